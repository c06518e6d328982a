// Panels of all quantities at the robot's state: name, formula, units, numbers; an entry says which joints it is about.

import { rows } from "./robot.js";
import { colour } from "./theme.js";
import { TorqueEllipse } from "./torque.js";
import { hasSixRows, unitOf } from "./units.js";

const FIRST = ["mass_matrix", "gravity_forces", "forward_kinematics"];
const SIX = ["ω_x", "ω_y", "ω_z", "v_x", "v_y", "v_z"];
const WRENCH = ["m_x", "m_y", "m_z", "f_x", "f_y", "f_z"];
// More columns are drawn as a picture.
const TABLE = 12;

// Other words for a quantity, by a part of its name.
const WORDS = {
  inverse_dynamics: "torques torque rnea newton euler", tip_forces: "torques torque load", gravity_forces: "torques torque weight", bias_forces: "torques torque nonlinear",
  velocity_product: "torques torque coriolis centrifugal", joint_friction: "torques torque", spring_forces: "torques torque",
  forward_dynamics: "accelerations aba torques torque", mass_matrix: "inertia crba", forward_kinematics: "pose position fk", frame_poses: "position fk",
  jacobian: "velocity twist singular", kinetic_energy: "velocity", velocity_ellipsoid: "manipulability singular",
};

const label = (text) => text.replaceAll("_", " ");

export class Quantities {
  constructor(host, app) {
    Object.assign(this, { host, app, open: new Set(FIRST), parts: new Map() });
    const row = host.appendChild(document.createElement("div"));
    row.className = "row";
    this.search = row.appendChild(document.createElement("input"));
    Object.assign(this.search, { type: "search", placeholder: "find a quantity" });
    this.search.setAttribute("aria-label", "Find a quantity");
    this.search.addEventListener("input", () => this.filter());
    this.none = host.appendChild(document.createElement("p"));
    Object.assign(this.none, { className: "note", hidden: true });
    this.none.setAttribute("role", "status");
    this.ellipse = host.appendChild(document.createElement("details"));
    this.ellipse.className = "quantity";
    this.ellipse.appendChild(document.createElement("summary")).append(Object.assign(document.createElement("b"), { textContent: "torque ellipsoid" }),
      Object.assign(document.createElement("small"), { textContent: "{Mθ̈ : ‖θ̈‖ = 1}, the torques that give accelerations of size 1" }));
    this.torques = new TorqueEllipse(this.ellipse);
    this.ellipse.addEventListener("toggle", () => this.update());
    this.list = host.appendChild(document.createElement("div"));
    this.entry = host.appendChild(document.createElement("p"));
    this.entry.id = "entry";
    this.entry.setAttribute("aria-live", "polite");
  }

  // The panels of a robot.
  take(robot) {
    this.robot = robot;
    this.list.replaceChildren();
    this.parts.clear();
    for (const quantity of robot.quantities) {
      const part = this.list.appendChild(document.createElement("details"));
      part.className = "quantity";
      part.dataset.name = quantity.name;
      const summary = part.appendChild(document.createElement("summary"));
      summary.appendChild(document.createElement("b")).textContent = label(quantity.name);
      summary.appendChild(document.createElement("small")).textContent = quantity.formula;
      const body = part.appendChild(document.createElement("div"));
      this.parts.set(quantity.name, { part, body, quantity, shown: [] });
      part.open = this.open.has(quantity.name);
      part.addEventListener("toggle", () => {
        if (part.open) this.open.add(quantity.name);
        else this.open.delete(quantity.name);
        if (part.open) this.app.last = quantity;
        this.update();
      });
    }
    this.filter();
  }

  filter() {
    const words = this.search.value.toLowerCase().split(/[\s_]+/).filter(Boolean);
    for (const { part, quantity } of this.parts.values()) part.hidden = !words.every((word) => this.text(quantity).includes(word));
    this.ellipse.hidden = !words.every((word) => "torque torques ellipsoid ellipse mass matrix".includes(word));
    const isEmpty = this.ellipse.hidden && [...this.parts.values()].every(({ part }) => part.hidden);
    this.none.hidden = !isEmpty;
    this.none.textContent = isEmpty ? `No quantity is found by “${this.search.value.trim()}”. Try torque, mass, Jacobian, energy, friction or derivative.` : "";
  }

  // What a quantity is found by: name, formula, other words.
  text({ name, formula }) {
    const others = Object.entries(WORDS).filter(([part]) => name.includes(part)).map(([, words]) => words);
    return [label(name), formula, ...others].join(" ").toLowerCase();
  }

  request({ name, of }) {
    return of === "frame" || of === "task" ? { quantity: name, frame: this.app.frameName } : { quantity: name };
  }

  update() {
    if (!this.robot || this.host.hidden) return;
    for (const one of this.parts.values()) if (one.part.open && !one.part.hidden) this.fill(one);
    if (this.ellipse.open && this.robot.n > 0) this.torques.show(this.robot, this.app.state.theta);
  }

  fill(one) {
    const request = this.request(one.quantity);
    let found = null;
    let problem = "";
    try {
      found = this.robot.compute(request);
    } catch (error) {
      problem = error.message;
    }
    const key = JSON.stringify(request) + problem + (this.robot.number ?? "");
    if (one.key !== key) {
      one.key = key;
      one.body.replaceChildren();
      const about = one.body.appendChild(document.createElement("p"));
      const of = request.frame ? `of the frame ${request.frame}; ` : "";
      about.textContent = problem || of + (one.quantity.inputs.length > 0 ? `of ${one.quantity.inputs.map((name) => this.symbol(name)).join(", ")}` : "");
      const { outputs } = found ? this.robot.prepared(JSON.stringify(request)) : { outputs: [] };
      one.shown = outputs.map((output) => ({ name: output.name, show: this.table(one.body, one.quantity, { ...output, unit: unitOf(one.quantity, output, this.robot) }) }));
    }
    if (found) for (const { name, show } of one.shown) show(found[name]);
  }

  symbol(name) {
    return this.robot.inputs.find((input) => input.name === name)?.symbol ?? name;
  }

  // Names of the entries along an axis of this length, and the velocities that they are about.
  names(length, name, isSix) {
    const { robot } = this;
    if (isSix) return /^[fFwWhb]|^dh|wrench/.test(name) || name === "A" ? WRENCH : SIX;
    if (name === "theta" || (length === robot.nq && length !== robot.n)) return robot.positions;
    if (length === robot.n) return robot.velocities;
    if (length === 6) return SIX;
    if (length === 3) return ["x", "y", "z"];
    if (length === 4) return ["x", "y", "z", "1"];
    return Array.from({ length }, (_, k) => String(k + 1));
  }

  // A table or, of a large matrix, a picture; returned is what fills it.
  table(host, quantity, { name, shape, unit }) {
    const box = host.appendChild(document.createElement("div"));
    box.className = "values-of";
    const [height, width] = shape.length === 2 ? shape : [shape[0] ?? 1, 1];
    if (shape.length > 2) return this.plain(box, name, shape, unit);
    const across = width > 1 ? this.names(width, name) : [""];
    const down = shape.length === 0 ? [""] : this.names(height, name, hasSixRows(quantity, name, shape));
    if (width > TABLE || height * width > 400) return this.picture(box, { name, unit, down, across });
    const table = box.appendChild(document.createElement("table"));
    table.appendChild(document.createElement("caption")).textContent = unit ? `${name}, ${unit}` : name;
    const cells = [];
    down.forEach((rowName, i) => {
      const tr = table.appendChild(document.createElement("tr"));
      const th = tr.appendChild(document.createElement("th"));
      Object.assign(th, { textContent: rowName, title: rowName, scope: "row" });
      across.forEach((columnName, j) => {
        const td = tr.appendChild(document.createElement("td"));
        const say = () => this.say(name, rowName, columnName, Number(td.dataset.value), unit);
        td.addEventListener("pointerenter", say);
        td.addEventListener("focus", say);
        td.addEventListener("pointerleave", () => this.app.stage.point([]));
        td.tabIndex = i === 0 && j === 0 ? 0 : -1;
        td.addEventListener("keydown", (event) => this.move(event, cells, i, j, across.length));
        cells.push(td);
      });
    });
    return (numbers) => numbers.forEach((x, k) => {
      if (!cells[k]) return;
      cells[k].dataset.value = x;
      cells[k].textContent = written(x, across.length > 5 ? 3 : 5);
    });
  }

  move(event, cells, i, j, width) {
    const step = { ArrowUp: -width, ArrowDown: width, ArrowLeft: -1, ArrowRight: 1 }[event.key];
    const next = step && cells[i * width + j + step];
    if (!next) return;
    event.preventDefault();
    event.stopPropagation();
    next.tabIndex = 0;
    next.focus();
  }

  plain(box, name, shape, unit) {
    const p = box.appendChild(document.createElement("p"));
    return (numbers) => (p.textContent = `${name}, ${shape.join(" × ")}, ${unit}: largest ${written(Math.max(...numbers.map(Math.abs)))}`);
  }

  picture(box, { name, unit, down, across }) {
    const caption = box.appendChild(document.createElement("p"));
    caption.textContent = `${name}, ${unit}: ${down.length} × ${across.length}; warm is positive, cold negative`;
    const canvas = box.appendChild(document.createElement("canvas"));
    [canvas.width, canvas.height] = [across.length, down.length];
    Object.assign(canvas, { tabIndex: 0 });
    canvas.style.aspectRatio = `${across.length} / ${down.length}`;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${name}, a matrix of ${down.length} by ${across.length}`);
    let matrix = [];
    canvas.addEventListener("pointermove", (event) => {
      const { left, top, width, height } = canvas.getBoundingClientRect();
      const at = (part, count) => Math.min(Math.max(Math.floor(part * count), 0), count - 1);
      const [i, j] = [at((event.clientY - top) / height, down.length), at((event.clientX - left) / width, across.length)];
      this.say(name, down[i], across[j], matrix[i][j], unit);
    });
    canvas.addEventListener("pointerleave", () => this.app.stage.point([]));
    return (numbers) => {
      matrix = rows(numbers, across.length);
      const draw = canvas.getContext("2d");
      const most = Math.max(...numbers.map(Math.abs), 1e-300);
      const [cold, warm, none] = ["cold", "warm", "none"].map((kind) => colour(kind));
      matrix.forEach((row, i) => row.forEach((x, j) => {
        draw.globalAlpha = 1;
        draw.fillStyle = none;
        draw.fillRect(j, i, 1, 1);
        draw.globalAlpha = Math.cbrt(Math.abs(x) / most);
        draw.fillStyle = x < 0 ? cold : warm;
        draw.fillRect(j, i, 1, 1);
      }));
    };
  }

  // An entry in words, and the axes of its joints in the scene.
  say(name, row, column, value, unit) {
    const of = [row, column].filter((text) => text !== "").join(", ");
    this.entry.textContent = `${name}${of ? ` (${of})` : ""} = ${value}${unit ? `, ${unit}` : ""}`;
    this.app.stage.point([row, column].map((text) => this.robot.velocities.indexOf(text)).filter((j) => j >= 0));
  }
}

export function written(x, digits = 5) {
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (!Number.isFinite(x)) return String(x);
  return (size >= 1e5 || size < 1e-4 ? x.toExponential(digits - 2) : x.toPrecision(digits)).replace("-", "−");
}
