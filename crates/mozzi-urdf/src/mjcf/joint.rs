//! `<joint>`: hinges, slides and balls.

use super::Model;
use super::attributes::Item;
use super::contents::Inside;
use super::option::Options;
use super::spring::SpringDamper;
use super::tree::Name;
use super::vocabulary;
use crate::report::finding::Finding;
use crate::report::places::Place;
use crate::text::context::Context;
use crate::urdf::axis;
use mozzi::model::description::{JointKind, Limits};
use mozzi::{SE3, ScrewAxis, Vec3};

impl<'a> Model<'a> {
    /// Adds a joint between two links; returns its name for messages.
    pub fn joint(&mut self, inside: &Inside<'a>, ends: [usize; 2], origin: SE3, cx: &mut Context) -> String {
        let number = self.tree.degrees;
        self.tree.degrees += 1;
        let name = Name::of(&inside.item.element.called("joint"), format!("joint{number}"), cx);
        let name = name.suffixed(&inside.around.suffix);
        let shown = name.shown();
        let element = inside.item.element.called(format!("joint `{shown}`"));
        let item = Item { element, ..inside.item.clone() };
        item.element.check_attributes(&vocabulary::JOINT, cx);
        item.element.check_children(&vocabulary::JOINT, cx);
        let mut place = Place::new(item.element.span());
        for (name, check) in [
            ("name", "name"),
            ("range", "limits"),
            ("actuatorfrcrange", "effort limit"),
            ("damping", "damping"),
            ("frictionloss", "friction"),
            ("armature", "armature"),
            ("stiffness", "stiffness"),
            ("springref", "spring reference"),
            ("springdamper", "springdamper"),
        ] {
            if let Some(value) = item.value(name) {
                place.set(check, value.span);
            }
        }
        let kind = item.word("type", &["hinge", "slide", "ball", "free"], cx).unwrap_or("hinge");
        let (is_slide, is_ball) = (kind == "slide", kind == "ball");
        let screw = if is_ball { None } else { screw(&item, inside.T, is_slide, cx) };
        let compiler = self.compiler.of(&item.element).clone();
        let position = |x: f64| if is_slide { x } else { compiler.angle(x) };
        let reference = if is_ball { 0.0 } else { position(item.number("ref", 0.0, cx)) };
        let rest = if is_ball { 0.0 } else { position(item.number("springref", 0.0, cx)) };
        let limits = self.range(&item, "range", "limited", cx).map(|range| range.map(position));
        let limits = limits.filter(|bounds| is_ball || in_order("range", *bounds, &item, cx));
        let effort = self.effort(&item, cx);
        let [damping, friction] = self.friction(&item, cx);
        let stiffness = self.stiffness(&item, cx);
        if is_ball && self.options.spring && item.has("springdamper") {
            self.ignored.force("springdamper of a ball", &item, "springdamper", "a ball's stiffness chosen by MuJoCo");
        }
        let [time, ratio] = item.vector::<2>("springdamper", cx).unwrap_or([0.0; 2]);
        let Options { spring, damper, .. } = self.options;
        let spring_damper =
            (time > 0.0 && ratio > 0.0 && !is_ball).then_some(SpringDamper { time, ratio, spring, damper });
        let armature = item.number("armature", 0.0, cx);
        let center = item.vector::<3>("pos", cx).unwrap_or([0.0; 3]);
        // the file's own configuration is at `ref`
        let back = screw.map_or(SE3::identity(), |screw| SE3::exp(screw.twist() * -reference));
        let added = self.tree.joint(name, ends, origin * back, place);
        added.joint.kind = match is_ball {
            true => JointKind::Ball(inside.T * Vec3(center)),
            false => screw.map_or(JointKind::Fixed, JointKind::Screw),
        };
        added.joint.limits = Limits { position: limits, effort, ..Limits::default() };
        (added.joint.damping, added.joint.friction, added.joint.armature) = (damping, friction, armature);
        (added.joint.stiffness, added.joint.spring_reference) = (stiffness, rest);
        (added.reference, added.spring_damper) = (reference, spring_damper);
        shown
    }

    /// A range of the file, if another attribute or the compiler enables it.
    fn range(&self, item: &Item, range: &str, limited: &str, cx: &mut Context) -> Option<[f64; 2]> {
        let numbers = item.vector::<2>(range, cx);
        match item.word(limited, &["auto", "true", "false"], cx).unwrap_or("auto") {
            "false" => None,
            "true" if !item.has(range) => {
                let message = format!("is limited, but has no attribute `{range}`");
                cx.findings.add(item.error("missing_attribute", limited, &message));
                None
            }
            "auto" if item.has(range) && !self.compiler.of(&item.element).autolimits => {
                let message = format!(
                    "{range}: is used only with {limited}=\"true\", since the compiler's autolimits is `false`"
                );
                let help = format!("write `{limited}`, true or false");
                cx.findings.add(item.error("unclear_limit", range, &message).help(help));
                None
            }
            "true" if numbers.is_some_and(|[low, high]| low >= high) => {
                let message = format!("is limited, but its `{range}` is empty, which MuJoCo refuses");
                cx.findings.add(item.error("reversed_limits", range, &message));
                None
            }
            // as in MuJoCo: an empty range of its own accord is no limit
            "auto" => numbers.filter(|[low, high]| low != high),
            _ => numbers,
        }
    }

    /// The largest force of the joint's actuators, if their ranges are symmetric.
    fn effort(&mut self, item: &Item, cx: &mut Context) -> Option<f64> {
        const NAME: &str = "actuatorfrcrange";
        let [low, high] = self.range(item, NAME, "actuatorfrclimited", cx)?;
        if !in_order(NAME, [low, high], item, cx) {
            return None;
        }
        if low != -high {
            self.ignored.force(NAME, item, NAME, "an uneven bound of the actuators' force");
        }
        (low == -high && high > 0.0).then_some(high)
    }

    /// Damping and Coulomb friction.
    fn friction(&mut self, item: &Item, cx: &mut Context) -> [f64; 2] {
        let [linear, quadratic, cubic] = item.overlaid::<3>("damping", cx);
        if self.options.damper && (quadratic != 0.0 || cubic != 0.0) {
            self.ignored.force("damping", item, "damping", "nonlinear damping");
        }
        let loss = item.number("frictionloss", 0.0, cx);
        [if self.options.damper { linear } else { 0.0 }, if self.options.friction { loss } else { 0.0 }]
    }

    /// The linear stiffness of a spring, with a warning about nonlinear terms.
    fn stiffness(&mut self, item: &Item, cx: &mut Context) -> f64 {
        let [linear, quadratic, cubic] = item.overlaid::<3>("stiffness", cx);
        let springyield = item.number("springyield", 0.0, cx);
        if !self.options.spring {
            return 0.0;
        }
        if quadratic != 0.0 || cubic != 0.0 {
            self.ignored.force("stiffness", item, "stiffness", "a nonlinear spring");
        }
        if springyield > 0.0 && linear != 0.0 {
            self.ignored.force("springyield", item, "springyield", "a yielding spring");
        }
        linear
    }
}

/// Reports joints of one body that MuJoCo refuses: a turn after a ball, or more than six degrees of freedom.
pub fn check_joints(joints: &[Inside], cx: &mut Context) {
    let (mut degrees, mut has_ball) = (0, false);
    for Inside { item, .. } in joints {
        let kind = item.value("type").map_or("hinge", |kind| kind.text);
        degrees += if kind == "ball" { 3 } else { 1 };
        let why = if has_ball && kind != "slide" {
            "is after a ball in the same body, expected a slide there"
        } else if degrees > 6 {
            "is one joint too many in its body, expected at most six degrees of freedom"
        } else {
            has_ball |= kind == "ball";
            continue;
        };
        let help = "MuJoCo refuses it, too; put the joints into a body of its own between this one and its parent";
        return cx.findings.add(item.error("unsupported_joint", "", why).help(help));
    }
}

/// Whether the lower bound is not above the upper one; the reverse is reported.
fn in_order(name: &str, [low, high]: [f64; 2], item: &Item, cx: &mut Context) -> bool {
    if low > high {
        let message =
            format!("{}: {name}: goes from {low} to {high}, expected the lower bound first", item.element.subject);
        let span = item.value(name).map_or_else(|| item.element.span(), |value| value.span);
        cx.findings
            .add(Finding::warning("reversed_limits", span, message).help("it is not used; exchange the numbers"));
    }
    low <= high
}

/// The screw axis in the body's frame; reports an axis of length 0 and returns `None`.
fn screw(item: &Item, T: SE3, is_slide: bool, cx: &mut Context) -> Option<ScrewAxis> {
    let axis = Vec3(item.vector::<3>("axis", cx).unwrap_or([0.0, 0.0, 1.0]));
    let position = Vec3(item.vector::<3>("pos", cx).unwrap_or([0.0; 3]));
    let kind = if is_slide { "prismatic" } else { "revolute" };
    let Some((screw, _)) = axis::screw(kind, T.R * axis) else {
        let text = item.value("axis").map_or("", |value| value.text.trim());
        let message = format!("axis: is `{}`, expected a direction", crate::urdf::vocabulary::shown(text));
        let help = "the axis of a joint is a vector in the body's frame, such as `0 0 1`";
        cx.findings.add(item.error("zero_axis", "axis", &message).help(help));
        return None;
    };
    if is_slide {
        return Some(screw);
    }
    let line = ScrewAxis::from_line(screw.twist().w.0, (T * position).0, 0.0);
    line.map_err(|_| Finding::error("not_finite", item.element.span(), format!("{}: pos", item.element.subject)))
        .map_err(|finding| cx.findings.add(finding))
        .ok()
}
