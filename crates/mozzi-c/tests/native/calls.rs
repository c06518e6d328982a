//! The calls of all typed functions and methods, from the list of quantities.

use crate::list::{Further, further, quantities};
use std::fmt::Write;

/// A function for each typed function of C, and their table.
pub fn functions() -> String {
    let mut text = String::new();
    for (index, (quantity, _)) in quantities().enumerate() {
        let mut arguments = String::from("a->model, a->workspace");
        (0..quantity.inputs.len()).for_each(|k| arguments += &format!(", a->in[{k}]"));
        for further in further(quantity) {
            arguments += match further {
                Further::Frame => ", a->frame",
                Further::Task => ", a->task",
                Further::About => ", a->about",
                Further::Environment => ", a->environment",
            };
        }
        for (k, output) in quantity.outputs.iter().enumerate() {
            arguments += &match output.dims.len() {
                0 | 1 => format!(", a->out[{k}]"),
                2 => format!(", matrix_of(a, {k})"),
                _ => format!(", tensor_of(a, {k})"),
            };
        }
        let name = quantity.name;
        let head = format!("static mozzi_status typed_{index}(const struct arguments *a)");
        writeln!(text, "{head} {{ return mozzi_{name}({arguments}); }}").expect("a String");
    }
    text += "static mozzi_status (*const typed[])(const struct arguments *) = {\n";
    (0..quantities().count()).for_each(|index| text += &format!("    typed_{index},\n"));
    text + "};\n"
}

/// A template for each method of C++, and a function that calls that of this number.
pub fn methods() -> String {
    let mut text = String::new();
    for (index, (quantity, _)) in quantities().enumerate() {
        let further = further(quantity);
        let mut arguments: Vec<String> = (0..quantity.inputs.len()).map(|k| format!("c.in[{k}]")).collect();
        let given = |kind: Further, argument: &str| further.contains(&kind).then(|| argument.to_string());
        arguments.extend(given(Further::Frame, "c.frame"));
        arguments.extend(given(Further::Task, "c.task"));
        arguments.extend(quantity.outputs.iter().enumerate().map(|(k, output)| match output.dims.len() {
            0 => format!("c.number[{k}]"),
            1 => format!("c.vector[{k}]"),
            2 => format!("c.matrix[{k}]"),
            _ => format!("c.tensor[{k}]"),
        }));
        arguments.extend(given(Further::About, "c.about"));
        arguments.extend(given(Further::Environment, "c.environment"));
        let (name, arguments) = (quantity.name, arguments.join(", "));
        writeln!(text, "template <class C> mozzi::Status method_{index}(C &c) {{").expect("a String");
        writeln!(text, "  return c.workspace.{name}({arguments});\n}}").expect("a String");
    }
    text += "template <class C> mozzi::Status method(int32_t quantity, C &c) {\n  switch (quantity) {\n";
    for index in 0..quantities().count() {
        writeln!(text, "    case {index}: return method_{index}(c);").expect("a String");
    }
    text + "    default: return mozzi::Status(MOZZI_NOT_FOUND);\n  }\n}\n"
}
