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
