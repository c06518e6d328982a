//! Runs the libraries: a script in a Python process reads a request and writes results.

use crate::compare::answer::{Answer, Fault, Unavailable};
use crate::compare::question::Question;
use crate::compare::question::name_of;
use crate::compare::{Error, Result};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

/// One text: each part uses names of the parts before it.
const SCRIPT: &str = concat!(
    include_str!("peers/common.py"),
    include_str!("peers/pinocchio.py"),
    include_str!("peers/mujoco.py"),
    include_str!("peers/answer.py")
);

/// A question, and the library that gets it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Peer {
    Pinocchio,
    /// Pinocchio with coupled mimic joints.
    PinocchioMimic,
    MuJoCo,
}

impl Peer {
    pub fn key(self) -> &'static str {
        if self == Peer::MuJoCo { "mujoco" } else { "pinocchio" }
    }
}

/// The given interpreter, that of the active virtual environment, or `python3`.
pub fn find(named: Option<&str>) -> PathBuf {
    let (inside, global) = if cfg!(windows) { ("Scripts/python.exe", "python") } else { ("bin/python", "python3") };
    match (named, std::env::var_os("VIRTUAL_ENV")) {
        (Some(path), _) => PathBuf::from(path),
        (None, Some(folder)) => Path::new(&folder).join(inside),
        (None, None) => PathBuf::from(global),
    }
}

/// Runs each library in its own process, at the same time: a crash in one does not affect the others.
pub fn ask(python: &Path, question: &Question, peers: &[Peer], limit: Duration) -> Result<Vec<Answer>> {
    let running: Vec<(Peer, Child)> = peers.iter().map(|&peer| Ok((peer, start(python)?))).collect::<Result<_>>()?;
    let answers = thread::scope(|scope| {
        let threads: Vec<_> = running
            .into_iter()
            .map(|(peer, child)| (peer, scope.spawn(move || answer(child, question, peer, limit))))
            .collect();
        let died =
            |peer: Peer| Answer::silent(peer.key(), Unavailable::Died("its answer was not read".into(), Fault::Mozzi));
        threads.into_iter().map(|(peer, thread)| thread.join().unwrap_or_else(|_| died(peer))).collect()
    });
    Ok(answers)
}

fn start(python: &Path) -> Result<Child> {
    let mut command = Command::new(python);
    command.arg("-c").arg(SCRIPT).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().map_err(|error| Error::Python { python: python.to_path_buf(), error })
}

fn answer(child: Child, question: &Question, peer: Peer, limit: Duration) -> Answer {
    let read = |value: serde_json::Value| {
        let answer = Answer::read(&value).filter(|answer| answer.library == name_of(peer.key()));
        answer.ok_or_else(|| not_written(&value.to_string()))
    };
    let answer = value(child, question, peer, limit).and_then(read);
    answer.unwrap_or_else(|(why, fault)| Answer::silent(peer.key(), Unavailable::Died(why, fault)))
}

/// The results of one library as JSON, to be stored.
#[cfg(test)]
pub fn raw(python: &Path, question: &Question, peer: Peer) -> std::result::Result<serde_json::Value, String> {
    let child = start(python).map_err(|error| error.to_string())?;
    value(child, question, peer, crate::compare::TIME_LIMIT).map_err(|(why, _)| why)
}

/// The reason why there is no result, and the part at fault.
type Missing = (String, Fault);

fn not_written(text: &str) -> Missing {
    let start: String = text.chars().take(60).collect();
    (format!("its answer is not what the script writes: `{start}`"), Fault::Python)
}

/// The script's output, or the reason why there is none.
fn value(
    mut child: Child,
    question: &Question,
    peer: Peer,
    limit: Duration,
) -> std::result::Result<serde_json::Value, Missing> {
    let of_mozzi = |why: String| (why, Fault::Mozzi);
    let asked = question.json(peer.key(), peer == Peer::PinocchioMimic).map_err(|error| of_mozzi(error.to_string()))?;
    if let Some(mut stdin) = child.stdin.take() {
        // if a script ends before it has read, its exit status gives the reason
        thread::spawn(move || drop(stdin.write_all(asked.to_string().as_bytes())));
    }
    let (out, err) = (text_of(child.stdout.take()), text_of(child.stderr.take()));
    let deadline = Instant::now() + limit;
    let late = || (format!("no answer within {} s, it was ended", limit.as_secs_f64()), Fault::Python);
    let (text, status) = match (received(&out, deadline), ended(&mut child, deadline)) {
        (Some(text), Some(status)) => (text, status),
        _ => {
            // the threads that read it end with its pipes
            let _ = child.kill().and_then(|()| child.wait());
            return Err(late());
        }
    };
    let said = received(&err, deadline).unwrap_or_default();
    let last = said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it said nothing").trim();
    if !status.success() {
        // killed by a signal: the fault of the library's own code
        let fault = if status.code().is_none() { Fault::Library } else { Fault::Python };
        return Err((format!("Python ended with {status}: {last}"), fault));
    }
    serde_json::from_str(&text).map_err(|_| not_written(&text))
}

/// A pipe's text, read until it is closed.
fn text_of(pipe: Option<impl Read + Send + 'static>) -> Receiver<String> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(mut pipe) = pipe {
            let _ = pipe.read_to_end(&mut bytes);
        }
        let _ = sender.send(String::from_utf8_lossy(&bytes).into_owned());
    });
    receiver
}

fn received(text: &Receiver<String>, deadline: Instant) -> Option<String> {
    text.recv_timeout(deadline.saturating_duration_since(Instant::now())).ok()
}

/// Its exit status, if it ended in time.
fn ended(child: &mut Child, deadline: Instant) -> Option<ExitStatus> {
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Some(status),
            Ok(None) if Instant::now() < deadline => thread::sleep(Duration::from_millis(5)),
            _ => return None,
        }
    }
}
