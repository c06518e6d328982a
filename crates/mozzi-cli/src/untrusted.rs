//! The readers of untrusted files and requests, as the commands call them: for tests and fuzz targets that pass
//! arbitrary bytes.

use crate::failure::Failure;
use crate::serve::request::{self, Head};
use crate::tables::{motion, read, states::States};
use mozzi::quantities::Query;
use mozzi::{Description, Model};
use std::io::Result as IoResult;

pub use crate::tables::samples::Samples;

/// A robot of a JSON file.
///
/// # Errors
/// Every problem with its place.
pub fn robot(file: &str) -> Result<Description, Vec<String>> {
    crate::robot_json::read(file).map_err(|errors| errors.iter().map(ToString::to_string).collect())
}

/// The robot as the text of such a file.
pub fn robot_text(model: &Model) -> String {
    crate::robot_json::write(model)
}

/// A table of named columns or arrays, as `simulate --follow`, `plot` and `view` read it.
///
/// # Errors
/// The error with its place.
pub fn table(file: &str, model: &Model) -> Result<Samples, String> {
    let samples = read::read_as(file, model, &motion::HOW);
    samples.and_then(|samples| motion::mended(samples, model)).map_err(said)
}

/// A log as `identify` reads it: the numbers of times, positions and forces.
///
/// # Errors
/// The error with its place.
pub fn log(file: &str, model: &Model) -> Result<[usize; 3], String> {
    let log = crate::commands::identify::log(file, model).map_err(said)?;
    Ok([log.t.len(), log.theta.len(), log.tau.len()])
}

/// The quantity's inputs at each state of a table, as `compute --in` reads them.
///
/// # Errors
/// The error with its place.
pub fn inputs(file: &str, query: Query, model: &Model) -> Result<Vec<Vec<f64>>, String> {
    States::<f64>::read(file, query, model, &[]).map(|states| states.inputs).map_err(said)
}

/// The status and the body of the response of the server of `mozzi view`; `read` is the connection.
///
/// # Errors
/// An error of the connection.
pub fn answer(read: impl FnMut(&mut [u8]) -> IoResult<usize>, port: u16, page: &str) -> IoResult<(&'static str, &str)> {
    Ok(match request::head(read)? {
        Head::Late => ("408", ""),
        Head::Long => ("431", ""),
        Head::Whole(head) => {
            let reply = request::reply(&head, port, page);
            (reply.status, if reply.is_head { "" } else { reply.body })
        }
    })
}

fn said(failure: Failure) -> String {
    match failure {
        Failure::Wrong(text) | Failure::Answered(text) | Failure::Stopped(text) => text,
        Failure::Load(error) => error.to_string(),
    }
}
