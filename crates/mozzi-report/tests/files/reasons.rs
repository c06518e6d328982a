//! Errors of a link's mass, centre and moments, one by one and together.

use crate::bodies::place;
use crate::{compare_description, has_cause, of_text};
use mozzi::{SO3, SpatialInertia, Sym3, Vec3};
use mozzi_report::compare::files::compare_files;

/// Another inertia of `upper`, from its mass, centre and moments about it.
fn is_shown(edit: impl Fn(f64, Vec3, Sym3) -> (f64, Vec3, Sym3), words: &[&str], is_explained: bool) {
    let comparison = compare_description(|robot| {
        let k = place(robot, "upper");
        let G = robot.links[k].inertia;
        let (m, c, I) = edit(G.mass, G.center_of_mass(), G.about_center_of_mass());
        robot.links[k].inertia = SpatialInertia::new(m, c, I);
    });
    words.iter().for_each(|words| has_cause(&comparison, words, is_explained));
}

#[test]
fn the_inertial_is_misread() {
    let of = |quat: &str| {
        let text = format!(
            "<mujoco model='m'><worldbody><body name='arm'><joint name='x' axis='1 0 0'/>\
             <inertial pos='0.2 0.1 0' mass='2' quat='{quat}' diaginertia='0.01 0.02 0.027'/>\
             </body></worldbody></mujoco>"
        );
        of_text("a.xml", &text)
    };
    let xyzw = compare_files(&of("0.8 0.2 0.4 0.4"), &of("0.2 0.4 0.4 0.8"), 10, 1, 1e-9).unwrap();
    has_cause(&xyzw, "inertia of `arm` has its inertial's quaternion in the order x y z w", true);
    // the inertial of `upper` is turned by roll, pitch and yaw
    let turn = SO3::from_rpy(0.3, 0.2, 0.1);
    let other = SO3::from_rpy(0.3, 0.0, 0.0) * SO3::from_rpy(0.0, 0.2, 0.0) * SO3::from_rpy(0.0, 0.0, 0.1);
    let [r, p, y] = [0.3_f64, 0.2, 0.1].map(f64::to_degrees);
    for (wrong, words) in
        [(other, "roll, pitch and yaw in the other order"), (SO3::from_rpy(r, p, y), "angles in degrees")]
    {
        let moments = |I: Sym3| I.congruence(turn.inverse().matrix()).congruence(wrong.matrix());
        is_shown(
            |m, c, I| (m, c, moments(I)),
            &[&format!("b.urdf's inertia of `upper` has its inertial's {words}")],
            true,
        );
    }
}

#[test]
fn several_errors_of_a_link() {
    let raw = |I: Sym3| I.congruence(SO3::from_rpy(0.3, 0.2, 0.1).inverse().matrix());
    let mirrored = |c: Vec3| Vec3([c.0[0], c.0[1], -c.0[2]]);
    let unturned = "inertia of `upper` is not rotated by its inertial's orientation";
    is_shown(|m, c, I| (m, mirrored(c), raw(I)), &["with the other sign of z; ", unturned], true);
    let (pound, inch) = (0.45359237, 0.0254);
    let imperial = |I: Sym3| I.map(|x| x / (pound * inch * inch));
    is_shown(|m, c, I| (m / pound, c, imperial(I)), &["kg instead of 2 kg (pounds); ", "is in lb in²"], true);
    let about_origin = |m: f64, c: Vec3, I: Sym3| SpatialInertia::new(m, c, I).I;
    is_shown(
        |m, c, I| (m, Vec3::zero(), about_origin(m, c, I)),
        &["(0, 0, 0) instead of (0.02, 0.01, 0.15); ", "is about the link's origin"],
        true,
    );
    is_shown(|m, c, I| (m, c, I.map(|x| 3.0 * x)), &["moments of 3 times the size of the inertia of `upper`"], false);
    is_shown(
        |m, c, I| (1.3 * m, c * 1.1, Sym3 { xx: I.xx * 1.7, yy: I.yy * 1.4, ..I }),
        &["2.6 kg instead of 2 kg; ", "(0.022, 0.011, 0.165) instead of", "other moments (ixx "],
        false,
    );
}
