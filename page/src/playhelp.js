// Help of the playground: what to do, keys, signs, and what was left out.

import { KINDS } from "./kinds.js";

const TODO = [
  ["open", "drop a URDF, xacro, MJCF or JSON file on the page, or a folder with its meshes; nothing leaves this computer"],
  ["play", "the robot moves in real time by steps of 1 ms: Runge-Kutta of order 4, or Moreau-Jean's method if there is dry friction or ground"],
  ["motors", "off; g(θ); g(θ) + K_p e + K_d ė; M(θ)(K_p e + K_d ė) + h(θ, θ̇), with K_p = ω² I and K_d = 2ω I: of PD control I is the inertia that a joint moves, of computed torque 1. Sliders set the target while it plays"],
  ["drag", "paused: the joint under the pointer, with Shift the end effector by inverse kinematics. Playing: a spring pulls the robot, with Shift the target of the motors follows"],
  ["ground", "the plane z = 0, with friction as in `mozzi simulate --ground`; collision shapes without meshes touch it, else the origins of the last links"],
];
const KEYS = [["space", "play or pause"], ["Home", "back to the start"], ["Ctrl-Z, Ctrl-Shift-Z", "undo, redo"], ["0", "all of the robot in sight"], ["o", "open files"], ["d", "light or dark"], ["p", "save a picture"], ["Esc", "close a message"], ["?", "this page"]];

export function fillPlayHelp(dialog, notes) {
  dialog.replaceChildren();
  // first of all, so that the page opens at its beginning
  const close = dialog.appendChild(document.createElement("button"));
  close.className = "close";
  close.textContent = "Close";
  close.addEventListener("click", () => dialog.close());
  const heading = (text) => (dialog.appendChild(document.createElement("h2")).textContent = text);
  const list = (pairs) => {
    const dl = dialog.appendChild(document.createElement("dl"));
    for (const [term, what] of pairs) {
      dl.appendChild(document.createElement("dt")).textContent = term;
      dl.appendChild(document.createElement("dd")).textContent = what;
    }
  };
  if (notes.length > 0) {
    heading("Warnings, and what was left out");
    for (const note of notes) Object.assign(dialog.appendChild(document.createElement("pre")), { className: "code", textContent: note });
  }
  heading("What to do");
  list(TODO);
  heading("Keys");
  list(KEYS);
  heading("What is shown");
  list(Object.values(KINDS).map(({ key, name, about }) => [`${name} (${key})`, about]));
  const credit = "Computed by mozzi, which is in this file as WebAssembly; drawn with three.js, whose licence is at the top of this file. Nothing is fetched from a network, and nothing is sent.";
  dialog.appendChild(document.createElement("p")).textContent = credit;
}
