// What the scene can show: its name, its key, its colour.

export const KINDS = {
  shapes: { name: "shapes", key: "s", colour: "#8894a2", about: "visual geometry of the robot's file; else what collides" },
  glass: { name: "glass", key: "g", colour: "#8894a2", about: "shapes that let the inside be seen" },
  skeleton: { name: "skeleton", key: "k", colour: "#5e7188", about: "joints as drums (turning), boxes (sliding) and spheres (balls), bones between" },
  axes: { name: "screw axes", key: "a", colour: "#8a63d2", about: "of each joint, in its direction; of a ball three, fixed to its link" },
  frames: { name: "frames", key: "f", colour: "#7a8794", about: "base, link frames and end effector: x red, y green, z blue" },
  masses: { name: "masses", key: "c", colour: "#c79a12", about: "centres of mass of the bodies, the robot's own in red" },
  twists: { name: "twists", key: "t", colour: "#2f9e6e", about: "of each body: ω (light green), v of its centre of mass (green)" },
  wrenches: { name: "wrenches", key: "w", colour: "#d0433f", about: "that each joint transmits to its link: moment (orange), force (red)" },
  constraints: { name: "constraints", key: "o", colour: "#b0309a", about: "lines between the points that they hold together; in a motion the force that each carries" },
  contacts: { name: "contacts", key: "x", colour: "#4f46e5", about: "in a motion: points that touch planes (grey: they do not), the force that the robot applies to the plane, and the cone of friction of half-angle atan μ, as deep as that force's normal part; orange: the force is on the cone, the point slides" },
  inertia: { name: "inertia", key: "i", colour: "#b8962e", about: "homogeneous ellipsoids with the bodies' mass and inertia" },
  manipulability: { name: "manipulability", key: "m", colour: "#1f9bb0", about: "velocities of the end effector's origin at ‖θ̇‖ = 1, {v: v = J_v θ̇}; 1 m/s is drawn 0.25 m long" },
  torque: { name: "torques", key: "e", colour: "#e07b39", about: "forces at the end effector that ‖τ‖ = 1 holds, {f: ‖J_vᵀf‖ = 1}: long where manipulability is short" },
  path: { name: "path", key: "h", colour: "#3b7dd8", about: "of the end effector's origin" },
  mass: { name: "M(θ)", key: "n", colour: "#cf4630", about: "mass matrix: warm entries are positive, cold ones negative, by the cube root of their size" },
};
