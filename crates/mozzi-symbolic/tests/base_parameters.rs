//! Base parameters: textbook combinations, and the numeric ones of `Model::base_parameters`.

use crate::robots::all;
use crate::{embedded, formulas, model};
use mozzi::nalgebra::DMatrix;
use mozzi::random::Random;
use mozzi::{BaseParameters, Model};
use mozzi_symbolic::{Derivation, Language, Options, Rational, Symbols, base_parameters};

const ALL: Options = Options {
    symbols: Symbols::ALL,
    equal: mozzi_symbolic::Equal::Separate,
    collect: mozzi_symbolic::Collect::Shortest,
    names: false,
};

fn found(text: &str, options: &Options) -> Derivation {
    base_parameters(&model(text), Some(text), options).unwrap_or_else(|error| panic!("{error}"))
}

/// By Lagrange, as in the unit test of the numeric combinations.
#[test]
fn the_planar_arm_has_the_combinations_of_textbooks() {
    let page = formulas(&found(embedded("two_link_planar"), &ALL));
    assert!(
        page.starts_with(
            "π_b =\n[ mc₁x + m₂L₁ ]\n[ mc₁z ]\n[ I₁yy + m₂L₁² ]\n[ mc₂x ]\n[ mc₂z ]\n[ I₂yy ]\nY_b₁₁ = g cos θ₁\n"
        ),
        "{page}"
    );
    assert!(page.ends_with("Y_b₂₆ = θ̈₁ + θ̈₂\nthe other entries of Y_b(θ, θ̇, θ̈) are 0"), "{page}");
    let numbers = formulas(&found(embedded("two_link_planar"), &Options { symbols: Symbols::NONE, ..ALL }));
    assert!(numbers.contains("[ I₁yy + 0.25m₂ ]"), "{numbers}");
    // without gravity's moment, along an axis of the file that is not turned
    let (_, cart) = all().into_iter().find(|(name, _)| *name == "cart-pole").expect("known");
    assert!(formulas(&found(&cart, &ALL)).starts_with("π_b =\n[ m₁ + m₂ ]\n[ mc₂x ]"));
}

/// The columns of the regressor at random states, stacked, of these parameters.
fn stacked(model: &Model, kept: &[usize]) -> DMatrix<f64> {
    let (mut random, n) = (Random(3), model.n());
    let mut rows: Vec<f64> = Vec::new();
    let states = 2 * model.parameter_count() / n + 10;
    for _ in 0..states {
        let [theta, dtheta, ddtheta] = [2.0, 2.0, 4.0].map(|size| random.vector(n, size));
        let Y = model.regressor(&theta, &dtheta, &ddtheta, &model.environment()).expect("finite");
        (0..n).for_each(|i| rows.extend(kept.iter().map(|&k| Y[(i, k)])));
    }
    DMatrix::from_row_slice(states * n, kept.len(), &rows)
}

#[test]
fn combinations_are_those_found_numerically_by_rank() {
    for (name, text) in all().iter().map(|(name, text)| (*name, text.as_str())).chain([("ur5", embedded("ur5"))]) {
        let model = model(text);
        let pi = model.parameters();
        let of_joints = model.parameters_of_joint(0).start;
        let kept: Vec<usize> = (0..pi.len()).filter(|&k| k < of_joints || pi[k] != 0.0).collect();
        let names = model.parameter_names();
        let names: Vec<String> = kept.iter().map(|&k| names[k].clone()).collect();
        let numeric = BaseParameters::of_columns(&stacked(&model, &kept), names);
        let options = if name == "ur5" { Options { symbols: Symbols::NONE, ..ALL } } else { ALL };
        let found = found(text, &options);
        let theta: Vec<f64> = (0..model.n()).map(|k| 0.3 + 0.4 * k as f64).collect();
        let [dtheta, ddtheta] = [0.7, -0.9].map(|x| vec![x; model.n()]);
        let state = [&theta[..], &dtheta, &ddtheta];
        let values = found.evaluate(&state, Rational::to_f64, std::f64::consts::PI);
        // the same combinations: of the file's parameters, and the same columns
        let pi: Vec<f64> = kept.iter().map(|&k| pi[k]).collect();
        let expected = numeric.values(&pi);
        assert_eq!(values[0].len(), numeric.count(), "{name}");
        for (x, y) in values[0].iter().zip(expected.iter()) {
            assert!((x - y).abs() < 1e-7 * expected.amax(), "{name}: {x} {y}");
        }
        let Y = model.regressor(&theta, &dtheta, &ddtheta, &model.environment()).expect("finite");
        let count = numeric.count();
        for (at, y) in values[1].iter().enumerate() {
            let column = kept[numeric.columns[at % count]];
            assert!((y - Y[(at / count, column)]).abs() < 1e-6 * Y.amax(), "{name}: entry {at}");
        }
    }
}

#[test]
fn friction_of_the_file_is_a_parameter_of_its_own() {
    let text = embedded("two_link_planar");
    let rubbing = text.replacen("<axis", "<dynamics damping=\"0.3\" friction=\"0.2\"/><axis", 1);
    assert!(rubbing != text);
    let page = formulas(&found(&rubbing, &ALL));
    assert!(page.contains("[ d₁ ]\n[ μ₁ ]"), "{page}");
    assert!(page.contains("Y_b₁₈ = sgn(θ̇₁)"), "{page}");
}

#[test]
fn each_form_has_both_results() {
    let found = found(embedded("two_link_planar"), &ALL);
    for (language, parts) in [
        (Language::Latex, [r"{\pi_b} = \begin{bmatrix}", r"{Y_b}(\theta, \dot{\theta}, \ddot{\theta})"]),
        (Language::Markdown, [r"mc_{1,x} + m_{2} \, L_{1}", "| $mc_{1,x}$ | 1 | kg m | link1.mcx |"]),
        (Language::Sympy, ["pi_b = Matrix(6, 1, [mc1_x + m2*L1, ", "Y_b = Matrix(2, 6, ["]),
        (Language::Python, ["def base_parameters(theta, dtheta, ddtheta, m2=1.0", "return out_pi_b, out_Y_b"]),
        (Language::Matlab, ["function [out_pi_b, out_Y_b] = base_parameters(", "out_pi_b = [mc1_x + m2*L1; "]),
        (Language::Julia, ["function base_parameters(theta, dtheta, ddtheta;", "out_pi_b = [mc1_x + m2*L1, "]),
    ] {
        let page = found.print(language);
        parts.iter().for_each(|part| assert!(page.contains(part), "{language:?}: {page}"));
    }
}
