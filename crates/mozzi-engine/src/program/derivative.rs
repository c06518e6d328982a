//! Derivatives of programs, which are programs again: forward, on dual numbers, while another program is recorded; and
//! backward, from the outputs to the inputs.

use crate::program::record::record;
use crate::program::too_long::TooLong;
use crate::program::{Function, Program, Step, Traced};
use mozzi::{Dual, Freedom, Model, SO3, Vec3};

/// The derivative of a quantity y = f(x) that a program computes. x are the inputs of the quantity, then the arguments;
/// a set of them is a number with one bit per input, in their order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Derivative {
    /// y.
    #[default]
    None,
    /// y, then its derivative along a direction: after all other inputs the rates of these inputs, such as
    /// `theta_rate`, and after the quantity's outputs the rate of each, such as `tau_rate`. A rate of θ has n numbers,
    /// along the velocities. See [`Dual`](mozzi::Dual).
    Rates(u32),
    /// A product of first or second derivatives with vectors.
    Product(Product),
}

impl Derivative {
    /// The derivative along a direction that changes all inputs.
    pub const RATES: Self = Derivative::Rates(u32::MAX);
}

/// A product of derivatives of y = f(x) with vectors, without the matrices:
///
/// | along | gradient | `product` |
/// |---|---|---|
/// | U | – | ∂f u |
/// | U, V | – | ∂²f(u, v) |
/// | – | X | wᵀ∂f |
/// | U | X | wᵀ∂²f u |
///
/// Derivatives are by the numbers of the inputs: of a quaternion all four, whose length has no effect. u, v and w are
/// further inputs, `along`, `along_2` and `w`: the changes of the inputs in U and V, and a weight for each number of y,
/// one after the other. The gradient is that by the inputs in X, one after the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Product {
    /// U and V; 0 for no direction.
    pub along: [u32; 2],
    /// X; 0 for no gradient.
    pub gradient: u32,
}

/// Whether a set has this input.
pub(crate) fn has(set: u32, input: usize) -> bool {
    set.checked_shr(input as u32).is_some_and(|bits| bits & 1 == 1)
}

/// The name of an array's rate.
fn rate_of(name: &str) -> String {
    format!("{name}_rate")
}

/// The number of outputs before the pivots, which are last and have no derivative.
pub(crate) fn before_pivots(program: &Program) -> usize {
    let outputs = program.outputs();
    outputs.iter().position(|output| output.name.ends_with("pivots")).unwrap_or(outputs.len())
}

/// The derivative of this program.
///
/// # Errors
/// [`TooLong`].
pub fn derivative(program: Program, model: &Model, of: Derivative) -> Result<Program, TooLong> {
    match of {
        Derivative::None => Ok(program),
        Derivative::Rates(moving) => with_rates(&program, model, moving),
        Derivative::Product(Product { along, gradient }) => {
            let (name, own) = (format!("{}_product", program.name()), program.inputs().len());
            let mut found = if gradient == 0 { program } else { backward(&program, gradient)? };
            for (moving, name) in along.into_iter().zip(["along", "along_2"]).filter(|&(moving, _)| moving != 0) {
                found = along_numbers(&found, moving, name)?;
            }
            if gradient != 0 {
                put_last(&mut found, own); // w
            }
            let pivots = found.outputs.split_off(before_pivots(&found));
            let values = found.outputs.iter().flat_map(|output| output.values.iter().copied()).collect();
            found.outputs = vec![crate::Output { name: "product".into(), values }];
            found.outputs.extend(pivots);
            Ok(Program { name, ..found })
        }
    }
}

/// Moves an input behind all others.
fn put_last(program: &mut Program, place: usize) {
    let last = program.inputs.len() - 1;
    program.inputs[place..].rotate_left(1);
    for step in &mut program.steps {
        if let Step::Input(array, _) = step
            && *array as usize >= place
        {
            *array = if *array as usize == place { last as u32 } else { *array - 1 };
        }
    }
}

/// The program and its derivative along a direction, with a rate for some inputs and for each output but pivots, which
/// come last. The rate of `theta` is along the velocities.
fn with_rates(program: &Program, model: &Model, moving: u32) -> Result<Program, TooLong> {
    let is_theta = |name: &str| name == "theta";
    let rates = program.inputs().iter().enumerate().filter(|&(k, _)| has(moving, k)).map(|(_, array)| {
        let length = if is_theta(&array.name) { model.n() } else { array.length };
        (rate_of(&array.name), length)
    });
    let names = program.outputs()[..before_pivots(program)].iter().map(|output| rate_of(&output.name)).collect();
    let given = Given { name: format!("{}_jvp", program.name()), arrays: rates.collect(), rates: names, values: true };
    forward(program, given, |values, rates| {
        let mut rates = rates.iter();
        let seeded = program.inputs().iter().zip(values).enumerate().map(|(k, (array, x))| {
            match if has(moving, k) { rates.next() } else { None } {
                None => Dual::constants(x),
                Some(rate) if is_theta(&array.name) => positions(model, x, rate),
                Some(rate) => Dual::list(x, rate),
            }
        });
        seeded.collect()
    })
}

/// The derivative of all outputs but pivots along a direction, with one further input: the changes of some inputs' own
/// numbers, one after the other.
fn along_numbers(program: &Program, moving: u32, name: &str) -> Result<Program, TooLong> {
    let changed = program.inputs().iter().enumerate().filter(|&(k, _)| has(moving, k));
    let length = changed.map(|(_, array)| array.length).sum();
    let names = program.outputs()[..before_pivots(program)].iter().map(|output| output.name.clone()).collect();
    let arrays = vec![(name.to_string(), length)];
    let given = Given { name: program.name().to_string(), arrays, rates: names, values: false };
    forward(program, given, |values, changes| {
        let mut rest = &changes[0][..];
        let mut next = |length: usize| {
            let (these, further) = rest.split_at(length);
            rest = further;
            these
        };
        let seeded = values.iter().enumerate();
        seeded.map(|(k, x)| if has(moving, k) { Dual::list(x, next(x.len())) } else { Dual::constants(x) }).collect()
    })
}

/// The inputs and outputs that a directional derivative adds to its program.
struct Given {
    name: String,
    /// Its further inputs.
    arrays: Vec<(String, usize)>,
    /// The names of the outputs' rates.
    rates: Vec<String>,
    /// True if the program's own outputs are kept.
    values: bool,
}

/// The program on dual numbers, which `seed` makes of its inputs and the further ones.
fn forward(
    program: &Program,
    given: Given,
    seed: impl FnOnce(&[Vec<Traced>], &[Vec<Traced>]) -> Vec<Vec<Dual<Traced>>>,
) -> Result<Program, TooLong> {
    let inputs = program.inputs().iter().map(|array| (array.name.as_str(), array.length));
    let inputs: Vec<(&str, usize)> = inputs.chain(given.arrays.iter().map(|(name, n)| (name.as_str(), *n))).collect();
    let pivots = before_pivots(program);
    record(&given.name, &inputs, |arrays| {
        let (own, further) = arrays.split_at(program.inputs().len());
        let seeded = seed(own, further);
        let found = program.evaluate(&seeded.iter().map(Vec::as_slice).collect::<Vec<_>>());
        let of = |part: fn(&Dual<Traced>) -> Traced| move |x: &Vec<Dual<Traced>>| x.iter().map(part).collect();
        let names = program.outputs().iter().map(|output| output.name.as_str());
        let mut values: Vec<(&str, Vec<Traced>)> = names.zip(found.iter().map(of(|x| x.value))).collect();
        let pivots = values.split_off(pivots);
        values.truncate(if given.values { values.len() } else { 0 });
        let rates = given.rates.iter().map(String::as_str).zip(found.iter().map(of(|x| x.derivative)));
        values.into_iter().chain(rates).chain(pivots).collect()
    })
}

/// θ with its rate along the velocities: q̇ = ½ q ω of a quaternion, ṗ = R v of an origin, θ̇ of any other joint.
fn positions(model: &Model, theta: &[Traced], velocities: &[Traced]) -> Vec<Dual<Traced>> {
    let mut moving = Dual::constants(theta);
    for place in model.configuration_space().places() {
        let (moving, theta, v) =
            (&mut moving[place.positions()], &theta[place.positions()], &velocities[place.velocities()]);
        if place.freedom == Freedom::One {
            moving[0].derivative = v[0];
            continue;
        }
        let (w, q, omega) = (theta[0], Vec3([theta[1], theta[2], theta[3]]), Vec3([v[0], v[1], v[2]]));
        let half = omega * Traced::from(0.5);
        let turned = half * w + q.cross(half);
        moving[0].derivative = -q.dot(half);
        (0..3).for_each(|k| moving[1 + k].derivative = turned.0[k]);
        if place.freedom == Freedom::Free {
            let shifted = SO3::from_quaternion(w, q) * Vec3([v[3], v[4], v[5]]);
            (0..3).for_each(|k| moving[4 + k].derivative = shifted.0[k]);
        }
    }
    moving
}

/// wᵀ∂f by the inputs in a set, one after the other: after all other inputs w, a number for each output but pivots; its
/// output is the gradient, then the pivots. Each step hands its own derivative ȳ to its operands,
///
/// > ā += ȳ ∂y/∂a
///
/// from the last step to the first, which takes at most about four times the program's operations for any number of
/// inputs.
fn backward(program: &Program, wanted: u32) -> Result<Program, TooLong> {
    let (own, pivots) = program.outputs().split_at(before_pivots(program));
    let length = own.iter().map(|output| output.values.len()).sum();
    let inputs = program.inputs().iter().map(|array| (array.name.as_str(), array.length)).chain([("w", length)]);
    record(program.name(), &inputs.collect::<Vec<_>>(), |arrays| {
        let (x, w) = arrays.split_at(program.inputs().len());
        let y = program.values(&x.iter().map(Vec::as_slice).collect::<Vec<_>>());
        let mut bars: Vec<Option<Traced>> = vec![None; y.len()];
        for (&value, &w) in own.iter().flat_map(|output| &output.values).zip(&w[0]) {
            add(&mut bars, value, w);
        }
        for place in (0..y.len()).rev() {
            let (Some(bar), Step::Apply(function, operands)) = (bars[place], program.steps()[place]) else { continue };
            let found = handed(function, operands.map(|operand| y[operand as usize]), y[place], bar);
            for (&operand, found) in operands.iter().zip(found).take(function.arity()) {
                add(&mut bars, operand, found);
            }
        }
        let mut gradients: Vec<Vec<Traced>> =
            program.inputs().iter().map(|array| vec![Traced::from(0.0); array.length]).collect();
        for (step, bar) in program.steps().iter().zip(&bars) {
            if let (Step::Input(array, index), Some(bar)) = (step, bar) {
                gradients[*array as usize][*index as usize] = *bar;
            }
        }
        let wanted = gradients.into_iter().enumerate().filter(|&(k, _)| has(wanted, k)).flat_map(|(_, list)| list);
        let of = |output: &crate::Output| output.values.iter().map(|&value| y[value as usize]).collect();
        let pivots = pivots.iter().map(|output| (output.name.as_str(), of(output)));
        [("gradient", wanted.collect())].into_iter().chain(pivots).collect()
    })
}

fn add(bars: &mut [Option<Traced>], value: u32, x: Traced) {
    let bar = &mut bars[value as usize];
    *bar = Some(bar.map_or(x, |bar| bar + x));
}

/// ȳ ∂y/∂a for each operand a of y = f(a, b, c).
fn handed(function: Function, [a, b, _]: [Traced; 3], y: Traced, bar: Traced) -> [Traced; 3] {
    use Function::*;
    use mozzi::Scalar;
    let (zero, one) = (Traced::from(0.0), Traced::from(1.0));
    match function {
        Add => [bar, bar, zero],
        Sub => [bar, -bar, zero],
        Mul => [bar * b, bar * a, zero],
        Div => [bar / b, -(bar / b) * y, zero],
        Neg => [-bar, zero, zero],
        MulAdd => [bar * b, bar * a, bar],
        MulSub => [bar * b, bar * a, -bar],
        NegMulAdd => [-bar * b, -bar * a, bar],
        NegMulSub => [-bar * b, -bar * a, -bar],
        Sqrt => [bar * Traced::from(0.5) / y, zero, zero],
        Sin => [bar * a.sin_cos().1, zero, zero],
        Cos => [-bar * a.sin_cos().0, zero, zero],
        Tanh => [bar * (one - y * y), zero, zero],
        Sgn => [zero; 3],
    }
}
