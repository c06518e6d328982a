//! Compilers, and where programs and libraries are.

use crate::{calls, states};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// Warnings of C and C++, as errors.
pub const WARNINGS: [&str; 4] = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"];
pub const SANITIZERS: [&str; 3] =
    ["-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-fno-omit-frame-pointer"];

/// The folder of the libraries that cargo built with this test.
fn libraries() -> PathBuf {
    let this = std::env::current_exe().expect("a test's path");
    this.parent().expect("target/…/deps").to_path_buf()
}

/// The folder of everything that this test writes, with the library under its installed name.
pub fn folder() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("native");
        std::fs::create_dir_all(&folder).expect("a folder of this test's");
        for name in ["libmozzi.so.0", "libmozzi.so"] {
            let _ = std::fs::remove_file(folder.join(name));
            link(&libraries().join("libmozzi_c.so"), &folder.join(name));
        }
        let _ = std::fs::remove_file(folder.join("libmozzi.a"));
        link(&libraries().join("libmozzi_c.a"), &folder.join("libmozzi.a"));
        std::fs::write(folder.join("calls.inc"), calls::functions()).expect("a file of this test's");
        std::fs::write(folder.join("methods.inc"), calls::methods()).expect("a file of this test's");
        std::fs::write(folder.join("states.txt"), states::file()).expect("a file of this test's");
        folder
    })
}

/// Writes a copy of the library under another name.
pub fn copy_of_the_library() {
    std::fs::copy(libraries().join("libmozzi_c.so"), folder().join("copy-of-mozzi.so")).expect("a file of this test's");
}

#[cfg(unix)]
fn link(from: &Path, to: &Path) {
    std::os::unix::fs::symlink(from, to).expect("a link in this test's folder");
}

#[cfg(not(unix))]
fn link(from: &Path, to: &Path) {
    std::fs::copy(from, to).expect("a file in this test's folder");
}

/// A file of the package.
pub fn source(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// Can this program be run?
pub fn exists(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|found| found.status.success())
}

/// Can this compiler link with sanitizers? Debian's clang needs a further package for them.
pub fn has_sanitizers(compiler: &str) -> bool {
    let (source, to) = (folder().join("empty.c"), folder().join(format!("empty-{compiler}")));
    std::fs::write(&source, "int main(void) { return 0; }\n").expect("a file of this test's");
    let has = Command::new(compiler).args(SANITIZERS).args(["-x", "c"]).arg(source).arg("-o").arg(to).output();
    let has = has.is_ok_and(|found| found.status.success());
    if !has {
        println!("skipped: {compiler} has no sanitizers here");
    }
    has
}

/// Runs a command; its output is shown if it fails.
pub fn run(command: &mut Command) -> String {
    let found = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, err) = (text(&found.stdout), text(&found.stderr));
    assert!(found.status.success(), "{command:?}: {}\n{out}\n{err}", found.status);
    out
}

/// The compiler's flags for Eigen; none where it is not installed.
pub fn eigen() -> Option<Vec<String>> {
    let places = ["/usr/include/eigen3", "/usr/local/include/eigen3"];
    let place = places.iter().find(|place| Path::new(place).join("Eigen/Core").exists());
    if place.is_none() {
        println!("skipped: Eigen is not installed");
    }
    place.map(|place| vec!["-isystem".to_string(), place.to_string()]) // its warnings are not ours
}

/// A way to compile a program.
#[derive(Clone, Copy)]
pub struct Build<'a> {
    pub compiler: &'a str,
    pub standard: &'a str,
    pub flags: &'a [&'a str],
    pub is_static: bool,
}

impl Build<'_> {
    /// Compiles a program of `tests/programs`, or of another folder of the package; its path.
    pub fn compile(&self, program: &str) -> PathBuf {
        let (place, program) = match program.rsplit_once('/') {
            Some((place, program)) => (source(place), program),
            None => (source("tests/programs"), program),
        };
        let kind = format!("{}-{}-{}-{}", self.compiler, self.standard, self.flags.join(""), self.is_static);
        let kind: String = kind.chars().filter(|c| c.is_alphanumeric() || "-+".contains(*c)).collect();
        let to = folder().join(format!("{}-{kind}", program.replace('.', "-")));
        let mut compiler = Command::new(self.compiler);
        compiler.arg(format!("-std={}", self.standard)).args(WARNINGS).args(["-g1", "-O0"]).args(self.flags);
        compiler.arg("-I").arg(source("include")).arg("-I").arg(folder());
        compiler.arg(place.join(program)).arg("-o").arg(&to);
        if self.is_static {
            compiler.arg(folder().join("libmozzi.a"));
        } else {
            compiler.arg("-L").arg(folder()).arg("-lmozzi").arg(format!("-Wl,-rpath,{}", folder().display()));
        }
        run(compiler.args(["-lm", "-lpthread", "-ldl"]));
        to
    }

    /// Compiles and runs a program with the file of states.
    pub fn run(&self, program: &str) -> String {
        let path = self.compile(program);
        run(Command::new(path).arg(folder().join("states.txt")).current_dir(folder()))
    }
}
