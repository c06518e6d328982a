//! Figures of a motion: over time, and in phase.

use crate::error::Error;
use crate::figure::{Curve, Figure, Panel};
use crate::motion::Motion;
use mozzi::Model;

/// An independent joint: its name, its place among them, whether it slides.
struct Joint<'m> {
    name: &'m str,
    k: usize,
    slides: bool,
}

fn joints(model: &Model) -> Vec<Joint<'_>> {
    let joint = |(k, joint): (usize, &'_ mozzi::model::description::Joint)| (k, joint.kind.name() == "prismatic");
    let kinds: Vec<_> = model.joints().enumerate().map(joint).collect();
    model.joint_names().zip(kinds).map(|(name, (k, slides))| Joint { name, k, slides }).collect()
}

/// Entry k of each row.
fn column(rows: &[f64], width: usize, k: usize) -> impl Iterator<Item = f64> {
    rows.chunks(width.max(1)).map(move |row| row[k])
}

/// θ, θ̇, θ̈ and τ of the joints over time, as far as they are known; turning and sliding joints apart.
///
/// # Errors
/// [`Error::Motion`] where the rows are not as long as this robot's.
pub fn trajectories(model: &Model, motion: &Motion) -> Result<Figure, Error> {
    motion.check(model)?;
    let (joints, base) = (joints(model), model.base());
    let groups = [
        ("θ", ["rad", "m"], Some(&motion.theta), model.nq(), base.positions()),
        ("θ̇", ["rad/s", "m/s"], motion.dtheta.as_ref(), model.n(), base.velocities()),
        ("θ̈", ["rad/s²", "m/s²"], motion.ddtheta.as_ref(), model.n(), base.velocities()),
        ("τ", ["N m", "N"], motion.tau.as_ref(), model.n(), base.velocities()),
    ];
    let mut panels = Vec::new();
    for (symbol, units, rows, width, first) in groups {
        let Some(rows) = rows else { continue };
        for (slides, unit) in [false, true].into_iter().zip(units) {
            let of_kind = joints.iter().filter(|joint| joint.slides == slides);
            let curve = |joint: &Joint| {
                let values = column(rows, width, first + joint.k);
                Curve::line(joint.name, joint.k, motion.t.iter().copied().zip(values).map(|(t, x)| [t, x]).collect())
            };
            let curves: Vec<Curve> = of_kind.map(curve).collect();
            if !curves.is_empty() {
                panels.push(Panel {
                    x_label: "t [s]".into(),
                    y_label: format!("{symbol} [{unit}]"),
                    curves,
                    ..Panel::default()
                });
            }
        }
    }
    Ok(Figure { title: motion.title.clone(), panels, columns: 1 })
}

/// 𝒦, 𝒫 and their sum over time; below them the drift, where it is known.
///
/// # Errors
/// [`Error::Motion`] as [`trajectories`], and where no energy is known.
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

/// θ̇ over θ, a panel for each joint.
///
/// # Errors
/// [`Error::Motion`] as [`trajectories`], and where velocities are not known.
pub fn phase(model: &Model, motion: &Motion) -> Result<Figure, Error> {
    motion.check(model)?;
    let (rows, width) = (motion.t.len(), model.n());
    let Some(dtheta) = &motion.dtheta else {
        return Err(Error::Motion { what: "dtheta", found: 0, expected: rows * width, rows, width });
    };
    let panel = |joint: Joint| {
        let theta = column(&motion.theta, model.nq(), model.base().positions() + joint.k);
        let rate = column(dtheta, width, model.base().velocities() + joint.k);
        let unit = if joint.slides { "m" } else { "rad" };
        Panel {
            x_label: format!("{} [{unit}]", joint.name),
            y_label: format!("θ̇ [{unit}/s]"),
            curves: vec![Curve::line("", joint.k, theta.zip(rate).map(|(x, v)| [x, v]).collect())],
            ..Panel::default()
        }
    };
    let panels: Vec<Panel> = joints(model).into_iter().map(panel).collect();
    let columns = panels.len().clamp(1, 3);
    Ok(Figure { title: motion.title.clone(), panels, columns })
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::simulation::{Options, Zero};

    fn fall(name: &str) -> (Model, Motion) {
        let model = mozzi_urdf::open(name).and_then(mozzi_urdf::Loaded::build).expect("embedded");
        let theta = model.neutral_configuration::<f64>();
        let fall = model.simulate(&theta, &vec![0.1; model.n()], Zero, &Options::new(0.05, 10)).expect("a motion");
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
        assert_eq!(phases.panels[3].curves[0].points[5], [motion.theta[5 * 8 + 3], expected]);
    }

    #[test]
    fn total_energy_is_the_sum_and_what_is_not_known_is_named() {
        let (model, motion) = fall("double_pendulum");
        let figure = energy(&model, &motion).expect("a figure");
        let at = |k: usize| figure.panels[0].curves[k].points[7][1];
        assert_eq!((figure.panels.len(), at(0) + at(1)), (2, at(2)));
        let bare = Motion { dtheta: None, kinetic_energy: None, potential_energy: None, ..motion };
        let message = phase(&model, &bare).expect_err("no velocities").to_string();
        assert_eq!(message, "the motion's dtheta has 0 numbers, expected 22: 11 rows of 2");
        assert!(energy(&model, &bare).is_err());
    }
}
