// Bundles a page into one HTML file, gzipped: `node build.mjs report|play FILE`. The same sources give the same text.

import { createHash } from "node:crypto";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import { gzip } from "./gzip.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const text = (file) => readFileSync(join(here, file), "utf8").replaceAll("\r\n", "\n");

// Script, template, styles, and what the WebAssembly was made of, with its hash: see xtask/src/wasm.rs.
const PAGES = {
  report: { main: "src/main.js", html: "index.html", styles: ["style.css"], wasm: "../crates/mozzi-report/bundle/mozzi.wasm.txt" },
  play: { main: "src/play.js", html: "play.html", styles: ["style.css", "play.css"], wasm: "../crates/mozzi-report/bundle/play.wasm.txt" },
};
const [name, file] = process.argv.slice(2);
const page = PAGES[name];

// 64-bit FNV-1a of all sources, which `cargo xtask test` computes again: was the bundle made from them?
function stamp() {
  const scripts = readdirSync(join(here, "src")).filter((name) => name.endsWith(".js")).map((name) => `src/${name}`);
  const notes = Object.values(PAGES).map(({ wasm }) => wasm);
  const files = [...notes, "build.mjs", "index.html", "pack.mjs", "package-lock.json", "package.json", "play.css", "play.html", "style.css", ...scripts].sort();
  let hash = 0xcbf29ce484222325n;
  for (const byte of Buffer.from(files.map((file) => `${file}\n${text(file)}`).join(""))) {
    hash = BigInt.asUintN(64, (hash ^ BigInt(byte)) * 0x100000001b3n);
  }
  return hash.toString(16).padStart(16, "0");
}

const bundled = await build({
  entryPoints: [join(here, page.main)],
  bundle: true, minify: true, write: false, format: "esm", target: "es2022", legalComments: "none", charset: "ascii",
});
const script = bundled.outputFiles[0].text.trim().replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
const { code } = await (await import("esbuild")).transform(page.styles.map(text).join("\n"), { loader: "css", minify: true, charset: "ascii" });
const style = code.trim();

const hashed = (part) => `'sha256-${createHash("sha256").update(part).digest("base64")}'`;
// nothing is fetched; the textures that a mesh asks for are an empty picture; WebAssembly is in the page, not evaluated text
const policy = [
  "default-src 'none'", `script-src ${hashed(script)} 'wasm-unsafe-eval'`, "style-src 'unsafe-inline'", "img-src data: blob:", "connect-src 'none'",
  "base-uri 'none'", "form-action 'none'",
].join("; ");

const { version } = JSON.parse(readFileSync(join(here, "node_modules/three/package.json"), "utf8"));
const notice = `<!--
Made by \`cargo xtask page\` from the sources in page/, stamp ${stamp()}. It contains three.js ${version}, https://threejs.org:

${text("node_modules/three/LICENSE").trim()}

${text(page.wasm).trim()}
-->`;
const parts = { policy, style, script };
const html = text(page.html).replace(/\{\{(policy|style|script)\}\}/g, (_, name) => parts[name]);
writeFileSync(file, await gzip(Buffer.from(html.replace("<!doctype html>", () => `<!doctype html>\n${notice}`))));
console.log(`${file}: ${html.length} bytes, three.js ${version}`);
