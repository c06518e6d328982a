// Contact points, the forces there, by the plane on the robot or by the robot on the plane, and the cones of friction; what happened to the
// contacts.

import * as THREE from "three";
import { seriesColour } from "./colours.js";
import { KINDS } from "./kinds.js";
import { add, dot, fromRows, norm, scaled, turned } from "./vectors.js";
import { Arrow, paint } from "./marks.js";

export const SLIDES = "#f2740d";
const AWAY = "#8b95a1";
export const EVENT_COLOURS = { "touches down": "#4f46e5", "lifts off": AWAY, sticks: "#2f9e6e", slides: SLIDES };

// A force this near to the cone's surface is on it: numbers are of 32 bits.
const ON_SURFACE = 1 - 1e-4;
// Most numbers of a motion that are looked at for its scale.
const LOOKED_AT = 30_000;

// Into the plane: the plane's z points towards the robot.
export const inward = (pose) => turned(pose.R, [0, 0, -1]);

// A force's part into the plane, f_n, and how much of the greatest friction μ f_n it uses: 1 where it slides.
export function friction(force, pose, mu) {
  const n = inward(pose);
  const normal = dot(force, n);
  const tangential = norm(add(force, scaled(n, -normal)));
  const used = normal > 0 && mu > 0 ? tangential / (mu * normal) : 0;
  return { normal: Math.max(normal, 0), used: Math.min(used, 1.001) };
}

// Sizes of the forces that are not 0, ascending.
function sizes(contacts) {
  const step = Math.max(Math.ceil((contacts.forces.length * contacts.pairs.length) / LOOKED_AT), 1);
  const found = [];
  for (let row = 0; row < contacts.forces.length; row += step)
    for (let k = 0; k < contacts.pairs.length; k++) found.push(norm(contacts.forces[row].slice(3 * k, 3 * k + 3)));
  return found.filter((size) => size > 0).sort((a, b) => a - b);
}

// The force that nine tenths of all do not exceed: impacts would dwarf the others.
export function usualForce(contacts) {
  const found = sizes(contacts);
  return found.length > 0 ? found[Math.floor(0.9 * (found.length - 1))] : 0;
}

// A cone of height 1 along z from its tip at the origin; tan of its half-angle is μ.
class Cone extends THREE.Group {
  constructor(mu, colour) {
    super();
    const geometry = new THREE.ConeGeometry(mu, 1, 48, 1, true).rotateX(-Math.PI / 2).translate(0, 0, 0.5);
    this.skin = new THREE.Mesh(geometry, paint(colour, { opacity: 0.16, depthWrite: false, side: THREE.DoubleSide }));
    const points = [];
    const at = (k, of) => [mu * Math.cos((2 * Math.PI * k) / of), mu * Math.sin((2 * Math.PI * k) / of), 1];
    for (let k = 0; k < 48; k++) points.push(...at(k, 48), ...at(k + 1, 48));
    for (let k = 0; k < 8; k++) points.push(0, 0, 0, ...at(k, 8));
    const lines = new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
    this.edges = new THREE.LineSegments(lines, new THREE.LineBasicMaterial({ color: colour, depthTest: false, transparent: true, opacity: 0.75 }));
    this.add(this.skin, this.edges);
    this.children.forEach((part) => (part.renderOrder = 8));
  }

  set(tip, direction, height, colour) {
    this.visible = height > 0;
    if (!this.visible) return;
    this.position.set(...tip);
    this.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), new THREE.Vector3(...direction));
    this.scale.setScalar(height);
    this.children.forEach(({ material }) => material.color.set(colour));
  }
}

export class ContactMarks {
  constructor(contacts, layer, reach) {
    this.contacts = contacts;
    this.usual = usualForce(contacts);
    // the robot's force on the plane, or the plane's on the robot
    this.isApplied = false;
    // metres per newton
    this.scale = this.usual > 0 ? (0.3 * reach) / this.usual : 0;
    const colour = KINDS.contacts.colour;
    const many = contacts.pairs.length > 12 ? 0.7 : 1;
    const put = (object) => {
      layer.add(object);
      return object;
    };
    this.marks = contacts.pairs.map(({ mu }) => {
      const point = put(new THREE.Mesh(new THREE.SphereGeometry(0.009 * reach * many, 16, 12), paint(AWAY)));
      point.renderOrder = 12;
      return { point, cone: put(new Cone(mu, colour)), arrow: put(new Arrow(colour, 0.006 * reach * many)) };
    });
  }

  get side() {
    return this.isApplied ? 1 : -1;
  }

  update({ touch }) {
    this.marks.forEach(({ point, cone, arrow }, k) => {
      const { mu, plane } = this.contacts.pairs[k];
      const [at, force] = [touch.points, touch.forces].map((list) => list.slice(3 * k, 3 * k + 3));
      const pose = touch.planes[plane];
      const { normal, used } = friction(force, pose, mu);
      const colour = used > ON_SURFACE ? SLIDES : KINDS.contacts.colour;
      point.position.set(...at);
      point.material.color.set(normal > 0 ? colour : AWAY);
      cone.set(at, scaled(inward(pose), this.side), normal * this.scale, colour);
      arrow.set(at, scaled(force, this.side * this.scale));
      arrow.children.forEach(({ material }) => material.color.set(colour));
    });
  }

  // Where cones and arrows of a state end, roughly.
  ends({ touch }) {
    return this.contacts.pairs.flatMap(({ plane }, k) => {
      const [at, force] = [touch.points, touch.forces].map((list) => list.slice(3 * k, 3 * k + 3));
      const length = Math.min(norm(force), 2 * this.usual) * this.scale;
      return length > 0 ? [at, add(at, scaled(inward(touch.planes[plane]), 1.1 * this.side * length))] : [];
    });
  }

  // What the scene has, for tests: in metres, newtons and radians, measured on the drawn shapes.
  drawn() {
    return this.marks.map(({ point, cone, arrow }, k) => {
      [point, cone, arrow].forEach((part) => part.updateMatrixWorld(true));
      const tip = new THREE.Vector3(0, 0, 1).applyMatrix4(arrow.head.matrixWorld);
      const force = arrow.visible ? tip.sub(arrow.position).divideScalar(this.scale) : new THREE.Vector3();
      const rim = cone.skin.geometry.attributes.position;
      const corner = (i) => new THREE.Vector3().fromBufferAttribute(rim, i).applyMatrix4(cone.matrixWorld).sub(cone.position);
      const ring = Array.from({ length: rim.count }, (_, i) => corner(i))
        .filter((v) => v.length() > 1e-9).slice(1); // the first and the last are one
      const axis = ring.reduce((sum, v) => sum.add(v), new THREE.Vector3()).normalize();
      return {
        name: this.contacts.pairs[k].name,
        at: point.position.toArray(),
        force: force.toArray(),
        cone: cone.visible ? { tip: cone.position.toArray(), axis: axis.toArray(), halfAngles: ring.map((v) => v.angleTo(axis)) } : null,
        slides: arrow.visible && `#${arrow.head.material.color.getHexString()}` === SLIDES,
      };
    });
  }
}

const SEVERAL = { "touches down": "touch down", "lifts off": "lift off", sticks: "stick", slides: "slide" };

// What last happened to contacts up to a time, in words.
export function lastEvent(contacts, time) {
  const past = contacts.events.filter(({ t }) => t <= time + 1e-9);
  if (past.length === 0) return "";
  const { t } = past.at(-1);
  const words = Object.keys(SEVERAL).flatMap((change) => {
    const names = past.filter((event) => event.t === t && event.change === change).map(({ contact }) => contact);
    const who = names.length > 3 ? `${names.length} contacts` : names.join(", ");
    return names.length > 0 ? [`${who} ${names.length > 1 ? SEVERAL[change] : change}`] : [];
  });
  return `${t.toFixed(3)} s: ${words.join("; ")}`;
}

// Plots of the contacts that ever carry, the strongest first; `marks` are the events.
export function contactPlots(contacts) {
  const most = 24;
  const poses = (row) => contacts.planes.map(({ poses }) => fromRows(poses[Math.min(row, poses.length - 1)]));
  const of = contacts.pairs.map(({ name, mu, plane }, k) => {
    const rows = contacts.forces.map((row, i) => friction(row.slice(3 * k, 3 * k + 3), poses(i)[plane], mu));
    return { name, normal: rows.map(({ normal }) => normal), used: rows.map(({ used }) => Math.min(used, 1)), sum: rows.reduce((sum, { normal }) => sum + normal, 0) };
  });
  const carrying = of.filter(({ sum }) => sum > 0);
  if (carrying.length === 0) return [];
  const shown = carrying.length > most ? [...carrying].sort((a, b) => b.sum - a.sum).slice(0, most) : carrying;
  const curves = (key) => shown.map((curve, k) => ({ name: curve.name, colour: seriesColour(k), values: curve[key] }));
  const marks = contacts.events.map(({ t, change }) => ({ t, colour: EVENT_COLOURS[change] }));
  const legend = shown.length <= 8;
  const left = carrying.length > most ? `, ${most} of ${carrying.length}` : "";
  return [
    { title: "contact f_n", unit: `N on planes${left}`, legend, marks, curves: curves("normal") },
    { title: "friction used", unit: "‖f_t‖ / μ f_n, 1 slides", legend, marks, curves: curves("used") },
  ];
}
