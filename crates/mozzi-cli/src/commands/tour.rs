//! `mozzi` alone: a tour of the library on the UR5; every number is computed when it runs.

use super::terms::text::{blocks, state, sum, task, wrench};
use super::terms::values::Terms;
use super::{info, screws, simulate_page};
use crate::columns::save;
use crate::failure::{Failure, Result};
use crate::log;
use crate::task::TaskArguments;
use crate::text::{Page, about, table};
use mozzi::quantities::{
    BodyJacobian, CoriolisMatrix, ForwardDynamics, ForwardKinematics, InverseDynamics, KineticEnergy, MassMatrix,
    PotentialEnergy,
};
use mozzi::{Environment, Model, Wrench};
use mozzi_sim::Trajectory;
use mozzi_sim::{Method, Options, Zero};
use nalgebra::DVector;

const ROBOT: &str = "ur5";
/// The state that is shown.
const THETA: [f64; 6] = [0.0, -1.2, 1.5, 0.3, 1.1, 0.0];
const DTHETA: [f64; 6] = [0.5, -0.3, 0.4, 0.2, -0.6, 1.0];
const DDTHETA: [f64; 6] = [1.0, 0.5, -1.0, 2.0, 0.0, -0.5];
const F_TIP: [f64; 6] = [0.0, 0.0, 0.5, 0.0, 0.0, 20.0];
/// Duration and steps of the fall.
const SECONDS: f64 = 2.0;
const STEPS: usize = 2000;

pub fn run() -> Result<String> {
    let model = mozzi_urdf::open(ROBOT)?.build()?;
    let mut page = Page::default();
    page.line("mozzi: every term of a robot's dynamics, in the notation of Lynch & Park, Modern Robotics, chapter 8");
    page.line(format!("{}; {}", info::headline(&model), info::surroundings(&model)));
    robot(&model, &mut page);
    one_state(&model, &mut page)?;
    fall(&model, &mut page)?;
    page.title("next");
    page.lines(&[
        "mozzi terms ur5 --theta 0,-1.2,1.5,0.3,1.1,0 --stacked   all of this at your state, and 𝒜 𝒢 𝒲 ℒ".to_string(),
        "mozzi info my_robot.urdf                                 your robot; mozzi check lists its errors".to_string(),
        "mozzi simulate panda --torque gravity-compensation       motors compensate gravity".to_string(),
        "mozzi --help                                             all subcommands, with examples".to_string(),
    ]);
    Ok(page.end())
}

fn robot(model: &Model, page: &mut Page) {
    let Ok(lists) = model.screws() else { return };
    page.title("1  a robot is a list of screws and a list of masses");
    page.lines(&[
        "At θ = 0, in base coordinates: joint i at 1 rad/s moves the links beyond it with the twist S_i = (ω, v),"
            .to_string(),
    ]);
    page.lines(&[
        "ω in rad/s, and v in m/s of the point at the base's origin. Six-vectors are angular first.".to_string()
    ]);
    page.lines(&screws::axes(&lists, &lists.S));
    page.lines(&[
        "Mass m [kg], centre of mass p [m], inertia about it [kg m²], in frame {i} at the centre of mass:".to_string()
    ]);
    page.lines(&screws::masses(&lists));
}

fn one_state(model: &Model, page: &mut Page) -> Result<()> {
    let applied = [(model.end_effector()?, Wrench::from_array(F_TIP))];
    let environment = Environment { applied: &applied, ..model.environment() };
    let mut terms = Terms::at(model, [THETA.to_vec(), DTHETA.to_vec(), DDTHETA.to_vec()], &environment)?;
    terms.add_task(&TaskArguments::default(), &environment)?;
    page.title("2  every term of its dynamics, at one state").lines(&state(&terms)).lines(&wrench(&terms));
    page.lines(&blocks(
        &terms,
        &[
            ("J_b(θ): V_b = J_b θ̇, the tip's twist, and τ = J_bᵀF", BodyJacobian.into(), 0),
            ("T_sb(θ), the tip's pose [R p]", ForwardKinematics.into(), 0),
        ],
    ));
    page.lines(&blocks(
        &terms,
        &[
            ("M(θ), mass matrix [kg m²]", MassMatrix.into(), 0),
            ("C(θ, θ̇), Coriolis: C θ̇ = c, Ṁ = C + Cᵀ", CoriolisMatrix.into(), 0),
        ],
    ));
    page.blank().line("  The equation of motion, τ = M θ̈ + c + g + JᵀF_tip + f, term by term:").lines(&sum(&terms));
    let tau = model.closed_form(&THETA, &DTHETA, &environment)?.inverse_dynamics(&DVector::from_column_slice(&DDTHETA));
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
    page.lines(&[
        format!(
            "The book's closed form, by dense stacked matrices, gives the same τ to {:.0e} N m",
            apart(tau.as_slice(), terms.vector(InverseDynamics))
        ),
        format!(
            "and forward dynamics, in O(n), takes τ back to θ̈ to {:.0e} rad/s².",
            apart(&DDTHETA, terms.vector(ForwardDynamics))
        ),
        format!(
            "Kinetic energy ½ θ̇ᵀMθ̇ = {:.4} J, potential energy −Σ m gᵀp = {:.4} J.",
            terms.vector(KineticEnergy)[0],
            terms.vector(PotentialEnergy)[0]
        ),
    ]);
    let mut lines = vec!["Seen from the tip, in its frame, F = Λ V̇ + η:".to_string()];
    lines.extend(task(&terms).into_iter().skip(1));
    page.lines(&lines);
    Ok(())
}

fn fall(model: &Model, page: &mut Page) -> Result<()> {
    page.title("3  a fall: motors off, from rest at the same θ, for 2 s in steps of 1 ms");
    let options = |method| Options { method, ..Options::new(SECONDS, STEPS) };
    let mut motions = Vec::new();
    for method in [Method::SemiImplicitEuler, Method::RungeKutta4] {
        let options = options(method);
        motions.push((method, mozzi_sim::simulate(model, &THETA, &[0.0; 6], Zero, &options)?));
    }
    if let Some((method, motion)) = motions.last() {
        page.lines(&[format!(
            "by {}; K kinetic, P potential energy, drift of K + P; joint limits are not enforced:",
            method.name()
        )]);
        page.lines(&simulate_page::rows(model, motion, 8));
    }
    page.blank().lines(&drifts(&motions));
    let file = format!("mozzi-fall-{ROBOT}.csv");
    save(&file, csv(model, &motions))?;
    let path = std::path::absolute(&file).map_err(|error| Failure::wrong(format!("{file}: {error}")))?;
    let rows: usize = motions.iter().map(|(_, motion)| motion.len()).sum();
    page.lines(&[format!("The table, {rows} rows with t, θ, θ̇, θ̈, τ, energies: {}", path.display())]);
    Ok(())
}

/// One row for each method: order, largest drift.
fn drifts(motions: &[(Method, Trajectory)]) -> Vec<String> {
    let mut cells = vec![
        ["method", "order", "largest energy drift", "of the largest K", "|θ − θ of the last| at 2 s"]
            .map(String::from)
            .to_vec(),
    ];
    let best = motions.last().map(|(_, motion)| motion.last().theta.to_vec()).unwrap_or_default();
    for (method, motion) in motions {
        let (drift, scale) = (motion.largest_drift(), motion.largest_kinetic_energy());
        let away = motion.last().theta.iter().zip(&best).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        cells.push(vec![
            method.name().to_string(),
            method.order().to_string(),
            format!("{} J", about(drift)),
            about(drift / scale),
            if away == 0.0 { "–".to_string() } else { format!("{} rad", about(away)) },
        ]);
    }
    table(&cells, "lr")
}

/// One table: a column that names the method, then those of `mozzi simulate`.
fn csv(model: &Model, motions: &[(Method, Trajectory)]) -> Vec<u8> {
    let mut text = format!("method,{}\n", log::names(model).join(",")).into_bytes();
    for (method, motion) in motions {
        for row in motion.samples() {
            text.extend(format!("{},", method.name()).into_bytes());
            let _ = log::line(&mut text, &row); // writing to memory cannot fail
        }
    }
    text
}
