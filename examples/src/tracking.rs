//! Helpers shared by the controller examples: two arms, a motion for each, and the tracking errors, without and with a
//! load that is missing in the controller's model.

use crate::chart::{Curve, chart};
use mozzi::model::difference;
use mozzi::{FrameId, Model, SpatialInertia, Vec3};
use mozzi_motion::Policy;
use mozzi_motion::controllers::{Saturated, tracking_error};
use mozzi_motion::trajectories::{Line, Profile, Reference, Timed};
use mozzi_sim::{Input, Options};
use std::error::Error;

/// The load in the hand that the controller's model lacks, kg.
const LOADS: [f64; 2] = [0.0, 2.0];

/// An arm with a desired motion.
pub struct Arm {
    /// "UR5" or "Panda".
    pub name: &'static str,
    /// Without a load.
    pub model: Model,
    /// The frame of its hand.
    pub tool: FrameId,
    from: Vec<f64>,
    to: Vec<f64>,
}

impl Arm {
    /// The UR5, and the Panda with its fingers locked.
    pub fn both() -> Result<[Arm; 2], Box<dyn Error>> {
        let ur5 = mozzi_urdf::open("ur5")?.build()?;
        let panda = mozzi_urdf::open("panda")?.build()?.with_locked_joints(&[("panda_finger_joint1", 0.02)])?;
        let (from, to) = (vec![0.3, -1.4, 1.6, -0.6, 0.9, 0.5], vec![1.1, -0.9, 1.0, -0.1, 1.4, -0.3]);
        let ur5 = Arm { name: "UR5", tool: ur5.frame("tool0")?, model: ur5, from, to };
        let (from, to) = (vec![0.3, -0.5, 0.2, -2.0, 0.4, 1.8, 0.7], vec![-0.3, 0.1, 0.5, -1.5, 0.1, 1.4, 0.1]);
        let panda = Arm { name: "Panda", tool: panda.frame("panda_hand")?, model: panda, from, to };
        Ok([ur5, panda])
    }

    /// A straight line of the joints in 1.2 s, and 0.6 s to settle.
    pub fn motion(&self) -> Result<Timed<Line<'_>>, mozzi_motion::Error> {
        Ok(Timed::new(Line::new(&self.model, &self.from, &self.to)?, Profile::quintic(1.2)?))
    }

    /// Simulates the arm with a load in its hand, under a controller whose model lacks the load.
    pub fn follow(&self, load: f64, motors: impl Input) -> Result<mozzi_sim::Trajectory, Box<dyn Error>> {
        let mut robot = self.model.clone();
        if load > 0.0 {
            robot = robot.with_payload(self.tool, SpatialInertia::point_mass(load, Vec3([0.0, 0.0, 0.05])))?;
        }
        let motors = Saturated::new(&robot, motors, Policy::Respect);
        let start = self.motion()?.at(0.0).theta;
        Ok(mozzi_sim::simulate(&robot, &start, &vec![0.0; robot.n()], motors, &Options::new(1.8, 600))?)
    }
}

/// Both arms under a controller, without and with an unknown load: a table of errors, an SVG file each, and the errors
/// `[[UR5, loaded], [Panda, loaded]]`: the largest |θ_d ⊖ θ| of any joint.
pub fn both_loads<'a, I: Input + 'a>(
    arms: &'a [Arm; 2],
    name: &str,
    controller: impl Fn(&'a Arm) -> Result<I, Box<dyn Error>>,
) -> Result<[[f64; 2]; 2], Box<dyn Error>> {
    let mut errors = [[0.0; 2]; 2];
    println!("{name}, largest error of any joint, and the largest root of a mean square:");
    for (arm, errors) in arms.iter().zip(&mut errors) {
        let (mut curves, motion): (Vec<Curve>, _) = (Vec::new(), arm.motion()?);
        for (load, error) in LOADS.into_iter().zip(errors) {
            let followed = arm.follow(load, controller(arm)?)?;
            let found = tracking_error(&arm.model, &followed, &motion);
            println!("  {:6} with {load} kg: {:.2e} rad, {:.2e} rad", arm.name, found.worst(), found.worst_rms());
            *error = found.worst();
            let mut e = vec![0.0; arm.model.n()];
            let points = followed.samples().step_by(5).map(|row| {
                difference(&arm.model, row.theta, &motion.at(row.t).theta, &mut e);
                [row.t, e.iter().fold(0.0_f64, |m, x| m.max(x.abs()))]
            });
            curves.push((format!("{load} kg unknown"), points.collect()));
        }
        let file = std::env::current_dir()?.join(format!("{}_{}.svg", name.replace(' ', "_"), arm.name.to_lowercase()));
        std::fs::write(&file, chart(&format!("{}: {name}", arm.name), "largest |θ_d − θ| of any joint, rad", &curves))?;
        println!("  drawn to {}", file.display());
    }
    Ok(errors)
}
