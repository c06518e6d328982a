//! `mozzi terms`: every quantity of the dynamics at one state.

use super::derivatives::Derivatives;
use super::{terms_json, terms_text};
use crate::failure::{self, Failure, Result};
use crate::json;
use crate::numbers::TWIST;
use crate::robot::{RobotArguments, end_effector};
use crate::state::{Motion, MotionArguments, environment};
use clap::{Args, ValueEnum};
use mozzi::{
    BodyFrame, ClosedForm, Environment, FrameId, Jacobian, Model, NewtonEuler, SE3, Task, TaskFrame, TaskSpaceDynamics,
    Twist, Wrench,
};
use nalgebra::{DMatrix, DVector};

#[derive(Args, Debug)]
pub struct TermsArguments {
    #[command(flatten)]
    robot: RobotArguments,
    #[command(flatten)]
    motion: MotionArguments,
    /// Rows of the task: of wx, wy, wz, vx, vy, vz those that matter, such as vx,vz for a planar arm [default: all six]
    #[arg(long, value_name = "ROWS")]
    task: Option<String>,
    /// In whose coordinates the task's twist and wrench are
    #[arg(long, value_name = "FRAME", default_value = "body")]
    task_frame: Coordinates,
    /// Show the matrices of the closed form, too: 𝒜 𝒢 𝒲 ℒ [ad_𝒱] [ad_𝒜θ̇] 𝒱 𝒱̇ 𝓕
    #[arg(long)]
    stacked: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Coordinates {
    /// The end effector's
    Body,
    /// The base's
    Space,
}

/// Every quantity at one state.
pub struct Terms<'m> {
    pub model: &'m Model,
    pub theta: Vec<f64>,
    pub dtheta: Vec<f64>,
    pub ddtheta: Vec<f64>,
    /// The tip's wrench on the environment, in the tip's frame.
    pub F_tip: Wrench,
    pub tip: Option<Tip>,
    pub M: DMatrix<f64>,
    pub dM: DMatrix<f64>,
    pub C: DMatrix<f64>,
    pub c: DVector<f64>,
    pub g: DVector<f64>,
    pub h: DVector<f64>,
    pub tip_forces: DVector<f64>,
    pub friction: DVector<f64>,
    pub tau: DVector<f64>,
    /// θ̈ of τ; none where the mass matrix is singular.
    pub forward_dynamics: Option<DVector<f64>>,
    pub kinetic_energy: f64,
    pub potential_energy: f64,
    pub derivatives: Derivatives,
    pub newton_euler: NewtonEuler,
    /// None without end effector, and where the task is singular.
    pub task: Option<TaskSpaceDynamics>,
    pub task_rows: Vec<usize>,
    pub task_frame: TaskFrame,
    pub closed_form: Option<ClosedForm>,
}

/// The end effector at one state.
pub struct Tip {
    pub frame: FrameId,
    pub T_sb: SE3,
    pub J_s: Jacobian,
    pub J_b: Jacobian,
    pub dJ_s: Jacobian,
    pub dJ_b: Jacobian,
    pub V_s: Twist,
    pub V_b: Twist,
}

pub fn run(arguments: &TermsArguments) -> Result<String> {
    let model = arguments.robot.load()?;
    let Motion { state, applied } = arguments.motion.read(&model)?;
    let environment = environment(&model, &applied);
    let task_frame = match arguments.task_frame {
        Coordinates::Body => TaskFrame::Body,
        Coordinates::Space => TaskFrame::Space,
    };
    let mut terms = Terms::at(&model, state, &environment)?;
    terms.add_task(arguments.task.as_deref(), task_frame, &environment)?;
    if arguments.stacked {
        terms.closed_form = Some(model.closed_form(&terms.theta, &terms.dtheta, &environment)?);
    }
    Ok(if arguments.robot.json { json::print(&terms_json::object(&terms)) } else { terms_text::page(&terms) })
}

impl<'m> Terms<'m> {
    /// All but the task and the closed form.
    pub fn at(model: &'m Model, [theta, dtheta, ddtheta]: [Vec<f64>; 3], environment: &Environment) -> Result<Self> {
        let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, environment)?;
        let forward_dynamics = match model.forward_dynamics(&theta, &dtheta, tau.as_slice(), environment) {
            Ok(ddtheta) => Some(ddtheta),
            Err(error) => {
                failure::note(&format!("no forward dynamics: {error}"));
                None
            }
        };
        let tip = match end_effector(model) {
            Some(frame) => Some(Tip::at(model, frame, &theta, &dtheta)?),
            None => None,
        };
        Ok(Terms {
            tip,
            F_tip: environment.applied.first().map_or(Wrench::zero(), |&(_, F)| F),
            M: model.mass_matrix(&theta)?,
            dM: model.mass_matrix_rate(&theta, &dtheta)?,
            C: model.coriolis_matrix(&theta, &dtheta)?,
            c: model.velocity_product(&theta, &dtheta)?,
            g: model.gravity_forces(&theta)?,
            h: model.bias_forces(&theta, &dtheta, &model.environment())?,
            tip_forces: model.tip_forces(&theta, environment.applied)?,
            friction: model.joint_friction(&dtheta)?,
            tau,
            forward_dynamics,
            kinetic_energy: model.kinetic_energy(&theta, &dtheta)?,
            potential_energy: model.potential_energy(&theta)?,
            derivatives: Derivatives::at(model, [&theta, &dtheta, &ddtheta], environment)?,
            newton_euler: model.newton_euler(&theta, &dtheta, &ddtheta, environment, BodyFrame::CenterOfMass)?,
            task: None,
            task_rows: (0..6).collect(),
            task_frame: TaskFrame::Body,
            closed_form: None,
            model,
            theta,
            dtheta,
            ddtheta,
        })
    }

    /// Λ and η; a singular task is an error where it was asked for by name, else a note.
    pub fn add_task(&mut self, rows: Option<&str>, coordinates: TaskFrame, environment: &Environment) -> Result<()> {
        self.task_frame = coordinates;
        if let Some(rows) = rows {
            self.task_rows = rows.split(',').map(row).collect::<Result<_>>()?;
            self.model.end_effector()?;
        }
        let Some(Tip { frame, .. }) = self.tip else { return Ok(()) };
        let task = Task { frame, coordinates, rows: &self.task_rows };
        let still = Environment { applied: &[], ..*environment };
        match self.model.task_space_dynamics(&self.theta, &self.dtheta, task, &still) {
            Ok(dynamics) => self.task = Some(dynamics),
            Err(error) if rows.is_some() => return Err(error.into()),
            Err(mozzi::Error::SingularTask { .. }) if self.model.n() < 6 => failure::note(&format!(
                "Λ and η are left out: {} joints cannot move all six directions; name those that matter, such as --task vx,vz",
                self.model.n()
            )),
            Err(error) => failure::note(&format!("Λ and η are left out: {error}")),
        }
        Ok(())
    }
}

impl Tip {
    fn at(model: &Model, frame: FrameId, theta: &[f64], dtheta: &[f64]) -> Result<Self> {
        let (J_s, J_b) = (model.space_jacobian(theta, frame)?, model.body_jacobian(theta, frame)?);
        Ok(Tip {
            frame,
            T_sb: model.forward_kinematics(theta, frame)?,
            V_s: &J_s * dtheta,
            V_b: &J_b * dtheta,
            dJ_s: model.space_jacobian_rate(theta, dtheta, frame)?,
            dJ_b: model.body_jacobian_rate(theta, dtheta, frame)?,
            J_s,
            J_b,
        })
    }
}

fn row(name: &str) -> Result<usize> {
    let names = ["wx", "wy", "wz", "vx", "vy", "vz"];
    let name = name.trim();
    let found = names.iter().zip(TWIST).position(|(short, symbol)| *short == name || symbol == name);
    found.ok_or_else(|| {
        Failure::wrong(format!("--task: there is no row `{name}`, expected some of {}", names.join(", ")))
    })
}
