//! Compilers for other targets: rustup's, or another toolchain's with the sources of the standard library.

use crate::workspace::Workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of a toolchain with `bin/rustc` and `lib/rustlib/src`, which builds the standard library of any target.
pub const FOLDER: &str = "MOZZI_WASM";

/// A compiler for a target.
pub enum Compiler {
    /// rustup's, with the target installed.
    Rustup,
    /// That of the [`FOLDER`].
    Folder(PathBuf),
}

impl Compiler {
    pub fn find(target: &str) -> Result<Option<Self>, String> {
        if let Some(folder) = std::env::var_os(FOLDER).map(PathBuf::from) {
            let rustc = folder.join("bin/rustc");
            return match rustc.is_file() {
                true => Ok(Some(Compiler::Folder(folder))),
                false => Err(format!("{FOLDER}: {} does not exist", rustc.display())),
            };
        }
        let libraries = printed(&rustc(), &["--print", "target-libdir", "--target", target]);
        Ok(libraries.filter(|folder| Path::new(folder).is_dir()).map(|_| Compiler::Rustup))
    }

    pub fn rustc(&self) -> PathBuf {
        match self {
            Compiler::Rustup => rustc(),
            Compiler::Folder(folder) => folder.join("bin/rustc"),
        }
    }

    /// Its `rustc --version`.
    pub fn version(&self) -> String {
        printed(&self.rustc(), &["--version"]).unwrap_or_default()
    }

    /// Its folder of libraries and sources.
    pub fn sysroot(&self) -> Option<PathBuf> {
        printed(&self.rustc(), &["--print", "sysroot"]).map(PathBuf::from)
    }

    /// cargo with it.
    pub fn cargo(&self, workspace: &Workspace, arguments: &[&str], target: &str) -> Command {
        let mut cargo = workspace.cargo(arguments);
        cargo.args(["--target", target]);
        if let Compiler::Folder(_) = self {
            cargo.args(["-Z", "build-std=std,panic_abort"]).env("RUSTC_BOOTSTRAP", "1").env("RUSTC", self.rustc());
        }
        cargo
    }
}

/// The linker that comes with the compiler of this machine.
pub fn lld() -> PathBuf {
    let host = printed(&rustc(), &["--print", "target-libdir"]).unwrap_or_default();
    Path::new(&host).with_file_name("bin").join("rust-lld")
}

fn rustc() -> PathBuf {
    std::env::var_os("RUSTC").map_or_else(|| "rustc".into(), PathBuf::from)
}

/// The one line that a program prints.
fn printed(program: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_string())
}
