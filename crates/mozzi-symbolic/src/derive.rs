//! A quantity of a robot, from its kernel on symbols to what is printed.

use crate::angles;
use crate::atom::{Class, Id};
use crate::collect::Grouping;
use crate::cse;
use crate::expression::{Expression, Operations};
use crate::order::ranks;
use crate::parameters::{Equal, Meaning, Parameters, Symbols};
use crate::polynomial::Polynomial;
use crate::proof;
use crate::rational::Rational;
use crate::read::NotRead;
use crate::sines::shortened;
use crate::symbol::{Symbol, end, start, with_table};
use crate::table::{Fault, Table};
use mozzi::quantities::{Memory, Query};
use mozzi::{Description, Environment, FrameId, Model, Scalar, Wrench};
use std::fmt;

/// How sums are grouped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Collect {
    /// The shortest of the candidates.
    #[default]
    Shortest,
    /// By products of velocities.
    Velocities,
}

/// What is derived, and how it is written.
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

/// The reason why there is no derivation.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Error {
    /// The second reader does not read the file.
    NotRead(NotRead),
    /// mozzi's own error.
    Model(mozzi::Error),
    /// The quantity is no polynomial in sines and parameters.
    NotPolynomial {
        /// The quantity.
        quantity: &'static str,
        /// What its kernel does.
        what: String,
    },
    /// The robot has no recursion in the book's form.
    NoRecursion(String),
    /// The expressions would be too long.
    TooLong {
        /// The quantity.
        quantity: &'static str,
        /// The terms of its largest entry.
        terms: usize,
    },
    /// An expression differs from the kernel: an error of this library.
    NotProven {
        /// The quantity.
        quantity: &'static str,
        /// The entry.
        entry: usize,
        /// What was found.
        what: String,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::NotRead(error) => write!(f, "the file's decimals: {error}"),
            Error::Model(error) => error.fmt(f),
            Error::NotPolynomial { quantity, what } => {
                let quantity = quantity.replace('_', "-");
                write!(
                    f,
                    "{quantity} {what}: it is no sum of products of sines and parameters. Derived are quantities \
                     without an inverse, such as mass-matrix, velocity-product, gravity-forces and inverse-dynamics"
                )
            }
            Error::NoRecursion(what) => write!(
                f,
                "the recursion is printed for joints that slide, or turn about an axis of their link, on a fixed base; \
                 the robot has {what}"
            ),
            Error::TooLong { quantity, terms } => {
                let quantity = quantity.replace('_', "-");
                write!(
                    f,
                    "{quantity} would have sums of {terms} terms, expected at most {LONGEST}. Numbers instead of symbols \
                     are shorter (symbols: none), and so are robots with locked joints"
                )
            }
            Error::NotProven { quantity, entry, what } => {
                write!(f, "entry {entry} of {quantity} is not proven, and is not printed: {what}. Please report this")
            }
        }
    }
}
impl std::error::Error for Error {}

impl From<mozzi::Error> for Error {
    fn from(error: mozzi::Error) -> Self {
        Error::Model(error)
    }
}

/// An output of a quantity in symbols.
#[derive(Clone, Debug)]
pub struct Formula {
    /// Its declared name: `M`, `c` …
    pub name: &'static str,
    /// Its shape; empty for a number.
    pub shape: Vec<usize>,
    /// Whether it is a symmetric matrix.
    pub is_symmetric: bool,
    pub(crate) entries: Vec<Expression>,
}

/// The formulas of a quantity, proven.
#[derive(Clone, Debug)]
pub struct Derivation {
    /// The quantity's name.
    pub quantity: &'static str,
    /// Its outputs.
    pub formulas: Vec<Formula>,
    pub(crate) names: Vec<Expression>,
    /// The numbers of the state, by input.
    pub(crate) inputs: Vec<(&'static str, Vec<Id>)>,
    /// Angles that were read as multiples of π, in multiples.
    pub angles: Vec<(String, Rational)>,
    /// The sum of these readings' differences from the file, rad.
    pub(crate) angle_error: f64,
    /// The symbols that occur.
    pub legend: Vec<Meaning>,
    /// Whether its numbers are those of formulas, ½, and not the file's.
    pub(crate) has_fractions: bool,
    pub(crate) table: Table,
}

impl Derivation {
    /// The operations of all that is printed; entries below the diagonal of symmetric matrices are not counted.
    pub fn operations(&self) -> Operations {
        let mut atoms = std::collections::BTreeSet::new();
        let mut all = Operations::default();
        let mut add = |expression: &Expression| {
            let count = expression.count();
            all.additions += count.additions;
            all.products += count.products;
            expression.atoms(&mut atoms);
        };
        self.names.iter().for_each(&mut add);
        for formula in &self.formulas {
            formula.distinct().for_each(|k| add(&formula.entries[k]));
        }
        all.sines = atoms.iter().filter(|&&id| self.table.class(id) == Class::Trigonometric).count();
        all
    }
}

impl Formula {
    /// The entries that are printed by themselves: of a symmetric matrix those on and above the diagonal.
    pub(crate) fn distinct(&self) -> impl Iterator<Item = usize> + '_ {
        let columns = self.shape.last().copied().unwrap_or(1).max(1);
        (0..self.entries.len()).filter(move |k| !self.is_symmetric || k / columns <= k % columns)
    }
}

/// Longer entries are not derived: a person reads none of them, and grouping takes longer and longer.
const LONGEST: usize = 30_000;

/// Fails if an operation left the polynomials.
pub(crate) fn check_fault(quantity: &'static str) -> Result<(), Error> {
    match with_table(|table| table.fault.take()) {
        None => Ok(()),
        Some(Fault::Left(what)) => Err(Error::NotPolynomial { quantity, what }),
        Some(Fault::TooLong(terms)) => Err(Error::TooLong { quantity, terms }),
    }
}

/// The robot in symbols, in a derivation that starts.
pub(crate) fn described(
    model: &Model,
    text: Option<&str>,
    options: &Options,
) -> Result<(Description<Symbol>, Parameters), Error> {
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
    query.check_subject(model)?;
    let declaration = query.declaration();
    let quantity = declaration.name;
    if declaration.divides {
        return Err(Error::NotPolynomial { quantity, what: "divides by pivots".into() });
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
    let outputs = kernel(&query, &symbolic, &inputs, tip);
    check_fault(quantity)?;
    let mut found: Vec<Vec<Polynomial>> = Vec::new();
    for output in &outputs {
        found.push(output.iter().map(|x| x.polynomial()).collect());
    }
    let terms = found.iter().flatten().map(|p| p.terms().len()).max().unwrap_or(0);
    if terms > LONGEST {
        return Err(Error::TooLong { quantity, terms });
    }
    let mut formulas: Vec<Formula> = with_table(|table| {
        declaration
            .outputs
            .iter()
            .zip(query.shapes(model))
            .zip(&found)
            .map(|((output, shape), entries)| Formula {
                name: output.name,
                shape,
                is_symmetric: output.is_symmetric,
                entries: written(table, entries, options.collect),
            })
            .collect()
    });
    let names = if options.names { cse::name(&mut formulas) } else { Vec::new() };
    proof::prove(&query, &symbolic, &inputs, tip, &formulas, &names)?;
    let id = |x: &Symbol| x.single_atom().unwrap_or_default();
    let ids = names_of_inputs.into_iter().zip(&inputs).map(|(of, all)| (of, all.iter().map(id).collect())).collect();
    let table = end();
    let has_fractions = options.symbols.are_all();
    let (angles, angle_error, legend_of_all) = (parameters.angles, parameters.angle_error, parameters.legend);
    let mut derivation = Derivation {
        quantity,
        formulas,
        names,
        inputs: ids,
        angles,
        angle_error,
        legend: Vec::new(),
        has_fractions,
        table,
    };
    let entries = derivation.formulas.iter().flat_map(|formula| &formula.entries);
    let entries: Vec<&Expression> = derivation.names.iter().chain(entries).collect();
    derivation.legend = legend_of(&derivation.table, &entries, legend_of_all);
    proof::compare(&derivation, &query, model, tip)?;
    Ok(derivation)
}

/// The quantity's outputs on symbols; the last input is the wrench of the tip, if there is one.
pub(crate) fn kernel(
    query: &Query,
    model: &Model<Symbol>,
    inputs: &[Vec<Symbol>],
    tip: Option<FrameId>,
) -> Vec<Vec<Symbol>> {
    let mut outputs: Vec<Vec<Symbol>> =
        query.output_lengths(model).map(|length| vec![Symbol::zero(); length]).collect();
    let mut slices: Vec<&mut [Symbol]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
    let (inputs, wrench) = inputs.split_at(query.declaration().inputs.len());
    let applied: Vec<(FrameId, Wrench<Symbol>)> =
        tip.into_iter().zip(wrench).map(|(tip, F)| (tip, Wrench::from_array(std::array::from_fn(|k| F[k])))).collect();
    let environment = Environment { applied: &applied, ..model.environment() };
    let inputs: Vec<&[Symbol]> = inputs.iter().map(Vec::as_slice).collect();
    query.evaluate(model, &inputs, &environment, &mut Memory::new(model), &mut slices);
    outputs
}

/// The shortest forms of polynomials.
pub(crate) fn written(table: &mut Table, entries: &[Polynomial], collect: Collect) -> Vec<Expression> {
    let shortened: Vec<_> = entries.iter().map(|p| shortened(table, p)).collect();
    let classes: Vec<Class> = (0..table.len() as u32).map(|id| table.class(id)).collect();
    let ranks = ranks(table);
    let grouping = Grouping { classes: &classes, ranks: &ranks };
    let write = |terms: &Vec<_>| match collect {
        Collect::Shortest => grouping.shortest(terms),
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
