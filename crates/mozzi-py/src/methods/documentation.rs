//! The docstring of a quantity's method, in numpydoc's sections, made from its declaration.

use crate::signature::{Argument, Signature, shape};
use mozzi::quantities::{Declaration, Dim, Input, Of, Output};
use std::fmt::Write;

/// The docstring; `class` names the tuple of several results.
pub fn documentation(declaration: &Declaration, class: &str) -> String {
    let mut text = format!("{}.\n\nParameters\n----------\n", declaration.formula);
    let signature = Signature::new(declaration);
    // writing to a String cannot fail
    for (place, Argument { name, about, .. }) in signature.arguments.iter().enumerate() {
        let _ = match declaration.inputs.get(place) {
            Some(input) => writeln!(text, "{name} : {}", state(input)),
            None => writeln!(text, "{name} : {}\n    {}", about[0], about[1]),
        };
    }
    text += "\nReturns\n-------\n";
    match declaration.outputs {
        [output] => text += &one(output),
        outputs => {
            let _ = writeln!(text, "{class}\n    A named tuple of arrays:\n");
            for output in outputs {
                let _ = writeln!(text, "    - `{}`, shape {}: {}.", output.name, shape(output.dims), output.unit);
            }
        }
    }
    text += &raises(declaration);
    text + &example(declaration)
}

fn state(input: &Input) -> String {
    let of_floating_base = match input.name {
        "theta" => "; of a floating base first its quaternion (w, x, y, z) and its origin",
        "dtheta" => "; of a floating base first its body twist (ω, v)",
        "ddtheta" => "; of a floating base first (ω̇, v̇)",
        "tau" => "; on a floating base first a wrench (m, f)",
        _ => "",
    };
    let Input { symbol, about, unit, dim, .. } = input;
    format!("array_like, shape {}\n    {symbol}, {about}: {unit}{of_floating_base}.", shape(&[*dim]))
}

fn one(output: &Output) -> String {
    let Output { name, unit, dims, .. } = output;
    match dims {
        [] => format!("{name} : float, or numpy.ndarray of the leading axes\n    {unit}.\n"),
        dims => format!("{name} : numpy.ndarray, shape {}\n    {unit}.\n", shape(dims)),
    }
}

fn raises(declaration: &Declaration) -> String {
    let singular = match declaration.of {
        Of::Task => "If the mass matrix is singular, or the rows cannot move independently.",
        _ => "If the mass matrix is singular. The message names the joint.",
    };
    match declaration {
        Declaration { divides: true, .. } => format!("\nRaises\n------\nSingularError\n    {singular}\n"),
        Declaration { needs_mass: true, .. } => {
            "\nRaises\n------\nValueError\n    If the robot's total mass is 0.\n".to_string()
        }
        _ => String::new(),
    }
}

/// The example: the UR5 at one state and at five, and the shapes of the results.
fn example(declaration: &Declaration) -> String {
    let mut text = String::from("\nExamples\n--------\n>>> import mozzi\n>>> ur5 = mozzi.models.ur5()\n");
    let names: Vec<&str> = declaration.inputs.iter().map(|input| input.name).collect();
    for &name in &names {
        let values = if name == "theta" { "[0, -1.2, 1.5, 0.3, 1.1, 0]" } else { "[0.1] * 6" };
        let _ = writeln!(text, ">>> {name} = {values}");
    }
    let call = |given: &str| format!("ur5.{}({given})", declaration.name);
    let (one, many) =
        (call(&names.join(", ")), call(&names.join(", ").replacen(names[0], &format!("[{}] * 5", names[0]), 1)));
    let _ = match declaration.outputs {
        [Output { dims: [], .. }] => writeln!(text, ">>> type({one})\n<class 'float'>"),
        [output] => writeln!(text, ">>> {one}.shape{}", found(None, output)),
        outputs => {
            let _ = writeln!(text, ">>> found = {one}");
            outputs
                .iter()
                .try_for_each(|output| writeln!(text, ">>> found.{}.shape{}", output.name, found(None, output)))
        }
    };
    if let [output] = declaration.outputs {
        let _ = writeln!(text, ">>> {many}.shape{}", found(Some("5"), output));
    }
    text
}

/// The shape of the UR5's result, as Python shows it; it is compared with the model's sizes.
fn found(leading: Option<&str>, output: &Output) -> String {
    let size = |dim: &Dim| match dim {
        Dim::N | Dim::Nq | Dim::Rows => "6".to_string(),
        Dim::Parameters => "len(ur5.parameters)".to_string(),
        Dim::Bodies => "6".to_string(),
        Dim::Frames => "len(ur5.frames)".to_string(),
        Dim::Constraints => "len(ur5.constraint_row_names)".to_string(),
        Dim::Is(size) => size.to_string(),
    };
    let sizes: Vec<String> = leading.map(String::from).into_iter().chain(output.dims.iter().map(size)).collect();
    let comma = if sizes.len() == 1 { "," } else { "" };
    let shape = format!("({}{comma})", sizes.join(", "));
    if shape.contains("len") { format!(" == {shape}\nTrue") } else { format!("\n{shape}") }
}
