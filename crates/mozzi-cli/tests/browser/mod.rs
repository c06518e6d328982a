//! A page in a real browser.

use serde_json::Value;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// A browser and a Python that drives it, or the reason why there is none.
pub fn browser() -> Result<(PathBuf, PathBuf), String> {
    let given = |name: &str| std::env::var_os(name).map(PathBuf::from).ok_or(format!("{name} is not set"));
    let (browser, python) = (given("MOZZI_BROWSER")?, given("MOZZI_PYTHON")?);
    let probe = Command::new(&python).args(["-c", "import playwright"]).output();
    match probe.is_ok_and(|output| output.status.success()) {
        true => Ok((browser, python)),
        false => Err(format!("{} has no playwright", python.display())),
    }
}

pub fn look(program: &(PathBuf, PathBuf), jobs: &Value) -> Vec<Value> {
    run("look.py", program, jobs)
}

/// What a script of this folder finds in pages.
pub fn run(script: &str, (browser, python): &(PathBuf, PathBuf), jobs: &Value) -> Vec<Value> {
    let script = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/browser")).join(script);
    let mut child = Command::new(python)
        .arg(script)
        .arg(browser)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("Python starts");
    child.stdin.take().expect("a pipe").write_all(jobs.to_string().as_bytes()).expect("written");
    let output = child.wait_with_output().expect("it ends");
    assert!(output.status.success(), "the script failed, see above");
    serde_json::from_slice::<Vec<Value>>(&output.stdout).expect("JSON")
}

pub fn url(path: &std::path::Path) -> String {
    format!("file://{}", path.display())
}
