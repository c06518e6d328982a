//! The benchmarks, a package of their own: mozzi beside Pinocchio, or each kernel alone by criterion.

use crate::command;
use crate::report::Outcome;
use crate::stamp::Stamp;
use crate::venv;
use crate::workspace::Workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

const SOURCE: &str = "benches/pinocchio.cpp";
const REQUIREMENTS: &str = "benches/requirements.txt"; // Eigen's headers, which Pinocchio's wheel has not
const LIBRARY: &str = "target/bench/libpinocchio_peer.so";
/// Where the wheel of `example-robot-data` keeps its robots.
const ROBOTS: &str = "share/example-robot-data/robots";
const RESULTS: &str = "benches/RESULTS.md";

/// What makes a difference to the speed, and is quoted.
const FLAGS: &str = "-std=c++17 -O3 -march=native -DNDEBUG";
/// What Pinocchio's headers need: they name more joints than Boost's lists take.
const BOOST: &str = "-DBOOST_MPL_LIMIT_LIST_SIZE=30 -DBOOST_MPL_LIMIT_VECTOR_SIZE=30 \
    -DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS -DBOOST_FUSION_INVOKE_MAX_ARITY=12";

/// clang makes Pinocchio 1.3 to 1.8 times faster than gcc does.
const COMPILERS: [&str; 7] = ["clang++", "clang++-22", "clang++-21", "clang++-20", "clang++-19", "clang++-18", "g++"];

const INSTALL: &str = "\
A C++ compiler is needed, and clang makes the fastest peer:
  Debian, Ubuntu   apt install clang-19
  Fedora           dnf install clang
  macOS            xcode-select --install";

const PREFIX: &str = "import sysconfig; print(sysconfig.get_path('purelib'))";

pub fn run(workspace: &Workspace) -> Outcome {
    match compare(workspace) {
        Ok(note) => Outcome::Passed(note),
        Err(why) => Outcome::Failed(why),
    }
}

pub fn criterion(workspace: &Workspace) -> Outcome {
    command::outcome(workspace.cargo(&["bench", "-p", "mozzi-benches"]))
}

fn compare(workspace: &Workspace) -> Result<String, String> {
    let note = build_peer(workspace)?;
    let mut cargo = workspace.cargo(&["run", "--release", "-p", "mozzi-benches", "--bin", "compare", "--"]);
    command::run(
        cargo
            .arg("--peer")
            .arg(workspace.path(LIBRARY))
            .arg("--robots")
            .arg(prefix(workspace)?.join(ROBOTS))
            .args(["--write", RESULTS]),
    )?;
    Ok(format!("{RESULTS} is written{note}"))
}

/// Compile Pinocchio into a library, unless it was compiled already from the same sources. What is to be said of it.
fn build_peer(workspace: &Workspace) -> Result<&'static str, String> {
    let compiler = COMPILERS.into_iter().find(|name| command::exists(&mut Command::new(name)));
    let Some(compiler) = compiler else {
        println!("{INSTALL}");
        return Err("no C++ compiler was found".into());
    };
    let note = if compiler == "g++" { "; by g++, clang makes a faster peer" } else { "" };
    if !note.is_empty() {
        println!("{INSTALL}\ng++ is taken: Pinocchio is slower by it, and the ratios flatter mozzi.");
    }

    if let Outcome::Failed(why) = venv::prepare(workspace) {
        return Err(why);
    }
    let read = |name: &str| std::fs::read_to_string(workspace.path(name)).map_err(|error| format!("{name}: {error}"));
    let sources =
        [SOURCE, REQUIREMENTS, "oracles/requirements.txt"].map(read).into_iter().collect::<Result<String, _>>()?;
    let stamp = Stamp::new(workspace.path("target/bench/peer.stamp"), format!("{compiler} {FLAGS} {BOOST}\n{sources}"));
    if stamp.is_fresh() {
        return Ok(note);
    }
    workspace.fresh_folder("target/bench")?;
    let mut pip = Command::new(venv::python(workspace));
    pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input", "-r"]);
    command::run(pip.arg(workspace.path(REQUIREMENTS)))?;
    println!("Pinocchio is being compiled: two minutes by clang, more by g++.");
    command::run(compile(workspace, compiler, &prefix(workspace)?))?;
    stamp.write()?;
    Ok(note)
}

/// Where the wheels keep headers and libraries.
fn prefix(workspace: &Workspace) -> Result<PathBuf, String> {
    let (_, folder) = command::output(Command::new(venv::python(workspace)).args(["-c", PREFIX]))?;
    let prefix = Path::new(folder.trim()).join("cmeel.prefix");
    if prefix.is_dir() { Ok(prefix) } else { Err("the wheel of `pin` brought no cmeel.prefix".into()) }
}

fn compile(workspace: &Workspace, compiler: &str, prefix: &Path) -> Command {
    let mut command = Command::new(compiler);
    command.current_dir(&workspace.root).args(FLAGS.split(' ')).args(BOOST.split(' '));
    command.args(["-fPIC", "-shared", &format!("-DPEER_FLAGS={FLAGS}")]);
    for folder in ["include", "include/eigen3"] {
        command.arg("-isystem").arg(prefix.join(folder));
    }
    let lib = prefix.join("lib").display().to_string();
    command.args([SOURCE, "-o", LIBRARY, &format!("-L{lib}"), "-lboost_serialization", &format!("-Wl,-rpath,{lib}")]);
    command
}
