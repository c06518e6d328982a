//! Random robots dropped on the ground: every simulation ends, and friction never gives energy.

use super::robots::by;
use mozzi::{Model, Vec3, testing};
use mozzi_sim::{ContactPoint, Contacts, Method, Options, Plane, Policy, Simulation, Zero};

/// A floating tree with friction, and a contact point at each link's origin.
fn robot(seed: u64) -> (Model, Contacts<'static>) {
    let model = testing::floating_tree(seed, 2 + seed as usize % 6, seed as usize % 2);
    let mut random = testing::Random(seed);
    let points = model.frames().take(8).map(|(frame, name)| {
        let mu = 0.5 + 0.5 * random.next();
        ContactPoint::new(name, frame, Vec3(random.array::<3>().map(|x| 0.1 * x)), mu)
    });
    let points = points.collect();
    (model, Contacts { points, planes: vec![Plane::ground()] })
}

#[test]
fn a_thousand_drops_end_and_lose_energy() {
    let (mut worst, mut largest, mut unsolved, mut steps) = (0.0_f64, 0.0_f64, 0, 0);
    let (mut drift, mut lifted, mut halvings, mut unsettled) = (0.0_f64, 0.0_f64, 0, 0);
    let count = 1000;
    for seed in 0..count {
        let (model, contacts) = robot(seed);
        let [mut theta, dtheta, _] = testing::state(&model, seed);
        let lowest = contacts.gaps(&model, 0.0, &theta).into_iter().fold(f64::INFINITY, f64::min);
        theta[6] += 0.05 - lowest;
        let options = Options { joint_limits: Policy::Ignore, ..by(Method::Automatic, 0.3, 2e-3) };
        let run = Simulation { contacts, ..Simulation::new(options) }.run(&model, &theta, &dtheta, Zero);
        let run = run.unwrap_or_else(|error| panic!("{seed}: {error}"));
        assert!(run.motion.complete);
        let account = run.one_sided.expect("contacts");
        largest = largest.max(account.largest_residual);
        unsolved += account.unsolved;
        steps += account.steps;
        let size = run.motion.largest_kinetic_energy();
        let mut least = f64::INFINITY;
        for energy in &run.motion.energy {
            let now = energy.kinetic + energy.potential;
            worst = worst.max((now - least) / size);
            least = least.min(now);
        }
        drift = drift.max(run.motion.largest_drift() / size);
        lifted = lifted.max(account.lifted / size);
        halvings += account.halvings;
        unsettled += account.unsettled;
    }
    println!(
        "{count} drops, {steps} steps: largest residual {largest:.1e} m/s, {unsolved} steps above 1e-6, largest gain \
         {worst:.1e} of the kinetic energy, drift {drift:.1e}, lifted {lifted:.1e}, {halvings} halvings, {unsettled} unsettled"
    );
    assert!(worst < 1e-4 && drift < 2e-2 && unsolved == 0);
}
