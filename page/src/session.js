// A robot of the playground: opened from files, simulated and edited by commands of mozzi-web (crates/mozzi-web/src/play).

import { Robot } from "./robot.js";
import { fromRows } from "./vectors.js";

// { file, files: { path: text }, description, arguments } as an open robot, with its texts; throws what is wrong with the files.
export function openRobot(library, asked) {
  const number = library.call("web_open", [], JSON.stringify(asked));
  const { about, description, shapes, warnings, notes, arguments: declared } = JSON.parse(library.said());
  const robot = new Robot(library, number, about);
  robot.shapes = shapes.map((shape) => ({ ...shape, T: fromRows(shape.T) }));
  return Object.assign(robot, { description, warnings, notes, declared });
}

export function closeRobot(robot) {
  robot.library.call("web_close", [robot.number]);
}

// The answer of a command.
export function command(robot, object) {
  robot.library.call("web_play", [robot.number], JSON.stringify(object));
  return JSON.parse(robot.library.said());
}

// The numbers of an input, copied.
export function read(robot, name) {
  const k = robot.inputs.findIndex((input) => input.name === name);
  return Array.from(robot.library.floats(robot.addresses[k], robot.inputs[k].length));
}
