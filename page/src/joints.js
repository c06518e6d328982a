// How a joint of each kind moves its body. A floating base is the free joint of body 0.

import { capped, compose, exponential, fromQuaternion, identity, linear, angular, cross, quaternionOf, rotationVector, turned } from "./lie.js";

const UNIT = [0, 1, 2, 3, 4, 5].map((k) => [0, 1, 2, 3, 4, 5].map((i) => (i === k ? 1 : 0)));

// How many positions and velocities.
export const positionsOf = ({ kind }) => ({ ball: 4, free: 7 })[kind] ?? 1;
export const velocitiesOf = ({ kind }) => ({ ball: 3, free: 6 })[kind] ?? 1;

export const hasQuaternion = (joint) => positionsOf(joint) > 1;
export const slides = ({ kind }) => kind === "prismatic";

export const atZero = (joint) => (hasQuaternion(joint) ? [1, ...new Array(positionsOf(joint) - 1).fill(0)] : [0]);

// The body's frame, seen from where it is at 0: of a ball a rotation about its centre.
export function displacement(body, theta) {
  const own = theta.slice(body.q, body.q + positionsOf(body));
  if (body.kind === "free") return fromQuaternion(own);
  if (body.kind !== "ball") return exponential(body.A, body.ratio * own[0] + body.offset);
  const { R } = fromQuaternion([...own, 0, 0, 0]);
  return { R, p: body.center.map((x, k) => x - turned(R, body.center)[k]) };
}

// The twist of each of its velocities, in the body's own frame.
export function screws(body) {
  if (body.kind === "free") return UNIT;
  if (body.kind !== "ball") return [body.A.map((x) => x * body.ratio)];
  return UNIT.slice(0, 3).map((axis) => [...angular(axis), ...cross(body.center, angular(axis))]);
}

// The point of a screw axis nearest to the origin of its coordinates, and its direction.
export function lineOf(A) {
  const [w, v] = [angular(A), linear(A)];
  return w.some((x) => x !== 0) ? { point: cross(w, v), direction: w } : { point: [0, 0, 0], direction: v };
}

// The lines about or along which it moves: none of a free joint.
export const linesOf = (body) => (body.kind === "free" ? [] : screws({ ...body, ratio: 1 }).map(lineOf));

// Where the joint acts on its body, in the body's frame.
export const pointOf = (body) => body.center ?? linesOf(body)[0]?.point ?? [0, 0, 0];

// Numbers that a slider can set: an angle or a length; of a ball and a free joint the rotation vector, of a free one also the origin.
export const coordinates = {
  names: (joint) => (hasQuaternion(joint) ? ["rx", "ry", "rz", "x", "y", "z"].slice(0, velocitiesOf(joint)).map((part) => `${joint.name}.${part}`) : [joint.name]),
  isLength: (joint, k) => slides(joint) || k > 2,
  range(joint, k) {
    if (this.isLength(joint, k)) return joint.limits ?? [-1, 1];
    const most = joint.limits?.[1] ?? Math.PI;
    return hasQuaternion(joint) ? [-most, most] : joint.limits ?? [-Math.PI, Math.PI];
  },
  // From its positions, and back; a ball turns no farther than its limit.
  read: (joint, own) => (hasQuaternion(joint) ? [...rotationVector(own), ...own.slice(4)] : own),
  write: (joint, values) =>
    hasQuaternion(joint) ? [...quaternionOf(capped(values.slice(0, 3), joint.limits?.[1] ?? Infinity)), ...values.slice(3)] : values,
};

// Any pose within the limits; what is free stays where it is at 0.
export const randomPose = (robot) => robot.allJoints.flatMap((joint) => {
  if (joint.kind === "free") return atZero(joint);
  const values = coordinates.names(joint).map((_, k) => {
    const [low, high] = coordinates.range(joint, k);
    return low + Math.random() * (high - low);
  });
  return coordinates.write(joint, values);
});

// θ with the quaternions unit.
export function normalized(robot, theta) {
  const unit = [...theta];
  for (const { q } of robot.allJoints.filter(hasQuaternion)) {
    const size = Math.hypot(...theta.slice(q, q + 4)) || 1;
    for (let k = q; k < q + 4; k++) unit[k] /= size;
  }
  return unit;
}
