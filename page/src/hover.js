// The link under the pointer: its name, its joint, and the joint's axis.

import { velocitiesOf } from "./joints.js";
import { Picker } from "./pick.js";

export class Hover {
  constructor(view) {
    Object.assign(this, { view, picker: new Picker(view) });
    this.tag = view.host.appendChild(document.createElement("div"));
    Object.assign(this.tag, { id: "tag", hidden: true });
    const { canvas } = this.picker;
    canvas.addEventListener("pointermove", (event) => this.later(event));
    canvas.addEventListener("pointerleave", () => this.at(null));
  }

  // Once for each picture.
  later(event) {
    const isPending = Boolean(this.event);
    this.event = event;
    if (isPending) return;
    requestAnimationFrame(() => {
      const { event } = this;
      this.event = null;
      if (event.buttons > 0) return this.at(null);
      this.picker.aim(event);
      return this.at(this.picker.hit()?.body ?? null, event);
    });
  }

  at(body, event) {
    const { view, tag } = this;
    tag.hidden = body === null;
    if (body === null) return view.overlays.point([]);
    const { name, joint, j } = view.robot.bodies[body];
    tag.textContent = joint ? `${joint}, ${name}` : name;
    const { left, top, width } = view.host.getBoundingClientRect();
    tag.style.left = `${Math.min(event.clientX - left + 14, Math.max(width - 12 - tag.offsetWidth, 0))}px`;
    tag.style.top = `${event.clientY - top + 16}px`;
    return view.overlays.point(joint ? Array.from({ length: velocitiesOf(view.robot.bodies[body]) }, (_, k) => j + k) : []);
  }
}
