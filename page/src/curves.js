// Which curves stand in which plot: joints by their units, a free base's parts, energies.

const AXES = ["x", "y", "z"];

// { title, unit, curves } of a motion; a curve's name is the joint's, whatever it tells of it.
export function plotsOf(robot, motion, jointColour) {
  const base = robot.isFloating ? { q: 7, j: 6 } : { q: 0, j: 0 };
  const column = (rows, k) => rows.map((row) => row[k]);
  const joints = robot.slides.map((slides, k) => ({ slides, name: robot.velocities[base.j + k], k, colour: jointColour(base.j + k) }));
  const plots = [];
  const ofJoints = (title, rows, offset, turning, sliding) => {
    if (!rows) return;
    for (const [slides, unit] of [[false, turning], [true, sliding]]) {
      const curves = joints.filter((joint) => joint.slides === slides)
        .map(({ name, k, colour }) => ({ name, colour, values: column(rows, offset + k) }));
      if (curves.length > 0) plots.push({ title, unit, curves });
    }
  };
  ofJoints("θ", motion.theta, base.q, "rad", "m");
  ofJoints("θ̇", motion.dtheta, base.j, "rad/s", "m/s");
  ofJoints("θ̈", motion.ddtheta, base.j, "rad/s²", "m/s²");
  ofJoints("τ", motion.tau, base.j, "N m", "N");
  const energy = [["kinetic", motion.kinetic, "#e07b39"], ["potential", motion.potential, "#3b7dd8"]].filter(([, values]) => values);
  if (energy.length === 2) energy.push(["total", motion.kinetic.map((K, k) => K + motion.potential[k]), "#2f9e6e"]);
  const named = ([name, values, colour]) => ({ name, values, colour });
  if (energy.length > 0) plots.push({ title: "energy", unit: "J", legend: true, curves: energy.map(named) });
  if (motion.drift) plots.push({ title: "drift", unit: "J, energy that the method made", curves: [{ name: "drift", values: motion.drift, colour: "#c9486a" }] });
  if (!robot.isFloating) return plots;
  const colours = ["#e5484d", "#30a46c", "#3e7bfa", "#8a63d2"];
  const part = (title, unit, rows, from, names) => {
    if (!rows) return;
    const curves = names.map((name, k) => ({ name, colour: colours[k], values: column(rows, from + k) }));
    plots.push({ title: `base ${title}`, unit, legend: true, curves });
  };
  part("p", "m", motion.theta, 4, AXES);
  part("quaternion", "", motion.theta, 0, ["w", ...AXES]);
  part("ω", "rad/s, in its own axes", motion.dtheta, 0, AXES);
  part("v", "m/s, in its own axes", motion.dtheta, 3, AXES);
  return plots;
}
