// Prints the torques of a UR5, as JSON, by the WebAssembly of the report's page: node torques.mjs WASM.gz ROBOT.json

import { readFileSync } from "node:fs";
import { Library } from "../../page/src/library.js";

const [wasm, file] = process.argv.slice(2);
const library = await Library.open(readFileSync(wasm).toString("base64"));
const robot = library.load(file, readFileSync(file, "utf8"));
const state = { theta: [0, -1.2, 1.5, 0.3, 1.1, 0], dtheta: Array(6).fill(0.1), ddtheta: Array(6).fill(0.5) };
console.log(JSON.stringify(robot.compute({ quantity: "inverse_dynamics" }, state).tau));
