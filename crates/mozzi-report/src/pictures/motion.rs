//! Figures of a motion: over time, and in phase.

use crate::error::Error;
use crate::figure::{Curve, Figure, Panel, Stroke};
use crate::motion::Motion;
use mozzi::Model;
use mozzi::model::{Freedom, Place, description};
use std::ops::Range;

/// An independent joint: its name, its index, the place of its numbers, whether it slides.
struct Joint<'m> {
    name: &'m str,
    k: usize,
    place: Place,
    slides: bool,
}

impl Joint<'_> {
    fn has_one_axis(&self) -> bool {
        self.place.freedom == Freedom::One
    }
}

fn joints(model: &Model) -> Vec<Joint<'_>> {
    let joint =
        |(k, (joint, place)): (usize, (&'_ description::Joint, &Place))| (k, *place, joint.kind.name() == "prismatic");
    let kinds: Vec<_> = model.joints().zip(model.places()).enumerate().map(joint).collect();
    model.joint_names().zip(kinds).map(|(name, (k, place, slides))| Joint { name, k, place, slides }).collect()
}

/// The numbers of a joint that a row contains.
#[derive(Clone, Copy, PartialEq)]
enum Entries {
    Positions,
    Velocities,
}

impl Entries {
    fn of(self, place: &Place) -> Range<usize> {
        match self {
            Entries::Positions => place.positions(),
            Entries::Velocities => place.velocities(),
        }
    }

    fn names(self, model: &Model) -> Vec<&str> {
        match self {
            Entries::Positions => model.position_names().collect(),
            Entries::Velocities => model.velocity_names().collect(),
        }
    }
}

/// A quantity of a motion: its symbol, its units for turning and sliding joints, and its two parts for balls and free
/// joints, each with its length.
struct Quantity<'m> {
    symbol: &'static str,
    units: [&'static str; 2],
    parts: [(&'static str, usize); 2],
    entries: Entries,
    rows: Option<&'m Vec<f64>>,
}

fn quantities(motion: &Motion) -> [Quantity<'_>; 4] {
    let of = |symbol, units, parts, rows| Quantity { symbol, units, parts, entries: Entries::Velocities, rows };
    let (dtheta, ddtheta, tau) = (motion.dtheta.as_ref(), motion.ddtheta.as_ref(), motion.tau.as_ref());
    [
        Quantity {
            entries: Entries::Positions,
            ..of("θ", ["rad", "m"], [("quaternion", 4), ("p [m]", 3)], Some(&motion.theta))
        },
        of("θ̇", ["rad/s", "m/s"], [("ω [rad/s]", 3), ("v [m/s]", 3)], dtheta),
        of("θ̈", ["rad/s²", "m/s²"], [("ω̇ [rad/s²]", 3), ("v̇ [m/s²]", 3)], ddtheta),
        of("τ", ["N m", "N"], [("m [N m]", 3), ("f [N]", 3)], tau),
    ]
}

/// Entry k of each row.
fn column(rows: &[f64], width: usize, k: usize) -> impl Iterator<Item = f64> {
    rows.chunks(width.max(1)).map(move |row| row[k])
}

/// θ, θ̇, θ̈ and τ of the joints over time, if known; turning and sliding joints in separate panels. Balls and free
/// joints have panels of their own: quaternion and origin, angular and linear velocity, moment and force. A floating
/// base is not shown.
///
/// # Errors
/// [`Error::Motion`] if the rows are not as long as this robot's.
pub fn trajectories(model: &Model, motion: &Motion) -> Result<Figure, Error> {
    motion.check(model)?;
    let joints = joints(model);
    let mut panels = Vec::new();
    for Quantity { symbol, units, parts, entries, rows } in quantities(motion) {
        let Some(rows) = rows else { continue };
        let names = entries.names(model);
        let curve = |k: usize, color: usize| {
            let values = column(rows, names.len(), k);
            Curve::line(names[k], color, motion.t.iter().copied().zip(values).map(|(t, x)| [t, x]).collect())
        };
        let mut add = |y_label: String, curves: Vec<Curve>| {
            if !curves.is_empty() {
                panels.push(Panel { x_label: "t [s]".into(), y_label, curves, ..Panel::default() });
            }
        };
        for (slides, unit) in [false, true].into_iter().zip(units) {
            let of_kind = joints.iter().filter(|joint| joint.has_one_axis() && joint.slides == slides);
            let curves = of_kind.map(|joint| curve(entries.of(&joint.place).start, joint.k));
            add(format!("{symbol} [{unit}]"), curves.collect());
        }
        for joint in joints.iter().filter(|joint| !joint.has_one_axis()) {
            let mut entries = entries.of(&joint.place);
            for (part, length) in parts {
                let curves = entries.by_ref().take(length).enumerate().map(|(color, k)| curve(k, color));
                add(format!("{} {part}", joint.name), curves.collect());
            }
        }
    }
    Ok(Figure { title: motion.title.clone(), panels, columns: 1 })
}

/// 𝒦, 𝒫 and their sum over time; below them the drift, if it is known.
///
/// # Errors
/// [`Error::Motion`] as [`trajectories`], and if no energy is known.
pub fn energy(model: &Model, motion: &Motion) -> Result<Figure, Error> {
    motion.check(model)?;
    let over_time = |values: &[f64]| motion.t.iter().zip(values).map(|(&t, &x)| [t, x]).collect::<Vec<_>>();
    let (kinetic, potential) = (motion.kinetic_energy.as_deref(), motion.potential_energy.as_deref());
    let total = kinetic.zip(potential).map(|(K, P)| K.iter().zip(P).map(|(K, P)| K + P).collect::<Vec<_>>());
    let named = [("kinetic", kinetic, 1), ("potential", potential, 0), ("total", total.as_deref(), 2)];
    let curves: Vec<Curve> = (named.into_iter())
        .filter_map(|(name, values, color)| Some(Curve::line(name, color, over_time(values?))))
        .collect();
    if curves.is_empty() {
        let rows = motion.t.len();
        return Err(Error::Motion {
            what: "kinetic and potential energy",
            found: 0,
            expected: 2 * rows,
            rows,
            width: 2,
        });
    }
    let panel =
        |y_label: &str, curves| Panel { x_label: "t [s]".into(), y_label: y_label.into(), curves, ..Panel::default() };
    let mut panels = vec![panel("energy [J]", curves)];
    if let Some(drift) = &motion.drift {
        panels.push(panel("drift [J]", vec![Curve::line("", 3, over_time(drift))]));
    }
    Ok(Figure { title: motion.title.clone(), panels, columns: 1 })
}

/// θ̇ over θ, a panel for each joint of one axis: the velocities of balls and free joints are not the rates of their
/// positions.
///
/// # Errors
/// [`Error::Motion`] as [`trajectories`], and if velocities are not known.
pub fn phase(model: &Model, motion: &Motion) -> Result<Figure, Error> {
    motion.check(model)?;
    let (rows, width) = (motion.t.len(), model.n());
    let Some(dtheta) = &motion.dtheta else {
        return Err(Error::Motion { what: "dtheta", found: 0, expected: rows * width, rows, width });
    };
    let panel = |joint: Joint| {
        let theta = column(&motion.theta, model.nq(), joint.place.q);
        let rate = column(dtheta, width, joint.place.j);
        let unit = if joint.slides { "m" } else { "rad" };
        let points: Vec<[f64; 2]> = theta.zip(rate).map(|(x, v)| [x, v]).collect();
        let first = points.iter().take(1).copied().collect();
        let start = Curve { name: "start".into(), color: 9, stroke: Stroke::Rings, points: first };
        Panel {
            x_label: format!("{} [{unit}]", joint.name),
            y_label: format!("θ̇ [{unit}/s]"),
            curves: vec![Curve::line("", joint.k, points), start],
            ..Panel::default()
        }
    };
    let panels: Vec<Panel> = joints(model).into_iter().filter(Joint::has_one_axis).map(panel).collect();
    let columns = panels.len().clamp(1, 3);
    Ok(Figure { title: motion.title.clone(), panels, columns })
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi_sim::{Options, Zero};

    fn fall(name: &str) -> (Model, Motion) {
        let model = mozzi_urdf::open(name).and_then(mozzi_urdf::Loaded::build).expect("embedded");
        let theta = model.neutral_configuration::<f64>();
        let fall = mozzi_sim::simulate(&model, &theta, &vec![0.1; model.n()], Zero, &Options::new(0.05, 10))
            .expect("a motion");
        (model, Motion::simulated("let go", &fall))
    }

    #[test]
    fn curves_are_the_motions_columns() {
        let (model, motion) = fall("panda");
        let figure = trajectories(&model, &motion).expect("a figure");
        let labels: Vec<&str> = figure.panels.iter().map(|panel| panel.y_label.as_str()).collect();
        assert_eq!(labels, ["θ [rad]", "θ [m]", "θ̇ [rad/s]", "θ̇ [m/s]", "θ̈ [rad/s²]", "θ̈ [m/s²]", "τ [N m]", "τ [N]"]);
        let third = &figure.panels[2].curves[3];
        assert_eq!((third.name.as_str(), third.points.len()), ("panda_joint4", 11));
        let expected = motion.dtheta.as_ref().expect("known")[5 * 8 + 3];
        assert_eq!(third.points[5], [motion.t[5], expected]);
        let phases = phase(&model, &motion).expect("a figure");
        assert_eq!((phases.panels.len(), phases.columns), (8, 3));
        let curves = &phases.panels[3].curves;
        assert_eq!(curves[0].points[5], [motion.theta[5 * 8 + 3], expected]);
        assert_eq!((curves[1].name.as_str(), &curves[1].points), ("start", &curves[0].points[..1].to_vec()));
    }

    #[test]
    fn a_ball_and_a_free_joint_have_panels_of_their_own() {
        let model: Model = crate::testing::balls().build().expect("sound");
        let (n, nq) = (model.n(), model.nq());
        let row = |width: usize| (0..2 * width).map(|k| k as f64).collect::<Vec<_>>();
        let motion = Motion { t: vec![0.0, 1.0], theta: row(nq), dtheta: Some(row(n)), ..Motion::default() };
        let figure = trajectories(&model, &motion).expect("a figure");
        let panel = |label: &str| {
            let found = figure.panels.iter().find(|panel| panel.y_label == label);
            found.unwrap_or_else(|| panic!("no {label}"))
        };
        let place = |name: &str| {
            let k = model.joint_names().position(|known| known == name).expect("a joint");
            model.places()[k]
        };
        let check = |label: &str, names: &[&str], width: usize, first: usize| {
            let curves = &panel(label).curves;
            assert_eq!(curves.iter().map(|curve| curve.name.as_str()).collect::<Vec<_>>(), names);
            for (k, curve) in curves.iter().enumerate() {
                assert_eq!(curve.points[1], [1.0, (width + first + k) as f64], "{label}");
            }
        };
        let (ball, free) = (place("shoulder"), place("flight"));
        let quaternion = ["shoulder.qw", "shoulder.qx", "shoulder.qy", "shoulder.qz"];
        check("shoulder quaternion", &quaternion, nq, ball.q);
        check("shoulder ω [rad/s]", &["shoulder.wx", "shoulder.wy", "shoulder.wz"], n, ball.j);
        check("flight p [m]", &["flight.x", "flight.y", "flight.z"], nq, free.q + 4);
        check("flight v [m/s]", &["flight.vx", "flight.vy", "flight.vz"], n, free.j + 3);
        check("θ [m]", &["reach"], nq, place("reach").q);
        let hinges: Vec<&str> = panel("θ̇ [rad/s]").curves.iter().map(|curve| curve.name.as_str()).collect();
        assert_eq!(hinges, ["yaw", "elbow", "swivel"]);
        assert_eq!(panel("θ̇ [rad/s]").curves[1].points[1][1], (n + place("elbow").j) as f64);
        let phases = phase(&model, &motion).expect("a figure");
        assert_eq!((phases.panels.len(), phases.panels[1].x_label.as_str()), (4, "elbow [rad]"));
        assert_eq!(
            phases.panels[1].curves[0].points[1],
            [nq + place("elbow").q, n + place("elbow").j].map(|k| k as f64)
        );
    }

    #[test]
    fn total_energy_is_the_sum_and_what_is_not_known_is_named() {
        let (model, motion) = fall("double_pendulum");
        let figure = energy(&model, &motion).expect("a figure");
        let at = |k: usize| figure.panels[0].curves[k].points[7][1];
        assert_eq!((figure.panels.len(), at(0) + at(1)), (2, at(2)));
        let bare = Motion { dtheta: None, kinetic_energy: None, potential_energy: None, ..motion };
        let message = phase(&model, &bare).expect_err("no velocities").to_string();
        assert_eq!(message, "the motion has no dtheta, expected 22: 11 rows of 2");
        assert!(energy(&model, &bare).is_err());
    }
}
