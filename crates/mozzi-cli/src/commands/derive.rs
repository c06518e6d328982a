//! `mozzi derive`: a robot's equations in symbols.

use super::assemble::check_constraints;
use crate::failure::{self, Failure, Result};
use crate::json;
use crate::quantity::{hyphenated, quantity};
use crate::robot::RobotArguments;
use crate::task::TaskArguments;
use crate::text::table;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use mozzi::Model;
use mozzi::quantities::{LIST, Query};
use mozzi_symbolic::{
    Collect, Derivation, Equal, Error, Language, Options, Symbols, base_parameters, derive, is_fraction, print_all,
    steps,
};
use serde_json::{Value, json};
use std::ffi::OsStr;

#[derive(Args, Debug)]
pub struct DeriveArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// The quantities: M c g tau T J_b M_inv Lambda … base-parameters [default: M c g]
    #[arg(value_name = "QUANTITY", value_parser = Names, value_delimiter = ',')]
    quantity: Vec<Wanted>,
    #[command(flatten)]
    task: TaskArguments,
    /// Form of the equations
    #[arg(long = "as", value_name = "FORM", default_value = "text", value_parser = language())]
    language: Language,
    /// The numbers of the file that become symbols, separated by commas: masses, lengths, inertias, gravity, joints
    /// (friction and springs), all, none [default: all up to three moving links, else none]
    #[arg(long, value_name = "KIND,…", value_parser = symbols)]
    symbols: Option<Symbols>,
    /// Equal numbers of one kind that share a symbol
    #[arg(long, value_name = "WHERE", default_value = "none", value_parser = equal())]
    equal: Equal,
    /// Grouping of sums
    #[arg(long, value_name = "HOW", default_value = "shortest", value_parser = collect())]
    collect: Collect,
    /// Name sub-expressions that occur more than once
    #[arg(long)]
    cse: bool,
    /// Print the Newton-Euler recursion link by link: T, 𝒜, 𝒱, 𝒱̇, 𝒢, 𝓕, τ, and the blocks of 𝒲 and ℒ
    #[arg(long, conflicts_with_all = ["quantity", "cse", "collect"])]
    steps: bool,
    /// List the quantities that can be derived
    #[arg(long)]
    list: bool,
}

/// A quantity, or the base parameters.
#[derive(Clone, Copy, Debug)]
enum Wanted {
    Quantity(Query<'static>),
    BaseParameters,
}

impl Wanted {
    fn query(&self) -> Option<Query<'static>> {
        match self {
            Wanted::Quantity(query) => Some(*query),
            Wanted::BaseParameters => None,
        }
    }
}

const BASE_PARAMETERS: (&str, &str) =
    ("base-parameters", "π_b = Kπ and Y_b(θ, θ̇, θ̈): τ = Y_b π_b, with the fewest combinations of the parameters π");

/// The names of quantities, and `base-parameters`.
#[derive(Clone)]
struct Names;

impl TypedValueParser for Names {
    type Value = Wanted;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> std::result::Result<Wanted, clap::Error> {
        if value.to_string_lossy().replace('_', "-") == BASE_PARAMETERS.0 {
            return Ok(Wanted::BaseParameters);
        }
        quantity().parse_ref(command, argument, value).map(Wanted::Quantity)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let (name, help) = BASE_PARAMETERS;
        let own = PossibleValue::new(name).help(help);
        Some(Box::new(quantity().possible_values()?.collect::<Vec<_>>().into_iter().chain([own])))
    }
}

/// A value by its name and help.
type Named<T> = (&'static str, &'static str, T);

fn one_of<T: Copy + Send + Sync + 'static, const N: usize>(values: [Named<T>; N]) -> impl TypedValueParser<Value = T> {
    let shown = values.map(|(name, help, _)| PossibleValue::new(name).help(help));
    PossibleValuesParser::new(shown).map(move |name| {
        let found = values.iter().find(|value| value.0 == name);
        found.unwrap_or(&values[0]).2
    })
}

fn language() -> impl TypedValueParser<Value = Language> {
    one_of([
        ("text", "The book's letters", Language::Text),
        ("latex", "LaTeX with amsmath", Language::Latex),
        ("markdown", "Markdown with LaTeX formulas and a table of the symbols", Language::Markdown),
        ("sympy", "A Python module of SymPy expressions, with exact numbers", Language::Sympy),
        ("python", "A Python function of NumPy arrays", Language::Python),
        ("matlab", "A MATLAB function", Language::Matlab),
        ("julia", "A Julia function", Language::Julia),
    ])
}

fn equal() -> impl TypedValueParser<Value = Equal> {
    one_of([
        ("none", "Each number of the file is a symbol of its own", Equal::Separate),
        ("link", "Equal numbers of one link share a symbol", Equal::OfLink),
        ("robot", "Equal numbers of the robot share a symbol", Equal::OfRobot),
    ])
}

fn collect() -> impl TypedValueParser<Value = Collect> {
    one_of([
        ("shortest", "The fewest operations of several candidates", Collect::Shortest),
        ("velocities", "By products of velocities: Christoffel symbols as factors", Collect::Velocities),
    ])
}

fn symbols(text: &str) -> Result<Symbols, String> {
    let mut symbols = Symbols::NONE;
    for word in text.split(',') {
        match word.trim() {
            "masses" => symbols.masses = true,
            "lengths" => symbols.lengths = true,
            "inertias" => symbols.inertias = true,
            "gravity" => symbols.gravity = true,
            "joints" => symbols.joints = true,
            "all" => symbols = Symbols::ALL,
            "none" => symbols = Symbols::NONE,
            word => {
                return Err(format!(
                    "found `{word}`, expected some of masses, lengths, inertias, gravity, joints, all, none"
                ));
            }
        }
    }
    Ok(symbols)
}

pub fn run(arguments: &DeriveArguments) -> Result<String> {
    let model = arguments.robot.load()?;
    if arguments.list {
        return Ok(list());
    }
    let default = if model.moving_links() <= 3 { Symbols::ALL } else { Symbols::NONE };
    let options = Options {
        symbols: arguments.symbols.unwrap_or(default),
        equal: arguments.equal,
        collect: arguments.collect,
        names: arguments.cse,
    };
    if arguments.steps {
        return recursion(arguments, &model, &options);
    }
    let mut queries = arguments.quantity.clone();
    if queries.is_empty() {
        let named = |name| Query::named(name).map(Wanted::Quantity);
        queries = ["M", "c", "g"].into_iter().map(named).collect::<Result<Vec<Wanted>, mozzi::Error>>()?;
    }
    let quantities = || queries.iter().filter_map(Wanted::query);
    arguments.task.check_use(quantities())?;
    check_constraints(quantities(), &model)?;
    let rows = arguments.task.rows()?;
    let mut text = arguments.robot.urdf_text();
    let mut derivations = Vec::new();
    let mut refused = None;
    for wanted in queries {
        let query = wanted.query().map(|query| arguments.task.subject(query, &rows, &model)).transpose()?;
        let found = by_decimals(&mut text, |text| match query {
            Some(query) => derive(&model, text, query, &options),
            None => base_parameters(&model, text, &options),
        });
        match found {
            Ok(derivation) => derivations.push(derivation),
            Err(failure) if derivations.is_empty() => return Err(failure),
            Err(failure) => {
                refused = Some(failure);
                break;
            }
        }
    }
    let page = match arguments.robot.json {
        true => object(&model, &derivations),
        false => print_all(&derivations, arguments.language),
    };
    // what is derived is printed, then why the next is not
    match refused {
        Some(failure) => {
            failure.say();
            Err(Failure::Answered(page))
        }
        None => Ok(page),
    }
}

/// By the file's decimals, else by the shortest decimals of the robot's numbers, with a note.
fn by_decimals<T>(text: &mut Option<String>, find: impl Fn(Option<&str>) -> Result<T, Error>) -> Result<T> {
    let mut found = find(text.as_deref());
    if let (Err(Error::NotRead(error)), true) = (&found, text.is_some()) {
        failure::note(&format!("the file's decimals are not used, but the robot's shortest decimals: {error}"));
        *text = None;
        found = find(None);
    }
    found.map_err(|error| Failure::wrong(error.to_string()))
}

fn recursion(arguments: &DeriveArguments, model: &Model, options: &Options) -> Result<String> {
    let steps = by_decimals(&mut arguments.robot.urdf_text(), |text| steps(model, text, options))?;
    let page = steps.print(arguments.language);
    page.ok_or_else(|| Failure::wrong("--steps is printed as text, latex or markdown".to_string()))
}

/// All quantities without those whose kernels divide, unless they are written as fractions.
fn list() -> String {
    let rows = LIST.iter().filter(|declared| !declared.divides || is_fraction(declared.name));
    let rows = rows.map(|declared| vec![hyphenated(declared.name), declared.formula.into()]);
    let rows: Vec<Vec<String>> = rows.chain([vec![BASE_PARAMETERS.0.into(), BASE_PARAMETERS.1.into()]]).collect();
    table(&rows, "ll").iter().map(|line| format!("{line}\n")).collect()
}

fn object(model: &Model, derivations: &[Derivation]) -> String {
    let one = |derivation: &Derivation| {
        let count = derivation.operations();
        let symbol = |meaning: &mozzi_symbolic::Meaning| {
            json!({
                "name": meaning.plain_name(), "value": meaning.value.to_f64(), "exact": meaning.value.to_string(),
                "unit": meaning.unit, "places": meaning.places,
            })
        };
        json!({
            "quantity": hyphenated(derivation.quantity),
            "text": derivation.print(Language::Text),
            "latex": derivation.print(Language::Latex),
            "sympy": derivation.print(Language::Sympy),
            "operations": { "additions": count.additions, "products": count.products, "sines": count.sines },
            "symbols": derivation.legend.iter().map(symbol).collect::<Value>(),
        })
    };
    json::print(&json::of_robot(model, json!({ "derivations": derivations.iter().map(one).collect::<Value>() })))
}
