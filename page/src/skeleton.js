// A robot without geometry, or without its skin: bones between joints, a drum, a slide or a sphere at each joint.

import * as THREE from "three";
import { turnedBack } from "./vectors.js";

const Z = new THREE.Vector3(0, 0, 1);

function bone(from, to, thick, thin, material) {
  const [a, b] = [new THREE.Vector3(...from), new THREE.Vector3(...to)];
  const length = a.distanceTo(b);
  if (length < 1e-6) return null;
  const geometry = new THREE.CylinderGeometry(thin, thick, length, 20).rotateX(Math.PI / 2);
  const mesh = new THREE.Mesh(geometry, material);
  mesh.position.copy(a).lerp(b, 0.5);
  mesh.quaternion.setFromUnitVectors(Z, b.sub(a).normalize());
  return mesh;
}

// Where a body's bones lead: to the joints that it carries and the anchors of constraints on it, or, of a tip, to its farthest frame
// or its centre of mass.
function ends(robot, k, anchors) {
  const children = robot.bodies.filter((body) => body.parent === k && body.kind !== "free").map(({ at }) => at);
  if (children.length > 0) return [...children, ...anchors];
  const length = (p) => Math.hypot(...p);
  const frames = robot.frames.filter((frame) => frame.body === k).map(({ p }) => p);
  const far = frames.reduce((best, p) => (length(p) > length(best) ? p : best), [0, 0, 0]);
  const { center } = robot.bodies[k];
  if (length(far) > length(center)) return [far, ...anchors];
  return anchors.length > 0 ? anchors : [center];
}

// For each body the anchors of constraints on it, in its frame, from a configuration: that of the robot's inputs, which stays.
function anchorsOf(robot, theta) {
  const found = robot.bodies.map(() => []);
  if (robot.constraints.length === 0) return found;
  const poses = robot.bodyPoses(robot.poses(theta));
  const { a, b } = robot.compute({ quantity: "constraint_anchors" }, { theta });
  robot.constraints.forEach((constraint, i) => [[constraint.a, a], [constraint.b, b]].forEach(([frame, points]) => {
    if (!frame) return;
    const k = robot.frames.find(({ name }) => name === frame).body;
    found[k].push(turnedBack(poses[k].R, points.slice(3 * i, 3 * i + 3).map((x, j) => x - poses[k].p[j])));
  }));
  return found;
}

export function addSkeleton(robot, scene, reach, jointColour, theta) {
  const parts = [];
  const r = 0.02 * reach;
  const metal = new THREE.MeshStandardMaterial({ color: 0x9aa7b5, roughness: 0.5, metalness: 0.25 });
  const add = (k, mesh) => {
    if (!mesh) return;
    mesh.castShadow = true;
    mesh.receiveShadow = true;
    scene.bodies[k].add(mesh);
    parts.push(mesh);
  };
  const anchors = anchorsOf(robot, theta);
  robot.bodies.forEach((body, k) => {
    if (k === 0) add(0, base(robot, r, metal));
    for (const end of ends(robot, k, anchors[k])) add(k, bone(body.point, end, 1.05 * r, 0.7 * r, metal));
    if (k > 0) add(k, joint(body, r, metal, jointColour(body.j), before(robot, k)));
  });
  return parts;
}

// How many joints before this one turn about the same point: their drums would be in one place.
function before(robot, k) {
  const { parent, at } = robot.bodies[k];
  if (parent === null || parent === 0) return 0;
  const apart = Math.hypot(...at.map((x, i) => x - robot.bodies[parent].point[i]));
  return apart < 1e-6 ? 1 + before(robot, parent) : 0;
}

const sphere = (radius, material) => new THREE.Mesh(new THREE.SphereGeometry(radius, 32, 20), material);

function base(robot, r, metal) {
  if (robot.isFloating) return sphere(1.8 * r, metal);
  const plate = new THREE.Mesh(new THREE.CylinderGeometry(3.2 * r, 3.6 * r, 0.8 * r, 48).rotateX(Math.PI / 2), metal);
  plate.position.z = -0.4 * r;
  return plate;
}

// Nothing joins a free body to its parent: the sphere is the body's, as a floating base's.
function joint(body, r, metal, colour, inner) {
  if (body.kind === "free") return sphere(1.8 * r, metal);
  const paint = new THREE.MeshStandardMaterial({ color: new THREE.Color(colour), roughness: 0.45, metalness: 0.1 });
  const mesh = body.kind === "ball" ? sphere(2.1 * r, paint) : new THREE.Mesh(drumOrSlide(body.kind, r), paint);
  // one within the other: thinner and longer
  if (inner > 0 && body.kind === "revolute") mesh.scale.set(0.78 ** inner, 0.78 ** inner, 1.3 ** inner);
  mesh.position.set(...body.point);
  mesh.quaternion.setFromUnitVectors(Z, new THREE.Vector3(...body.lines[0].direction).normalize());
  return mesh;
}

function drumOrSlide(kind, r) {
  if (kind === "prismatic") return new THREE.BoxGeometry(2.2 * r, 2.2 * r, 3.6 * r);
  return new THREE.CylinderGeometry(1.75 * r, 1.75 * r, 3.4 * r, 40).rotateX(Math.PI / 2);
}
