//! `<inertial>` as its numbers are written.

use crate::edit::element::{Editor, Tag};
use crate::text::number::numbers;
use mozzi::linalg::Sym3;
use mozzi::{SE3, SO3, SpatialInertia, Vec3};

/// The attributes of `<inertia>`, in the order of [`Numbers::moments`].
pub(super) const MOMENTS: [&str; 6] = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];

/// Mass, centre and moments, these in the axes of the inertial frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Numbers {
    pub mass: f64,
    pub center: [f64; 3],
    pub moments: [f64; 6],
}

/// An `<inertial>` and its link.
pub(super) struct Inertial<'a> {
    pub link: Tag<'a>,
    pub tag: Tag<'a>,
    pub numbers: Numbers,
    /// The axes of its moments, in the link's.
    pub R: SO3,
}

impl<'a> Inertial<'a> {
    /// None if a number is missing or invalid, which the reader reports.
    pub fn read(link: Tag<'a>) -> Option<Self> {
        let tag = link.child("inertial")?;
        let one = |tag: Tag<'a>, name| numbers::<1>(tag.attribute(name)?).ok().map(|[x]| x);
        let three = |name| match tag.child("origin").and_then(|origin| origin.attribute(name)) {
            Some(text) => numbers::<3>(text).ok(),
            None => Some([0.0; 3]),
        };
        if tag.child("origin").is_some_and(|origin| origin.attribute("quat_xyzw").is_some()) {
            return None;
        }
        let mut moments = [0.0; 6];
        for (moment, name) in moments.iter_mut().zip(MOMENTS) {
            *moment = one(tag.child("inertia")?, name)?;
        }
        let numbers = Numbers { mass: one(tag.child("mass")?, "value")?, center: three("xyz")?, moments };
        let [roll, pitch, yaw] = three("rpy")?;
        Some(Inertial { link, tag, numbers, R: SO3::from_rpy(roll, pitch, yaw) })
    }

    /// The inertia that these numbers would give, in the link's frame.
    pub fn inertia(&self, of: &Numbers) -> SpatialInertia {
        let [xx, xy, xz, yy, yz, zz] = of.moments;
        let I = Sym3 { xx, xy, xz, yy, yz, zz }.congruence(self.R.matrix());
        SpatialInertia::new(of.mass, Vec3(of.center), I)
    }

    /// The numbers of an inertia about the centre of mass, in the axes of the file.
    pub fn numbers_of(&self, G: SpatialInertia) -> Numbers {
        let Sym3 { xx, xy, xz, yy, yz, zz } = G.about_center_of_mass().congruence(self.R.inverse().matrix());
        Numbers { mass: G.mass, center: G.center_of_mass().0, moments: [xx, xy, xz, yy, yz, zz] }
    }

    /// Writes the numbers that differ, and lists them.
    pub fn write(&self, new: &Numbers) -> (Editor<'a>, String) {
        let (mut editor, mut said) = (Editor::new(self.tag.text), Vec::new());
        let old = &self.numbers;
        if new.mass != old.mass
            && let Some(tag) = self.tag.child("mass")
        {
            editor.set(tag, "value", Some(&shortest(new.mass)));
            said.push(format!("mass {} → {} kg", shortest(old.mass), shortest(new.mass)));
        }
        if new.center != old.center
            && let Some(tag) = self.tag.child("origin")
        {
            let [before, written] = [old.center, new.center].map(|center| center.map(shortest).join(" "));
            said.push(format!("centre {before} → {written} m"));
            editor.set(tag, "xyz", Some(&written));
        }
        for ((name, old), new) in MOMENTS.into_iter().zip(old.moments).zip(new.moments) {
            if let (true, Some(tag)) = (new != old, self.tag.child("inertia")) {
                editor.set(tag, name, Some(&shortest(new)));
                said.push(format!("{name} {} → {}", shortest(old), shortest(new)));
            }
        }
        (editor, said.join(", "))
    }
}

/// A number without the last digits, which rounding changed: those that fifteen digits give.
pub(super) fn shortest(x: f64) -> String {
    let rounded = format!("{x:.14e}").parse::<f64>().unwrap_or(x);
    let is_plain = rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs());
    if is_plain { format!("{}", rounded + 0.0) } else { format!("{rounded:e}") }
}

/// (x² + y² + z²) E − r rᵀ: the moments of 1 kg at r about the origin.
pub(super) fn of_point(r: Vec3) -> Sym3 {
    SpatialInertia::point_mass(1.0, r).transformed(SE3::identity()).I
}
