// The torque ellipsoid {Mθ̈ : ‖θ̈‖ = 1} in the plane of two joints' torques: with A, their rows of M, the ellipse {A x : ‖x‖ = 1}.

import { ticks, short } from "./plots.js";
import { colour } from "./theme.js";

const MARGIN = 34;
const CORNERS = 96;

// Semi-axes and the angle of the first, of the symmetric A Aᵀ.
export function ellipseOf(rows) {
  const dot = (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0);
  const [a, b, c] = [dot(rows[0], rows[0]), dot(rows[0], rows[1]), dot(rows[1], rows[1])];
  const [middle, half] = [(a + c) / 2, Math.hypot((a - c) / 2, b)];
  return { axes: [Math.sqrt(middle + half), Math.sqrt(Math.max(middle - half, 0))], angle: Math.atan2(2 * b, a - c) / 2 };
}

export class TorqueEllipse {
  constructor(host) {
    const figure = host.appendChild(document.createElement("figure"));
    figure.className = "torque";
    this.row = figure.appendChild(document.createElement("div"));
    this.row.className = "row";
    this.canvas = figure.appendChild(document.createElement("canvas"));
    this.canvas.setAttribute("role", "img");
    this.caption = figure.appendChild(document.createElement("figcaption"));
  }

  take(robot) {
    this.robot = robot;
    const names = robot.velocities;
    this.row.replaceChildren();
    this.selects = [0, 1].map((first) => {
      const select = this.row.appendChild(document.createElement("select"));
      names.forEach((name, j) => select.append(new Option(name, j)));
      select.value = Math.min(first, names.length - 1);
      select.setAttribute("aria-label", `Joint along the ${first === 0 ? "horizontal" : "vertical"} axis`);
      select.addEventListener("change", () => this.draw());
      return select;
    });
    this.row.hidden = names.length < 3;
  }

  show(robot, theta) {
    if (this.robot !== robot) this.take(robot);
    const M = robot.massMatrix(theta);
    const key = String(M);
    if (key === this.key) return;
    [this.M, this.key] = [M, key];
    this.draw();
  }

  draw() {
    const [i, j] = this.selects.map(({ value }) => Number(value));
    const names = [i, j].map((k) => this.robot.velocities[k]);
    this.ellipse = ellipseOf([this.M[i], this.M[j]]);
    const { axes: [long, wide], angle } = this.ellipse;
    const size = this.canvas.clientWidth || 280;
    const scale = Math.min(devicePixelRatio, 2);
    [this.canvas.width, this.canvas.height] = [size * scale, size * scale];
    const draw = this.canvas.getContext("2d");
    draw.scale(scale, scale);
    const most = 1.15 * Math.max(long, 1e-9);
    const place = (x, y) => [size / 2 + (x / most) * (size / 2 - MARGIN), size / 2 - (y / most) * (size / 2 - MARGIN)];
    draw.font = "11px system-ui, sans-serif";
    draw.fillStyle = colour("muted");
    for (const x of ticks(-most, most, 4).list) {
      const [at, up] = [place(x, 0), place(0, x)];
      draw.strokeStyle = colour(x === 0 ? "grid-axis" : "line");
      draw.strokeRect(at[0], MARGIN, 0, size - 2 * MARGIN);
      draw.strokeRect(MARGIN, up[1], size - 2 * MARGIN, 0);
      draw.textAlign = "center";
      draw.fillText(short(x, most / 4), at[0], size - MARGIN + 14);
      draw.textAlign = "right";
      draw.fillText(short(x, most / 4), MARGIN - 4, up[1] + 4);
    }
    draw.textAlign = "center";
    draw.fillText(`τ of ${names[0]}`, size / 2, size - 4);
    draw.fillText(`τ of ${names[1]}`, size / 2, 12);
    draw.strokeStyle = draw.fillStyle = "#e07b39";
    draw.lineWidth = 2;
    draw.beginPath();
    for (let k = 0; k < CORNERS; k++) {
      const [u, v] = [long * Math.cos((2 * Math.PI * k) / CORNERS), wide * Math.sin((2 * Math.PI * k) / CORNERS)];
      draw.lineTo(...place(u * Math.cos(angle) - v * Math.sin(angle), u * Math.sin(angle) + v * Math.cos(angle)));
    }
    draw.closePath();
    draw.stroke();
    draw.globalAlpha = 0.12;
    draw.fill();
    this.canvas.setAttribute("aria-label", `Torques that accelerate ${names[0]} and ${names[1]} with size 1: an ellipse`);
    this.caption.textContent = `{Mθ̈ : ‖θ̈‖ = 1}: semi-axes ${short(long)} and ${short(wide)}, the long one at ${((angle * 180) / Math.PI).toFixed(0)}° to ${names[0]}`;
  }
}
