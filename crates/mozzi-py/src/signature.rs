//! The arguments of a quantity's method, made from its declaration: their order, defaults, types and documentation.
//! Independent of Python, so that `tests/stubs.rs` can write the stubs from it.

use mozzi::quantities::{Declaration, Dim, Input, Of, Output, Uses};
use std::fmt::Write;
use std::ops::RangeInclusive;

/// Class names of the quantities, in the order of the list: the named tuples of several results.
pub const CLASSES: &[&str] = {
    macro_rules! names {
        ($($Q:ident)*) => { &[$(stringify!($Q)),*] };
    }
    mozzi::quantities!(names)
};

/// One argument of a method.
#[derive(Clone, Copy, Debug)]
pub struct Argument {
    /// Identifies the argument.
    pub slot: Slot,
    /// Its name.
    pub name: &'static str,
    /// Its default as Python writes it; none if it is required.
    pub default: Option<&'static str>,
    /// Its type in the stubs.
    pub stub: &'static str,
    /// Its type and its meaning, as numpydoc has them.
    pub about: [&'static str; 2],
}

/// The optional arguments: `Slot NAME: name, stub = default, type, meaning;`.
macro_rules! optional {
    ($($slot:ident $constant:ident: $name:literal, $stub:literal = $default:literal, $kind:literal, $about:literal;)*) => {
        /// One of the arguments of all methods.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[allow(missing_docs)] // their names
        pub enum Slot { Input0, Input1, Input2, Input3, $($slot),* }

        $(const $constant: Argument = Argument {
            slot: Slot::$slot, name: $name, default: Some($default), stub: $stub, about: [$kind, $about],
        };)*

        impl Slot {
            /// The argument's name; none of the state, whose names are the quantity's.
            pub fn name(self) -> Option<&'static str> {
                match self {
                    $(Slot::$slot => Some($name),)*
                    _ => None,
                }
            }
        }
    };
}
optional! {
    Frame FRAME: "frame", "str | None" = "None", "str, optional",
        "A link or frame of the robot. Default: its end effector.";
    Coordinates COORDINATES: "coordinates", "Literal[\"body\", \"space\"]" = "\"body\"", "{'body', 'space'}",
        "Coordinates of the twist and the wrench: the frame's, or those of {s}.";
    Rows ROWS: "rows", "Sequence[int] | None" = "None", "sequence of int, optional",
        "Rows of (ω_x, ω_y, ω_z, v_x, v_y, v_z), each at most once. Default: all six.";
    About ABOUT: "about", "ArrayLike | None" = "None", "array_like, shape (3,), optional",
        "A point of {s}, m. Default: the origin.";
    TipWrench TIP_WRENCH: "tip_wrench", "ArrayLike | None" = "None", "array_like, shape (..., 6), optional",
        "Wrench (m, f) that the end effector applies to the environment, in its own coordinates: N m, N.";
    Gravity GRAVITY: "gravity", "ArrayLike | None" = "None", "array_like, shape (..., 3), optional",
        "Gravity in the axes of {s}, m/s², for all states or for each. Default: the model's.";
    AppliedWrenches APPLIED_WRENCHES: "applied_wrenches", "Mapping[str, ArrayLike] | None" = "None",
        "dict of str to array_like of shape (..., 6), optional",
        "Wrench (m, f) that each frame applies to the environment, in its own coordinates: N m, N.";
    BaseTwist BASE_TWIST: "base_twist", "ArrayLike | None" = "None", "array_like, shape (6,), optional",
        "Twist (ω, v) of {s}: rad/s, m/s. Default: at rest.";
    BaseAcceleration BASE_ACCELERATION: "base_acceleration", "ArrayLike | None" = "None", "array_like, shape (6,), optional",
        "Acceleration (ω̇, v̇) of {s}: rad/s², m/s². Default: none.";
    Parameters PARAMETERS: "parameters", "ArrayLike | None" = "None", "array_like, shape (..., p), optional",
        "Inertial parameters in the order of `Model.parameters`, for all states or for each. Default: the model's.";
    Environment ENVIRONMENT_OBJECT: "environment", "Environment | None" = "None", "mozzi.Environment, optional",
        "Gravity, motion of the base, wrenches and parameters in one object; an argument of its own must not repeat it.";
    Out OUT: "out", "Array | None" = "None", "numpy.ndarray, optional",
        "Array in which the result is written.";
    Threads THREADS: "threads", "int | None" = "None", "int, optional",
        "Maximum number of threads for many states. Default: all cores.";
}

/// `out` of a method with several results.
const SEVERAL_OUT: Argument = Argument {
    stub: "Sequence[Array] | None",
    about: ["sequence of numpy.ndarray, optional", "Arrays in which the results are written, in their order."],
    ..OUT
};

/// The number of slots.
pub const SLOTS: usize = Slot::Threads as usize + 1;
/// The slots of the state, in the order of the declaration.
pub const INPUTS: [Slot; 4] = [Slot::Input0, Slot::Input1, Slot::Input2, Slot::Input3];
/// The slots of the environment's parts.
pub const ENVIRONMENT: RangeInclusive<usize> = Slot::TipWrench as usize..=Slot::Parameters as usize;

/// The arguments of a method, in their order.
#[derive(Debug)]
pub struct Signature {
    /// The method's name.
    pub name: &'static str,
    /// All arguments.
    pub arguments: Vec<Argument>,
    /// The number of required arguments, which come first: the state.
    pub required: usize,
    /// The number of arguments that may be positional, which come first.
    pub positional: usize,
}

impl Signature {
    /// The signature of a quantity's method.
    pub fn new(declaration: &Declaration) -> Self {
        let Declaration { name, inputs, of, uses, .. } = *declaration;
        let has = |part, argument: Argument| uses.has(part).then_some(argument);
        let task = of == Of::Task;
        let mut arguments: Vec<Argument> = inputs.iter().zip(INPUTS).map(state).collect();
        let required = arguments.len();
        arguments.extend((task || of == Of::Frame).then_some(FRAME));
        arguments.extend(has(Uses::WRENCHES, TIP_WRENCH));
        let positional = arguments.len();
        arguments.extend(task.then_some([COORDINATES, ROWS]).into_iter().flatten());
        arguments.extend((of == Of::Point).then_some(ABOUT));
        arguments.extend(has(Uses::GRAVITY, GRAVITY));
        arguments.extend(has(Uses::WRENCHES, APPLIED_WRENCHES));
        arguments.extend(has(Uses::BASE_TWIST, BASE_TWIST));
        arguments.extend(has(Uses::BASE_ACCELERATION, BASE_ACCELERATION));
        arguments.extend(depends_on_parameters(declaration).then_some(PARAMETERS));
        let has_environment = arguments.iter().any(|argument| ENVIRONMENT.contains(&(argument.slot as usize)));
        arguments.extend(has_environment.then_some(ENVIRONMENT_OBJECT));
        arguments.push(if declaration.outputs.len() > 1 { SEVERAL_OUT } else { OUT });
        arguments.push(THREADS);
        Signature { name, arguments, required, positional }
    }

    /// The text that `inspect.signature` reads; with types, the text of the stubs.
    pub fn text(&self, this: &str, has_types: bool) -> String {
        let mut text = String::from(this);
        for (place, argument) in self.arguments.iter().enumerate() {
            text += if place == self.positional { ", *, " } else { ", " };
            text += argument.name;
            let equals = match has_types {
                true => [": ", argument.stub, " = "].concat(),
                false => "=".to_string(),
            };
            match argument.default {
                Some(default) => text = text + &equals + default,
                None => text += equals.trim_end_matches([' ', '=']),
            }
        }
        text
    }
}

fn state((input, slot): (&Input, Slot)) -> Argument {
    Argument { slot, name: input.name, default: None, stub: "ArrayLike", about: [""; 2] }
}

/// True for forces, energies and momenta, which depend on the inertial parameters. False for kinematics, including that
/// of the constraints, for forces of wrenches alone, and for matrices that multiply the parameters.
fn depends_on_parameters(declaration: &Declaration) -> bool {
    let free_of_them = |dim: &Dim| matches!(dim, Dim::Frames | Dim::Parameters);
    let of_constraints = |output: &Output| output.dims.iter().any(|dim| matches!(dim, Dim::Constraints));
    declaration.of != Of::Frame
        && !declaration.outputs.iter().all(of_constraints)
        && declaration.uses != Uses::WRENCHES
        && !declaration.outputs.iter().all(|output| output.dims.iter().any(free_of_them))
}

/// `(..., n, n)`.
pub fn shape(dims: &[Dim]) -> String {
    dims.iter().fold(String::from("(..."), |mut text, dim| {
        let _ = write!(text, ", {dim}"); // writing to a String cannot fail
        text
    }) + ")"
}
