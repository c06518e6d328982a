// What is under the pointer.

import * as THREE from "three";

export class Picker {
  // `view` has the scene, the robot and the parts that can be hit.
  constructor(view) {
    this.view = view;
    this.ray = new THREE.Raycaster();
  }

  get canvas() {
    return this.view.scene.renderer.domElement;
  }

  aim({ clientX, clientY }) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    this.ray.setFromCamera(new THREE.Vector2((2 * (clientX - left)) / width - 1, 1 - (2 * (clientY - top)) / height), this.view.scene.camera);
  }

  // The body, and the point.
  hit() {
    const { scene, robot, parts } = this.view;
    scene.world.updateMatrixWorld();
    for (const { object, point } of this.ray.intersectObjects(parts, true)) {
      for (let group = object; group; group = group.parent) {
        const body = scene.bodies.indexOf(group);
        if (body >= 0) return { body, point };
        const frame = scene.frames.indexOf(group);
        if (frame >= 0) return { body: robot.frames[frame].body, point };
      }
    }
    return null;
  }
}
