//! `<limit>`: bounds on position, velocity and effort.
//!
//! URDF requires a limit for revolute and prismatic joints, and a missing bound is 0. Published robots (eight joints in
//! two of the robots of `example-robot-data`: wheels and knees) give effort and velocity but no bounds, and mean a
//! joint that turns freely, not one that cannot move. Therefore a joint without any bound is unlimited, and if one
//! bound is given, the other is URDF's 0; both cases are reported. From version 1.2 on URDF has no such default: a
//! joint with one bound is unlimited, with a warning, and effort and velocity may be missing; limits of acceleration
//! are read.
//!
//! Limits do not enter the dynamics. Reversed limits, which other readers accept, are dropped with a warning: code that
//! uses limits expects the lower one first.

use crate::report::finding::Finding;
use crate::report::places::Place;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::text::version::Version;
use crate::urdf::vocabulary::LIMIT;
use mozzi::model::description::Limits;

/// How an infinite limit is written: urdfdom refuses a moving joint's <limit> without `effort` and `velocity`, reads a
/// missing bound as 0, and does not read infinity.
pub(crate) const UNLIMITED: f64 = f64::MAX;

const DECLARE: &str = "declare the version: <robot version=\"1.2\">";

/// The limits of a joint that moves.
pub(crate) fn read(
    kind: &str,
    limit: Option<&Element>,
    joint: &Element,
    place: &mut Place,
    cx: &mut Context,
) -> Limits {
    let Some(limit) = limit else {
        if kind != "continuous" && !place.has_reported("limits") {
            let message = format!("{}: has no <limit>, expected one on a {kind} joint", joint.subject);
            let help = match kind {
                "revolute" => "the joint is treated as unlimited; a joint that turns freely is of type `continuous`",
                _ => "it is treated as unlimited",
            };
            cx.findings.add(Finding::warning("missing_limit", joint.span(), message).help(help));
        }
        return Limits::default();
    };
    let before = cx.findings.errors();
    limit.check_attributes(&LIMIT, cx);
    let is_misspelled = cx.findings.errors() > before;
    limit.check_children(&LIMIT, cx);
    let acceleration = acceleration(limit, place, cx);
    for (name, attribute) in [("lower", "limits"), ("velocity", "velocity limit"), ("effort", "effort limit")] {
        if let Some(value) = limit.attribute(name) {
            place.set(attribute, value.span);
        }
    }
    let mut number = |name| match limit.attribute(name) {
        Some(value) => (true, limit.vector::<1>(name, &value, cx).map(|[x]| x)),
        None => (false, None),
    };
    let [lower, upper, velocity, effort] = ["lower", "upper", "velocity", "effort"].map(&mut number);
    let rates = [velocity.1, effort.1, acceleration];
    if kind == "continuous" {
        continuous(limit, joint, [lower.1, upper.1], cx);
        return bounded(None, rates);
    }
    all_zero(limit, [lower, upper, velocity, effort], cx);
    let mut missing = |name: &str, help: &str| {
        if is_misspelled {
            return;
        }
        let message = format!("{}: has no attribute `{name}`, expected one on a {kind} joint", limit.subject);
        cx.findings.add(Finding::warning("missing_limit", limit.span(), message).help(help));
    };
    let has_default = cx.version < Version::WITH_ACCELERATION;
    let position = match (lower, upper) {
        ((false, _), (false, _)) => {
            missing("lower", "without `lower` and `upper` the joint is treated as unlimited");
            None
        }
        ((true, _), (false, _)) if !has_default => {
            missing("upper", "with one bound alone the joint is treated as unlimited");
            None
        }
        ((false, _), (true, _)) if !has_default => {
            missing("lower", "with one bound alone the joint is treated as unlimited");
            None
        }
        ((true, low), (false, _)) => {
            missing("upper", "it is treated as 0, URDF's default");
            low.map(|low| [low, 0.0])
        }
        ((false, _), (true, high)) => {
            missing("lower", "it is treated as 0, URDF's default");
            high.map(|high| [0.0, high])
        }
        ((true, low), (true, high)) => low.zip(high).map(|(low, high)| [low, high]),
    };
    for (name, (is_there, _)) in [("velocity", velocity), ("effort", effort)] {
        if !is_there && has_default {
            missing(name, "it is treated as unlimited");
        }
    }
    let position = position.filter(|bounds| in_order(*bounds, limit, cx));
    bounded(position, rates)
}

/// Without the limits that are [`UNLIMITED`].
fn bounded(position: Option<[f64; 2]>, rates: [Option<f64>; 3]) -> Limits {
    let [velocity, effort, acceleration] = rates.map(|limit| limit.filter(|limit| *limit != UNLIMITED));
    Limits { position: position.filter(|bounds| *bounds != [-UNLIMITED, UNLIMITED]), velocity, effort, acceleration }
}

/// Whether the lower bound is not above the upper one; the reverse is reported.
fn in_order([low, high]: [f64; 2], limit: &Element, cx: &mut Context) -> bool {
    if low > high {
        let message = format!("{}: goes from {low} to {high}, expected the lower bound first", limit.subject);
        let help = "the joint is treated as unlimited; exchange `lower` and `upper`";
        let span = limit.attribute("lower").map_or_else(|| limit.span(), |value| value.span);
        cx.findings.add(Finding::warning("reversed_limits", span, message).help(help));
    }
    low <= high
}

/// The limits of URDF 1.2: the smaller of `acceleration` and `deceleration`. A limit of jerk is named, and so are these
/// limits in a file of an earlier version.
fn acceleration(limit: &Element, place: &mut Place, cx: &mut Context) -> Option<f64> {
    let is_earlier = cx.version < Version::WITH_ACCELERATION;
    let mut least = None;
    for name in LIMIT.silent {
        let Some(value) = limit.attribute(name) else { continue };
        let why = match *name {
            _ if is_earlier => "URDF has it from version 1.2 on",
            "jerk" => "no motion here is planned within a limit of jerk",
            _ => {
                let Some([x]) = limit.vector::<1>(name, &value, cx) else { continue };
                place.set("acceleration limit", value.span);
                least = Some(least.map_or(x, |least: f64| least.min(x)));
                continue;
            }
        };
        let message = format!("{}: {name}: is ignored: {why}", limit.subject);
        let finding = Finding::warning("ignored_limit", value.span.clone(), message);
        cx.repeat(&format!("limit {name}"), if is_earlier { finding.help(DECLARE) } else { finding });
        if !is_earlier {
            limit.vector::<1>(name, &value, cx);
        }
    }
    least
}

/// Limits that a CAD program writes for a joint whose limits nobody entered. They do not enter the dynamics; planners
/// and motors with limits cannot move such a joint.
fn all_zero(limit: &Element, numbers: [(bool, Option<f64>); 4], cx: &mut Context) {
    if numbers.iter().all(|number| *number == (true, Some(0.0))) {
        let message = format!("{}: all its numbers are 0: the joint may not move", limit.subject);
        cx.repeat("zero limits", Finding::warning("zero_limits", limit.span(), message));
    }
}

/// A continuous joint has no bounds. Bounds without effect, a full turn or more apart or both 0, are accepted silently.
fn continuous(limit: &Element, joint: &Element, bounds: [Option<f64>; 2], cx: &mut Context) {
    let [low, high] = bounds.map(|bound| bound.unwrap_or(0.0));
    let says_nothing = low == 0.0 && high == 0.0 || high - low >= core::f64::consts::TAU;
    let Some(value) = limit.attribute("lower").or_else(|| limit.attribute("upper")) else { return };
    if !says_nothing {
        let message =
            format!("{}: limit: goes from {low} to {high}, but a continuous joint has no bounds", joint.subject);
        let help = "they are ignored; a joint with bounds is of type `revolute`";
        cx.findings.add(Finding::warning("continuous_limits", value.span, message).help(help));
    }
}
