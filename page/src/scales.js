// What a length in the scene means, a line for each layer that is on.

import { KINDS } from "./kinds.js";

// "5 N = 0.21 m": a round number whose length is about `size`; nothing where nothing is drawn.
export function scale(unit, metres, size) {
  if (!(metres > 0) || !Number.isFinite(metres)) return "";
  const most = size / metres;
  const power = 10 ** Math.floor(Math.log10(most));
  const round = [5, 2, 1].map((k) => k * power).find((x) => x <= most * 1.000001) ?? power;
  return `${Number(round.toPrecision(1))} ${unit} = ${Number((round * metres).toPrecision(2))} m`;
}

// Lines { kind, text } of arrows and ellipsoids; `touch` is the length of a newton at a contact.
export function scales(overlays, shown, touch) {
  const { longest, reach, drawn } = overlays;
  const of = (kind, unit) => scale(unit, longest[kind] > 0 ? (0.3 * reach) / longest[kind] : 0, 0.3 * reach);
  const both = (list) => list.filter(Boolean).join(", ");
  const cut = drawn.isCut ? `, cut at ${Number((0.6 * reach).toPrecision(2))} m` : "";
  const lines = {
    twists: both([of("spin", "rad/s"), of("speed", "m/s")]),
    wrenches: both([of("moment", "N m"), of("force", "N")]),
    constraints: of("carried", "N"),
    contacts: scale("N", touch, 0.3 * reach),
    manipulability: scale("m/s", drawn.velocity, 0.3 * reach),
    torque: scale("N", drawn.force, 0.3 * reach) && scale("N", drawn.force, 0.3 * reach) + cut,
  };
  return Object.entries(lines).filter(([kind, text]) => shown[kind] && text).map(([kind, text]) => ({ kind, text: `${KINDS[kind].name}: ${text}` }));
}

// Shows them, where they differ from what is there.
export function showScales(host, lines) {
  const key = JSON.stringify(lines);
  if (host.dataset.key === key) return;
  host.dataset.key = key;
  host.replaceChildren(...lines.map(({ kind, text }) => {
    const p = document.createElement("p");
    p.style.setProperty("--colour", KINDS[kind].colour);
    p.append(document.createElement("i"), text);
    return p;
  }));
}
