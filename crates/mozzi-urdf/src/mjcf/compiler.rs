//! `<compiler>`: how to interpret the numbers of a model.

use super::attributes::Item;
use super::vocabulary;
use crate::report::finding::Finding;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::vocabulary::shown;
use mozzi::{SO3, Vec3};
use std::collections::BTreeMap;

/// The source of a body's inertia.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FromGeoms {
    Never,
    Always,
    /// If a body has no `<inertial>`.
    Auto,
}

/// The settings of the model, and those of models of which parts are attached.
pub(crate) struct Compilers {
    pub main: Compiler,
    pub attached: BTreeMap<usize, Compiler>,
}

impl Compilers {
    /// Those for an element.
    pub fn of(&self, element: &Element) -> &Compiler {
        self.attached.get(&element.page()).unwrap_or(&self.main)
    }
}

/// The settings that mozzi uses.
#[derive(Clone)]
pub(crate) struct Compiler {
    degrees: bool,
    /// The axis, and whether it turns with the frame.
    sequence: [(usize, bool); 3],
    pub autolimits: bool,
    pub align_free: bool,
    pub from_geoms: FromGeoms,
    pub groups: [f64; 2],
    pub bound_mass: f64,
    pub bound_inertia: f64,
    pub balance: bool,
    /// True if solids are fitted to the bounding boxes of meshes.
    pub fit_aabb: bool,
    /// True if the folders in the names of mesh files are dropped.
    pub strips: bool,
    pub total_mass: Option<f64>,
    /// True if MuJoCo merges bodies without joints into their parents.
    pub fuses: bool,
}

impl Compiler {
    /// The last of several sections takes precedence.
    pub fn read<'a: 's, 's>(sections: impl Iterator<Item = &'s Element<'a>>, cx: &mut Context) -> Self {
        let mut compiler = Compiler {
            degrees: true,
            sequence: [(0, true), (1, true), (2, true)],
            autolimits: true,
            align_free: false,
            from_geoms: FromGeoms::Auto,
            groups: [0.0, 5.0],
            bound_mass: 0.0,
            bound_inertia: 0.0,
            balance: false,
            fit_aabb: false,
            strips: false,
            total_mass: None,
            fuses: false,
        };
        for section in sections {
            compiler.take(&Item::plain(&section.called("compiler")), cx);
        }
        compiler
    }

    fn take(&mut self, item: &Item, cx: &mut Context) {
        item.element.check_attributes(&vocabulary::COMPILER, cx);
        let children = item.element.check_children(&vocabulary::COMPILER, cx);
        if let Some(child) = children.get("lengthrange") {
            cx.leave_out("compiler", "lengthrange", child.span());
        }
        if let Some(angle) = item.word("angle", &["degree", "radian"], cx) {
            self.degrees = angle == "degree";
        }
        if item.word("coordinate", &["local", "global"], cx) == Some("global") {
            let finding = item.error("global_coordinates", "coordinate", "coordinate: is `global`, expected `local`");
            let help = "save the model with MuJoCo 2.3.3 or older, which writes local coordinates";
            cx.findings.add(finding.help(help));
        }
        if let Some(value) = item.value("eulerseq") {
            let axis = |c: char| Some(("xyz".find(c.to_ascii_lowercase())?, c.is_ascii_lowercase()));
            let axes: Option<Vec<(usize, bool)>> = value.text.chars().take(4).map(axis).collect();
            match axes.as_deref() {
                Some(&[a, b, c]) => self.sequence = [a, b, c],
                _ => {
                    let message = format!("compiler: eulerseq: is `{}`, expected three axes", shown(value.text));
                    let help = "such as `xyz` (axes that turn with the frame) or `XYZ` (fixed axes)";
                    cx.findings.add(Finding::error("unknown_word", value.span, message).help(help));
                }
            }
        }
        self.autolimits = item.flag("autolimits", self.autolimits, cx);
        self.align_free = item.flag("alignfree", self.align_free, cx);
        self.balance = item.flag("balanceinertia", self.balance, cx);
        self.strips = item.flag("strippath", self.strips, cx);
        self.fuses = item.flag("fusestatic", self.fuses, cx);
        self.fit_aabb = item.flag("fitaabb", self.fit_aabb, cx);
        match item.word("inertiafromgeom", &["auto", "true", "false"], cx) {
            Some("true") => self.from_geoms = FromGeoms::Always,
            Some("false") => self.from_geoms = FromGeoms::Never,
            Some(_) => self.from_geoms = FromGeoms::Auto,
            None => {}
        }
        self.groups = item.vector::<2>("inertiagrouprange", cx).unwrap_or(self.groups);
        self.bound_mass = item.number("boundmass", self.bound_mass, cx);
        self.bound_inertia = item.number("boundinertia", self.bound_inertia, cx);
        if item.has("settotalmass") {
            self.total_mass = Some(item.number("settotalmass", -1.0, cx)).filter(|&mass| mass > 0.0);
        }
    }

    /// An angle in radians.
    pub fn angle(&self, x: f64) -> f64 {
        if self.degrees { x.to_radians() } else { x }
    }

    /// The rotation of three Euler angles.
    pub fn euler(&self, angles: [f64; 3]) -> SO3 {
        let mut R = SO3::identity();
        for ((axis, turns), angle) in self.sequence.into_iter().zip(angles) {
            let mut w = [0.0; 3];
            w[axis] = self.angle(angle);
            let turn = SO3::exp(Vec3(w));
            R = if turns { R * turn } else { turn * R };
        }
        R
    }
}
