// The geometry of the robot's file: boxes, cylinders, spheres, capsules, ellipsoids, and meshes where the file was at hand.

import * as THREE from "three";
import { ColladaLoader } from "three/addons/loaders/ColladaLoader.js";
import { OBJLoader } from "three/addons/loaders/OBJLoader.js";
import { STLLoader } from "three/addons/loaders/STLLoader.js";
import { unzipped } from "./data.js";
import { matrixOf } from "./scene.js";

const PLAIN = [0.78, 0.8, 0.83, 1];
// what a mesh asks for beside itself (textures) is not in the page
const BLANK = "data:image/gif;base64,R0lGODlhAQABAIAAAP///wAAACwAAAAAAQABAAACAkQBADs=";

const manager = new THREE.LoadingManager();
manager.setURLModifier(() => BLANK);

const material = ([r, g, b, a]) =>
  new THREE.MeshStandardMaterial({
    color: new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace),
    roughness: 0.62,
    metalness: 0.08,
    side: THREE.DoubleSide,
    transparent: a < 1,
    opacity: a,
  });

const readers = {
  stl: (buffer) => new THREE.Mesh(new STLLoader().parse(buffer)),
  obj: (buffer) => new OBJLoader(manager).parse(new TextDecoder().decode(buffer)),
  dae: (buffer) => {
    // a URDF's mesh is meant as its numbers stand, whatever axis the file calls up
    const text = new TextDecoder().decode(buffer).replace(/<up_axis>\s*\w+\s*<\/up_axis>/, "<up_axis>Y_UP</up_axis>");
    return new ColladaLoader(manager).parse(text, "").scene;
  },
};

function primitive({ kind, size }) {
  const upright = (geometry) => geometry.rotateX(Math.PI / 2); // three.js stands on y
  switch (kind) {
    case "box":
      return new THREE.BoxGeometry(...size);
    case "sphere":
      return new THREE.SphereGeometry(size[0], 40, 24);
    case "cylinder":
      return upright(new THREE.CylinderGeometry(size[0], size[0], size[1], 48));
    case "capsule":
      return upright(new THREE.CapsuleGeometry(size[0], size[1], 12, 40));
    case "ellipsoid":
      return new THREE.SphereGeometry(1, 40, 24).scale(...size);
    default:
      return null;
  }
}

// A Collada file has colours of its own; the rest has those of the robot's file.
function paint(object, colour, hasOwnColours) {
  object.traverse((part) => {
    if (part.isLine || part.isPoints) part.visible = false;
    if (!part.isMesh) return;
    part.castShadow = true;
    part.receiveShadow = true;
    if (!part.geometry.attributes.normal) part.geometry.computeVertexNormals();
    const own = (old) => {
      const { r, g, b } = old.color.getRGB({ r: 0, g: 0, b: 0 }, THREE.SRGBColorSpace);
      return material([r, g, b, 1]);
    };
    if (hasOwnColours) part.material = Array.isArray(part.material) ? part.material.map(own) : own(part.material);
    else part.material = material(colour ?? PLAIN);
  });
  return object;
}

// Milliseconds of reading meshes between two pictures.
const SLICE = 40;

// Adds the shapes to their frames, in two layers: at once what needs no file. Answers the layers, the number of files to read, and what
// reads them, picture by picture, as long as `isWanted`; that answers what could not be read.
export function addShapes(robot, meshes, scene) {
  const layers = { visual: [], collision: [] };
  const add = (shape, object) => {
    const holder = new THREE.Group().add(object);
    holder.matrixAutoUpdate = false;
    holder.matrix.copy(matrixOf(shape.T));
    scene.frames[shape.frame].add(holder);
    layers[shape.use].push(holder);
  };
  const waiting = robot.shapes.filter(({ kind }) => kind === "mesh");
  for (const shape of robot.shapes) if (shape.kind !== "mesh") add(shape, paint(new THREE.Mesh(primitive(shape)), shape.color, false));
  const files = new Map();
  const file = (k) => {
    if (!files.has(k)) files.set(k, meshes[k].bytes ? meshes[k].bytes() : unzipped(meshes[k].gzip));
    return files.get(k);
  };
  const load = async (onRead = () => {}, isWanted = () => true) => {
    const failures = new Set();
    let began = performance.now();
    for (const [k, shape] of waiting.entries()) {
      const { format, name } = meshes[shape.mesh];
      try {
        const content = await file(shape.mesh);
        if (!isWanted()) return [];
        const object = paint(readers[format](content), shape.color, format === "dae" && !shape.color);
        object.scale.multiply(new THREE.Vector3(...shape.size));
        add(shape, object);
      } catch (error) {
        failures.add(`${name}: ${error.message}`);
      }
      onRead(k + 1, waiting.length);
      if (performance.now() - began < SLICE) continue;
      await new Promise((next) => setTimeout(next));
      began = performance.now();
    }
    return [...failures];
  };
  return { layers, waiting: waiting.length, load };
}

// Shapes that let what is inside be seen.
export function seeThrough(holders, isOn) {
  for (const holder of holders)
    holder.traverse((part) => {
      for (const each of part.isMesh ? [part.material].flat() : []) {
        each.userData.opacity ??= each.opacity;
        each.opacity = isOn ? 0.28 * each.userData.opacity : each.userData.opacity;
        each.transparent = each.opacity < 1;
        each.depthWrite = !isOn;
      }
    });
}
