//! `mozzi codegen`: a robot's quantities as source text, and their operation counts after folding.

use super::assemble::check_constraints;
use super::info;
use crate::failure::{Failure, Result};
use crate::json;
use crate::missing;
use crate::quantity::{hyphenated, quantity};
use crate::robot::{RobotArguments, end_effector};
use crate::state::check_frames;
use crate::task::TaskArguments;
use crate::text::{Page, table};
use crate::workload::count;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use mozzi::Model;
use mozzi::quantities::{LIST, Of, Query, Uses};
use mozzi_engine::{
    Arguments, Count, Derivative, Kernel, LONGEST_TEXT, Language, Number, Precision, Refusal, Shape, SourceFile, emit,
    emit_casadi, estimate, record_quantity,
};
use mozzi_symbolic::dependent_rows;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
pub struct CodegenArguments {
    #[command(flatten)]
    robot: RobotArguments,
    #[command(flatten)]
    task: TaskArguments,
    /// The quantities to generate: M c g tau J_b … [default with --explain: all]
    #[arg(value_name = "QUANTITY", value_parser = quantity(), required_unless_present_any = ["explain", "named"])]
    quantity: Vec<Query<'static>>,
    /// A quantity to generate; may be repeated
    #[arg(long = "quantity", value_name = "NAME", value_parser = quantity())]
    named: Vec<Query<'static>>,
    /// Language of the source text
    #[arg(long, value_name = "LANGUAGE", value_parser = language(), requires = "out", required_unless_present = "explain")]
    lang: Option<Target>,
    /// Number type of the source text, and of the machine code that is measured
    #[arg(long, default_value = "f64", value_parser = precision())]
    precision: Precision,
    /// Folder for the files; created if it does not exist
    #[arg(long, value_name = "DIR", requires = "lang")]
    out: Option<PathBuf>,
    /// Keep this as a function argument instead of a constant: parameters (masses, inertias, frictions, springs),
    /// gravity, base-twist, base-acceleration (the rates of that twist, not the acceleration of the base's origin),
    /// about (reference point of a momentum), wrench (applied by the end effector) or wrench=FRAME; may be repeated
    #[arg(long, value_name = "WHAT", value_parser = argument)]
    argument: Vec<Argument>,
    /// Generate the directional derivative, too: a rate of each input is a further argument, that of each output a
    /// further result (forward mode)
    #[arg(long)]
    jvp: bool,
    /// Allow programs of more than 150000 operations
    #[arg(long)]
    allow_large: bool,
    /// Print the number of operations before and after folding constants, and the length of the machine code
    #[arg(long)]
    explain: bool,
}

/// The program that compiles or calls the source text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Target {
    Text(Language),
    Casadi,
}

fn language() -> impl TypedValueParser<Value = Target> {
    let value = |name, help| PossibleValue::new(name).help(help);
    let values = [
        value("rust", "One file without std, allocation or panic"),
        value("c", "C99, a header and a source"),
        value("cuda", "CUDA C, one thread per state"),
        value("casadi", "C99 for casadi.external, with Jacobians"),
    ];
    PossibleValuesParser::new(values).map(|name| match name.as_str() {
        "rust" => Target::Text(Language::Rust),
        "c" => Target::Text(Language::C),
        "cuda" => Target::Text(Language::Cuda),
        _ => Target::Casadi,
    })
}

fn precision() -> impl TypedValueParser<Value = Precision> {
    PossibleValuesParser::new(["f64", "f32"]).map(|name| if name == "f64" { Precision::F64 } else { Precision::F32 })
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Argument {
    Parameters,
    Gravity,
    BaseTwist,
    BaseAcceleration,
    About,
    /// Applied by this frame, or by the end effector.
    Wrench(Option<String>),
}

fn argument(text: &str) -> Result<Argument, String> {
    Ok(match text {
        "parameters" => Argument::Parameters,
        "gravity" => Argument::Gravity,
        "base-twist" => Argument::BaseTwist,
        "base-acceleration" => Argument::BaseAcceleration,
        "about" => Argument::About,
        "wrench" => Argument::Wrench(None),
        _ => match text.strip_prefix("wrench=") {
            Some(frame) => Argument::Wrench(Some(frame.to_string())),
            None => {
                let names = "parameters, gravity, base-twist, base-acceleration, about, wrench, wrench=FRAME";
                return Err(format!("expected one of {names}"));
            }
        },
    })
}

pub fn run(arguments: &CodegenArguments) -> Result<String> {
    let model = arguments.robot.load()?;
    let mut frames = Vec::new();
    for argument in &arguments.argument {
        if let Argument::Wrench(name) = argument {
            frames.push(name.as_ref().map_or_else(|| model.end_effector(), |name| model.frame(name))?);
        }
    }
    check_frames(&model, frames.iter().copied())?;
    let is_argument = |what: Argument| arguments.argument.contains(&what);
    let further = Arguments {
        parameters: is_argument(Argument::Parameters),
        gravity: is_argument(Argument::Gravity),
        base_twist: is_argument(Argument::BaseTwist),
        base_acceleration: is_argument(Argument::BaseAcceleration),
        about: is_argument(Argument::About),
        wrenches: &frames,
        derivative: if arguments.jvp { Derivative::RATES } else { Derivative::None },
    };
    let mut queries = [arguments.quantity.as_slice(), &arguments.named].concat();
    let is_named = !queries.is_empty();
    check_constraints(queries.iter().copied(), &model)?;
    arguments.task.check_use(queries.iter().copied())?;
    if queries.is_empty() {
        let has_end = end_effector(&model).is_some();
        queries =
            (0..LIST.len()).map(Query::at).filter(|query| has_end || !query.declaration().needs_frame()).collect();
    }
    let rows = arguments.task.rows()?;
    let subject = |query| arguments.task.subject(query, &rows, &model);
    let queries = queries.into_iter().map(subject).collect::<Result<Vec<Query>>>()?;
    let queries = if is_named {
        let is_nothing = |query: &&Query| query.declaration().uses == Uses::WRENCHES && frames.is_empty();
        if let Some(query) = queries.iter().find(is_nothing) {
            let name = hyphenated(query.name());
            return Err(Failure::wrong(format!("{name} of no wrench is 0: --argument wrench=FRAME gives it one")));
        }
        queries.iter().try_for_each(|query| check_task(&model, query))?;
        queries
    } else {
        missing::those_of(queries, &model)
    };
    if !arguments.allow_large {
        queries.iter().try_for_each(|&query| check_length(&model, query))?;
    }
    let precision = arguments.precision;
    let files = match (arguments.lang, &arguments.out) {
        (Some(target), Some(folder)) => {
            let emitted = match target {
                Target::Text(language) => emit(&model, &queries, further, language, precision),
                Target::Casadi if precision == Precision::F32 => {
                    return Err(Failure::wrong("--precision is f32, expected f64: CasADi's functions take doubles"));
                }
                Target::Casadi => emit_casadi(&model, &queries, further),
            };
            write(folder, &emitted.map_err(|error| Failure::wrong(error.to_string()))?)?
        }
        _ => Vec::new(),
    };
    let works = match arguments.explain {
        true => {
            queries.iter().map(|&query| Work::of(&model, query, further, precision)).collect::<Result<Vec<Work>>>()?
        }
        false => Vec::new(),
    };
    if arguments.robot.json {
        return Ok(object(&model, precision, &files, &works));
    }
    let mut page = Page::default();
    files.iter().for_each(|(path, bytes)| {
        page.line(format!("{path}: {bytes} bytes"));
    });
    if !works.is_empty() {
        explain(&mut page, &model, &works);
    }
    Ok(page.end())
}

/// Checks that the rows of a task are independent somewhere: else its program divides by 0.
fn check_task(model: &Model, query: &Query) -> Result<()> {
    let dependent = if query.declaration().of == Of::Task { dependent_rows(model, query)? } else { None };
    match dependent {
        Some(why) => {
            Err(Failure::wrong(format!("{} is not generated: {why}; --task names them", hyphenated(query.name()))))
        }
        None => Ok(()),
    }
}

/// Recording a long program, and compiling its text, takes minutes and gigabytes.
fn check_length(model: &Model, query: Query) -> Result<()> {
    query.check_subject(model)?;
    let operations = estimate(model, query);
    if operations <= LONGEST_TEXT {
        return Ok(());
    }
    Err(Failure::wrong(format!(
        "{} of `{}` would be about {} operations without loops, expected at most {}; --allow-large allows more",
        hyphenated(query.name()),
        model.description().name,
        count(operations),
        count(LONGEST_TEXT)
    )))
}

/// Writes the files; returns their paths and lengths.
fn write(folder: &Path, files: &[SourceFile]) -> Result<Vec<(String, usize)>> {
    let write = |file: &SourceFile| {
        let path = file.write(folder).map_err(|error| Failure::wrong(error.to_string()))?;
        Ok((path.display().to_string(), file.text.len()))
    };
    files.iter().map(write).collect()
}

/// The work to compute a quantity on this robot.
struct Work {
    name: String,
    before: Option<Count>,
    after: Count,
    /// For one state, and for as many states as fit into a register.
    code: [(Shape, Result<Kernel, Refusal>); 2],
}

impl Work {
    fn of(model: &Model, query: Query, further: Arguments, precision: Precision) -> Result<Self> {
        let program = record_quantity(model, query, further)?;
        let (one, widest, otherwise) = match precision {
            Precision::F64 => (Shape::one_f64(), <f64 as Number>::shape(), Shape::FourF64),
            Precision::F32 => (Shape::one_f32(), <f32 as Number>::shape(), Shape::EightF32),
        };
        let lanes = widest.unwrap_or(otherwise);
        Ok(Work {
            name: hyphenated(query.name()),
            before: program.count_before_folding(),
            after: program.count(),
            code: [one, lanes].map(|shape| (shape, Kernel::new(&program, shape))),
        })
    }
}

fn explain(page: &mut Page, model: &Model, works: &[Work]) {
    let lanes: Vec<Shape> = works[0].code.iter().map(|(shape, _)| *shape).collect();
    page.line(info::headline(model));
    page.line("Recorded with this robot's constants: zeros, ones and common subexpressions are folded away.");
    let states = |shape: &Shape| mozzi_urdf::counted(shape.lanes(), "state");
    let title = format!("flops, and bytes of machine code ({})", lanes[1].instruction_set());
    let mut rows = vec![["", "before", "after", "left", "div", "sqrt", "sin, cos"].map(String::from).to_vec()];
    rows[0].extend(lanes.iter().map(states));
    let mut refusals = Vec::new();
    for work in works {
        let (after, before) = (work.after, work.before.map_or(0, |count| count.flops()));
        let percent = (100 * after.flops() + before / 2).checked_div(before);
        let left = percent.map_or("–".to_string(), |percent| format!("{percent} %"));
        let mut row = vec![work.name.clone(), before.to_string(), after.flops().to_string(), left];
        row.extend([after.div, after.sqrt, after.sin_cos].map(|count| count.to_string()));
        for (shape, kernel) in &work.code {
            row.push(kernel.as_ref().map_or("–".to_string(), |kernel| kernel.code_bytes().to_string()));
            if let Err(refusal) = kernel {
                refusals.push(format!("{}, {}: {refusal}", work.name, states(shape)));
            }
        }
        rows.push(row);
    }
    page.title(&title).lines(&table(&rows, "lr"));
    if !refusals.is_empty() {
        page.title("no machine code").lines(&refusals);
    }
}

fn object(model: &Model, precision: Precision, files: &[(String, usize)], works: &[Work]) -> String {
    let count = |count: &Count| {
        let Count { add, mul, fma, div, sqrt, sin_cos, other } = count;
        json!({
            "flops": count.flops(), "add": add, "mul": mul, "fma": fma, "div": div, "sqrt": sqrt, "sin_cos": sin_cos, "other": other,
        })
    };
    let code = |(shape, kernel): &(Shape, Result<Kernel, Refusal>)| {
        json!({
            "states": shape.lanes(), "instruction_set": shape.instruction_set(),
            "bytes": kernel.as_ref().ok().map(Kernel::code_bytes),
            "instructions": kernel.as_ref().ok().map(Kernel::instructions),
            "none_because": kernel.as_ref().err().map(Refusal::to_string),
        })
    };
    let work = |work: &Work| {
        json!({
            "quantity": work.name, "before": work.before.as_ref().map(count), "after": count(&work.after),
            "machine_code": work.code.iter().map(code).collect::<Value>(),
        })
    };
    let file = |(path, bytes): &(String, usize)| json!({ "path": path, "bytes": bytes });
    json::print(&json::of_robot(
        model,
        json!({
            "precision": format!("{precision:?}").to_lowercase(),
            "files": files.iter().map(file).collect::<Value>(), "work": works.iter().map(work).collect::<Value>(),
        }),
    ))
}
