//! The quantities of one state as text.

use super::stacked;
use super::values::Terms;
use crate::numbers::{TWIST, WRENCH};
use crate::quantity::is_of_a_frame;
use crate::robot::{Units, space_frame};
use crate::table::{Quantity, quantities, short};
use crate::text::{Page, beside, flow, matrix, scalar, sixes, table, tuple};
use mozzi::quantities::{
    BiasForces, BodyJacobian, BodyJacobianRate, CoriolisMatrix, ForwardDynamics, ForwardDynamicsDerivatives,
    ForwardKinematics, GravityForces, GravityForcesDerivative, INPUTS, InverseDynamics, InverseDynamicsDerivatives,
    JointFriction, KineticEnergy, MassMatrix, MassMatrixRate, PotentialEnergy, Query, SpaceJacobian, SpaceJacobianRate,
    SpringForces, TipForces, VelocityProduct,
};
use mozzi::{Base, TaskFrame, Twist};
use nalgebra::{DMatrix, DVector};

pub fn page(terms: &Terms) -> String {
    let mut page = Page::default();
    let model = terms.model;
    let numbered =
        |names: Vec<&str>| flow(&names.iter().zip(1..).map(|(name, j)| format!("{j} {name}")).collect::<Vec<_>>());
    if model.is_floating() {
        let (name, nq, n) = (&model.description().name, model.nq(), model.n());
        page.line(format!(
            "{name} with a floating base, {} joints: {nq} positions θ and {n} velocities θ̇,",
            model.joint_names().len()
        ));
        page.lines(&numbered(model.velocity_names().collect()));
        page.line("in this order in the rows and columns of all matrices; the base's are in its own coordinates");
    } else {
        page.line(format!("{}, {} joints:", model.description().name, model.joint_names().len()));
        page.lines(&numbered(model.velocity_names().collect()));
    }
    page.title("the state").lines(&state(terms)).lines(&wrench(terms));
    if let Some(tip) = terms.tip {
        page.title(&format!("where {} is and how it moves", model.frame_name(tip))).lines(&kinematics(terms));
    }
    page.title("the dynamics, τ = M(θ) θ̈ + c(θ, θ̇) + g(θ) + JᵀF_tip + f(θ, θ̇)").lines(&matrices(terms));
    page.blank().lines(&sum(terms)).blank().lines(&further(terms));
    page.title("derivatives of inverse and forward dynamics").lines(&derivatives(terms));
    page.title("the Newton-Euler recursion, in frames {i} at the links' centres of mass, angular first");
    page.lines(&recursion(terms));
    page.title("the dynamics in the task space, F = Λ V̇ + η").lines(&task(terms));
    if let Some(form) = &terms.closed_form {
        page.title("the closed form, all links stacked").lines(&stacked::lines(terms.model, form, &terms.ddtheta));
    }
    page.end()
}

pub fn state(terms: &Terms) -> Vec<String> {
    let inputs = INPUTS.iter().zip([&terms.theta, &terms.dtheta, &terms.ddtheta]);
    let units = Units::of(terms.model);
    let rows: Vec<Quantity> = inputs.map(|(input, values)| Quantity::of(input, &units, values)).collect();
    quantities(terms.model, &rows, false)
}

/// Gravity and the tip's wrench.
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

/// Matrices side by side, each an output of a quantity below a title; missing ones are left out.
pub fn blocks(terms: &Terms, list: &[(&str, Query, usize)]) -> Vec<String> {
    let block = |&(title, query, output): &(&str, Query, usize)| {
        let lines = matrix(&terms.matrix(query, output)?);
        let is_of_twists = is_of_a_frame(query) && query != ForwardKinematics.into();
        Some((title.to_string(), if is_of_twists { with_rows_named(lines) } else { lines }))
    };
    beside(&list.iter().filter_map(block).collect::<Vec<_>>())
}

/// A Jacobian's lines.
fn with_rows_named(lines: Vec<String>) -> Vec<String> {
    let mut names = TWIST.iter().cycle();
    let named = |line: String| match line.starts_with("columns") {
        true => line,
        false => format!("{} {line}", names.next().unwrap_or(&"")),
    };
    lines.into_iter().map(named).collect()
}

fn velocity(V: Option<DVector<f64>>) -> String {
    let V = V.unwrap_or_default();
    let (w, v) = V.as_slice().split_at(V.len() / 2);
    format!("(ω, v), ω = {} rad/s, v = {} m/s", short(w), short(v))
}

fn kinematics(terms: &Terms) -> Vec<String> {
    let space = space_frame(terms.model);
    let title = format!("T_sb(θ), its pose in {space} [R p], m");
    let mut lines = blocks(terms, &[(&title, ForwardKinematics.into(), 0)]);
    lines.push(format!("V_b = J_b θ̇ = {}   in its own frame", velocity(terms.twist(BodyJacobian))));
    lines.push(format!("V_s = J_s θ̇ = {}   in {space}", velocity(terms.twist(SpaceJacobian))));
    lines.extend(blocks(
        terms,
        &[
            ("J_b(θ), body Jacobian", BodyJacobian.into(), 0),
            ("J_s(θ), space Jacobian", SpaceJacobian.into(), 0),
            ("J̇_b(θ, θ̇), its rate", BodyJacobianRate.into(), 0),
            ("J̇_s(θ, θ̇), its rate", SpaceJacobianRate.into(), 0),
        ],
    ));
    lines
}

fn matrices(terms: &Terms) -> Vec<String> {
    let M = format!(
        "M(θ), mass matrix [{}]",
        Units::of(terms.model).own(Query::from(MassMatrix).declaration().outputs[0].unit)
    );
    let dM = ("Ṁ(θ, θ̇) = C + Cᵀ, its rate", MassMatrixRate.into(), 0);
    let C = ("C(θ, θ̇), Coriolis matrix: C θ̇ = c", CoriolisMatrix.into(), 0);
    blocks(terms, &[(&M, MassMatrix.into(), 0), dM, C])
}

/// τ as the sum of its terms.
pub fn sum(terms: &Terms) -> Vec<String> {
    let force = &Units::of(terms.model).input(3);
    let M = terms.matrix(MassMatrix, 0).unwrap_or_default();
    let inertial = M * DVector::from_column_slice(&terms.ddtheta);
    quantities(
        terms.model,
        &[
            Quantity::new("  M θ̈", "mass_matrix θ̈", force, inertial.as_slice()),
            Quantity::new("+ c", "velocity_product", force, terms.vector(VelocityProduct)),
            Quantity::new("+ g", "gravity_forces", force, terms.vector(GravityForces)),
            Quantity::new("+ JᵀF_tip", "tip_forces", force, terms.vector(TipForces)),
            Quantity::new("+ dθ̇ + μ sgn θ̇", "joint_friction", force, terms.vector(JointFriction)),
            Quantity::new("+ k(θ − θ₀)", "spring_forces", force, terms.vector(SpringForces)),
            Quantity::new("= τ", "inverse_dynamics", force, terms.vector(InverseDynamics)),
            Quantity::new("  h = c + g", "bias_forces", force, terms.vector(BiasForces)),
        ],
        true,
    )
}

fn further(terms: &Terms) -> Vec<String> {
    let (unit, ddtheta) = (Units::of(terms.model).input(2), terms.vector(ForwardDynamics));
    let mut lines = match ddtheta.is_empty() {
        true => Vec::new(),
        false => quantities(terms.model, &[Quantity::new("θ̈ of this τ", "forward_dynamics", unit, ddtheta)], false),
    };
    let energy = |query: Query| terms.vector(query).first().map_or(String::new(), |&x| scalar(x));
    lines.push(format!("kinetic_energy   ½ θ̇ᵀMθ̇   = {} J", energy(KineticEnergy.into())));
    lines.push(format!(
        "potential_energy −Σ m gᵀp + Σ ½k(θ − θ₀)² = {} J (0 for a mass at the origin of {}, a spring at rest)",
        energy(PotentialEnergy.into()),
        space_frame(terms.model)
    ));
    lines
}

fn derivatives(terms: &Terms) -> Vec<String> {
    let (inverse, forward) = (InverseDynamicsDerivatives.into(), ForwardDynamicsDerivatives.into());
    let gravity = ("∂g/∂θ", GravityForcesDerivative.into(), 0);
    let of_tau = [("∂τ/∂θ", inverse, 0), ("∂τ/∂θ̇", inverse, 1), ("∂τ/∂θ̈ = M", inverse, 2), gravity];
    let of_ddtheta = [("∂θ̈/∂θ", forward, 1), ("∂θ̈/∂θ̇", forward, 2), ("∂θ̈/∂τ = M⁻¹", forward, 3)];
    [blocks(terms, &of_tau), blocks(terms, &of_ddtheta)].concat()
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
