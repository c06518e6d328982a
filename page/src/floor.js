// The floor: an opaque surface with a grid, seen from above alone, and the shadows on it.

import * as THREE from "three";
import { read } from "./session.js";
import { colour } from "./theme.js";

// Pixels of a cell of the grid.
const CELL = 128;
// What is below the floor is seen through it.
const GLASS = 0.35;

// One cell with its lines; far away they fade into one colour.
function texture(cells) {
  const canvas = Object.assign(document.createElement("canvas"), { width: CELL, height: CELL });
  const draw = canvas.getContext("2d");
  draw.fillStyle = colour("floor");
  draw.fillRect(0, 0, CELL, CELL);
  draw.fillStyle = colour("grid");
  draw.fillRect(0, 0, CELL, 1.5);
  draw.fillRect(0, 0, 1.5, CELL);
  const map = new THREE.CanvasTexture(canvas);
  map.wrapS = map.wrapT = THREE.RepeatWrapping;
  map.repeat.set(cells, cells);
  map.anisotropy = 8;
  map.colorSpace = THREE.SRGBColorSpace;
  return map;
}

// `order`: of several planes the later ones are drawn over the first.
export class Floor extends THREE.Group {
  constructor(cell, cells, shadowed, order) {
    super();
    const material = new THREE.MeshBasicMaterial({ map: texture(cells), toneMapped: false, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 - order });
    this.surface = new THREE.Mesh(new THREE.PlaneGeometry(cells * cell, cells * cell), material);
    this.surface.renderOrder = -1;
    const shadow = new THREE.Mesh(new THREE.PlaneGeometry(shadowed, shadowed), new THREE.ShadowMaterial({ opacity: 0.28 }));
    shadow.receiveShadow = true;
    this.add(this.surface, shadow);
  }

  // Is something of the robot below it?
  uncover(isBelow) {
    const { material } = this.surface;
    if (material.transparent === isBelow) return;
    Object.assign(material, { transparent: isBelow, depthWrite: !isBelow, opacity: isBelow ? GLASS : 1, needsUpdate: true });
  }

  dispose() {
    this.surface.material.map.dispose();
    for (const { geometry, material } of this.children) [geometry, material].forEach((part) => part.dispose());
  }
}

// Where the floor is without a ground: below a floating robot and below one that hangs, else z = 0.
export function floorHeight(robot, bottom, reach) {
  if (robot.isFloating) return bottom;
  const theta = read(robot, "theta");
  const lowest = Math.min(bottom, ...robot.poses(robot.neutral).map(({ p }) => p[2]));
  robot.set("theta", theta);
  return lowest < -0.15 * reach ? lowest - 0.05 * reach : 0;
}
