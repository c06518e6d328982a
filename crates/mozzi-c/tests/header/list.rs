//! The list of the quantities, and the arguments of their functions.

/// The visitor of the list that the Python package's stubs are written by, too.
#[allow(dead_code)] // Python's part
#[path = "../../../mozzi-py/src/signature.rs"]
mod signature;

use mozzi::quantities::{Declaration, LIST, Output};
use signature::{CLASSES, INPUTS, Signature, Slot};

/// The arguments of a quantity's function that are no inputs, outputs, model or memory.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Further {
    Frame,
    Task,
    About,
    Environment,
}

/// The quantities, with the names of their types.
pub fn quantities() -> impl Iterator<Item = (&'static Declaration, &'static str)> {
    LIST.iter().zip(CLASSES.iter().copied())
}

/// The further arguments, from the signature's.
pub fn further(declaration: &Declaration) -> Vec<Further> {
    let mut list = Vec::new();
    for argument in Signature::new(declaration).arguments {
        let further = match argument.slot {
            slot if INPUTS.contains(&slot) => continue,
            Slot::Frame => Further::Frame,
            Slot::Coordinates | Slot::Rows => Further::Task,
            Slot::About => Further::About,
            Slot::TipWrench | Slot::Gravity | Slot::AppliedWrenches => Further::Environment,
            Slot::BaseTwist | Slot::BaseAcceleration => Further::Environment,
            _ => continue,
        };
        if !list.contains(&further) {
            list.push(further);
        }
    }
    if list.contains(&Further::Task) {
        list.retain(|further| *further != Further::Frame); // a task has its frame
    }
    list.sort();
    list
}

/// `(n × n)`, empty for a number.
fn shape(output: &Output) -> String {
    let sizes: Vec<String> = output.dims.iter().map(ToString::to_string).collect();
    if sizes.is_empty() { String::new() } else { format!(" ({})", sizes.join(" × ")) }
}

/// `theta (nq), rad or m; …` of the inputs, and of the outputs.
pub fn shapes(declaration: &Declaration) -> [String; 2] {
    let inputs = declaration.inputs.iter().map(|input| format!("{} ({}), {}", input.name, input.dim, input.unit));
    let outputs = declaration.outputs.iter().map(|output| format!("{}{}, {}", output.name, shape(output), output.unit));
    [inputs.collect::<Vec<_>>().join("; "), outputs.collect::<Vec<_>>().join("; ")]
}
