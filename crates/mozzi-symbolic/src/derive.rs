//! A quantity of a robot, from its kernel on symbols to what is printed.

use crate::angles;
use crate::atom::Class;
use crate::collect::Grouping;
use crate::constrained::{self, Parts};
use crate::cse;
use crate::derivation::{Derivation, Formula, plain_names};
use crate::error::{Error, LONGEST, LONGEST_IN_ALL, MOST_LINKS};
use crate::expression::Expression;
use crate::fraction::Fraction;
use crate::inverse::{Robot, check_inverse};
use crate::kernel::{Kernel, check_fault};
use crate::order::ranks;
use crate::parameters::{Equal, Meaning, Parameters, Symbols};
use crate::polynomial::{Monomial, Polynomial};
use crate::proof;
use crate::rational::Rational;
use crate::sines::shortened;
use crate::symbol::{Symbol, end, start, with_table};
use crate::table::Table;
use mozzi::model::description::JointKind;
use mozzi::quantities::Query;
use mozzi::{Description, Model};

/// How sums are grouped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Collect {
    /// The shortest of the candidates.
    #[default]
    Shortest,
    /// By products of velocities.
    Velocities,
}

/// Options of a derivation: its symbols, and how expressions are written.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// The numbers that become symbols.
    pub symbols: Symbols,
    /// Which equal numbers are one symbol.
    pub equal: Equal,
    /// How sums are grouped.
    pub collect: Collect,
    /// Name sub-expressions that occur more than once.
    pub names: bool,
}

/// The robot in symbols, in a derivation that starts.
pub(crate) fn described(
    model: &Model,
    text: Option<&str>,
    options: &Options,
) -> Result<(Description<Symbol>, Parameters), Error> {
    if model.moving_links() > MOST_LINKS {
        return Err(Error::TooManyLinks(model.moving_links()));
    }
    start(Table::default());
    let mut parameters = Parameters::new(model, options.symbols, options.equal);
    let theta = angles::positions(model);
    let groups = angles::groups(model, &theta);
    with_table(|table| table.groups = groups);
    let description = parameters.describe(model.description(), text).map_err(Error::NotRead)?;
    check_fault("the model")?;
    Ok((description, parameters))
}

/// Derives a quantity. `text` is the URDF whose decimals are read; without it, the numbers of the description are
/// taken by their shortest decimals.
///
/// # Errors
/// [`Error`] if the kernel leaves the polynomials, or an expression does not equal the kernel.
pub fn derive(model: &Model, text: Option<&str>, query: Query, options: &Options) -> Result<Derivation, Error> {
    derived(model, text, query, options).map_err(|error| explained(error, model))
}

/// A root is that of a ball: its spring, and the column of its stiffness, are along the rotation vector of its
/// quaternion.
pub(crate) fn explained(error: Error, model: &Model) -> Error {
    let balls = || model.joints().filter(|joint| matches!(joint.kind, JointKind::Ball(_)));
    let ball = balls().find(|joint| joint.stiffness != 0.0).or_else(|| balls().next());
    match (error, ball) {
        (Error::NotPolynomial { quantity, what }, Some(joint)) if what.contains("root") => {
            let of = if joint.stiffness != 0.0 { "in the spring" } else { "in the column of the stiffness" };
            let what = format!("{what}, the length of the rotation vector {of} of the ball joint `{}`", joint.name);
            Error::NotPolynomial { quantity, what }
        }
        (error, _) => error,
    }
}

fn derived(model: &Model, text: Option<&str>, query: Query, options: &Options) -> Result<Derivation, Error> {
    query.check_subject(model)?;
    let declaration = query.declaration();
    let quantity = declaration.name;
    if declaration.divides {
        check_inverse(quantity, model.n())?;
    }
    let (description, parameters) = described(model, text, options)?;
    let symbolic = description.build()?;
    let mut inputs: Vec<Vec<Symbol>> = declaration
        .inputs
        .iter()
        .zip(query.input_lengths(model))
        .map(|(input, length)| angles::input(model, input, length))
        .collect();
    let tip = declaration.name.starts_with("tip_forces").then(|| model.end_effector()).transpose()?;
    let mut names_of_inputs: Vec<&'static str> = declaration.inputs.iter().map(|input| input.name).collect();
    if tip.is_some() {
        inputs.push(angles::wrench());
        names_of_inputs.push("F");
    }
    let kernel = Kernel::new(&query, &symbolic, tip)?;
    let are_fractions = options.symbols.are_all();
    let robot = Robot { model, symbolic: &symbolic, are_fractions };
    let found: Vec<Fraction> = match declaration.divides {
        true => robot.fractions(&query, &inputs)?,
        false => {
            let outputs = kernel.outputs(&inputs);
            check_fault(quantity)?;
            let whole = |output: Vec<Symbol>| Fraction::whole(output.iter().map(|x| x.polynomial()).collect());
            outputs.into_iter().map(whole).collect()
        }
    };
    let terms = || found.iter().flat_map(Fraction::polynomials).map(|p| p.terms().len());
    for (terms, most) in [(terms().max().unwrap_or(0), LONGEST), (terms().sum(), LONGEST_IN_ALL)] {
        if terms > most {
            return Err(Error::TooLong { quantity, terms, most });
        }
    }
    let formulas: Vec<Formula> = with_table(|table| {
        declaration
            .outputs
            .iter()
            .zip(query.shapes(model))
            .zip(&found)
            .map(|((output, shape), found)| {
                let (entries, denominator) = fraction(table, found, options.collect);
                Formula { name: output.name, shape, is_symmetric: output.is_symmetric, entries, denominator }
            })
            .collect()
    });
    let parts = (quantity == constrained::QUANTITY).then(|| Parts::new(&robot)).transpose()?;
    let prove = |formulas: &[Formula], names: &[Expression]| match &parts {
        Some(parts) => parts.prove(&inputs, formulas, names),
        None => proof::prove(quantity, &kernel, &inputs, formulas, names),
    };
    let derivation = finished(quantity, formulas, options, parameters, (&names_of_inputs, &inputs), prove)?;
    proof::compare(&derivation, &query, model, tip)?;
    Ok(derivation)
}

/// A derivation of these formulas, which are proven first: ends the session of symbols.
pub(crate) fn finished(
    quantity: &'static str,
    mut formulas: Vec<Formula>,
    options: &Options,
    parameters: Parameters,
    (names_of_inputs, inputs): (&[&'static str], &[Vec<Symbol>]),
    prove: impl Fn(&[Formula], &[Expression]) -> Result<(), Error>,
) -> Result<Derivation, Error> {
    let taken = with_table(|table| plain_names(table, names_of_inputs.iter().copied(), &formulas));
    let letter = cse::free_letter(&taken).filter(|_| options.names);
    let names = letter.map_or(Vec::new(), |_| cse::name(&mut formulas));
    prove(&formulas, &names)?;
    let id = |x: &Symbol| x.single_atom().unwrap_or_default();
    let ids = names_of_inputs.iter().zip(inputs).map(|(of, all)| (*of, all.iter().map(id).collect())).collect();
    let table = end();
    let has_fractions = options.symbols.are_all();
    let (angles, angle_error, legend_of_all) = (parameters.angles, parameters.angle_error, parameters.legend);
    let mut derivation = Derivation {
        quantity,
        formulas,
        names,
        letter_of_names: letter.unwrap_or_default(),
        inputs: ids,
        angles,
        angle_error,
        legend: Vec::new(),
        has_fractions,
        table,
    };
    let entries: Vec<&Expression> = derivation.expressions().collect();
    derivation.legend = legend_of(&derivation.table, &entries, legend_of_all);
    Ok(derivation)
}

/// The forms of a fraction's entries and denominator.
fn fraction(table: &mut Table, fraction: &Fraction, collect: Collect) -> (Vec<Expression>, Option<Expression>) {
    if fraction.is_whole() {
        return (written(table, &fraction.numerators, collect), None);
    }
    let all: Vec<Polynomial> = fraction.polynomials().cloned().collect();
    let mut entries = all_written(table, &all, collect, |grouping, terms| grouping.factored(terms));
    let denominator = entries.pop();
    (entries, denominator)
}

/// The shortest forms of polynomials.
pub(crate) fn written(table: &mut Table, entries: &[Polynomial], collect: Collect) -> Vec<Expression> {
    all_written(table, entries, collect, |grouping, terms| grouping.shortest(terms))
}

fn all_written(
    table: &mut Table,
    entries: &[Polynomial],
    collect: Collect,
    shortest: impl Fn(&Grouping, &[(Monomial, Rational)]) -> Expression,
) -> Vec<Expression> {
    let shortened: Vec<_> = entries.iter().map(|p| shortened(table, p)).collect();
    let classes: Vec<Class> = (0..table.len() as u32).map(|id| table.class(id)).collect();
    let ranks = ranks(table);
    let grouping = Grouping { classes: &classes, ranks: &ranks };
    let write = |terms: &Vec<_>| match collect {
        Collect::Shortest => shortest(&grouping, terms),
        Collect::Velocities => grouping.by_velocities(terms),
    };
    shortened.iter().map(write).collect()
}

/// The symbols that occur, in the order of printing.
pub(crate) fn legend_of(table: &Table, expressions: &[&Expression], all: Vec<Meaning>) -> Vec<Meaning> {
    let mut atoms = std::collections::BTreeSet::new();
    expressions.iter().for_each(|expression| expression.atoms(&mut atoms));
    for id in atoms.clone() {
        if let crate::atom::Atom::Inverse(p) = table.atom(id) {
            atoms.extend(p.terms().iter().flat_map(|(m, _)| m.factors().map(|(id, _)| id)));
        }
    }
    let mut legend: Vec<Meaning> = all.into_iter().filter(|meaning| atoms.contains(&meaning.id)).collect();
    legend.sort_by_key(|meaning| crate::order::key(table, meaning.id));
    legend
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::proof::compare;

    /// A formula that is wrong by a millionth of one entry is refused, a difference in rounding is not.
    #[test]
    fn wrong_formulas_are_refused() {
        let text = mozzi_urdf::embedded::text("two_link_planar").expect("embedded");
        let model = mozzi_urdf::parse("robot.urdf", text).expect("sound").description.build().expect("sound");
        for name in ["mass_matrix", "forward_dynamics", "inverse_dynamics_vjp"] {
            let query = Query::named(name).expect(name);
            let found = derive(&model, Some(text), query, &Options::default()).expect(name);
            for (part, is_wrong) in
                [(Rational::new(1, 1_000_000), true), (Rational::new(1, 1_000_000_000_000_000), false)]
            {
                let mut other = found.clone();
                let entry = &mut other.formulas[0].entries[0];
                *entry = Expression::product(&Rational::ONE + &part, vec![entry.clone()]);
                assert_eq!(compare(&other, &query, &model, None).is_err(), is_wrong, "{name}");
            }
        }
    }
}
