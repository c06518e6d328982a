//! `cargo xtask test | check | docs | claims | coverage | mutants | book | page | bench | accuracy | campaign |
//! gpu-report | gpu-bench | jit-report | aarch64 | nightly | wheel | weigh | api | release | dist | deb | licences`:
//! the same commands as in CI.
//!
//! Each command is a list of steps; each step is one file. A step passes, fails or is skipped with its reason, and the
//! list at the end shows which. A failing step does not stop the steps after it, but fails the command.

mod accuracy;
mod advisories;
mod bench;
mod book;
mod campaign;
mod circles;
mod claims;
mod command;
mod coverage;
mod cpu;
mod cross;
mod deb;
mod dist;
mod docs;
mod documents;
mod examples;
mod fuzz;
mod glibc;
mod gpu;
mod house_rules;
mod inlining;
mod jit_report;
mod licences;
mod main_job;
mod metadata;
mod module_order;
mod mutants;
mod names;
mod nightly;
mod no_std;
mod oracles;
mod other_targets;
mod package;
mod page;
mod prose;
mod readme;
mod release;
mod report;
mod sbom;
mod source_text;
mod spdx;
mod stamp;
mod tests;
mod third_party;
mod venv;
mod wasm;
mod weigh;
mod wheel;
mod workspace;
mod zig;

use report::Report;
use std::process::ExitCode;
use workspace::Workspace;

const USAGE: &str = "\
usage: cargo xtask COMMAND

  test    build and run everything: Python environment, reference numbers, every test,
          the Python package, its wheel, some fuzzing, the no_std check, every example, the main job,
          the release build's kernels (none may call what is compiled without FMA)
          --torch                                     install PyTorch (5.5 GB), else its tests are skipped
  check   formatting, clippy, documentation, licences, advisories, house rules, prose, length of README and DESIGN,
          whether the pages' bundles are current
          --quick                                     only what compiles nothing, in seconds: before each commit
  docs    rewrite the generated pages of docs/ and README's tables; `test` and `check` compare them
          --readme                                    README's tables alone, from the pages that other commands write
  claims  list every measured number of README and the documentation with the command or test that it comes from
  coverage  lines and regions that the libraries' tests run, into docs/coverage.md; needs llvm-cov of rustc's LLVM
  mutants put a sample of faults into the sources, each shown to the tests that pass it; adds to docs/mutants.md
          --sample 200 --seed 0                       how many, which ones
  book    build the documentation book from book/, docs/ and the sources, with rustdoc, into target/book/html
          --code                                      run its code blocks instead; `test` does that and builds the book
  page    bundle page/ by npm, and mozzi-web if there is a compiler for WebAssembly, into crates/mozzi-report/bundle/;
          `test` checks that both are current
          --check                                     build it elsewhere and compare
  bench   compare with Pinocchio, MuJoCo, KDL, dynibo and CasADi's C, on one core, into benches/RESULTS.md
          --robots ur5,panda,anymal,talos,tree,chain,feet  only these robots, into target/bench/RESULTS.md
          --peers pinocchio,mujoco,kdl,dynibo,casadi  only these libraries, likewise; c,c++,c++-compiled is mozzi from C, C++
          --seconds 15                                for each robot
          --install                                   let apt install clang and KDL first
          --contacts                                  steps with contacts beside MuJoCo's, into benches/CONTACTS.md
          --python                                    compare Python's calls with Pinocchio's and the Modern Robotics package's
  accuracy  measure every quantity in every way, Pinocchio and MuJoCo against numbers of 31 and 71 digits, into docs/accuracy.md
          --states 1000                               of each robot, up to a million
          --references 2                              states at which 71 digits check the reference
          --robots ur5,anymal:floating,FILE.urdf      only these robots, to standard output
          --quantities mass-matrix,forward-dynamics   likewise
          --no-hard                                   without the cases that are hard by design
  campaign  compare every quantity of random robots in two ways: kernel, second way, fused, f32, program, machine code, C;
          adds a row to docs/campaign.md and prints the smallest robot that differs
          --robots 100000                             in all
          --seed 1                                    the first robot's seed
          --resume                                    continue from target/campaign/state.json
          --seconds 600                               stop after this time
  gpu-report  count registers, spills and instructions of the GPU kernels, and the bounds that follow, into docs/gpu.md;
          installs NVRTC and nvdisasm from PyPI into target/nvidia; no GPU is needed
          --arch sm_90                                the architecture
          --only UR5, --quantity mass_matrix          only this robot or quantity, to standard output
  gpu-bench  measure the GPU kernels on this machine's GPU, into benches/GPU.md; beside frax and MuJoCo Warp if
          MOZZI_GPU_PYTHON names a Python with them (benches/gpu/peers.py)
          --only UR5, --quantity mass_matrix          only this robot or quantity, to standard output
          --states 4194304                            at most this many states in an array, likewise
  jit-report  count the instructions of machine code for AArch64 beside x86-64's, into docs/arm.md; any machine does
  aarch64 random programs as machine code for AArch64 by qemu; skipped without qemu-user, a C compiler
          for it and rustup's target
  nightly long simulations, accuracy at 1000 states, random robots, AArch64, WebAssembly in node, fuzzing guided by coverage; hours, with a log in target/nightly
          --seconds 3600                              for each fuzz target
  wheel   build the Python package for Linux into target/wheels, install it into an empty environment, run its README and
          the notebooks
          --sdist                                     also the source distribution, twice; build the wheel from it elsewhere,
                                                      without a network: both wheels must be the same file
          --of-tests                                  package the build of `test`, as `test` does it
  weigh   CPU seconds of the main job's cold build by package, sizes of what is published, into docs/weight.md
          --main-job                                  the main job alone, to standard output
  api     list and count the public items of the published crates in target/api/items
  release --dry-run VERSION: version, changelog, metadata, features, public items; packages every crate that is published,
          and builds and runs their documentation's examples, a first program and the command line from the packages alone
  dist    archives of the C and C++ library for Linux into target/dist, for glibc 2.28 or newer; needs cmake
  deb     a Debian package for this machine into target/deb: command line, completions, manual, C and C++ library; installs
          it into an empty root and uses it; needs dpkg-deb and cmake, else it is skipped
  licences  write THIRD-PARTY.txt, the licences of all linked packages, and mozzi.cdx.json, their list in CycloneDX's format;
          the binaries are shipped with both, `check` compares";

/// Options of `test`, each with what it installs.
const EXTRAS: [(&str, &str); 1] = [("--torch", venv::TORCH)];

fn main() -> ExitCode {
    if let Some(log) = std::env::var_os(weigh::LOG) {
        return weigh::wrapped(log.as_ref());
    }
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let workspace = Workspace::find();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["test", ref options @ ..] if options.iter().all(|option| EXTRAS.iter().any(|(name, _)| name == option)) => {
            test(&workspace, options)
        }
        ["check"] => check(&workspace, Check::Everything),
        ["check", "--quick"] => check(&workspace, Check::WithoutBuilds),
        ["docs"] => docs(&workspace),
        ["docs", "--readme"] => one("README's tables", || readme::write(&workspace)),
        ["mutants", ref options @ ..] => {
            let number = |name: &str, default: usize| {
                let at = options.iter().position(|option| *option == name);
                at.and_then(|at| options.get(at + 1)?.parse().ok()).unwrap_or(default)
            };
            let (sample, seed) = (number("--sample", mutants::SAMPLE), number("--seed", 0));
            one("mutants", || mutants::run(&workspace, sample, seed))
        }
        ["coverage"] => one("coverage", || coverage::run(&workspace)),
        ["claims"] => one("claims", || claims::list(&workspace)),
        ["book"] => book(&workspace),
        ["book", "--code"] => one("code of the book", || book::code(&workspace)),
        ["page"] => one("page", || page::write(&workspace)),
        ["page", "--check"] => one("page", || page::compare(&workspace)),
        ["wheel"] => steps(|report| wheel::run(&workspace, false, report)),
        ["wheel", "--sdist"] => steps(|report| wheel::run(&workspace, true, report)),
        ["dist"] => steps(|report| dist::run(&workspace, report)),
        ["deb"] => steps(|report| deb::run(&workspace, report)),
        ["licences"] => one("licence texts", || third_party::write(&workspace)),
        ["api"] => one("public items", || release::api::write(&workspace)),
        ["release", "--dry-run", version] => steps(|report| release::rehearse(&workspace, version, report)),
        ["nightly"] => nightly::run(&workspace, nightly::SECONDS),
        ["nightly", "--seconds", seconds] if seconds.parse::<u32>().is_ok() => {
            nightly::run(&workspace, seconds.parse().unwrap_or(nightly::SECONDS))
        }
        ["weigh"] => one("weight", || weigh::run(&workspace, false)),
        ["weigh", "--main-job"] => one("weight", || weigh::run(&workspace, true)),
        ["wheel", "--of-tests"] => one("wheel", || wheel::test(&workspace)),
        ["bench", "--python"] => one("benchmarks", || bench::python(&workspace)),
        ["bench", "--contacts"] => one("benchmarks", || bench::contacts(&workspace)),
        ["gpu-report", ref options @ ..] => one("GPU kernels", || gpu::report(&workspace, options)),
        ["gpu-bench", ref options @ ..] => one("GPU benchmarks", || gpu::bench(&workspace, options)),
        ["jit-report"] => one("machine code", || jit_report::write(&workspace)),
        ["aarch64"] => one("AArch64, a sample", || other_targets::aarch64_sample(&workspace)),
        ["accuracy", ref options @ ..] => accuracy(&workspace, options),
        ["campaign", ref options @ ..] => one("campaign", || campaign::run(&workspace, options)),
        ["bench", ref options @ ..] => match bench::Options::parse(options) {
            Ok(options) => one("benchmarks", || bench::run(&workspace, &options)),
            Err(why) => {
                eprintln!("bench: {why}\n{USAGE}");
                ExitCode::from(2)
            }
        },
        ["--help" | "-h" | "help"] => {
            println!("{USAGE}");
            ExitCode::SUCCESS
        }
        _ => {
            eprintln!("{USAGE}");
            ExitCode::from(2)
        }
    }
}

fn test(workspace: &Workspace, options: &[&str]) -> ExitCode {
    let mut report = Report::default();
    let mut count = tests::Count::default();
    let release = main_job::start_build(workspace); // beside pip and Python's reference numbers, which use one core
    report.step("Python environment", || venv::prepare(workspace));
    for (option, file) in EXTRAS.iter().filter(|(option, _)| options.contains(option)) {
        report.step(option.trim_start_matches('-'), || venv::add(workspace, file));
    }
    report.step("reference numbers", || oracles::make(workspace));
    report.step("page", || page::is_current(workspace));
    report.step("tests", || tests::run(workspace, &mut count));
    report.step("Python package", || package::test(workspace, &mut count));
    report.step("wheel", || wheel::test(workspace));
    report.step("fuzzing", || fuzz::run(workspace, None));
    report.step("no_std", || no_std::check(workspace));
    report.step("AArch64, a sample", || other_targets::aarch64_sample(workspace));
    let mut programs = examples::Programs::new();
    report.step("examples", || examples::build(workspace, &mut programs));
    for example in examples::list(workspace) {
        report.step(&format!("example {}", example.name()), || example.run(workspace, &programs));
    }
    report.step("main job", || main_job::run(workspace, release));
    report.step("book's builder", || book::test_builder(workspace));
    report.step("book", || book::build(workspace, false));
    report.step("search of the book", || book::search(workspace));
    report.step("code of the book", || book::code(workspace));
    report.step("inlining", || inlining::check(workspace));
    let exit = report.finish();
    println!("{count}"); // CI reads this line
    exit
}

fn accuracy(workspace: &Workspace, options: &[&str]) -> ExitCode {
    let mut report = Report::default();
    report.step("Python environment", || venv::prepare(workspace));
    report.step("reference numbers", || oracles::make(workspace));
    report.step("accuracy", || accuracy::run(workspace, options));
    report.finish()
}

fn docs(workspace: &Workspace) -> ExitCode {
    let mut report = Report::default();
    report.step("Python environment", || venv::prepare(workspace));
    report.step("reference numbers", || oracles::make(workspace));
    report.step("pages", || docs::write(workspace));
    report.step("README's tables", || readme::write(workspace));
    report.finish()
}

fn book(workspace: &Workspace) -> ExitCode {
    let mut report = Report::default();
    report.step("book", || book::build(workspace, true));
    report.step("search of the book", || book::search(workspace));
    report.finish()
}

/// Which steps `check` takes.
#[derive(PartialEq)]
enum Check {
    Everything,
    /// Those that compile nothing of the workspace.
    WithoutBuilds,
}

fn check(workspace: &Workspace, which: Check) -> ExitCode {
    let mut report = Report::default();
    report.step("formatting", || command::outcome(workspace.cargo(&["fmt", "--all", "--check"])));
    for tool in ["xtask/book/Cargo.toml", "xtask/mutants/Cargo.toml"] {
        report.step(&format!("formatting, {tool}"), || {
            command::outcome(workspace.cargo(&["fmt", "--check", "--manifest-path", tool]))
        });
    }
    report.step("licences", || licences::check(workspace));
    report.step("licence texts", || third_party::check(workspace));
    report.step("advisories", || advisories::check(workspace));
    report.step("house rules", || house_rules::check(workspace));
    report.step("prose", || prose::check(workspace));
    report.step("lengths of documents", || documents::check(workspace));
    report.step("places of the map", || documents::check_places(workspace));
    report.step("README's tables", || readme::check(workspace));
    report.step("claims", || claims::check(workspace));
    report.step("names in documents", || names::check(workspace));
    report.step("page", || page::is_current(workspace));
    if which == Check::Everything {
        builds(workspace, &mut report);
    }
    report.finish()
}

/// The steps of `check` that compile the workspace.
fn builds(workspace: &Workspace, report: &mut Report) {
    report.step("clippy", || {
        let mut cargo = workspace.cargo(&["clippy", "--workspace", "--lib", "--bins", "--tests", "--examples"]);
        command::outcome(cargo.args(workspace::FEATURES).args(["--", "-D", "warnings"]))
    });
    report.step("documentation", || {
        // Libraries only: the program `mozzi` would overwrite the library of the same name, which is written at the
        // same time.
        let mut doc = workspace.cargo(&["doc", "--workspace", "--no-deps", "--lib"]);
        command::outcome(doc.env("RUSTDOCFLAGS", "-Dwarnings"))
    });
}

/// A command that adds its steps itself.
fn steps(add: impl FnOnce(&mut Report)) -> ExitCode {
    let mut report = Report::default();
    add(&mut report);
    report.finish()
}

/// A command with a single step.
fn one(name: &str, step: impl FnOnce() -> report::Outcome) -> ExitCode {
    let mut report = Report::default();
    report.step(name, step);
    report.finish()
}
