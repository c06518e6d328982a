// Light and dark: the system's choice until the switch says otherwise.

const system = matchMedia("(prefers-color-scheme: dark)");

export function startTheme(button, onChange) {
  let chosen = null;
  const dark = () => (chosen ? chosen === "dark" : system.matches);
  const apply = () => {
    document.documentElement.dataset.theme = dark() ? "dark" : "light";
    button.setAttribute("aria-pressed", String(dark()));
    onChange(dark());
  };
  system.addEventListener("change", apply);
  const set = (theme) => {
    chosen = theme;
    apply();
  };
  button.addEventListener("click", () => set(dark() ? "light" : "dark"));
  return { apply, set, toggle: () => button.click() };
}

// A colour of the style sheet.
export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
