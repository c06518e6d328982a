// A slow renderer draws coarser meshes, then fewer pixels and no shadows, as long as the simulation runs.

import * as THREE from "three";

// Drawing by the processor, whose smooth edges would take half of a moving picture's time.
const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;
// Pixels along an edge for one of the screen where that is so and nothing moves.
const STILL = 1.5;
// Milliseconds of a picture above which the next level is taken; pictures between two levels.
const SLOW = 42;
const WAIT = 4;
// Meshes with fewer triangles stay; cells along the longest side of the others, at each level.
const FEW = 120;
const CELLS = [0, 18, 12, 8];

export class Quality {
  constructor(stage) {
    Object.assign(this, { stage, level: 0, mean: 0, count: 0, software: softwareContext() });
  }

  get still() {
    return this.software ? STILL : 1;
  }

  frame(interval) {
    this.count++;
    this.mean = this.count === 1 ? 0 : this.count === 2 ? interval : 0.6 * this.mean + 0.4 * interval;
    if (this.count > WAIT && this.mean > SLOW && this.level < 3) this.set(this.mean > 3 * SLOW ? 3 : this.level + 1);
  }

  // Full quality, where nothing moves.
  rest() {
    if (this.level > 0) this.set(0);
    this.count = 0;
  }

  set(level) {
    [this.level, this.count] = [level, 0];
    const { scene, shapes } = this.stage;
    for (const holder of shapes)
      holder.traverse((part) => {
        if (!part.isMesh) return;
        part.userData.fine ??= part.geometry;
        part.geometry = level > 0 ? this.coarse(part.userData.fine, level) : part.userData.fine;
      });
    scene.sun.castShadow = level < 2;
    scene.scale = [this.still, 1, 0.75, 0.5][level];
    scene.resize();
    scene.drawNow(); // at once: another size empties the canvas
  }

  coarse(fine, level) {
    fine.userData.coarse ??= [];
    return (fine.userData.coarse[level] ??= coarse(fine, CELLS[level]));
  }
}

// The canvas and context of a processor that draws, whose start takes a quarter of a second; of graphics hardware the names alone are
// asked, since smooth edges are chosen when a context is made.
function softwareContext() {
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("webgl2", { alpha: true, stencil: false, antialias: false, preserveDrawingBuffer: true });
  if (!context) return null;
  const names = context.getExtension("WEBGL_debug_renderer_info");
  if (SOFTWARE.test(context.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : context.RENDERER))) return { canvas, context };
  context.getExtension("WEBGL_lose_context")?.loseContext();
  return null;
}

// The geometry with all vertices of a cell of a grid made one; triangles within a cell go.
export function coarse(fine, cells) {
  const { position } = fine.attributes;
  const corners = fine.index ? fine.index.count : position.count;
  if (corners < 3 * FEW || fine.groups.length > 1) return fine;
  fine.computeBoundingBox();
  const { min, max } = fine.boundingBox;
  const cell = Math.max(max.x - min.x, max.y - min.y, max.z - min.z) / cells;
  const places = new Map();
  const [points, index] = [[], []];
  const vertex = (k) => {
    const at = fine.index ? fine.index.getX(k) : k;
    const [x, y, z] = [position.getX(at), position.getY(at), position.getZ(at)];
    const key = (Math.floor((x - min.x) / cell) * 64 + Math.floor((y - min.y) / cell)) * 64 + Math.floor((z - min.z) / cell);
    if (!places.has(key)) {
      places.set(key, points.length / 3);
      points.push(x, y, z);
    }
    return places.get(key);
  };
  for (let k = 0; k + 2 < corners; k += 3) {
    const [a, b, c] = [vertex(k), vertex(k + 1), vertex(k + 2)];
    if (a !== b && b !== c && c !== a) index.push(a, b, c);
  }
  const made = new THREE.BufferGeometry();
  made.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
  made.setIndex(index);
  made.computeVertexNormals();
  return made;
}
