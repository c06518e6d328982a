// Dropped and chosen files: which are robots, and where a robot's meshes are.

const ROBOT = /\.(urdf|xacro|xml|mjcf|sdf|json)$/i;
const TEXT = /\.(urdf|xacro|xml|mjcf|sdf|json|ya?ml)$/i;
const MESH = /\.(stl|obj|dae)$/i;
// Larger texts are no robots.
const MOST = 64 << 20;

// Every file of a drop, with its path: folders are read to their ends.
export async function dropped(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  if (entries.length === 0) return chosen(transfer.files);
  const found = [];
  const visit = async (entry) => {
    if (entry.isFile) {
      const file = await new Promise((resolve, reject) => entry.file(resolve, reject));
      found.push({ path: entry.fullPath.replace(/^\//, ""), file });
      return;
    }
    const reader = entry.createReader();
    for (;;) {
      const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
      if (some.length === 0) return;
      for (const one of some) await visit(one);
    }
  };
  for (const entry of entries) await visit(entry);
  return found;
}

export const meshesIn = (list) => list.filter(({ path }) => MESH.test(path));

export const chosen = (list) => [...list].map((file) => ({ path: file.webkitRelativePath || file.name, file }));

// The robots among files, the likeliest first: { name, file, files, meshes }.
export async function robotsOf(list) {
  const texts = {};
  for (const { path, file } of list) if (TEXT.test(path) && file.size < MOST) texts[path] = await file.text();
  const meshes = meshesIn(list);
  // of JSON any file may be a robot if it stands alone
  const isRobot = (path) =>
    /\.json$/i.test(path) ? list.length === 1 || /"links"\s*:/.test(texts[path]) : /<(robot|mujoco)[\s>]/.test(texts[path]);
  const included = (path) => Object.values(texts).some((text) => new RegExp(`<(xacro:)?include[^>]*[/"']${escaped(last(path))}["']`).test(text));
  const rank = (path) => (included(path) ? 4 : 0) + (/\.urdf$/i.test(path) ? 0 : /\.urdf\.xacro$/i.test(path) ? 1 : 2);
  const robots = Object.keys(texts).filter((path) => ROBOT.test(path) && isRobot(path)).sort((a, b) => rank(a) - rank(b));
  // a single text that looks like nothing is opened all the same: the reader says what is wrong with it
  if (robots.length === 0) robots.push(...Object.keys(texts).filter((path) => ROBOT.test(path) && !/package\.xml$/.test(path)).slice(0, 1));
  return robots.map((path) => ({ name: last(path), file: path, files: texts, meshes, isDropped: true }));
}

const last = (path) => path.split("/").pop();
const escaped = (text) => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");

// The meshes of a robot's shapes among the files: the one whose path ends like the address, at least by its name.
export function meshesOf(shapes, meshes) {
  const addresses = [...new Set(shapes.filter(({ kind }) => kind === "mesh").map(({ address }) => address))];
  const found = [];
  const missing = [];
  for (const address of addresses) {
    const parts = address.split(/[/\\]/).reverse();
    const common = ({ path }) => {
      const own = path.split("/").reverse();
      let k = 0;
      while (k < Math.min(own.length, parts.length) && own[k].toLowerCase() === parts[k].toLowerCase()) k++;
      return k;
    };
    const best = meshes.reduce((best, mesh) => (common(mesh) > (best ? common(best) : 0) ? mesh : best), null);
    const format = parts[0].split(".").pop().toLowerCase();
    if (best && MESH.test(address)) found.push({ name: address, format, gzip: best.gzip, bytes: best.file && (() => best.file.arrayBuffer()) });
    else missing.push(`the mesh ${address} is not among the files`);
  }
  const kept = shapes.filter(({ kind, address }) => kind !== "mesh" || found.some(({ name }) => name === address));
  const placed = kept.map((shape) => (shape.kind === "mesh" ? { ...shape, mesh: found.findIndex(({ name }) => name === shape.address) } : shape));
  return { shapes: placed, meshes: found, missing };
}
