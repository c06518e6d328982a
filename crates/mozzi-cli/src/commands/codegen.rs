//! `mozzi codegen`: a robot's quantities as source text, and how much work was left of them.

use super::info;
use crate::failure::{Failure, Result};
use crate::json;
use crate::robot::RobotArguments;
use crate::text::{Page, table};
use clap::{Args, ValueEnum};
use mozzi::Model;
use mozzi_codegen::{
    Arguments, Count, Kernel, Language, Precision, Program, Quantity, Refusal, Shape, SourceFile, emit,
};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
pub struct CodegenArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// What is computed; may be repeated [default with --explain: all]
    #[arg(long, value_name = "NAME", required_unless_present = "explain")]
    quantity: Vec<Name>,
    /// The language of the text
    #[arg(long, value_name = "LANGUAGE", requires = "out", required_unless_present = "explain")]
    lang: Option<Lang>,
    /// Of the text's numbers, and of the machine code that is measured
    #[arg(long, default_value = "f64")]
    precision: Bits,
    /// The folder of the files, made where there is none
    #[arg(long, value_name = "DIR", requires = "lang")]
    out: Option<PathBuf>,
    /// An argument of the functions instead of numbers in them; may be repeated
    #[arg(long, value_name = "WHAT")]
    argument: Vec<OpenArgument>,
    /// Tell the work before and after folding, and the length of machine code
    #[arg(long)]
    explain: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Name {
    /// τ of θ, θ̇, θ̈
    InverseDynamics,
    /// M of θ
    MassMatrix,
    /// θ̈ of θ, θ̇, τ
    ForwardDynamics,
    /// h = c + g of θ, θ̇
    BiasForces,
    /// c = C θ̇ of θ, θ̇
    VelocityProduct,
    /// g of θ
    GravityForces,
    /// T_sb of θ, of the end effector
    ForwardKinematics,
    /// J_b of θ, of the end effector
    BodyJacobian,
    /// J_s of θ, of the end effector
    SpaceJacobian,
    /// ∂τ/∂θ, ∂τ/∂θ̇, ∂τ/∂θ̈ = M of θ, θ̇, θ̈
    InverseDynamicsDerivatives,
    /// θ̈ and ∂θ̈/∂θ, ∂θ̈/∂θ̇, ∂θ̈/∂τ = M⁻¹ of θ, θ̇, τ
    ForwardDynamicsDerivatives,
}

impl Name {
    fn of(self, model: &Model) -> Result<Quantity> {
        Ok(match self {
            Name::InverseDynamics => Quantity::InverseDynamics,
            Name::MassMatrix => Quantity::MassMatrix,
            Name::ForwardDynamics => Quantity::ForwardDynamics,
            Name::BiasForces => Quantity::BiasForces,
            Name::VelocityProduct => Quantity::VelocityProduct,
            Name::GravityForces => Quantity::GravityForces,
            Name::ForwardKinematics => Quantity::ForwardKinematics(model.end_effector()?),
            Name::BodyJacobian => Quantity::BodyJacobian(model.end_effector()?),
            Name::SpaceJacobian => Quantity::SpaceJacobian(model.end_effector()?),
            Name::InverseDynamicsDerivatives => Quantity::InverseDynamicsDerivatives,
            Name::ForwardDynamicsDerivatives => Quantity::ForwardDynamicsDerivatives,
        })
    }

    fn is_of_a_frame(self) -> bool {
        matches!(self, Name::ForwardKinematics | Name::BodyJacobian | Name::SpaceJacobian)
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Lang {
    /// One file without std, allocation or panic
    Rust,
    /// C99, a header and a source
    C,
    /// CUDA C, a thread a state
    Cuda,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Bits {
    F64,
    F32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum OpenArgument {
    /// Masses, inertias, frictions
    Parameters,
    /// Gravity in {s}
    Gravity,
    /// What the end effector applies to the environment
    Wrench,
}

pub fn run(arguments: &CodegenArguments) -> Result<String> {
    let model = arguments.robot.load()?;
    let is_open = |what: OpenArgument| arguments.argument.contains(&what);
    let open = Arguments {
        parameters: is_open(OpenArgument::Parameters),
        gravity: is_open(OpenArgument::Gravity),
        wrench: if is_open(OpenArgument::Wrench) { Some(model.end_effector()?) } else { None },
    };
    let mut names = arguments.quantity.clone();
    if names.is_empty() {
        let has_end = crate::robot::end_effector(&model).is_some();
        names = Name::value_variants().iter().copied().filter(|name| has_end || !name.is_of_a_frame()).collect();
    }
    let quantities = names.iter().map(|name| name.of(&model)).collect::<Result<Vec<Quantity>>>()?;
    let precision = match arguments.precision {
        Bits::F64 => Precision::F64,
        Bits::F32 => Precision::F32,
    };
    let files = match (arguments.lang, &arguments.out) {
        (Some(lang), Some(folder)) => {
            let language = match lang {
                Lang::Rust => Language::Rust,
                Lang::C => Language::C,
                Lang::Cuda => Language::Cuda,
            };
            let emitted = emit(&model, &quantities, open, language, precision);
            let emitted = emitted.map_err(|error| Failure::wrong(error.to_string()))?;
            write(folder, &emitted)?
        }
        _ => Vec::new(),
    };
    let works: Vec<Work> = match arguments.explain {
        true => quantities.iter().map(|&quantity| Work::of(&model, quantity, open, precision)).collect(),
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

/// Their paths and lengths.
fn write(folder: &Path, files: &[SourceFile]) -> Result<Vec<(String, usize)>> {
    let write = |file: &SourceFile| {
        let path = file.write(folder).map_err(|error| Failure::wrong(error.to_string()))?;
        Ok((path.display().to_string(), file.text.len()))
    };
    files.iter().map(write).collect()
}

/// What a quantity takes on this robot.
struct Work {
    name: String,
    before: Option<Count>,
    after: Count,
    /// At one state, and at as many as registers hold.
    code: [(Shape, std::result::Result<Kernel, Refusal>); 2],
}

impl Work {
    fn of(model: &Model, quantity: Quantity, open: Arguments, precision: Precision) -> Self {
        let program: Program = quantity.record(model, open);
        let (one, widest, narrower) = match precision {
            Precision::F64 => (Shape::OneF64, Shape::EightF64, Shape::FourF64),
            Precision::F32 => (Shape::OneF32, Shape::SixteenF32, Shape::EightF32),
        };
        let lanes = if widest.is_supported() { widest } else { narrower };
        Work {
            name: quantity.name().replace('_', "-"),
            before: program.count_before_folding(),
            after: program.count(),
            code: [one, lanes].map(|shape| (shape, Kernel::new(&program, shape))),
        }
    }
}

fn explain(page: &mut Page, model: &Model, works: &[Work]) {
    let lanes: Vec<Shape> = works[0].code.iter().map(|(shape, _)| *shape).collect();
    page.line(info::headline(model));
    page.line("Recorded on this robot's numbers: zeros, ones and what is computed twice are folded away.");
    let states = |shape: &Shape| format!("{} state{}", shape.lanes(), if shape.lanes() == 1 { "" } else { "s" });
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
    let code = |(shape, kernel): &(Shape, std::result::Result<Kernel, Refusal>)| {
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
