// A robot of the library: what does not depend on its state, and quantities at a state.

import { hasQuaternion } from "./joints.js";
import { fromRows, identity } from "./vectors.js";

// Body 0 is the base; `allJoints` are the independent joints, a floating base first.
export class Robot {
  constructor(library, number, about) {
    Object.assign(this, { library, number });
    this.take(about);
    this.addresses = about.inputs.map((_, k) => library.address("web_input", [number, k]));
    this.requests = new Map();
  }

  take(about) {
    Object.assign(this, about);
    this.isFloating = about.base === "floating";
    const base = this.isFloating ? [{ name: "base", kind: "free", q: 0, j: 0 }] : [];
    this.allJoints = [...base, ...about.joints];
    [this.n, this.nq] = [about.velocities.length, about.positions.length];
  }

  setParameters(parameters) {
    this.library.call("web_parameters", [this.number], JSON.stringify(parameters));
    this.take(JSON.parse(this.library.said()));
  }

  // Outputs by their names, matrices by rows: compute({ quantity: "body_jacobian", frame: "hand" }, { theta }). Inputs
  // that are not given keep their last numbers.
  compute(request, inputs = {}) {
    const { place, address, length, outputs } = this.prepared(JSON.stringify(request));
    for (const [name, numbers] of Object.entries(inputs)) this.set(name, numbers);
    this.library.call("web_evaluate", [this.number, place]);
    const all = this.library.floats(address, length);
    const found = {};
    let at = 0;
    for (const { name, size } of outputs) {
      found[name] = Array.from(all.subarray(at, at + size));
      at += size;
    }
    return found;
  }

  prepared(text) {
    if (!this.requests.has(text)) {
      const place = this.library.call("web_prepare", [this.number], text);
      const outputs = JSON.parse(this.library.said()).outputs.map((output) => ({ ...output, size: output.shape.reduce((a, b) => a * b, 1) }));
      const length = outputs.reduce((sum, { size }) => sum + size, 0);
      this.requests.set(text, { place, outputs, length, address: this.library.address("web_output", [this.number, place]) });
    }
    return this.requests.get(text);
  }

  set(name, numbers) {
    const k = this.inputs.findIndex((input) => input.name === name);
    if (k < 0) throw new Error(`there is no input ${name}`);
    const { length } = this.inputs[k];
    if (numbers.length !== length) throw new Error(`${name} has ${numbers.length} numbers, expected ${length}`);
    this.library.floats(this.addresses[k], length).set(numbers);
  }

  // The wrenches that frames apply, each { frame, as }: returned is what sets their numbers, six for each.
  applying(list) {
    const address = this.library.address("web_apply", [this.number], JSON.stringify(list));
    return (numbers) => this.library.floats(address, 6 * list.length).set(numbers);
  }

  // Where every frame is.
  poses(theta) {
    const { T } = this.compute({ quantity: "frame_poses" }, { theta });
    return this.frames.map((_, k) => fromRows(T.slice(16 * k, 16 * k + 12)));
  }

  // Where every body is, by the frames' poses.
  bodyPoses(T) {
    return this.bodies.map(({ frame }) => T[frame] ?? identity());
  }

  massMatrix(theta) {
    return rows(this.compute({ quantity: "mass_matrix" }, { theta }).M, this.n);
  }

  // None if nothing weighs anything.
  centerOfMass(theta) {
    return this.weighs ? this.compute({ quantity: "center_of_mass" }, { theta }).c : null;
  }

  // Numbers for sliders, one for each velocity, and back.
  coordinates(theta) {
    return this.compute({ quantity: "coordinates" }, { theta }).x;
  }

  configuration(x) {
    return this.compute({ quantity: "configuration" }, { x }).theta;
  }

  // θ with unit quaternions.
  normalized(theta) {
    return this.allJoints.some(hasQuaternion) ? this.compute({ quantity: "unit_configuration" }, { theta }).theta : theta;
  }
}

// A list as rows of a width.
export const rows = (list, width) => Array.from({ length: list.length / width }, (_, k) => list.slice(k * width, (k + 1) * width));

// The frame with the most joints before it, where no end effector is named.
export function farthest(robot) {
  const depth = [];
  robot.bodies.forEach(({ parent }) => depth.push(parent === null ? 0 : depth[parent] + 1));
  return robot.frames.reduce((best, { body }, k) => (depth[body] >= depth[robot.frames[best].body] ? k : best), 0);
}

// Have two robots the same joints and frames?
export const alike = (a, b) =>
  String(a.frames.map(({ name }) => name)) === String(b.frames.map(({ name }) => name)) && a.isFloating === b.isFloating && String(a.positions) === String(b.positions);
