// The keyboard.

import { KINDS } from "./kinds.js";
import { SPEEDS } from "./player.js";

export function onKeys({ player, player_speed, loop, theme, look, savePicture, help, motion, toggle }) {
  const kinds = Object.fromEntries(Object.entries(KINDS).map(([kind, { key }]) => [key, kind]));
  const faster = (by) => {
    const at = Math.min(Math.max(SPEEDS.indexOf(player.speed) + by, 0), SPEEDS.length - 1);
    player.speed = SPEEDS[at];
    player_speed.value = player.speed;
  };
  const step = (sign, byRow) => {
    player.pause();
    const [{ t }, { start, end, time }] = [motion, player];
    if (!byRow) return player.seek(time + (sign * (end - start)) / 100);
    const next = sign > 0 ? t.find((row) => row > time + 1e-12) : t.findLast((row) => row < time - 1e-12);
    player.seek(next ?? time);
  };
  const ofMotion = player && {
    " ": () => player.toggle(),
    ArrowLeft: (event) => step(-1, event.shiftKey),
    ArrowRight: (event) => step(1, event.shiftKey),
    Home: () => player.seek(player.start),
    End: () => player.seek(player.end),
    "-": () => faster(-1),
    "+": () => faster(1),
    "=": () => faster(1),
    l: () => loop.click(),
  };
  const always = { 0: look, d: () => theme.toggle(), p: savePicture, "?": () => help.showModal() };
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || help.open) return;
    const { tagName, type } = event.target;
    if (tagName === "SELECT" || (tagName === "INPUT" && (type === "number" || event.key.length > 1))) return;
    if (tagName === "BUTTON" && event.key === " ") return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const act = always[key] ?? ofMotion?.[key] ?? (key in kinds ? () => toggle(kinds[key]) : null);
    if (!act) return;
    event.preventDefault();
    act(event);
  });
}
