//! Manipulability and force ellipses in a plane, at some configurations.

use crate::figure::{Curve, Figure, Panel, Stroke};
use crate::text::digits;
use mozzi::model::{Freedom, Place};
use mozzi::nalgebra::{DMatrix, Matrix2, SymmetricEigen, U2, Vector2};
use mozzi::{Error, FrameId, Model, Vec3};
use mozzi_urdf::counted;

/// The drawn length of a velocity of 1 m/s, in m.
const METRES: f64 = 0.25;
const CORNERS: usize = 96;

/// Two axes of {s}.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// From above.
    Xy,
    /// From the side.
    Xz,
    /// From the front.
    Yz,
}

impl Plane {
    fn axes(self) -> [usize; 2] {
        match self {
            Plane::Xy => [0, 1],
            Plane::Xz => [0, 2],
            Plane::Yz => [1, 2],
        }
    }

    fn of(self, p: Vec3) -> [f64; 2] {
        self.axes().map(|axis| p.0[axis])
    }
}

/// At each configuration the robot's links up to a frame, and at its origin two ellipses of this plane of {s}: of
/// velocities, { J_v θ̇ : ‖θ̇‖ = 1 }, and of forces, { f : ‖J_vᵀf‖ = 1 }, J_v being the two rows of the plane; a
/// floating base and free joints are held. The force ellipse is scaled to the size of the other, as the legend states,
/// and omitted if J_v is singular.
///
/// # Errors
/// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
pub fn ellipsoids(model: &Model, configurations: &[Vec<f64>], frame: FrameId, plane: Plane) -> Result<Figure, Error> {
    let (mut links, mut ellipses) = (Vec::new(), Vec::new());
    let driven = || model.places().iter().filter(|place| place.freedom != Freedom::Free).flat_map(Place::velocities);
    for theta in configurations {
        let tip = model.forward_kinematics(theta, frame)?;
        links.push(chain(model, theta, frame)?.iter().map(|&p| plane.of(p)).collect::<Vec<_>>());
        let J = model.body_jacobian(theta, frame)?;
        let columns = driven().map(|j| plane.of(tip.R * J.0[j].v));
        let flat: Vec<f64> = columns.flatten().collect();
        let J_v = DMatrix::from_column_slice(2, flat.len() / 2, &flat);
        let gram = &J_v * J_v.transpose();
        let gram = Matrix2::new(gram[(0, 0)], gram[(0, 1)], gram[(1, 0)], gram[(1, 1)]);
        ellipses.push((Vector2::from(plane.of(tip.p)), SymmetricEigen::new(gram)));
    }
    let regular = |gram: &Gram| sigma(gram).min() > 1e-6 * sigma(gram).max();
    let most = |size: &dyn Fn(&Gram) -> f64| ellipses.iter().map(|(_, gram)| size(gram)).fold(0.0, f64::max);
    let fastest = most(&|gram| sigma(gram).max());
    let strongest = most(&|gram| if regular(gram) { 1.0 / sigma(gram).min() } else { 0.0 });
    let metres_a_newton = if strongest > 0.0 { METRES * fastest / strongest } else { 0.0 };
    let velocity = format!("velocities at ‖θ̇‖ = 1: 1 m/s is {METRES} m long");
    let force = format!("forces at ‖τ‖ = 1: 1 N is {} m long", digits(metres_a_newton, 2));
    let mut curves = Vec::new();
    for (points, (center, eigen)) in links.into_iter().zip(&ellipses) {
        curves.push(Curve { points, color: 8, stroke: Stroke::Links, ..Curve::default() });
        let axes = sigma(eigen);
        let mut add = |name: &str, color, lengths: Vector2<f64>| {
            let corner = |k: usize| {
                let (sine, cosine) = (std::f64::consts::TAU * k as f64 / CORNERS as f64).sin_cos();
                let p = center + eigen.eigenvectors * Vector2::new(lengths[0] * cosine, lengths[1] * sine);
                [p.x, p.y]
            };
            let points = (0..CORNERS).map(corner).collect();
            curves.push(Curve { name: name.to_string(), color, stroke: Stroke::Filled, points });
        };
        add(&velocity, 6, axes.map(|sigma| METRES * sigma));
        if regular(eigen) {
            add(&force, 1, axes.map(|sigma| metres_a_newton / sigma));
        }
    }
    let [x, y] = plane.axes().map(|axis| format!("{} [m]", ["x", "y", "z"][axis]));
    let panel = Panel { x_label: x, y_label: y, equal: true, curves, ..Panel::default() };
    let singular = ellipses.iter().filter(|(_, gram)| !regular(gram)).count();
    let without = match singular {
        0 => String::new(),
        _ => format!("; {} without an ellipsoid of forces", counted(singular, "singular position")),
    };
    let title = format!("{}, at {}{without}", model.description().name, model.frame_name(frame));
    Ok(Figure { title, panels: vec![panel], columns: 1 })
}

/// The eigenvalues and principal axes of J_v J_vᵀ.
type Gram = SymmetricEigen<f64, U2>;

/// The singular values of J_v: semi-axes of velocities; those of forces are 1/σ.
fn sigma(gram: &Gram) -> Vector2<f64> {
    gram.eigenvalues.map(|value| value.max(0.0).sqrt())
}

/// The origins of the moving links that carry a frame, base first, then the frame's own.
fn chain(model: &Model, theta: &[f64], frame: FrameId) -> Result<Vec<Vec3>, Error> {
    let robot = model.description();
    let name = model.frame_name(frame);
    let mut link = robot.frames.iter().find(|known| known.name == name).map_or(name, |known| &known.link);
    let mut points = vec![model.forward_kinematics(theta, frame)?.p];
    while let Some(joint) = robot.joints.iter().find(|joint| joint.child == link) {
        points.push(model.forward_kinematics(theta, model.frame(link)?)?.p);
        link = &joint.parent;
    }
    points.push(model.forward_kinematics(theta, model.frame(link)?)?.p);
    points.reverse();
    points.dedup_by(|a, b| (*a - *b).dot(*a - *b) < 1e-18);
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ellipses_are_the_images_of_unit_rates_and_torques() {
        let model = mozzi_urdf::open("two_link_planar").and_then(mozzi_urdf::Loaded::build).expect("embedded");
        let tip = model.end_effector().expect("a chain");
        let theta = vec![0.4, 0.9];
        let figure = ellipsoids(&model, &[theta.clone(), vec![0.0, 0.0]], tip, Plane::Xz).expect("a figure");
        let panel = &figure.panels[0];
        // links, two ellipses; stretched out: links, one ellipse
        assert_eq!(panel.curves.len(), 5);
        assert!(figure.title.ends_with("; 1 singular position without an ellipsoid of forces"), "{}", figure.title);
        let pose = model.forward_kinematics(&theta, tip).expect("a pose");
        let J = model.body_jacobian(&theta, tip).expect("J").0.into_iter().map(|column| pose.R * column.v);
        let J: Vec<Vec3> = J.collect();
        let det = J[0].0[0] * J[1].0[2] - J[1].0[0] * J[0].0[2];
        let mut scale = 0.0;
        for k in 0..CORNERS {
            let [x, z] = [0, 1].map(|side| panel.curves[1].points[k][side] - pose.p.0[2 * side]);
            // θ̇ = J⁻¹v is of length 1
            let v = [x / METRES, z / METRES];
            let rates = [(J[1].0[2] * v[0] - J[1].0[0] * v[1]) / det, (J[0].0[0] * v[1] - J[0].0[2] * v[0]) / det];
            assert!((rates[0].hypot(rates[1]) - 1.0).abs() < 1e-12, "{rates:?}");
            // τ = Jᵀf has constant length
            let [x, z] = [0, 1].map(|side| panel.curves[2].points[k][side] - pose.p.0[2 * side]);
            let torque = (J[0].0[0] * x + J[0].0[2] * z).hypot(J[1].0[0] * x + J[1].0[2] * z);
            scale = if k == 0 { torque } else { scale };
            assert!((torque / scale - 1.0).abs() < 1e-12);
        }
        assert_eq!(panel.curves[0].points.last(), Some(&[pose.p.0[0], pose.p.0[2]]));
    }

    #[test]
    fn free_joints_are_held() {
        let model: Model = crate::testing::balls().build().expect("sound");
        let theta = vec![model.neutral_configuration()];
        let curves = |link: &str| {
            let frame = model.frame(link).expect("a link");
            ellipsoids(&model, &theta, frame, Plane::Xy).expect("a figure").panels[0].curves.len()
        };
        // links and both ellipses; links and a point
        assert_eq!((curves("hand"), curves("drone")), (3, 2));
    }

    #[test]
    fn two_digits_are_shown() {
        assert_eq!([0.123, 0.00456, 12.3, 0.0].map(|x| digits(x, 2)), ["0.12", "0.0046", "12", "0"]);
    }
}
