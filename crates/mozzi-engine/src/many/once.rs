//! A value that is made once by the thread that needs it first, while the others wait; also in a fork of the process,
//! where the thread that makes it may be missing.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

/// Between two looks of a waiting thread.
const LOOK: Duration = Duration::from_micros(50);
/// No process makes it.
const NOBODY: u32 = 0;

#[derive(Debug)]
pub(crate) struct Once<T> {
    value: OnceLock<T>,
    /// The process in which a thread makes the value, or [`NOBODY`].
    maker: AtomicU32,
}

impl<T> Default for Once<T> {
    fn default() -> Self {
        Once { value: OnceLock::new(), maker: AtomicU32::new(NOBODY) }
    }
}

impl<T> Once<T> {
    pub fn get(&self) -> Option<&T> {
        self.value.get()
    }

    /// The value; makes it if there is none.
    ///
    /// # Errors
    /// That of `make`; the next thread tries again.
    pub fn get_or_try<E>(&self, make: impl FnOnce() -> Result<T, E>) -> Result<&T, E> {
        let this = std::process::id();
        loop {
            if let Some(value) = self.value.get() {
                return Ok(value);
            }
            let maker = self.maker.load(Ordering::Acquire);
            // in a fork, the maker is of the other process and will never finish here
            if maker != this && self.maker.compare_exchange(maker, this, Ordering::AcqRel, Ordering::Acquire).is_ok() {
                break;
            }
            std::thread::sleep(LOOK);
        }
        let _last = Last(&self.maker);
        if let Some(value) = self.value.get() {
            return Ok(value); // made between the two looks
        }
        // the lock of `OnceLock` is held for the move of a made value alone
        let made = make()?;
        Ok(self.value.get_or_init(|| made))
    }
}

/// Lets others try when the maker ends, by an error or a panic, too.
struct Last<'a>(&'a AtomicU32);

impl Drop for Last<'_> {
    fn drop(&mut self) {
        self.0.store(NOBODY, Ordering::Release);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicUsize;

    #[test]
    fn it_is_made_once_by_many_threads() {
        let (once, made) = (Once::default(), AtomicUsize::new(0));
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    let found = once.get_or_try(|| {
                        std::thread::sleep(Duration::from_millis(20));
                        Ok::<_, ()>(made.fetch_add(1, Ordering::Relaxed))
                    });
                    assert_eq!(found, Ok(&0));
                });
            }
        });
        assert_eq!(made.into_inner(), 1);
    }

    #[test]
    fn an_error_a_panic_and_a_fork_leave_it_to_the_next() {
        let once: Once<u8> = Once::default();
        assert_eq!(once.get_or_try(|| Err(7)), Err(7));
        let panicked = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            once.get_or_try(|| -> Result<u8, ()> { panic!("of the test") }).copied()
        }));
        assert!(panicked.is_err() && once.get().is_none());
        once.maker.store(std::process::id() + 1, Ordering::Release); // as a fork finds it
        assert_eq!(once.get_or_try(|| Ok::<_, ()>(3)), Ok(&3));
        assert_eq!(once.get_or_try(|| Err(7)), Ok(&3));
    }
}
