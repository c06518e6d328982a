//! mozzi-web for WebAssembly, which is committed next to the pages, once for each: built if there is a compiler for it,
//! else the committed ones are used.
//!
//! It depends on nearly every crate. If its stamp covered all of them, every change of the library would need this
//! compiler. So the stamp covers `crates/mozzi-web`, the interface; whether the numbers are current is a test's task:
//! `crates/mozzi-cli/tests/page_numbers.rs` compares the page with the library.

use crate::command;
use crate::cross::{self, Compiler};
use crate::stamp::fnv;
use crate::workspace::Workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A build of mozzi-web.
pub struct Wasm {
    gzip: &'static str,
    note: &'static str,
    features: &'static [&'static str],
}

/// That of the page of `--report` and `view`, and that of the playground.
const ALL: [Wasm; 2] = [
    Wasm {
        gzip: "crates/mozzi-report/bundle/mozzi.wasm.gz",
        note: "crates/mozzi-report/bundle/mozzi.wasm.txt",
        features: &["--no-default-features"],
    },
    Wasm {
        gzip: "crates/mozzi-report/bundle/play.wasm.gz",
        note: "crates/mozzi-report/bundle/play.wasm.txt",
        features: &["--no-default-features", "--features", "play"],
    },
];

const SOURCES: &str = "crates/mozzi-web";
/// Bytes of stack, for xacro files that nest deep; more ends in a trap.
const STACK: usize = 8 << 20;
const TARGET: &str = "wasm32-unknown-unknown";

/// Compiles one; messages of panics name no folder of this machine.
fn compile(compiler: &Compiler, workspace: &Workspace, folder: &Path, wasm: &Wasm) -> Result<(), String> {
    let build = ["build", "--package", "mozzi-web", "--lib", "--profile", "web"];
    let mut cargo = compiler.cargo(workspace, &build, TARGET);
    cargo.args(wasm.features).arg("--target-dir").arg(folder);
    if let Compiler::Folder(_) = compiler {
        cargo.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", cross::lld());
    }
    let home = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| std::env::home_dir().map(|home| home.join(".cargo")));
    let sysroot = compiler.sysroot();
    let library = sysroot.as_ref().and_then(|root| root.join("lib/rustlib/src/rust").canonicalize().ok());
    let places =
        [Some(workspace.root.clone()), home, sysroot, library].into_iter().zip(["mozzi", "cargo", "rust", "rust"]);
    let flags = places.filter_map(|(place, name)| Some(format!("--remap-path-prefix={}={name}", place?.display())));
    let flags = flags.chain([format!("-Clink-arg=-zstack-size={STACK}")]);
    cargo.env("CARGO_ENCODED_RUSTFLAGS", flags.collect::<Vec<_>>().join("\u{1f}"));
    command::run(cargo)
}

/// Builds and packs both if there is a compiler; returns a description.
pub fn write(workspace: &Workspace) -> Result<String, String> {
    let Some(compiler) = Compiler::find(TARGET)? else {
        return Ok(format!("the committed wasm files: no compiler for {TARGET}, see CONTRIBUTING.md"));
    };
    for wasm in &ALL {
        wasm.write(workspace, &compiler)?;
    }
    Ok(format!("wasm by {}", compiler.version()))
}

/// Checks that each committed wasm is the one of its note, and was made from the current interface.
pub fn are_current(workspace: &Workspace) -> Result<(), String> {
    ALL.iter().try_for_each(|wasm| wasm.is_current(workspace))
}

impl Wasm {
    fn write(&self, workspace: &Workspace, compiler: &Compiler) -> Result<(), String> {
        let folder = workspace.target().join("wasm");
        compile(compiler, workspace, &folder, self)?;
        let built = folder.join(TARGET).join("web/mozzi_web.wasm");
        let mut pack = Command::new("node");
        pack.current_dir(workspace.path("page")).arg("pack.mjs").arg(built).arg(workspace.path(self.gzip));
        command::run(pack)?;
        let version = compiler.version();
        let version = version.split(" (").next().unwrap_or_default();
        let (hash, stamp) = (self.hash(workspace)?, stamp(workspace)?);
        let name = self.gzip.rsplit('/').next().unwrap_or_default();
        let note = format!(
            "{name}, hash {hash}, is mozzi-web, stamp {stamp}, compiled by {version} with these packages:\n\n{}",
            self.packages(workspace)?
        );
        std::fs::write(workspace.path(self.note), note).map_err(|error| format!("{}: {error}", self.note))
    }

    fn is_current(&self, workspace: &Workspace) -> Result<(), String> {
        let Wasm { gzip, note: name, .. } = self;
        let note = std::fs::read_to_string(workspace.path(name)).map_err(|error| format!("{name}: {error}"))?;
        if !note.contains(&format!("hash {},", self.hash(workspace)?)) {
            return Err(format!("{gzip} is not the file of {name}: run cargo xtask page"));
        }
        match note.contains(&format!("stamp {},", stamp(workspace)?)) {
            true => Ok(()),
            false => Err(format!("{gzip} is older than {SOURCES}: run cargo xtask page with a compiler for {TARGET}")),
        }
    }

    fn hash(&self, workspace: &Workspace) -> Result<String, String> {
        let bytes = std::fs::read(workspace.path(self.gzip)).map_err(|error| format!("{}: {error}", self.gzip))?;
        Ok(fnv(bytes))
    }

    /// The packages in it, each with its version and licence.
    fn packages(&self, workspace: &Workspace) -> Result<String, String> {
        let mut tree = workspace.cargo(&["tree", "--package", "mozzi-web", "--target", TARGET, "--edges", "normal"]);
        tree.args(self.features);
        tree.args(["--prefix", "none", "--no-dedupe", "--format", "{p}, {l}"]);
        let (_, text) = command::output(tree)?;
        let is_compiled_in = |line: &&str| !line.is_empty() && !line.contains("(proc-macro)") && !line.contains("(/");
        let mut lines: Vec<&str> = text.lines().filter(is_compiled_in).collect();
        lines.sort_unstable();
        lines.dedup();
        Ok(lines.join("\n") + "\n")
    }
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
