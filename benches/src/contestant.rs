//! A contestant: a library, or one of mozzi's ways to compute, with one robot and its states.

use crate::peak::Width;
use mozzi::quantities::Query;

/// One library, or one way of mozzi, that holds a robot and all states.
pub trait Contestant {
    /// Its quantities, and its names for the algorithms.
    fn algorithms(&self) -> Vec<(Query<'static>, String)>;
    /// The k-th algorithm at all states.
    fn run(&mut self, algorithm: usize);
    /// The flops of its own program, if it has one; else the kernels' are counted.
    fn flops(&self, _algorithm: usize) -> Option<usize> {
        None
    }
    /// Its result at one state in mozzi's conventions, matrices by rows.
    fn result(&mut self, algorithm: usize, state: usize) -> Result<Vec<f64>, String>;
}

/// Its column.
pub struct Entry<'a> {
    pub name: String,
    /// For mozzi's ways, the instructions used; none for a peer.
    pub width: Option<Width>,
    pub contestant: Box<dyn Contestant + 'a>,
}
