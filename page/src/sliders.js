// A slider and a number for each coordinate of each independent joint, where there is no motion.

import { coordinates, positionsOf, randomPose, velocitiesOf } from "./joints.js";

export function addSliders(host, robot, theta, jointColour, onChange, onPoint = () => {}) {
  const row = host.appendChild(document.createElement("div"));
  row.className = "row";
  const fields = robot.joints.map((joint) => slidersOf(host, robot, joint, theta, jointColour, onChange, onPoint));
  const set = (values) => {
    values.forEach((value, k) => (theta[k] = value));
    fields.forEach((show) => show());
    onChange();
  };
  const button = (text, values) => {
    const made = row.appendChild(document.createElement("button"));
    made.textContent = text;
    made.addEventListener("click", () => set(values()));
  };
  button("all at 0", () => robot.neutral);
  button("a random pose", () => randomPose(robot));
  if (robot.states.length > 0) addStates(row, robot.states, set);
  return set;
}

// The states that the robot's file names.
function addStates(row, states, set) {
  const select = row.appendChild(document.createElement("select"));
  select.setAttribute("aria-label", "a named state");
  select.append(new Option("a state…", ""));
  states.forEach(({ name }, k) => select.append(new Option(name, k)));
  select.addEventListener("change", () => select.value !== "" && set(states[select.value].theta));
}

// The fields of one joint, which set its positions in `theta`; returned is what shows them.
function slidersOf(host, robot, joint, theta, jointColour, onChange, onPoint) {
  const own = () => robot.coordinates(theta).slice(joint.j, joint.j + velocitiesOf(joint));
  const values = own();
  const x = new Array(robot.n).fill(0);
  const fields = coordinates.names(joint).map((name, k) => {
    const isLength = coordinates.isLength(joint, k);
    return field(host, { name, isLength, range: coordinates.range(joint, k), colour: jointColour(joint.j + k), point: (isOn) => onPoint(isOn ? [joint.j + k] : []) }, (value) => {
      values[k] = value;
      values.forEach((value, i) => (x[joint.j + i] = value));
      robot.configuration(x).slice(joint.q, joint.q + positionsOf(joint)).forEach((value, i) => (theta[joint.q + i] = value));
      onChange(joint);
    });
  });
  const show = () => own().forEach((value, k) => fields[k]((values[k] = value)));
  show();
  return show;
}

// A slider and a number that follow each other; returned is what sets both.
function field(host, { name, isLength, range, colour, point }, take) {
  const [low, high] = range;
  const div = host.appendChild(document.createElement("div"));
  div.className = "joint";
  for (const [kind, isOn] of [["pointerenter", true], ["focusin", true], ["pointerleave", false], ["focusout", false]]) div.addEventListener(kind, () => point(isOn));
  const label = div.appendChild(document.createElement("label"));
  const mark = label.appendChild(document.createElement("i"));
  mark.style.setProperty("--colour", colour);
  label.append(`${name}, ${isLength ? "m" : "rad"}`);
  label.title = name;
  label.htmlFor = `joint-${name}`;
  const number = div.appendChild(document.createElement("input"));
  Object.assign(number, { type: "number", step: isLength ? "0.01" : "0.1" });
  number.setAttribute("aria-label", `${name}, a number`);
  const slider = div.appendChild(document.createElement("input"));
  Object.assign(slider, { type: "range", id: label.htmlFor, min: low, max: high, step: "any" });
  let now = 0;
  const write = () => (number.value = Number(now.toFixed(4)));
  const show = (value, from) => {
    now = value;
    if (from !== slider) slider.value = value;
    // a number stays as it is typed
    if (document.activeElement !== number) write();
  };
  for (const input of [slider, number])
    input.addEventListener("input", () => {
      const value = input.valueAsNumber;
      if (!Number.isFinite(value)) return;
      show(value, input);
      take(value);
    });
  // what is no number goes
  number.addEventListener("blur", write);
  number.addEventListener("keydown", ({ key }) => key === "Escape" && write());
  return (value) => show(value, null);
}
