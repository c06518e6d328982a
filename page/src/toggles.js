// The buttons of what is shown, in groups with their words.

import { KINDS } from "./kinds.js";

// Buttons of the kinds that can be there, by kind.
export function fillToggles(host, isPossible, onClick) {
  host.replaceChildren();
  const [groups, buttons] = [{}, {}];
  for (const [kind, { group, name, key, colour, about }] of Object.entries(KINDS)) {
    if (!isPossible(kind)) continue;
    if (!groups[group]) {
      groups[group] = host.appendChild(document.createElement("div"));
      groups[group].className = "group";
      groups[group].setAttribute("role", "group");
      groups[group].setAttribute("aria-label", group);
      groups[group].appendChild(document.createElement("span")).textContent = group;
    }
    const button = groups[group].appendChild(document.createElement("button"));
    button.appendChild(document.createElement("i"));
    button.append(name);
    button.style.setProperty("--colour", colour);
    button.title = `${about} (${key.toUpperCase()})`;
    button.dataset.kind = kind;
    button.addEventListener("click", () => onClick(kind));
    buttons[kind] = button;
  }
  return buttons;
}
