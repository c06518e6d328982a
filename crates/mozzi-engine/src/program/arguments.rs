//! A robot's quantities as programs.

use crate::program::derivative::derivative;
use crate::program::estimate::is_deep;
use crate::program::needed;
use crate::program::record::record;
use crate::program::robot_number::RobotNumber;
use crate::program::too_long::TooLong;
use crate::program::{Derivative, Program, Traced};
use mozzi::quantities::{ForwardDynamics, ForwardDynamicsParameterVjp, ForwardDynamicsVjp, Memory, Of, Query};
use mozzi::{Environment, Error, FrameId, Model, Twist, Vec3, Wrench};

/// Quantities kept as arguments of the program instead of constants: further inputs after the state, in this order. By
/// default there are none: all numbers of the robot are constants, its base is at rest, no wrenches are applied, and
/// products with zeros are dropped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Arguments<'a> {
    /// `parameters`: [`Model::parameters`], the masses, inertias, frictions and springs. Geometry stays constant.
    pub parameters: bool,
    /// `gravity`: three numbers, in {s}.
    pub gravity: bool,
    /// `base_twist`: six numbers, (ω, v) of {s}.
    pub base_twist: bool,
    /// `base_acceleration`: six numbers, (ω̇, v̇) of {s}.
    pub base_acceleration: bool,
    /// `about`: three numbers, the reference point of a momentum in {s}.
    pub about: bool,
    /// `wrench`, or `wrench_FRAME` for several frames: six numbers (m, f), the wrench that this frame applies to the
    /// environment in its own coordinates.
    pub wrenches: &'a [FrameId],
    /// A derivative, with its directions as last inputs.
    pub derivative: Derivative,
}

impl Arguments<'_> {
    /// Names and lengths.
    pub(crate) fn inputs(&self, model: &Model) -> Vec<(String, usize)> {
        let plain = [
            ("parameters", self.parameters, model.parameter_count()),
            ("gravity", self.gravity, 3),
            ("base_twist", self.base_twist, 6),
            ("base_acceleration", self.base_acceleration, 6),
            ("about", self.about, 3),
        ];
        let plain = plain.into_iter().filter(|(_, is_argument, _)| *is_argument);
        let wrench = |&frame: &FrameId| (self.wrench_name(model, frame), 6);
        plain.map(|(name, _, length)| (name.to_string(), length)).chain(self.wrenches.iter().map(wrench)).collect()
    }

    /// The input of this frame's wrench.
    pub(crate) fn wrench_name(&self, model: &Model, frame: FrameId) -> String {
        match self.wrenches.len() {
            1 => "wrench".to_string(),
            _ => format!("wrench_{}", model.frame_name(frame)),
        }
    }
}

/// The program of a quantity of this robot: `mozzi`'s kernel, recorded. Its inputs are the quantity's, then the
/// [`Arguments`]. Its outputs are the quantity's by name, matrices by rows, then `pivots` if it divides by the mass
/// matrix and `task_pivots` for a task. Forward dynamics and its products are recorded both by the articulated-body
/// algorithm and by the mass matrix, and the shorter program is kept.
///
/// # Errors
/// [`Error::BadArgument`] if the frame is missing or belongs to another model, or if the program is too long
/// ([`TooLong`]).
pub fn record_quantity<'q>(model: &Model, query: impl Into<Query<'q>>, arguments: Arguments) -> Result<Program, Error> {
    let query = query.into();
    query.check_subject(model)?;
    arguments.wrenches.iter().try_for_each(|&frame| model.check_frame(frame))?;
    let by = |model: &Model| {
        let program = recorded(model, query, arguments).and_then(|own| derivative(own, model, arguments.derivative));
        program.map_err(|TooLong| Error::BadArgument {
            what: "the program of a robot so large",
            found: TooLong.to_string(),
            expected: "a shorter one",
        })
    };
    let program = by(model)?;
    let solves =
        [ForwardDynamics.into(), ForwardDynamicsVjp.into(), ForwardDynamicsParameterVjp.into()].contains(&query);
    if !solves || model.solves_by_mass_matrix() || is_deep(model) {
        return Ok(program);
    }
    let by_matrix = by(&model.clone().solving_by_mass_matrix())?;
    Ok(if work(&by_matrix) < work(&program) { by_matrix } else { program })
}

/// The program of a query, recorded from its kernel.
fn recorded(model: &Model, query: Query, arguments: Arguments) -> Result<Program, TooLong> {
    let declaration = query.declaration();
    let reduced = declaration.is_of_forces.then(|| model.reduced());
    let model = reduced.as_ref().unwrap_or(model);
    let further = arguments.inputs(model);
    let state = declaration.inputs.iter().map(|input| input.name).zip(query.input_lengths(model));
    let inputs: Vec<(&str, usize)> =
        state.chain(further.iter().map(|(name, length)| (name.as_str(), *length))).collect();
    let program = record(query.name(), &inputs, |arrays| {
        let (state, rest) = arrays.split_at(declaration.inputs.len());
        let state: Vec<&[Traced]> = state.iter().map(Vec::as_slice).collect();
        let mut rest = rest.iter().map(Vec::as_slice);
        let mut next = |is_argument: bool| if is_argument { rest.next() } else { None };
        let parameters = next(arguments.parameters);
        fn fixed<const K: usize>(numbers: &[Traced]) -> [Traced; K] {
            std::array::from_fn(|k| numbers[k])
        }
        let gravity = next(arguments.gravity).map_or(model.gravity().map(Traced::from), |g| Vec3(fixed(g)));
        let twist = |x: Option<&[Traced]>| x.map_or(Twist::zero(), |x| Twist::from_array(fixed(x)));
        let base_twist = twist(next(arguments.base_twist));
        let base_acceleration = twist(next(arguments.base_acceleration));
        let point = next(arguments.about).map(|p| Vec3(fixed(p)));
        let wrenches = arguments.wrenches.iter().filter_map(|&frame| Some((frame, next(true)?)));
        let applied: Vec<_> = wrenches.map(|(frame, F)| (frame, Wrench::from_array(fixed(F)))).collect();
        let environment = Environment { gravity, base_twist, base_acceleration, applied: &applied };

        let mut memory = Memory::new(model);
        if let Some(point) = point {
            memory = memory.with_point(point);
        }
        let zero = Traced::from(0.0);
        let mut outputs: Vec<Vec<Traced>> = query.output_lengths(model).map(|length| vec![zero; length]).collect();
        let mut slices: Vec<&mut [Traced]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
        let model = match parameters {
            Some(parameters) => {
                let recorded: Vec<RobotNumber> = parameters.iter().map(|&x| RobotNumber::Recorded(x)).collect();
                model.with_parameters(&recorded)
            }
            None => model.map(RobotNumber::Constant),
        };
        query.evaluate(&model, &state, &environment, &mut memory, &mut slices);
        let names = declaration.outputs.iter().map(|output| output.name).chain(pivot_names(&query).iter().copied());
        names.zip(outputs.into_iter().chain(memory.pivots().map(<[_]>::to_vec))).collect()
    })?;
    Ok(needed::ordered(program, query, model.n()))
}

/// The outputs of a program after the quantity's own: the pivots that it divides by.
pub fn pivot_names(query: &Query) -> &'static [&'static str] {
    match query.declaration() {
        declaration if !declaration.divides => &[],
        declaration if declaration.of == Of::Task => &["pivots", "task_pivots"],
        _ => &["pivots"],
    }
}

/// The cost in instructions; a division or square root counts as eight.
fn work(program: &Program) -> usize {
    let count = program.count();
    count.instructions() + 7 * (count.div + count.sqrt)
}
