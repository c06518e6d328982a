// Which curves stand in which plot: joints of one axis by their units, the parts of a ball, a free joint and a floating base each on its
// own, energies, contacts.

import { contactPlots } from "./contacts.js";
import { hasQuaternion, positionsOf, slides, velocitiesOf } from "./joints.js";

const COLOURS = ["#e5484d", "#30a46c", "#3e7bfa", "#8a63d2"];

// What a motion knows of its joints: its title and units, turning and sliding; and the parts of a joint of several numbers, each { title,
// unit, from, to } among them.
const QUANTITIES = [
  { key: "theta", title: "θ", units: ["rad", "m"], parts: [["quaternion", "", 0, 4], ["p", "m", 4, 7]] },
  { key: "dtheta", title: "θ̇", units: ["rad/s", "m/s"], parts: [["ω", "rad/s, in its own axes", 0, 3], ["v", "m/s, in its own axes", 3, 6]] },
  { key: "ddtheta", title: "θ̈", units: ["rad/s²", "m/s²"], parts: [["ω̇", "rad/s², in its own axes", 0, 3], ["v̇", "m/s², in its own axes", 3, 6]] },
  { key: "tau", title: "τ", units: ["N m", "N"], parts: [["m", "N m, in its own axes", 0, 3], ["f", "N, in its own axes", 3, 6]] },
];

const column = (rows, k) => rows.map((row) => row[k]);

// Plots of all joints of one axis.
function ofAxes(robot, motion, { key, title, units }, jointColour) {
  const curves = robot.joints.filter((joint) => !hasQuaternion(joint)).map((joint) => ({
    name: joint.name, joint: joint.name, colour: jointColour(joint.j), slides: slides(joint),
    values: column(motion[key], key === "theta" ? joint.q : joint.j),
  }));
  return [false, true]
    .map((isSliding, k) => ({ title, unit: units[k], curves: curves.filter((curve) => curve.slides === isSliding) }))
    .filter((plot) => plot.curves.length > 0);
}

// Plots of one joint of several numbers; a part of τ only where something acts.
function ofParts(robot, motion, { key, parts }, joint) {
  const [first, width, names] = key === "theta" ? [joint.q, positionsOf(joint), robot.positions] : [joint.j, velocitiesOf(joint), robot.velocities];
  return parts.filter(([, , from]) => from < width).map(([title, unit, from, to]) => ({
    title: `${joint.name} ${title}`, unit, legend: true,
    curves: names.slice(first + from, first + to).map((name, k) => ({
      name: name.slice(joint.name.length + 1), joint: joint.name, colour: COLOURS[k], values: column(motion[key], first + from + k),
    })),
  })).filter(({ curves }) => key !== "tau" || curves.some(({ values }) => values.some((x) => x !== 0)));
}

// { title, unit, curves } of a motion.
export function plotsOf(robot, motion, jointColour) {
  const known = QUANTITIES.filter(({ key }) => motion[key]);
  const plots = known.flatMap((quantity) => ofAxes(robot, motion, quantity, jointColour));
  const energy = [["kinetic", motion.kinetic, "#e07b39"], ["potential", motion.potential, "#3b7dd8"]].filter(([, values]) => values);
  if (energy.length === 2) energy.push(["total", motion.kinetic.map((K, k) => K + motion.potential[k]), "#2f9e6e"]);
  const named = ([name, values, colour]) => ({ name, values, colour });
  if (energy.length > 0) plots.push({ title: "energy", unit: "J", legend: true, curves: energy.map(named) });
  if (motion.drift) plots.push({ title: "drift", unit: "J, energy that the method made", curves: [{ name: "drift", values: motion.drift, colour: "#c9486a" }] });
  if (motion.contacts) plots.push(...contactPlots(motion.contacts));
  const ofJoint = (joint) => known.flatMap((quantity) => ofParts(robot, motion, quantity, joint));
  return [...plots, ...robot.allJoints.filter(hasQuaternion).flatMap(ofJoint)];
}
