// The lines that compute the same, and the files of this robot and its motion.

import { LANGUAGES, codeOf, jsonOf } from "./code.js";
import { command, read } from "./session.js";

export class CodePanel {
  constructor(host, app) {
    Object.assign(this, { host, app });
    const row = host.appendChild(document.createElement("div"));
    row.className = "row";
    this.language = this.select(row, "Language ");
    for (const [name, text] of Object.entries(LANGUAGES)) this.language.append(new Option(text, name));
    this.quantity = this.select(row, "Quantity ");
    for (const select of [this.language, this.quantity]) select.addEventListener("change", () => this.update());
    this.code = host.appendChild(document.createElement("pre"));
    Object.assign(this.code, { className: "code", tabIndex: 0 });
    const buttons = host.appendChild(document.createElement("div"));
    buttons.className = "nudges";
    this.button(buttons, "Copy", () => app.copy(this.code.textContent, "The lines are copied."));
    host.appendChild(document.createElement("h2")).textContent = "Save";
    const files = host.appendChild(document.createElement("div"));
    files.className = "nudges";
    this.button(files, "Motion as CSV", () => app.save(`${app.robot.name}.csv`, app.record.csv(app.robot), "text/csv"));
    this.button(files, "Robot as URDF", () => this.urdf());
    this.button(files, "Robot as JSON", () => app.save(jsonOf(app.robot), command(app.robot, { do: "json" }).text, "application/json"));
    this.button(files, "Picture", () => app.savePicture());
    this.note = host.appendChild(document.createElement("p"));
    this.note.className = "note";
  }

  select(row, text) {
    const label = row.appendChild(document.createElement("label"));
    label.append(text);
    return label.appendChild(document.createElement("select"));
  }

  button(row, text, act) {
    const button = row.appendChild(document.createElement("button"));
    button.textContent = text;
    button.addEventListener("click", act);
  }

  urdf() {
    const { app } = this;
    app.attempt(() => {
      const { text, leftOut } = command(app.robot, { do: "urdf" });
      app.save(`${app.robot.name}.urdf`, text, "application/xml");
      this.note.textContent = leftOut.length > 0 ? `URDF cannot express ${leftOut.join(", ")}; JSON can.` : "";
    });
  }

  take(robot) {
    this.robot = robot;
    this.note.textContent = "";
    const before = this.quantity.value;
    // those of pictures are no part of the library's list
    this.listed = robot.quantities.filter(({ outputs }) => outputs);
    this.quantity.replaceChildren(...this.listed.map(({ name }) => new Option(name.replaceAll("_", " "), name)));
    this.quantity.value = this.listed.some(({ name }) => name === before) ? before : "mass_matrix";
    this.update();
  }

  update() {
    if (!this.robot || this.host.hidden) return;
    const { app, robot } = this;
    if (app.last?.outputs && app.last !== this.seen) this.quantity.value = (this.seen = app.last).name;
    const quantity = this.listed.find(({ name }) => name === this.quantity.value);
    let outputs = [];
    try {
      outputs = robot.prepared(JSON.stringify(app.quantities.request(quantity))).outputs;
    } catch {
      outputs = quantity.outputs.map((name) => ({ name, shape: [] }));
    }
    const { entry } = app;
    const hasFile = entry.isEmbedded || entry.isAsFile || (entry.isDropped && !entry.isLinked);
    const isSaved = !hasFile || (app.isEdited && !app.isJustFreed) || Object.keys(app.values).length > 0;
    this.code.textContent = codeOf(this.language.value, {
      robot: isSaved ? jsonOf(robot) : entry.isEmbedded ? entry.name : entry.file.split("/").pop(),
      isSaved,
      isFloating: !isSaved && robot.isFloating && app.isJustFreed,
      quantity, outputs, frame: app.frameName,
      inputs: quantity.inputs.map((name) => [name, read(robot, name)]),
    });
  }
}
