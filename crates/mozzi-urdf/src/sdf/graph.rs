//! Named frames, and where they are: a pose is relative to a frame by its name, and so on up to the model's frame.

use crate::report::finding::Finding;
use crate::text::context::Context;
use crate::text::element::Value;
use crate::urdf::vocabulary::shown;
use mozzi::SE3;
use std::collections::HashMap;
use std::rc::Rc;

/// Models inside models, each referring into another, are followed to this depth.
const DEEPEST: usize = 256;

/// Where names are looked up: in a model, or in the world.
pub(crate) struct Scope {
    /// "arm::" for the model `arm` of another model.
    pub prefix: String,
    /// The frame that poses are relative to by default, called `__model__`.
    pub frame: usize,
    /// The model, or the world.
    pub model: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum What {
    World,
    /// With its first link.
    Model(Option<usize>),
    /// The number of the link.
    Link(usize),
    Joint,
    Frame,
}

/// A frame.
pub(crate) struct Node<'a> {
    pub what: What,
    pub scope: Rc<Scope>,
    pub T: SE3,
    /// The name of the frame that `T` is relative to; the scope's frame if there is none.
    pub relative_to: Option<Value<'a>>,
    /// The name of the element that carries it: `attached_to` of a frame, the child of a joint, the canonical link of a
    /// model.
    pub carrier: Option<Value<'a>>,
    /// The frame of a model that `T` is for, and that model's scope.
    pub placement: Option<(Value<'a>, Rc<Scope>)>,
    /// In messages.
    pub subject: String,
}

pub(crate) struct Graph<'a> {
    nodes: Vec<Node<'a>>,
    names: HashMap<String, usize>,
    /// Configurations in the node's own model, as they are found.
    known: Vec<Option<SE3>>,
    pub world: Rc<Scope>,
    /// The model whose name does not precede its links', and its node.
    pub robot: Option<(String, usize)>,
    /// Names of static models of the world, which are not read.
    pub statics: Vec<String>,
}

impl<'a> Graph<'a> {
    pub fn new() -> Self {
        let world = Rc::new(Scope { prefix: String::new(), frame: 0, model: 0 });
        let mut graph = Graph {
            nodes: Vec::new(),
            names: HashMap::new(),
            known: Vec::new(),
            world: world.clone(),
            robot: None,
            statics: Vec::new(),
        };
        graph.add(Node::new(What::World, &world, "world".to_string()));
        graph
    }

    /// A new frame without a name.
    pub fn add(&mut self, node: Node<'a>) -> usize {
        self.nodes.push(node);
        self.known.push(None);
        self.nodes.len() - 1
    }

    /// Gives a frame its name; false if another frame has it.
    pub fn name(&mut self, full: &str, node: usize) -> bool {
        let is_new = !self.names.contains_key(full);
        self.names.entry(full.to_string()).or_insert(node);
        is_new
    }

    pub fn node(&mut self, node: usize) -> &mut Node<'a> {
        &mut self.nodes[node]
    }

    /// The frame of this name.
    pub fn find(&self, scope: &Scope, name: &str) -> Option<usize> {
        match name {
            "__model__" => Some(scope.frame),
            "world" => Some(0),
            _ => {
                let name = name.strip_suffix("::__model__").unwrap_or(name);
                let name = match &self.robot {
                    Some((robot, node)) if scope.model == 0 && name == robot => return Some(*node),
                    Some((robot, _)) if scope.model == 0 => {
                        name.strip_prefix(robot.as_str()).and_then(|rest| rest.strip_prefix("::")).unwrap_or(name)
                    }
                    _ => name,
                };
                self.names.get(&format!("{}{name}", scope.prefix)).copied()
            }
        }
    }

    /// As [`find`](Self::find); reports an unknown name at its place.
    pub fn found(&self, scope: &Scope, value: &Value, subject: &str, cx: &mut Context) -> Option<usize> {
        let found = self.find(scope, value.text);
        if found.is_none() {
            let message = format!("{subject}: names `{}`, which is no frame here", shown(value.text));
            let help = self.of_static(value.text);
            cx.findings.add(Finding::error("unknown_frame", value.span.clone(), message).maybe_help(help));
        }
        found
    }

    /// A remedy if a name is that of a static model, or of a part of one.
    pub fn of_static(&self, name: &str) -> Option<String> {
        let model = name.split("::").next().filter(|model| self.statics.iter().any(|other| other == model))?;
        let help = "is static, and static models are not read: write the pose in numbers, and `world` for the link";
        Some(format!("`{}` {help}", shown(model)))
    }

    /// The configuration in {s}.
    pub fn pose(&mut self, node: usize, cx: &mut Context) -> SE3 {
        self.within(node, 0, 0, cx)
    }

    /// The configuration in a model that contains it.
    fn within(&mut self, node: usize, model: usize, depth: usize, cx: &mut Context) -> SE3 {
        if node == model {
            return SE3::identity();
        }
        let own = self.own(node, depth + 1, cx);
        match self.nodes[node].scope.model {
            outer if outer == model || node == outer => own,
            outer => self.within(outer, model, depth + 1, cx) * own,
        }
    }

    /// The configuration in its own model: the frames that it is relative to, one after the other.
    fn own(&mut self, node: usize, depth: usize, cx: &mut Context) -> SE3 {
        let model = self.nodes[node].scope.model;
        let (mut row, mut at) = (vec![node], node);
        let mut T = loop {
            if at == model {
                row.pop();
                break SE3::identity();
            }
            if let Some(known) = self.known[at] {
                row.pop();
                break known;
            }
            let Node { scope, relative_to, subject, .. } = &self.nodes[at];
            let (scope, subject) = (scope.clone(), subject.clone());
            let next = match &relative_to.clone() {
                None => scope.frame,
                // an unknown child is reported as the joint's
                Some(name) if self.nodes[at].carrier.as_ref().is_some_and(|child| child.span == name.span) => {
                    self.find(&scope, name.text).unwrap_or(scope.frame)
                }
                Some(name) => self.found(&scope, name, &format!("{subject}: pose"), cx).unwrap_or(scope.frame),
            };
            if row.len() > self.nodes.len() || depth > DEEPEST {
                let span = relative_to.as_ref().map_or(0..0, |name| name.span.clone());
                let message = format!("{subject}: its pose is relative to itself, directly or over other frames");
                cx.findings.error("circular_frames", span, message);
                break SE3::identity();
            }
            if self.nodes[next].scope.model == model || next == model {
                at = next;
                row.push(at);
            } else {
                break match self.nodes[next].what {
                    What::World => self.within(model, 0, depth + 1, cx).inverse(),
                    _ => self.within(next, model, depth + 1, cx),
                };
            }
        };
        while let Some(next) = row.pop() {
            T = T * self.placed(next, depth, cx);
            self.known[next] = Some(T);
        }
        T
    }

    /// T of a node; of a model that is placed by one of its frames, T of the model's own frame.
    fn placed(&mut self, node: usize, depth: usize, cx: &mut Context) -> SE3 {
        let Node { T, placement, subject, .. } = &self.nodes[node];
        let Some((frame, scope)) = placement.clone() else { return *T };
        let (T, subject) = (*T, format!("{subject}: placement_frame"));
        let Some(frame) = self.found(&scope, &frame, &subject, cx) else { return T };
        T * self.within(frame, scope.model, depth + 1, cx).inverse()
    }

    /// The number of the link that carries a frame; `None` for the world. `Err` if it is carried by itself or, with a
    /// diagnostic, by something unknown.
    pub fn link(&self, node: usize, cx: &mut Context) -> Result<Option<usize>, ()> {
        let mut at = node;
        for _ in 0..=self.nodes.len() {
            let Node { what, scope, carrier, subject, .. } = &self.nodes[at];
            at = match (what, carrier) {
                (What::World, _) => return Ok(None),
                (What::Link(link), _) | (What::Model(Some(link)), None) => return Ok(Some(*link)),
                (What::Model(None), None) => return Err(()),
                (_, Some(carrier)) => self.found(scope, carrier, subject, cx).ok_or(())?,
                (What::Joint | What::Frame, None) => scope.frame,
            };
        }
        let Node { carrier, subject, .. } = &self.nodes[node];
        let span = carrier.as_ref().map_or(0..0, |name| name.span.clone());
        cx.findings.error("circular_frames", span, format!("{subject}: is attached to itself, over other frames"));
        Err(())
    }
}

impl<'a> Node<'a> {
    pub fn new(what: What, scope: &Rc<Scope>, subject: String) -> Self {
        let (T, scope) = (SE3::identity(), scope.clone());
        Node { what, scope, T, relative_to: None, carrier: None, placement: None, subject }
    }
}
