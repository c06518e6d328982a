// The page about the page: keys, signs, and what was left out.

import { KINDS } from "./kinds.js";

export function fillHelp(dialog, hasMotion, notes) {
  // first of all, so that the page opens at its beginning
  const close = dialog.appendChild(document.createElement("button"));
  close.className = "close";
  close.textContent = "Close";
  close.addEventListener("click", () => dialog.close());
  const heading = (text) => {
    dialog.appendChild(document.createElement("h2")).textContent = text;
  };
  const list = (pairs) => {
    const dl = dialog.appendChild(document.createElement("dl"));
    for (const [term, what] of pairs) {
      dl.appendChild(document.createElement("dt")).textContent = term;
      dl.appendChild(document.createElement("dd")).textContent = what;
    }
  };
  heading("Keys");
  list([
    ...(hasMotion ? [
      ["space", "play or pause"], ["← →", "a hundredth of the time back or on; with shift a row"], ["home, end", "first and last time"],
      ["− +", "slower, faster"], ["l", "repeat"],
    ] : []),
    ["0", "all of the robot in sight"], ["d", "light or dark"], ["p", "save a picture, its ground transparent"], ["?", "this page"],
  ]);
  heading("What is shown");
  list(Object.values(KINDS).map(({ key, name, about }) => [`${name} (${key})`, about]));
  if (notes.length > 0) {
    heading("Left out");
    const ul = dialog.appendChild(document.createElement("ul"));
    for (const note of notes) ul.appendChild(document.createElement("li")).textContent = note;
  }
  const credit = "Made and computed by mozzi, which is in this file as WebAssembly; drawn with three.js, whose licence stands at the top of this file. Nothing here was fetched from a network.";
  dialog.appendChild(document.createElement("p")).textContent = credit;
}
