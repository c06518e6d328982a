//! Random robots dropped on the ground: every simulation ends, and friction never gives energy.

use super::robots::by;
use mozzi::simulation::{ContactPoint, Contacts, Method, Options, Plane, Policy, Simulation, Zero};
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

#[test]
fn drops_end_by_every_method() {
    let dopri = Method::DormandPrince { tolerance: 1e-6 };
    for method in [dopri, Method::RungeKutta4, Method::SemiImplicitEuler, Method::Midpoint] {
        let (mut ended, mut refused, mut worst, mut steps) = (0, vec![], 0.0_f64, 0);
        for seed in 0..12 {
            let (model, contacts) = robot(seed);
            let [mut theta, dtheta, _] = testing::state(&model, seed);
            let lowest = contacts.gaps(&model, 0.0, &theta).into_iter().fold(f64::INFINITY, f64::min);
            theta[6] += 0.05 - lowest;
            let options = Options { joint_limits: Policy::Ignore, ..by(method, 0.2, 2e-3) };
            match (Simulation { contacts, ..Simulation::new(options) }).run(&model, &theta, &dtheta, Zero) {
                Ok(run) => {
                    ended += usize::from(run.motion.complete);
                    steps += run.motion.steps;
                    worst = worst.max(run.one_sided.expect("contacts").largest_residual);
                }
                Err(error) => refused.push(format!("{seed}: {error}")),
            }
        }
        println!("{:20} {ended} of 12 end, {steps} steps, residual {worst:.1e}; {refused:?}", method.name());
        assert!(ended >= 11);
    }
}
