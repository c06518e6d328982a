// The pointer on the robot: drags a joint or the end effector while the simulation is paused, pushes while it runs.

import * as THREE from "three";
import { Picker } from "./pick.js";

export class Grab {
  constructor(app) {
    this.app = app;
    this.picker = new Picker(app.stage);
    const { canvas } = this.picker;
    this.canvas = canvas;
    // before the camera's own listeners
    canvas.addEventListener("pointerdown", (event) => this.begin(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, () => this.end());
  }

  begin(event) {
    if (event.button !== 0 || this.held) return;
    const { app } = this;
    const { robot, scene } = app.stage;
    this.picker.aim(event);
    const hit = this.picker.hit();
    if (!hit || (hit.body === 0 && !robot.isFloating)) return;
    const { name, frame } = robot.bodies[hit.body];
    if (frame === null) return;
    event.stopImmediatePropagation();
    this.canvas.setPointerCapture(event.pointerId);
    const towards = scene.camera.getWorldDirection(new THREE.Vector3());
    this.plane = new THREE.Plane().setFromNormalAndCoplanarPoint(towards, hit.point);
    const point = hit.point.clone().applyMatrix4(scene.frames[frame].matrixWorld.clone().invert());
    const isEnd = event.shiftKey !== (app.grabs === "end");
    this.held = { frame: name, point: point.toArray(), body: hit.body, from: hit.point.clone(), isEnd, end: app.endPoint() };
    if (!app.isPlaying) app.remember();
    this.move(event);
  }

  move(event) {
    if (!this.held) return;
    this.picker.aim(event);
    const at = this.picker.ray.ray.intersectPlane(this.plane, new THREE.Vector3());
    if (!at) return;
    const { app, held } = this;
    const goal = at.toArray();
    const shifted = at.clone().sub(held.from).add(new THREE.Vector3(...held.end)).toArray();
    if (app.isPlaying && held.isEnd && app.hasTarget) app.reachTarget(shifted);
    else if (app.isPlaying) app.push = { frame: held.frame, point: held.point, goal };
    else if (held.isEnd) app.reach(shifted);
    else app.drag({ joint: this.jointOf(held.body), frame: held.frame, point: held.point, goal });
  }

  // The independent joint that moves a body: a mimic joint's source.
  jointOf(body) {
    const { robot } = this.app.stage;
    if (body === 0) return "base";
    const { j } = robot.bodies[body];
    return robot.joints.find((joint) => joint.j === j)?.name ?? robot.bodies[body].joint;
  }

  end() {
    if (!this.held) return;
    this.held = null;
    this.app.push = null;
    this.app.changed();
  }
}
