//! Independent results, such as those of joints, on all cores.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Jobs with fewer numbers are done before another thread has begun.
const SMALL: usize = 20_000;

/// `of(0)`, `of(1)`, … `of(count − 1)`, in this order; `numbers` are read by all of them together. The results do not
/// depend on the number of cores.
pub fn each<T: Send>(count: usize, numbers: usize, of: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let results: Vec<Mutex<Option<T>>> = (0..count).map(|_| Mutex::new(None)).collect();
    on_cores(count, numbers, &|k| {
        if let Ok(mut place) = results[k].lock() {
            *place = Some(of(k));
        }
    });
    results.into_iter().filter_map(|place| place.into_inner().ok().flatten()).collect()
}

/// Does each of `count` jobs once; a panic of one is passed on.
fn on_cores(count: usize, numbers: usize, job: &(dyn Fn(usize) + Sync)) {
    let cores = thread::available_parallelism().map_or(1, usize::from).min(count);
    if cores <= 1 || numbers < SMALL {
        return (0..count).for_each(job);
    }
    let next = AtomicUsize::new(0);
    let work = || {
        loop {
            match next.fetch_add(1, Ordering::Relaxed) {
                k if k < count => job(k),
                _ => return,
            }
        }
    };
    thread::scope(|scope| {
        (1..cores).for_each(|_| drop(scope.spawn(work)));
        work();
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_order_on_one_core_and_on_many() {
        for numbers in [0, SMALL] {
            assert_eq!(each(100, numbers, |k| k * k), (0..100).map(|k| k * k).collect::<Vec<_>>());
            assert!(each(0, numbers, |k| k).is_empty());
        }
    }
}
