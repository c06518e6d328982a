//! Asking the libraries: the script in a Python, a question in, an answer out.

use crate::answer::{Answer, Unavailable, name_of};
use crate::question::Question;
use crate::{Error, Result};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

const SCRIPT: &str = include_str!("peers.py");

/// What is asked, and of whom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Peer {
    Pinocchio,
    /// Pinocchio with its mimic joints coupled.
    PinocchioMimic,
    MuJoCo,
}

impl Peer {
    pub fn key(self) -> &'static str {
        if self == Peer::MuJoCo { "mujoco" } else { "pinocchio" }
    }
}

/// The one named, that of the virtual environment that is active, or `python3`.
pub fn find(named: Option<&str>) -> PathBuf {
    let (inside, global) = if cfg!(windows) { ("Scripts/python.exe", "python") } else { ("bin/python", "python3") };
    match (named, std::env::var_os("VIRTUAL_ENV")) {
        (Some(path), _) => PathBuf::from(path),
        (None, Some(folder)) => Path::new(&folder).join(inside),
        (None, None) => PathBuf::from(global),
    }
}

/// Each in a process of its own, at the same time: one that dies takes no other along.
pub fn ask(python: &Path, question: &Question, peers: &[Peer]) -> Result<Vec<Answer>> {
    let running: Vec<(Peer, Child)> = peers.iter().map(|&peer| Ok((peer, start(python)?))).collect::<Result<_>>()?;
    let answers = std::thread::scope(|scope| {
        let threads: Vec<_> = running
            .into_iter()
            .map(|(peer, child)| (peer, scope.spawn(move || answer(child, question, peer))))
            .collect();
        let died = |peer: Peer| Answer::silent(peer.key(), Unavailable::Died("its answer was not read".into()));
        threads.into_iter().map(|(peer, thread)| thread.join().unwrap_or_else(|_| died(peer))).collect()
    });
    Ok(answers)
}

fn start(python: &Path) -> Result<Child> {
    let mut command = Command::new(python);
    command.arg("-c").arg(SCRIPT).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().map_err(|error| Error::Python { python: python.to_path_buf(), error })
}

fn answer(child: Child, question: &Question, peer: Peer) -> Answer {
    let read = |value: serde_json::Value| {
        let answer = Answer::read(&value).filter(|answer| answer.library == name_of(peer.key()));
        answer.ok_or_else(|| not_written(&value.to_string()))
    };
    let answer = value(child, question, peer).and_then(read);
    answer.unwrap_or_else(|why| Answer::silent(peer.key(), Unavailable::Died(why)))
}

/// One answer as JSON, to be kept.
#[cfg(test)]
pub fn raw(python: &Path, question: &Question, peer: Peer) -> std::result::Result<serde_json::Value, String> {
    value(start(python).map_err(|error| error.to_string())?, question, peer)
}

fn not_written(text: &str) -> String {
    let start: String = text.chars().take(60).collect();
    format!("its answer is not what the script writes: `{start}`")
}

/// What the script prints, or why there is none.
fn value(mut child: Child, question: &Question, peer: Peer) -> std::result::Result<serde_json::Value, String> {
    let text = question.json(peer.key(), peer == Peer::PinocchioMimic).map_err(|error| error.to_string())?.to_string();
    if let Some(mut stdin) = child.stdin.take() {
        // a script that ends before it has read says why by its exit
        let _ = stdin.write_all(text.as_bytes());
    }
    let output = child.wait_with_output().map_err(|error| format!("its answer cannot be read: {error}"))?;
    let said = String::from_utf8_lossy(&output.stderr);
    let last = said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it said nothing").trim();
    if !output.status.success() {
        return Err(format!("Python ended with {}: {last}", output.status));
    }
    let text = String::from_utf8_lossy(&output.stdout);
    serde_json::from_str(&text).map_err(|_| not_written(&text))
}
