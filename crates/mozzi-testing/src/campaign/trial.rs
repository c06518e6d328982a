//! One case, computed in every way.

use crate::campaign::LIMIT;
use crate::campaign::case::{Case, Numbers};
use crate::campaign::condition::{Condition, LARGEST};
use crate::campaign::log::Way;
use crate::{Given, second_way_of_f64};
use mozzi::quantities::{Memory, Of, Query};
use mozzi::random::Random;
use mozzi::{Environment, Model, Scalar, Twist, Vec3, Wrench, fast};
use mozzi_engine::{Arguments, Batch, Engine, Number, compile, record_quantity};

/// Neighbours from which a unit is determined, and for a difference that seems too large.
const DRAWS: [usize; 2] = [3, 24];

/// A unit that is smaller, relative to ε of what is given, is that of a structural zero.
const NOTHING: f64 = 1e-9;

/// A case whose numbers are all changed by ε.
struct Neighbour {
    model: Model,
    numbers: Numbers,
    point: Vec3,
    environment: Environment<'static>,
}

/// A case with its model and the memory of its kernels.
pub struct Trial<'c> {
    case: &'c Case,
    model: &'c Model,
    numbers: Numbers,
    condition: Condition,
    neighbours: Vec<Neighbour>,
    portable: fast::Workspace,
    fused: fast::Workspace,
    memory: Memory<f64>,
    single: (Model<f32>, Memory<f32>),
}

/// A quantity by the kernel on `f64`.
pub struct Plain<'q> {
    query: Query<'q>,
    values: Vec<Vec<f64>>,
    /// The unit of each output.
    units: Vec<f64>,
}

/// The result of a comparison.
#[derive(Clone, Debug)]
pub struct Compared {
    /// The largest difference, in units.
    pub units: f64,
    /// How many numbers were compared.
    pub numbers: usize,
    /// Output, index, and both numbers.
    pub what: String,
}

type Outputs = Vec<Vec<f64>>;

impl<'c> Trial<'c> {
    /// None if the case lacks a frame.
    pub fn new(case: &'c Case, model: &'c Model) -> Option<Self> {
        let numbers = case.numbers(model)?;
        let single = model.map(|x| x as f32);
        Some(Trial {
            condition: Condition::new(model, &numbers, case.coordinates, &case.rows),
            neighbours: Vec::new(),
            portable: fast::Workspace::portable(model),
            fused: fast::Workspace::new(model),
            memory: Memory::new(model),
            single: (single.clone(), Memory::new(&single)),
            case,
            model,
            numbers,
        })
    }

    /// The kernel's result and its unit.
    ///
    /// # Errors
    /// Why this quantity is not compared for this robot.
    pub fn plain(&mut self, index: usize) -> Result<Plain<'c>, &'static str> {
        let query = self.case.query(index, &self.numbers);
        if query.output_lengths(self.model).all(|length| length == 0) {
            return Err("no numbers");
        }
        let kappa = self.condition.of(query.declaration());
        if !(kappa < LARGEST) {
            return Err("ill-conditioned");
        }
        if self.condition.is_spread(query.declaration()) {
            return Err("constraints of different sizes");
        }
        let environment = self.case.environment(&self.numbers);
        let inputs = self.numbers.inputs(&query);
        let mut values = empty(&query, self.model);
        let mut slices: Vec<&mut [f64]> = values.iter_mut().map(Vec::as_mut_slice).collect();
        let outcome = fast::compute(&query, self.model, &inputs, &environment, &mut self.portable, &mut slices);
        match outcome {
            Ok(()) => {}
            Err(mozzi::Error::NoMass { .. }) => return Err("no mass"),
            Err(_) => return Err("singular"),
        }
        let units = vec![0.0; values.len()];
        let mut plain = Plain { query, values, units };
        self.measure(&mut plain, DRAWS[0]);
        Ok(plain)
    }

    /// Determines the units from so many neighbours.
    fn measure(&mut self, plain: &mut Plain, draws: usize) {
        while self.neighbours.len() < draws {
            self.neighbours.push(self.neighbour(self.neighbours.len() as u64));
        }
        let size = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let kappa = self.condition.of(plain.query.declaration());
        for (unit, x) in plain.units.iter_mut().zip(&plain.values) {
            *unit = unit.max(f64::EPSILON * (1.0 + kappa) * size(x));
        }
        let largest: Vec<f64> = plain.values.iter().map(|x| f64::EPSILON * kappa * size(x)).collect();
        for other in &self.neighbours[..draws] {
            let mut query = plain.query;
            if query.declaration().of == Of::Point {
                query = query.about(other.point);
            }
            let environment = Environment { applied: &other.numbers.applied, ..other.environment };
            let found = evaluate(&query, &other.model, &other.numbers.inputs(&query), &environment, &mut self.portable);
            for (k, found) in found.iter().enumerate() {
                let differences = found.iter().zip(&plain.values[k]).map(|(x, y)| (x - y).abs());
                plain.units[k] = plain.units[k].max(differences.fold(0.0, f64::max) + largest[k]);
            }
        }
        // for an output that is 0 whatever the constants: ε of what is given
        let given = plain.query.declaration().inputs.len();
        let given = self.numbers.state[..given.min(4)].iter().fold(1.0_f64, |m, x| m.max(size(x)));
        let given = f64::EPSILON * given * self.model.mass().max(1.0);
        plain.units.iter_mut().filter(|unit| **unit < NOTHING * given).for_each(|unit| *unit = given);
    }

    fn neighbour(&self, draw: u64) -> Neighbour {
        let random = std::cell::RefCell::new(Random(draw + 77));
        let change = |x: f64| change(x, &random);
        let turn = |x: f64| change(0.0) + x;
        let mut numbers = self.numbers.clone();
        let [theta, rest @ ..] = &mut numbers.state;
        theta.iter_mut().for_each(|x| *x = if x.abs() > 1.0 { change(*x) } else { turn(*x) });
        rest.iter_mut().flatten().for_each(|x| *x = change(*x));
        let six = |x: [f64; 6]| x.map(change);
        numbers.applied.iter_mut().for_each(|(_, F)| *F = Wrench::from_array(six(F.to_array())));
        let own = self.case.environment(&self.numbers);
        let environment = Environment {
            gravity: own.gravity.map(change),
            base_twist: Twist::from_array(six(own.base_twist.to_array())),
            base_acceleration: Twist::from_array(six(own.base_acceleration.to_array())),
            applied: &[],
        };
        Neighbour { model: self.model.map(change), numbers, point: self.case.point.map(change), environment }
    }

    /// Compares a way with the kernel; None if there is no such way for this quantity, robot or machine.
    pub fn compare(&mut self, plain: &mut Plain, way: Way) -> Option<Compared> {
        let found = self.found(&plain.query, way)?;
        let first = difference(plain, &found, way);
        if first.units <= LIMIT || way == Way::Memory {
            return Some(first);
        }
        self.measure(plain, DRAWS[1]);
        if way == Way::Second {
            self.measure_second(plain, &found);
        }
        Some(difference(plain, &found, way))
    }

    /// Raises the units to the largest change of the second way, whose terms can be larger than the kernel's: it works
    /// in {s}, where the motion of the whole robot is in each term.
    fn measure_second(&mut self, plain: &mut Plain, found: &[Vec<f64>]) {
        for (draw, other) in self.neighbours.iter().enumerate().take(DRAWS[0]) {
            let random = std::cell::RefCell::new(Random(draw as u64 + 777));
            let robot = self.model.description().map(|x| change(x, &random));
            let (inputs, mut of) = (other.numbers.inputs(&plain.query), plain.query.subject);
            of.point = other.point;
            let environment = Environment { applied: &other.numbers.applied, ..other.environment };
            let given = Given { robot: &robot, model: &other.model, of, inputs: &inputs, environment: &environment };
            let changed = second_way_of_f64(plain.query.index(), given);
            for ((unit, x), y) in plain.units.iter_mut().zip(&changed).zip(found) {
                *unit = x.iter().zip(y).fold(*unit, |unit, (x, y)| unit.max((x - y).abs()));
            }
        }
    }

    /// The outputs in this way.
    pub fn found(&mut self, query: &Query, way: Way) -> Option<Outputs> {
        let environment = self.case.environment(&self.numbers);
        let inputs = self.numbers.inputs(query);
        let declaration = query.declaration();
        let is_single = matches!(way, Way::Single | Way::SingleArrays);
        if is_single && declaration.divides {
            return None;
        }
        Some(match way {
            Way::Second => {
                let (robot, model, of) = (self.model.description(), self.model, query.subject);
                let given = Given { robot, model, of, inputs: &inputs, environment: &environment };
                second_way_of_f64(query.index(), given)
            }
            Way::Memory => {
                self.memory.fill_nan();
                on(query, self.model, &inputs, &environment, &mut self.memory)
            }
            Way::Fused => {
                if !self.fused.is_fused(query) {
                    return None;
                }
                evaluate(query, self.model, &inputs, &environment, &mut self.fused)
            }
            Way::Single => {
                let inputs: Vec<Vec<f32>> = inputs.iter().map(|x| x.iter().map(|&x| x as f32).collect()).collect();
                let inputs: Vec<&[f32]> = inputs.iter().map(Vec::as_slice).collect();
                let mut applied = Vec::new();
                let environment = environment.map(|x| x as f32, &mut applied);
                on(query, &self.single.0, &inputs, &environment, &mut self.single.1)
            }
            Way::Program => {
                let frames: Vec<_> = environment.applied.iter().map(|&(frame, _)| frame).collect();
                let is_alone = self.case.is_alone();
                let arguments = if is_alone {
                    Arguments { about: declaration.of == Of::Point, ..Arguments::default() }
                } else {
                    Arguments {
                        gravity: true,
                        base_twist: true,
                        base_acceleration: true,
                        about: declaration.of == Of::Point,
                        wrenches: &frames,
                        ..Arguments::default()
                    }
                };
                if mozzi_engine::is_too_long(self.model, *query) {
                    return None;
                }
                let program = record_quantity(self.model, *query, arguments).ok()?;
                let (twist, acceleration) =
                    (environment.base_twist.to_array(), environment.base_acceleration.to_array());
                let wrenches: Vec<[f64; 6]> = environment.applied.iter().map(|(_, F)| F.to_array()).collect();
                let mut all = inputs.clone();
                if !is_alone {
                    all.extend([&environment.gravity.0[..], &twist, &acceleration]);
                }
                if arguments.about {
                    all.push(&self.case.point.0);
                }
                all.extend(wrenches.iter().map(<[f64; 6]>::as_slice));
                program.evaluate(&all)
            }
            Way::Code => {
                if !self.case.is_alone() {
                    return None;
                }
                let compiled = compile(self.model, &[*query]).ok()?;
                if !matches!(compiled.engine(*query), Engine::MachineCode { .. }) {
                    return None;
                }
                let mut outputs = empty(query, self.model);
                let mut slices: Vec<&mut [f64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
                compiled.evaluate(*query, &inputs, &mut slices);
                outputs
            }
            Way::Arrays => arrays::<f64>(self.model, query, &inputs, environment)?,
            Way::SingleArrays => arrays::<f32>(self.model, query, &inputs, environment)?,
            Way::C => return None, // by `emitted`, many quantities together
        })
    }

    /// Compares outputs that were computed elsewhere.
    pub fn compare_with(&mut self, plain: &mut Plain, found: &[Vec<f64>], way: Way) -> Compared {
        self.measure(plain, DRAWS[1]);
        difference(plain, found, way)
    }

    /// The numbers of the case.
    pub fn numbers(&self) -> &Numbers {
        &self.numbers
    }
}

impl<'q> Plain<'q> {
    /// The quantity.
    pub fn query(&self) -> Query<'q> {
        self.query
    }
}

/// x (1 ± ε), and ±ε for 0.
fn change(x: f64, random: &std::cell::RefCell<Random>) -> f64 {
    let size = if x == 0.0 { 1.0 } else { x.abs() };
    let up = random.borrow_mut().next() < 0.0;
    x + if up { f64::EPSILON } else { -f64::EPSILON } * size
}

fn empty<C: Scalar>(query: &Query, model: &Model<C>) -> Outputs {
    query.output_lengths(model).map(|length| vec![f64::NAN; length]).collect()
}

fn evaluate(
    query: &Query,
    model: &Model,
    inputs: &[&[f64]],
    environment: &Environment,
    workspace: &mut fast::Workspace,
) -> Outputs {
    let mut outputs = empty(query, model);
    let mut slices: Vec<&mut [f64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
    fast::evaluate(query, model, inputs, environment, workspace, &mut slices);
    outputs
}

/// The kernel on a number type.
fn on<S: Scalar + Into<f64> + 'static>(
    query: &Query,
    model: &Model<S>,
    inputs: &[&[S]],
    environment: &Environment<S>,
    memory: &mut Memory<S>,
) -> Outputs {
    let nan = S::from_f64(f64::NAN);
    let mut outputs: Vec<Vec<S>> = query.output_lengths(model).map(|length| vec![nan; length]).collect();
    let mut slices: Vec<&mut [S]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
    query.evaluate(model, inputs, environment, memory, &mut slices);
    outputs.into_iter().map(|x| x.into_iter().map(Into::into).collect()).collect()
}

/// Machine code at many states, of which there is one.
fn arrays<T: Number>(model: &Model, query: &Query, inputs: &[&[f64]], environment: Environment) -> Option<Outputs> {
    let environment = environment.into();
    let batch = Batch::<T>::of(model).with_threads(1).ok()?;
    let batch = batch.for_job_of(&[*query], &environment, usize::MAX).ok()?;
    if !matches!(batch.engine_in(*query, &environment), Engine::MachineCode { .. }) {
        return None;
    }
    let inputs: Vec<Vec<T>> = inputs.iter().map(|x| x.iter().map(|&x| T::from_f64(x)).collect()).collect();
    let inputs: Vec<&[T]> = inputs.iter().map(Vec::as_slice).collect();
    let nan = T::from_f64(f64::NAN);
    let mut outputs: Vec<Vec<T>> = query.output_lengths(model).map(|length| vec![nan; length]).collect();
    let mut slices: Vec<&mut [T]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
    batch.compute(*query, &inputs, &environment, &mut slices).ok()?;
    Some(outputs.into_iter().map(|x| x.into_iter().map(Into::into).collect()).collect())
}

fn difference(plain: &Plain, found: &[Vec<f64>], way: Way) -> Compared {
    let mut worst = Compared { units: 0.0, numbers: 0, what: String::new() };
    for (k, (expected, unit)) in plain.values.iter().zip(&plain.units).enumerate() {
        let Some(found) = found.get(k).filter(|found| found.len() == expected.len()) else {
            return Compared { units: f64::INFINITY, what: format!("output {k} has a wrong length"), ..worst };
        };
        worst.numbers += expected.len();
        for (i, (&f, &e)) in found.iter().zip(expected).enumerate() {
            let units = match way {
                _ if f.to_bits() == e.to_bits() && !e.is_nan() => 0.0,
                Way::Memory => f64::INFINITY,
                _ => (f - e).abs() / (unit * way.epsilon()),
            };
            let units = if units.is_nan() { f64::INFINITY } else { units };
            if units > worst.units {
                worst.units = units;
                if units > LIMIT {
                    worst.what = format!("output {k}[{i}]: {f:e}, kernel {e:e}, unit {unit:e}");
                }
            }
        }
    }
    worst
}
