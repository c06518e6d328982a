//! Random robots dropped on the ground: every simulation ends, and friction never gives energy.

use super::robots::by;
use mozzi::simulation::{ContactPoint, Contacts, Energy, Method, Options, Plane, Policy, Simulation, Zero};
use mozzi::{Model, Vec3, testing};

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
        for k in 1..run.motion.len() {
            let lost = run.motion.energy[k].friction_loss - run.motion.energy[k - 1].friction_loss;
            worst = worst.max(-lost / size);
        }
    }
    println!(
        "{count} drops, {steps} steps: largest residual {largest:.1e} m/s, {unsolved} steps above 1e-6, largest gain {worst:.1e} of the kinetic energy"
    );
    assert!(worst < 1e-9 && unsolved == 0);
}

/// Drops of the first robots by a method; all have to end.
fn drop_all(method: Method, count: u64, duration: f64) {
    let (mut worst, mut steps, mut across, mut robots_across, mut gain) = (0.0_f64, 0, 0, 0, 0.0_f64);
    for seed in 0..count {
        let (model, contacts) = robot(seed);
        let [mut theta, dtheta, _] = testing::state(&model, seed);
        let lowest = contacts.gaps(&model, 0.0, &theta).into_iter().fold(f64::INFINITY, f64::min);
        theta[6] += 0.05 - lowest;
        let options = Options { joint_limits: Policy::Ignore, ..by(method, duration, 2e-3) };
        let run = (Simulation { contacts, ..Simulation::new(options) }).run(&model, &theta, &dtheta, Zero);
        let run = run.unwrap_or_else(|error| panic!("{} {seed}: {error}", method.name()));
        assert!(run.motion.complete, "{} {seed}", method.name());
        assert_eq!(run.motion.len(), options.steps + 1);
        let account = run.one_sided.expect("contacts");
        steps += run.motion.steps;
        across += account.steps_across;
        robots_across += usize::from(account.steps_across > 0);
        worst = worst.max(account.largest_residual);
        let size = run.motion.largest_kinetic_energy();
        let gained = |pair: &[Energy]| (pair[0].friction_loss - pair[1].friction_loss) / size;
        let gained = run.motion.energy.windows(2).map(gained).fold(0.0, f64::max);
        if gained > 1e-6 {
            println!(
                "{seed} gains {gained:.1e}, {} steps across, drift {:.1e}",
                account.steps_across,
                run.motion.largest_drift() / size
            );
        }
        gain = gain.max(gained);
    }
    println!(
        "{:20} {count} of {count} end, {steps} steps, residual {worst:.1e}, largest gain {gain:.1e} of the kinetic \
         energy; {across} steps across events of {robots_across} robots",
        method.name()
    );
    assert!(worst < 1e-6 && gain < 1e-6);
}

#[test]
fn drops_end_by_every_method() {
    for method in [Method::RungeKutta4, Method::SemiImplicitEuler, Method::Midpoint] {
        drop_all(method, 12, 0.2);
    }
    drop_all(Method::DormandPrince { tolerance: 1e-6 }, 60, 0.2);
}

/// Takes minutes in release: `cargo test --release -p mozzi one_sided -- --ignored adaptive --nocapture`.
#[test]
#[ignore = "a thousand adaptive simulations"]
fn a_thousand_adaptive_drops_end() {
    drop_all(Method::DormandPrince { tolerance: 1e-6 }, 1000, 0.2);
}
