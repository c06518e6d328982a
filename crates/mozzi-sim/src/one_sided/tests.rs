//! The solver on random problems: the laws themselves, and one method against another.

extern crate std;
use super::*;
use mozzi::random::Random;
use nalgebra::Matrix3;

/// Normally distributed, roughly: the sum of four uniform numbers.
fn matrix(random: &mut Random, rows: usize, columns: usize) -> DMatrix<f64> {
    DMatrix::from_fn(rows, columns, |_, _| random.array::<4>().iter().sum())
}

/// Contacts with a G of a given rank; b is in the range of J, and some velocity opens all contacts.
fn contacts(random: &mut Random, count: usize, rank: usize, mu: f64) -> Problem {
    let mut J = matrix(random, 3 * count, rank);
    let lift = matrix(random, rank, 1);
    for k in 0..count {
        if (J.row(3 * k) * &lift)[0] < 0.0 {
            J.row_mut(3 * k).neg_mut();
        }
    }
    let b = (&J * matrix(random, rank, 1)).column(0).into_owned();
    Problem { G: &J * J.transpose() / (3 * count) as f64, b, laws: alloc::vec![Law::Contact { mu }; count] }
}

/// Three constraints, three stops, dry friction of six joints and contacts on 12 velocities. The redundant problem has
/// a constraint twice and 37 rows of rank 12.
fn mixed(random: &mut Random, is_redundant: bool) -> Problem {
    let n = 12;
    let A = matrix(random, n, n);
    let M = &A * A.transpose() + DMatrix::identity(n, n);
    let mut laws = alloc::vec![Law::Bilateral; if is_redundant { 4 } else { 3 }];
    let constraints = laws.len();
    laws.extend([Law::Stop; 3]);
    laws.extend([Law::Dry { most: 0.05 }; 6]);
    laws.extend(alloc::vec![Law::Contact { mu: 0.6 }; if is_redundant { 8 } else { 4 }]);
    let rows = laws.iter().map(|law| law.rows()).sum();
    let mut J = matrix(random, rows, n);
    if is_redundant {
        let sum = J.row(0) + J.row(1);
        J.set_row(3, &sum);
    }
    // a velocity that keeps the constraints and opens every stop and contact
    let bilateral = J.rows(0, constraints).into_owned();
    let mut lift = matrix(random, n, 1);
    lift -= bilateral.clone().pseudo_inverse(1e-10).expect("finite") * &bilateral * &lift;
    let mut first = 0;
    for law in &laws {
        let opens = matches!(law, Law::Stop | Law::Contact { .. });
        if opens && (J.row(first) * &lift)[0] > 0.0 {
            J.row_mut(first).neg_mut();
        }
        first += law.rows();
    }
    let G = &J * M.cholesky().expect("positive definite").solve(&J.transpose());
    Problem { G: (&G + G.transpose()) * 0.5, b: -(J * matrix(random, n, 1)).column(0).into_owned(), laws }
}

/// How far (p, u) is from each law, in the law's own words: sizes of p in velocities by the block's g.
fn violation(problem: &Problem, p: &DVector<f64>) -> f64 {
    let (u, scales) = (problem.velocity(p), scaled::scales(&problem.G, &problem.laws));
    let mut worst = 0.0_f64;
    let mut at_most = |excess: f64| worst = worst.max(excess);
    for (i, law) in problem.blocks() {
        let g = scales[i];
        match law {
            Law::Bilateral => at_most(u[i].abs()),
            Law::Stop => {
                at_most(-g * p[i]);
                at_most(-u[i]);
                at_most((g * p[i]).min(u[i]));
            }
            Law::Dry { most } => {
                at_most(g * (p[i].abs() - most));
                // it slips only with all friction, against the slip
                at_most(u[i].abs().min(g * (p[i] + most * u[i].signum()).abs()));
            }
            Law::Contact { mu } => {
                let (p_t, u_t) = ([p[i + 1], p[i + 2]], [u[i + 1], u[i + 2]]);
                let (size, slip) = (law::norm(p_t[0], p_t[1]), law::norm(u_t[0], u_t[1]));
                at_most(-g * p[i]);
                at_most(-u[i]);
                at_most((g * p[i]).min(u[i]));
                at_most(g * (size - mu * p[i]));
                let missing = [0, 1].map(|k| g * (p_t[k] * slip + mu * p[i] * u_t[k]) / slip.max(1e-300));
                at_most(slip.min(law::norm(missing[0], missing[1])));
            }
        }
    }
    worst
}

fn zeros(problem: &Problem) -> DVector<f64> {
    DVector::zeros(problem.b.len())
}

#[test]
fn one_contact_is_solved_exactly() {
    let (mut random, mut cases, mut worst) = (Random(5), [0; 3], 0.0_f64);
    for k in 0..3000 {
        let A = matrix(&mut random, 3, 3);
        let (G, b) = (&A * A.transpose(), matrix(&mut random, 3, 1).column(0).into_owned());
        let mu = [0.3, 0.7, 1.0, 2.0][k % 4];
        let block: Matrix3<f64> = G.fixed_view::<3, 3>(0, 0).into_owned();
        let p = DVector::from_row_slice(&point_contact::point_contact(&block, [b[0], b[1], b[2]], mu));
        let problem = Problem { G, b, laws: alloc::vec![Law::Contact { mu }] };
        let u = problem.velocity(&p);
        let slides = law::norm(u[1], u[2]) > 1e-9;
        cases[if p[0] == 0.0 { 0 } else { 1 + usize::from(slides) }] += 1;
        let size = problem.G.amax().max(1.0) * (1.0 + p.amax());
        worst = worst.max(violation(&problem, &p) / size).max(residual(&problem, &p) / size);
    }
    std::println!("take-off, sticking, sliding: {cases:?}, worst violation over the size of the terms {worst:.1e}");
    assert!(cases.iter().all(|&count| count > 100) && worst < 1e-12);
}

#[test]
fn random_contacts_satisfy_their_laws() {
    for (count, rank, mu) in
        [(4, 12, 0.3), (4, 12, 1.0), (8, 24, 0.5), (8, 12, 0.3), (8, 12, 1.0), (4, 12, 1e4), (8, 24, 1e6)]
    {
        let (mut random, mut worst, mut effort) = (Random(count as u64 + rank as u64), 0.0_f64, [0; 3]);
        let mut missed = 0;
        for _ in 0..40 {
            let problem = contacts(&mut random, count, rank, mu);
            let found = solve(&problem, &zeros(&problem), [1e-12, 1e-8]);
            missed += usize::from(found.residual > 1e-10);
            if found.residual <= 1e-10 {
                worst = worst.max(violation(&problem, &found.p));
            }
            for (sum, x) in effort.iter_mut().zip([found.newton_steps, found.sweeps, found.admm_iterations]) {
                *sum += x;
            }
        }
        std::println!(
            "{count} contacts, rank {rank}, μ {mu}: {missed} of 40 above 1e-10, worst violation {worst:.1e}, mean steps {:?}",
            effort.map(|x| x / 40)
        );
        // redundant rows; or a jam, in which friction opens what presses
        let most = if mu > 1.0 { 8 } else { 6 * usize::from(rank < 3 * count) };
        assert!(missed <= most && worst < 1e-8);
    }
}

#[test]
fn constraints_stops_friction_and_contacts_are_solved_together() {
    for is_redundant in [false, true] {
        let (mut random, mut missed, mut worst) = (Random(3), 0, 0.0_f64);
        for _ in 0..40 {
            let problem = mixed(&mut random, is_redundant);
            let found = solve(&problem, &zeros(&problem), [1e-12, 1e-8]);
            missed += usize::from(found.residual > CLOSE * 1e-12);
            worst = worst.max(violation(&problem, &found.p));
        }
        std::println!("redundant {is_redundant}: {missed} of 40 not close, worst violation {worst:.1e}");
        assert!(missed == 0 && worst < 1e-8);
    }
}

#[test]
fn three_methods_find_the_same_velocities() {
    let mut random = Random(11);
    let (mut compared, mut apart) = (0, 0.0_f64);
    for _ in 0..30 {
        let problem = contacts(&mut random, 4, 12, 0.3);
        let newton = solve(&problem, &zeros(&problem), [1e-12, 1e-8]).p;
        let mut by_sweeps = zeros(&problem);
        sweeps::sweep(&problem, &mut by_sweeps, 1e-14, 3000);
        let mut method = admm::Admm::new(&problem, None, &zeros(&problem));
        method.iterate(&problem, 1e-13, 5000);
        let by_admm = method.impulses();
        // the solution for friction is not unique in general: compare where all three solve the problem
        if residual(&problem, &by_sweeps).max(residual(&problem, by_admm)) < 1e-10 {
            compared += 1;
            for other in [&by_sweeps, by_admm] {
                apart = apart.max((problem.velocity(&newton) - problem.velocity(other)).amax());
            }
        }
    }
    std::println!("{compared} of 30 compared, velocities at most {apart:.1e} apart");
    assert!(compared >= 25 && apart < 1e-8);
}

#[test]
fn a_guess_that_is_the_solution_costs_nothing() {
    let problem = mixed(&mut Random(1), false);
    let found = solve(&problem, &zeros(&problem), [1e-12, 1e-8]);
    let again = solve(&problem, &found.p, [1e-11, 1e-7]);
    assert_eq!((again.newton_steps, again.sweeps, again.admm_iterations), (0, 0, 0));
}

#[test]
fn a_problem_without_a_solution_is_reported() {
    // two stops against each other, which close at 1 m/s each: no velocity opens both
    let G = DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.0]);
    let problem = Problem { G, b: DVector::from_row_slice(&[-1.0, -1.0]), laws: alloc::vec![Law::Stop; 2] };
    let found = solve(&problem, &zeros(&problem), [1e-12, 1e-8]);
    assert!(found.residual > 0.1 && found.p.iter().all(|x| x.is_finite()), "{found:?}");
    // NaN ends at once
    let problem = Problem { b: DVector::from_row_slice(&[f64::NAN, 0.0]), ..problem };
    assert!(!(solve(&problem, &zeros(&problem), [1e-12, 1e-8]).residual <= 1e-12));
}

#[test]
fn sticking_is_found_among_redundant_contacts() {
    // a box on four corners, pushed by less than friction holds: 12 rows of rank 6
    let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]];
    let rows = corners.iter().flat_map(|&[x, y]| {
        // (ω, v) at a corner (x, y, −½): n = −z, t = x and y
        [[-y, x, 0.0, 0.0, 0.0, -1.0], [0.0, -0.5, -y, 1.0, 0.0, 0.0], [0.5, 0.0, x, 0.0, 1.0, 0.0]]
    });
    let entries: Vec<f64> = rows.flatten().collect();
    let J = DMatrix::from_row_slice(12, 6, &entries);
    let free = DVector::from_row_slice(&[0.0, 0.0, 0.0, 0.3, 0.1, -1.0]);
    let problem = Problem { G: &J * J.transpose(), b: -(&J * free), laws: alloc::vec![Law::Contact { mu: 0.5 }; 4] };
    let found = solve(&problem, &zeros(&problem), [1e-13, 1e-9]);
    std::println!("{found:?}");
    assert!(found.residual < 1e-13 && problem.velocity(&found.p).amax() < 1e-12 && found.newton_steps <= 3);
    let normal: f64 = (0..4).map(|k| found.p[3 * k]).sum();
    assert!((normal - 1.0).abs() < 1e-12);
}

#[test]
fn systems_of_many_rows_are_those_of_few_velocities() {
    let (mut random, mut slides, mut apart, mut left) = (Random(17), 0, 0.0_f64, 0.0_f64);
    for k in 0..60 {
        let Problem { G, b, laws } = contacts(&mut random, 10, 5, [0.3, 1.0, 100.0][k % 3]);
        let spectrum = G.clone().symmetric_eigen();
        let mut R = spectrum.eigenvectors.transpose();
        for (mut row, value) in R.row_iter_mut().zip(&spectrum.eigenvalues) {
            row *= value.max(0.0).sqrt();
        }
        let kept: Vec<usize> =
            (0..30).filter(|&k| spectrum.eigenvalues[k] > 1e-12 * spectrum.eigenvalues.max()).collect();
        let R = R.select_rows(&kept);
        let mut p = matrix(&mut random, 30, 1).column(0).into_owned();
        (0..10).for_each(|k| p[3 * k] = p[3 * k].abs());
        let steps = [None, Some(R)].map(|root| {
            let mut of = scaled::Scaled::new(&G, &laws, root);
            of.begin(&b, &p);
            let p = of.best.clone();
            let at = newton::Function::at(&of.problem, &p);
            slides += at.sides.iter().filter(|side| **side == newton::Side::Slides).count();
            let derivative = derivative::Derivative::new(&of, &p, &at, 1e-6);
            derivative.step(&of.problem, &p, &at.F, &p).expect("regular")
        });
        apart = apart.max((&steps[0] - &steps[1]).amax() / steps[0].amax());
        left = left.max((&G * (&steps[0] - &steps[1])).amax() / steps[0].amax());
    }
    std::println!("{slides} contacts slide; steps {apart:.1e} apart, their velocities {left:.1e}");
    assert!(slides > 100 && apart < 1e-6 && left < 1e-9);
}
