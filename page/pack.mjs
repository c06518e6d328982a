// Gzips a file: `node pack.mjs FILE TO`.

import { readFileSync, writeFileSync } from "node:fs";
import { gzip } from "./gzip.mjs";

const [from, to] = process.argv.slice(2);
const whole = readFileSync(from);
const packed = await gzip(whole);
writeFileSync(to, packed);
console.log(`${to}: ${packed.length} bytes of ${whole.length}`);
