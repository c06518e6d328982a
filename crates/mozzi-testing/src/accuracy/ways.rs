//! The ways in which mozzi computes a quantity.

use crate::accuracy::reference::applied;
use crate::accuracy::robot::{Robot, is_of_wrenches};
use crate::accuracy::states::States;
use mozzi::quantities::Query;
use mozzi::{Environment, fast};
use mozzi_engine::{Batch, Compiled, Engine, Number, compile};

/// One way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Way {
    /// The kernel on plain `f64`.
    Plain,
    /// The kernel with fused multiply-add.
    Fused,
    /// Machine code at one state.
    MachineCode,
    /// Machine code at many states.
    MachineCodeLanes,
    /// Machine code at many states in `f32`.
    Single,
}

impl Way {
    /// All.
    pub const ALL: [Way; 5] = [Way::Plain, Way::Fused, Way::MachineCode, Way::MachineCodeLanes, Way::Single];

    /// Its name in the tables.
    pub fn name(self) -> &'static str {
        match self {
            Way::Plain => "f64",
            Way::Fused => "f64, FMA",
            Way::MachineCode => "machine code",
            Way::MachineCodeLanes => "machine code, arrays",
            Way::Single => "f32 arrays",
        }
    }

    /// ε of the way's number type over 2⁻⁵².
    pub fn epsilon(self) -> f64 {
        if self == Way::Single { f64::from(f32::EPSILON) / f64::EPSILON } else { 1.0 }
    }
}

/// Largest number of velocities for which a program is recorded; above it, programs would have millions of operations.
const LARGEST_RECORDED: usize = 80;

/// A quantity of a robot, ready to be computed in a way.
pub struct Computer<'r> {
    robot: &'r Robot,
    query: Query<'r>,
    engine: Inner,
}

#[allow(clippy::large_enum_variant)] // one for each thread
enum Inner {
    One(fast::Workspace),
    Many(Batch),
    Single(Batch<f32>),
    Compiled(Compiled),
}

/// Computes outputs from inputs.
type OneState<'o> = dyn FnMut(&[&[f64]], &mut [&mut [f64]]) + 'o;

impl<'r> Computer<'r> {
    /// None if the way is not available: this machine has no FMA or machine code, or the program is too long.
    pub fn new(robot: &'r Robot, query: Query<'r>, way: Way) -> Option<Self> {
        let model = &robot.model;
        let is_short = model.n() <= LARGEST_RECORDED;
        let own = is_short && !is_of_wrenches(&query);
        let many = || Batch::new(model).with_threads(1).ok();
        let engine = match way {
            Way::Plain => Inner::One(fast::Workspace::portable(model)),
            Way::Fused => Inner::One(fast::Workspace::new(model)).which(|one| one.is_fused(&query))?,
            Way::Single => {
                let batch =
                    own.then(|| Batch::<f32>::of(model).with_threads(1).ok()?.compile(&[query]).ok()).flatten()?;
                let is_code = matches!(batch.engine(query), Engine::MachineCode { .. });
                Inner::Single(batch).which(|_| is_code)?
            }
            Way::MachineCode => {
                let compiled = own.then(|| compile(model, &[query]).ok()).flatten()?;
                let is_code = matches!(compiled.engine(query), Engine::MachineCode { .. });
                Inner::Compiled(compiled).which(|_| is_code)?
            }
            Way::MachineCodeLanes => {
                let batch = own.then(|| many()?.compile(&[query]).ok()).flatten()?;
                let is_code = matches!(batch.engine(query), Engine::MachineCode { .. });
                Inner::Many(batch).which(|_| is_code)?
            }
        };
        Some(Computer { robot, query, engine })
    }

    /// The outputs at some states, each a table.
    pub fn compute(&mut self, states: &States, first: usize, count: usize) -> Vec<Vec<f64>> {
        let (model, query) = (&self.robot.model, self.query);
        let tables = states.inputs(&query, first, count);
        let lengths: Vec<usize> = query.output_lengths(model).collect();
        let mut found: Vec<Vec<f64>> = lengths.iter().map(|length| vec![f64::NAN; length * count]).collect();
        let push = applied(&query, self.robot.frame);
        let environment = Environment { applied: &push, ..model.environment() };
        let widths: Vec<usize> = query.input_lengths(model).collect();
        let mut each = |one: &mut OneState| {
            for k in 0..count {
                let state: Vec<&[f64]> =
                    tables.iter().zip(&widths).map(|(table, &width)| &table[k * width..][..width]).collect();
                let mut outputs: Vec<&mut [f64]> =
                    found.iter_mut().zip(&lengths).map(|(x, &length)| &mut x[k * length..][..length]).collect();
                one(&state, &mut outputs);
            }
        };
        match &mut self.engine {
            Inner::One(workspace) => each(&mut |state, outputs| {
                fast::evaluate(&query, model, state, &environment, workspace, outputs);
            }),
            Inner::Compiled(compiled) => each(&mut |state, outputs| {
                compiled.evaluate(query, state, outputs);
            }),
            Inner::Many(batch) => {
                found = many(batch, query, &tables, &environment, &lengths, count);
            }
            Inner::Single(batch) => {
                found = many(batch, query, &tables, &environment, &lengths, count);
            }
        }
        found
    }
}

impl Inner {
    fn which(self, holds: impl FnOnce(&Self) -> bool) -> Option<Self> {
        holds(&self).then_some(self)
    }
    fn is_fused(&self, query: &Query) -> bool {
        matches!(self, Inner::One(workspace) if workspace.is_fused(query))
    }
}

fn many<T: Number>(
    batch: &Batch<T>,
    query: Query,
    tables: &[&[f64]],
    environment: &Environment,
    lengths: &[usize],
    count: usize,
) -> Vec<Vec<f64>> {
    let tables: Vec<Vec<T>> = tables.iter().map(|table| table.iter().map(|&x| T::from_f64(x)).collect()).collect();
    let inputs: Vec<&[T]> = tables.iter().map(Vec::as_slice).collect();
    let nan = T::from_f64(f64::NAN);
    let mut found: Vec<Vec<T>> = lengths.iter().map(|length| vec![nan; length * count]).collect();
    let mut outputs: Vec<&mut [T]> = found.iter_mut().map(Vec::as_mut_slice).collect();
    match batch.compute(query, &inputs, &(*environment).into(), &mut outputs) {
        // the error of a singular state comes after all states are computed
        Ok(()) | Err(mozzi_engine::Error::State { .. }) => {}
        Err(error) => panic!("{}: {error}", query.name()),
    }
    found.into_iter().map(|x| x.into_iter().map(Into::into).collect()).collect()
}
