//! Executes every code block of `book/src`, and some of other pages, each in its language; those of Rust are
//! documentation tests of `examples/src/book.rs`.
//!
//! The blocks of a page run in their order, in one empty folder. All Python of a page is one program, which runs at its
//! first block. A block `xml,file=NAME` (or another data format) becomes a file. The block `text` after a program is
//! its output, and `console` shows commands with theirs: both are compared.

use super::blocks::{Block, blocks};
use super::expected::{agrees, sessions};
use super::mozzi;
use crate::command;
use crate::package;
use crate::report::Outcome;
use crate::venv;
use crate::workspace::Workspace;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The documentation tests of the pages with Rust.
const RUST: &str = "examples/src/book.rs";
/// Pages elsewhere, with the language of which the blocks run; other tests run their other blocks, or none.
const GUIDES: [(&str, &str); 4] =
    [("README.md", "python"), ("README.md", "console"), ("docs/jax.md", "python"), ("docs/cpp.md", "cpp")];
/// Printed between the outputs of two blocks of Python.
const MARK: &str = "\u{1}";
const COMPILERS: [&str; 2] = ["g++", "clang++"];

/// The programs and libraries that the blocks need.
struct Tools {
    /// PATH with the folders of `mozzi` and of the tests' Python in front.
    path: OsString,
    compiler: Option<&'static str>,
    /// The static library of C that the tests were built with.
    library: PathBuf,
    rust: String,
}

/// A page while its blocks run.
struct Page<'a> {
    name: String,
    folder: PathBuf,
    blocks: &'a [Block],
}

pub fn code(workspace: &Workspace) -> Outcome {
    match try_code(workspace) {
        Ok(outcome) => outcome,
        Err(why) => Outcome::Failed(why),
    }
}

fn try_code(workspace: &Workspace) -> Result<Outcome, String> {
    let mozzi = mozzi(workspace)?;
    let paths = std::env::var_os("PATH").unwrap_or_default();
    let python = venv::python(workspace); // with Pinocchio and MuJoCo
    let before = [&mozzi, &python].into_iter().filter_map(|program| program.parent().map(Path::to_path_buf));
    let tools = Tools {
        path: std::env::join_paths(before.chain(std::env::split_paths(&paths))).map_err(|error| error.to_string())?,
        compiler: COMPILERS.into_iter().find(|name| command::exists(&mut Command::new(name))),
        library: workspace.target().join("debug/deps/libmozzi_c.a"),
        rust: std::fs::read_to_string(workspace.path(RUST)).map_err(|error| format!("{RUST}: {error}"))?,
    };
    let (mut ran, mut skipped, mut failed) = (0, Vec::new(), Vec::new());
    let mut files = Vec::new();
    markdown(&workspace.path("book/src"), &mut files)?;
    files.sort();
    let own = files.into_iter().map(|file| (file, None));
    for (file, only) in own.chain(GUIDES.map(|(file, language)| (workspace.path(file), Some(language)))) {
        let name = file.strip_prefix(&workspace.root).unwrap_or(&file).to_string_lossy().replace('\\', "/");
        let text = std::fs::read_to_string(&file).map_err(|error| format!("{name}: {error}"))?;
        let mut blocks = blocks(&text).map_err(|why| format!("{name}: {why}"))?;
        blocks.retain(|block| only.is_none_or(|language| block.language == language));
        let folder = workspace.scratch(&format!("book-{}", name.replace('/', "-").trim_end_matches(".md")))?;
        let page = Page { name, folder, blocks: &blocks };
        for at in 0..blocks.len() {
            match page.run(workspace, &tools, at) {
                Ok(None) => ran += 1,
                Ok(Some(why)) if skipped.contains(&why) => {}
                Ok(Some(why)) => skipped.push(why),
                Err(why) => {
                    let place = format!("{}:{}", page.name, blocks[at].line);
                    println!("{place}: {why}");
                    failed.push(place);
                }
            }
        }
    }
    let note = match &skipped[..] {
        [] => format!("{ran} blocks"),
        skipped => format!("{ran} blocks; skipped: {}", skipped.join(", ")),
    };
    Ok(if failed.is_empty() { Outcome::Passed(note) } else { Outcome::Failed(failed.join(", ")) })
}

fn markdown(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for path in entries.filter_map(Result::ok).map(|entry| entry.path()) {
        match path.is_dir() {
            true => markdown(&path, files)?,
            false if path.extension().is_some_and(|ending| ending == "md") => files.push(path),
            false => {}
        }
    }
    Ok(())
}

impl Page<'_> {
    /// Runs a block; `Some` is the reason why it is skipped.
    fn run(&self, workspace: &Workspace, tools: &Tools, at: usize) -> Result<Option<String>, String> {
        let block = &self.blocks[at];
        let no_output = || match &block.output {
            Some(_) => Err(format!("the output of `{}` is not compared: use console", block.language)),
            None => Ok(()),
        };
        match block.language.as_str() {
            "rust" => {
                no_output()?;
                match tools.rust.contains(&format!("/{}\"", self.name)) {
                    true => {}
                    false => return Err(format!("is not among the documentation tests of {RUST}")),
                }
            }
            "sh" => {
                no_output()?;
                self.shell(tools, &block.code)?;
            }
            "console" => {
                no_output()?;
                for (command, expected) in sessions(&block.code) {
                    compare(&self.session(tools, &command)?, &expected)?;
                }
            }
            "python" if self.blocks[..at].iter().any(|block| block.language == "python") => {}
            "python" => self.python(workspace, tools)?,
            "cpp" => match tools.compiler {
                None => return Ok(Some(format!("cpp, because there is no {}", COMPILERS.join(" or ")))),
                Some(_) if !tools.library.is_file() => return Ok(Some("cpp, because mozzi-c is not built".into())),
                Some(compiler) => self.cpp(workspace, tools, compiler, at)?,
            },
            "xml" | "json" | "yaml" | "csv" => {
                let name = block.option("file").ok_or("data has a name: `xml,file=arm.urdf`")?;
                std::fs::write(self.folder.join(name), &block.code).map_err(|error| format!("{name}: {error}"))?;
            }
            language => return Err(format!("nothing runs `{language}`")),
        }
        Ok(None)
    }

    fn shell(&self, tools: &Tools, script: &str) -> Result<String, String> {
        let (succeeded, out, error) =
            self.output(Command::new("sh").args(["-e", "-c", script]).env("PATH", &tools.path))?;
        if succeeded { Ok(out) } else { Err(format!("it failed: {error}")) }
    }

    /// Runs a command; its output as a terminal shows it, whatever the exit status.
    fn session(&self, tools: &Tools, command: &str) -> Result<String, String> {
        let script = format!("{command} 2>&1");
        let mut shell = Command::new("sh");
        let (_, out, _) = self.output(shell.args(["-c", &script]).env("PATH", &tools.path))?;
        Ok(out)
    }

    fn python(&self, workspace: &Workspace, tools: &Tools) -> Result<(), String> {
        let blocks: Vec<&Block> = self.blocks.iter().filter(|block| block.language == "python").collect();
        let mut program = String::new();
        for block in &blocks {
            program += &format!("{}print(\"\\x01\")\n", block.code);
        }
        std::fs::write(self.folder.join("page.py"), program).map_err(|error| error.to_string())?;
        let mut python = package::python(workspace);
        python.env("PATH", &tools.path).env("PYTHONIOENCODING", "utf-8").env("MPLBACKEND", "agg").arg("page.py");
        let (succeeded, out, error) = self.output(&mut python)?;
        if !succeeded {
            return Err(format!("Python failed:\n{out}{error}"));
        }
        let outputs: Vec<&str> = out.split(&format!("{MARK}\n")).collect();
        for (block, found) in blocks.iter().zip(outputs) {
            if let Some(expected) = &block.output {
                compare(found, expected).map_err(|why| format!("line {}: {why}", block.line))?;
            }
        }
        Ok(())
    }

    fn cpp(&self, workspace: &Workspace, tools: &Tools, compiler: &str, at: usize) -> Result<(), String> {
        let block = &self.blocks[at];
        let (source, program) = (self.folder.join(format!("{at}.cpp")), self.folder.join(format!("{at}.program")));
        std::fs::write(&source, &block.code).map_err(|error| error.to_string())?;
        let mut build = Command::new(compiler);
        build.args(["-std=c++17", "-Wall", "-Wextra", "-Werror", "-O1", "-I"]);
        build.arg(workspace.path("crates/mozzi-c/include")).arg(&source).arg(&tools.library);
        build.args(["-lm", "-lpthread", "-ldl", "-o"]).arg(&program);
        let (succeeded, _, error) = self.output(&mut build)?;
        if !succeeded {
            return Err(format!("{compiler} refuses it: {error}"));
        }
        let (succeeded, out, error) = self.output(&mut Command::new(&program))?;
        if !succeeded {
            return Err(format!("the program failed:\n{out}{error}"));
        }
        block.output.as_ref().map_or(Ok(()), |expected| compare(&out, expected))
    }

    /// Whether a command in the page's folder succeeded, and what it printed.
    fn output(&self, command: &mut Command) -> Result<(bool, String, String), String> {
        let shown = command::shown(command);
        let found = command.current_dir(&self.folder).stdin(Stdio::null()).output();
        let found = found.map_err(|error| format!("`{shown}` did not start: {error}"))?;
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        Ok((found.status.success(), text(&found.stdout), text(&found.stderr)))
    }
}

fn compare(found: &str, expected: &str) -> Result<(), String> {
    match agrees(found, expected) {
        true => Ok(()),
        false => Err(format!("it printed\n{found}\ninstead of\n{expected}")),
    }
}
