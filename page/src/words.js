// Words of sentences.

// "1 mesh was", "7 meshes were".
export const counted = (count, one, several) => `${count} ${count === 1 ? one : several}`;

// "6 joints, 21.0 kg"; a floating base is no joint.
export function aboutRobot(robot, mass) {
  const joints = counted(robot.joints.length, "joint", "joints");
  return [joints, robot.isFloating ? "a floating base" : "", mass > 0 ? `${Number(mass.toPrecision(3)) >= 100 ? mass.toFixed(0) : mass.toPrecision(3)} kg` : "no mass"].filter(Boolean).join(", ");
}
