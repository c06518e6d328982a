//! `<inertial>` as its numbers are written, read and replaced.

use super::element::{Editor, Tag};
use super::joint::{ROUNDING, is_near};
use crate::text::number::numbers;
use crate::text::version::Version;
use crate::urdf::inertial::{MOMENTS, element, moments};
use crate::urdf::origin::rotation;
use mozzi::linalg::Sym3;
use mozzi::{SO3, SpatialInertia, Vec3};

/// Mass, centre and moments, these in the axes of the inertial frame and in the order of [`MOMENTS`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Numbers {
    pub mass: f64,
    pub center: [f64; 3],
    pub moments: [f64; 6],
}

/// An `<inertial>` and its link.
pub(crate) struct Inertial<'a> {
    pub link: Tag<'a>,
    pub tag: Tag<'a>,
    pub numbers: Numbers,
    /// The axes of its moments, in the link's.
    pub R: SO3,
}

fn one(tag: Tag<'_>, name: &str) -> Option<f64> {
    numbers::<1>(tag.attribute(name)?).ok().map(|[x]| x)
}

impl<'a> Inertial<'a> {
    /// None if a number is missing or invalid, which the reader reports.
    pub fn read(link: Tag<'a>) -> Option<Self> {
        let tag = link.child("inertial")?;
        let attribute = |name| tag.child("origin").and_then(|origin| origin.attribute(name));
        let three = |name| attribute(name).map_or(Some([0.0; 3]), |text| numbers::<3>(text).ok());
        let version = link.node.document().root_element().attribute("version").and_then(Version::parse);
        let R = match attribute("quat_xyzw").filter(|_| version.unwrap_or_default() >= Version::WITH_QUATERNIONS) {
            Some(_) if attribute("rpy").is_some() => return None,
            Some(text) => rotation(numbers::<4>(text).ok()?)?.0,
            None => three("rpy").map(|[roll, pitch, yaw]| SO3::from_rpy(roll, pitch, yaw))?,
        };
        let mut moments = [0.0; 6];
        for (moment, name) in moments.iter_mut().zip(MOMENTS) {
            *moment = one(tag.child("inertia")?, name)?;
        }
        let numbers = Numbers { mass: one(tag.child("mass")?, "value")?, center: three("xyz")?, moments };
        Some(Inertial { link, tag, numbers, R })
    }

    /// The inertia that these numbers would give, in the link's frame.
    pub fn inertia(&self, of: &Numbers) -> SpatialInertia {
        let [xx, xy, xz, yy, yz, zz] = of.moments;
        let I = Sym3 { xx, xy, xz, yy, yz, zz }.congruence(self.R.matrix());
        SpatialInertia::new(of.mass, Vec3(of.center), I)
    }

    /// The numbers of an inertia about the centre of mass, in the axes of the file: I_file = Rᵀ I R.
    pub fn numbers_of(&self, G: SpatialInertia) -> Numbers {
        let I = G.about_center_of_mass().congruence(self.R.inverse().matrix());
        Numbers { mass: G.mass, center: G.center_of_mass().0, moments: moments(I) }
    }

    /// Sets the numbers that differ by more than rounding, and lists them.
    pub fn set(&self, new: &Numbers, format: impl Fn(f64) -> String, editor: &mut Editor<'a>) -> Vec<String> {
        let (old, mut changes) = (&self.numbers, Vec::new());
        let mut differ = |name: &str, unit: &str, [before, after]: [String; 2], is_near: bool| {
            let differs = !is_near && before != after;
            if differs {
                changes.push(format!("{name} {before} → {after}{unit}"));
            }
            differs.then_some(after)
        };
        let masses = [old.mass, new.mass].map(&format);
        if let Some(mass) = differ("mass", " kg", masses, is_near(&[old.mass], &[new.mass])) {
            self.tag.child("mass").into_iter().for_each(|tag| editor.set(tag, "value", Some(&mass)));
        }
        let centers = [old.center, new.center].map(|center| center.map(&format).join(" "));
        if let Some(center) = differ("centre", " m", centers, is_near(&old.center, &new.center)) {
            match self.tag.child("origin") {
                Some(origin) => editor.set(origin, "xyz", Some(&center)),
                None => editor.insert_first(self.tag, &format!("<origin xyz=\"{center}\"/>")),
            }
        }
        let scale = new.moments.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for ((name, old), new) in MOMENTS.into_iter().zip(old.moments).zip(new.moments) {
            let is_near = (old - new).abs() <= ROUNDING * scale;
            if let Some(moment) = differ(name, "", [old, new].map(&format), is_near) {
                self.tag.child("inertia").into_iter().for_each(|tag| editor.set(tag, name, Some(&moment)));
            }
        }
        changes
    }
}

/// Sets a link's inertia, and lists the changes.
pub(crate) fn set_inertia<'a>(
    link: Tag<'a>,
    G: SpatialInertia,
    format: impl Fn(f64) -> String,
    editor: &mut Editor<'a>,
) -> Vec<String> {
    if let Some(inertial) = Inertial::read(link) {
        return inertial.set(&inertial.numbers_of(G), format, editor);
    }
    if G == SpatialInertia::zero() {
        return Vec::new();
    }
    editor.insert_first(link, &element(G, &format, "", ""));
    vec![format!("an <inertial> of {} kg is added", format(G.mass))]
}

/// A comment with the numbers that a link had before.
pub(super) fn comment_of(G: SpatialInertia) -> String {
    let values = MOMENTS.into_iter().zip(moments(G.about_center_of_mass()));
    let numbers: Vec<String> = values.map(|(name, value)| format!("{name} {value:?}")).collect();
    let center = G.center_of_mass().0.map(|x| format!("{x:?}")).join(" ");
    format!("<!-- before: mass {:?}, centre {center}, {} -->", G.mass, numbers.join(" "))
}
