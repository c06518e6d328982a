// M(θ) as a picture: the sign is the hue, the cube root of the size the strength, so that small entries are seen beside large ones.

import { short } from "./plots.js";
import { colour } from "./theme.js";

// More diagonal entries are not listed.
const MOST = 9;

const mixed = (a, b, part) => a.map((x, k) => Math.round(x + part * (b[k] - x)));
const channels = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));

export class MatrixPicture {
  constructor(figure, names, unit) {
    [this.canvas, this.caption] = [figure.querySelector("canvas"), figure.querySelector("figcaption")];
    [this.figure, this.names, this.unit, this.at] = [figure, names, unit, null];
    figure.hidden = false;
    this.canvas.addEventListener("pointermove", (event) => this.look(event));
    this.canvas.addEventListener("pointerdown", (event) => this.look(event));
    this.canvas.addEventListener("pointerleave", () => {
      this.at = null;
      this.say();
    });
  }

  look(event) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const place = (part) => Math.min(Math.max(Math.floor(part * this.names.length), 0), this.names.length - 1);
    this.at = [place((event.clientY - top) / height), place((event.clientX - left) / width)];
    this.say();
  }

  show(M) {
    if (this.figure.hidden) return;
    this.M = M;
    const n = M.length;
    const cell = Math.max(Math.floor(400 / n), 4);
    const size = cell * n;
    if (this.canvas.width !== size) [this.canvas.width, this.canvas.height] = [size, size];
    const draw = this.canvas.getContext("2d");
    const [cold, warm, none] = ["cold", "warm", "none"].map((name) => channels(colour(name)));
    const most = Math.max(...M.flat().map(Math.abs), 1e-300);
    for (let i = 0; i < n; i++)
      for (let j = 0; j < n; j++) {
        const part = Math.cbrt(Math.abs(M[i][j]) / most);
        draw.fillStyle = `rgb(${mixed(none, M[i][j] < 0 ? cold : warm, part)})`;
        draw.fillRect(j * cell, i * cell, cell, cell);
      }
    if (this.canvas.clientWidth > 22 * n) this.numbers(draw, M, cell, most);
    this.say();
  }

  numbers(draw, M, cell, most) {
    draw.textAlign = "center";
    draw.textBaseline = "middle";
    draw.font = `${Math.floor(Math.min(cell / 2.9, 30))}px system-ui, sans-serif`;
    M.forEach((row, i) => row.forEach((value, j) => {
      draw.fillStyle = Math.cbrt(Math.abs(value) / most) > 0.6 ? "#ffffff" : colour("text");
      const text = Math.abs(value) < 0.005 ? "·" : Math.abs(value) < 10 ? value.toFixed(2) : value.toFixed(Math.abs(value) < 100 ? 1 : 0);
      draw.fillText(text.replace("-", "−"), (j + 0.5) * cell, (i + 0.5) * cell);
    }));
  }

  say() {
    if (!this.at || !this.M) {
      // its diagonal: the inertia that each joint moves
      const own = this.names.length <= MOST ? this.names.map((name, k) => `${name}: ${short(this.M?.[k][k] ?? 0)}`) : [`${this.names.length} × ${this.names.length}`];
      this.caption.replaceChildren(...[`M(θ), ${this.unit}`, ...own].map((text) => Object.assign(document.createElement("div"), { textContent: text })));
      return;
    }
    const [i, j] = this.at;
    this.caption.textContent = `M(θ), ${this.unit}: ${this.names[i]}, ${this.names[j]}: ${short(this.M[i][j])}`;
  }
}
