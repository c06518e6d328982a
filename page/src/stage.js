// The robot in the scene: shapes, skeleton, overlays, marks of the playground. A robot replaces the last one.

import * as THREE from "three";
import { seriesColour } from "./colours.js";
import { meshesOf } from "./files.js";
import { KINDS, usualKinds } from "./kinds.js";
import { Arrow } from "./marks.js";
import { Overlays } from "./overlays.js";
import { Quality } from "./quality.js";
import { floorHeight } from "./floor.js";
import { Scene } from "./scene.js";
import { addShapes, seeThrough } from "./shapes.js";
import { addSkeleton } from "./skeleton.js";
import { rows } from "./robot.js";
import { scales, showScales } from "./scales.js";
import { fillToggles } from "./toggles.js";
import { add, scaled } from "./vectors.js";

const PUSH = "#d0433f";
const TOUCH = "#4f46e5";

export class Stage {
  constructor(host, toggles) {
    Object.assign(this, { host, toggles, shown: {}, buttons: {}, hasGround: false, layers: { visual: [], collision: [] } });
    this.captions = document.getElementById("scales");
    this.quality = new Quality(this);
  }

  jointColour = (j) => seriesColour(j);

  // Shows a robot, at first without meshes; `meshes` are those of its files. Answers the meshes that are missing, and what reads the others.
  show(robot, meshes, theta) {
    this.robot = robot;
    this.overlays?.remove();
    if (this.scene) this.scene.setRobot(robot);
    else this.scene = new Scene(this.host, robot, { drawn: this.quality.software, scale: this.quality.still });
    this.reach = this.reachOf(theta);
    this.addOverlays();
    this.skeleton = addSkeleton(robot, this.scene, this.reach, this.jointColour, theta);
    this.marks?.forEach((mark) => mark.removeFromParent());
    this.push = new Arrow(PUSH, 0.009 * this.reach);
    this.touches = [];
    this.marks = [this.push];
    this.scene.world.add(this.push);
    this.push.visible = false;
    const found = meshesOf(robot.shapes, meshes);
    const { layers, waiting, load } = addShapes({ ...robot, shapes: found.shapes }, found.meshes, this.scene);
    Object.assign(this, { layers, waiting, missing: found.missing.length });
    this.addToggles();
    const read = async (onRead) => {
      const failures = await load(onRead, () => this.robot === robot);
      if (this.robot !== robot) return [];
      this.waiting = 0;
      this.addToggles();
      return failures;
    };
    return { missing: found.missing, read };
  }

  // An edit that leaves joints and frames where they are: shapes stay.
  replace(robot) {
    this.overlays.remove();
    this.robot = robot;
    this.addOverlays();
    this.setFrame(this.frame);
    this.addToggles(Object.keys(KINDS).filter((kind) => this.shown[kind]));
  }

  reachOf(theta) {
    const T = this.robot.bodyPoses(this.robot.poses(theta));
    const far = T.map(({ p }) => Math.hypot(...p.map((x, i) => x - T[0].p[i])));
    const frames = this.robot.frames.map(({ body, p }) => far[body] + Math.hypot(...p));
    return Math.max(...far, ...frames, 0.05);
  }

  // Of what is there: shapes, and the skeleton where it stands for missing ones.
  get bounds() {
    return this.scene.bounds([...this.shapes, ...(this.shown.skeleton || this.shapes.length === 0 ? this.skeleton : [])]);
  }

  // What the pointer can be on.
  get parts() {
    return [...(this.shown.shapes ? this.shapes : []), ...(this.shown.skeleton ? this.skeleton : [])];
  }

  get shapes() {
    return [...this.layers.visual, ...this.layers.collision];
  }

  // `kept`: what is shown now, by an edit.
  addToggles(kept = null) {
    const { robot, toggles } = this;
    // with loops also what they carry would have to be known
    const possible = { wrenches: robot.constraints.length === 0, shapes: this.shapes.length > 0, glass: this.shapes.length > 0, constraints: robot.constraints.length > 0, contacts: this.hasGround, applied: this.hasGround, path: false, mass: false };
    const usual = usualKinds(robot, possible.shapes && this.waiting === 0 && this.missing === 0, possible.shapes);
    this.buttons = fillToggles(toggles, (kind) => possible[kind] !== false, (kind) => this.toggle(kind, !this.shown[kind]));
    const chosen = kept ?? (this.chosen && (possible.shapes || this.chosen.includes("skeleton")) && this.waiting + this.missing === 0 ? this.chosen : usual);
    for (const kind of Object.keys(KINDS)) this.toggle(kind, chosen.includes(kind) && possible[kind] !== false, false);
  }

  toggle(kind, isOn, isChosen = true) {
    this.shown[kind] = isOn;
    this.buttons[kind]?.setAttribute("aria-pressed", String(isOn));
    if (kind === "shapes") this.shapes.forEach((holder) => (holder.visible = isOn));
    else if (kind === "glass") seeThrough(this.shapes, isOn);
    else if (kind === "skeleton") this.skeleton.forEach((part) => (part.visible = isOn));
    else if (this.overlays.layers[kind]) this.overlays.show(kind, isOn);
    if (isChosen) {
      this.chosen = Object.keys(KINDS).filter((kind) => this.shown[kind]);
      this.last && this.place(this.last);
    }
  }

  setFrame(index) {
    this.frame = index;
    this.overlays.setFrame(index, null);
  }

  // Everything at a state { theta, dtheta, ddtheta }, with the touches and the push of a simulation.
  place(state) {
    this.last = state;
    const T = this.robot.poses(state.theta);
    this.scene.place(T, this.robot.bodyPoses(T));
    this.applied(state);
    this.measure({ ...state, tip: null, loops: this.loops(state), touch: null });
    this.push.visible = false;
    if (state.push) this.push.set(add(state.push.p, scaled(state.push.f, -this.lengthOf(state.push.f))), scaled(state.push.f, this.lengthOf(state.push.f)));
    this.placeTouches(this.shown.contacts ? state.touches ?? [] : []);
    showScales(this.captions, scales(this.overlays, this.shown, this.lengthOf([1])));
  }

  // The wrenches that the robot applies: to the ground, and to the mouse.
  applied({ touches = [], push = null }) {
    const list = touches.map(({ frame }) => ({ frame, as: "point" }));
    if (push) list.push({ frame: push.frame, as: "point" });
    const key = JSON.stringify(list);
    if (this.appliedBy !== key) [this.appliedBy, this.apply] = [key, this.robot.applying(list)];
    this.apply([...touches.flatMap(({ p, f }) => [...p, ...f]), ...(push ? [...push.p, ...scaled(push.f, -1)] : [])]);
  }

  // The wrenches that constraints carry, after what is applied is set.
  loops({ theta, dtheta, ddtheta, tau }) {
    if (!this.shown.constraints || !ddtheta || !tau) return null;
    const { moment, force } = this.robot.compute({ quantity: "constraint_wrenches" }, { theta, dtheta, ddtheta, tau });
    return rows(moment, 3).flatMap((m, k) => [...m, ...force.slice(3 * k, 3 * k + 3)]);
  }

  // Arrows by the longest so far.
  measure(state) {
    if (this.shown.twists || this.shown.wrenches || this.shown.constraints) {
      const before = { ...this.overlays.longest };
      this.overlays.measure([state]);
      for (const [kind, size] of Object.entries(before)) this.overlays.longest[kind] = Math.max(0.98 * size, this.overlays.longest[kind]);
    }
    this.overlays.update(state);
  }

  // The overlays of a robot; what it applies is set here.
  addOverlays() {
    this.overlays = new Overlays(this.robot, this.scene, this.reach, this.jointColour, null);
    this.overlays.apply = () => {};
    this.overlays.longest = { carried: 0, spin: 0, speed: 0, moment: 0, force: 0 };
    this.appliedBy = null;
  }

  // Metres for a newton: the robot's weight is drawn half as long as the robot.
  lengthOf(f) {
    const size = Math.hypot(...f);
    return size > 0 ? Math.min((0.5 * this.reach) / Math.max(this.weight, 1e-9), this.reach / size) : 0;
  }

  placeTouches(touches) {
    while (this.touches.length < touches.length) {
      const arrow = new Arrow(TOUCH, 0.006 * this.reach);
      this.scene.world.add(arrow);
      this.touches.push(arrow);
      this.marks.push(arrow);
    }
    this.touches.forEach((arrow, k) => {
      if (k < touches.length) arrow.set(touches[k].p, scaled(touches[k].f, (this.shown.applied ? 1 : -1) * this.lengthOf(touches[k].f)));
      else arrow.visible = false;
    });
  }

  // The axes of some velocities, drawn thick: those that an entry of a matrix is about.
  point(velocities) {
    this.overlays.point(velocities);
  }

  look() {
    const box = this.bounds;
    const { min, max } = box;
    const points = box.isEmpty() ? [] : [0, 1, 2, 3, 4, 5, 6, 7].map((k) => new THREE.Vector3(k & 1 ? max.x : min.x, k & 2 ? max.y : min.y, k & 4 ? max.z : min.z));
    for (const frame of this.scene.frames) points.push(new THREE.Vector3().setFromMatrixPosition(frame.matrixWorld));
    if (new THREE.Box3().setFromPoints(points).getSize(new THREE.Vector3()).length() < 0.1 * this.reach)
      for (const sign of [-1, 1]) points.push(new THREE.Vector3(sign * this.reach, sign * this.reach, sign * this.reach));
    this.scene.fit(points);
  }

  // The ground of the simulation is z = 0; without it the floor is below the robot. Contacts can be shown where there is ground.
  ground(isReal) {
    if (this.hasGround !== isReal) {
      this.hasGround = isReal;
      this.addToggles(Object.keys(KINDS).filter((kind) => this.shown[kind] || (isReal && kind === "contacts")));
      if (this.last) this.place(this.last);
    }
    this.scene.ground(this.reach, [{ height: isReal ? 0 : floorHeight(this.robot, this.bounds.min.z, this.reach) }]);
  }
}
