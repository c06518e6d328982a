//! A robot's quantities as programs.

use crate::program::derivative::derivative;
use crate::program::estimate::is_deep;
use crate::program::needed;
use crate::program::record::record;
use crate::program::robot_number::RobotNumber;
use crate::program::too_long::TooLong;
use crate::program::{Derivative, Program, Traced};
use mozzi::quantities::{ForwardDynamics, ForwardDynamicsParameterVjp, ForwardDynamicsVjp, Memory, Of, Query};
use mozzi::{Environment, Error, FrameId, Model, Scalar, Twist, Vec3, Wrench};
use std::cell::{Cell, RefCell};

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
    /// Names and lengths of those that are not the robot's own numbers.
    fn inputs<C: Scalar>(&self, model: &Model<C>) -> Vec<(String, usize)> {
        let plain = [
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
    pub(crate) fn wrench_name<C: Scalar>(&self, model: &Model<C>, frame: FrameId) -> String {
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
    let reduced = query.declaration().is_of_forces.then(|| model.reduced());
    let model = reduced.as_ref().unwrap_or(model);
    let own = arguments.parameters.then(|| ("parameters", model.parameter_count()));
    let program = record_kernel(model, query, arguments, own, |own| match arguments.parameters {
        true => model.with_parameters(own),
        false => model.map(RobotNumber::Constant),
    })?;
    Ok(needed::ordered(program, query, model.n()))
}

/// The program of a quantity of a robot whose numbers are of any kind, such as exact or symbolic ones, and those
/// numbers: its input `numbers`, between the quantity's inputs and the wrenches. 0 and ±1 are constants of the program.
/// The program's value in that kind of number is the kernel's. See [`record_quantity`].
///
/// # Errors
/// [`TooLong`].
pub fn record_numbers<C: Scalar + PartialEq>(
    model: &Model<C>,
    query: Query,
    wrenches: &[FrameId],
) -> Result<(Program, Vec<C>), TooLong> {
    let constants = [0.0, 1.0, -1.0].map(|x| (C::from_f64(x), x));
    let constant = |x: C| constants.iter().find(|(constant, _)| *constant == x).map(|(_, x)| *x);
    let found = RefCell::new(Vec::new());
    model.map(|x| match constant(x) {
        Some(_) => {}
        None => found.borrow_mut().push(x),
    });
    let (found, next) = (found.into_inner(), Cell::new(0));
    let own = Some(("numbers", found.len()));
    let arguments = Arguments { wrenches, ..Arguments::default() };
    let program = record_kernel(model, query, arguments, own, |numbers| {
        model.map(|x| match constant(x) {
            Some(x) => RobotNumber::Constant(x),
            None => numbers[next.replace(next.get() + 1)],
        })
    })?;
    Ok((program, found))
}

/// The program of a query's kernel on a robot, which is made of an input of its `own` numbers.
fn record_kernel<C: Scalar>(
    model: &Model<C>,
    query: Query,
    arguments: Arguments,
    own: Option<(&str, usize)>,
    robot: impl FnOnce(&[RobotNumber]) -> Model<RobotNumber>,
) -> Result<Program, TooLong> {
    let declaration = query.declaration();
    let further = arguments.inputs(model);
    let further = further.iter().map(|(name, length)| (name.as_str(), *length));
    let state = declaration.inputs.iter().map(|input| input.name).zip(query.input_lengths(model));
    let inputs: Vec<(&str, usize)> = state.chain(own).chain(further).collect();
    record(query.name(), &inputs, |arrays| {
        let (state, rest) = arrays.split_at(declaration.inputs.len());
        let (own, rest) = rest.split_at(usize::from(own.is_some()));
        let own: Vec<RobotNumber> = own.iter().flatten().map(|&x| RobotNumber::Recorded(x)).collect();
        outputs(query, &robot(&own), arguments, state, rest)
    })
}

/// The outputs of a query's kernel, by name. It is not generic, so that kernels are compiled in this crate alone.
fn outputs(
    query: Query,
    model: &Model<RobotNumber>,
    arguments: Arguments,
    state: &[Vec<Traced>],
    further: &[Vec<Traced>],
) -> Vec<(&'static str, Vec<Traced>)> {
    fn fixed<const K: usize>(numbers: &[Traced]) -> [Traced; K] {
        std::array::from_fn(|k| numbers[k])
    }
    let state: Vec<&[Traced]> = state.iter().map(Vec::as_slice).collect();
    let mut further = further.iter().map(Vec::as_slice);
    let mut next = |is_argument: bool| if is_argument { further.next() } else { None };
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
    query.evaluate(model, &state, &environment, &mut memory, &mut slices);
    let names = query.declaration().outputs.iter().map(|output| output.name).chain(pivot_names(&query).iter().copied());
    names.zip(outputs.into_iter().chain(memory.pivots().map(<[_]>::to_vec))).collect()
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
