// The playground's page: reads its data, builds scene and panels, and ties controls, keys and files to them.

import { App } from "./app.js";
import { CodePanel } from "./codepanel.js";
import { EditPanel } from "./editpanel.js";
import { chosen, dropped, meshesIn, robotsOf } from "./files.js";
import { Grab } from "./grab.js";
import { Hover } from "./hover.js";
import { JointPanel } from "./jointpanel.js";
import { KINDS } from "./kinds.js";
import { Lesson } from "./lesson.js";
import { Library } from "./library.js";
import { Loop } from "./loop.js";
import { fillPlayHelp } from "./playhelp.js";
import { Quantities } from "./quantities.js";
import { Record } from "./record.js";
import { stateOf } from "./share.js";
import { Stage } from "./stage.js";
import { addTabs } from "./tabs.js";
import { startTheme } from "./theme.js";

const find = (id) => document.getElementById(id);
let opened;
window.mozzi = { ready: new Promise((resolve) => (opened = resolve)) };

const data = JSON.parse(find("data").textContent);
const library = await Library.open(find("wasm").textContent).catch((error) => {
  find("about").textContent = `This browser cannot run the page: ${error.message}`;
  throw error;
});
const entries = data.robots.map((robot) => ({ ...robot, meshes: (robot.meshes ?? []).map((mesh) => ({ ...mesh, path: mesh.name })) }));

const stage = new Stage(find("scene"), find("toggles"));
const app = new App(library, stage, find, data.friction);
const hosts = addTabs(find("tabs"), find("pages"), { ...(data.lesson ? { lesson: "Lesson" } : {}), joints: "Joints", numbers: "Numbers", plots: "Plots", edit: "Edit", code: "Code" }, () => app.robot && app.draw());
app.loop = new Loop(app);
app.record = new Record(hosts.plots, (time) => app.seek(time));
app.quantities = new Quantities(hosts.numbers, app);
const joints = new JointPanel(hosts.joints, app);
const editor = new EditPanel(hosts.edit, app);
const code = new CodePanel(hosts.code, app);
const between = (act) => () => !app.isBetween && act();
const asked = new URLSearchParams(location.hash.slice(1));
const linked = await stateOf(location.hash).catch(() => null);
app.lesson = data.lesson && new Lesson(hosts.lesson, app, data.lesson, linked?.answers);
app.panels = [
  { take: (robot) => joints.take(robot), update: between(() => joints.show(app.isPlaying && app.hasTarget ? app.settings.target : app.state.theta, app.state.dtheta)) },
  { take: (robot) => app.quantities.take(robot), update: between(() => app.quantities.update()) },
  { take: (robot) => app.record.take(robot, stage.jointColour), update: between(() => app.record.show()) },
  { take: (robot) => editor.take(robot), update: () => !hosts.edit.hidden && editor.show() },
  { take: (robot) => code.take(robot), update: between(() => code.update()) },
];

const theme = startTheme(find("theme"), () => {
  if (!app.robot) return;
  stage.ground(app.settings.ground !== null);
  app.draw();
  app.record.plots.forEach((plot) => plot.redraw());
});

function showEntries() {
  find("robot").replaceChildren(...entries.map(({ name }, k) => new Option(name, k)));
  find("robot").value = entries.indexOf(app.entry);
}
app.onEntry = showEntries;

async function openEntry(entry, more) {
  const isFirst = !app.robot;
  if (!isFirst) app.remember();
  const done = await app.open(entry, more);
  if (done && !app.grabbed) [app.grabbed, app.hover] = [new Grab(app), new Hover(stage)];
  showEntries();
  return done;
}

// Meshes without a robot are those of the robot that is shown.
async function addMeshes(list) {
  const { entry, description, values, state } = app;
  entry.meshes = [...list, ...(entry.meshes ?? [])];
  const { theta, dtheta } = state;
  return app.open(entry, { description, values, theta, dtheta, isNew: true });
}

// Robots of dropped or chosen files join the menu; the likeliest is opened.
async function openFiles(list, isForMeshes = false) {
  const meshes = meshesIn(list);
  const found = isForMeshes && meshes.length > 0 ? [] : await robotsOf(list);
  if (found.length === 0 && meshes.length > 0 && app.robot) return addMeshes(meshes);
  if (found.length === 0) {
    app.trouble("No robot is among these files", "Expected a file of URDF, xacro, MJCF, SDFormat or mozzi's JSON; meshes may come with it, as files or in folders.");
    return false;
  }
  const done = await openEntry(found[0]);
  const known = entries.filter((entry) => !found.some(({ file }) => entry.isDropped && entry.file === file));
  entries.splice(0, entries.length, ...(done ? found : found.slice(1)), ...known);
  showEntries();
  return done;
}

function addFiles() {
  let isForMeshes = false;
  find("robot").addEventListener("change", () => openEntry(entries[find("robot").value]));
  for (const [button, input] of [["open", "files"], ["folder", "folders"]]) {
    find(button).addEventListener("click", () => {
      isForMeshes = false;
      find(input).click();
    });
    find(input).addEventListener("change", async () => {
      const list = chosen(find(input).files);
      find(input).value = "";
      if (list.length > 0) await openFiles(list, isForMeshes);
      isForMeshes = false;
    });
  }
  find("missing").addEventListener("click", () => {
    isForMeshes = true;
    find("folders").click();
  });
  let depth = 0;
  const show = (isOver) => (find("drop").hidden = !isOver);
  addEventListener("dragenter", (event) => {
    event.preventDefault();
    show(++depth > 0);
  });
  addEventListener("dragleave", () => show(--depth > 0));
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("drop", async (event) => {
    event.preventDefault();
    show((depth = 0) > 0);
    await openFiles(await dropped(event.dataTransfer));
  });
}

function addControls() {
  find("play").addEventListener("click", () => (app.isPlaying ? app.pause() : app.play()));
  find("reset").addEventListener("click", () => app.reset());
  const set = (change) => {
    Object.assign(app.settings, change);
    if (!app.isPlaying) app.settings.target = null;
    app.apply();
    if (!app.isPlaying) app.refresh();
  };
  find("motors").addEventListener("change", () => {
    app.settings.target = null;
    set({ motors: find("motors").value });
    app.showControls();
  });
  find("omega").addEventListener("input", () => {
    set({ omega: find("omega").valueAsNumber });
    app.showControls();
  });
  // on a phone the settings are a sheet
  const sheet = (isOpen) => {
    find("settings").classList.toggle("open", isOpen);
    find("sheet").setAttribute("aria-expanded", String(isOpen));
  };
  find("sheet").addEventListener("click", () => sheet(find("sheet").getAttribute("aria-expanded") !== "true"));
  document.addEventListener("pointerdown", (event) => !event.target.closest("#settings, #sheet") && sheet(false));
  app.closeSheet = () => sheet(false);
  find("ground").addEventListener("change", () => app.setGround(find("ground").checked));
  find("floating").addEventListener("change", async () => {
    await app.edit({ what: find("floating").checked ? "floating" : "fixed" });
    app.showControls();
  });
  find("speed").addEventListener("change", () => (app.speed = Number(find("speed").value)));
  find("trouble-close").addEventListener("click", () => app.clearTrouble());
  find("picture").addEventListener("click", () => app.savePicture());
  find("share").addEventListener("click", () => app.share().catch((error) => app.trouble("No link", error.message)));
  find("help").addEventListener("click", () => find("about-page").showModal());
  app.fillNotes = () => fillPlayHelp(find("about-page"), [...app.robot.warnings, ...app.omitted]);
}

function addKeys() {
  const kinds = Object.fromEntries(Object.entries(KINDS).map(([kind, { key }]) => [key, kind]));
  const acts = {
    " ": () => find("play").click(), Home: () => app.reset(), 0: () => stage.look(), d: () => theme.toggle(), p: () => app.savePicture(),
    o: () => find("open").click(), "?": () => find("about-page").showModal(), Escape: () => [app.clearTrouble(), app.closeSheet()],
  };
  document.addEventListener("keydown", (event) => {
    const { tagName, type } = event.target;
    const isText = tagName === "INPUT" && type !== "range" && type !== "checkbox";
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z" && !isText) {
      event.preventDefault();
      return event.shiftKey ? app.history.redo() : app.history.undo();
    }
    if (event.ctrlKey || event.metaKey || event.altKey || find("about-page").open || isText || tagName === "SELECT") return null;
    if (["BUTTON", "SUMMARY", "INPUT"].includes(tagName) && (event.key === " " || event.key.length > 1)) return null;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const act = acts[key] ?? (stage.buttons[kinds[key]]?.isConnected ? () => stage.toggle(kinds[key], !stage.shown[kinds[key]]) : null);
    if (!act) return null;
    event.preventDefault();
    return act();
  });
}

if (app.lesson) {
  app.panels.push({ take: () => {}, update: between(() => app.lesson.update()) });
  stage.chosen = data.lesson.show;
}

async function start() {
  addFiles();
  addControls();
  addKeys();
  if (asked.has("theme")) theme.set(asked.get("theme"));
  else theme.apply();
  let entry = entries[data.first ?? 0];
  if (linked) {
    const { name, files, file } = linked.robot;
    entry = files ? { name, files, file, meshes: [], isDropped: true, isLinked: true } : entries.find((known) => known.name === name) ?? entry;
    if (files) entries.unshift(entry);
    Object.assign(app.settings, linked.settings, { target: null });
  }
  if (!(await openEntry(entry, linked ?? {})) && linked) await openEntry(entries[data.first ?? 0]);
  if (linked) {
    if (linked.frame < app.robot.frames.length) app.setFrame(linked.frame);
    if (linked.settings?.target?.length === app.robot.nq) app.settings.target = linked.settings.target;
    app.apply();
    app.refresh();
  }
  app.lesson?.start();
  stage.scene.drawNow();
}

addEventListener("hashchange", () => /s=/.test(location.hash) && location.reload());

Object.assign(window.mozzi, {
  app, library, entries, openFiles,
  // Of text files alone: { path: text }.
  openTexts: (texts) => openFiles(Object.entries(texts).map(([path, text]) => ({ path, file: new File([text], path.split("/").pop()) }))),
  compute: (request, inputs) => app.robot.compute(request, inputs),
  state: () => app.state,
});
opened(start());
