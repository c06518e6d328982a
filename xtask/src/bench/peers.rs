//! How each peer is built: a library with the interface of `benches/peers/peer.hpp`.

use super::workshop::Workshop;
use crate::command;
use crate::venv;
use std::path::{Path, PathBuf};
use std::process::Command;

pub struct Peer {
    pub name: &'static str,
    /// The library, or the reason why there is none.
    pub build: fn(&Workshop) -> Result<PathBuf, String>,
    /// mozzi itself, in another language: measured only if `--peers` names it.
    pub is_mozzi: bool,
}

pub const PEERS: [Peer; 9] = [
    Peer { name: "Pinocchio", build: pinocchio, is_mozzi: false },
    Peer { name: "MuJoCo", build: mujoco, is_mozzi: false },
    Peer { name: "KDL", build: kdl, is_mozzi: false },
    Peer { name: "dynibo", build: dynibo, is_mozzi: false },
    Peer { name: "CasADi", build: casadi, is_mozzi: false },
    Peer { name: "Drake", build: drake, is_mozzi: false },
    Peer { name: "C", build: plain_c, is_mozzi: true },
    Peer { name: "C++", build: cpp, is_mozzi: true },
    Peer { name: "C++-compiled", build: cpp_compiled, is_mozzi: true },
];

const HEADER: &str = "benches/peers/peer.hpp";
/// The options that affect the speed; they are quoted.
const FAST: &str = "-std=c++17 -O3 -march=native -DNDEBUG";

/// Built from the headers of PyPI's `pin`: the wheel's library and gcc's code are slower.
fn pinocchio(workshop: &Workshop) -> Result<PathBuf, String> {
    const SOURCE: &str = "benches/peers/pinocchio.cpp";
    const REQUIREMENTS: &str = "benches/requirements.txt"; // Eigen's headers, which Pinocchio's wheel lacks
    /// The headers list more joint types than Boost's default limit.
    const BOOST: &str = "-DBOOST_MPL_LIMIT_LIST_SIZE=30 -DBOOST_MPL_LIMIT_VECTOR_SIZE=30 \
        -DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS -DBOOST_FUSION_INVOKE_MAX_ARITY=12";
    let words = format!("{FAST} {BOOST}");
    workshop.library("pinocchio", &words, &[SOURCE, HEADER, REQUIREMENTS, "oracles/requirements.txt"], |library| {
        workshop.pip(REQUIREMENTS)?;
        let prefix = workshop.package("cmeel.prefix")?;
        println!("Pinocchio is being compiled: three minutes by clang, more by g++.");
        let mut compile = workshop.compile(FAST);
        compile.args(BOOST.split(' '));
        for folder in ["include", "include/eigen3"] {
            compile.arg("-isystem").arg(prefix.join(folder));
        }
        let lib = prefix.join("lib").display().to_string();
        compile.arg(SOURCE).arg("-o").arg(library);
        command::run(compile.args([&format!("-L{lib}"), "-lboost_serialization", &format!("-Wl,-rpath,{lib}")]))
    })
}

/// The library of PyPI's `mujoco`.
fn mujoco(workshop: &Workshop) -> Result<PathBuf, String> {
    const SOURCE: &str = "benches/peers/mujoco.cpp";
    let package = workshop.package("mujoco")?;
    let wheels = file(&package, "libmujoco.so").ok_or("its wheel brought no libmujoco.so")?;
    workshop.library("mujoco", &format!("{FAST} {}", wheels.display()), &[SOURCE, HEADER], |library| {
        let mut compile = workshop.compile(FAST);
        compile.arg("-isystem").arg(package.join("include")).arg(SOURCE).arg("-o").arg(library);
        command::run(compile.arg(&wheels).arg(format!("-Wl,-rpath,{}", package.display())))
    })
}

/// Debian's. Without `-march=native`: Eigen would align memory differently from Debian's library, which frees it.
fn kdl(workshop: &Workshop) -> Result<PathBuf, String> {
    const SOURCE: &str = "benches/peers/kdl.cpp";
    const WORDS: &str = "-std=c++17 -O3 -DNDEBUG";
    const EIGEN: &str = "/usr/include/eigen3";
    if !Path::new("/usr/include/kdl").is_dir() {
        return Err("apt install liborocos-kdl-dev, or cargo xtask bench --install".into());
    }
    workshop.library("kdl", WORDS, &[SOURCE, HEADER], |library| {
        let mut compile = workshop.compile(WORDS);
        command::run(compile.args(["-isystem", EIGEN, SOURCE, "-o"]).arg(library).arg("-lorocos-kdl"))
    })
}

/// From the crate registry; a package outside the workspace, compiled for this machine.
fn dynibo(workshop: &Workshop) -> Result<PathBuf, String> {
    const FOLDER: &str = "benches/peers/dynibo";
    const WORDS: &str = "-C target-cpu=native";
    let manifest = format!("{FOLDER}/Cargo.toml");
    let mut cargo =
        workshop.workspace.cargo(&["build", "--release", "--quiet", "--locked", "--manifest-path", &manifest]);
    let target = workshop.built("dynibo");
    cargo.arg("--target-dir").arg(&target).env("RUSTFLAGS", WORDS).env("PEER_FLAGS", WORDS);
    command::run(cargo)?;
    let name = format!("{}dynibo_peer{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    Ok(target.join("release").join(name))
}

/// C that PyPI's `casadi` generates for each robot.
fn casadi(workshop: &Workshop) -> Result<PathBuf, String> {
    const SCRIPT: &str = "benches/peers/casadi_kernels.py";
    const SOURCE: &str = "benches/peers/casadi.cpp";
    const REQUIREMENTS: &str = "benches/requirements-casadi.txt";
    const WORDS: &str = "-O3 -march=native -ffast-math";
    let robots = workshop.built("robots");
    let read = |path: &PathBuf| std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()));
    let numbers = files(&robots, "txt").iter().map(read).collect::<Result<String, _>>()?;
    workshop.library("casadi", &format!("{WORDS}\n{numbers}"), &[SCRIPT, SOURCE, HEADER, REQUIREMENTS], |library| {
        workshop.pip(REQUIREMENTS)?;
        let folder = workshop.workspace.fresh_folder("target/bench/casadi")?;
        let mut python = Command::new(venv::python(workshop.workspace));
        python.current_dir(&workshop.workspace.root).arg(SCRIPT).arg(&robots).arg(&folder);
        command::run(python.arg(workshop.c_compiler()).args(WORDS.split(' ')))?;
        for source in files(&folder, "c") {
            let mut compile = Command::new(workshop.c_compiler());
            compile.args(WORDS.split(' ')).args(["-fPIC", "-c"]);
            command::run(compile.arg(&source).arg("-o").arg(source.with_extension("o")))?;
        }
        // not linked with -ffast-math, which would flush subnormal numbers to zero in the whole process
        let mut link = Command::new(workshop.compiler);
        link.current_dir(&workshop.workspace.root).args(["-std=c++17", "-O3", "-fPIC", "-shared"]);
        link.arg(format!("-DPEER_FLAGS={WORDS}")).arg("-I").arg(&folder).arg(SOURCE).args(files(&folder, "o"));
        command::run(link.arg("-o").arg(library))
    })
}

/// mozzi.hpp with Eigen's arguments, on the shared library.
fn cpp(workshop: &Workshop) -> Result<PathBuf, String> {
    own(workshop, "mozzi-cpp", FAST)
}

/// The functions of mozzi.h on pointers.
fn plain_c(workshop: &Workshop) -> Result<PathBuf, String> {
    own(workshop, "mozzi-c", &format!("{FAST} -DPLAIN"))
}

/// As [`cpp`], by machine code.
fn cpp_compiled(workshop: &Workshop) -> Result<PathBuf, String> {
    own(workshop, "mozzi-cpp-compiled", &format!("{FAST} -DCOMPILED"))
}

fn own(workshop: &Workshop, name: &str, words: &str) -> Result<PathBuf, String> {
    const SOURCE: &str = "benches/peers/mozzi.cpp";
    const EIGEN: &str = "benches/requirements.txt";
    const HEADERS: [&str; 2] = ["crates/mozzi-c/include/mozzi/mozzi.h", "crates/mozzi-c/include/mozzi/mozzi.hpp"];
    command::run(workshop.workspace.cargo(&["build", "--release", "--quiet", "-p", "mozzi-c"]))?;
    let folder = workshop.workspace.fresh_folder(&format!("target/bench/{name}"))?;
    let library = workshop.workspace.target().join("release/libmozzi_c.so");
    for link in ["libmozzi.so", "libmozzi.so.0"] {
        let to = folder.join(link);
        std::fs::copy(&library, &to).map_err(|error| format!("{}: {error}", to.display()))?;
    }
    let [header, methods] = HEADERS;
    workshop.library(name, words, &[SOURCE, HEADER, EIGEN, header, methods], |library| {
        workshop.pip(EIGEN)?;
        let mut compile = workshop.compile(words);
        compile.arg("-isystem").arg(workshop.package("cmeel.prefix")?.join("include/eigen3"));
        compile.args(["-I", "crates/mozzi-c/include", SOURCE, "-o"]).arg(library).arg("-L").arg(&folder);
        command::run(compile.arg("-lmozzi").arg(format!("-Wl,-rpath,{}", folder.display())))
    })
}

fn drake(_: &Workshop) -> Result<PathBuf, String> {
    Err("the wheel of `drake` brings a library without headers, and a call through Python takes longer than the dynamics".into())
}

/// The first file of a folder with this prefix.
fn file(folder: &Path, start: &str) -> Option<PathBuf> {
    let entries = std::fs::read_dir(folder).ok()?.filter_map(Result::ok);
    entries
        .map(|entry| entry.path())
        .find(|path| path.file_name().is_some_and(|n| n.to_string_lossy().starts_with(start)))
}

/// The files of a folder with this suffix, in order.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok).map(|entry| entry.path());
    let mut files: Vec<_> = entries.filter(|path| path.extension().is_some_and(|e| e == ending)).collect();
    files.sort();
    files
}
