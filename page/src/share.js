// A link: the page's address with the robot and its state in the fragment, gzipped. Nothing goes to a server.

import { bytes } from "./data.js";

// A dropped robot whose texts take more is not put into a link, bytes of the fragment.
export const MOST = 60_000;

export async function linkOf(state) {
  const stream = new Blob([JSON.stringify(state)]).stream().pipeThrough(new CompressionStream("gzip"));
  const packed = new Uint8Array(await new Response(stream).arrayBuffer());
  let text = "";
  for (const byte of packed) text += String.fromCharCode(byte);
  const fragment = btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  if (fragment.length > MOST) throw new Error(`this robot needs a link of ${fragment.length} characters, more than ${MOST}: save it as JSON instead`);
  return `${location.href.split("#")[0]}#s=${fragment}`;
}

// The state in a fragment; null if there is none.
export async function stateOf(fragment) {
  const text = /(^#|&)s=([\w-]+)/.exec(fragment)?.[2];
  if (!text) return null;
  const stream = new Blob([bytes(text.replaceAll("-", "+").replaceAll("_", "/"))]).stream().pipeThrough(new DecompressionStream("gzip"));
  return JSON.parse(await new Response(stream).text());
}
