//! Quantities with an inverse: textbook forms, products with what they invert, refusals.

use crate::lagrange::python;
use crate::robots::all;
use crate::{attempt, embedded, formulas, model, of};
use mozzi::model::description::{Anchor, Constraint};
use mozzi::quantities::{ConstrainedForwardDynamics, Query, TaskSpaceDynamics};
use mozzi::{SE3, Task, TaskFrame};
use mozzi_symbolic::{Collect, Derivation, Equal, Error, Language, Options, Rational, Symbols, derive};
use std::fmt::Write;
use std::process::Command;

const BOOK: Options = Options { symbols: Symbols::ALL, equal: Equal::OfLink, collect: Collect::Shortest, names: false };

/// Λ and η of rows of the end effector's body twist.
fn task(text: &str, rows: &[usize], options: &Options) -> Result<Derivation, Error> {
    let model = model(text);
    let task = Task { frame: model.end_effector()?, coordinates: TaskFrame::Body, rows };
    derive(&model, Some(text), Query::from(TaskSpaceDynamics).of_task(task), options)
}

/// Point masses at the links' ends: M⁻¹ by hand from M of the book, Λ as Khatib's for two links.
#[test]
fn the_planar_arm_has_the_inverses_of_textbooks() {
    let robot = embedded("two_link_planar");
    assert_eq!(
        formulas(&of(robot, "M_inv", &BOOK)),
        "M⁻¹(θ) = 1/Δ ·\n[ m₂L₂² −m₂L₂(L₁ cos θ₂ + L₂) ]\n\
         [ −m₂L₂(L₁ cos θ₂ + L₂) m₁L₁² + m₂(L₁² + 2L₁L₂ cos θ₂ + L₂²) ]\n\
         Δ = m₂L₁²L₂²(m₁ + m₂ sin² θ₂)"
    );
    let page = formulas(&task(robot, &[3, 5], &BOOK).expect("independent"));
    assert!(page.starts_with("Λ(θ) = 1/Δ ·\n[ m₁ + m₂ sin² θ₂ 0 ]\n[ 0 m₂ sin² θ₂ ]\n"), "{page}");
    assert!(page.ends_with("\nΔ = sin² θ₂"), "{page}");
    let numbers = formulas(&of(robot, "M_inv", &Options { symbols: Symbols::NONE, ..BOOK }));
    assert!(numbers.ends_with("Δ = 0.04 sin² θ₂ + 0.08"), "{numbers}");
    let cart = all().into_iter().find(|(name, _)| *name == "cart-pole").expect("known").1;
    let page = formulas(&of(&cart, "aba", &BOOK));
    assert!(page.ends_with("Δ = m₂r₂²(m₁ + m₂ sin² θ₂)"), "{page}");
}

/// The product of matrices by rows.
fn product(a: &[f64], b: &[f64], inner: usize) -> Vec<f64> {
    let columns = b.len() / inner;
    let entry = |i: usize, j: usize| (0..inner).map(|k| a[i * inner + k] * b[k * columns + j]).sum();
    (0..a.len() / inner).flat_map(|i| (0..columns).map(move |j| (i, j))).map(|(i, j)| entry(i, j)).collect()
}

#[test]
fn inverses_of_nine_robots_times_their_matrices_are_one() {
    for (name, text) in all() {
        let model = model(&text);
        let n = model.n();
        let theta: Vec<f64> = (0..n).map(|k| 0.3 + 0.5 * k as f64).collect();
        let M: Vec<f64> = model.mass_matrix(&theta).expect("regular").transpose().as_slice().to_vec();
        for names in [false, true] {
            let options = Options { names, ..Options { symbols: Symbols::ALL, ..Options::default() } };
            let inverse = of(&text, "M_inv", &options).evaluate(&[&theta], Rational::to_f64, std::f64::consts::PI);
            for (k, x) in product(&M, &inverse[0], n).into_iter().enumerate() {
                let one = f64::from(u8::from(k / n == k % n));
                assert!((x - one).abs() < 1e-7, "{name}: entry {k} of M M⁻¹ is {x}");
            }
        }
        let symbols = if n > 2 { Symbols::NONE } else { Symbols::ALL };
        of(&text, "forward_dynamics", &Options { symbols, ..Options::default() });
    }
}

#[test]
fn tasks_of_nine_robots_are_derived_for_rows_that_move() {
    for (name, text) in all() {
        let six = task(&text, &[0, 1, 2, 3, 4, 5], &BOOK).expect_err("dependent").to_string();
        let rows = six.rsplit("such as ").next().expect("rows").split(',');
        let names = ["wx", "wy", "wz", "vx", "vy", "vz"];
        let rows: Vec<usize> = rows.map(|row| names.iter().position(|name| *name == row).expect(row)).collect();
        let options = Options { symbols: Symbols::NONE, ..Options::default() };
        let found = task(&text, &rows, &options).unwrap_or_else(|error| panic!("{name} {rows:?}: {error}"));
        assert_eq!(found.formulas[0].shape, [rows.len(), rows.len()], "{name}");
    }
}

/// SymPy multiplies back: M M⁻¹ = 1, Mθ̈ + c + g = τ, Λ J M⁻¹Jᵀ = 1.
#[test]
fn sympy_multiplies_back() {
    let Some(python) = python() else { return };
    let robot = embedded("two_link_planar");
    let cart = all().into_iter().find(|(name, _)| *name == "cart-pole").expect("known").1;
    for (text, rows) in [(robot, Some([3, 5])), (&cart, None)] {
        let mut script = String::from("from sympy import eye, simplify, zeros\nscope = {}\n");
        for quantity in ["mass_matrix", "mass_matrix_inverse", "bias_forces", "forward_dynamics", "body_jacobian"] {
            let _ = writeln!(script, "exec({:?}, scope)", of(text, quantity, &BOOK).print(Language::Sympy));
        }
        script.push_str(
            "M, inverse, h = (scope[k] for k in ('mass_matrix', 'mass_matrix_inverse', 'bias_forces'))\n\
             n = M.rows\n\
             assert simplify(M * inverse - eye(n)) == zeros(n, n), 'inverse'\n\
             rest = M * scope['forward_dynamics'] + h\n\
             assert all(simplify(rest[i] - scope['tau'][i]) == 0 for i in range(n)), 'accelerations'\n",
        );
        if let Some(rows) = rows {
            let module = task(text, &rows, &BOOK).expect("independent").print(Language::Sympy);
            let _ = writeln!(script, "exec({module:?}, scope)\nJ = scope['body_jacobian'].extract({rows:?}, range(n))");
            script
                .push_str("one = scope['Lambda'] * J * inverse * J.T\nassert simplify(one - eye(2)) == zeros(2, 2)\n");
        }
        let output = Command::new(&python).args(["-c", &script]).output().expect("Python runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

/// θ̈ and λ, of a pendulum that a rod holds and of a four-bar linkage, whose loop has a row that never moves.
#[test]
fn multipliers_of_loops_are_derived() {
    let world = |p: [f64; 3]| Anchor::world(SE3::translation(p));
    let rod = Constraint::distance("rod", world([0.1, 0.0, 0.2]), Anchor::frame("link2"), 0.5);
    let pin =
        Constraint::point("pin", world([0.7, 0.0, 0.0]), Anchor::frame("link3").at(SE3::translation([0.3, 0.0, 0.0])));
    let rrr = all().into_iter().find(|(name, _)| *name == "RRR").expect("known").1;
    let query = Query::from(ConstrainedForwardDynamics);
    let numbers = Options { symbols: Symbols::NONE, ..BOOK };
    for (text, constraint, options, zeros) in
        [(embedded("two_link_planar"), rod, BOOK, 0), (&rrr, pin.clone(), numbers, 1)]
    {
        let model = model(text).with_constraints([constraint]).expect("frames");
        let found = derive(&model, Some(text), query, &options).unwrap_or_else(|error| panic!("{error}"));
        let (theta, still, tau) = (vec![0.4; model.n()], vec![0.3; model.n()], vec![0.7; model.n()]);
        let values = found.evaluate(&[&theta, &still, &tau], Rational::to_f64, std::f64::consts::PI);
        assert_eq!(values[1].iter().filter(|x| **x == 0.0).count(), zeros);
        let page = found.print(Language::Text);
        assert!(page.contains("θ̈₁ = ") && page.contains("λ"), "{page}");
    }
    let twice = [pin.clone(), Constraint { name: "again".into(), ..pin }];
    let model = model(&rrr).with_constraints(twice).expect("frames");
    let error = derive(&model, Some(&rrr), query, &numbers).expect_err("redundant").to_string();
    assert!(error.contains("rows of the constraints are dependent"), "{error}");
}

#[test]
fn each_form_divides_once() {
    let robot = embedded("two_link_planar");
    let found = of(robot, "M_inv", &BOOK);
    for (language, parts) in [
        (Language::Latex, [r"M^{-1}(\theta) = \frac{1}{\Delta}\begin{bmatrix}", r"\Delta = m_{2}"]),
        (Language::Markdown, [r"\frac{1}{\Delta}\begin{bmatrix}", "| $L_{2}$ | 0.4 | m |"]),
        (Language::Sympy, ["Delta = m2*L1**2*L2**2*(m1 + m2*sin(theta2)**2)", "])/Delta"]),
        (Language::Python, ["    Delta = m2*L1**2*L2**2*(m1 + m2*sin(theta2)**2)", "]])/Delta"]),
        (Language::Matlab, ["  Delta = m2*L1^2*L2^2*(m1 + m2*sin(theta2)^2);", "]/Delta;"]),
        (Language::Julia, ["    Delta = m2*L1^2*L2^2*(m1 + m2*sin(theta2)^2)", "]/Delta\n"]),
    ] {
        let page = found.print(language);
        parts.iter().for_each(|part| assert!(page.contains(part), "{language:?}: {page}"));
    }
    // entry by entry, and two denominators
    let long = of(robot, "aba", &BOOK).print(Language::Latex);
    assert!(long.contains(r"\ddot{\theta}_{1} &= \frac{") && long.contains(r"}{\Delta}"), "{long}");
    let rr = task(&all()[0].1, &[1, 3], &Options { symbols: Symbols::ALL, ..Options::default() }).expect("independent");
    let page = rr.print(Language::Python);
    assert!(page.contains("Delta1 = ") && page.contains("Delta2 = ") && page.contains("/Delta2"), "{page}");
    assert!(rr.print(Language::Text).contains("Λ(θ) = 1/Δ₁ ·"), "{}", rr.print(Language::Text));
    let count = found.operations();
    assert_eq!((count.additions, count.products, count.sines), (5, 24, 2), "1/Δ, and a product for each entry");
}

#[test]
fn long_and_singular_inverses_are_refused_with_a_remedy() {
    let robot = embedded("two_link_planar");
    let massless = robot.replace("<mass value=\"1\"/>", "<mass value=\"0\"/>");
    for (found, part) in [
        (
            attempt(embedded("ur5"), "aba", &BOOK),
            "forward-dynamics of 6 velocities is too long to read as one fraction",
        ),
        (attempt(robot, "aba_derivatives", &BOOK), "forward-dynamics-derivatives divides by pivots"),
        (task(robot, &[0, 3], &BOOK), "the rows wx,vx of J are dependent in every configuration"),
        (task(robot, &[0, 1, 2, 3, 4, 5], &BOOK), "such as vx,vz"),
        (attempt(&massless, "M_inv", &BOOK), "the mass matrix is singular in every configuration"),
    ] {
        let error = found.expect_err(part).to_string();
        assert!(error.contains(part), "{error}");
    }
}
