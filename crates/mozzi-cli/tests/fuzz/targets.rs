//! Properties that hold for any bytes in a robot's JSON, in a table and in a request. `fuzz/` runs these under
//! cargo-fuzz, `tests/fuzz` replays its corpus.

use mozzi::Model;
use mozzi::quantities::Query;
use mozzi_cli::untrusted::{self, Samples};
use std::cell::Cell;
use std::path::PathBuf;
use std::sync::LazyLock;

static ROBOT: LazyLock<Model> =
    LazyLock::new(|| mozzi_urdf::open("two_link_planar").expect("embedded").build().expect("a robot that is right"));

/// A file that is removed when it is dropped.
struct Temporary(PathBuf);

impl Temporary {
    fn name(&self) -> &str {
        self.0.to_str().expect("text")
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

/// A file of these bytes, in memory if there is such a folder, for speed.
fn file(ending: &str, bytes: &[u8]) -> Temporary {
    let memory = PathBuf::from("/dev/shm");
    let folder = if memory.is_dir() { memory } else { std::env::temp_dir() };
    let path = folder.join(format!("mozzi-fuzz-{}.{ending}", std::process::id()));
    std::fs::write(&path, bytes).expect("a temporary file");
    Temporary(path)
}

/// Is the text a message: not empty, and not endless?
fn is_message(text: &str) -> bool {
    !text.is_empty() && text.len() < 1 << 20
}

/// A robot whose model is finite and whose round trip gives the same robot, or errors.
pub fn json(bytes: &[u8]) {
    let path = file("json", bytes);
    let name = path.name();
    match untrusted::robot(name) {
        Err(errors) => {
            assert!(!errors.is_empty() && errors.iter().all(|error| error.starts_with(name) && is_message(error)));
        }
        Ok(robot) => {
            let Ok(model) = robot.build() else { return };
            let is_finite = Cell::new(true);
            model.map(|c: f64| {
                is_finite.set(is_finite.get() && c.is_finite());
                c
            });
            assert!(is_finite.get(), "not finite: {:?}", model.description());
            let text = untrusted::robot_text(&model);
            let again = untrusted::robot(file("json", text.as_bytes()).name());
            let again = again.unwrap_or_else(|errors| panic!("{errors:?}\n{text}"));
            assert_eq!(untrusted::robot_text(&again.build().expect("the same robot")), text);
        }
    }
}

/// A table with as many numbers as its rows need, or an error; the same for a quantity's inputs.
fn table(ending: &str, bytes: &[u8]) {
    let path = file(ending, bytes);
    let name = path.name();
    let query = Query::named("inverse_dynamics").expect("a quantity");
    match untrusted::table(name, &ROBOT) {
        Ok(samples) => is_whole(&samples),
        Err(error) => assert!(error.starts_with(name) && is_message(&error), "{error}"),
    }
    match untrusted::inputs(name, query, &ROBOT) {
        Ok(inputs) => {
            let states = inputs.iter().map(|input| input.len() / ROBOT.n()).collect::<Vec<_>>();
            assert!(inputs.len() == 3 && states.iter().all(|&count| count == states[0]), "{states:?} states");
        }
        Err(error) => assert!(error.starts_with(name) && is_message(&error), "{error}"),
    }
}

fn is_whole(samples: &Samples) {
    assert!(samples.t.as_ref().is_none_or(|t| t.len() == samples.count));
    assert!(samples.lines.is_empty() || samples.lines.len() == samples.count);
    for (name, numbers) in &samples.tables {
        let width = match name.as_str() {
            "theta" | "dtheta" | "ddtheta" | "tau" | "x" => ROBOT.n(),
            "w" => 6,
            "gravity" => 3,
            "parameters" => ROBOT.parameter_count(),
            name if name.starts_with("wrench") => 6,
            _ => 1,
        };
        assert_eq!(numbers.len(), samples.count * width, "{name}");
    }
}

pub fn csv(bytes: &[u8]) {
    table("csv", bytes);
}

/// A log for identification, as text or as a bag: tables of equal lengths, or a message.
fn recorded(ending: &str, bytes: &[u8]) {
    let path = file(ending, bytes);
    let name = path.name();
    match untrusted::log(name, &ROBOT) {
        Ok([t, theta, tau]) => assert!(theta == ROBOT.nq() * t && tau == ROBOT.n() * t, "{t} {theta} {tau}"),
        Err(error) => assert!(error.contains(name) && is_message(&error), "{error}"),
    }
}

pub fn log(bytes: &[u8]) {
    recorded("csv", bytes);
}

pub fn bag(bytes: &[u8]) {
    recorded("db3", bytes);
}

pub fn npy(bytes: &[u8]) {
    table("npy", bytes);
}

pub fn npz(bytes: &[u8]) {
    table("npz", bytes);
}

pub fn arrow(bytes: &[u8]) {
    table("arrow", bytes);
}

/// A connection that sends these bytes in pieces, whose size is the first byte, gets the page only if it names this
/// machine. The answer is the same as if all bytes came at once.
pub fn request(bytes: &[u8]) {
    const PORT: u16 = 8000;
    const PAGE: &str = "<p>page</p>";
    let Some((&size, sent)) = bytes.split_first() else { return };
    let answer = |size: usize| {
        let mut rest = sent;
        let read = |to: &mut [u8]| {
            let count = size.min(rest.len()).min(to.len());
            to[..count].copy_from_slice(&rest[..count]);
            rest = &rest[count..];
            Ok(count)
        };
        untrusted::answer(read, PORT, PAGE).map_err(|error| error.kind())
    };
    let found = answer(usize::from(size) + 1);
    assert_eq!(found, answer(4096));
    if let Ok((status, body)) = found {
        let us = |name: &[u8]| sent.to_ascii_lowercase().windows(name.len()).any(|part| part == name);
        let is_page = status == "200 OK";
        assert!(!is_page || us(b"127.0.0.1:8000") || us(b"localhost:8000"));
        assert!(body != PAGE || is_page && sent.starts_with(b"GET / "));
    }
}
