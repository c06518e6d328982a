// Lines of Rust, Python and C++ that compute what the page shows.

const list = (numbers, open, close) => `${open}${numbers.join(", ")}${close}`;

const NEEDS = { frame: true, task: true };

export const LANGUAGES = { python: "Python", rust: "Rust", cpp: "C++", shell: "Command line" };

// The file that the tab saves. Browsers, shells and strings in programs take all other characters of a name as they are.
export const jsonOf = ({ name }) => `${name.replace(/[\s/\\:*?"'`$<>|&;()!]+/g, "_") || "robot"}.json`;

// `robot`: the name of an embedded robot or the file's; `isSaved`: the file is the one that the tab saves; `inputs`: [name, numbers]
// pairs of the quantity.
export function codeOf(language, { isSaved, ...asked }) {
  const mark = { python: "#", shell: "#" }[language] ?? "//";
  return `${isSaved ? `${mark} save ${asked.robot} first: a button below, JSON\n` : ""}${program(language, asked)}`;
}

function program(language, { robot, isFloating, quantity, frame, inputs, outputs }) {
  const names = inputs.map(([name]) => name);
  const ofFrame = NEEDS[quantity.of];
  switch (language) {
    case "python":
      return [
        "import mozzi",
        "",
        `robot = ${pythonOf(robot, isFloating)}`,
        ...inputs.map(([name, numbers]) => `${name} = ${list(numbers, "[", "]")}`),
        `print(robot.${quantity.name}(${[...names, ...(ofFrame ? [`frame="${frame}"`] : [])].join(", ")}))`,
      ].join("\n");
    case "rust":
      return [
        "use mozzi::quantities::Query;",
        "",
        "fn main() -> Result<(), Box<dyn std::error::Error>> {",
        `    let model = mozzi_urdf::open("${robot}")?.${isFloating ? "description.floating()." : ""}build()?;`,
        ...inputs.map(([name, numbers]) => `    let ${name} = ${list(numbers.map(float), "[", "]")};`),
        `    let query = Query::named("${quantity.name}")?${ofFrame ? `.of(model.frame("${frame}")?)` : ""};`,
        `    let outputs = model.compute(query, &[${names.map((name) => `&${name}[..]`).join(", ")}], &model.environment())?;`,
        '    println!("{outputs:?}");',
        "    Ok(())",
        "}",
      ].join("\n");
    case "shell":
      return [
        `mozzi compute ${/^[\w.-]+$/.test(robot) ? robot : `'${robot}'`} ${quantity.name.replaceAll("_", "-")}${isFloating ? " --floating" : ""}`,
        ...inputs.map(([name, numbers]) => `--${name}=${numbers.join(",")}`),
        ...(ofFrame ? [`--frame ${frame}`] : []),
      ].join(" \\\n  ");
    default:
      return [
        "#include <mozzi/mozzi.hpp>",
        "#include <cstdio>",
        "#include <vector>",
        "",
        "int main() {",
        `  const mozzi::Model robot = mozzi::Model::open("${robot}").value()${isFloating ? ".with_base(true).value()" : ""};`,
        "  mozzi::Workspace workspace(robot);",
        ...inputs.map(([name, numbers]) => `  const std::vector<double> ${name}${list(numbers, "{", "}")};`),
        ...(ofFrame ? [`  const mozzi::Frame frame = robot.frame("${frame}").value();`] : []),
        ...outputs.map(room),
        `  workspace.${quantity.name}(${[...names, ...(ofFrame ? ["frame"] : []), ...outputs.map(({ name }) => name)].join(", ")}).or_throw();`,
        ...outputs.map(printed),
        "}",
      ].join("\n");
  }
}

const EMBEDDED = ["anymal", "double_pendulum", "furuta_pendulum", "panda", "two_link_planar", "ur5"];

function pythonOf(robot, isFloating) {
  const floating = isFloating ? "floating=True" : "";
  if (EMBEDDED.includes(robot)) return `mozzi.models.${robot}(${robot === "anymal" && !isFloating ? "floating=False" : floating})`;
  return `mozzi.Model.load("${robot}"${floating && `, ${floating}`})`;
}

// Memory for an output in C++; matrices by rows.
function room({ name, shape }) {
  return shape.length === 0 ? `  double ${name};` : `  std::vector<double> ${name}(${shape.join(" * ")});`;
}

function printed({ name, shape }) {
  return shape.length === 0 ? `  std::printf("%.17g\\n", ${name});` : `  for (const double x : ${name}) std::printf("%.17g\\n", x);`;
}

const float = (x) => (Number.isInteger(x) ? `${x}.0` : String(x));
