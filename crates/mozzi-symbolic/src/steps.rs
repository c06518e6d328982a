//! The Newton-Euler recursion link by link, in the book's frames at centres of mass (Modern Robotics 8.50 to 8.54), and
//! the blocks of the stacked matrices. The torques are compared with the kernel's, exactly.

use crate::angles;
use crate::derivation::Formula;
use crate::derive::{Collect, Options, described, legend_of, written};
use crate::error::Error;
use crate::expression::Expression;
use crate::kernel::{Kernel, check_fault};
use crate::letters::{below, printable};
use crate::parameters::Meaning;
use crate::symbol::{Symbol, end, with_table};
use crate::table::Table;
use mozzi::model::description::JointKind;
use mozzi::quantities::{InverseDynamics, Query};
use mozzi::{Description, Freedom, Model, SE3, SO3, Scalar, SpatialInertia, Twist, Vec3, Wrench};
use std::collections::HashMap;

/// One line of the recursion: a symbol and its value.
#[derive(Clone, Debug)]
pub struct Step {
    /// A title before it, if a part begins.
    pub title: Option<String>,
    pub(crate) text: String,
    pub(crate) latex: String,
    pub(crate) formula: Formula,
}

/// The recursion of a robot with a fixed base and joints of one axis.
#[derive(Clone, Debug)]
pub struct Steps {
    /// In the order in which they are computed.
    pub steps: Vec<Step>,
    /// The symbols that occur.
    pub legend: Vec<Meaning>,
    /// Whether its numbers are those of formulas, ½, and not the file's.
    pub(crate) has_fractions: bool,
    pub(crate) table: Table,
}

/// A moving link in its frame {i}, at its centre of mass with the axes of the file's link.
struct Link {
    name: String,
    /// Its number's index, and its parent's; 0 is the base.
    parent: usize,
    /// T_{i,p}(θ).
    T: SE3<Symbol>,
    A: Twist<Symbol>,
    G: SpatialInertia<Symbol>,
    joint: usize,
    ratio: Symbol,
}

/// e^{[A]q} for a joint that slides, or turns about one of its link's axes; none for others.
fn exponential(A: Twist<Symbol>, q: Symbol) -> Option<SE3<Symbol>> {
    let zero = Symbol::zero();
    let is_zero = |x: &Symbol| *x == zero;
    if A.w.0.iter().all(is_zero) {
        return Some(SE3 { R: SO3::identity(), p: A.v * q });
    }
    let Vec3([x, y, z]) = A.w.map(|w| w * q);
    let along = A.w.0.iter().filter(|x| !is_zero(x)).count();
    (along == 1 && A.v.0.iter().all(is_zero)).then(|| SE3 { R: SO3::from_rpy(x, y, z), p: Vec3::zero() })
}

/// The moving link that carries each link, from 1, and the link's frame in that link's.
type Carried = HashMap<String, (usize, SE3<Symbol>)>;

fn links(model: &Model, robot: &Description<Symbol>, theta: &[Symbol]) -> Result<Vec<Link>, Error> {
    let joint_of = |name: &str| robot.joints.iter().find(|joint| joint.child == name);
    let moving: Vec<String> = model.moving_joints().map(|joint| joint.child.clone()).collect();
    let mut carried: Carried = HashMap::new();
    for link in &robot.links {
        let (mut at, mut T) = (link.name.as_str(), SE3::identity());
        let slot = loop {
            if let Some(slot) = moving.iter().position(|name| name == at) {
                break slot + 1;
            }
            let Some(joint) = joint_of(at) else { break 0 };
            (at, T) = (joint.parent.as_str(), joint.origin * T);
        };
        carried.insert(link.name.clone(), (slot, T));
    }
    let mut inertias = vec![SpatialInertia::zero(); moving.len() + 1];
    for link in &robot.links {
        let (slot, T) = carried[&link.name];
        inertias[slot] += link.inertia.transformed(T);
    }
    let center = |slot: usize| match slot {
        0 => SE3::identity(),
        _ => SE3 { R: SO3::identity(), p: inertias[slot].center_of_mass() },
    };
    let mut found = Vec::new();
    for (i, (name, source)) in moving.iter().zip(model.sources()).enumerate() {
        let Some(joint) = joint_of(name) else { continue };
        let JointKind::Screw(A) = joint.kind else { continue };
        let mimic = robot.source_of(&joint.name);
        let (ratio, offset) = mimic.map_or((Symbol::one(), Symbol::zero()), |mimic| (mimic.ratio, mimic.offset));
        let q = ratio * theta[model.places()[source.joint].q] + offset;
        let (parent, T) = carried[&joint.parent];
        let Some(moved) = exponential(A.twist(), q) else {
            return Err(Error::NoRecursion(format!("`{}`, whose axis is along none of its link's", joint.name)));
        };
        let in_parent = center(parent).inverse() * T * joint.origin * moved * center(i + 1);
        found.push(Link {
            name: name.clone(),
            parent,
            T: in_parent.inverse(),
            A: center(i + 1).inverse().Ad() * A.twist(),
            G: inertias[i + 1].congruence(center(i + 1).Ad()),
            joint: source.joint,
            ratio,
        });
    }
    Ok(found)
}

/// The title before it, its text and LaTeX, its shape and entries.
type Line = (Option<String>, String, String, Vec<usize>, Vec<Symbol>);

/// Collects the printed lines.
#[derive(Default)]
struct Writer {
    lines: Vec<Line>,
    title: Option<String>,
}

impl Writer {
    fn add(&mut self, text: String, latex: String, shape: Vec<usize>, entries: Vec<Symbol>) {
        self.lines.push((self.title.take(), text, latex, shape, entries));
    }
    fn six(&mut self, text: String, latex: String, entries: [Symbol; 6]) {
        self.add(text, latex, vec![6], entries.to_vec());
    }
}

/// The recursion of a robot, link by link, and the blocks of 𝒜, 𝒢, 𝒲 and ℒ.
///
/// # Errors
/// [`Error::NoRecursion`] for a floating base, balls, free joints, and axes along none of their link's;
/// [`Error::NotProven`] if the torques differ from the kernel's.
pub fn steps(model: &Model, text: Option<&str>, options: &Options) -> Result<Steps, Error> {
    let quantity = "newton_euler";
    if model.is_floating() {
        return Err(Error::NoRecursion("a floating base".into()));
    }
    if let Some((joint, _)) = model.joints().zip(model.places()).find(|(_, place)| place.freedom != Freedom::One) {
        return Err(Error::NoRecursion(format!("`{}`, a {} joint", joint.name, joint.kind.name())));
    }
    let (mut robot, parameters) = described(model, text, options)?;
    // friction, springs and rotors are no part of the recursion
    for joint in &mut robot.joints {
        let zero = Symbol::zero();
        (joint.damping, joint.friction, joint.stiffness, joint.armature) = (zero, zero, zero, zero);
    }
    robot.rotors.clear();
    let query = Query::from(InverseDynamics);
    let inputs: Vec<Vec<Symbol>> =
        query.declaration().inputs.iter().map(|input| angles::input(model, input, model.n())).collect();
    let (theta, dtheta, ddtheta) = (&inputs[0], &inputs[1], &inputs[2]);
    let links = links(model, &robot, theta)?;
    let mut writer = Writer::default();
    let mut V = vec![Twist::zero()];
    let mut dV = vec![Twist::linear(-Vec3(robot.gravity))];
    writer.title = Some("base".into());
    writer.six("𝒱₀".into(), r"\mathcal V_0".into(), V[0].to_array());
    writer.six("𝒱̇₀".into(), r"\dot{\mathcal V}_0".into(), dV[0].to_array());
    for (i, link) in (1..).zip(&links) {
        let (p, at) = (link.parent, below(i));
        let of_parent = format!("{at},{}", below(p));
        writer.title = Some(format!("outward, link {i}: {}", printable(&link.name)));
        let matrix = link.T.to_matrix().concat();
        writer.add(format!("T{of_parent}"), format!("T_{{{i},{p}}}"), vec![4, 4], matrix);
        writer.six(format!("𝒜{at}"), format!(r"\mathcal A_{{{i}}}"), link.A.to_array());
        let Ad = link.T.Ad();
        let A = link.A * link.ratio;
        let next = Ad * V[p] + A * dtheta[link.joint];
        V.push(next);
        writer.six(format!("𝒱{at}"), format!(r"\mathcal V_{{{i}}}"), next.to_array());
        let next = Ad * dV[p] + next.ad() * A * dtheta[link.joint] + A * ddtheta[link.joint];
        dV.push(next);
        writer.six(format!("𝒱̇{at}"), format!(r"\dot{{\mathcal V}}_{{{i}}}"), next.to_array());
    }
    let mut F = vec![Wrench::zero(); links.len() + 1];
    let mut tau = vec![Symbol::zero(); model.n()];
    for (k, link) in links.iter().enumerate().rev() {
        let i = k + 1;
        let at = below(i);
        writer.title = Some(format!("inward, link {i}: {}", printable(&link.name)));
        let G = link.G.to_matrix().concat();
        writer.add(format!("𝒢{at}"), format!(r"\mathcal G_{{{i}}}"), vec![6, 6], G);
        F[i] = F[i] + link.G * dV[i] - V[i].ad().transpose() * (link.G * V[i]);
        writer.six(format!("𝓕{at}"), format!(r"\mathcal F_{{{i}}}"), F[i].to_array());
        tau[link.joint] += (link.A * link.ratio).dot(F[i]);
        F[link.parent] = F[link.parent] + link.T.Ad().transpose() * F[i];
    }
    writer.title = Some("torques, 𝒜ᵀ𝓕".into());
    for (j, tau) in tau.iter().enumerate() {
        writer.add(format!("τ{}", below(j + 1)), format!(r"\tau_{{{}}}", j + 1), Vec::new(), vec![*tau]);
    }
    stacked(&mut writer, &links);
    let found = Kernel::new(&query, &robot.build()?, None)?.outputs(&inputs).swap_remove(0);
    check_fault(quantity)?;
    if let Some(entry) = (0..tau.len()).find(|&j| tau[j] != found[j]) {
        return Err(Error::NotProven { quantity, entry, what: "the recursion's torque differs".into() });
    }
    Ok(Steps { has_fractions: options.symbols.are_all(), ..finish(writer, parameters.legend) })
}

/// The blocks of 𝒲 and ℒ; those of 𝒜 and 𝒢 are in the recursion.
fn stacked(writer: &mut Writer, links: &[Link]) {
    let block = |T: SE3<Symbol>| T.Ad().to_matrix().concat();
    writer.title = Some("𝒲(θ): the blocks that are not 0; 𝒜 and 𝒢 have 𝒜_i and 𝒢_i on their diagonals".into());
    for (i, link) in (1..).zip(links).filter(|(_, link)| link.parent > 0) {
        let (a, b) = (below(i), below(link.parent));
        writer.add(format!("𝒲{a},{b}"), format!(r"\mathcal W_{{{i},{}}}", link.parent), vec![6, 6], block(link.T));
    }
    writer.title =
        Some("ℒ(θ) = (I − 𝒲)⁻¹: the further blocks; its diagonal is I, and ℒ = 𝒲 from parent to link".into());
    for (i, link) in (1..).zip(links) {
        let (mut T, mut at) = (link.T, link.parent);
        while at > 0 && links[at - 1].parent > 0 {
            let other = links[at - 1].parent;
            T = T * links[at - 1].T;
            let (a, b) = (below(i), below(other));
            writer.add(format!("ℒ{a},{b}"), format!(r"\mathcal L_{{{i},{other}}}"), vec![6, 6], block(T));
            at = other;
        }
    }
}

fn finish(writer: Writer, all: Vec<Meaning>) -> Steps {
    let lines = writer.lines.into_iter();
    let steps: Vec<Step> = lines
        .map(|(title, text, latex, shape, entries)| {
            let polynomials: Vec<_> = entries.iter().map(|x| x.polynomial()).collect();
            let entries = with_table(|table| written(table, &polynomials, Collect::Shortest));
            Step {
                title,
                text,
                latex,
                formula: Formula { name: "", shape, is_symmetric: false, entries, denominator: None },
            }
        })
        .collect();
    let table = end();
    let entries: Vec<&Expression> = steps.iter().flat_map(|step| &step.formula.entries).collect();
    Steps { legend: legend_of(&table, &entries, all), steps, has_fractions: false, table }
}
