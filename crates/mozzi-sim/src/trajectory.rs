//! The result of a simulation.

use crate::ContactForce;
use alloc::vec::Vec;
use mozzi::linalg::Vec3;
use mozzi::model::Model;

/// Energies and works, in joules. Work counts from the start of the simulation: W = ∫ power dt is a further component
/// of the state, integrated by the same method, and so of the same order, as the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// 𝒦 = ½ θ̇ᵀMθ̇.
    pub kinetic: f64,
    /// 𝒫 = −Σ m gᵀp, 0 for a mass at the base's origin.
    pub potential: f64,
    /// Done by the motors: ∫ θ̇ᵀτ dt.
    pub motor_work: f64,
    /// Dissipated in the joints: ∫ θ̇ᵀ(dθ̇ + μ sgn θ̇) dt ≥ 0.
    pub friction_loss: f64,
    /// Given to the environment: ∫ Σ 𝒱ᵀF dt.
    pub applied_work: f64,
}

impl Energy {
    /// E = 𝒦 + 𝒫.
    pub fn total(&self) -> f64 {
        self.kinetic + self.potential
    }

    /// The energy supplied to the robot: motors − friction − environment.
    pub fn supplied(&self) -> f64 {
        self.motor_work - self.friction_loss - self.applied_work
    }

    /// E − E_first − (motors − friction − environment), in joules: 0 up to the error of the integration.
    pub fn drift_since(&self, first: &Energy) -> f64 {
        self.total() - first.total() - self.supplied()
    }
}

/// A simulated motion: one row for each recorded time, row-major lists.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// Columns of θ.
    pub nq: usize,
    /// Columns of θ̇, θ̈ and τ.
    pub n: usize,
    /// Seconds.
    pub t: Vec<f64>,
    /// θ, rows of nq.
    pub theta: Vec<f64>,
    /// θ̇, rows of n.
    pub dtheta: Vec<f64>,
    /// θ̈, rows of n.
    pub ddtheta: Vec<f64>,
    /// The motors' τ, rows of n.
    pub tau: Vec<f64>,
    /// One for each row.
    pub energy: Vec<Energy>,
    /// The forces that contact points apply to planes, row after row: see [`Sample::contact_forces`].
    contact_forces: Vec<ContactForce>,
    /// Where those of each row end.
    ends: Vec<usize>,
    /// Steps taken.
    pub steps: usize,
    /// True if it reached t_f; false if the progress callback stopped it.
    pub complete: bool,
}

/// One row of a [`Trajectory`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<'a> {
    /// Seconds.
    pub t: f64,
    /// θ.
    pub theta: &'a [f64],
    /// θ̇.
    pub dtheta: &'a [f64],
    /// θ̈.
    pub ddtheta: &'a [f64],
    /// The motors' τ.
    pub tau: &'a [f64],
    /// Energies, and works since the start.
    pub energy: Energy,
    /// The forces that contact points apply to planes, where they are not 0, by their pairs: the mean over the step
    /// that ends at the row.
    pub contact_forces: &'a [ContactForce],
}

impl Sample<'_> {
    /// The sum of the contact forces: what the robot applies to the planes, in {s}, N.
    pub fn total_contact_force(&self) -> Vec3 {
        self.contact_forces.iter().fold(Vec3::zero(), |sum, force| sum + force.f)
    }

    /// The forces of these pairs, which ascend, in {s}, N: three numbers each, also where they are 0.
    pub fn forces_of(&self, pairs: impl IntoIterator<Item = usize>) -> Vec<f64> {
        let mut carrying = self.contact_forces.iter().peekable();
        let mut found = Vec::new();
        for pair in pairs {
            while carrying.next_if(|force| force.pair < pair).is_some() {}
            let f = carrying.peek().filter(|force| force.pair == pair).map_or(Vec3::zero(), |force| force.f);
            found.extend(f.0);
        }
        found
    }
}

impl Trajectory {
    /// For this robot, without rows: a [`Recorder`](crate::Recorder).
    pub fn new(model: &Model) -> Self {
        Trajectory {
            nq: model.nq(),
            n: model.n(),
            t: Vec::new(),
            theta: Vec::new(),
            dtheta: Vec::new(),
            ddtheta: Vec::new(),
            tau: Vec::new(),
            energy: Vec::new(),
            contact_forces: Vec::new(),
            ends: Vec::new(),
            steps: 0,
            complete: false,
        }
    }

    /// Adds a row.
    ///
    /// # Panics
    /// When the row does not have this robot's lengths.
    pub fn record(&mut self, row: Sample) {
        assert!(row.theta.len() == self.nq, "theta has {} entries, expected {}", row.theta.len(), self.nq);
        for list in [row.dtheta, row.ddtheta, row.tau] {
            assert!(list.len() == self.n, "a slice has {} entries, expected {}", list.len(), self.n);
        }
        self.t.push(row.t);
        self.contact_forces.extend(row.contact_forces);
        self.ends.push(self.contact_forces.len());
        self.theta.extend(row.theta);
        self.dtheta.extend(row.dtheta);
        self.ddtheta.extend(row.ddtheta);
        self.tau.extend(row.tau);
        self.energy.push(row.energy);
    }

    /// Keeps only rows 0, k, 2k, ….
    pub(crate) fn keep_every(&mut self, k: usize) {
        let (n, nq) = (self.n.max(1), self.nq.max(1));
        let thin = |list: &mut Vec<f64>, width: usize| {
            let mut entry = 0;
            list.retain(|_| {
                entry += 1;
                ((entry - 1) / width).is_multiple_of(k)
            });
        };
        let kept: Vec<_> = (0..self.len()).step_by(k).map(|row| self.forces_in(row).to_vec()).collect();
        self.contact_forces.clear();
        self.ends.clear();
        for forces in kept {
            self.contact_forces.extend(forces);
            self.ends.push(self.contact_forces.len());
        }
        thin(&mut self.t, 1);
        thin(&mut self.theta, nq);
        [&mut self.dtheta, &mut self.ddtheta, &mut self.tau].into_iter().for_each(|list| thin(list, n));
        let mut row = 0;
        self.energy.retain(|_| {
            row += 1;
            usize::is_multiple_of(row - 1, k)
        });
    }

    /// Removes all rows.
    pub(crate) fn clear(&mut self) {
        let lists = [&mut self.t, &mut self.theta, &mut self.dtheta, &mut self.ddtheta, &mut self.tau];
        lists.into_iter().for_each(Vec::clear);
        self.contact_forces.clear();
        self.ends.clear();
        self.energy.clear();
    }

    /// The number of rows.
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// Never true after a simulation: the start is always recorded.
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    /// Row k.
    ///
    /// # Panics
    /// When there is no row k.
    pub fn sample(&self, k: usize) -> Sample<'_> {
        Sample {
            t: self.t[k],
            theta: &self.theta[k * self.nq..(k + 1) * self.nq],
            dtheta: self.velocities(&self.dtheta, k),
            ddtheta: self.velocities(&self.ddtheta, k),
            tau: self.velocities(&self.tau, k),
            energy: self.energy[k],
            contact_forces: self.forces_in(k),
        }
    }

    fn forces_in(&self, row: usize) -> &[ContactForce] {
        let start = if row == 0 { 0 } else { self.ends[row - 1] };
        &self.contact_forces[start..self.ends[row]]
    }

    /// The pairs of a contact point and a plane that carry in at least one row, ascending.
    pub fn carrying(&self) -> Vec<usize> {
        let mut pairs: Vec<usize> = self.contact_forces.iter().map(|force| force.pair).collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    fn velocities<'a>(&self, list: &'a [f64], k: usize) -> &'a [f64] {
        &list[k * self.n..(k + 1) * self.n]
    }

    /// All rows, in the order of time.
    pub fn samples(&self) -> impl ExactSizeIterator<Item = Sample<'_>> {
        (0..self.len()).map(|k| self.sample(k))
    }

    /// The last row.
    pub fn last(&self) -> Sample<'_> {
        self.sample(self.len() - 1)
    }

    /// E(t) − E(0) − (motors − friction − environment) in row k, in joules: 0 up to the error of the integration. For a
    /// passive robot without friction it is E(t) − E(0).
    ///
    /// # Panics
    /// When there is no row k.
    pub fn drift(&self, k: usize) -> f64 {
        self.energy[k].drift_since(&self.energy[0])
    }

    /// max |drift| over the rows, in joules.
    pub fn largest_drift(&self) -> f64 {
        (0..self.len()).map(|k| self.drift(k).abs()).fold(0.0, f64::max)
    }

    /// max 𝒦 over the rows, in joules: a reference for the drift (𝒫 has no natural zero).
    pub fn largest_kinetic_energy(&self) -> f64 {
        self.energy.iter().map(|energy| energy.kinetic).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use crate::simulate;
    extern crate std;
    use crate::tests::robots::{INERTIA, double_pendulum, pendulum, smooth_tree};
    use crate::{Friction, Method, Options, Zero, torque};
    use mozzi::{Vec3, testing};

    const METHODS: [Method; 3] = [Method::Euler, Method::SemiImplicitEuler, Method::RungeKutta4];

    /// Largest drift over 2 s of a double pendulum let go from the horizontal, over its largest kinetic energy.
    fn relative_drift(method: Method, step: f64) -> f64 {
        let options = Options { method, ..Options::with_step(2.0, step).expect("fits") };
        let fall = simulate(&double_pendulum(), &[1.5, 0.0], &[0.0; 2], Zero, &options).expect("a motion");
        fall.largest_drift() / fall.largest_kinetic_energy()
    }

    #[test]
    fn drift_of_a_falling_double_pendulum() {
        for method in METHODS {
            let drifts = [1e-2, 5e-3, 2e-3, 1e-3, 1e-4].map(|step| (step, relative_drift(method, step)));
            let row = drifts.map(|(step, drift)| std::format!("{step:e}: {drift:.1e}"));
            std::println!("{:20} {row:?}", method.name());
            let ratio = drifts[2].1 / drifts[3].1; // a step halved
            let (low, high) = if method == Method::RungeKutta4 { (12.0, 40.0) } else { (1.6, 2.6) };
            assert!(ratio > low && ratio < high, "{}: {ratio}", method.name());
        }
    }

    #[test]
    fn work_is_accounted_for() {
        // a driven, damped tree: the drift falls with the method's order, though the energy itself changes
        let model = smooth_tree(6, 6, 1);
        let [theta, dtheta, _] = testing::state(&model, 9);
        for (method, steps) in [(Method::Euler, 4000), (Method::SemiImplicitEuler, 4000), (Method::RungeKutta4, 100)] {
            let drift = |steps| {
                let motors = torque(|t, theta, _, tau| (0..tau.len()).for_each(|j| tau[j] = 3.0 * t - theta[j]));
                let options = Options { method, ..Options::new(0.2, steps) };
                let motion = simulate(&model, &theta, &dtheta, motors, &options).expect("a motion");
                let end = motion.last().energy;
                assert!(end.motor_work.abs() > 0.01 && end.friction_loss > 0.01, "{end:?}");
                motion.largest_drift()
            };
            let ratio = drift(steps) / drift(2 * steps);
            let expected = 2_u32.pow(method.order()) as f64;
            assert!(ratio > 0.8 * expected && ratio < 2.2 * expected, "{}: {ratio}", method.name());
        }
    }

    #[test]
    fn friction_takes_what_the_kinetic_energy_loses() {
        let (omega, t_f) = (3.0, 0.5);
        let weightless = Options { gravity: Some(Vec3::zero()), ..Options::new(t_f, 1000) };
        // viscous: θ̇ = ω e^{−dt/I}
        let (d, mu) = (0.8, 0.4);
        let end = simulate(&pendulum(d, 0.0), &[0.0], &[omega], Zero, &weightless).expect("a motion");
        let rate = omega * (-d * t_f / INERTIA).exp();
        assert!((end.last().dtheta[0] - rate).abs() < 1e-12);
        let lost = 0.5 * INERTIA * (omega * omega - rate * rate);
        assert!((end.last().energy.friction_loss - lost).abs() < 1e-11 && end.largest_drift() < 1e-11);
        // Coulomb, before it stops: θ̇ = ω − μt/I, loss μ Δθ
        let end = simulate(&pendulum(0.0, mu), &[0.0], &[omega], Zero, &weightless).expect("a motion");
        assert!((end.last().dtheta[0] - (omega - mu * t_f / INERTIA)).abs() < 1e-12);
        assert!((end.last().energy.friction_loss - mu * end.last().theta[0]).abs() < 1e-12);
        // smooth: I θ̈ = −μ tanh(θ̇/v), so sinh(θ̇/v) = sinh(ω/v) e^{−μt/(I v)}
        let v = 0.5;
        let smooth = Options { friction: Friction::Smooth { slip_speed: v }, ..weightless };
        let end = simulate(&pendulum(0.0, mu), &[0.0], &[omega], Zero, &smooth).expect("a motion");
        let rate = v * ((omega / v).sinh() * (-mu * t_f / (INERTIA * v)).exp()).asinh();
        assert!((end.last().dtheta[0] - rate).abs() < 1e-11);
        assert!(end.largest_drift() < 1e-11 && end.last().energy.friction_loss > 0.5);
    }

    #[test]
    fn smooth_friction_brings_a_pendulum_to_rest() {
        let friction = Friction::Smooth { slip_speed: 0.01 };
        let options = Options { friction, ..Options::new(20.0, 20_000) };
        let robot = pendulum(0.0, 0.5);
        let end = simulate(&robot, &[1.0], &[0.0], Zero, &options).expect("a motion");
        assert!(end.last().dtheta[0].abs() < 1e-3 && end.largest_drift() < 1e-6, "{:?}", end.last());
        // its energy has become heat
        let energy = |k: usize| end.energy[k].total();
        assert!((energy(0) - energy(end.len() - 1) - end.last().energy.friction_loss).abs() < 1e-6);
    }

    #[test]
    fn semi_implicit_euler_keeps_a_pendulums_energy_bounded() {
        let largest = |method, from: f64, to: f64| {
            let options = Options { method, ..Options::new(200.0, 20_000) };
            let motion = simulate(&pendulum(0.0, 0.0), &[2.0], &[0.0], Zero, &options).expect("a motion");
            let within = (0..motion.len()).filter(|&k| motion.t[k] >= from && motion.t[k] < to);
            within.map(|k| motion.drift(k).abs()).fold(0.0, f64::max)
        };
        let (first, last) =
            (largest(Method::SemiImplicitEuler, 0.0, 20.0), largest(Method::SemiImplicitEuler, 180.0, 200.0));
        assert!(last < 1.05 * first && first < 0.5, "{first} {last}");
        let (first, last) = (largest(Method::Euler, 0.0, 20.0), largest(Method::Euler, 180.0, 200.0));
        assert!(last > 5.0 * first, "{first} {last}");
    }
}
