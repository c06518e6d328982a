//! The quantities of one state as text.

use super::stacked;
use super::terms::{Terms, Tip};
use crate::numbers::{TWIST, WRENCH};
use crate::robot::{Units, space_frame};
use crate::table::{Quantity, quantities};
use crate::text::{Page, beside, flow, matrix, scalar, sixes, table, tuple};
use mozzi::{Base, Jacobian, SE3, TaskFrame, Twist};
use nalgebra::DMatrix;

pub fn page(terms: &Terms) -> String {
    let mut page = Page::default();
    let model = terms.model;
    let numbered =
        |names: Vec<&str>| flow(&names.iter().zip(1..).map(|(name, j)| format!("{j} {name}")).collect::<Vec<_>>());
    if model.is_floating() {
        let (name, nq, n) = (&model.description().name, model.nq(), model.n());
        page.line(format!(
            "{name}, its base floating, {} joints: {nq} positions θ and {n} velocities θ̇,",
            model.joint_names().len()
        ));
        page.lines(&numbered(model.velocity_names().collect()));
        page.line("in this order in the rows and columns of all matrices; the base's are in its own coordinates");
    } else {
        page.line(format!("{}, {} joints:", model.description().name, model.n()));
        page.lines(&numbered(model.joint_names().collect()));
    }
    page.title("the state").lines(&state(terms)).lines(&wrench(terms));
    if let Some(tip) = &terms.tip {
        page.title(&format!("where {} is and how it moves", terms.model.frame_name(tip.frame)))
            .lines(&kinematics(tip, space_frame(terms.model)));
    }
    page.title("the dynamics, τ = M(θ) θ̈ + c(θ, θ̇) + g(θ) + JᵀF_tip + f(θ̇)").lines(&matrices(terms));
    page.blank().lines(&sum(terms)).blank().lines(&further(terms));
    page.title("derivatives of inverse and forward dynamics").lines(&terms.derivatives.lines());
    page.title("the Newton-Euler recursion, in frames {i} at the links' centres of mass, angular first");
    page.lines(&recursion(terms));
    page.title("the dynamics in the task space, F = Λ V̇ + η").lines(&task(terms));
    if let Some(form) = &terms.closed_form {
        page.title("the closed form, all links stacked").lines(&stacked::lines(terms.model, form, &terms.ddtheta));
    }
    page.end()
}

pub fn state(terms: &Terms) -> Vec<String> {
    let units = Units::of(terms.model);
    quantities(
        terms.model,
        &[
            Quantity::new("θ", "positions", units.rate(0), &terms.theta),
            Quantity::new("θ̇", "velocities", units.rate(1), &terms.dtheta),
            Quantity::new("θ̈", "accelerations", units.rate(2), &terms.ddtheta),
        ],
        false,
    )
}

/// What surrounds the robot.
pub fn wrench(terms: &Terms) -> Vec<String> {
    let F = terms.F_tip;
    let mut lines = vec![format!("gravity = {} m/s²", tuple(&terms.model.gravity().0))];
    if terms.tip.is_some() {
        lines.push(format!(
            "F_tip = (m, f), m = {} N m, f = {} N: what the tip applies to the environment, in its frame",
            tuple(&F.m.0),
            tuple(&F.f.0)
        ));
    }
    lines
}

pub fn dense<const R: usize, const C: usize>(rows: [[f64; C]; R]) -> DMatrix<f64> {
    DMatrix::from_fn(R, C, |r, c| rows[r][c])
}

pub fn pose(T: SE3) -> Vec<String> {
    matrix(&dense(T.to_matrix()))
}

/// A Jacobian with its rows named.
pub fn jacobian(J: &Jacobian) -> Vec<String> {
    let lines = matrix(&J.matrix());
    let mut names = TWIST.iter().cycle();
    lines
        .into_iter()
        .map(|line| match line.starts_with("columns") {
            true => line,
            false => format!("{} {line}", names.next().unwrap_or(&"")),
        })
        .collect()
}

fn velocity(V: Twist) -> String {
    format!("(ω, v), ω = {} rad/s, v = {} m/s", short(&V.w.0), short(&V.v.0))
}

/// A tuple with few digits, for what was computed.
pub fn short(values: &[f64]) -> String {
    let decimals = crate::text::Decimals::of(values);
    let entries: Vec<String> = values.iter().map(|&x| decimals.show(x).trim().to_string()).collect();
    format!("({})", entries.join(", "))
}

fn kinematics(tip: &Tip, space: &str) -> Vec<String> {
    let mut lines = beside(&[(format!("T_sb(θ), its pose in {space} [R p], m"), pose(tip.T_sb))]);
    lines.push(format!("V_b = J_b θ̇ = {}   in its own frame", velocity(tip.V_b)));
    lines.push(format!("V_s = J_s θ̇ = {}   in {space}", velocity(tip.V_s)));
    lines.extend(beside(&[
        ("J_b(θ), body Jacobian".into(), jacobian(&tip.J_b)),
        ("J_s(θ), space Jacobian".into(), jacobian(&tip.J_s)),
        ("J̇_b(θ, θ̇), its rate".into(), jacobian(&tip.dJ_b)),
        ("J̇_s(θ, θ̇), its rate".into(), jacobian(&tip.dJ_s)),
    ]));
    lines
}

fn matrices(terms: &Terms) -> Vec<String> {
    let unit = Units::of(terms.model).inertia;
    beside(&[
        (format!("M(θ), mass matrix [{unit}]"), matrix(&terms.M)),
        ("Ṁ(θ, θ̇) = C + Cᵀ, its rate".into(), matrix(&terms.dM)),
        ("C(θ, θ̇), Coriolis matrix: C θ̇ = c".into(), matrix(&terms.C)),
    ])
}

/// τ as the sum of its terms.
pub fn sum(terms: &Terms) -> Vec<String> {
    let force = Units::of(terms.model).force;
    let inertial = &terms.M * nalgebra::DVector::from_column_slice(&terms.ddtheta);
    quantities(
        terms.model,
        &[
            Quantity::new("  M θ̈", "mass_matrix θ̈", force, inertial.as_slice()),
            Quantity::new("+ c", "velocity_product", force, terms.c.as_slice()),
            Quantity::new("+ g", "gravity_forces", force, terms.g.as_slice()),
            Quantity::new("+ JᵀF_tip", "tip_forces", force, terms.tip_forces.as_slice()),
            Quantity::new("+ f", "joint_friction", force, terms.friction.as_slice()),
            Quantity::new("= τ", "inverse_dynamics", force, terms.tau.as_slice()),
            Quantity::new("  h = c + g", "bias_forces", force, terms.h.as_slice()),
        ],
        true,
    )
}

fn further(terms: &Terms) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(ddtheta) = &terms.forward_dynamics {
        let unit = Units::of(terms.model).rate(2);
        lines = quantities(
            terms.model,
            &[Quantity::new("θ̈ of this τ", "forward_dynamics", unit, ddtheta.as_slice())],
            false,
        );
    }
    lines.push(format!("kinetic_energy   ½ θ̇ᵀMθ̇   = {} J", scalar(terms.kinetic_energy)));
    lines.push(format!(
        "potential_energy −Σ m gᵀp = {} J (0 for a mass at the origin of {})",
        scalar(terms.potential_energy),
        space_frame(terms.model)
    ));
    lines
}

fn recursion(terms: &Terms) -> Vec<String> {
    let found = &terms.newton_euler;
    let links: Vec<String> =
        terms.model.moving_joints().zip(1..).map(|(joint, i)| format!("{i} {}", joint.child)).collect();
    let six = |title: &str, names: [&str; 6], list: &[[f64; 6]]| {
        let mut rows = vec![[vec![title.to_string()], names.map(str::to_string).to_vec()].concat()];
        rows.extend(links.iter().zip(sixes(list)).map(|(link, cells)| [vec![link.clone()], cells].concat()));
        table(&rows, "lr")
    };
    let twists = |list: &[Twist]| list.iter().map(|V| V.to_array()).collect::<Vec<_>>();
    let wrenches: Vec<[f64; 6]> = found.wrenches.iter().map(|F| F.to_array()).collect();
    let accelerations = ["ω̇_x", "ω̇_y", "ω̇_z", "v̇_x", "v̇_y", "v̇_z"];
    let mut lines = six("V_i, twists [rad/s, m/s]", TWIST, &twists(&found.twists));
    lines.extend(six("V̇_i, accelerations, less gravity", accelerations, &twists(&found.accelerations)));
    lines.extend(six("F_i, wrenches through joint i [N m, N]", WRENCH, &wrenches));
    let base = found.base_reaction;
    let what = match terms.model.base() {
        Base::Fixed => "the ground holds the base with",
        Base::Floating => "the base is driven by the first six entries of τ,",
    };
    lines.push(format!("{what} m = {} N m, f = {} N", short(&base.m.0), short(&base.f.0)));
    lines
}

pub fn task(terms: &Terms) -> Vec<String> {
    let Some(task) = &terms.task else {
        let why = if terms.tip.is_none() { "it needs an end effector" } else { "the task is singular in this state" };
        return vec![format!("left out: {why}")];
    };
    let rows: Vec<&str> = terms.task_rows.iter().map(|&row| TWIST[row]).collect();
    let coordinates = match terms.task_frame {
        TaskFrame::Body => "the end effector's own frame",
        TaskFrame::Space => space_frame(terms.model),
    };
    let mut lines = vec![format!("rows {} in {coordinates}", rows.join(" "))];
    let eta = DMatrix::from_column_slice(task.eta.len(), 1, task.eta.as_slice());
    let bias = DMatrix::from_column_slice(task.eta.len(), 1, task.dJ_dtheta.as_slice());
    lines.extend(beside(&[
        ("Λ = (J M⁻¹Jᵀ)⁻¹".into(), matrix(&task.Lambda)),
        ("η".into(), matrix(&eta)),
        ("J̇ θ̇".into(), matrix(&bias)),
    ]));
    lines
}
