//! Who does the work.

use crate::Error;
use rayon::prelude::*;
use std::sync::Arc;

/// Threads of a batch.
#[derive(Clone, Debug)]
pub(crate) enum Threads {
    /// rayon's own, one a core.
    All,
    /// The caller's.
    One,
    Pool(Arc<rayon::ThreadPool>),
}

impl Threads {
    pub fn new(threads: usize) -> Result<Self, Error> {
        let failed = |reason| Error::Threads { threads, reason };
        match threads {
            0 => Err(failed("expected at least one".into())),
            1 => Ok(Threads::One),
            _ => {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
                Ok(Threads::Pool(Arc::new(pool.map_err(|error| failed(error.to_string()))?)))
            }
        }
    }

    pub fn count(&self) -> usize {
        match self {
            Threads::All => rayon::current_num_threads(),
            Threads::One => 1,
            Threads::Pool(pool) => pool.current_num_threads(),
        }
    }

    /// f of every piece, in their order, with memory that a thread makes once and uses again.
    pub fn map<I: Send, M, R: Send>(
        &self,
        pieces: Vec<I>,
        memory: impl Fn() -> M + Sync,
        f: impl Fn(&mut M, I) -> R + Sync,
    ) -> Vec<R> {
        let one = |pieces: Vec<I>| {
            let mut memory = memory();
            pieces.into_iter().map(|piece| f(&mut memory, piece)).collect()
        };
        let many = |pieces: Vec<I>| pieces.into_par_iter().map_init(&memory, &f).collect();
        match self {
            _ if pieces.len() <= 1 => one(pieces),
            Threads::One => one(pieces),
            Threads::All => many(pieces),
            Threads::Pool(pool) => pool.install(|| many(pieces)),
        }
    }
}
