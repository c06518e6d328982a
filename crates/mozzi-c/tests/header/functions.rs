//! The quantities' functions: their declarations in C, and their exports in Rust.

use crate::{Further, GLUE, further, quantities, shapes, wrapped};
use mozzi::quantities::{Declaration, Output};
use std::fmt::Write;

const WIDTH: usize = 119;

/// An output's type in C and in Rust.
fn types(output: &Output) -> (&'static str, &'static str) {
    match output.dims.len() {
        0 | 1 => ("double *", "Vector"),
        2 => ("mozzi_matrix ", "Matrix"),
        _ => ("mozzi_tensor ", "Tensor"),
    }
}

/// A further argument's type in C, its name, and its type in Rust.
fn argument(further: Further) -> (&'static str, &'static str, &'static str) {
    match further {
        Further::Frame => ("mozzi_frame ", "frame", "Frame"),
        Further::Task => ("const mozzi_task *", "task", "TaskPointer"),
        Further::About => ("const double *", "about", "Point"),
        Further::Environment => ("const mozzi_environment *", "environment", "EnvironmentPointer"),
    }
}

/// What the further arguments are, if there are any.
fn about(further: &[Further]) -> String {
    let texts = further.iter().map(|further| match further {
        Further::Frame => "frame: of this model.",
        Further::Task => "task: a frame, coordinates and rows.",
        Further::About => "about (3): a point of {s}, m, or NULL for its origin.",
        Further::Environment => "environment: or NULL for the model's own.",
    });
    texts.collect::<Vec<_>>().join(" ")
}

fn declaration(quantity: &Declaration) -> String {
    let further = further(quantity);
    let mut arguments = String::from("const mozzi_model *model, mozzi_workspace *workspace");
    quantity.inputs.iter().for_each(|input| arguments += &format!(", const double *{}", input.name));
    for (kind, name, _) in further.iter().copied().map(argument) {
        arguments += &format!(", {kind}{name}");
    }
    quantity.outputs.iter().for_each(|output| arguments += &format!(", {}{}", types(output).0, output.name));
    let start = format!("mozzi_status mozzi_{}(", quantity.name);
    let next = " ".repeat(start.len());
    // a type and its name stay together
    let arguments = arguments.replace(" *", &[GLUE, "*"].concat()).replace("const ", &["const", GLUE].concat());
    let kinds = ["mozzi_frame ", "mozzi_matrix ", "mozzi_tensor "];
    let arguments = kinds.iter().fold(arguments, |text, kind| text.replace(kind, &kind.replace(' ', GLUE)));
    let [inputs, outputs] = shapes(quantity);
    let text = [quantity.formula, ".\n", &inputs, ". ", &about(&further), "\nGives ", &outputs, ". */"].concat();
    let lines: Vec<&str> = text.split('\n').collect();
    let comment = lines.iter().enumerate().map(|(k, line)| {
        let first = if k == 0 { "/* " } else { " * " };
        wrapped(line, WIDTH, first, " * ")
    });
    let comment: Vec<String> = comment.collect();
    format!("{}\n{}\n", comment.join("\n"), wrapped(&(arguments + ");"), WIDTH, &start, &next))
}

/// The part of mozzi.h.
pub fn text() -> String {
    let mut text = String::from("\n/* Their numbers. */\nenum {\n");
    for (index, (quantity, _)) in quantities().enumerate() {
        let comma = if index + 1 == quantities().count() { "" } else { "," };
        writeln!(text, "    MOZZI_{} = {index}{comma}", quantity.name.to_uppercase()).expect("a String");
    }
    text += "};\n";
    for (quantity, _) in quantities() {
        text += "\n";
        text += &declaration(quantity);
    }
    text + "\n"
}

/// `src/typed/list.rs`.
pub fn exports() -> String {
    let mut text = String::from("// Written by `cargo xtask docs` from the list of quantities.\n\n");
    for (quantity, class) in quantities() {
        let inputs: Vec<&str> = quantity.inputs.iter().map(|input| input.name).collect();
        let further: Vec<String> =
            further(quantity).into_iter().map(argument).map(|(_, name, kind)| format!("{name}: {kind}")).collect();
        let outputs: Vec<String> =
            quantity.outputs.iter().map(|output| format!("{}: {}", output.name, types(output).1)).collect();
        writeln!(
            text,
            "export! {{\n    mozzi_{} {class}\n    ({}) ({})\n    ({})\n}}",
            quantity.name,
            inputs.join(" "),
            further.join(", "),
            outputs.join(", ")
        )
        .expect("a String");
    }
    text
}
