// The playground: one robot at a state, with what changes it. Panels and the scene show it.

import { aboutRobot, counted } from "./words.js";
import { History } from "./history.js";
import { linkOf } from "./share.js";
import { alike, farthest } from "./robot.js";
import { closeRobot, command, openRobot, read } from "./session.js";

// Seconds of a step.
export const STEP = 0.001;
const STATE = ["theta", "dtheta", "ddtheta", "tau"];

export class App {
  constructor(library, stage, find, friction) {
    Object.assign(this, { library, stage, find, friction, robot: null, isPlaying: false, push: null, keeps: false, speed: 1, panels: [], last: null });
    this.settings = { motors: "off", omega: 8, zeta: 1, ground: null };
    this.history = new History(find("undo"), find("redo"), {
      now: () => ({ entry: this.entry, values: this.values, description: this.description, theta: [...this.state.theta], dtheta: [...this.state.dtheta] }),
      restore: (state) => this.restore(state),
    });
  }

  get frameName() {
    return this.robot.frames[this.stage.frame].name;
  }

  get grabs() {
    return this.find("grab").value;
  }

  // Do the motors have a target?
  get hasTarget() {
    return ["pd", "computed-torque"].includes(this.settings.motors);
  }

  get isEdited() {
    return this.description !== null && JSON.stringify(this.description) !== this.original;
  }

  // Does it neither move nor begin to?
  get isResting() {
    const { dtheta, ddtheta } = this.state;
    return this.settings.motors === "off" && [...dtheta, ...(ddtheta ?? [])].every((x) => Math.abs(x) < 1e-6);
  }

  // Is the only edit that the base was freed?
  get isJustFreed() {
    return this.description !== null && JSON.stringify(this.description) === this.freed;
  }

  // What went wrong, in the place of diagnostics; the last robot stays.
  trouble(title, text) {
    const box = this.find("trouble");
    box.hidden = false;
    box.querySelector("strong").textContent = title;
    box.querySelector("pre").textContent = text;
    this.say(title);
  }

  clearTrouble() {
    this.find("trouble").hidden = true;
  }

  attempt(act) {
    try {
      const result = act();
      this.clearTrouble();
      return result;
    } catch (error) {
      this.pause();
      this.trouble("This does not work here", error.message);
      return null;
    }
  }

  say(text) {
    this.find("about").textContent = text;
  }

  // Opens the robot of an entry, { name, files, file, meshes }, at its start or at a state, with values of xacro's arguments. False if
  // its files are wrong.
  async open(entry, { description = null, theta = null, dtheta = null, values = entry === this.entry ? this.values : {}, isNew = false } = {}) {
    this.pause();
    let robot;
    try {
      robot = openRobot(this.library, { file: entry.file, files: entry.files, arguments: values, description: description ?? entry.description ?? null });
    } catch (error) {
      this.trouble(`${entry.name} cannot be opened; the last robot stays`, error.message);
      return false;
    }
    this.clearTrouble();
    this.original = this.entry === entry && this.original && description ? this.original : JSON.stringify(robot.description);
    this.settings.target = null;
    const last = this.robot;
    const isAlike = !isNew && last && this.entry === entry && this.values === values && alike(last, robot);
    // edits keep the arguments of their file
    robot.declared ??= this.entry === entry && this.values === values ? last.declared : [];
    Object.assign(this, { robot, entry, values, description: description ?? null });
    const fits = theta?.length === robot.nq && dtheta?.length === robot.n;
    const start = entry.theta?.length === robot.nq ? entry.theta : robot.start;
    this.state = { time: 0, theta: fits ? theta : [...start], dtheta: fits ? dtheta : new Array(robot.n).fill(0) };
    robot.set("theta", this.state.theta);
    robot.set("dtheta", this.state.dtheta);
    for (const name of ["x", "w"]) if (robot.inputs.some((input) => input.name === name)) robot.set(name, new Array(robot.inputs.find((input) => input.name === name).length).fill(1));
    // a start beyond limits, or that breaks the constraints, is put right
    if (!fits) command(robot, { do: "within" });
    if (robot.constraints.length > 0 && !fits) this.quietly(() => command(robot, { do: "close" }));
    this.state.theta = read(robot, "theta");
    this.begin = { theta: [...this.state.theta], dtheta: [...this.state.dtheta] };
    const mass = command(robot, { do: "inertias" }).links.reduce((sum, { mass }) => sum + mass, 0);
    this.stage.weight = 9.81 * mass;
    let meshes = null;
    if (isAlike) {
      robot.shapes = last.shapes;
      this.stage.replace(robot);
      this.omitted = this.omitted ?? [];
    } else {
      meshes = this.stage.show(robot, entry.meshes ?? [], this.state.theta);
      this.omitted = [...robot.notes, ...meshes.missing];
      this.stage.setFrame(robot.endEffector ?? farthest(robot));
    }
    if (last) closeRobot(last);
    if (this.settings.motors === "computed-torque" && robot.isFloating) this.settings.motors = "off";
    this.showControls();
    this.apply({ reset: true });
    this.panels.forEach((panel) => panel.take(robot));
    this.refresh();
    if (!isAlike) this.stage.look();
    this.stage.ground(this.settings.ground !== null);
    this.say(`${aboutRobot(robot, mass)}${robot.warnings.length > 0 ? `; ${counted(robot.warnings.length, "warning", "warnings")}: see ?` : ""}`);
    this.stage.scene.drawNow();
    this.firstPicture ??= performance.now();
    if (meshes) await this.readMeshes(meshes);
    this.note();
    return true;
  }

  // After the first picture: the meshes, and the view of all of them.
  async readMeshes({ read }) {
    const { robot } = this;
    const failures = await read((count, all) => this.robot === robot && this.note(`${count} of ${all} meshes`));
    if (this.robot !== robot) return;
    this.omitted.push(...failures);
    this.draw();
    this.stage.look();
    this.stage.ground(this.settings.ground !== null);
  }

  // Below the scene: how far the meshes are, or what is missing; shapes that the ground does not touch are drawn all the same.
  note(progress = "") {
    const { find, stage, robot, omitted } = this;
    const others = omitted.length - stage.missing - omitted.filter((note) => robot.notes.includes(note)).length;
    const lost = stage.missing > 0 ? `${counted(stage.missing, "mesh was", "meshes were")} not found` : "";
    find("hint").textContent = progress || lost || (others > 0 ? `${counted(others, "shape was", "shapes were")} left out: see ?` : "");
    find("missing").hidden = progress !== "" || lost === "";
    this.fillNotes?.();
  }

  quietly(act) {
    try {
      return act();
    } catch {
      return null;
    }
  }

  showControls() {
    const { find, settings, robot } = this;
    find("motors").value = settings.motors;
    find("motors").querySelector('[value="computed-torque"]').disabled = robot.isFloating;
    find("omega").value = settings.omega;
    find("omega-value").textContent = `${settings.omega} rad/s`;
    find("stiffness").hidden = !this.hasTarget;
    find("ground").checked = settings.ground !== null;
    find("floating").checked = robot.isFloating;
  }

  // Sends the settings to the robot; the target is where it is if there is none.
  apply(more = {}) {
    const { motors, omega, zeta, ground } = this.settings;
    if (!this.settings.target) this.settings.target = [...this.state.theta];
    this.attempt(() => command(this.robot, { do: "set", motors, omega, zeta, ground, target: this.settings.target, ...more }));
  }

  // Energies, θ̈ and τ at the state, and everything that shows it.
  refresh() {
    const answer = this.quietly(() => command(this.robot, { do: "step", step: STEP, steps: 0 }));
    this.take(answer ?? {});
  }

  // The state after a command, and its account.
  take(answer) {
    for (const name of STATE) this.state[name] = read(this.robot, name);
    Object.assign(this.state, { touches: [], push: null }, answer);
    if (this.state.push) this.state.push.frame = this.push?.frame ?? this.frameName;
    if (answer.time !== undefined) this.record.add(structuredClone(this.state));
    this.draw();
  }

  draw() {
    this.quietly(() => this.stage.place(this.state));
    this.find("clock").textContent = `${this.state.time.toFixed(3)} s`;
    this.panels.forEach((panel) => panel.update?.());
  }

  // A change of the state by hand: the motors then hold the new state.
  changed() {
    this.apply();
    this.refresh();
  }

  remember() {
    this.history.remember();
  }

  // Of the sliders: the state, or while the motors have a target and the simulation runs, the target.
  setTheta(theta, joint) {
    if (this.isPlaying && this.hasTarget) {
      this.settings.target = theta;
      return this.apply();
    }
    this.rememberOnce();
    this.robot.set("theta", theta);
    if (this.robot.constraints.length > 0) {
      const hold = joint ? { hold: joint.name } : {};
      const closed = this.quietly(() => command(this.robot, { do: "close", ...hold })) ?? this.quietly(() => command(this.robot, { do: "close" }));
      if (closed === null && !this.closes()) this.robot.set("theta", this.state.theta);
    }
    this.settings.target = read(this.robot, "theta");
    return this.changed();
  }

  closes() {
    const found = this.quietly(() => this.robot.compute({ quantity: "constraint_residual" })) ?? {};
    return Object.values(found).flat().every((x) => Math.abs(x) < 1e-9);
  }

  // One step of undo for a series of changes.
  rememberOnce() {
    clearTimeout(this.pending);
    if (!this.isChanging) this.remember();
    this.isChanging = true;
    this.pending = setTimeout(() => (this.isChanging = false), 600);
  }

  setRates(dtheta) {
    this.remember();
    this.robot.set("dtheta", dtheta);
    if (this.robot.constraints.length > 0) this.attempt(() => command(this.robot, { do: "close" }));
    this.changed();
  }

  endPoint() {
    const { T } = this.robot.compute({ quantity: "forward_kinematics", frame: this.frameName }, { theta: this.state.theta });
    return [T[3], T[7], T[11]];
  }

  reach(goal) {
    this.quietly(() => command(this.robot, { do: "reach", frame: this.frameName, goal, keep: this.keeps }));
    this.settings.target = read(this.robot, "theta");
    this.changed();
  }

  // The motors' target by inverse kinematics, from the last target; the state stays.
  reachTarget(goal) {
    this.robot.set("theta", this.settings.target);
    this.quietly(() => command(this.robot, { do: "reach", frame: this.frameName, goal, keep: this.keeps }));
    this.settings.target = read(this.robot, "theta");
    this.robot.set("theta", this.state.theta);
    this.apply();
  }

  drag(held) {
    this.quietly(() => command(this.robot, { do: "drag", ...held }));
    this.settings.target = read(this.robot, "theta");
    this.changed();
  }

  // A centimetre by inverse kinematics; while the simulation runs, a push of a fifth of a second.
  nudge(along) {
    const at = this.endPoint();
    const moved = (by) => at.map((x, k) => x + by * along[k]);
    if (!this.isPlaying) {
      this.rememberOnce();
      return this.reach(moved(0.01));
    }
    this.push = { frame: this.frameName, point: [0, 0, 0], goal: moved(0.3 * this.stage.reach) };
    return setTimeout(() => (this.push = null), 200);
  }

  setFrame(index) {
    this.stage.setFrame(index);
    this.draw();
  }

  // An edit of the description; the state stays if it still fits.
  async edit(change) {
    return this.editAll([change]);
  }

  async editAll(changes) {
    this.remember();
    const { theta, dtheta } = this.state;
    for (const change of changes) {
      const description = this.attempt(() => command(this.robot, { do: "edit", ...change }));
      if (!description) return;
      if (change.what === "floating" && !this.isEdited) this.freed = JSON.stringify(description);
      await this.open(this.entry, { description, ...this.converted(change, theta, dtheta) });
    }
  }

  // A state of the robot with another base.
  converted({ what }, theta, dtheta) {
    if (what === "floating") return { theta: [1, 0, 0, 0, 0, 0, 0, ...theta], dtheta: [0, 0, 0, 0, 0, 0, ...dtheta] };
    if (what === "fixed") return { theta: theta.slice(7), dtheta: dtheta.slice(6) };
    return { theta, dtheta };
  }

  async revert() {
    this.remember();
    await this.open(this.entry, { values: {} });
  }

  // Another value of an argument of xacro.
  async setArgument(name, value) {
    this.remember();
    await this.open(this.entry, { values: { ...this.values, [name]: value } });
  }

  async restore({ entry, values, description, theta, dtheta }) {
    if (entry === this.entry && values === this.values && description === this.description) {
      this.pause();
      this.robot.set("theta", theta);
      this.robot.set("dtheta", dtheta);
      this.settings.target = [...theta];
      this.changed();
    } else {
      await this.open(entry, { values, description, theta, dtheta });
      this.onEntry?.();
    }
  }

  seek(time) {
    this.pause();
    const row = this.record.rows.findLast((row) => row.time <= time) ?? this.record.rows[0];
    if (!row) return;
    this.robot.set("theta", row.theta);
    this.robot.set("dtheta", row.dtheta);
    this.state = structuredClone(row);
    this.settings.target = [...row.theta];
    this.apply({ account: row });
    this.draw();
  }

  reset() {
    this.pause();
    this.remember();
    this.robot.set("theta", this.begin.theta);
    this.robot.set("dtheta", this.begin.dtheta);
    this.state = { time: 0, theta: [...this.begin.theta], dtheta: [...this.begin.dtheta] };
    this.settings.target = null;
    this.record.clear();
    this.apply({ reset: true });
    this.refresh();
  }

  // Puts the ground at z = 0, and a floating base onto it.
  setGround(isOn) {
    this.settings.ground = isOn ? { friction: this.friction, restitution: 0 } : null;
    if (isOn && this.robot.isFloating) {
      this.remember();
      this.attempt(() => command(this.robot, { do: "settle" }));
      this.settings.target = read(this.robot, "theta");
      this.state.theta = read(this.robot, "theta");
      this.begin.theta = [...this.state.theta];
    }
    this.changed();
    this.stage.ground(isOn);
  }

  play() {
    if (this.isPlaying) return;
    if (this.state.time === 0) this.begin = { theta: [...this.state.theta], dtheta: [...this.state.dtheta] };
    this.remember();
    this.isPlaying = true;
    if (this.isResting) this.say("The robot is at rest and stays so: drag it, or move a joint.");
    this.loop.start();
    this.showPlaying();
  }

  pause() {
    if (!this.isPlaying) return;
    this.isPlaying = false;
    this.push = null;
    this.showPlaying();
    this.draw();
  }

  showPlaying() {
    const button = this.find("play");
    button.classList.toggle("playing", this.isPlaying);
    button.setAttribute("aria-label", this.isPlaying ? "Pause" : "Play");
  }

  async share() {
    const { entry, state, settings } = this;
    const robot = entry.isDropped ? { name: entry.name, file: entry.file, files: entry.files } : { name: entry.name };
    const link = await linkOf({ robot, values: this.values, description: this.description, theta: state.theta, dtheta: state.dtheta, settings, frame: this.stage.frame, ...(this.lesson ? { answers: this.lesson.given } : {}) });
    history.replaceState(null, "", link);
    await this.copy(link, entry.isDropped && entry.meshes.length > 0 ? "The link is copied; meshes are not in it." : "The link is copied.");
    return link;
  }

  async copy(text, said) {
    try {
      await navigator.clipboard.writeText(text);
      this.say(said);
    } catch {
      this.say("This browser does not let the page copy; the link is in the address line.");
    }
  }

  save(name, text, type) {
    const link = document.createElement("a");
    link.download = name;
    link.href = type ? URL.createObjectURL(new Blob([text], { type })) : text;
    link.click();
    this.saved = { name, text };
  }

  savePicture() {
    this.save(`${this.robot.name}.png`, this.stage.scene.picture());
  }
}
