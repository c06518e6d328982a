//! A trial of the Debian package: install it, run the first command, build a C++ program with it.

use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A state of the UR5, whose torques README shows.
const STATE: [&str; 5] = ["compute", "ur5", "inverse-dynamics", "--theta", "0,-1.2,1.5,0.3,1.1,0"];

/// Tags that lintian reports for a maintainer without an address.
const NO_ADDRESS: &str = "bogus-mail-host,bogus-mail-host-in-debian-changelog";

/// Installs the package into an empty root and uses it there.
pub fn run(workspace: &Workspace, file: &Path) -> Outcome {
    installed(workspace, file).map_or_else(Outcome::Failed, Outcome::Passed)
}

fn installed(workspace: &Workspace, file: &Path) -> Result<String, String> {
    command::run(Command::new("dpkg-deb").arg("--info").arg(file))?;
    let root = workspace.scratch("deb-root")?;
    let how = install(file, &root)?;
    let mozzi = root.join("usr/bin/mozzi");
    command::run(Command::new(&mozzi).arg("--version"))?;
    command::run(Command::new(&mozzi).args(STATE))?;
    let completions = root.join("usr/share/bash-completion/completions/mozzi");
    command::run(Command::new("bash").arg("-n").arg(completions))?;
    let mut gzip = Command::new("gzip");
    command::run(gzip.arg("--test").arg(root.join("usr/share/man/man1/mozzi.1.gz")))?;
    let program = program(workspace, &root)?;
    Ok(format!("{how}; `mozzi {}` ran{program}", STATE[..3].join(" ")))
}

/// By dpkg, with a database of its own, if this user may; else the files alone.
fn install(file: &Path, root: &Path) -> Result<&'static str, String> {
    let database = root.join("var/lib/dpkg");
    let made = ["updates", "info", "triggers"].iter().try_for_each(|name| std::fs::create_dir_all(database.join(name)));
    let made = made.and_then(|()| std::fs::write(database.join("status"), ""));
    made.map_err(|error| format!("{}: {error}", database.display()))?;
    let mut dpkg = Command::new("dpkg");
    // the packages that it depends on are those of this machine, outside the root
    dpkg.arg(format!("--root={}", root.display())).args(["--force-depends", "--install"]).arg(file);
    if command::run(dpkg).is_ok() {
        return Ok("installed by `dpkg --install`");
    }
    command::run(Command::new("dpkg-deb").arg("-x").arg(file).arg(root))?;
    Ok("unpacked, since dpkg may not install here")
}

/// Builds the program of docs/cpp.md with pkg-config, and runs it; skipped without a compiler.
fn program(workspace: &Workspace, root: &Path) -> Result<String, String> {
    let has = |name: &str| command::exists(&mut Command::new(name));
    if !has("c++") || !has("pkg-config") {
        return Ok("; without c++ and pkg-config no program was built".into());
    }
    let page = "docs/cpp.md";
    let text = std::fs::read_to_string(workspace.path(page)).map_err(|error| format!("{page}: {error}"))?;
    let block = text.split("```cpp\n").nth(1).and_then(|rest| rest.split("```").next());
    let folder = workspace.scratch("deb-program")?;
    let source = folder.join("main.cpp");
    std::fs::write(&source, block.ok_or("docs/cpp.md has no block of cpp")?).map_err(|error| error.to_string())?;
    let libraries = folder_of_libraries(root)?;
    let mut flags = Command::new("pkg-config");
    flags.args(["--cflags", "--libs", "mozzi"]).env("PKG_CONFIG_PATH", libraries.join("pkgconfig"));
    let (true, flags) = command::output(flags)? else { return Err("pkg-config does not find mozzi".into()) };
    let mut compile = Command::new("c++");
    compile.args(["-std=c++17", "-o", "main", "main.cpp"]).args(flags.split_whitespace()).current_dir(&folder);
    command::run(compile)?;
    command::run(Command::new(folder.join("main")).env("LD_LIBRARY_PATH", libraries))?;
    Ok(format!("; the program of {page} was built by pkg-config, and ran"))
}

fn folder_of_libraries(root: &Path) -> Result<PathBuf, String> {
    let folder = root.join("usr/lib");
    let entries = std::fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut entries = entries.flatten().map(|entry| entry.path()).filter(|path| path.join("pkgconfig").is_dir());
    entries.next().ok_or_else(|| format!("{} has no pkgconfig", folder.display()))
}

/// Debian's checks, except that of the maintainer's address. Their findings are printed; errors fail.
pub fn lintian(file: &Path) -> Outcome {
    match command::output(
        Command::new("lintian")
            .args(["--tag-display-limit", "0", "--fail-on", "none", "--suppress-tags", NO_ADDRESS])
            .arg(file),
    ) {
        Err(why) => Outcome::Failed(why),
        Ok((_, findings)) => {
            print!("{findings}");
            let (errors, others): (Vec<_>, Vec<_>) = findings.lines().partition(|line| line.starts_with("E:"));
            match errors.is_empty() {
                true => Outcome::Passed(format!("{} warnings", others.len())),
                false => Outcome::Failed(errors.join("; ")),
            }
        }
    }
}
