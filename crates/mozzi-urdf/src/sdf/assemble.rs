//! From named frames to a tree of links: T of each joint from the poses of its links, its axis in the child's frame.

use super::axis::{Axes, Axis};
use super::graph::{Scope, What};
use super::joint::{Joint, Kind};
use super::{FIXED_BASE, Reader};
use crate::report::finding::Finding;
use crate::report::places::{Place, Places};
use crate::text::context::Context;
use crate::text::element::{Element, Value};
use crate::urdf::vocabulary::shown;
use crate::urdf::write::ball_name;
use crate::urdf::{axis, series};
use core::f64::consts::TAU;
use mozzi::model::description::{
    self, Anchor, BaseState, Constraint, JointKind, JointState, Mimic, NamedFrame, NamedState,
};
use mozzi::{Base, Description, SE3, ScrewAxis, SpatialInertia, Vec3};
use std::collections::HashMap;
use std::rc::Rc;

/// The name of the base when joints fix the robot to it.
const WORLD: &str = "world";
/// The name of the state in which the file places the robot.
const INITIAL: &str = "initial";

/// `<drake:ball_constraint>`: two bodies, and a point of each.
pub(super) struct Closure<'a> {
    scope: Rc<Scope>,
    ends: [(Value<'a>, Vec3); 2],
    place: Place,
}

impl<'a> Closure<'a> {
    pub fn read(element: &Element<'a>, scope: &Rc<Scope>, cx: &mut Context) -> Option<Self> {
        let mut part = |name: &str| {
            let word = format!("drake:ball_constraint_{name}");
            let found = element.elements().find(|child| child.written_name() == word);
            if found.is_none() {
                let message = format!("{}: has no <{word}>", element.subject);
                cx.findings.error("missing_element", element.span(), message);
            }
            found
        };
        let (a, p, b, q) = (part("body_A"), part("p_AP"), part("body_B"), part("p_BQ"));
        let mut point = |point: Option<Element<'a>>| {
            let point = point?;
            element.vector::<3>(point.name(), &point.content(), cx).map(Vec3)
        };
        let (p, q) = (point(p), point(q));
        let ends = [(a?.content(), p?), (b?.content(), q?)];
        Some(Closure { scope: scope.clone(), ends, place: Place::new(element.span()) })
    }
}

impl Reader<'_> {
    pub fn assemble(
        mut self,
        name: String,
        gravity: [f64; 3],
        mut places: Places,
        cx: &mut Context,
    ) -> Option<(Description, Places)> {
        let mut description = Description::new(name).with_gravity(gravity);
        let poses: Vec<SE3> = (0..self.links.len()).map(|i| self.graph.pose(self.links[i].node, cx)).collect();
        for link in &self.links {
            description.links.push(description::Link { name: link.name.clone(), inertia: link.inertia });
            places.links.push(link.place.clone());
        }
        let mut state = NamedState { name: INITIAL.to_string(), ..NamedState::default() };
        let joints = std::mem::take(&mut self.joints);
        let mut renamed: HashMap<(String, &str), String> = HashMap::new();
        let (mut mimics, mut carried, mut to_world) = (Vec::new(), vec![false; self.links.len()], Vec::new());
        for joint in &joints {
            let Some((parent, child)) = self.ends(joint, cx) else {
                places.is_partial = true; // reported
                continue;
            };
            carried[child] = true;
            let origin = parent.map_or(SE3::identity(), |parent| poses[parent]).inverse() * poses[child];
            let origin = match joint.kind {
                Kind::Planar(_) => self.coinciding(joint, parent.map(|i| poses[i]), poses[child], cx),
                _ => self.written(parent, child).unwrap_or(origin),
            };
            let ends =
                [parent.map_or(WORLD.to_string(), |i| self.links[i].name.clone()), self.links[child].name.clone()];
            if parent.is_none() {
                to_world.push(description.joints.len());
            }
            let first = description.joints.len();
            self.moved(joint, ends, [origin, poses[child]], (&mut description, &mut places), cx);
            for (i, one) in joint.axes.iter().enumerate().take(description.joints.len() - first) {
                let (added, word) = (&mut description.joints[first + i], ["axis", "axis2"][i.min(1)]);
                renamed.insert((joint.name.clone(), word), added.name.clone());
                if let Some(coupling) = &one.mimic {
                    mimics.push((first + i, joint, coupling));
                } else if one.initial != 0.0 {
                    let name = added.name.clone();
                    state.joints.push(JointState { name, positions: vec![one.initial], velocities: vec![0.0] });
                }
            }
        }
        for (i, joint, coupling) in mimics {
            let name = format!("{}{}", joint.scope.prefix, coupling.joint.text);
            let axis = if coupling.axis == "axis2" { "axis2" } else { "axis" };
            let joint = renamed.get(&(name.clone(), axis)).cloned().unwrap_or(name);
            description.joints[i].mimic = Some(Mimic { joint, ratio: coupling.ratio, offset: coupling.offset });
        }
        let roots: Vec<usize> = (0..self.links.len()).filter(|i| !carried[*i]).collect();
        self.based(&mut description, &mut places, &to_world, (&roots, &poses), &mut state);
        for i in 0..self.frames.len() {
            let (node, name) = (self.frames[i].node, self.frames[i].name.clone());
            let Ok(link) = self.graph.link(node, cx) else { continue };
            let T = self.graph.pose(node, cx);
            // a frame of the world itself is on a link only if the world is one
            let has_world = description.links.first().is_some_and(|link| link.name == WORLD);
            let (link, T) = match link {
                Some(link) => (self.links[link].name.clone(), poses[link].inverse() * T),
                None if has_world => (WORLD.to_string(), T),
                None => continue,
            };
            description.frames.push(NamedFrame { name, link, T });
            places.frames.push(self.frames[i].place.clone());
        }
        for (i, closure) in std::mem::take(&mut self.closures).into_iter().enumerate() {
            let anchors = closure.ends.map(|(body, point)| {
                let node = self.graph.found(&closure.scope, &body, "drake:ball_constraint", cx)?;
                let (link, T) = (self.graph.link(node, cx).ok()?, self.graph.pose(node, cx));
                Some(match link {
                    Some(link) => {
                        Anchor::frame(&*self.links[link].name).at(poses[link].inverse() * T * SE3::translation(point.0))
                    }
                    None => Anchor::world(T * SE3::translation(point.0)),
                })
            });
            if let [Some(a), Some(b)] = anchors {
                description.constraints.push(Constraint::point(ball_name(i), a, b));
                places.constraints.push(closure.place);
            }
        }
        if state.base.is_some() || !state.joints.is_empty() {
            description.start = Some(state.name.clone());
            description.states.push(state);
            places.states.push(places.robot.clone());
        }
        Some((description, places))
    }

    /// The links of a joint; `None` for the world, which is no child.
    fn ends(&mut self, joint: &Joint, cx: &mut Context) -> Option<(Option<usize>, usize)> {
        let subject = &joint.subject;
        let mut end = |value: &Option<Value>, word: &str| {
            let value = value.as_ref()?;
            let Some(node) = self.graph.find(&joint.scope, value.text) else {
                let message = format!("{subject}: {word}: is `{}`, which is no link or frame here", shown(value.text));
                let help = self.graph.of_static(value.text);
                cx.findings.add(Finding::error("unknown_link", value.span.clone(), message).maybe_help(help));
                return None;
            };
            self.graph.link(node, cx).ok()
        };
        let (parent, child) = (end(&joint.parent, "parent"), end(&joint.child, "child"));
        let (parent, child) = (parent?, child?);
        let Some(child) = child else {
            let message = format!("{subject}: child: is `world`, which does not move");
            let span = joint.child.as_ref().map_or_else(|| joint.place.span(""), |child| child.span.clone());
            cx.findings.add(Finding::error("misplaced_joint", span, message).help("exchange <parent> and <child>"));
            return None;
        };
        Some((parent, child))
    }

    /// The child's configuration in the parent for which the two frames that a <drake:joint> names coincide.
    fn coinciding(&mut self, joint: &Joint, parent: Option<SE3>, child: SE3, cx: &mut Context) -> SE3 {
        let mut frame = |end: &Option<Value>| {
            let node = end.as_ref().and_then(|end| self.graph.find(&joint.scope, end.text));
            node.map_or_else(SE3::identity, |node| self.graph.pose(node, cx))
        };
        let (there, here) = (frame(&joint.parent), frame(&joint.child));
        parent.unwrap_or_else(SE3::identity).inverse() * there * here.inverse() * child
    }

    /// The child's pose as it is written, if it is relative to the parent.
    fn written(&mut self, parent: Option<usize>, child: usize) -> Option<SE3> {
        let (child, parent) = (self.links[child].node, parent.map(|parent| self.links[parent].node)?);
        let node = self.graph.node(child);
        let (scope, name, T) = (node.scope.clone(), node.relative_to.clone()?, node.T);
        (self.graph.find(&scope, name.text) == Some(parent)).then_some(T)
    }

    /// The joint's pose as it is written, if it is relative to the child link.
    fn written_in_child(&mut self, joint: &Joint) -> Option<SE3> {
        let node = self.graph.node(joint.node);
        let (relative_to, T) = (node.relative_to.clone()?, node.T);
        let [child, frame] = [joint.child.as_ref()?, &relative_to].map(|name| self.graph.find(&joint.scope, name.text));
        let child = child.filter(|child| frame == Some(*child))?;
        matches!(self.graph.node(child).what, What::Link(_)).then_some(T)
    }

    /// Adds the joints of one or several axes.
    fn moved(
        &mut self,
        joint: &Joint,
        [parent, child]: [String; 2],
        [origin, of_child]: [SE3; 2],
        (description, places): (&mut Description, &mut Places),
        cx: &mut Context,
    ) {
        // the joint's, in the child's
        let frame = match self.written_in_child(joint) {
            Some(T) => T,
            None => of_child.inverse() * self.graph.pose(joint.node, cx),
        };
        let one = |kind| description::Joint::new(&joint.name, &parent, &child, origin, kind);
        let screw = |axis: &Axis, kind: &str, reader: &mut Self, cx: &mut Context| {
            let R = match &axis.axes {
                Axes::Joint => frame.R,
                Axes::Model => of_child.R.inverse() * reader.graph.pose(joint.scope.frame, cx).R,
                Axes::Frame(name) => {
                    let node = reader.graph.found(&joint.scope, name, &format!("{}: axis", joint.subject), cx);
                    let node = node.unwrap_or(joint.node);
                    of_child.R.inverse() * reader.graph.pose(node, cx).R
                }
            };
            let found = direction(kind, R, axis.xyz, frame.p, joint.kind);
            if found.is_none() {
                let message = format!("{}: axis: is `{:?}`, expected a direction", joint.subject, axis.xyz.0);
                cx.findings.add(Finding::error("zero_axis", axis.span.clone(), message));
            }
            found
        };
        let mut place = joint.place.clone();
        let mut added = match joint.kind {
            Kind::Fixed => vec![one(JointKind::Fixed)],
            Kind::Ball => vec![one(JointKind::Ball(frame.p))],
            Kind::Turns | Kind::Slides | Kind::Screw(_) => {
                let word = if joint.kind == Kind::Slides { "prismatic" } else { "revolute" };
                let found = screw(&joint.axes[0], word, self, cx);
                if found.is_none() {
                    place.report("kind");
                }
                vec![one(found.map_or(JointKind::Fixed, JointKind::Screw))]
            }
            Kind::TwoAxes | Kind::Planar(_) => {
                let parts: Option<Vec<series::Part>> = match joint.kind {
                    Kind::Planar(damping) => series::planar(Vec3([0.0, 0.0, 1.0]), damping).map(|parts| {
                        parts.into_iter().map(|part| series::Part { screw: part.screw.moved(frame), ..part }).collect()
                    }),
                    _ => (joint.axes.iter().zip(["axis", "axis2"]))
                        .map(|(axis, ending)| {
                            screw(axis, "revolute", self, cx).map(|screw| series::Part { ending, screw, damping: 0.0 })
                        })
                        .collect(),
                };
                let mut row = Description::new("");
                let mut row_places = Places::default();
                series::add(one(JointKind::Fixed), &parts.unwrap_or_default(), &place, &mut row, &mut row_places);
                description.links.append(&mut row.links);
                places.links.append(&mut row_places.links);
                row.joints
            }
        };
        if joint.kind == Kind::Ball {
            // Drake's one damping for all directions; nothing else of an axis has a meaning
            added[0].damping = joint.axes.first().map_or(0.0, |axis| axis.damping);
        }
        for (added, axis) in
            added.iter_mut().zip(&joint.axes).filter(|(added, _)| matches!(added.kind, JointKind::Screw(_)))
        {
            added.limits = axis.limits;
            (added.damping, added.friction) = (axis.damping, axis.friction);
            (added.stiffness, added.spring_reference) = (axis.stiffness, axis.spring_reference);
        }
        self.geared(joint, &mut added, &mut place, cx);
        places.joints.extend(added.iter().map(|_| place.clone()));
        description.joints.append(&mut added);
    }

    /// The armature, ratio² × inertia; as in Drake, none without an actuator, which an effort limit of 0 removes.
    fn geared(&self, joint: &Joint, added: &mut [description::Joint], place: &mut Place, cx: &mut Context) {
        let [inertia, ratio] = joint.rotor;
        if inertia == 0.0 {
            return;
        }
        match added {
            [one] if matches!(one.kind, JointKind::Screw(_)) && one.limits.effort != Some(0.0) => {
                one.armature = ratio * ratio * inertia;
            }
            _ => {
                let message = format!(
                    "{}: drake:rotor_inertia: is ignored: Drake has a rotor only on a joint of one axis whose effort \
                     limit is not 0",
                    joint.subject
                );
                cx.findings.add(Finding::warning("ignored_property", place.span(""), message));
            }
        }
    }

    /// The base: the model's link, free or fixed at the origin; or the world.
    fn based(
        &self,
        description: &mut Description,
        places: &mut Places,
        to_world: &[usize],
        (roots, poses): (&[usize], &[SE3]),
        state: &mut NamedState,
    ) {
        if let (&[joint], []) = (to_world, roots) {
            let fixed = &description.joints[joint];
            if fixed.name == FIXED_BASE && fixed.kind == JointKind::Fixed && fixed.origin == SE3::identity() {
                description.joints.remove(joint);
                places.joints.remove(joint);
                return;
            }
        }
        if let ([], &[root]) = (to_world, roots) {
            description.base = Base::Floating;
            if poses[root] != SE3::identity() {
                state.base = Some(BaseState { pose: poses[root].to_pose(), twist: [0.0; 6] });
            }
            return;
        }
        description.links.insert(0, description::Link { name: WORLD.to_string(), inertia: SpatialInertia::zero() });
        places.links.insert(0, places.robot.clone());
        for &root in roots {
            let link = &self.links[root];
            let name = format!("{}:free", link.name);
            let free = description::Joint::new(&name, WORLD, &link.name, SE3::identity(), JointKind::Free);
            description.joints.push(free);
            places.joints.push(link.place.clone());
            if poses[root] != SE3::identity() {
                let positions = poses[root].to_pose().to_vec();
                state.joints.push(JointState { name, positions, velocities: vec![0.0; 6] });
            }
        }
    }
}

/// The screw axis in the child's frame: a direction in a frame with the rotation R, through a point of the child's.
fn direction(kind: &str, R: mozzi::SO3, xyz: Vec3, point: Vec3, of: Kind) -> Option<ScrewAxis> {
    let (unit, _) = axis::screw(kind, xyz)?;
    if kind == "prismatic" {
        return axis::screw(kind, R * unit.twist().v).map(|(screw, _)| screw);
    }
    let pitch = if let Kind::Screw(travel) = of { travel / TAU } else { 0.0 };
    ScrewAxis::from_line((R * unit.twist().w).0, point.0, pitch).ok()
}
