//! Bodies whose inertial parameters differ between the two sides, and why.

use crate::compare::Result;
use crate::compare::answer::{Answer, Robot, Workaround};
use crate::compare::cause::Cause;
use crate::compare::constants::{Constants, freed, home, same_body};
use mozzi::{Description, SE3, SpatialInertia, Sym3};

/// The reason why a body differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// MuJoCo made its moments those of a sphere (balanceinertia).
    Balanced,
    /// MuJoCo dropped the moments of links without mass, fixed to others.
    Dropped,
    /// MuJoCo raised its mass or its moments (boundmass, boundinertia).
    Bounded,
    /// MuJoCo computed its inertia from its shapes.
    Shapes,
    /// Both computed it from its shapes.
    BothShapes,
    /// MuJoCo scaled all masses (settotalmass).
    Scaled,
    Unknown,
}

/// A body on both sides, at home in the base frame.
#[derive(Clone, Debug)]
pub struct BodyChange {
    /// The joint that moves it.
    pub joint: String,
    /// The moving link, then the links fixed to it.
    pub links: Vec<String>,
    pub mozzi: SpatialInertia,
    pub theirs: SpatialInertia,
}

impl BodyChange {
    /// The largest difference of the moments about the centre of mass, relative to the largest moment.
    pub fn moments_apart(&self) -> f64 {
        let moments = |inertia: &SpatialInertia| {
            let center = SE3 { p: -inertia.center_of_mass(), ..SE3::identity() };
            let rows = inertia.transformed(center).to_matrix();
            [0, 1, 2].map(|i| [rows[i][0], rows[i][1], rows[i][2]])
        };
        let (a, b) = (moments(&self.mozzi), moments(&self.theirs));
        let most = |all: &mut dyn Iterator<Item = f64>| all.fold(0.0_f64, |most, x| most.max(x.abs()));
        let far = most(&mut a.as_flattened().iter().zip(b.as_flattened()).map(|(x, y)| x - y));
        far / most(&mut b.as_flattened().iter().copied())
    }
}

/// One cause for each reason.
pub fn suspects(robot: &Description, answer: &Answer, from: &Robot) -> Result<Vec<Cause>> {
    let (mine, model) = (Constants::of(robot)?, freed(robot).build()?);
    let mut groups: Vec<(Reason, Vec<BodyChange>)> = Vec::new();
    for (joint, folded) in mine.joints.iter().zip(&model.folded_links()[1..]) {
        let Some(there) = from.constants.joint(&joint.name) else { continue };
        if same_body(&joint.body, &there.body) {
            continue;
        }
        let links: Vec<String> = folded.links.iter().map(|(name, _)| name.to_string()).collect();
        let change = BodyChange { joint: joint.name.clone(), links, mozzi: joint.body, theirs: there.body };
        let reason = reason(robot, &change, answer, from)?;
        match groups.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, list)) => list.push(change),
            None => groups.push((reason, vec![change])),
        }
    }
    Ok(groups.into_iter().map(|(reason, list)| Cause::Bodies(reason, list)).collect())
}

/// The reason that yields the body's numbers.
fn reason(robot: &Description, change: &BodyChange, answer: &Answer, from: &Robot) -> Result<Reason> {
    if answer.library != "MuJoCo" {
        return Ok(Reason::Unknown);
    }
    let home = home(robot)?;
    let links = || robot.links.iter().filter(|link| change.links.contains(&link.name));
    let whole = |edit: &dyn Fn(SpatialInertia) -> SpatialInertia| {
        links().fold(SpatialInertia::zero(), |sum, link| sum + edit(link.inertia).transformed(home[&link.name]))
    };
    let setting = |name: &str| from.settings[name].as_f64().unwrap_or(0.0);
    let (mass, moment) = (setting("boundmass"), setting("boundinertia"));
    let is_bounded = mass > 0.0 || moment > 0.0;
    let balances = from.settings["balanceinertia"] == true;
    let dropped = |inertia: SpatialInertia| if inertia.mass == 0.0 { SpatialInertia::zero() } else { inertia };
    if same_body(&whole(&dropped), &change.theirs) {
        return Ok(Reason::Dropped);
    }
    if balances && same_body(&whole(&balanced), &change.theirs) {
        return Ok(Reason::Balanced);
    }
    let tried_bound = answer.attempts.iter().any(|(_, workaround)| *workaround == Workaround::Bound);
    let is_light = |link: &mozzi::model::description::Link| {
        let [least, ..] = link.inertia.verdict().principal_moments;
        link.inertia.mass < mass || least < moment
    };
    // MuJoCo may raise each of the bodies fixed to each other, or their sum: both are less than this
    let most = links().count() as f64;
    let raised = change.theirs.mass - change.mozzi.mass;
    if is_bounded && (tried_bound || links().any(is_light)) && raised >= 0.0 && raised <= most * mass * 1.001 {
        return Ok(Reason::Bounded);
    }
    let has_shapes = change.links.iter().any(|link| from.from_geometry.contains(link));
    if has_shapes || from.settings["inertiafromgeom"] == "true" {
        // a link without <inertial> has no mass here, unless its shapes give it
        let same_mass = change.mozzi.mass > 0.0 && raised.abs() <= 1e-6 * change.mozzi.mass;
        return Ok(if same_mass { Reason::BothShapes } else { Reason::Shapes });
    }
    Ok(if setting("settotalmass") > 0.0 { Reason::Scaled } else { Reason::Unknown })
}

/// Balances an inertia as MuJoCo does: one that violates the triangle inequality becomes that of a sphere with the same
/// trace.
fn balanced(inertia: SpatialInertia) -> SpatialInertia {
    let [a, b, c] = inertia.verdict().principal_moments;
    if a + b >= c {
        return inertia;
    }
    let mean = (a + b + c) / 3.0;
    SpatialInertia::new(inertia.mass, inertia.center_of_mass(), Sym3::diagonal(mean, mean, mean))
}
