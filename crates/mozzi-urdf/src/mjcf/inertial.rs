//! `<inertial>`, and the compiler's corrections of inertias.

use super::Model;
use super::attributes::Item;
use super::orientation::{ORIENTATIONS, pose};
use super::vocabulary;
use crate::report::finding::Finding;
use crate::report::places::Place;
use crate::text::context::Context;
use crate::text::element::Element;
use mozzi::linalg::Sym3;
use mozzi::{SpatialInertia, Vec3};
use nalgebra::{Matrix3, SymmetricEigen};

impl Model<'_> {
    /// The inertia in the body's frame, and the centre of mass, which a mass of 0 has too.
    pub fn inertial(&self, item: &Item, place: &mut Place, cx: &mut Context) -> (SpatialInertia, Vec3) {
        item.element.check_attributes(&vocabulary::INERTIAL, cx);
        item.element.check_children(&vocabulary::INERTIAL, cx);
        item.element.required("pos", cx);
        let T = pose(item, &self.compiler, cx);
        for (name, check) in [("mass", "mass"), ("diaginertia", "inertia"), ("fullinertia", "inertia")] {
            if let Some(value) = item.value(name) {
                place.set(check, value.span);
            }
        }
        let mass = match item.element.required("mass", cx) {
            Some(_) => item.number("mass", 0.0, cx),
            None => {
                // checks of a body without mass would only repeat the error
                place.report("mass");
                place.report("inertia");
                0.0
            }
        };
        let (diagonal, full) = (item.has("diaginertia"), item.has("fullinertia"));
        let turned = ORIENTATIONS.into_iter().find(|name| item.has(name));
        if let (true, Some(name)) = (full, turned) {
            let message = format!("has both fullinertia and {name}, expected one of them");
            cx.findings.add(item.error("several_orientations", name, &message));
        }
        let (subject, span) = (&item.element.subject, item.element.span());
        if diagonal && full {
            let message = format!("{subject}: has both diaginertia and fullinertia, expected one of them");
            cx.findings.error("missing_attribute", span, message);
        } else if !diagonal && !full {
            let message = format!("{subject}: has neither diaginertia nor fullinertia: the moments are 0");
            let help = "as in MuJoCo, it is a point mass; write diaginertia=\"0 0 0\" if that is meant";
            cx.findings.add(Finding::warning("missing_attribute", span, message).help(help));
        }
        let I = if let Some([xx, yy, zz, xy, xz, yz]) = item.vector::<6>("fullinertia", cx) {
            Sym3 { xx, xy, xz, yy, yz, zz }
        } else {
            let [x, y, z] = item.vector::<3>("diaginertia", cx).unwrap_or([0.0; 3]);
            place.turned = Some(T.R);
            Sym3::diagonal(x, y, z).congruence(T.R.matrix())
        };
        (SpatialInertia::new(mass, T.p, I), T.p)
    }

    /// The inertia after the compiler's bounds and balancing, if set; `center` is the centre of mass.
    pub fn bounded(&self, given: SpatialInertia, center: Vec3, body: &Element) -> SpatialInertia {
        let compiler = self.compiler.of(body);
        let (bound, mass) = (compiler.bound_inertia, given.mass.max(compiler.bound_mass));
        let verdict = given.verdict();
        if given.mass < 0.0
            || verdict.principal_moments.iter().any(|&moment| moment < -1e-12 * verdict.principal_moments[2])
        {
            return given; // an error is not repaired silently
        }
        let is_low = bound > 0.0 && verdict.principal_moments.iter().any(|&moment| moment < bound);
        let is_unbalanced = compiler.balance && !verdict.is_physical();
        if mass == given.mass && !is_low && !is_unbalanced {
            return given;
        }
        let mut I = given.about_center_of_mass();
        if is_low {
            let rows = I.to_mat3().rows();
            let Some(mut eigen) = SymmetricEigen::try_new(Matrix3::from_fn(|i, j| rows[i][j]), f64::EPSILON, 1000)
            else {
                return given; // not finite, which the checks report
            };
            eigen.eigenvalues.iter_mut().for_each(|moment| *moment = moment.max(bound));
            let raised = eigen.recompose();
            let entry = |i: usize, j: usize| 0.5 * (raised[(i, j)] + raised[(j, i)]);
            let (xx, xy, xz) = (entry(0, 0), entry(0, 1), entry(0, 2));
            I = Sym3 { xx, xy, xz, yy: entry(1, 1), yz: entry(1, 2), zz: entry(2, 2) };
        }
        let raised = SpatialInertia::new(mass, center, I);
        if compiler.balance && !raised.verdict().is_physical() {
            let mean = I.trace() / 3.0;
            return SpatialInertia::new(mass, center, Sym3::diagonal(mean, mean, mean));
        }
        raised
    }
}

#[cfg(test)]
mod tests {
    /// M of the first joint, with the bounds of MuJoCo's table below.
    fn first(bodies: &str) -> f64 {
        let compiler = "<compiler boundmass='0.3' boundinertia='0.01'/>";
        let text = format!("<mujoco>{compiler}<worldbody>{bodies}</worldbody></mujoco>");
        let model = crate::parse("a.xml", &text).unwrap_or_else(|error| panic!("{error}")).description.build();
        let model = model.expect("sound");
        model.mass_matrix(&model.neutral_configuration::<f64>()).expect("M")[(0, 0)]
    }

    #[test]
    fn a_bounded_mass_without_a_place_is_where_mujoco_puts_it() {
        let joint = "<joint axis='0 0 1' pos='0.5 0 0'/>";
        let body = |pose: &str, rest: &str| format!("<body name='a' {pose}>{joint}{rest}</body>");
        let at = "pos='1 2 3'";
        // MuJoCo 4.0's mj_fullM
        for (bodies, expected) in [
            (body(at, ""), 1.285),
            (body("pos='1 2 3' euler='30 20 10'", ""), 1.285),
            (format!("<frame pos='1 0 0' euler='0 90 0'>{}</frame>", body(at, "")), 1.285),
            (body(at, "<geom size='.1' mass='0' pos='0 0 .2'/>"), 1.285),
            (body(at, "<geom size='.1' mass='1e-10' pos='0 0 .2'/>"), 0.085),
            (body(at, "<inertial pos='0.1 0 0' mass='0' diaginertia='0 0 0'/>"), 0.058),
            (body(at, "<geom size='.1' mass='4'/><body pos='1 0 0'/>"), 4.0 * 0.25 + 0.016 + 0.3 * 2.25 + 0.01),
            (
                body(at, "<geom size='.1' mass='4'/><body pos='1 0 0' euler='0 0 90'/>"),
                4.0 * 0.25 + 0.016 + 0.3 * 1.25 + 0.01,
            ),
        ] {
            assert!((first(&bodies) - expected).abs() < 1e-9, "{bodies}: {}, expected {expected}", first(&bodies));
        }
        // about the world's x-axis, of a free body that carries another one
        let free = "<body name='a' pos='1 2 3' euler='0 0 45'><freejoint/><body pos='1 0 0'><geom size='.1' mass='4'/>\
                    </body></body>";
        assert!((first(free) - (0.3 * 13.0 + 0.01 + 0.016)).abs() < 1e-9, "{}", first(free));
    }
}
