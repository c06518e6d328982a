// The simulation in real time: as many steps as fit into the time since the last picture.

import { STEP } from "./app.js";
import { command } from "./session.js";

// Seconds that one picture may stand for, and seconds that its steps may take.
const MOST = 0.05;
const BUDGET = 0.03;
// Pictures between two updates of panels and plots.
const EVERY = 6;

export class Loop {
  constructor(app) {
    Object.assign(this, { app, cost: 1e-5, count: 0, times: [] });
  }

  start() {
    [this.before, this.rest] = [performance.now(), 0];
    requestAnimationFrame((now) => this.frame(now));
  }

  frame(now) {
    const { app } = this;
    if (!app.isPlaying) return app.stage.quality.rest();
    app.stage.quality.frame(now - this.before);
    const past = Math.min(Math.max((now - this.before) / 1000, 0), MOST) * app.speed + this.rest;
    this.before = now;
    const wanted = Math.floor(past / STEP);
    const steps = Math.min(wanted, Math.max(Math.floor(BUDGET / this.cost), 1));
    this.rest = steps < wanted ? 0 : past - steps * STEP;
    if (steps > 0) this.advance(steps);
    this.isSlow = steps < wanted;
    return requestAnimationFrame((next) => this.frame(next));
  }

  // Some steps, and what they lead to.
  advance(steps) {
    const { app } = this;
    const began = performance.now();
    const answer = app.attempt(() => command(app.robot, { do: "step", step: STEP, steps, push: app.push }));
    const took = (performance.now() - began) / 1000;
    this.cost = 0.8 * this.cost + 0.2 * (took / steps);
    this.times.push(1000 * took);
    if (this.times.length > 600) this.times.shift();
    if (!answer) return;
    this.count++;
    app.isBetween = this.count % EVERY !== 0;
    app.take(answer);
    app.isBetween = false;
  }
}
