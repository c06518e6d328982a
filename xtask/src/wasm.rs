//! mozzi-web for WebAssembly, which is committed next to the page: built if there is a compiler for it, else the
//! committed one is used.
//!
//! It depends on nearly every crate. If its stamp covered all of them, every change of the library would need this
//! compiler. So the stamp covers `crates/mozzi-web`, the interface; whether the numbers are current is a test's task:
//! `crates/mozzi-cli/tests/page_numbers.rs` compares the page with the library.

use crate::command;
use crate::stamp::fnv;
use crate::workspace::Workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

const GZIP: &str = "crates/mozzi-report/bundle/mozzi.wasm.gz";
const NOTE: &str = "crates/mozzi-report/bundle/mozzi.wasm.txt";
const SOURCES: &str = "crates/mozzi-web";
const TARGET: &str = "wasm32-unknown-unknown";

/// A compiler for [`TARGET`].
enum Compiler {
    /// rustup's, with the target installed.
    Rustup,
    /// Another toolchain's folder, with `bin/rustc` and the sources of the standard library, named by `MOZZI_WASM`.
    Folder(PathBuf),
}

impl Compiler {
    fn find() -> Result<Option<Self>, String> {
        if let Some(folder) = std::env::var_os("MOZZI_WASM").map(PathBuf::from) {
            let rustc = folder.join("bin/rustc");
            return match rustc.is_file() {
                true => Ok(Some(Compiler::Folder(folder))),
                false => Err(format!("MOZZI_WASM: {} does not exist", rustc.display())),
            };
        }
        let libraries = printed(&rustc(), &["--print", "target-libdir", "--target", TARGET]);
        Ok(libraries.filter(|folder| Path::new(folder).is_dir()).map(|_| Compiler::Rustup))
    }

    fn rustc(&self) -> PathBuf {
        match self {
            Compiler::Rustup => rustc(),
            Compiler::Folder(folder) => folder.join("bin/rustc"),
        }
    }

    /// `cargo build` with it; messages of panics name no folder of this machine.
    fn build(&self, workspace: &Workspace, folder: &Path) -> Result<(), String> {
        let mut cargo = workspace.cargo(&["build", "--package", "mozzi-web", "--lib", "--profile", "web"]);
        cargo.arg("--no-default-features");
        cargo.args(["--target", TARGET, "--target-dir"]).arg(folder);
        if let Compiler::Folder(_) = self {
            let host = printed(&rustc(), &["--print", "target-libdir"]).unwrap_or_default();
            let linker = Path::new(&host).with_file_name("bin").join("rust-lld");
            cargo.args(["-Z", "build-std=std,panic_abort"]).env("RUSTC_BOOTSTRAP", "1").env("RUSTC", self.rustc());
            cargo.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", linker);
        }
        let home = std::env::var_os("CARGO_HOME").map(PathBuf::from);
        let home = home.or_else(|| std::env::home_dir().map(|home| home.join(".cargo")));
        let sysroot = printed(&self.rustc(), &["--print", "sysroot"]).map(PathBuf::from);
        let library = sysroot.as_ref().and_then(|root| root.join("lib/rustlib/src/rust").canonicalize().ok());
        let places =
            [Some(workspace.root.clone()), home, sysroot, library].into_iter().zip(["mozzi", "cargo", "rust", "rust"]);
        let flags = places.filter_map(|(place, name)| Some(format!("--remap-path-prefix={}={name}", place?.display())));
        cargo.env("CARGO_ENCODED_RUSTFLAGS", flags.collect::<Vec<_>>().join("\u{1f}"));
        command::run(cargo)
    }
}

/// Builds and packs it if there is a compiler; returns a description.
pub fn write(workspace: &Workspace) -> Result<String, String> {
    let Some(compiler) = Compiler::find()? else {
        return Ok(format!("the committed wasm: no compiler for {TARGET}, see CONTRIBUTING.md"));
    };
    let folder = workspace.target().join("wasm");
    compiler.build(workspace, &folder)?;
    let built = folder.join(TARGET).join("web/mozzi_web.wasm");
    let mut pack = Command::new("node");
    pack.current_dir(workspace.path("page")).arg("pack.mjs").arg(built).arg(workspace.path(GZIP));
    command::run(pack)?;
    let version = printed(&compiler.rustc(), &["--version"]).unwrap_or_default();
    let version = version.split(" (").next().unwrap_or_default();
    let (hash, stamp) = (hash(workspace)?, stamp(workspace)?);
    let note = format!(
        "mozzi.wasm.gz, hash {hash}, is mozzi-web, stamp {stamp}, compiled by {version} with these packages:\n\n{}",
        packages(workspace)?
    );
    std::fs::write(workspace.path(NOTE), note).map_err(|error| format!("{NOTE}: {error}"))?;
    Ok(format!("wasm by {version}"))
}

/// Checks that the committed wasm is the one of the note, and was made from the current interface.
pub fn is_current(workspace: &Workspace) -> Result<(), String> {
    let note = std::fs::read_to_string(workspace.path(NOTE)).map_err(|error| format!("{NOTE}: {error}"))?;
    if !note.contains(&format!("hash {},", hash(workspace)?)) {
        return Err(format!("{GZIP} is not the file of {NOTE}: run cargo xtask page"));
    }
    match note.contains(&format!("stamp {},", stamp(workspace)?)) {
        true => Ok(()),
        false => Err(format!("{GZIP} is older than {SOURCES}: run cargo xtask page with a compiler for {TARGET}")),
    }
}

fn hash(workspace: &Workspace) -> Result<String, String> {
    let bytes = std::fs::read(workspace.path(GZIP)).map_err(|error| format!("{GZIP}: {error}"))?;
    Ok(fnv(bytes))
}

/// The hash of the interface's sources: of their names and texts.
fn stamp(workspace: &Workspace) -> Result<String, String> {
    let mut files = vec![PathBuf::from("Cargo.toml")];
    let root = workspace.path(SOURCES);
    sources(&root, Path::new("src"), &mut files)?;
    let mut names: Vec<String> = files.iter().map(|file| file.to_string_lossy().replace('\\', "/")).collect();
    names.sort();
    let mut all = Vec::new();
    for name in names {
        let text = std::fs::read_to_string(root.join(&name)).map_err(|error| format!("{SOURCES}/{name}: {error}"))?;
        all.extend(format!("{name}\n{}", text.replace("\r\n", "\n")).into_bytes());
    }
    Ok(fnv(all))
}

fn sources(root: &Path, folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), String> {
    let entries = std::fs::read_dir(root.join(folder)).map_err(|error| format!("{}: {error}", folder.display()))?;
    for entry in entries.filter_map(Result::ok) {
        let path = folder.join(entry.file_name());
        match entry.path().is_dir() {
            true => sources(root, &path, files)?,
            false => files.push(path),
        }
    }
    Ok(())
}

/// The packages in it, each with its version and licence.
fn packages(workspace: &Workspace) -> Result<String, String> {
    let mut tree = workspace.cargo(&["tree", "--package", "mozzi-web", "--target", TARGET, "--edges", "normal"]);
    tree.arg("--no-default-features");
    tree.args(["--prefix", "none", "--no-dedupe", "--format", "{p}, {l}"]);
    let (_, text) = command::output(tree)?;
    let is_compiled_in = |line: &&str| !line.is_empty() && !line.contains("(proc-macro)") && !line.contains("(/");
    let mut lines: Vec<&str> = text.lines().filter(is_compiled_in).collect();
    lines.sort_unstable();
    lines.dedup();
    Ok(lines.join("\n") + "\n")
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
