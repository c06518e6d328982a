//! `cargo xtask gpu-report`: what each kernel needs, counted in its machine code, and the bounds that follow. No GPU is
//! needed; NVRTC and nvdisasm are. Arguments: `--nvdisasm PATH`, `--arch sm_90`, `--robots FOLDER` of
//! example-robot-data, `--only NAME` of a robot, `--quantity NAME`, `--page FILE` (else standard output).

mod card;
#[path = "../cases/mod.rs"]
mod cases;
mod page;
mod sass;

use cases::Robot;
use mozzi_codegen::{CudaLayout, Precision};
use mozzi_gpu::{Arch, Form, Nvrtc, Resources, Source};
use sass::Instructions;
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

/// Lines of text of the longest kernel that is compiled: longer ones take minutes.
const LONGEST: usize = 20_000;

/// A kernel's counts.
struct Count {
    robot: String,
    n: usize,
    quantity: &'static str,
    form: Form,
    bytes: usize,
    resources: Resources,
    instructions: Instructions,
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let option = |name: &str| arguments.iter().position(|x| x == name).and_then(|k| arguments.get(k + 1));
    let arch: Arch = option("--arch").map_or(Ok(Arch::SM_90), |name| name.parse())?;
    let nvdisasm = option("--nvdisasm").map_or("nvdisasm", String::as_str);
    let nvrtc = Nvrtc::find()?;
    let only = option("--only");
    let robots = cases::robots(option("--robots").map(Path::new))?;
    let mut counts = Vec::new();
    for robot in robots.iter().filter(|robot| only.is_none_or(|name| *name == robot.name)) {
        for (precision, layout) in cases::FORMS {
            for (query, is_packed) in cases::quantities(option("--quantity").map(String::as_str)) {
                let form = Form { precision, layout, is_packed };
                let source = Source::new(&robot.model, query, form)?;
                if source.text().lines().count() > LONGEST {
                    eprintln!("{} {} {form:?}: left out, longer than {LONGEST} lines", robot.name, query.name());
                    continue;
                }
                counts.push(count(robot, query.name(), &source, &nvrtc, arch, nvdisasm)?);
                let Count { robot, quantity, resources, .. } = &counts[counts.len() - 1];
                eprintln!("{robot} {quantity} {form:?}: {resources:?}");
            }
        }
    }
    let text = page::text(&counts, arch, nvrtc.version());
    match option("--page") {
        Some(path) => std::fs::write(path, text)?,
        None => println!("{text}"),
    }
    Ok(())
}

fn count(
    Robot { name, model }: &Robot,
    quantity: &'static str,
    source: &Source,
    nvrtc: &Nvrtc,
    arch: Arch,
    nvdisasm: &str,
) -> Result<Count, Box<dyn Error>> {
    let binary = source.compile(nvrtc, arch)?;
    let file = std::env::temp_dir().join(format!("mozzi-{}.cubin", std::process::id()));
    std::fs::write(&file, binary.code())?;
    let output = std::process::Command::new(nvdisasm).arg("-c").arg(&file).output();
    std::fs::remove_file(&file)?;
    let output = output.map_err(|error| format!("{nvdisasm}: {error}"))?;
    if !output.status.success() {
        return Err(format!("{nvdisasm}: {}", String::from_utf8_lossy(&output.stderr)).into());
    }
    let instructions = Instructions::count(&String::from_utf8_lossy(&output.stdout));
    Ok(Count {
        robot: name.clone(),
        n: model.n(),
        quantity,
        form: source.form(),
        bytes: source.bytes_of_state(),
        resources: binary.resources().ok_or("this NVRTC reports no registers; 13.5 does")?,
        instructions,
    })
}

/// `f32` or `f64`.
fn name(precision: Precision) -> &'static str {
    if precision == Precision::F64 { "f64" } else { "f32" }
}

/// `rows` or `SoA`.
fn layout(layout: CudaLayout) -> &'static str {
    if layout == CudaLayout::Rows { "rows" } else { "SoA" }
}
