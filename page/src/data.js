// The data that mozzi writes into the page: `robot`, `meshes` and `motion`, see crates/mozzi-report. Numbers of a motion are 32-bit
// floats, base64, its times 64-bit ones; meshes are gzipped.

import { fromRows } from "./lie.js";

export function bytes(base64) {
  const text = atob(base64);
  return Uint8Array.from(text, (letter) => letter.charCodeAt(0));
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

export function readRobot(raw) {
  const bodies = raw.bodies.map((body) => ({ ...body, M: fromRows(body.M) }));
  const frames = raw.frames.map((frame) => ({ ...frame, T: fromRows(frame.T) }));
  const shapes = raw.shapes.map((shape) => ({ ...shape, T: fromRows(shape.T) }));
  return { ...raw, bodies, frames, shapes, isFloating: raw.base === "floating", n: raw.velocities.length, nq: raw.positions.length };
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
    t: Array.from(floats(raw.t, 8)),
    theta: rows(raw.theta, robot.nq),
    dtheta: rows(raw.dtheta, robot.n),
    ddtheta: rows(raw.ddtheta, robot.n),
    tau: rows(raw.tau, robot.n),
    tip: rows(raw.tip_wrench, 6),
    kinetic: list(raw.kinetic_energy),
    potential: list(raw.potential_energy),
    drift: list(raw.drift),
  };
}

// The state at a time: linear between rows, which a quaternion survives, since whoever reads it makes it unit.
export function stateAt(motion, time) {
  const { t } = motion;
  let low = 0;
  let high = t.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (t[middle] <= time) low = middle;
    else high = middle;
  }
  const part = t[high] > t[low] ? Math.min(Math.max((time - t[low]) / (t[high] - t[low]), 0), 1) : 0;
  const between = (rows) => rows && rows[low].map((x, k) => x + part * (rows[high][k] - x));
  const [theta, dtheta, ddtheta, tau, tip] = [motion.theta, motion.dtheta, motion.ddtheta, motion.tau, motion.tip].map(between);
  return { theta, dtheta, ddtheta, tau, tip, low, part };
}
