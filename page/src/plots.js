// Curves over time, with a cursor that scrubs.

import { dashes } from "./colours.js";
import { colour } from "./theme.js";

const MARGIN = { left: 46, right: 8, top: 6, bottom: 16 };

// Round numbers in a range, about so many, at least two.
export function ticks(low, high, about) {
  for (;; about *= 1.5) {
    const raw = (high - low) / about;
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((k) => k * power).find((size) => size >= raw * (1 - 1e-9));
    const list = [];
    for (let k = Math.ceil(low / step); k * step <= high; k++) list.push(k * step);
    if (list.length > 1 || about > 60) return { list, step };
  }
}

export function short(x, step = Math.abs(x) / 100) {
  if (x === 0 || step === 0) return "0";
  if (Math.abs(x) >= 1e5 || step < 1e-4) return x.toExponential(Math.abs(x) > 50 * step ? 2 : 0).replace("e+", "e");
  return x.toFixed(Math.min(Math.max(Math.ceil(-Math.log10(step) - 1e-9), 0), 5));
}

// Numbers of the curves that are looked at for their usual range.
const LOOKED_AT = 20_000;

// What is drawn of the curves, with air: of impacts, which would dwarf all else, the part up to the range of 99 % of the numbers. `cut`: the
// lowest and the highest number where they are beyond.
export function range(curves) {
  let [low, high] = [Infinity, -Infinity];
  const some = [];
  const step = Math.max(Math.ceil(curves.reduce((sum, { values }) => sum + values.length, 0) / LOOKED_AT), 1);
  for (const { values } of curves)
    values.forEach((x, k) => {
      if (!Number.isFinite(x)) return;
      [low, high] = [Math.min(low, x), Math.max(high, x)];
      if (k % step === 0) some.push(x);
    });
  if (low > high) return { low: -1, high: 1, cut: [null, null] };
  some.sort((a, b) => a - b);
  const [from, to] = [0.005, 0.995].map((part) => some[Math.round(part * (some.length - 1))]);
  const usual = to - from;
  const cut = [usual > 0 && low < from - 2 * usual ? low : null, usual > 0 && high > to + 2 * usual ? high : null];
  if (cut[0] !== null) low = from - 0.25 * usual;
  if (cut[1] !== null) high = to + 0.25 * usual;
  const air = high > low ? 0.06 * (high - low) : Math.abs(low) * 0.1 || 1;
  return { low: low - air, high: high + air, cut };
}

// Curves that differ by less than a line's width lie on one another: each { curve, on }, `on` the number of curves before that it lies on.
export function merged(curves, size) {
  const kept = [];
  for (const curve of curves) {
    const same = ({ curve: { values } }) => values.every((x, k) => Math.abs(x - curve.values[k]) <= 2e-3 * size);
    kept.push({ curve, on: kept.filter(same).length });
  }
  return kept;
}

// A switch for line patterns in these plots.
export function patternSwitch(plots) {
  const button = document.createElement("button");
  button.append(document.createElement("i"), "line patterns");
  button.title = "Lines differ by dashes, too, for readers who see few colours";
  button.className = "patterns";
  button.setAttribute("aria-pressed", String(Plot.isPatterned));
  button.addEventListener("click", () => {
    Plot.isPatterned = !Plot.isPatterned;
    button.setAttribute("aria-pressed", String(Plot.isPatterned));
    plots().forEach((plot) => plot.redraw());
  });
  return button;
}

export class Plot {
  // Are neighbours told apart by dashes, too?
  static isPatterned = false;

  // `curves`: { name, joint, colour, values }, one value for each time; `joint` is the joint's name, if it is of one. `marks`: { t, colour },
  // events.
  constructor(host, { title, unit, t, curves, seek, legend, marks = [] }) {
    const figure = document.createElement("figure");
    Object.assign(this, { t, legend, marks, figure, hidden: new Set() });
    this.curves = curves.map((curve, index) => Object.assign(curve, { index }));
    figure.className = "plot";
    const caption = figure.appendChild(document.createElement("figcaption"));
    caption.appendChild(document.createElement("b")).textContent = title;
    caption.appendChild(document.createElement("small")).textContent = unit;
    this.readout = caption.appendChild(document.createElement("span"));
    this.readout.className = "values";
    this.canvas = figure.appendChild(document.createElement("canvas"));
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", `${title} over time`);
    host.append(figure);
    this.still = document.createElement("canvas");
    this.time = t[0];
    this.scrub(seek);
    new ResizeObserver(() => this.redraw()).observe(this.canvas);
  }

  scrub(seek) {
    const to = (event) => {
      const { left, width } = this.canvas.getBoundingClientRect();
      const part = (event.clientX - left - MARGIN.left) / (width - MARGIN.left - MARGIN.right);
      seek(this.t[0] + part * (this.t.at(-1) - this.t[0]));
    };
    this.canvas.addEventListener("pointerdown", (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      to(event);
    });
    this.canvas.addEventListener("pointermove", (event) => event.buttons && to(event));
  }

  // The curves of a joint; a plot without any is not shown.
  hide(joint, isHidden) {
    if (isHidden) this.hidden.add(joint);
    else this.hidden.delete(joint);
    this.figure.hidden = this.shown.length === 0;
    this.redraw();
  }

  get shown() {
    return this.curves.filter(({ joint }) => !this.hidden.has(joint));
  }

  // Axes and curves, drawn once for each size, theme and choice.
  redraw() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0) return;
    const scale = Math.min(devicePixelRatio, 2);
    for (const canvas of [this.canvas, this.still]) [canvas.width, canvas.height] = [width * scale, height * scale];
    const draw = this.still.getContext("2d");
    draw.scale(scale, scale);
    const { low, high, cut } = range(this.shown);
    const [start, end] = [this.t[0], this.t.at(-1)];
    const box = { x: MARGIN.left, y: MARGIN.top, w: width - MARGIN.left - MARGIN.right, h: height - MARGIN.top - MARGIN.bottom };
    this.x = (t) => box.x + (end > start ? (t - start) / (end - start) : 0.5) * box.w;
    const y = (value) => box.y + (1 - (value - low) / (high - low)) * box.h;
    draw.font = "10.5px system-ui, sans-serif";
    draw.lineWidth = 1;
    const [up, along] = [ticks(low, high, 3), end > start ? ticks(start, end, Math.max(box.w / 90, 2)) : { list: [start], step: 1 }];
    this.ticks = { up: up.list, along: along.list };
    for (const value of up.list) {
      draw.strokeStyle = colour(Math.abs(value) < 1e-9 * up.step ? "grid-axis" : "line");
      draw.beginPath();
      draw.moveTo(box.x, y(value));
      draw.lineTo(box.x + box.w, y(value));
      draw.stroke();
      draw.fillStyle = colour("muted");
      draw.textAlign = "right";
      draw.textBaseline = "middle";
      draw.fillText(short(value, up.step), box.x - 5, y(value));
    }
    draw.textAlign = "center";
    draw.textBaseline = "alphabetic";
    for (const t of along.list) draw.fillText(short(t, along.step), this.x(t), height - 3);
    draw.save();
    draw.beginPath();
    draw.rect(box.x, box.y - 1, box.w, box.h + 2);
    draw.clip();
    for (const { t, colour: stroke } of this.marks) {
      draw.strokeStyle = stroke;
      draw.globalAlpha = 0.5;
      draw.beginPath();
      draw.moveTo(this.x(t), box.y);
      draw.lineTo(this.x(t), box.y + 0.16 * box.h);
      draw.stroke();
    }
    draw.globalAlpha = 1;
    draw.lineJoin = "round";
    draw.lineWidth = this.shown.length > 12 ? 1 : 1.5;
    // of several on one another the later ones are dashes on the first
    this.merged = this.shown.length <= 40 ? merged(this.shown, high - low) : this.shown.map((curve) => ({ curve, on: 0 }));
    for (const { curve: { values, colour: stroke, index }, on } of this.merged) {
      draw.strokeStyle = stroke;
      draw.setLineDash(on > 0 ? [7, 7 * on] : dashes(index, Plot.isPatterned));
      draw.beginPath();
      this.line(draw, values, y, box.w);
      draw.stroke();
    }
    draw.setLineDash([]);
    draw.restore();
    this.cut = cut;
    cut.forEach((peak, side) => peak !== null && this.peaks(draw, box, side, side === 0 ? low : high, peak));
    this.y = y;
    const letters = this.legend ? Math.max(...this.curves.map(({ name }) => name.length)) : 0;
    this.room = Math.floor(this.readout.clientWidth / (50 + 6 * letters));
    this.cursor(this.time);
  }

  // Where curves leave the picture: a mark at each highest point beyond, and the number of the highest of all.
  peaks(draw, { x, y, w, h }, side, limit, peak) {
    const beyond = (value) => (side === 1 ? value > limit : value < limit);
    const [edge, inside] = side === 1 ? [y, 5] : [y + h, -5];
    let last = -Infinity;
    for (const { values, colour: fill } of this.shown) {
      for (let k = 0; k < values.length; k++) {
        if (!beyond(values[k]) || this.x(this.t[k]) - last < 6) continue;
        last = this.x(this.t[k]);
        draw.fillStyle = fill;
        draw.beginPath();
        draw.moveTo(last, edge);
        draw.lineTo(last - 4, edge + inside);
        draw.lineTo(last + 4, edge + inside);
        draw.fill();
      }
      last = -Infinity;
    }
    draw.fillStyle = colour("text");
    draw.textAlign = "right";
    draw.textBaseline = side === 1 ? "top" : "bottom";
    draw.fillText(`${side === 1 ? "▲" : "▼"} ${short(peak)}`, x + w, edge + 1.4 * inside);
  }

  // Of many points in one column of pixels, the first, the lowest, the highest and the last.
  line(draw, values, y, columns) {
    const [n, bin] = [values.length, Math.ceil(values.length / (2 * columns))];
    for (let k = 0; k < n; k += bin) {
      const last = Math.min(k + bin, n) - 1;
      let picked = [k];
      if (bin > 2) {
        let [low, high] = [k, k];
        for (let i = k; i <= last; i++) {
          if (values[i] < values[low]) low = i;
          if (values[i] > values[high]) high = i;
        }
        picked = [k, Math.min(low, high), Math.max(low, high)];
      }
      if (bin > 1) picked.push(last);
      for (const i of picked) draw.lineTo(this.x(this.t[i]), y(values[i]));
    }
  }

  // `at(values)` is what a curve says at the time.
  cursor(time, at = this.at) {
    [this.time, this.at] = [time, at];
    if (!this.x || !at) return;
    const draw = this.canvas.getContext("2d");
    const scale = this.canvas.width / this.canvas.clientWidth;
    draw.setTransform(1, 0, 0, 1, 0, 0);
    draw.clearRect(0, 0, this.canvas.width, this.canvas.height);
    draw.drawImage(this.still, 0, 0);
    draw.scale(scale, scale);
    draw.strokeStyle = colour("text");
    draw.globalAlpha = 0.55;
    draw.beginPath();
    draw.moveTo(this.x(time), MARGIN.top);
    draw.lineTo(this.x(time), this.canvas.clientHeight - MARGIN.bottom);
    draw.stroke();
    draw.globalAlpha = 1;
    const few = this.shown.length <= 12;
    const said = [];
    for (const { name, values, colour: fill } of this.shown) {
      const value = at(values);
      if (few) {
        draw.fillStyle = fill;
        draw.beginPath();
        draw.arc(this.x(time), this.y(value), 2.8, 0, 2 * Math.PI);
        draw.fill();
      }
      said.push({ name, fill, text: this.legend ? `${name} ${short(value)}` : short(value) });
    }
    this.readout.replaceChildren(...(said.length <= Math.min(this.room, 8) ? said : []).map(({ name, fill, text }) => {
      const span = document.createElement("span");
      span.style.color = fill;
      span.title = name;
      span.textContent = text;
      return span;
    }));
  }
}
