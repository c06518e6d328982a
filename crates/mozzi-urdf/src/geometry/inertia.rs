//! Moments of inertia that are those of a link's collision shape about other axes: a cylinder turned to its wheel's
//! axle, and an inertia that was not turned with it.

use super::read::placed_form;
use super::shape::Form;
use crate::report::finding::{Finding, Findings};
use crate::text::context::Context;
use crate::text::dialect::Dialect;
use crate::text::element::Element;
use mozzi::SpatialInertia;

/// The moments of a uniform solid may differ by this factor from the given ones, in order of size.
const ALIKE: f64 = 1.25;
/// A moment that differs by this factor from that about the same axis of the solid is about another axis.
const TURNED: f64 = 1.5;

/// Warns if the inertia of a link fits its only collision shape when axes are exchanged, and not as it is.
pub(crate) fn check(link: &Element, G: SpatialInertia, cx: &mut Context) {
    let mut shapes = link.elements().filter(|child| child.written_name() == "collision");
    let (Some(shape), None) = (shapes.next(), shapes.next()) else { return };
    let mut unread = Context::new(Findings::default(), Dialect::Urdf); // the reader of shapes reports its findings
    unread.version = cx.version;
    let Some((T, form)) = placed_form(&shape, &mut unread) else { return };
    let Some(solid) = moments(&form).map(|each| each.map(|moment| moment * G.mass)) else { return };
    let I = G.about_center_of_mass().congruence(T.R.inverse().matrix());
    let found = [I.xx, I.yy, I.zz];
    let largest = found.iter().fold(0.0_f64, |m, &x| m.max(x));
    let is_along = [I.xy, I.xz, I.yz].iter().all(|x| x.abs() < 0.1 * largest);
    if !is_along || !differ_less(sorted(found), sorted(solid), ALIKE) || differ_less(found, solid, TURNED) {
        return;
    }
    let list = |moments: [f64; 3]| moments.map(|x| format!("{x:.3e}")).join(", ");
    let name = form.name();
    let message = format!(
        "{}: inertia: is that of its collision {name} about other axes: {} kg m² about the {name}'s x, y, z, expected {}",
        link.subject,
        list(found),
        list(solid)
    );
    cx.findings.add(Finding::warning("turned_inertia", link.span(), message));
}

fn sorted(mut moments: [f64; 3]) -> [f64; 3] {
    moments.sort_unstable_by(f64::total_cmp);
    moments
}

fn differ_less(a: [f64; 3], b: [f64; 3], factor: f64) -> bool {
    a.iter().zip(b).all(|(a, b)| *a < factor * b && b < factor * a)
}

/// The moments of a uniform solid of 1 kg about the axes of its own frame, m²; none for other forms. A capsule is about
/// a cylinder with the volume of its ends.
fn moments(form: &Form) -> Option<[f64; 3]> {
    let cylinder = |r: f64, l: f64| [(3.0 * r * r + l * l) / 12.0, (3.0 * r * r + l * l) / 12.0, 0.5 * r * r];
    match *form {
        Form::Box { size: [x, y, z] } => Some([y * y + z * z, x * x + z * z, x * x + y * y].map(|sum| sum / 12.0)),
        Form::Cylinder { radius, length } => Some(cylinder(radius, length)),
        Form::Capsule { radius, length } => Some(cylinder(radius, length + 4.0 / 3.0 * radius)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    /// A wheel of 3 kg whose cylinder is turned by an angle about x, with its inertia (xx, yy, zz).
    fn codes(rpy: &str, [xx, yy, zz]: [f64; 3], shape: &str) -> Vec<String> {
        let text = format!(
            "<robot name='r'><link name='b'/><link name='wheel'><inertial><mass value='3'/><inertia ixx='{xx}' \
             iyy='{yy}' izz='{zz}' ixy='0' ixz='0' iyz='0'/></inertial><collision><origin rpy='{rpy}'/><geometry>{shape}\
             </geometry></collision></link><joint name='j' type='continuous'><parent link='b'/><child link='wheel'/>\
             <axis xyz='0 1 0'/></joint></robot>"
        );
        let robot = crate::parse("r.urdf", text).expect("sound");
        robot.warnings.iter().map(|found| found.code().to_string()).collect()
    }

    #[test]
    fn an_inertia_about_other_axes_than_its_shape_is_reported() {
        const WHEEL: &str = "<cylinder radius='0.2' length='0.1'/>";
        let (across, along) = (3.0 * (3.0 * 0.04 + 0.01) / 12.0, 3.0 * 0.02);
        let turned = ["mozzi::urdf::turned_inertia"];
        assert_eq!(codes("1.5708 0 0", [across, across, along], WHEEL), turned);
        assert!(codes("1.5708 0 0", [across, along, across], WHEEL).is_empty());
        assert!(codes("0 0 0", [across, across, along], WHEEL).is_empty());
        // another mass distribution than the shape's is none of the shape's about other axes
        assert!(codes("1.5708 0 0", [0.4 * across, 0.4 * across, 0.4 * along], WHEEL).is_empty());
        // a beam along x with the moments of one along z
        const BEAM: &str = "<box size='1 0.1 0.1'/>";
        let (thin, long) = (3.0 * 0.02 / 12.0, 3.0 * 1.01 / 12.0);
        assert_eq!(codes("0 0 0", [long, long, thin], BEAM), turned);
        assert!(codes("0 0 0", [thin, long, long], BEAM).is_empty());
        // a cube has no other axes
        assert!(codes("0 0.3 0", [0.02, 0.02, 0.02], "<box size='0.2 0.2 0.2'/>").is_empty());
    }
}
