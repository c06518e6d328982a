// The data that mozzi writes into the page: `robot`, `shapes`, `meshes` and `motion`, see crates/mozzi-report. Numbers of a motion are
// 32-bit floats, base64, its times 64-bit ones; meshes are gzipped.

import { hasQuaternion } from "./joints.js";
import { dot, fromRows } from "./vectors.js";

export function bytes(base64) {
  const text = atob(base64);
  const found = new Uint8Array(text.length);
  for (let k = 0; k < text.length; k++) found[k] = text.charCodeAt(k); // a megabyte: thirty times as fast as Uint8Array.from
  return found;
}

export async function unzipped(base64) {
  const stream = new Blob([bytes(base64)]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

function floats(base64, size = 4) {
  const raw = bytes(base64);
  const view = new DataView(raw.buffer);
  const at = size === 8 ? (k) => view.getFloat64(8 * k, true) : (k) => view.getFloat32(4 * k, true);
  return Float64Array.from({ length: raw.length / size }, (_, k) => at(k));
}

// The robot of the page, with its shapes.
export function readRobot(library, { robot: description, parameters, shapes }) {
  const robot = library.load("robot.json", JSON.stringify(description));
  if (parameters) robot.setParameters(parameters);
  robot.shapes = shapes.map((shape) => ({ ...shape, T: fromRows(shape.T) }));
  return robot;
}

// A motion: columns[name] is a list of rows' entries; names that the file does not give are null.
export function readMotion(raw, robot) {
  if (!raw) return null;
  const rows = (base64, width) => {
    if (!base64) return null;
    const all = floats(base64);
    return Array.from({ length: all.length / width }, (_, k) => Array.from(all.subarray(k * width, (k + 1) * width)));
  };
  const list = (base64) => (base64 ? Array.from(floats(base64)) : null);
  return {
    title: raw.title,
    robot,
    t: Array.from(floats(raw.t, 8)),
    theta: rows(raw.theta, robot.nq),
    dtheta: rows(raw.dtheta, robot.n),
    ddtheta: rows(raw.ddtheta, robot.n),
    tau: rows(raw.tau, robot.n),
    tip: rows(raw.tip_wrench, 6),
    loops: rows(raw.constraint_wrenches, 6 * robot.constraints.length),
    kinetic: list(raw.kinetic_energy),
    potential: list(raw.potential_energy),
    drift: list(raw.drift),
    contacts: raw.contacts ? readContacts(raw.contacts, rows) : null,
  };
}

// Points and forces of each row, three numbers for each pair of a point and a plane; planes with one configuration or one a row.
function readContacts(raw, rows) {
  const planes = raw.planes.map((plane) => ({ ...plane, poses: rows(plane.poses, 12) }));
  const width = 3 * raw.pairs.length;
  return { ...raw, planes, points: rows(raw.points, width), forces: rows(raw.forces, width) };
}

// Two rows of θ, of each quaternion in the second the sign that is nearer to the first: both signs are one rotation.
function nearer(robot, from, to) {
  const signed = [...to];
  for (const { q } of robot.allJoints.filter(hasQuaternion)) {
    if (dot(from.slice(q, q + 4), to.slice(q, q + 4)) < 0) for (let k = q; k < q + 4; k++) signed[k] = -to[k];
  }
  return signed;
}

// The state at a time: linear between rows, quaternions then made unit.
export function stateAt(motion, time) {
  const { t, robot } = motion;
  let low = 0;
  let high = t.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (t[middle] <= time) low = middle;
    else high = middle;
  }
  const part = t[high] > t[low] ? Math.min(Math.max((time - t[low]) / (t[high] - t[low]), 0), 1) : 0;
  const mixed = (from, to) => from.map((x, k) => x + part * (to[k] - x));
  const between = (rows) => rows && mixed(rows[low], rows[high]);
  const theta = robot.normalized(mixed(motion.theta[low], nearer(robot, motion.theta[low], motion.theta[high])));
  const { contacts } = motion;
  const touch = contacts && {
    points: between(contacts.points),
    forces: between(contacts.forces),
    planes: contacts.planes.map(({ poses }) => fromRows(poses.length > 1 ? between(poses) : poses[0])),
  };
  const [dtheta, ddtheta, tau, tip, loops] = [motion.dtheta, motion.ddtheta, motion.tau, motion.tip, motion.loops].map(between);
  return { time, theta, dtheta, ddtheta, tau, tip, loops, touch, low, part };
}
