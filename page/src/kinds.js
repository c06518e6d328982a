// What the scene can show: its name, its key, its colour.

// Robot, motion and forces are the groups of buttons.
export const KINDS = {
  shapes: { group: "robot", name: "shapes", key: "s", colour: "#8894a2", about: "visual geometry of the robot's file; else what collides" },
  glass: { group: "robot", name: "glass", key: "g", colour: "#8894a2", about: "shapes that let the inside be seen" },
  skeleton: { group: "robot", name: "skeleton", key: "k", colour: "#5e7188", about: "joints as drums (turning), boxes (sliding) and spheres (balls), bones between" },
  axes: { group: "robot", name: "screw axes", key: "a", colour: "#8a63d2", about: "of each joint, in its direction; of a ball three, fixed to its link" },
  frames: { group: "robot", name: "frames", key: "f", colour: "#7a8794", about: "base, link frames and end effector: x red, y green, z blue" },
  masses: { group: "robot", name: "centres of mass", key: "c", colour: "#c79a12", about: "of the bodies, the robot's own in red" },
  inertia: { group: "robot", name: "inertia", key: "i", colour: "#b8962e", about: "homogeneous ellipsoids with the bodies' mass and inertia" },
  mass: { group: "robot", name: "M(θ)", key: "n", colour: "#cf4630", about: "mass matrix: warm entries are positive, cold ones negative, by the cube root of their size" },
  twists: { group: "motion", name: "twists", key: "t", colour: "#2f9e6e", about: "of each body: ω (light green), v of its centre of mass (green)" },
  manipulability: { group: "motion", name: "velocity ellipsoid", key: "m", colour: "#1f9bb0", about: "velocities of the end effector's origin at ‖θ̇‖ = 1, {v: v = J_v θ̇}" },
  path: { group: "motion", name: "path", key: "h", colour: "#3b7dd8", about: "of the end effector's origin" },
  wrenches: { group: "forces", name: "wrenches", key: "w", colour: "#d0433f", about: "that each joint transmits to its link: moment (orange), force (red)" },
  constraints: { group: "forces", name: "constraints", key: "o", colour: "#b0309a", about: "lines between the points that they hold together, and where the motion is known the force that each carries" },
  contacts: { group: "forces", name: "contacts", key: "x", colour: "#4f46e5", about: "points that touch planes (grey: they do not), the force with which the plane pushes the robot, and in a motion the cone of friction of half-angle atan μ, as high as that force's normal part; orange: the force is on the cone, the point slides" },
  applied: { group: "forces", name: "robot's side", key: "j", colour: "#4f46e5", about: "contacts from the robot's side: the force with which the robot pushes the plane" },
  torque: { group: "forces", name: "force ellipsoid", key: "e", colour: "#e07b39", about: "forces at the end effector that ‖τ‖ = 1 holds, {f: ‖J_vᵀf‖ = 1}: long where the velocity ellipsoid is short" },
};

// More joints' axes are shown only where the pointer is.
const MANY = 9;

// What is shown at first: shapes if they are whole, else bones with them, and the axes of few joints.
export function usualKinds(robot, isWhole, hasShapes) {
  const bones = isWhole ? [] : ["skeleton", ...(robot.n < MANY ? ["axes"] : [])];
  return [...(hasShapes ? ["shapes"] : []), ...bones, "contacts", "mass"];
}
