// A lesson beside the robot: prose, poses, questions whose answers the library checks, and the torque ellipsoid.

import { read } from "./session.js";
import { TorqueEllipse } from "./torque.js";

// An answer this near to the library's number is right: of its size, and of 1.
const SHARE = 0.01;
const LEAST = 0.005;

export class Lesson {
  // `given`: the answers so far, by the number of the part.
  constructor(host, app, lesson, given = {}) {
    Object.assign(this, { host, app, lesson, given: { ...given }, ellipses: [] });
    host.appendChild(document.createElement("h2")).textContent = lesson.title;
    this.score = Object.assign(document.createElement("p"), { className: "note" });
    this.score.setAttribute("role", "status");
    lesson.parts.forEach((part, k) => this.add(part, k));
    host.append(this.score);
    this.right = new Set();
  }

  // After the robot is there.
  start() {
    this.lesson.parts.forEach((part, k) => k in this.given && this.answered[k]?.(this.given[k]));
    this.count();
  }

  update() {
    if (!this.host.hidden) this.ellipses.forEach((ellipse) => ellipse.show(this.app.robot, this.app.state.theta));
  }

  add(part, k) {
    if (part.text) this.host.appendChild(document.createElement("p")).textContent = part.text;
    if (part.pose) this.pose(part);
    if (part.ellipsoid) this.ellipses.push(new TorqueEllipse(this.host));
    if (part.ask) this.ask(part, k);
    if (part.choose) this.choose(part, k);
  }

  pose({ pose, theta, dtheta }) {
    const button = this.host.appendChild(document.createElement("button"));
    Object.assign(button, { className: "text", textContent: pose });
    button.addEventListener("click", () => {
      const { app } = this;
      app.pause();
      app.remember();
      if (theta) app.robot.set("theta", theta);
      if (dtheta) app.robot.set("dtheta", dtheta);
      app.settings.target = read(app.robot, "theta");
      app.changed();
    });
  }

  question(text) {
    const box = this.host.appendChild(document.createElement("fieldset"));
    box.className = "question";
    box.appendChild(document.createElement("legend")).textContent = text;
    const said = document.createElement("p");
    said.setAttribute("role", "status");
    return { box, said };
  }

  get answered() {
    return (this.checks ??= {});
  }

  ask({ ask, unit, answer, because }, k) {
    const { box, said } = this.question(ask);
    const form = box.appendChild(document.createElement("form"));
    form.className = "row";
    const input = form.appendChild(Object.assign(document.createElement("input"), { type: "text", inputMode: "decimal", autocomplete: "off" }));
    input.setAttribute("aria-label", `${ask} In ${unit}`);
    form.append(unit);
    form.appendChild(document.createElement("button")).textContent = "Check";
    box.append(said);
    this.answered[k] = (text) => {
      input.value = text;
      const [found, expected] = [Number(text.replace("−", "-").replace(",", ".")), this.expected(answer)];
      if (text.trim() === "" || !Number.isFinite(found)) return this.say(said, k, null, `“${text}” is no number.`);
      const isRight = Math.abs(found - expected) <= Math.max(SHARE * Math.abs(expected), LEAST);
      return this.say(said, k, isRight, isRight ? `Right, ${Number(expected.toPrecision(4))} ${unit}. ${because}` : "Not yet.");
    };
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.given[k] = input.value;
      this.answered[k](input.value);
    });
  }

  choose({ choose, options, right, because }, k) {
    const { box, said } = this.question(choose);
    const buttons = options.map((option, i) => {
      const label = box.appendChild(document.createElement("label"));
      const button = label.appendChild(Object.assign(document.createElement("input"), { type: "radio", name: `question-${k}` }));
      label.append(` ${option}`);
      button.addEventListener("change", () => this.answered[k]((this.given[k] = i)));
      return button;
    });
    box.append(said);
    this.answered[k] = (i) => {
      if (buttons[i]) buttons[i].checked = true;
      this.say(said, k, i === right, i === right ? `Right. ${because}` : "Not yet.");
    };
  }

  // The library's number, for the robot as it is; the state stays.
  expected({ quantity, frame, output, index, inputs }) {
    const { robot } = this.app;
    const before = Object.keys(inputs).map((name) => [name, read(robot, name)]);
    const found = robot.compute(frame ? { quantity, frame } : { quantity }, inputs)[output][index];
    before.forEach(([name, numbers]) => robot.set(name, numbers));
    return found;
  }

  say(said, k, isRight, text) {
    said.textContent = text;
    said.className = isRight ? "right" : "wrong";
    if (isRight) this.right.add(k);
    else this.right.delete(k);
    this.count();
  }

  count() {
    const all = Object.keys(this.answered).length;
    this.score.textContent = this.right.size === all ? `All ${all} answers are right.` : `${this.right.size} of ${all} answers are right.`;
  }
}
