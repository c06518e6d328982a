// What the buttons show over the robot: screw axes, frames, centres of mass, twists, wrenches, ellipsoids, the end effector's path.

import * as THREE from "three";
import { ContactMarks } from "./contacts.js";
import { centerOfMass, linearGram, poses, twists, wrenches } from "./dynamics.js";
import { add, angular, cross, eigen, linear, moved, norm, scaled } from "./lie.js";
import { linesOf, pointOf } from "./joints.js";
import { KINDS } from "./kinds.js";
import { Arrow, Ellipsoid, massMark, triad } from "./marks.js";

// A velocity of 1 m/s by ‖θ̇‖ = 1 is drawn a quarter of a metre long; forces so that both ellipsoids are of the robot's size.
const DRAWN = 0.25;

const center = ([m, x, y, z]) => (m > 0 ? [x / m, y / m, z / m] : [0, 0, 0]);

// Inertia about the centre of mass, row-major.
function centralInertia([m, hx, hy, hz, xx, xy, xz, yy, yz, zz]) {
  const c = center([m, hx, hy, hz]);
  const d = m * (c[0] ** 2 + c[1] ** 2 + c[2] ** 2);
  const I = [xx, xy, xz, xy, yy, yz, xz, yz, zz];
  return I.map((x, k) => x - (k % 4 === 0 ? d : 0) + m * c[Math.floor(k / 3)] * c[k % 3]);
}

export class Overlays {
  constructor(robot, scene, reach, jointColour, contacts) {
    Object.assign(this, { robot, scene, reach, pairs: contacts?.pairs ?? [] });
    this.layers = Object.fromEntries(Object.keys(KINDS).map((kind) => [kind, new THREE.Group()]));
    for (const layer of Object.values(this.layers)) {
      layer.visible = false;
      scene.world.add(layer);
    }
    this.inertias = [robot.baseInertia, ...robot.bodies.map((body) => body.inertia)];
    this.fixedParts(jointColour);
    const thickness = 0.006 * reach;
    const moving = this.inertias.map(() => null);
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
      linesOf(body).forEach(({ point, direction }, i) => {
        const axis = new Arrow(jointColour(body.j + i), 0.0045 * reach);
        axis.set(add(point, scaled(direction, -0.16 * reach)), scaled(direction, 0.38 * reach));
        attach("axes", k + 1, new THREE.Group().add(axis));
      });
      attach("frames", k + 1, triad(0.11 * reach));
    });
    attach("frames", 0, triad(0.16 * reach));
    this.inertias.forEach((inertia, k) => {
      if (inertia[0] <= 0) return;
      const mark = massMark(0.016 * reach, "#f3c623");
      mark.position.set(...center(inertia));
      attach("masses", k, mark);
      const principal = eigen(centralInertia(inertia));
      const [a, b, c] = principal.map(({ value }) => value);
      // semi-axes of the homogeneous ellipsoid with this inertia
      const semi = (x, y, z) => Math.sqrt(Math.max((5 * (y + z - x)) / (2 * inertia[0]), 0));
      const ellipsoid = new Ellipsoid(KINDS.inertia.colour);
      const lengths = [semi(a, b, c), semi(b, c, a), semi(c, a, b)];
      ellipsoid.set(center(inertia), principal.map(({ vector }, i) => ({ vector, length: lengths[i] })));
      attach("inertia", k, new THREE.Group().add(ellipsoid));
    });
  }

  show(kind, isOn) {
    this.layers[kind].visible = isOn;
    this.attached[kind].forEach((object) => (object.visible = isOn));
    if (kind === "frames" && this.tipTriad) this.tipTriad.visible = isOn;
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
    const points = motion.theta.map((theta) => {
      const T = poses(this.robot, theta)[this.frame.body];
      return new THREE.Vector3(...moved(T, this.frame.T.p));
    });
    const material = new THREE.LineBasicMaterial({ color: KINDS.path.colour, transparent: true, opacity: 0.9 });
    layer.add(new THREE.Line(new THREE.BufferGeometry().setFromPoints(points), material));
  }

  // The longest arrow of each kind over some states is drawn three tenths of the robot long.
  measure(states) {
    const longest = { carried: 0, spin: 0, speed: 0, moment: 0, force: 0 };
    for (const state of states) {
      const found = this.vectors(state, poses(this.robot, state.theta));
      for (const kind of Object.keys(longest))
        for (const vector of found[kind] ?? []) longest[kind] = Math.max(longest[kind], norm(vector));
    }
    this.longest = longest;
  }

  // ω and v at each centre of mass, m and f at each joint.
  vectors({ dtheta, ddtheta, tip, loops, touch }, T) {
    const { robot } = this;
    const still = new Array(robot.n).fill(0);
    const centers = this.inertias.map((inertia, k) => moved(T[k], center(inertia)));
    const V = twists(robot, T, dtheta ?? still);
    const three = (list, k) => list.slice(3 * k, 3 * k + 3);
    const pushes = touch ? this.pairs.map(({ frame }, k) => ({ frame, at: three(touch.points, k), force: three(touch.forces, k) })) : [];
    const F = wrenches(robot, T, dtheta ?? still, ddtheta ?? still, tip, loops, pushes);
    const anchors = robot.constraints.map(({ a, b }) => [a, b].map(({ body, p }) => (body === null ? p : moved(T[body], p))));
    const joints = T.map((pose, k) => (k === 0 ? pose.p : moved(pose, pointOf(robot.bodies[k - 1]))));
    return {
      centers,
      joints,
      anchors,
      carried: robot.constraints.map((_, k) => (loops ? loops.slice(6 * k + 3, 6 * k + 6) : [0, 0, 0])),
      spin: V.map(angular),
      speed: V.map((twist, k) => add(linear(twist), cross(angular(twist), centers[k]))),
      moment: F.map((wrench, k) => add(angular(wrench), scaled(cross(joints[k], linear(wrench)), -1))),
      force: F.map(linear),
    };
  }

  update(state, T) {
    const { layers } = this;
    if (layers.twists.visible || layers.wrenches.visible || layers.constraints.visible) {
      const found = this.vectors(state, T);
      found.anchors.forEach((ends, k) => this.lines[k].geometry.setFromPoints(ends.map((end) => new THREE.Vector3(...end))));
      for (const [kind, from] of [["spin", found.centers], ["speed", found.centers], ["moment", found.joints], ["force", found.joints], ["carried", found.anchors.map(([, b]) => b)]]) {
        const scale = this.longest[kind] > 0 ? (0.3 * this.reach) / this.longest[kind] : 0;
        this[kind].forEach((arrow, k) => arrow.set(from[k], scaled(found[kind][k], scale)));
      }
    }
    if (layers.contacts.visible && state.touch) this.touches.update(state);
    if (layers.masses.visible) {
      const c = centerOfMass(this.robot, T);
      this.total.visible = c !== null;
      if (c) this.total.position.set(...c);
    }
    if (layers.manipulability.visible || layers.torque.visible) this.ellipsoids(T);
  }

  // Singular values σ of J_v, ascending, and their directions.
  singularValues(T) {
    return eigen(linearGram(this.robot, T, this.frame)).map(({ value, vector }) => ({ vector, sigma: Math.sqrt(Math.max(value, 0)) }));
  }

  // Of linear velocity, ‖θ̇‖ = 1: semi-axes σ along the singular directions of J_v; of force, ‖τ‖ = 1: 1/σ.
  ellipsoids(T) {
    const at = moved(T[this.frame.body], this.frame.T.p);
    const principal = this.singularValues(T);
    const most = 1.5 * this.reach;
    this.manipulability.set(at, principal.map(({ vector, sigma }) => ({ vector, length: DRAWN * sigma })));
    const force = (sigma) => Math.min((DRAWN * this.reach ** 2) / 4 / Math.max(sigma, 1e-9), most);
    this.forceEllipsoid.set(at, principal.map(({ vector, sigma }) => ({ vector, length: force(sigma) })));
  }
}
