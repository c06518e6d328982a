//! The quantities' methods in C++.

use crate::{Further, GLUE, further, quantities, shapes, wrapped};
use mozzi::quantities::{Declaration, Dim, Output};

const WIDTH: usize = 119;

/// The expression of a size in C++.
fn size(dim: &Dim) -> String {
    match dim {
        Dim::N => "sizes_.n".into(),
        Dim::Nq => "sizes_.nq".into(),
        Dim::Parameters => "sizes_.parameters".into(),
        Dim::Bodies => "sizes_.bodies".into(),
        Dim::Frames => "sizes_.frames".into(),
        Dim::Constraints => "sizes_.constraints".into(),
        Dim::Rows => "task.rows()".into(),
        Dim::Is(size) => size.to_string(),
    }
}

/// An output's type, and what C takes of it.
fn output(output: &Output) -> (&'static str, String) {
    match output.dims.len() {
        0 => ("double &", format!("&{}", output.name)),
        1 => ("Vector ", format!("{}.data()", output.name)),
        2 => ("Matrix ", format!("{}.c()", output.name)),
        _ => ("Tensor ", format!("{}.c()", output.name)),
    }
}

fn checks(quantity: &Declaration) -> Vec<String> {
    let inputs = quantity.inputs.iter().map(|input| format!("{0}.fits(\"{0}\", {1})", input.name, size(&input.dim)));
    let outputs = quantity.outputs.iter().filter(|output| !output.dims.is_empty()).map(|output| {
        let sizes: Vec<String> = output.dims.iter().map(size).collect();
        format!("{0}.fits(\"{0}\", {1})", output.name, sizes.join(", "))
    });
    inputs.chain(outputs).collect()
}

fn method(quantity: &Declaration) -> String {
    let further = further(quantity);
    let mut arguments: Vec<String> = quantity.inputs.iter().map(|input| format!("Input{GLUE}{}", input.name)).collect();
    let mut given = vec!["model_.get()".to_string(), "get()".to_string()];
    given.extend(quantity.inputs.iter().map(|input| format!("{}.data()", input.name)));
    for kind in &further {
        let (argument, given_as) = match kind {
            Further::Frame => ("Frame frame", "frame.c()"),
            Further::Task => ("const Task &task", "&task.c()"),
            Further::About => continue,
            Further::Environment => continue,
        };
        arguments.push(argument.into());
        given.push(given_as.into());
    }
    arguments
        .extend(quantity.outputs.iter().map(|found| format!("{}{}", output(found).0, found.name).replace(' ', GLUE)));
    // those with a default come last
    if further.contains(&Further::About) {
        arguments.push("const Point &about = Point()".replace(' ', GLUE));
        given.push("about.c()".into());
    }
    if further.contains(&Further::Environment) {
        arguments.push("Around environment = Around()".replace(' ', GLUE));
        given.push("environment.c()".into());
    }
    given.extend(quantity.outputs.iter().map(|found| output(found).1));
    let [inputs, outputs] = shapes(quantity);
    let comment = [
        wrapped(&format!("{}.", quantity.formula), WIDTH, "  /// ", "  /// "),
        wrapped(&format!("{inputs}. Gives {outputs}."), WIDTH, "  /// ", "  /// "),
    ];
    let indent = "      ";
    let head = wrapped(
        &format!("Status {}({}){GLUE}noexcept{GLUE}{{", quantity.name, arguments.join(", ")),
        WIDTH,
        "  ",
        indent,
    );
    let checks = wrapped(&format!("if (!({})) {{", checks(quantity).join(" && ")), WIDTH, "    ", "          ");
    let call =
        wrapped(&format!("return Status(mozzi_{}({}));", quantity.name, given.join(", ")), WIDTH, "    ", "        ");
    format!(
        "\n{}\n{head}\n{checks}\n      return Status(MOZZI_WRONG_LENGTH);\n    }}\n{call}\n  }}\n",
        comment.join("\n")
    )
}

/// The part of mozzi.hpp.
pub fn text() -> String {
    quantities().map(|(quantity, _)| method(quantity)).collect::<String>() + "\n"
}
