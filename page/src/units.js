// Units that apply to a robot: the library lists those of turning joints first, then those of sliding ones.

const slidesFirst = ({ kind }) => kind === "prismatic";
const turns = ({ kind }) => kind === "revolute" || kind === "ball";

// "turns" or "slides" if all joints do, else "both".
export function motionOf(robot) {
  if (robot.isFloating || robot.joints.length === 0) return "both";
  return robot.joints.every(turns) ? "turns" : robot.joints.every(slidesFirst) ? "slides" : "both";
}

// Rows of an output that are a twist's or a wrench's six.
export const hasSixRows = ({ of }, name, shape) => shape[0] === 6 && (of !== "robot" || name === "A" || name === "b");

// The unit of an output in words, such as "kg m²" of the mass matrix of an arm whose joints all turn.
export function unitOf(quantity, { name, shape, unit }, robot) {
  const motion = motionOf(robot);
  if (!unit || motion === "both") return unit ?? "";
  const [main, ...rest] = unit.split(/(?=, each per )/);
  // a number without a unit has none in either case
  const pick = (list) => (motion === "turns" || list[0] === "1" ? list[0] : list.at(-1));
  if (hasSixRows(quantity, name, shape)) {
    const groups = main.split(", ").map((group) => group.split(" or "));
    if (groups.length === 2) return [groups.map(pick).join(", "), ...rest].join("");
    return groups[0].length === 2 && motion === "turns" ? [`${groups[0][0]} for ω, ${groups[0][1]} for v`, ...rest].join("") : unit;
  }
  if (!shape.includes(robot.n)) return unit;
  return [pick(main.split(/, | or /)), ...rest].join("");
}
