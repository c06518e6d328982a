//! Independent results, such as those of joints, on all cores.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Jobs with fewer numbers are done before another thread has begun.
const SMALL: usize = 20_000;

/// `of(0)`, `of(1)`, … `of(count − 1)`, in this order; `numbers` are read by all of them together. The results do not
/// depend on the number of cores.
pub fn each<T: Send>(count: usize, numbers: usize, of: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let cores = thread::available_parallelism().map_or(1, usize::from).min(count);
    if cores <= 1 || numbers < SMALL {
        return (0..count).map(of).collect();
    }
    let next = AtomicUsize::new(0);
    let work = || -> Vec<(usize, T)> {
        let taken = std::iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
        taken.take_while(|&k| k < count).map(|k| (k, of(k))).collect()
    };
    let mut found: Vec<(usize, T)> = thread::scope(|scope| {
        let others: Vec<_> = (1..cores).map(|_| scope.spawn(work)).collect();
        let mut found = work();
        for other in others {
            found.extend(other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
        found
    });
    found.sort_unstable_by_key(|(k, _)| *k);
    found.into_iter().map(|(_, result)| result).collect()
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
