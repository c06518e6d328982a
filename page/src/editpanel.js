// Masses, inertias, friction, gravity, pinned frames: each change is a new description, which undo takes back.

import { command } from "./session.js";

const LINK = [["mass", "mass, kg"], ["x", "centre x, m"], ["y", "centre y, m"], ["z", "centre z, m"], ["xx", "I xx, kg m²"], ["xy", "I xy"], ["xz", "I xz"], ["yy", "I yy"], ["yz", "I yz"], ["zz", "I zz"]];
const JOINT = [["damping", "damping d"], ["friction", "dry friction μ"], ["armature", "armature"]];

export class EditPanel {
  constructor(host, app) {
    Object.assign(this, { host, app, link: null, joint: "", scales: true });
  }

  take(robot) {
    this.robot = robot;
    this.isStale = true;
    if (!this.host.hidden) this.show();
  }

  show() {
    if (!this.isStale) return;
    this.isStale = false;
    const { robot, host } = this;
    const now = command(robot, { do: "inertias" });
    host.replaceChildren();
    const heavy = now.links.filter(({ mass }) => mass > 0);
    this.link = now.links.some(({ name }) => name === this.link) ? this.link : (heavy.at(-1) ?? now.links.at(-1))?.name;
    this.heading("Mass and inertia of a link");
    this.choice("Link", now.links.map(({ name }) => [name, name]), this.link, (name) => (this.link = name));
    const link = now.links.find(({ name }) => name === this.link);
    if (link) {
      const values = [link.mass, ...link.center, ...link.inertia];
      this.fields(LINK, values, (entry, value) => ({ what: "link", name: this.link, entry, value, scale: this.scales }));
      const scale = host.appendChild(document.createElement("label"));
      const box = scale.appendChild(Object.assign(document.createElement("input"), { type: "checkbox", checked: this.scales }));
      scale.append(" a new mass scales the inertia");
      box.addEventListener("change", () => (this.scales = box.checked));
      this.note(`The inertia is about the centre of mass, in the link's axes.`);
      if (!link.isPhysical) this.note("No rigid body has this inertia.").classList.add("wrong");
    }
    this.heading("Friction and armature of the joints");
    this.choice("Joint", [["", "all joints"], ...now.joints.map(({ name }) => [name, name])], this.joint, (name) => (this.joint = name));
    const joint = now.joints.find(({ name }) => name === this.joint) ?? now.joints[0];
    if (joint) this.fields(JOINT, JOINT.map(([entry]) => joint[entry]), (entry, value) => ({ what: "joint", name: this.joint || null, entry, value }));
    this.note("d in N m s/rad or N s/m; μ in N m or N: a joint at rest sticks.");
    this.heading("Gravity, m/s²");
    this.fields([["0", "g x"], ["1", "g y"], ["2", "g z"]], now.gravity, (entry, value) => ({ what: "gravity", gravity: now.gravity.map((x, k) => (String(k) === entry ? value : x)) }));
    this.pins(now);
    this.declared();
    const row = host.appendChild(document.createElement("div"));
    row.className = "nudges";
    this.button(row, "Back to the file", () => this.app.revert());
  }

  pins({ pins }) {
    const { robot } = this;
    this.heading("Pinned frames");
    const ends = tips(robot);
    const row = this.host.appendChild(document.createElement("div"));
    row.className = "nudges";
    this.button(row, "Pin the end effector", () => this.app.edit({ what: "pin", frame: this.app.frameName }));
    if (ends.length > 1 && ends.length < 9) this.button(row, "Pin all tips", () => this.app.editAll(ends.filter((name) => !pins.includes(name)).map((frame) => ({ what: "pin", frame }))));
    for (const frame of pins) this.button(row, `Unpin ${frame}`, () => this.app.edit({ what: "unpin", frame }));
    this.note("A pinned frame stays where it is now, welded to the world: feet of a robot that stands.");
  }

  // Arguments of a xacro file: their values make another robot of it.
  declared() {
    if (this.robot.declared.length === 0) return;
    this.heading("Arguments of the xacro file");
    const box = this.host.appendChild(document.createElement("div"));
    box.className = "fields";
    for (const [name, value] of this.robot.declared) {
      const label = box.appendChild(document.createElement("label"));
      label.append(name);
      const input = label.appendChild(Object.assign(document.createElement("input"), { type: "text", value }));
      input.dataset.argument = name;
      input.addEventListener("change", () => this.app.setArgument(name, input.value));
    }
  }

  heading(text) {
    this.host.appendChild(document.createElement("h2")).textContent = text;
  }

  note(text) {
    return Object.assign(this.host.appendChild(document.createElement("p")), { className: "note", textContent: text });
  }

  button(row, text, act) {
    const button = row.appendChild(document.createElement("button"));
    button.textContent = text;
    button.addEventListener("click", act);
  }

  choice(text, options, value, take) {
    const row = this.host.appendChild(document.createElement("div"));
    row.className = "row";
    const label = row.appendChild(document.createElement("label"));
    label.append(`${text} `);
    const select = label.appendChild(document.createElement("select"));
    for (const [name, shown] of options) select.append(new Option(shown, name));
    select.value = value;
    select.addEventListener("change", () => {
      take(select.value);
      this.isStale = true;
      this.show();
    });
  }

  fields(entries, values, editOf) {
    const box = this.host.appendChild(document.createElement("div"));
    box.className = "fields";
    entries.forEach(([entry, text], k) => {
      const label = box.appendChild(document.createElement("label"));
      label.append(text);
      const input = label.appendChild(Object.assign(document.createElement("input"), { type: "number", step: "any", value: values[k] }));
      input.dataset.entry = entry;
      input.addEventListener("change", () => Number.isFinite(input.valueAsNumber) && this.app.edit(editOf(entry, input.valueAsNumber)));
      // a number that is accepted makes new fields; one that is refused goes
      const back = () => (input.value = values[k]);
      input.addEventListener("blur", back);
      input.addEventListener("keydown", ({ key }) => key === "Escape" && back());
    });
  }
}

// Of each body that carries no other, the frame that is farthest out.
function tips(robot) {
  const inner = new Set(robot.bodies.map(({ parent }) => parent));
  const far = ({ p }) => Math.hypot(...p);
  return robot.bodies.flatMap((_, k) => {
    const own = k > 0 && !inner.has(k) ? robot.frames.filter(({ body }) => body === k) : [];
    return own.length > 0 ? [own.reduce((best, frame) => (far(frame) > far(best) ? frame : best)).name] : [];
  });
}
