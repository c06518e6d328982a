//! `mozzi derivatives`: how τ and θ̈ change with θ, θ̇ and each other, at one state.

use crate::failure::{self, Result};
use crate::json;
use crate::robot::RobotArguments;
use crate::state::{Motion, MotionArguments, environment};
use crate::text::{Page, beside, flow, matrix};
use clap::Args;
use mozzi::{Environment, ForwardDynamicsDerivatives, InverseDynamicsDerivatives, Model};
use nalgebra::DMatrix;
use serde_json::{Value, json};

#[derive(Args, Debug)]
pub struct DerivativesArguments {
    #[command(flatten)]
    robot: RobotArguments,
    #[command(flatten)]
    motion: MotionArguments,
}

/// All derivatives at one state.
pub struct Derivatives {
    pub inverse: InverseDynamicsDerivatives,
    /// None where the mass matrix is singular.
    pub forward: Option<ForwardDynamicsDerivatives>,
    /// ∂g/∂θ.
    pub gravity: DMatrix<f64>,
}

impl Derivatives {
    /// At (θ, θ̇, θ̈), τ being what that motion takes. A singular mass matrix is a note.
    pub fn at(model: &Model, [theta, dtheta, ddtheta]: [&[f64]; 3], environment: &Environment) -> Result<Self> {
        let tau = model.inverse_dynamics(theta, dtheta, ddtheta, environment)?;
        let forward = match model.forward_dynamics_derivatives(theta, dtheta, tau.as_slice(), environment) {
            Ok(forward) => Some(forward),
            Err(error) => {
                failure::note(&format!("no derivatives of forward dynamics: {error}"));
                None
            }
        };
        let inverse = model.inverse_dynamics_derivatives(theta, dtheta, ddtheta, environment)?;
        Ok(Derivatives { inverse, forward, gravity: model.gravity_forces_derivative(theta)? })
    }

    /// Matrices beside each other.
    pub fn lines(&self) -> Vec<String> {
        let named = |name: &str, values: &DMatrix<f64>| (name.to_string(), matrix(values));
        let mut lines = beside(&[
            named("∂τ/∂θ", &self.inverse.d_theta),
            named("∂τ/∂θ̇", &self.inverse.d_dtheta),
            named("∂τ/∂θ̈ = M", &self.inverse.d_ddtheta),
            named("∂g/∂θ", &self.gravity),
        ]);
        if let Some(forward) = &self.forward {
            lines.extend(beside(&[
                named("∂θ̈/∂θ", &forward.d_theta),
                named("∂θ̈/∂θ̇", &forward.d_dtheta),
                named("∂θ̈/∂τ = M⁻¹", &forward.d_tau),
            ]));
        }
        lines
    }

    /// By the library's names.
    pub fn object(&self) -> Value {
        json!({
            "inverse_dynamics": {
                "d_theta": json::matrix(&self.inverse.d_theta),
                "d_dtheta": json::matrix(&self.inverse.d_dtheta),
                "d_ddtheta": json::matrix(&self.inverse.d_ddtheta),
            },
            "forward_dynamics": self.forward.as_ref().map(|forward| json!({
                "d_theta": json::matrix(&forward.d_theta),
                "d_dtheta": json::matrix(&forward.d_dtheta),
                "d_tau": json::matrix(&forward.d_tau),
            })),
            "gravity_forces": { "d_theta": json::matrix(&self.gravity) },
        })
    }
}

pub fn run(arguments: &DerivativesArguments) -> Result<String> {
    let model = arguments.robot.load()?;
    let Motion { state: [theta, dtheta, ddtheta], applied } = arguments.motion.read(&model)?;
    let environment = environment(&model, &applied);
    let derivatives = Derivatives::at(&model, [&theta, &dtheta, &ddtheta], &environment)?;
    if arguments.robot.json {
        return Ok(json::print(&json::of_robot(
            &model,
            json!({
                "theta": json::vector(&theta),
                "dtheta": json::vector(&dtheta),
                "ddtheta": json::vector(&ddtheta),
                "F_tip": applied.first().map(|(_, F)| json::vector(&F.to_array())),
                "derivatives": derivatives.object(),
            }),
        )));
    }
    let mut page = Page::default();
    page.line(format!("{}: rows and columns in the order of", model.description().name));
    let names: Vec<String> = model.velocity_names().zip(1..).map(|(name, j)| format!("{j} {name}")).collect();
    page.lines(&flow(&names));
    if model.is_floating() {
        page.line("a column by θ is along the velocity: of the floating base along its twist in its own coordinates");
    }
    page.title("derivatives of inverse and forward dynamics").lines(&derivatives.lines());
    Ok(page.end())
}
