//! `mozzi` alone: a tour of the library on the UR5; every number is computed when it runs.

use super::terms::text::{blocks, state, sum};
use super::terms::values::Terms;
use super::{info, screws, simulate_page};
use crate::columns::save;
use crate::failure::Result;
use crate::log;
use crate::text::{Page, about, page_width, table, wrapped};
use mozzi::quantities::{ForwardDynamics, InverseDynamics, MassMatrix};
use mozzi::{Environment, Model, Wrench};
use mozzi_sim::{Method, Options, Trajectory, Zero};
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

/// `file` is where the table of the fall goes, if anywhere.
pub fn run(file: Option<&str>) -> Result<String> {
    let model = mozzi_urdf::open(ROBOT)?.build()?;
    let mut page = Page::default();
    page.line("mozzi: robot dynamics in the notation of Lynch & Park, Modern Robotics, chapter 8");
    page.line(info::headline(&model));
    robot(&model, &mut page);
    one_state(&model, &mut page)?;
    fall(&model, &mut page, file)?;
    page.title("next");
    page.lines(&[
        "mozzi terms ur5 --q 0,-1.2,1.5,0.3,1.1,0 --all   all of this at your state".to_string(),
        "mozzi info my_robot.urdf                         your robot; `mozzi check` too".to_string(),
        "mozzi simulate panda --controller pd-gravity     motors hold it".to_string(),
        "mozzi --help                                     all commands, with examples".to_string(),
    ]);
    Ok(page.end())
}

fn robot(model: &Model, page: &mut Page) {
    let Ok(lists) = model.screws() else { return };
    page.title("1  a robot is a list of screws, and of masses (mozzi screws ur5)");
    let sentence = "Joint i at 1 rad/s moves the links beyond it with the twist S_i = (ω, v), at θ = 0 \
                    in base coordinates, angular first; v of the point at the base's origin:";
    page.lines(&wrapped(sentence, page_width() - 4, 2));
    page.lines(&screws::axes(&lists, &lists.S));
}

fn one_state(model: &Model, page: &mut Page) -> Result<()> {
    let applied = [(model.end_effector()?, Wrench::from_array(F_TIP))];
    let environment = Environment { applied: &applied, ..model.environment() };
    let terms = Terms::at(model, [THETA.to_vec(), DTHETA.to_vec(), DDTHETA.to_vec()], &environment)?;
    page.title("2  every term of its dynamics, at one state").lines(&state(&terms));
    page.lines(&blocks(&terms, &[("M(θ), mass matrix [kg m²]", MassMatrix.into(), 0)]));
    page.line("  τ = M θ̈ + c + g + JᵀF_tip + f, term by term:").lines(&sum(&terms));
    let tau = model.closed_form(&THETA, &DTHETA, &environment)?.inverse_dynamics(&DVector::from_column_slice(&DDTHETA));
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
    page.lines(&[
        format!(
            "The book's closed form, by stacked matrices, gives the same τ to {:.0e} N m,",
            apart(tau.as_slice(), terms.vector(InverseDynamics))
        ),
        format!(
            "and forward dynamics, in O(n), takes τ back to θ̈ to {:.0e} rad/s².",
            apart(&DDTHETA, terms.vector(ForwardDynamics))
        ),
    ]);
    Ok(())
}

fn fall(model: &Model, page: &mut Page, file: Option<&str>) -> Result<()> {
    page.title("3  a fall: motors off, from rest at the same θ, 2 s in steps of 1 ms");
    let options = |method| Options { method, ..Options::new(SECONDS, STEPS) };
    let mut motions = Vec::new();
    for method in [Method::SemiImplicitEuler, Method::RungeKutta4] {
        let options = options(method);
        motions.push((method, mozzi_sim::simulate(model, &THETA, &[0.0; 6], Zero, &options)?));
    }
    if let Some((_, motion)) = motions.last() {
        page.lines(&simulate_page::rows(model, motion, 3));
    }
    page.lines(&drifts(&motions));
    if let Some(file) = file {
        save(file, csv(model, &motions))?;
        let rows: usize = motions.iter().map(|(_, motion)| motion.len()).sum();
        page.line(format!("{rows} rows written to {file}"));
    }
    Ok(())
}

/// One row for each method: order, largest drift.
fn drifts(motions: &[(Method, Trajectory)]) -> Vec<String> {
    let mut cells =
        vec![["method", "order", "energy drift", "of largest K", "|θ − θ of rk4|"].map(String::from).to_vec()];
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
    let columns = log::Row::new(model);
    let mut text = format!("method,{}\n", columns.names().join(",")).into_bytes();
    for (method, motion) in motions {
        for row in motion.samples() {
            text.extend(format!("{},", method.name()).into_bytes());
            let _ = log::line(&mut text, &columns, &row); // writing to memory cannot fail
        }
    }
    text
}
