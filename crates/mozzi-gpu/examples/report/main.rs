//! `cargo xtask gpu-report`: what each kernel needs, counted in its machine code, and the bounds that follow. No GPU is
//! needed; NVRTC and nvdisasm are. Arguments: those of `cases`, `--nvdisasm PATH`, `--arch sm_90`.

mod card;
#[path = "../cases/mod.rs"]
mod cases;
mod page;
mod sass;

use cases::{Arguments, Robot};
use mozzi_gpu::{Arch, Form, Nvrtc, Resources, Source};
use sass::Instructions;
use std::error::Error;
use std::process::ExitCode;

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
    cases::run(run)
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let arch: Arch = arguments.option("--arch").map_or(Ok(Arch::SM_90), str::parse)?;
    let nvdisasm = arguments.option("--nvdisasm").unwrap_or("nvdisasm");
    let nvrtc = Nvrtc::find()?;
    let robots = arguments.robots()?;
    let mut counts = Vec::new();
    for (robot, query, form) in arguments.kernels(&robots) {
        let source = Source::new(&robot.model, query, form)?;
        let counted = count(robot, query.name(), &source, &nvrtc, arch, nvdisasm)?;
        eprintln!("{} {} {form:?}: {:?}", counted.robot, counted.quantity, counted.resources);
        counts.push(counted);
    }
    arguments.write(&page::text(&counts, arch, nvrtc.version()))
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
