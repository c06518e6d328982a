// The page: reads its data, builds the scene and the panel, ties them to the time.

import * as THREE from "three";
import { seriesColour } from "./colours.js";
import { lastEvent } from "./contacts.js";
import { plotsOf } from "./curves.js";
import { readMotion, readRobot, stateAt } from "./data.js";
import { floorHeight } from "./floor.js";
import { fillHelp } from "./help.js";
import { randomPose } from "./joints.js";
import { KINDS, usualKinds } from "./kinds.js";
import { onKeys } from "./keys.js";
import { Hover } from "./hover.js";
import { Library } from "./library.js";
import { MatrixPicture } from "./matrix.js";
import { Overlays } from "./overlays.js";
import { Player, SPEEDS } from "./player.js";
import { Plot, patternSwitch } from "./plots.js";
import { farthest } from "./robot.js";
import { Scene } from "./scene.js";
import { addShapes, seeThrough } from "./shapes.js";
import { addSkeleton } from "./skeleton.js";
import { addSliders } from "./sliders.js";
import { scales, showScales } from "./scales.js";
import { startTheme } from "./theme.js";
import { fillToggles } from "./toggles.js";
import { unitOf } from "./units.js";
import { aboutRobot, counted } from "./words.js";

const find = (id) => document.getElementById(id);
// For the console, and for tests: `ready` comes when the page can be used.
let opened;
window.mozzi = { ready: new Promise((resolve) => (opened = resolve)) };

const raw = JSON.parse(find("data").textContent);
const library = await Library.open(find("wasm").textContent).catch((error) => {
  find("hint").textContent = `This browser cannot run the page: ${error.message}`;
  throw error;
});
const robot = readRobot(library, raw);
const motion = readMotion(raw.motion, robot);
const asked = new URLSearchParams(location.hash.slice(1)); // #t=1.2&show=axes,twists&theme=dark
const jointColour = (j) => seriesColour(j);

const still = () => ({ theta: [...robot.start], dtheta: null, ddtheta: null, tip: null, loops: null });
let state = motion ? stateAt(motion, motion.t[0]) : still();

find("name").textContent = robot.name;
const mass = raw.robot.links.reduce((sum, { G }) => sum + G[3][3], 0);
find("about").textContent = [motion?.title, aboutRobot(robot, mass)].filter(Boolean).join("; ");

const scene = new Scene(find("scene"), robot);
const reach = reachOf();
const overlays = new Overlays(robot, scene, reach, jointColour, motion?.contacts);
const skeleton = addSkeleton(robot, scene, reach, jointColour, state.theta);
const matrix = new MatrixPicture(find("matrix"), robot.velocities, unitOf({ of: "robot" }, { name: "M", shape: [robot.n, robot.n], unit: "kg m², kg m or kg" }, robot));
const plots = [];

// How far frames are from the base: what all marks are scaled by.
function reachOf() {
  const T = robot.bodyPoses(robot.poses(robot.neutral));
  const far = T.map(({ p }) => Math.hypot(...p.map((x, i) => x - T[0].p[i])));
  const frames = robot.frames.map(({ body, p }) => far[body] + Math.hypot(...p));
  const solids = robot.shapes.filter(({ kind }) => kind !== "mesh").map(({ T: at, size }) => Math.hypot(...at.p) + 0.6 * Math.max(...size));
  return Math.max(...far, ...frames, ...solids, 0.05);
}

let failure = "";
function place() {
  try {
    const T = robot.poses(state.theta);
    scene.place(T, robot.bodyPoses(T));
    if (state.touch) scene.placePlanes(state.touch.planes, state.time);
    overlays.update(state);
    if (shown.mass) matrix.show(robot.massMatrix(state.theta));
    failure = "";
  } catch (error) {
    failure = error.message;
  }
  hint();
}

// Meshes that were not found, of the notes of mozzi-report.
const lost = raw.notes.reduce((sum, note) => sum + (note.startsWith("mesh ") ? 1 : Number(/^(\d+) meshes:/.exec(note)?.[1] ?? 0)), 0);

// Below the scene: how far the meshes are, what was left out, the scale of contact forces, what last happened to contacts.
let omitted = 0;
let progress = "";
function hint() {
  const said = [failure, progress, lost > 0 ? `${counted(lost, "mesh was", "meshes were")} not found: see ?` :
    omitted > 0 ? `${counted(omitted, "shape was", "shapes were")} left out: see ?` : ""];
  if (motion?.contacts && shown.contacts) {
    said.push(lastEvent(motion.contacts, state.time));
  }
  showScales(find("scales"), scales(overlays, shown, overlays.touches?.scale ?? 0));
  find("hint").textContent = said.filter((text) => text !== "").join("\n");
}

// What is shown, by kind.
const shown = {};
let layers = { visual: [], collision: [] };
const possible = {
  shapes: robot.shapes.length > 0,
  glass: robot.shapes.length > 0,
  twists: Boolean(motion?.dtheta),
  // with loops also what they carry has to be known
  wrenches: robot.constraints.length > 0 ? Boolean(motion?.loops) : !motion || Boolean(motion.dtheta && motion.ddtheta),
  constraints: robot.constraints.length > 0,
  contacts: Boolean(motion?.contacts),
  applied: Boolean(motion?.contacts),
  path: Boolean(motion),
  mass: robot.n > 0,
};
function show(kind, isOn) {
  shown[kind] = isOn;
  buttons[kind]?.setAttribute("aria-pressed", String(isOn));
  const all = [...layers.visual, ...layers.collision];
  if (kind === "shapes") all.forEach((holder) => (holder.visible = isOn));
  else if (kind === "glass") seeThrough(all, isOn);
  else if (kind === "skeleton") skeleton.forEach((part) => (part.visible = isOn));
  else if (kind === "mass") find("matrix").hidden = !isOn;
  else overlays.show(kind, isOn);
  place();
}

const buttons = fillToggles(find("toggles"), (kind) => possible[kind] !== false, (kind) => show(kind, !shown[kind]));

function row() {
  const div = find("panel").appendChild(document.createElement("div"));
  div.className = "row";
  return div;
}

// The frame whose path and ellipsoids are meant.
function addFrameChoice() {
  const div = row();
  const label = div.appendChild(document.createElement("label"));
  label.textContent = "End effector ";
  const select = label.appendChild(document.createElement("select"));
  robot.frames.forEach(({ name }, k) => select.append(new Option(name, k)));
  select.value = robot.endEffector ?? farthest(robot);
  const take = () => {
    overlays.setFrame(Number(select.value), motion);
    place();
  };
  select.addEventListener("change", take);
  take();
}

function addPlots() {
  const described = plotsOf(robot, motion, jointColour);
  const chips = find("panel").appendChild(document.createElement("div"));
  chips.className = "chips";
  robot.joints.forEach(({ name, j }) => {
    const chip = chips.appendChild(document.createElement("button"));
    chip.appendChild(document.createElement("i"));
    chip.append(name);
    chip.style.setProperty("--colour", jointColour(j));
    chip.setAttribute("aria-pressed", "true");
    chip.title = `${name}: shown or not; double click: alone`;
    const set = (isOn) => {
      chip.setAttribute("aria-pressed", String(isOn));
      plots.forEach((plot) => plot.hide(name, !isOn));
    };
    chip.addEventListener("click", () => set(chip.getAttribute("aria-pressed") !== "true"));
    chip.addEventListener("dblclick", () => {
      const isAlone = [...chips.children].every((other) => other === chip || other.getAttribute("aria-pressed") === "false");
      [...chips.children].forEach((other) => other.set(isAlone || other === chip));
    });
    chip.set = set;
  });
  find("panel").appendChild(Object.assign(document.createElement("div"), { className: "chips" })).append(patternSwitch(() => plots));
  for (const plot of described) plots.push(new Plot(find("panel"), { ...plot, t: motion.t, seek: (time) => player.seek(time) }));
}

// Value of a curve between rows.
function between(time) {
  const { low, part } = stateAt(motion, time);
  return (values) => values[low] + (part > 0 ? part * (values[low + 1] - values[low]) : 0);
}

function atTime(time) {
  state = stateAt(motion, time);
  const at = between(time);
  plots.forEach((plot) => plot.cursor(time, at));
  const digits = motion.t.at(-1) - motion.t[0] < 0.1 ? 5 : 3;
  find("time").value = time;
  find("clock").textContent = `${time.toFixed(digits)} s`;
  find("play").classList.toggle("playing", player.isPlaying);
  find("play").setAttribute("aria-label", player.isPlaying ? "Pause" : "Play");
  place();
}

const player = motion && new Player(motion.t, atTime);

function addTransport() {
  find("transport").hidden = false;
  const time = find("time");
  [time.min, time.max] = [player.start, player.end];
  time.addEventListener("input", () => player.seek(time.valueAsNumber));
  find("play").addEventListener("click", () => player.toggle());
  SPEEDS.forEach((speed) => find("speed").append(new Option(`${speed}×`, speed, speed === 1, speed === 1)));
  find("speed").addEventListener("change", () => (player.speed = Number(find("speed").value)));
  find("loop").addEventListener("click", () => {
    player.isLooping = !player.isLooping;
    find("loop").setAttribute("aria-pressed", String(player.isLooping));
  });
}

// Of the robot's shapes, and of its skeleton where that stands for missing ones, where it is now.
function bounds() {
  const all = [...layers.visual, ...layers.collision];
  return scene.bounds([...all, ...(shown.skeleton || all.length === 0 ? skeleton : [])]);
}

// All of the robot in sight: where it is now, and of a bolted one wherever the motion takes it.
function look() {
  const box = bounds();
  const { min, max } = box;
  const points = box.isEmpty() ? [] : [0, 1, 2, 3, 4, 5, 6, 7].map((k) =>
    new THREE.Vector3(k & 1 ? max.x : min.x, k & 2 ? max.y : min.y, k & 4 ? max.z : min.z));
  for (const { theta } of motion && !robot.isFloating ? some(24) : [state]) {
    robot.poses(theta).forEach(({ p }) => points.push(new THREE.Vector3(...p)));
  }
  if (shown.contacts) points.push(...overlays.touches.ends(state).map((end) => new THREE.Vector3(...end)));
  if (new THREE.Box3().setFromPoints(points).getSize(new THREE.Vector3()).length() < 0.1 * reach)
    for (const sign of [-1, 1]) points.push(new THREE.Vector3(sign * reach, sign * reach, sign * reach));
  scene.fit(points);
}

// Some of the motion's states, evenly.
function some(count) {
  const last = motion.t.length - 1;
  const step = Math.max(Math.ceil(last / count), 1);
  return Array.from({ length: Math.floor(last / step) + 1 }, (_, k) => stateAt(motion, motion.t[k * step]));
}

function randomStates(count) {
  return Array.from({ length: count }, () => ({ ...still(), theta: randomPose(robot) }));
}

function savePicture() {
  const link = document.createElement("a");
  link.download = `${robot.name}.png`;
  link.href = scene.picture();
  link.click();
}

const theme = startTheme(find("theme"), () => {
  plots.forEach((plot) => plot.redraw());
  if (scene.floors) scene.ground(scene.groundSize, scene.planes);
  place();
});

let setJoints = null;
// What the pointer meets: see Hover.
const view = {
  robot, scene, overlays, host: find("scene"),
  get parts() {
    return [...(shown.shapes ? [...layers.visual, ...layers.collision] : []), ...(shown.skeleton ? skeleton : [])];
  },
};

async function start() {
  if (asked.has("theme")) theme.set(asked.get("theme"));
  else theme.apply();
  addFrameChoice();
  if (motion) {
    addPlots();
    addTransport();
  } else {
    setJoints = addSliders(find("panel"), robot, state.theta, jointColour, place, (j) => overlays.point(j));
  }
  overlays.measure(motion ? some(60) : randomStates(30));
  onKeys({ player, player_speed: find("speed"), loop: find("loop"), theme, look, savePicture, help: find("about-page"), motion,
    toggle: (kind) => buttons[kind] && show(kind, !shown[kind]) });
  find("help").addEventListener("click", () => find("about-page").showModal());
  find("picture").addEventListener("click", savePicture);
  new Hover(view);
  const { layers: added, waiting, load } = addShapes(robot, raw.meshes, scene);
  layers = added;
  showFirst(waiting === 0);
  if (motion) player.seek(asked.has("t") ? Number(asked.get("t")) : motion.t[0]);
  scene.drawNow();
  window.mozzi.firstPicture = performance.now();
  const failures = await load((count, all) => {
    progress = count < all ? `${count} of ${all} meshes` : "";
    hint();
  });
  const notes = [...raw.notes, ...failures];
  omitted = notes.length;
  fillHelp(find("about-page"), Boolean(motion), notes);
  if (waiting > 0) showFirst(true);
  place();
  scene.drawNow();
}

// What is shown before and after the meshes are there, all of it in sight, on the ground.
function showFirst(isLoaded) {
  const hasShapes = layers.visual.length + layers.collision.length > 0;
  const first = asked.has("show") ? asked.get("show").split(",") : usualKinds(robot, hasShapes && isLoaded && lost === 0, hasShapes);
  for (const kind of Object.keys(KINDS)) show(kind, first.includes(kind) && possible[kind] !== false);
  place();
  look();
  scene.ground(reach, motion?.contacts ? motion.contacts.planes.map(({ velocity }, k) => ({ pose: state.touch.planes[k], velocity })) :
    [{ height: floorHeight(robot, bounds().min.z, reach) }]);
}

Object.assign(window.mozzi, {
  robot, motion, overlays, plots, show, library,
  seek: (time) => player.seek(time),
  setTheta: (theta) => setJoints(theta),
  state: () => state,
  // The first three rows of a frame's matrix, as the scene has it.
  framePose(name) {
    scene.world.updateMatrixWorld(true);
    const frame = scene.frames[robot.frames.findIndex((known) => known.name === name)];
    return frame.matrixWorld.clone().transpose().elements.slice(0, 12);
  },
  // A quantity by its name, at the given inputs: see Robot.compute.
  compute: (request, inputs) => robot.compute(request, inputs),
  massMatrix: () => robot.massMatrix(state.theta),
  centerOfMass: () => robot.centerOfMass(state.theta),
  semiAxes: () => overlays.singularValues(state.theta).map(({ sigma }) => sigma),
  contacts: () => overlays.touches?.drawn() ?? [],
  // Each plane's origin and z-axis, as the scene has them.
  planes: () => scene.floors.map((floor) => {
    floor.updateMatrixWorld(true);
    const { elements } = floor.matrixWorld;
    return { origin: elements.slice(12, 15), z: elements.slice(8, 11) };
  }),
  vectors: () => overlays.vectors(state),
});
opened(start());
