// A slider and a number for each independent joint, where there is no motion.

export function addSliders(host, robot, theta, jointColour, onChange) {
  const base = robot.isFloating ? 7 : 0;
  const home = [...theta];
  const row = host.appendChild(document.createElement("div"));
  row.className = "row";
  const fields = robot.slides.map((slides, k) => joint(host, robot, theta, k, slides, base, jointColour, onChange));
  const set = (values) => {
    values.forEach((value, k) => {
      if (k >= base) fields[k - base](value);
      theta[k] = value;
    });
    onChange();
  };
  const button = (text, values) => {
    const made = row.appendChild(document.createElement("button"));
    made.textContent = text;
    made.addEventListener("click", () => set(values()));
  };
  button("all at 0", () => home);
  button("a random pose", () => home.map((value, k) => {
    if (k < base) return value;
    const [low, high] = limits(robot, k - base);
    return low + Math.random() * (high - low);
  }));
  return set;
}

function limits(robot, k) {
  return robot.limits[k] ?? (robot.slides[k] ? [-1, 1] : [-Math.PI, Math.PI]);
}

function joint(host, robot, theta, k, slides, base, jointColour, onChange) {
  const name = robot.positions[base + k];
  const [low, high] = limits(robot, k);
  const div = host.appendChild(document.createElement("div"));
  div.className = "joint";
  const label = div.appendChild(document.createElement("label"));
  const mark = label.appendChild(document.createElement("i"));
  mark.style.setProperty("--colour", jointColour(base ? k + 6 : k));
  label.append(`${name}, ${slides ? "m" : "rad"}`);
  label.title = name;
  label.htmlFor = `joint-${k}`;
  const number = div.appendChild(document.createElement("input"));
  Object.assign(number, { type: "number", step: slides ? "0.01" : "0.1", value: theta[base + k] });
  number.setAttribute("aria-label", `${name}, a number`);
  const slider = div.appendChild(document.createElement("input"));
  Object.assign(slider, { type: "range", id: label.htmlFor, min: low, max: high, step: "any", value: theta[base + k] });
  const take = (value, from) => {
    if (!Number.isFinite(value)) return;
    theta[base + k] = value;
    if (from !== slider) slider.value = value;
    if (from !== number) number.value = Number(value.toFixed(4));
  };
  for (const field of [slider, number])
    field.addEventListener("input", () => {
      take(field.valueAsNumber, field);
      onChange();
    });
  return (value) => take(value, null);
}
