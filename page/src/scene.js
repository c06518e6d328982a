// The picture: camera, light, ground, and a group for each body and each frame, placed by its pose. Drawn when something changed, not otherwise.

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Floor } from "./floor.js";

export const matrixOf = ({ R, p }) =>
  new THREE.Matrix4().set(R[0], R[1], R[2], p[0], R[3], R[4], R[5], p[1], R[6], R[7], R[8], p[2], 0, 0, 0, 1);

export class Scene {
  // `drawn`: a canvas with its context, if there is one; `scale`: pixels along an edge for one of the screen.
  constructor(host, robot, { drawn = null, scale = 1 } = {}) {
    Object.assign(this, { host, scale });
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true, ...drawn });
    this.renderer.shadowMap.enabled = true;
    host.append(this.renderer.domElement);
    this.world = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.01, 200);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => this.draw());
    this.light();
    this.setRobot(robot);
    new ResizeObserver(() => this.resize()).observe(host);
    this.resize();
  }

  // Groups for the bodies and the frames of a robot; those of the last one go.
  setRobot(robot) {
    for (const group of [...(this.bodies ?? []), ...(this.frames ?? [])]) {
      this.world.remove(group);
      group.traverse((part) => part.geometry?.dispose());
    }
    const placed = (name) => {
      const group = new THREE.Group();
      group.matrixAutoUpdate = false;
      group.name = name;
      this.world.add(group);
      return group;
    };
    this.bodies = robot.bodies.map(() => placed(""));
    this.frames = robot.frames.map((frame) => placed(frame.name));
    this.isFollowing = robot.isFloating;
    this.followed = new THREE.Vector3();
    this.renderer.domElement.setAttribute("aria-label", `The robot ${robot.name} in three dimensions`);
  }

  light() {
    this.sky = new THREE.HemisphereLight(0xffffff, 0x8890a0, 1.7);
    this.sky.position.set(0, 0, 1);
    this.sun = new THREE.DirectionalLight(0xffffff, 2.1);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.radius = 5;
    this.sun.shadow.intensity = 0.6;
    this.world.add(this.sky, this.sun, this.sun.target);
  }

  // Floors on planes, each { pose, velocity }; without a pose a plane lies at a height and stays where it is. One alone reaches to the horizon.
  ground(size, planes) {
    [this.groundSize, this.planes] = [size, planes];
    for (const floor of this.floors ?? []) {
      this.world.remove(floor);
      floor.dispose();
    }
    this.cell = 10 ** Math.floor(Math.log10(size / 2));
    const near = 2 * Math.ceil((2.2 * size) / this.cell);
    const cells = planes.length > 1 ? near : 30 * near;
    this.floors = planes.map(({ pose, height }, k) => {
      const floor = new Floor(this.cell, cells, near * this.cell, k);
      floor.position.z = (height ?? 0) - 1e-3 * size;
      floor.matrixAutoUpdate = !pose;
      this.world.add(floor);
      return floor;
    });
    this.placeSun(size);
    this.uncover();
  }

  // A floor that hides a part of the robot lets it be seen.
  uncover() {
    for (const floor of this.floors ?? []) {
      if (!floor.matrixAutoUpdate) continue;
      floor.uncover([...this.frames, ...this.bodies].some(({ matrix }) => matrix.elements[14] < floor.position.z - 0.02 * this.groundSize));
    }
  }

  // The planes of contacts, at a time: below the robot's base, by whole cells of their grids; a belt's grid moves with it.
  placePlanes(poses, time) {
    if (!this.floors) return;
    this.floors.forEach((floor, k) => {
      if (!poses[k]) return;
      const T = matrixOf(poses[k]);
      const along = (x, y, z) => new THREE.Vector3(x, y, z).applyMatrix4(T.clone().setPosition(0, 0, 0).transpose());
      const carried = along(...(this.planes[k].velocity ?? [0, 0, 0])).multiplyScalar(time);
      const below = this.followed.clone().applyMatrix4(T.clone().invert());
      const whole = (x, from) => from + this.cell * Math.round((x - from) / this.cell);
      const center = new THREE.Matrix4().makeTranslation(whole(below.x, carried.x), whole(below.y, carried.y), -1e-3 * this.groundSize);
      floor.matrix.copy(T.multiply(center));
    });
  }

  placeSun(size) {
    Object.assign(this.sun.shadow.camera, { left: -size, right: size, top: size, bottom: -size, near: 0.1 * size, far: 8 * size });
    this.sun.shadow.camera.updateProjectionMatrix();
    this.sun.shadow.normalBias = 0.004 * size;
    this.size = size;
  }

  matrixOf = matrixOf;

  // By the poses of frames and of bodies.
  place(T, bodies) {
    T.forEach((pose, k) => this.frames[k].matrix.copy(matrixOf(pose)));
    bodies.forEach((pose, k) => this.bodies[k].matrix.copy(matrixOf(pose)));
    const base = new THREE.Vector3(...bodies[0].p);
    if (this.isFollowing) {
      const step = base.clone().sub(this.followed);
      this.controls.target.add(step);
      this.camera.position.add(step);
    }
    this.followed.copy(base);
    this.uncover();
    this.draw();
  }

  // The camera as near as it can be with all points in sight, from a corner a little above.
  fit(points) {
    const center = new THREE.Box3().setFromPoints(points).getCenter(new THREE.Vector3());
    const towards = new THREE.Vector3(1, -0.75, 0.27).normalize();
    const right = new THREE.Vector3(0, 0, 1).cross(towards).normalize();
    const up = towards.clone().cross(right);
    const tall = Math.tan((this.camera.fov * Math.PI) / 360);
    const wide = tall * this.camera.aspect;
    let distance = 1e-3;
    for (const point of points) {
      const from = point.clone().sub(center);
      const beside = Math.max(Math.abs(from.dot(right)) / (0.84 * wide), Math.abs(from.dot(up)) / (0.76 * tall));
      distance = Math.max(distance, beside + from.dot(towards));
    }
    this.controls.target.copy(center);
    this.camera.position.copy(towards.multiplyScalar(distance).add(center));
    this.camera.near = distance / 100;
    this.camera.far = distance * 60;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  bounds(parts) {
    const box = new THREE.Box3();
    this.world.updateMatrixWorld(true);
    for (const part of parts) box.expandByObject(part);
    return box;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2) * this.scale);
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() {
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame(() => {
      this.isAsked = false;
      this.drawNow();
    });
  }

  drawNow() {
    const size = this.size ?? 1;
    this.sun.target.position.copy(this.controls.target);
    this.sun.position.copy(this.controls.target).add(new THREE.Vector3(1.2, -0.7, 2.6).multiplyScalar(1.3 * size));
    this.renderer.render(this.world, this.camera);
  }

  // Of the robot and its shadow, the rest transparent.
  picture() {
    const surfaces = (this.floors ?? []).map(({ surface }) => surface);
    surfaces.forEach((surface) => (surface.visible = false));
    this.drawNow();
    const picture = this.renderer.domElement.toDataURL("image/png");
    surfaces.forEach((surface) => (surface.visible = true));
    this.drawNow();
    return picture;
  }
}
