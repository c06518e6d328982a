// The joints: sliders of θ, numbers of θ̇, and buttons that move the end effector or push it.

import { addSliders } from "./sliders.js";

const STEPS = [["−x", -1, 0, 0], ["+x", 1, 0, 0], ["−y", 0, -1, 0], ["+y", 0, 1, 0], ["−z", 0, 0, -1], ["+z", 0, 0, 1]];

export class JointPanel {
  constructor(host, app) {
    Object.assign(this, { host, app });
  }

  take(robot) {
    const { app, host } = this;
    host.replaceChildren();
    this.robot = robot;
    this.addFrame();
    this.theta = [...app.state.theta];
    const sliders = host.appendChild(document.createElement("div"));
    this.setAll = addSliders(sliders, robot, this.theta, (j) => app.stage.jointColour(j), (joint) => !this.isSilent && app.setTheta([...this.theta], joint), (j) => app.stage.point(j));
    this.addVelocities();
  }

  addFrame() {
    const { app, robot, host } = this;
    const row = host.appendChild(document.createElement("div"));
    row.className = "row";
    const label = row.appendChild(document.createElement("label"));
    label.append("End effector ");
    const select = label.appendChild(document.createElement("select"));
    robot.frames.forEach(({ name }, k) => select.append(new Option(name, k)));
    select.value = app.stage.frame;
    select.addEventListener("change", () => app.setFrame(Number(select.value)));
    const keep = row.appendChild(document.createElement("label"));
    const box = keep.appendChild(Object.assign(document.createElement("input"), { type: "checkbox", checked: app.keeps }));
    keep.append(" keep its orientation");
    box.addEventListener("change", () => (app.keeps = box.checked));
    const nudges = host.appendChild(document.createElement("div"));
    nudges.className = "nudges";
    nudges.setAttribute("role", "group");
    nudges.setAttribute("aria-label", "Move the end effector by inverse kinematics; push it while the simulation runs");
    nudges.appendChild(document.createElement("span")).textContent = "tool, 1 cm";
    for (const [text, ...along] of STEPS) {
      const button = nudges.appendChild(document.createElement("button"));
      button.textContent = text;
      button.title = "moves the end effector by inverse kinematics; pushes it while the simulation runs";
      button.addEventListener("click", () => app.nudge(along));
    }
  }

  addVelocities() {
    const { app, robot, host } = this;
    const part = host.appendChild(document.createElement("details"));
    part.className = "quantity";
    part.appendChild(document.createElement("summary")).textContent = "Velocities θ̇";
    const fields = part.appendChild(document.createElement("div"));
    fields.className = "fields";
    this.rates = robot.velocities.map((name, j) => {
      const label = fields.appendChild(document.createElement("label"));
      label.append(name);
      const input = label.appendChild(Object.assign(document.createElement("input"), { type: "number", step: "0.1" }));
      input.addEventListener("change", () => {
        if (!Number.isFinite(input.valueAsNumber)) return;
        const dtheta = [...app.state.dtheta];
        dtheta[j] = input.valueAsNumber;
        app.setRates(dtheta);
      });
      const back = () => (input.value = Number(app.state.dtheta[j].toFixed(4)));
      input.addEventListener("blur", back);
      input.addEventListener("keydown", ({ key }) => key === "Escape" && back());
      return input;
    });
  }

  // The sliders follow the state, or the motors' target where they set it.
  show(theta, dtheta) {
    if (!this.robot || this.host.hidden) return;
    if (!this.host.contains(document.activeElement) || document.activeElement.type !== "range") {
      this.isSilent = true;
      this.setAll(theta);
      this.isSilent = false;
    } else {
      theta.forEach((x, k) => (this.theta[k] = x));
    }
    this.rates.forEach((input, j) => {
      if (input !== document.activeElement) input.value = Number(dtheta[j].toFixed(4));
    });
  }
}
