// What the buttons show over the robot: screw axes, frames, centres of mass, twists, wrenches, ellipsoids, the end effector's path.

import * as THREE from "three";
import { ContactMarks } from "./contacts.js";
import { KINDS } from "./kinds.js";
import { Arrow, Ellipsoid, massMark, triad } from "./marks.js";
import { rows } from "./robot.js";
import { add, fromRows, norm, scaled } from "./vectors.js";

// A velocity of 1 m/s by ‖θ̇‖ = 1 is drawn a quarter of a metre long, or shorter: ellipsoids are no longer than this of the robot; forces so
// that both ellipsoids are of the robot's size.
const DRAWN = 0.25;
const MOST = 0.6;

export class Overlays {
  constructor(robot, scene, reach, jointColour, contacts) {
    Object.assign(this, { robot, scene, reach, jointColour, pairs: contacts?.pairs ?? [], axes: [] });
    this.layers = Object.fromEntries(Object.keys(KINDS).map((kind) => [kind, new THREE.Group()]));
    for (const layer of Object.values(this.layers)) {
      layer.visible = false;
      scene.world.add(layer);
    }
    this.fixedParts(jointColour);
    this.applied();
    const thickness = 0.006 * reach;
    const moving = robot.bodies.map(() => null);
    this.spin = moving.map(() => this.put("twists", new Arrow("#8ccf4d", thickness)));
    this.speed = moving.map(() => this.put("twists", new Arrow(KINDS.twists.colour, thickness)));
    this.moment = moving.map(() => this.put("wrenches", new Arrow("#ef9f3c", thickness)));
    this.force = moving.map(() => this.put("wrenches", new Arrow(KINDS.wrenches.colour, thickness)));
    this.manipulability = this.put("manipulability", new Ellipsoid(KINDS.manipulability.colour));
    this.forceEllipsoid = this.put("torque", new Ellipsoid(KINDS.torque.colour));
    this.total = this.put("masses", massMark(0.028 * reach, "#e5484d"));
    this.lines = robot.constraints.map(() => {
      const material = new THREE.LineBasicMaterial({ color: KINDS.constraints.colour, depthTest: false, transparent: true });
      return this.put("constraints", new THREE.Line(new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), new THREE.Vector3()]), material));
    });
    this.carried = robot.constraints.map(() => this.put("constraints", new Arrow(KINDS.constraints.colour, thickness)));
    this.touches = contacts && new ContactMarks(contacts, this.layers.contacts, reach);
    this.longest = { carried: 1, spin: 1, speed: 1, moment: 1, force: 1 };
    // metres of 1 m/s and of 1 N in the ellipsoids
    this.drawn = { velocity: 0, force: 0, isCut: false };
  }

  // Takes what is not in a body's or a frame's group out of the scene.
  remove() {
    for (const layer of Object.values(this.layers)) layer.removeFromParent();
    for (const object of [...Object.values(this.attached).flat(), ...this.axes, this.tipTriad]) object?.removeFromParent();
  }

  put(kind, object) {
    this.layers[kind].add(object);
    return object;
  }

  // What is at rest in a body, in that body's group.
  fixedParts(jointColour) {
    const { robot, scene, reach } = this;
    this.attached = Object.fromEntries(Object.keys(KINDS).map((kind) => [kind, []]));
    const attach = (kind, k, object) => {
      object.visible = false;
      scene.bodies[k].add(object);
      this.attached[kind].push(object);
    };
    robot.bodies.forEach((body, k) => {
      body.lines.forEach(({ point, direction }, i) => {
        const axis = new Arrow(jointColour(body.j + i), 0.0045 * reach);
        axis.set(add(point, scaled(direction, -0.16 * reach)), scaled(direction, 0.38 * reach));
        attach("axes", k, new THREE.Group().add(axis));
      });
      attach("frames", k, triad((k === 0 ? 0.16 : 0.11) * reach));
      if (!body.ellipsoid) return;
      const mark = massMark(0.016 * reach, "#f3c623");
      mark.position.set(...body.center);
      attach("masses", k, mark);
      const ellipsoid = new Ellipsoid(KINDS.inertia.colour);
      ellipsoid.set(body.center, body.ellipsoid.axes.map((vector, i) => ({ vector, length: Math.min(body.ellipsoid.lengths[i], MOST * reach) })));
      attach("inertia", k, new THREE.Group().add(ellipsoid));
    });
  }

  // The wrenches that a motion knows: of the end effector in its own frame, of anchor b on a and of a on b in {s}, and
  // of contacts as forces at points.
  applied() {
    const { robot, pairs } = this;
    const tip = robot.endEffector === null ? [] : [{ frame: robot.frames[robot.endEffector].name, as: "body" }];
    const ends = robot.constraints.flatMap(({ a, b }) => [b, a].filter(Boolean).map((frame) => ({ frame, as: "space" })));
    const points = pairs.map(({ frame }) => ({ frame: robot.frames[frame].name, as: "point" }));
    const set = robot.applying([...tip, ...ends, ...points]);
    const none = [0, 0, 0, 0, 0, 0];
    this.apply = ({ tip: F, loops, touch }) => {
      const three = (list, k) => list.slice(3 * k, 3 * k + 3);
      const W = (k) => (loops ? loops.slice(6 * k, 6 * k + 6) : none);
      set([
        ...(tip.length > 0 ? F ?? none : []),
        ...robot.constraints.flatMap(({ a, b }, k) => [...(b ? W(k) : []), ...(a ? scaled(W(k), -1) : [])]),
        ...pairs.flatMap((_, k) => (touch ? [...three(touch.points, k), ...three(touch.forces, k)] : none)),
      ]);
    };
  }

  show(kind, isOn) {
    if (kind === "applied" && this.touches) this.touches.isApplied = isOn;
    this.layers[kind].visible = isOn;
    this.attached[kind].forEach((object) => (object.visible = isOn));
    if (kind === "frames" && this.tipTriad) this.tipTriad.visible = isOn;
  }

  // The axes of some velocities, drawn thick: of the joint under the pointer, of an entry of a matrix.
  point(velocities) {
    const key = velocities.join();
    if (key === this.pointed) return;
    this.pointed = key;
    this.axes.forEach((axis) => axis.removeFromParent());
    this.axes = [];
    this.robot.bodies.forEach((body, k) => body.lines.forEach(({ point, direction }, i) => {
      if (!velocities.includes(body.j + (body.lines.length > 1 ? i : 0))) return;
      const axis = new Arrow(this.jointColour(body.j + i), 0.012 * this.reach);
      axis.set(add(point, scaled(direction, -0.2 * this.reach)), scaled(direction, 0.46 * this.reach));
      this.scene.bodies[k].add(axis);
      this.axes.push(axis);
    }));
    this.scene.draw();
  }

  // The frame whose ellipsoids and path are meant.
  setFrame(index, motion) {
    this.frame = this.robot.frames[index];
    this.tipTriad?.removeFromParent();
    this.tipTriad = triad(0.11 * this.reach);
    this.tipTriad.visible = this.layers.frames.visible;
    this.scene.frames[index].add(this.tipTriad);
    if (motion) this.drawPath(motion);
  }

  drawPath(motion) {
    const layer = this.layers.path;
    layer.clear();
    const request = { quantity: "forward_kinematics", frame: this.frame.name };
    const points = motion.theta.map((theta) => new THREE.Vector3(...fromRows(this.robot.compute(request, { theta }).T).p));
    const material = new THREE.LineBasicMaterial({ color: KINDS.path.colour, transparent: true, opacity: 0.9 });
    layer.add(new THREE.Line(new THREE.BufferGeometry().setFromPoints(points), material));
  }

  // The longest arrow of each kind over some states is drawn three tenths of the robot long.
  measure(states) {
    const longest = { carried: 0, spin: 0, speed: 0, moment: 0, force: 0 };
    for (const state of states) {
      const found = this.vectors(state);
      for (const kind of Object.keys(longest))
        for (const vector of found[kind] ?? []) longest[kind] = Math.max(longest[kind], norm(vector));
    }
    this.longest = longest;
  }

  // ω and v at each centre of mass, m and f at each joint.
  vectors(state) {
    const { robot } = this;
    const { theta, loops } = state;
    const still = new Array(robot.n).fill(0);
    this.apply(state);
    const found = robot.compute({ quantity: "body_motion" }, { theta, dtheta: state.dtheta ?? still, ddtheta: state.ddtheta ?? still });
    const of = (name) => rows(found[name], 3);
    const { a, b } = robot.compute({ quantity: "constraint_anchors" }, { theta });
    const ends = [rows(a, 3), rows(b, 3)];
    return {
      centers: of("center"),
      joints: of("point"),
      anchors: robot.constraints.map((_, k) => ends.map((list) => list[k])),
      carried: robot.constraints.map((_, k) => (loops ? loops.slice(6 * k + 3, 6 * k + 6) : [0, 0, 0])),
      spin: of("angular_velocity"),
      speed: of("center_velocity"),
      moment: of("moment"),
      force: of("force"),
    };
  }

  update(state) {
    const { layers } = this;
    if (layers.twists.visible || layers.wrenches.visible || layers.constraints.visible) {
      const found = this.vectors(state);
      found.anchors.forEach((ends, k) => this.lines[k].geometry.setFromPoints(ends.map((end) => new THREE.Vector3(...end))));
      for (const [kind, from] of [["spin", found.centers], ["speed", found.centers], ["moment", found.joints], ["force", found.joints], ["carried", found.anchors.map(([, b]) => b)]]) {
        const scale = this.longest[kind] > 0 ? (0.3 * this.reach) / this.longest[kind] : 0;
        this[kind].forEach((arrow, k) => arrow.set(from[k], scaled(found[kind][k], scale)));
      }
    }
    if (layers.contacts.visible && state.touch) this.touches.update(state);
    if (layers.masses.visible) {
      const c = this.robot.centerOfMass(state.theta);
      this.total.visible = c !== null;
      if (c) this.total.position.set(...c);
    }
    if (layers.manipulability.visible || layers.torque.visible) this.ellipsoids(state.theta);
  }

  // Singular values σ of J_v, ascending, and their directions.
  singularValues(theta) {
    const { sigma, u } = this.robot.compute({ quantity: "velocity_ellipsoid", frame: this.frame.name }, { theta });
    return rows(u, 3).map((vector, k) => ({ vector, sigma: sigma[k] }));
  }

  // Of linear velocity, ‖θ̇‖ = 1: semi-axes σ along the singular directions of J_v; of force, ‖τ‖ = 1: 1/σ.
  ellipsoids(theta) {
    const at = fromRows(this.robot.compute({ quantity: "forward_kinematics", frame: this.frame.name }, { theta }).T).p;
    const principal = this.singularValues(theta);
    const most = MOST * this.reach;
    const largest = Math.max(...principal.map(({ sigma }) => sigma));
    this.drawn.velocity = Math.min(DRAWN, most / Math.max(largest, 1e-9));
    this.drawn.force = (DRAWN * this.reach ** 2) / 4;
    this.drawn.isCut = principal.some(({ sigma }) => this.drawn.force > most * sigma);
    this.manipulability.set(at, principal.map(({ vector, sigma }) => ({ vector, length: this.drawn.velocity * sigma })));
    this.forceEllipsoid.set(at, principal.map(({ vector, sigma }) => ({ vector, length: Math.min(this.drawn.force / Math.max(sigma, 1e-9), most) })));
  }
}
