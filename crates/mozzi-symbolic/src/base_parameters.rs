//! The base parameters of a robot in symbols: the combinations of inertial parameters that its forces depend on, and
//! the regressor that belongs to them (Gautier 1991), exactly.

use crate::angles;
use crate::atom::{Atom, Class, Id, Name};
use crate::dependence::{dependence, file_value};
use crate::derivation::{Derivation, Formula};
use crate::derive::{Collect, Options, described, explained, finished, written};
use crate::error::{Error, LONGEST, LONGEST_IN_ALL};
use crate::expression::Expression;
use crate::kernel::{Kernel, check_fault};
use crate::letters::printable;
use crate::parameters::{Meaning, Symbols};
use crate::polynomial::Polynomial;
use crate::proof::{OF_BOUND, at_points, random_positions, value_at};
use crate::rational::Rational;
use crate::rounded::Rounded;
use crate::symbol::{Symbol, with_table};
use mozzi::Model;
use mozzi::quantities::{Query, Regressor};
use mozzi::random::Random;

const QUANTITY: &str = "base_parameters";

/// Letters, parts and units of a body's ten parameters.
const OF_BODY: [(&str, &str, &str); 10] = [
    ("m", "", "kg"),
    ("mc", "x", "kg m"),
    ("mc", "y", "kg m"),
    ("mc", "z", "kg m"),
    ("I", "xx", "kg m²"),
    ("I", "xy", "kg m²"),
    ("I", "xz", "kg m²"),
    ("I", "yy", "kg m²"),
    ("I", "yz", "kg m²"),
    ("I", "zz", "kg m²"),
];

/// Letters and units of a joint's five: armature, damping, friction, stiffness, preload.
const OF_JOINT: [(&str, &str); 5] =
    [("a", "kg m² or kg"), ("d", "N m s/rad or N s/m"), ("μ", "N m or N"), ("k", "N m/rad or N/m"), ("p", "N m or N")];

/// The parameters π of a robot as symbols, in the order of its regressor's columns.
fn parameters(model: &Model, symbolic: &Model<Symbol>) -> Vec<Meaning> {
    let bodies = model.parameters_of_joint(0).start / 10;
    let rotors = model.parameter_count() - model.parameters_of_joint(model.places().len()).start;
    let first = usize::from(!model.is_floating());
    let body = |body: usize| {
        let name = move |(letter, part, _): &(&'static str, &str, _)| Name::new(letter, body + first, *part);
        OF_BODY.iter().map(move |all| (name(all), Class::Inertia, all.2))
    };
    let joint = |joint: usize| {
        OF_JOINT.iter().map(move |(letter, unit)| {
            let class = if *letter == "a" { Class::Inertia } else { Class::Joint };
            (Name::new(letter, joint + 1, ""), class, *unit)
        })
    };
    let rotor = |rotor: usize| (Name::new("a", None, format!("rotor{}", rotor + 1)), Class::Inertia, "kg m²");
    let named = (0..bodies).flat_map(body).chain((0..model.places().len()).flat_map(joint));
    let named = named.chain((0..rotors).map(rotor));
    let all = named.zip(symbolic.parameters()).zip(model.parameters()).zip(model.parameter_names());
    let meaning = |((((name, class, unit), exact), value), place): (_, String)| {
        let exact: Polynomial = Symbol::polynomial(exact);
        let value = with_table(|table| file_value(table, &exact))
            .or_else(|| Rational::decimal(&format!("{value}")))
            .unwrap_or(Rational::ZERO);
        let atom = Atom::Parameter { name: Name::clone(&name), class, value: value.clone() };
        let id = with_table(|table| table.id(atom));
        let about = if name.letter == "I" { " about the origin of its frame" } else { "" };
        Meaning { name, class, value, unit, places: vec![format!("{}{about}", printable(&place))], id }
    };
    all.map(meaning).collect()
}

/// Derives the base parameters π_b = K π of a robot and their regressor: τ = Y_b(θ, θ̇, θ̈) π_b for every π. Each is
/// the parameter nearest to the base plus multiples of those that have no separate effect, as in
/// [`Model::base_parameters`]. The options' symbols apply to lengths and gravity. Joints' parameters that are 0 in the
/// file are left out. The outputs are `pi_b` and `Y_b`.
///
/// # Errors
/// [`Error`] if the regressor leaves the polynomials or is too long, or if Y_b π_b differs from the kernel's Y π.
pub fn base_parameters(model: &Model, text: Option<&str>, options: &Options) -> Result<Derivation, Error> {
    found(model, text, options).map_err(|error| explained(error, model))
}

fn found(model: &Model, text: Option<&str>, options: &Options) -> Result<Derivation, Error> {
    let Symbols { lengths, gravity, .. } = options.symbols;
    let symbols = Symbols { lengths, gravity, ..Symbols::NONE };
    let (description, mut known) = described(model, text, &Options { symbols, ..*options })?;
    let symbolic = description.build()?;
    let query = Query::from(Regressor);
    let declared = query.declaration().inputs;
    let inputs: Vec<Vec<Symbol>> =
        declared.iter().zip(query.input_lengths(model)).map(|(input, n)| angles::input(model, input, n)).collect();
    let kernel = Kernel::new(&query, &symbolic, None)?;
    let outputs = kernel.outputs(&inputs).swap_remove(0);
    check_fault(QUANTITY)?;
    let all: Vec<Polynomial> = outputs.iter().map(|x| x.polynomial()).collect();
    let longest = all.iter().map(|p| p.terms().len()).max().unwrap_or(0);
    let sum = all.iter().map(|p| p.terms().len()).sum();
    for (terms, most) in [(longest, LONGEST), (sum, LONGEST_IN_ALL)] {
        if terms > most {
            return Err(Error::TooLong { quantity: QUANTITY, terms, most });
        }
    }
    let meanings = parameters(model, &symbolic);
    let (n, p) = (model.n(), meanings.len());
    // parameters of joints that are 0 in the file are no symbols
    let of_joints = model.parameters_of_joint(0).start;
    let kept: Vec<usize> = (0..p).filter(|&k| k < of_joints || !meanings[k].value.is_zero()).collect();
    let columns: Vec<Vec<Polynomial>> =
        kept.iter().map(|&k| (0..n).map(|i| all[i * p + k].clone()).collect()).collect();
    let found = with_table(|table| dependence(table, &columns)).ok_or_else(|| Error::NotPolynomial {
        quantity: QUANTITY,
        what: "has combinations whose coefficients are quotients".into(),
    })?;
    check_fault(QUANTITY)?;
    let own: Vec<usize> = found.keys().copied().collect();
    let regressor: Vec<Polynomial> =
        (0..n).flat_map(|i| own.iter().map(move |&c| (i, c))).map(|(i, c)| columns[c][i].clone()).collect();
    let atoms: Vec<Id> = kept.iter().map(|&k| meanings[k].id).collect();
    let collect = options.collect;
    let formulas = with_table(|table| {
        let mut combined = Vec::new();
        for (own, row) in &found {
            let mut rest = Polynomial::default();
            for (k, factor) in row.iter().filter(|(k, _)| *k != own) {
                rest = rest.plus(&table.times(factor, &Polynomial::atom(atoms[*k])));
            }
            let rest = written(table, &[rest], Collect::Shortest);
            combined.push(Expression::sum([vec![Expression::Atom(atoms[*own])], rest].concat()));
        }
        let count = combined.len();
        let formula = |name, shape, entries| Formula { name, shape, is_symmetric: false, entries, denominator: None };
        let entries = written(table, &regressor, collect);
        vec![formula("pi_b", vec![count], combined), formula("Y_b", vec![n, count], entries)]
    });
    let pi: Vec<(usize, Id)> = kept.iter().copied().zip(atoms).collect();
    known.legend.extend(meanings);
    let prove = |formulas: &[Formula], names: &[Expression]| prove(&kernel, &inputs, formulas, names, &pi, p);
    let names_of_inputs: Vec<&'static str> = declared.iter().map(|input| input.name).collect();
    let derivation = finished(QUANTITY, formulas, options, known, (&names_of_inputs, &inputs), prove)?;
    compare(&derivation, model)?;
    Ok(derivation)
}

/// Y_b π_b is the kernel's Y π, exactly, at random points.
fn prove(
    kernel: &Kernel,
    inputs: &[Vec<Symbol>],
    formulas: &[Formula],
    names: &[Expression],
    pi: &[(usize, Id)],
    p: usize,
) -> Result<(), Error> {
    at_points(
        QUANTITY,
        |number, inputs| kernel.outputs_at(number, inputs),
        inputs,
        |point, outputs| {
            let value = value_at(point, names);
            let of = |id: Id| value(&Expression::Atom(id));
            let [combined, regressor] =
                [0, 1].map(|k: usize| formulas[k].entries.iter().map(&value).collect::<Vec<_>>());
            for (i, row) in regressor.chunks(combined.len().max(1)).enumerate() {
                let zero = Symbol::from(Rational::ZERO);
                let found = row.iter().zip(&combined).fold(zero, |sum, (&y, &x)| sum + y * x);
                let expected = pi.iter().fold(zero, |sum, &(k, id)| sum + outputs[0][i * p + k] * of(id));
                if found != expected {
                    let what = format!("{} instead of {}", f64::from(found), f64::from(expected));
                    return Err(Error::NotProven { quantity: QUANTITY, entry: i, what });
                }
            }
            Ok(())
        },
    )
}

/// Y_b π_b with the file's numbers is the model's inverse dynamics in `f64`.
fn compare(derivation: &Derivation, model: &Model) -> Result<(), Error> {
    let mut random = Random(8);
    let theta = random_positions(model, &mut random);
    let [dtheta, ddtheta] = [0, 1].map(|_| random.vector(model.n(), 1.0));
    let inputs = [&theta, &dtheta, &ddtheta].map(|slice| slice.iter().copied().map(Rounded::from).collect::<Vec<_>>());
    let slices = [&inputs[0][..], &inputs[1], &inputs[2]];
    let found = derivation.evaluate(&slices, |x| x.to_f64().into(), std::f64::consts::PI.into());
    let count = found[0].len().max(1);
    let expected = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &model.environment())?;
    let size = found[1].iter().fold(1e-300_f64, |size, x| size.max(x.value.abs())) * model.mass().abs().max(1.0);
    for (entry, row) in found[1].chunks(count).enumerate() {
        let tau = row.iter().zip(&found[0]).fold(Rounded::from(0.0), |sum, (&y, &x)| sum + y * x);
        let most = (1e-9 + 1e3 * derivation.angle_error) * size + OF_BOUND * tau.error;
        if !((tau.value - expected[entry]).abs() <= most) {
            let what = format!("{} instead of {}", tau.value, expected[entry]);
            return Err(Error::NotProven { quantity: QUANTITY, entry, what });
        }
    }
    Ok(())
}
