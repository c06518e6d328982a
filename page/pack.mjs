// Gzips a file as small as it gets, the same bytes each time: `node pack.mjs FILE TO`.

import { readFileSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";

const [from, to] = process.argv.slice(2);
const [whole, packed] = [readFileSync(from), gzipSync(readFileSync(from), { level: 9 })];
writeFileSync(to, packed);
console.log(`${to}: ${packed.length} bytes of ${whole.length}`);
