//! The quantities of the list at one state.

use crate::commands::compute::noise::cleaned;
use crate::commands::compute::one_state::OneState;
use crate::failure::{self, Failure, Result};
use crate::missing::Missing;
use crate::quantity::hyphenated;
use crate::robot::end_effector;
use crate::task::TaskArguments;
use crate::text::about;
use mozzi::TaskSpaceDynamics;
use mozzi::quantities::{self, BiasForces, InverseDynamics, LIST, Of, Query};
use mozzi::{BodyFrame, ClosedForm, Environment, FrameId, Model, NewtonEuler, Task, TaskFrame, Wrench};
use nalgebra::{DMatrix, DVector};

/// The quantities of a page whose rounding errors may stand alone.
const SHOWN: [&str; 9] = [
    "velocity_product",
    "gravity_forces",
    "tip_forces",
    "inverse_dynamics",
    "forward_dynamics",
    "kinetic_energy",
    "coriolis_matrix",
    "mass_matrix_rate",
    "forward_kinematics",
];

/// The quantities at one state; τ is the torque that the motion needs.
pub struct Terms<'m> {
    pub model: &'m Model,
    pub theta: Vec<f64>,
    pub dtheta: Vec<f64>,
    pub ddtheta: Vec<f64>,
    /// The tip's wrench on the environment, in the tip's frame.
    pub F_tip: Wrench,
    pub tip: Option<FrameId>,
    /// Each quantity's outputs, in the order of the list; none if it cannot be computed, or needs a task or a further
    /// vector.
    pub found: Vec<Option<Vec<Vec<f64>>>>,
    pub newton_euler: NewtonEuler,
    /// None without an end effector, and if the task is singular.
    pub task: Option<TaskSpaceDynamics>,
    /// Whether the task is given, not that of all six directions.
    pub is_task_given: bool,
    pub task_rows: Vec<usize>,
    pub task_frame: TaskFrame,
    pub closed_form: Option<ClosedForm>,
}

impl<'m> Terms<'m> {
    /// All but the task and the closed form. If a quantity cannot be computed, such as for a singular mass matrix, a
    /// note gives the reason.
    pub fn at(model: &'m Model, [theta, dtheta, ddtheta]: [Vec<f64>; 3], environment: &Environment) -> Result<Self> {
        let tip = end_effector(model);
        let tau = model.compute(InverseDynamics, &[&theta, &dtheta, &ddtheta], environment)?.remove(0);
        let given = [("theta", &theta), ("dtheta", &dtheta), ("ddtheta", &ddtheta), ("tau", &tau)];
        let mut missing = Missing::default();
        let mut compute = |query: Query| {
            let input = |name| given.iter().find(|(known, _)| *known == name).map(|(_, values)| values.as_slice());
            let inputs: Vec<&[f64]> =
                query.declaration().inputs.iter().map(|declared| input(declared.name)).collect::<Option<_>>()?;
            let query = match query.declaration().of {
                Of::Frame => query.of(tip?),
                Of::Task => return None,
                Of::Robot | Of::Point => query,
            };
            missing.keep(&query, model.compute(query, &inputs, &of_term(query, *environment)))
        };
        let found = (0..LIST.len()).map(Query::at).map(&mut compute).collect();
        missing.note();
        Ok(Terms {
            tip,
            F_tip: environment.applied.first().map_or(Wrench::zero(), |&(_, F)| F),
            found,
            newton_euler: model.newton_euler(&theta, &dtheta, &ddtheta, environment, BodyFrame::CenterOfMass)?,
            task: None,
            is_task_given: false,
            task_rows: (0..6).collect(),
            task_frame: TaskFrame::Body,
            closed_form: None,
            model,
            theta,
            dtheta,
            ddtheta,
        })
    }

    /// Replaces rounding errors by 0, for a page.
    pub fn clean(&mut self, environment: &Environment) {
        let queries: Vec<Query> = SHOWN.map(Query::named).into_iter().flatten().collect();
        for query in queries {
            let Ok(one) = self.one(query, *environment) else { continue };
            let outputs = cleaned(one.query, self.model, &one.inputs, &one.environment, &one.outputs);
            self.found[query.index()] = Some(outputs);
        }
    }

    /// A quantity of the list at this state, of the end effector if it has a frame.
    ///
    /// # Errors
    /// For those that need a further vector or cannot be computed here.
    pub fn one<'q>(&'q self, query: Query<'q>, environment: Environment<'q>) -> Result<OneState<'q>> {
        let declaration = query.declaration();
        let tau = self.vector(InverseDynamics);
        let given = [("theta", &*self.theta), ("dtheta", &*self.dtheta), ("ddtheta", &*self.ddtheta), ("tau", tau)];
        let mut inputs = Vec::new();
        for input in declaration.inputs {
            let Some((_, values)) = given.iter().find(|(name, _)| *name == input.name) else {
                let name = hyphenated(query.name());
                return Err(Failure::wrong(format!("--only: {name} needs --{}; `mozzi compute` takes it", input.name)));
            };
            inputs.push(values.to_vec());
        }
        let query = match declaration.of {
            Of::Frame => query.of(self.model.end_effector()?),
            Of::Task => query.of_task(Task {
                frame: self.model.end_effector()?,
                coordinates: self.task_frame,
                rows: &self.task_rows,
            }),
            Of::Robot | Of::Point => query,
        };
        let slices: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
        let environment = of_term(query, environment);
        let outputs = self.model.compute(query, &slices, &environment)?;
        Ok(OneState { query, model: self.model, inputs, environment, outputs })
    }

    /// A quantity's first output; empty if there is none.
    pub fn vector<'q>(&self, query: impl Into<Query<'q>>) -> &[f64] {
        self.found[query.into().index()].as_ref().map_or(&[], |outputs| &outputs[0])
    }

    /// A quantity's output with this index, as a matrix.
    pub fn matrix<'q>(&self, query: impl Into<Query<'q>>, output: usize) -> Option<DMatrix<f64>> {
        let query = query.into();
        let values = self.found[query.index()].as_ref()?.get(output)?;
        match query.shapes(self.model)[output][..] {
            [rows, columns] => Some(DMatrix::from_row_slice(rows, columns, values)),
            _ => None,
        }
    }

    /// Jθ̇, the twist (ω, v), of this Jacobian.
    pub fn twist<'q>(&self, jacobian: impl Into<Query<'q>>) -> Option<DVector<f64>> {
        Some(self.matrix(jacobian, 0)? * DVector::from_column_slice(&self.dtheta))
    }

    /// Λ and η; a singular task gives a note, and everything else is computed.
    pub fn add_task(&mut self, arguments: &TaskArguments, environment: &Environment) -> Result<()> {
        (self.task_rows, self.task_frame) = (arguments.rows()?, arguments.coordinates());
        let is_named = arguments.task.is_some();
        self.is_task_given = is_named;
        if is_named {
            self.model.end_effector()?;
        }
        let Some(frame) = self.tip else { return Ok(()) };
        let task = Task { frame, coordinates: self.task_frame, rows: &self.task_rows };
        let still = of_term(quantities::TaskSpaceDynamics.into(), *environment);
        match self.model.task_space_dynamics(&self.theta, &self.dtheta, task, &still) {
            Ok(dynamics) => self.task = Some(dynamics),
            Err(mozzi::Error::SingularTask { singular_values, .. }) if self.model.n() >= 6 && !is_named => {
                let least = singular_values.iter().copied().fold(f64::INFINITY, f64::min);
                let most = singular_values.iter().copied().fold(0.0, f64::max);
                failure::note(&format!(
                    "Λ and η are omitted: the end effector cannot move in all six directions here; the singular values of \
                     its Jacobian are {} to {}",
                    about(least),
                    about(most)
                ));
            }
            Err(mozzi::Error::SingularTask { .. }) if self.model.n() < 6 && !is_named => failure::note(&format!(
                "Λ and η are omitted: with {} of freedom the end effector cannot move in all six directions; choose \
                 some, such as --task vx,vz",
                mozzi_urdf::counted(self.model.n(), "degree")
            )),
            Err(error) if is_named && !is_singular(&error) => return Err(error.into()),
            Err(error) => failure::note(&format!("Λ and η are omitted: {error}")),
        }
        Ok(())
    }
}

/// The environment of a quantity of the equation: JᵀF is a term of its own, which neither h nor η has.
fn of_term<'e>(query: Query, environment: Environment<'e>) -> Environment<'e> {
    let is_still = query == BiasForces.into() || query.declaration().of == Of::Task;
    if is_still { Environment { applied: &[], ..environment } } else { environment }
}

fn is_singular(error: &mozzi::Error) -> bool {
    matches!(error, mozzi::Error::SingularTask { .. } | mozzi::Error::SingularMassMatrix { .. })
}
