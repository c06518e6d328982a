//! A contestant: a library, or one of mozzi's ways to compute, with one robot and its states.

use crate::mozzi_ways;
use crate::peak::Width;
use crate::peer::Peer;
use mozzi::Model;
use mozzi::quantities::Query;
use mozzi_benches::States;

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

/// All contestants that support this robot; the first is mozzi at one state, which gives the reference and the unit.
pub fn all<'a>(name: &str, model: &'a Model, states: &'a States, peers: &'a [Peer]) -> Result<Vec<Entry<'a>>, String> {
    let mut entries = mozzi_ways::all(model, states)?;
    for peer in peers {
        if let Some(robot) = peer.robot(name, model, states)? {
            entries.push(Entry { name: peer.name.clone(), width: None, contestant: Box::new(robot) });
        }
    }
    Ok(entries)
}
