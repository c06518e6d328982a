// Arrows, triads and ellipsoids. They are drawn over what stands before them: what is asked for is seen.

import * as THREE from "three";

const Z = new THREE.Vector3(0, 0, 1);

export const paint = (colour, options = {}) =>
  new THREE.MeshBasicMaterial({ color: new THREE.Color(colour), depthTest: false, transparent: true, toneMapped: false, ...options });

export class Arrow extends THREE.Group {
  constructor(colour, thickness) {
    super();
    const material = paint(colour);
    this.shaft = new THREE.Mesh(new THREE.CylinderGeometry(thickness, thickness, 1, 14).rotateX(Math.PI / 2).translate(0, 0, 0.5), material);
    this.head = new THREE.Mesh(new THREE.ConeGeometry(2.8 * thickness, 1, 20).rotateX(Math.PI / 2).translate(0, 0, 0.5), material);
    this.headLength = 8 * thickness;
    this.add(this.shaft, this.head);
    this.children.forEach((part) => (part.renderOrder = 10));
  }

  // From a point along a vector of this length in metres; nothing where it is shorter than its own line is thick.
  set(from, vector) {
    const [x, y, z] = vector;
    const length = Math.hypot(x, y, z);
    this.visible = length > this.headLength / 8;
    if (!this.visible) return;
    const head = Math.min(this.headLength, 0.5 * length);
    this.position.set(...from);
    this.quaternion.setFromUnitVectors(Z, new THREE.Vector3(x, y, z).divideScalar(length));
    this.shaft.scale.set(1, 1, length - head);
    this.head.scale.set(head / this.headLength, head / this.headLength, head);
    this.head.position.z = length - head;
  }
}

export function triad(length) {
  const group = new THREE.Group();
  for (const [direction, colour] of [[[length, 0, 0], "#e5484d"], [[0, length, 0], "#30a46c"], [[0, 0, length], "#3e7bfa"]]) {
    const arrow = new Arrow(colour, 0.028 * length);
    arrow.headLength = 0.24 * length;
    arrow.set([0, 0, 0], direction);
    group.add(arrow);
  }
  return group;
}

// A ball with the marks of a centre of mass: quarters, dark and bright.
export function massMark(radius, colour) {
  const group = new THREE.Group();
  for (let k = 0; k < 8; k++) {
    const [quarter, upper] = [k % 4, k >= 4];
    const geometry = new THREE.SphereGeometry(radius, 10, 8, (quarter * Math.PI) / 2, Math.PI / 2, upper ? 0 : Math.PI / 2, Math.PI / 2);
    const mesh = new THREE.Mesh(geometry, paint((quarter + (upper ? 1 : 0)) % 2 ? "#1b1f24" : colour));
    mesh.renderOrder = 11;
    group.add(mesh);
  }
  return group;
}

export class Ellipsoid extends THREE.Group {
  constructor(colour) {
    super();
    const ball = new THREE.SphereGeometry(1, 36, 24);
    const skin = new THREE.Mesh(ball, paint(colour, { opacity: 0.13, depthWrite: false }));
    const rings = [[0, 0], [Math.PI / 2, 0], [0, Math.PI / 2]].map(([x, y]) => {
      const circle = Array.from({ length: 73 }, (_, k) => new THREE.Vector3(Math.cos((k * Math.PI) / 36), Math.sin((k * Math.PI) / 36), 0));
      const line = new THREE.Line(new THREE.BufferGeometry().setFromPoints(circle), new THREE.LineBasicMaterial({ color: new THREE.Color(colour), depthTest: false, transparent: true }));
      line.rotation.set(x, y, 0);
      return line;
    });
    this.add(skin, ...rings);
    this.children.forEach((part) => (part.renderOrder = 9));
  }

  // Semi-axes along three orthogonal unit vectors.
  set(center, axes) {
    const columns = axes.map(({ vector }) => new THREE.Vector3(...vector));
    if (columns[0].clone().cross(columns[1]).dot(columns[2]) < 0) columns[2].negate();
    this.position.set(...center);
    this.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(...columns));
    this.scale.set(...axes.map(({ length }) => Math.max(length, 1e-6)));
  }
}
