// The motion since the last reset: rows for plots and for CSV.

import { slidingOf } from "./joints.js";
import { Plot, patternSwitch } from "./plots.js";

const MOST = 60_000;
// Seconds that the plots show.
const SHOWN = 20;

export class Record {
  constructor(host, seek) {
    Object.assign(this, { host, seek, rows: [], plots: [] });
    this.numbers = host.appendChild(document.createElement("dl"));
    this.numbers.className = "energy";
    const chips = host.appendChild(document.createElement("div"));
    chips.className = "chips";
    chips.append(patternSwitch(() => this.plots));
    this.place = host.appendChild(document.createElement("div"));
    this.note = host.appendChild(document.createElement("p"));
    this.note.className = "note";
  }

  clear() {
    this.rows = [];
  }

  add(row) {
    if (this.rows.length > 0 && row.time <= this.rows.at(-1).time) this.rows = this.rows.filter(({ time }) => time < row.time);
    this.rows.push(row);
    if (this.rows.length > MOST) this.rows.splice(0, 1000);
  }

  take(robot, jointColour) {
    this.robot = robot;
    this.clear();
    this.place.replaceChildren();
    const energy = [["kinetic", "#e07b39"], ["potential", "#3b7dd8"], ["total", "#2f9e6e"]];
    const of = (key) => (row) => row[key];
    const sliding = slidingOf(robot);
    const joints = (key, slides) => robot.velocities.map((name, j) => ({ name, j, colour: jointColour(j), of: (row) => row[key][j] })).filter(({ j }) => sliding[j] === slides);
    const kinds = (title, key, units, more = "") => [false, true].map((slides, k) => ({ title, unit: units[k] + more, curves: joints(key, slides) })).filter(({ curves }) => curves.length > 0);
    this.described = [
      { title: "energy", unit: "J", legend: true, curves: energy.map(([name, colour]) => ({ name, colour, of: of(name) })) },
      { title: "drift", unit: "J, energy that the method made", curves: [{ name: "drift", colour: "#c9486a", of: of("drift") }] },
      ...kinds("θ̇", "dtheta", ["rad/s", "m/s"]),
      ...kinds("τ", "tau", ["N m", "N"], ", of the motors"),
    ];
    this.plots = this.described.map(({ title, unit, legend, curves }) =>
      new Plot(this.place, { title, unit, legend, t: [0], curves: curves.map((curve) => ({ ...curve, values: [0] })), seek: this.seek }));
  }

  show() {
    if (this.host.hidden || !this.robot) return;
    const last = this.rows.at(-1);
    if (!last) return;
    const from = this.rows.findIndex(({ time }) => time >= last.time - SHOWN);
    const rows = this.rows.slice(from);
    for (const plot of this.plots) {
      plot.t = rows.map(({ time }) => time);
      for (const curve of plot.curves) curve.values = rows.map(curve.of);
      plot.cursor(last.time, (values) => values.at(-1));
      plot.redraw();
    }
    const terms = [["kinetic energy", last.kinetic], ["potential energy", last.potential], ["total", last.total], ["work of the motors", last.motorWork], ["lost to friction", last.frictionLoss], ["given to the mouse", last.appliedWork], ["drift", last.drift]];
    this.numbers.replaceChildren(...terms.flatMap(([name, value]) => {
      const [dt, dd] = ["dt", "dd"].map((tag) => document.createElement(tag));
      dt.textContent = name;
      dd.textContent = `${value.toPrecision(6).replace("-", "−")} J`;
      return [dt, dd];
    }));
    this.note.textContent = `${last.method}; drag in a plot to go back to a state.`;
  }

  csv(robot) {
    const names = ["t", ...robot.positions.map((_, k) => `theta_${k + 1}`), ...["dtheta", "ddtheta", "tau"].flatMap((name) => robot.velocities.map((_, k) => `${name}_${k + 1}`)), "kinetic_energy", "potential_energy", "motor_work", "friction_loss", "applied_work", "drift"];
    const line = (row) => [row.time, ...row.theta, ...row.dtheta, ...row.ddtheta, ...row.tau, row.kinetic, row.potential, row.motorWork, row.frictionLoss, row.appliedWork, row.drift].join(",");
    return `${[names.join(","), ...this.rows.map(line)].join("\n")}\n`;
  }
}
