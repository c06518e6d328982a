// Kinds of joints, and the numbers that sliders set.

// How many positions and velocities.
export const positionsOf = ({ kind }) => ({ ball: 4, free: 7 })[kind] ?? 1;
export const velocitiesOf = ({ kind }) => ({ ball: 3, free: 6 })[kind] ?? 1;

export const hasQuaternion = (joint) => positionsOf(joint) > 1;
export const slides = ({ kind }) => kind === "prismatic";

// A slider sets an angle or a length; of a ball and a free joint the rotation vector, of a free one also the origin.
export const coordinates = {
  names: (joint) => (hasQuaternion(joint) ? ["rx", "ry", "rz", "x", "y", "z"].slice(0, velocitiesOf(joint)).map((part) => `${joint.name}.${part}`) : [joint.name]),
  isLength: (joint, k) => slides(joint) || k > 2,
  range(joint, k) {
    if (this.isLength(joint, k)) return joint.limits ?? [-1, 1];
    const most = joint.limits?.[1] ?? Math.PI;
    return hasQuaternion(joint) ? [-most, most] : joint.limits ?? [-Math.PI, Math.PI];
  },
};

// Any pose within the limits; what is free stays where it is at 0.
export function randomPose(robot) {
  const x = new Array(robot.n).fill(0);
  for (const joint of robot.joints.filter(({ kind }) => kind !== "free")) {
    coordinates.names(joint).forEach((_, k) => {
      const [low, high] = coordinates.range(joint, k);
      x[joint.j + k] = low + Math.random() * (high - low);
    });
  }
  return robot.configuration(x);
}

// Of each velocity whether it is a length's: of a free joint the last three.
export const slidingOf = (robot) =>
  robot.allJoints.flatMap((joint) => Array.from({ length: velocitiesOf(joint) }, (_, k) => slides(joint) || k > 2));
