//! The tools to build the peers.

use crate::command;
use crate::stamp::Stamp;
use crate::venv;
use crate::workspace::Workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

/// clang makes Pinocchio 1.3 to 1.8 times faster than gcc does.
const COMPILERS: [&str; 7] = ["clang++-22", "clang++-21", "clang++-20", "clang++-19", "clang++-18", "clang++", "g++"];

const INSTALL: &str = "\
A C++ compiler is needed, and clang makes the fastest peers:
  Debian, Ubuntu   apt install clang-19, or cargo xtask bench --install
  Fedora           dnf install clang
  macOS            xcode-select --install";

const PURELIB: &str = "import sysconfig; print(sysconfig.get_path('purelib'))";

/// The apt packages for the peers.
const PACKAGES: [&str; 2] = ["clang-19", "liborocos-kdl-dev"];

pub struct Workshop<'a> {
    pub workspace: &'a Workspace,
    /// The C++ compiler.
    pub compiler: &'static str,
    /// The folder of the Python packages.
    pub packages: PathBuf,
}

/// Let apt install its packages for the peers.
pub fn install() -> Result<(), String> {
    let mut apt = Command::new("apt-get");
    apt.args(["install", "-y", "--no-install-recommends"]).args(PACKAGES);
    command::run(apt).map_err(|why| format!("{why}; as root: apt-get install {}", PACKAGES.join(" ")))
}

impl<'a> Workshop<'a> {
    pub fn new(workspace: &'a Workspace) -> Result<Self, String> {
        let compiler = COMPILERS.into_iter().find(|name| command::exists(&mut Command::new(name)));
        let compiler = compiler.ok_or_else(|| format!("no C++ compiler was found\n{INSTALL}"))?;
        if compiler == "g++" {
            println!("{INSTALL}\ng++ is taken: the peers are slower by it, and the ratios flatter mozzi.");
        }
        let (_, folder) = command::output(Command::new(venv::python(workspace)).args(["-c", PURELIB]))?;
        std::fs::create_dir_all(workspace.path("target/bench")).map_err(|error| format!("target/bench: {error}"))?;
        Ok(Workshop { workspace, compiler, packages: PathBuf::from(folder.trim()) })
    }

    /// The C compiler of the same toolchain.
    pub fn c_compiler(&self) -> String {
        self.compiler.replace("clang++", "clang").replace("g++", "gcc")
    }

    /// The folder of the robots' numbers, emptied.
    pub fn fresh_robots(&self) -> Result<String, String> {
        Ok(self.workspace.fresh_folder("target/bench/robots")?.display().to_string())
    }

    /// A file of the build folder.
    pub fn built(&self, name: &str) -> PathBuf {
        self.workspace.path("target/bench").join(name)
    }

    /// A Python package's folder, if it is installed.
    pub fn package(&self, name: &str) -> Result<PathBuf, String> {
        let folder = self.packages.join(name);
        if folder.is_dir() { Ok(folder) } else { Err(format!("its wheel brought no {name}")) }
    }

    /// Install the packages that a file of `benches/` lists, without their dependencies.
    pub fn pip(&self, requirements: &str) -> Result<(), String> {
        let mut pip = Command::new(venv::python(self.workspace));
        pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input", "--no-deps", "-r"]);
        command::run(pip.arg(self.workspace.path(requirements)))
    }

    /// The library `NAME.so`; `make` builds it unless it was already built from the same files with the same command.
    pub fn library(
        &self,
        name: &str,
        words: &str,
        files: &[&str],
        make: impl FnOnce(&Path) -> Result<(), String>,
    ) -> Result<PathBuf, String> {
        let library = self.built(&format!("{name}.so"));
        let mut text = format!("{} {words}\n", self.compiler);
        for file in files {
            let path = self.workspace.path(file);
            text += &std::fs::read_to_string(&path).map_err(|error| format!("{file}: {error}"))?;
        }
        let stamp = Stamp::new(self.built(&format!("{name}.stamp")), text);
        if !stamp.is_fresh() || !library.is_file() {
            stamp.remove()?;
            make(&library)?;
            stamp.write()?;
        }
        Ok(library)
    }

    /// The C++ compiler with its leading options; `words` are quoted in the tables.
    pub fn compile(&self, words: &str) -> Command {
        let mut command = Command::new(self.compiler);
        command.current_dir(&self.workspace.root).args(words.split(' '));
        command.args(["-fPIC", "-shared", &format!("-DPEER_FLAGS={words}")]);
        command
    }
}
