//! The threads that compute.

use crate::Error;
use rayon::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};

/// Threads of a batch.
#[derive(Clone, Debug)]
pub(crate) enum Threads {
    /// rayon's global pool, one thread for each core.
    All,
    /// The caller's thread.
    One,
    Pool {
        most: usize,
        started: Started,
    },
}

/// The threads that earlier calls needed.
type Started = Arc<Mutex<Option<Arc<rayon::ThreadPool>>>>;

/// The most threads for each core; more would only wait for each other.
const PER_CORE: usize = 8;

impl Threads {
    /// At most this many threads, started when a call has pieces of work for them.
    pub fn new(threads: usize) -> Result<Self, Error> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        match threads {
            0 => Err(Error::Threads { threads, reason: "expected at least one".into() }),
            1 => Ok(Threads::One),
            _ => Ok(Threads::Pool { most: threads.min(PER_CORE * cores), started: Started::default() }),
        }
    }

    pub fn count(&self) -> usize {
        match self {
            Threads::All => rayon::current_num_threads(),
            Threads::One => 1,
            Threads::Pool { most, .. } => *most,
        }
    }

    /// Applies f to every piece; results are in the order of the pieces. Each thread makes its memory once and reuses
    /// it.
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
            Threads::Pool { most, started } => match pool(started, pieces.len().min(*most)) {
                Some(pool) => pool.install(|| many(pieces)),
                None => one(pieces),
            },
        }
    }
}

/// At least this many threads if the system grants them; otherwise the earlier ones, or none.
fn pool(started: &Started, threads: usize) -> Option<Arc<rayon::ThreadPool>> {
    let mut started = started.lock().unwrap_or_else(PoisonError::into_inner);
    if started.as_ref().is_none_or(|pool| pool.current_num_threads() < threads) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        *started = pool.ok().map(Arc::new).or(started.take());
    }
    started.clone()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_are_not_more_than_pieces() {
        let threads = Threads::new(5000).expect("some");
        let Threads::Pool { most, started } = &threads else { panic!("one thread") };
        let running = || started.lock().expect("sound").as_ref().map_or(0, |pool| pool.current_num_threads());
        assert_eq!((threads.count(), running()), (*most, 0));
        for (pieces, expected) in [(1, 0), (3, 3), (2, 3), (4, 4)] {
            let found = threads.map((0..pieces).collect(), || (), |(), k: usize| 2 * k);
            assert_eq!(found, (0..pieces).map(|k| 2 * k).collect::<Vec<_>>());
            assert_eq!(running(), expected);
        }
        let many = threads.map((0..10_000).collect(), || (), |(), k: usize| k);
        assert!(many.len() == 10_000 && running() == *most);
    }
}
