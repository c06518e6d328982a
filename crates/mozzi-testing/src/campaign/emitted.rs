//! A robot's quantities as C, compiled, and run by a small program that prints the outputs.

use crate::campaign::generate;
use crate::campaign::log::{Counts, Finding, Way};
use crate::campaign::run::noted;
use crate::campaign::trial::{Plain, Trial};
use mozzi::quantities::{LIST, Query};
use mozzi_engine::{Arguments, Language, Precision, emit_programs, is_too_long, record_quantity};
use std::path::Path;
use std::process::Command;

/// Robots of which one is emitted.
pub const ONE_IN: u64 = 2000;

/// Quantities of a robot that are emitted, in turn.
const EMITTED: usize = 14;

/// True if there is a C compiler: `CC`, or cc.
pub fn has_compiler() -> bool {
    Command::new(compiler()).arg("--version").output().is_ok_and(|output| output.status.success())
}

fn compiler() -> std::ffi::OsString {
    std::env::var_os("CC").unwrap_or_else(|| "cc".into())
}

/// Compares the robot of a seed, if it has joints, in its own environment.
///
/// # Errors
/// A message if files cannot be written, or the compiler fails.
pub fn one(seed: u64, folder: &Path, counts: &mut Counts) -> Result<Vec<Finding>, String> {
    let mut case = generate::case(seed);
    (case.base_twist, case.base_acceleration, case.gravity) = ([0.0; 6], [0.0; 6], None);
    case.applied.clear();
    let Ok(model) = case.robot.clone().build() else { return Ok(Vec::new()) };
    if model.n() == 0 {
        return Ok(Vec::new()); // C has no empty arrays
    }
    let Some(mut trial) = Trial::new(&case, &model) else { return Ok(Vec::new()) };
    let first = (seed / ONE_IN) as usize * EMITTED;
    let mut plains: Vec<Plain> = Vec::new();
    for k in 0..EMITTED {
        let index = (first + k) % LIST.len();
        if !is_too_long(&model, Query::at(index)) {
            plains.extend(trial.plain(index));
        }
    }
    let said = |error: &dyn std::fmt::Display| format!("seed {seed}: {error}");
    let record = |plain: &Plain| record_quantity(&model, plain.query(), Arguments::default());
    let programs = plains.iter().map(record).collect::<Result<Vec<_>, _>>().map_err(|error| said(&error))?;
    let files = emit_programs("robot", &programs, Language::C, Precision::F64).map_err(|error| said(&error))?;
    std::fs::create_dir_all(folder).map_err(|error| said(&error))?;
    for file in &files {
        file.write(folder).map_err(|error| said(&error))?;
    }
    let mut main = String::from("#include <stdio.h>\n#include \"robot.h\"\nint main(void) {\n");
    for (plain, program) in plains.iter().zip(&programs) {
        let list = |x: &[f64]| x.iter().map(|x| format!("{x:e}")).collect::<Vec<_>>().join(", ");
        let mut names = Vec::new();
        main += "  {\n";
        for (k, (x, input)) in trial.numbers().inputs(&plain.query()).iter().zip(program.inputs()).enumerate() {
            // an empty array is a pointer
            names.push(if input.length > 0 { format!("i{k}") } else { "0".into() });
            if input.length > 0 {
                main += &format!("    static const double i{k}[] = {{{}}};\n", list(x));
            }
        }
        let outputs: Vec<usize> = program.outputs().iter().map(|output| output.values.len()).collect();
        for (k, &length) in outputs.iter().enumerate() {
            main += &format!("    static double o{k}[{}];\n", length.max(1));
            names.push(format!("o{k}"));
        }
        main += &format!("    robot_{}({});\n", program.name(), names.join(", "));
        for (k, length) in outputs.iter().enumerate().filter(|(_, length)| **length > 0) {
            main += &format!("    for (int k = 0; k < {length}; ++k) printf(\"%.17g \", o{k}[k]);\n");
        }
        main += "    printf(\"\\n\");\n  }\n";
    }
    main += "  return 0;\n}\n";
    std::fs::write(folder.join("main.c"), main).map_err(|error| said(&error))?;
    let mut cc = Command::new(compiler());
    cc.args(["-O0", "-std=c99", "-o", "main", "main.c", "robot.c", "-lm"]).current_dir(folder);
    let built = cc.output().map_err(|error| said(&error))?;
    if !built.status.success() {
        return Err(format!("seed {seed}: {}", String::from_utf8_lossy(&built.stderr)));
    }
    let output = Command::new(folder.join("main")).output().map_err(|error| said(&error))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let mut findings = Vec::new();
    for ((plain, program), line) in plains.iter_mut().zip(&programs).zip(text.lines()) {
        let mut numbers = line.split_whitespace().map(|x| x.parse().unwrap_or(f64::NAN));
        let take = |output: &mozzi_engine::Output| numbers.by_ref().take(output.values.len()).collect();
        let found: Vec<Vec<f64>> = program.outputs().iter().map(take).collect();
        let compared = trial.compare_with(plain, &found, Way::C);
        findings.extend(noted(seed, plain, Way::C, compared, counts));
    }
    Ok(findings)
}
