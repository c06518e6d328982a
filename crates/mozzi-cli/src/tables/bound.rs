//! Bounds on the cost of a damaged or hostile file: memory, and panics in other crates' readers.

use crate::failure::{Failure, Result};
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

/// A compressed table of any size may unpack to this many bytes.
const UNPACKED: u64 = 1 << 30;
/// A larger table may unpack to this multiple of its size.
const RATIO: u64 = 16;

/// The number of bytes to which a compressed table may still unpack.
pub struct Unpacked {
    most: u64,
    left: u64,
}

impl Unpacked {
    /// For a file of this length.
    pub fn of(length: u64) -> Self {
        let most = UNPACKED.max(length.saturating_mul(RATIO));
        Unpacked { most, left: most }
    }

    /// Takes these bytes; an error if too few are left.
    pub fn take(&mut self, bytes: u64) -> std::result::Result<(), String> {
        self.left = self.left.checked_sub(bytes).ok_or_else(|| {
            let most = self.most >> 20;
            format!("it unpacks to more than {most} MiB, expected at most these; write it without compression")
        })?;
        Ok(())
    }
}

thread_local! {
    /// The file that another crate reads.
    static FILE: RefCell<Option<String>> = const { RefCell::new(None) };
}
static HOOK: Once = Once::new();

/// Calls another crate's reader: a panic on damaged bytes becomes an error of the file. Where panics abort (the profile
/// `release`; `dist`, of packages, unwinds), the error is printed and the program ends here.
pub fn caught<T>(file: &str, read: impl FnOnce() -> Result<T>) -> Result<T> {
    HOOK.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| match FILE.with_borrow(Clone::clone) {
            Some(file) if cfg!(panic = "abort") => {
                eprintln!("error: {}", damaged(&file));
                std::process::exit(1);
            }
            Some(_) => {}
            None => before(panic),
        }));
    });
    let outside = FILE.replace(Some(file.to_owned()));
    let found = catch_unwind(AssertUnwindSafe(read));
    FILE.set(outside);
    found.unwrap_or_else(|_| Err(Failure::wrong(damaged(file))))
}

fn damaged(file: &str) -> String {
    format!("{file} is damaged: its content contradicts itself")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_an_error_of_the_file() {
        let Err(Failure::Wrong(said)) = caught::<()>("a.arrow", || panic!("not printed")) else { panic!("an error") };
        assert!(said.starts_with("a.arrow is damaged"), "{said}");
        assert_eq!(caught("a.arrow", || Ok(1)).expect("no panic"), 1);
    }

    #[test]
    fn what_unpacks_is_bounded_by_a_constant_and_by_the_file() {
        assert!(Unpacked::of(10).take(UNPACKED).is_ok());
        let mut unpacked = Unpacked::of(UNPACKED);
        assert!(unpacked.take(RATIO * UNPACKED).is_ok());
        assert!(unpacked.take(1).expect_err("no more").contains("more than 16384 MiB"));
        assert!(Unpacked::of(u64::MAX).take(u64::MAX).is_ok());
    }
}
