//! A quadruped falls onto its feet: ANYmal with a floating base, and its momentum balance.
//!
//! The base's configuration T_sb comes first among the positions, its twist 𝒱_b first among the velocities, the wrench
//! on it first among the forces; no motor drives it, so those six forces are 0. Only external forces change the total
//! momentum: gravity at the centre of mass, and the ground at the feet:
//!
//! > ḣ = (0, m g) + Σ F_ground, about the centre of mass, whatever the twelve motors do
//!
//! h is Σ [Ad]ᵀ𝒢𝒱 over the links. The balance is checked in two plots: ḣ at each time against the forces at that time,
//! and h(t) − h(0) against the time integral of the forces.

use mozzi::{FrameId, Model, Vec3, Wrench};
use mozzi_examples::{agree, row};
use mozzi_sim::{Input, Options};
use std::error::Error;

/// Hip, thigh and knee of the legs LF, LH, RF, RH, as the file has them.
const STANCE: [f64; 12] = [-0.1, 0.7, -1.0, -0.1, -0.7, 1.0, 0.1, 0.7, -1.0, 0.1, -0.7, 1.0];
const DURATION: f64 = 0.6;
const STEPS: usize = 6000;

/// Motors that hold the stance, and the ground at z = 0 under the feet.
struct Legs<'m> {
    model: &'m Model,
    feet: Vec<FrameId>,
}

impl Legs<'_> {
    /// The force of the ground on a foot, in {s} axes: a damped spring, and friction against sliding.
    fn ground(&self, theta: &[f64], dtheta: &[f64], foot: FrameId) -> Result<(Vec3, Vec3), mozzi::Error> {
        let T = self.model.forward_kinematics(theta, foot)?;
        let V_b = &self.model.body_jacobian(theta, foot)? * dtheta;
        let Vec3([vx, vy, vz]) = T.R.matrix() * V_b.v;
        let depth = -T.p.0[2];
        let normal = if depth > 0.0 { (2e4 * depth - 400.0 * vz).max(0.0) } else { 0.0 };
        let grip = 0.7 * normal / (vx * vx + vy * vy + 0.09).sqrt();
        Ok((T.p, Vec3([-grip * vx, -grip * vy, normal])))
    }
}

impl Input for &Legs<'_> {
    fn torque(&mut self, _: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), mozzi_sim::Error> {
        for (j, stance) in STANCE.iter().enumerate() {
            tau[6 + j] = 150.0 * (stance - theta[7 + j]) - 5.0 * dtheta[6 + j];
        }
        Ok(())
    }

    fn applied(
        &mut self,
        _: f64,
        theta: &[f64],
        dtheta: &[f64],
        wrenches: &mut Vec<(FrameId, Wrench)>,
    ) -> Result<(), mozzi_sim::Error> {
        for &foot in &self.feet {
            let R = self.model.forward_kinematics(theta, foot)?.R;
            let (_, f) = self.ground(theta, dtheta, foot)?;
            // mozzi's wrenches are applied by the robot to the environment: the negative of the ground's force on it
            wrenches.push((foot, Wrench { m: Vec3::zero(), f: -R.inverse_mul(f) }));
        }
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let anymal = mozzi_urdf::open("anymal")?.description.floating().build()?;
    let feet = ["LF_FOOT", "LH_FOOT", "RF_FOOT", "RH_FOOT"].map(|name| anymal.frame(name));
    let legs = Legs { model: &anymal, feet: feet.into_iter().collect::<Result<_, _>>()? };
    println!("ANYmal, {:.2} kg: {} positions, {} velocities.", anymal.mass(), anymal.nq(), anymal.n());

    let mut theta = anymal.neutral_configuration();
    theta[..7].copy_from_slice(&[0.995, 0.06, 0.08, 0.0, 0.0, 0.0, 0.65]); // tilted, 0.65 m up
    theta[7..].copy_from_slice(&STANCE);
    let mut dtheta = vec![0.0; anymal.n()];
    dtheta[..6].copy_from_slice(&[0.5, -0.3, 0.0, 0.4, 0.0, 0.0]);
    let fall = mozzi_sim::simulate(&anymal, &theta, &dtheta, &legs, &Options::new(DURATION, STEPS))?;

    let weight = Wrench { m: Vec3::zero(), f: anymal.gravity() * anymal.mass() };
    let start = anymal.momentum(&theta, &dtheta, Vec3::zero())?;
    let (mut impulse, mut before, mut worst) = (Wrench::zero(), None, 0.0_f64);
    println!("\nmomentum, linear (N s) and about the centre of mass (N m s):");
    println!("{:>6} {:>8}   {:29}  {:29}  {:>9}", "t (s)", "c_z (m)", "linear", "angular", "ground N");
    for (k, now) in fall.samples().enumerate() {
        let c = anymal.center_of_mass(now.theta)?;
        let grounds: Result<Vec<_>, _> =
            legs.feet.iter().map(|&foot| legs.ground(now.theta, now.dtheta, foot)).collect();
        let grounds = grounds?;
        let total = grounds.iter().fold(Vec3::zero(), |sum, &(_, f)| sum + f);
        // about the origin of {s}: each foot's force with its lever arm, and the weight with that of the centre of mass
        let pushed = grounds
            .iter()
            .fold(Wrench { m: c.cross(weight.f), f: weight.f }, |sum, &(p, f)| sum + Wrench { m: p.cross(f), f });
        let rate = anymal.momentum_rate(now.theta, now.dtheta, now.ddtheta, Vec3::zero())?;
        worst = worst.max((rate - pushed).norm() / (weight.norm() + pushed.norm()));
        if let Some((t, last)) = before {
            impulse += (pushed + last) * (0.5 * (now.t - t));
        }
        before = Some((now.t, pushed));
        if k % (STEPS / 12) == 0 {
            let h = anymal.momentum(now.theta, now.dtheta, c)?;
            println!("{:6.2} {:8.4}   {}  {}  {:9.1}", now.t, c.0[2], row(&h.f.0), row(&h.m.0), total.0[2]);
        }
    }
    println!();
    agree("ḣ and the forces, at the worst time", &[1.0 + worst], &[1.0], 1e-11);
    let end = anymal.momentum(fall.last().theta, fall.last().dtheta, Vec3::zero())?;
    // the forces are discontinuous when a foot touches the ground; the trapezoidal rule assumes that they are
    // continuous
    agree("h(t) − h(0) and the impulses", &(end - start).to_array(), &impulse.to_array(), 5e-3);
    println!(
        "\n(the energies' books are out by {:.1e} J of up to {:.0} J)",
        fall.largest_drift(),
        fall.largest_kinetic_energy()
    );
    assert!(fall.last().theta[6] > 0.3, "it stands");
    Ok(())
}
