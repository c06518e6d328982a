//! `<worldbody>` and `<body>`: links, and the joints before them.

use super::Model;
use super::class::Class;
use super::compiler::FromGeoms;
use super::contents::{Around, Contents, Inside};
use super::geom::Mass;
use super::joint::check_joints;
use super::orientation::{pose, to_z, unit};
use super::tree::{Link, Name, Site};
use super::{attributes::Item, vocabulary};
use crate::report::places::Place;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::vocabulary::shown;
use mozzi::{SE3, SpatialInertia, Vec3};

/// A parent body.
#[derive(Clone, Copy)]
struct Carrier {
    link: usize,
    /// No joint moves it.
    is_static: bool,
    /// Its pose, if no joint moves it.
    T: SE3,
    depth: usize,
}

impl<'a> Model<'a> {
    /// The tree of bodies; elements of the world itself do not move.
    pub fn world(&mut self, element: &Element<'a>, cx: &mut Context) {
        let element = element.called("worldbody");
        element.check_attributes(&vocabulary::WORLD, cx);
        element.check_children(&vocabulary::WORLD, cx);
        let class = self.classes.named(&element, "childclass", Class::MAIN, cx);
        let mut contents = Contents::default();
        self.gather(&element, &Around::new(class), &mut contents, cx);
        for joint in contents.joints.iter().chain(&contents.free) {
            let message = "worldbody: has a joint, but the world does not move";
            cx.findings.error("misplaced_joint", joint.item.element.span(), message);
        }
        self.draw(&contents.geoms, 0, Some(SE3::identity()));
        contents.geoms.iter().for_each(|geom| self.check_geom(&geom.item.element.called("worldbody: geom"), cx));
        self.rest(contents, Carrier { link: 0, is_static: true, T: SE3::identity(), depth: 0 }, cx);
    }

    /// A body and its descendants.
    fn body(&mut self, inside: Inside<'a>, carrier: Carrier, cx: &mut Context) {
        let element = inside.item.element.called("body");
        self.tree.bodies += 1;
        let name = Name::of(&element, format!("body{}", self.tree.bodies), cx).suffixed(&inside.around.suffix);
        let element = element.called(format!("body `{}`", name.shown()));
        let item = Item::plain(&element);
        element.check_attributes(&vocabulary::BODY, cx);
        element.check_children(&vocabulary::BODY, cx);
        let class = self.classes.named(&element, "childclass", inside.around.class, cx);
        let own = pose(&item, &self.compiler, cx);
        let mut origin = inside.T * own;
        let T = carrier.T * origin;
        let compensation = item.number("gravcomp", 0.0, cx);
        if compensation != 0.0 {
            self.ignored.force("gravcomp", &item, "gravcomp", "gravity compensation");
        }
        let is_mocap = item.flag("mocap", false, cx);
        if is_mocap {
            self.ignored.force("mocap", &item, "mocap", "a prescribed motion");
        }
        let mut contents = Contents::default();
        let around = Around { T: SE3::identity(), class, depth: carrier.depth, ..inside.around.clone() };
        self.gather(&element, &around, &mut contents, cx);

        let mut place = Place::new(element.span());
        if let Some(value) = element.attribute("name") {
            place.set("name", value.span);
        }
        let is_free = self.free(&contents, carrier.link, &name.shown(), origin, cx);
        check_joints(&contents.joints, cx);
        let is_static = carrier.is_static && contents.joints.is_empty() && !is_free;
        let inertia = self.inertia(&element, &contents, own.p, &mut place, is_static, cx);
        // joints act one after the other, the first at the parent; between them are massless links
        let mut parent = carrier.link;
        let count = contents.joints.len();
        for (i, joint) in contents.joints.iter().enumerate() {
            let child = self.tree.links.len();
            let read = self.joint(joint, [parent, child], origin, cx);
            if i + 1 < count {
                let name = Name::generated(format!("{}:{}", name.shown(), read));
                let place = Place::new(joint.item.element.span());
                let (inertia, compensation) = (SpatialInertia::zero(), 0.0);
                self.tree.links.push(Link { name, inertia, compensation, is_mocap: false, place });
            }
            (parent, origin) = (child, SE3::identity());
        }
        let link = if count == 0 { self.tree.links.len() } else { parent };
        if count == 0 && !is_free {
            let fixed = Name::generated(format!("{}:fixed", name.shown()));
            self.tree.joint(fixed, [parent, link], origin, Place::new(element.span()));
        }
        self.tree.links.push(Link { name, inertia, compensation, is_mocap, place });
        self.draw(&contents.geoms, link, is_static.then_some(T));
        self.rest(contents, Carrier { link, is_static, T, depth: carrier.depth + 1 }, cx);
    }

    /// The sites and the child bodies of a body.
    fn rest(&mut self, contents: Contents<'a>, carrier: Carrier, cx: &mut Context) {
        for site in &contents.sites {
            self.site(site, carrier.link, cx);
        }
        for body in contents.bodies {
            self.body(body, carrier, cx);
        }
    }

    /// A site is a frame, if it has a name.
    fn site(&mut self, site: &Inside, link: usize, cx: &mut Context) {
        let Inside { item, T, around } = site;
        item.element.check_attributes(&vocabulary::SITE, cx);
        item.element.called("site").check_children(&vocabulary::SITE, cx);
        let name = Name::of(&item.element.called("site"), String::new(), cx).suffixed(&around.suffix);
        let mut frame = pose(item, &self.compiler, cx);
        if let Some([a, b, c, d, e, f]) = item.vector::<6>("fromto", cx) {
            let (from, to) = (Vec3([a, b, c]), Vec3([d, e, f]));
            let R = unit(to - from).map_or(frame.R, to_z);
            frame = SE3 { R, p: (from + to) * 0.5 };
        }
        let Some(name) = name.given else { return };
        let mut place = Place::new(item.element.span());
        if let Some(value) = item.element.attribute("name") {
            place.set("name", value.span);
        }
        self.tree.sites.push(Site { name, link, T: *T * frame, place });
    }

    /// The vocabulary of a geom; a plugin in it defines its shape.
    fn check_geom(&mut self, geom: &Element<'a>, cx: &mut Context) {
        geom.check_attributes(&vocabulary::GEOM, cx);
        geom.check_children(&vocabulary::GEOM, cx);
        if let Some(plugin) = geom.elements().find(|child| child.name() == "plugin") {
            self.ignored.list("plugin", plugin.span(), &geom.subject, "it generates a shape for contacts");
        }
    }

    /// The inertia of a body in its frame: given, or the sum of its geoms'. If there is neither, boundmass puts its
    /// mass, as in MuJoCo, at the point `p` of the body's frame, the `pos` that places the body in its parent.
    fn inertia(
        &mut self,
        element: &Element<'a>,
        contents: &Contents<'a>,
        p: Vec3,
        place: &mut Place,
        is_static: bool,
        cx: &mut Context,
    ) -> SpatialInertia {
        let (inertial, from_geoms) = (contents.inertial.as_ref(), self.compiler.of(element).from_geoms);
        let given = inertial.map(|inertial| self.inertial(inertial, place, cx));
        let is_given = from_geoms == FromGeoms::Never || from_geoms == FromGeoms::Auto && given.is_some();
        let mut sum = SpatialInertia::zero();
        for geom in &contents.geoms {
            let named = geom.item.element.attribute("name").map(|name| format!("geom `{}`", shown(name.text)));
            let subject = named.unwrap_or_else(|| format!("{}: geom", element.subject));
            let item = Item { element: geom.item.element.called(subject), ..geom.item.clone() };
            self.check_geom(&item.element, cx);
            if !is_static && item.value("type").is_some_and(|kind| kind.text == "plane") {
                let message = "type: is plane, expected another shape: joints move its body";
                let help = "MuJoCo refuses it, too; a plane belongs in the world, or in a body that does not move";
                cx.findings.add(item.error("unsupported_element", "type", message).help(help));
            }
            if is_given {
                continue;
            }
            match self.mass_of(&item, geom.T, cx) {
                Mass::Known(inertia) => sum += inertia,
                // checks of an unknown mass would only repeat the error
                Mass::Wrong => place.report("mass"),
                Mass::Mesh(_) if is_static => self.ignored.mesh(&item),
                Mass::Mesh(why) => {
                    let help = "give the body an <inertial>, or the geom mass=\"0\"; MuJoCo writes inertias into the file that \
                                it saves with the compiler's saveinertial";
                    let message = format!("mesh: its inertia is needed, and is unknown: {why}");
                    cx.findings.add(item.error("mesh_inertia", "mesh", &message).help(help));
                    place.report("mass");
                }
            }
        }
        // without a geom that has a mass the given inertia remains
        let (inertia, center) = match given {
            Some((given, center)) if is_given || sum.mass == 0.0 => (given, center),
            _ if is_given || sum.mass == 0.0 => (SpatialInertia::zero(), p),
            _ => (sum, sum.center_of_mass()),
        };
        self.bounded(inertia, center, element)
    }
}
