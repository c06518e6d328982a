//! One machine code for equal programs in a process: robots that are loaded again, in each thread or for each test,
//! share it as long as one of them is in use.

use super::{Form, Kernel, Refusal, Shape};
use crate::program::{Program, Step};
use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Arc, Mutex, MutexGuard, TryLockError, Weak};

/// Two hashes of the program, the shape, the form and the condensed outputs. The cache keeps no program to compare
/// with: two different ones have the same key with a probability of 2⁻¹²⁸.
type Key = [u64; 2];

type Cache = BTreeMap<Key, Weak<Kernel>>;

static CACHE: Mutex<Cache> = Mutex::new(Cache::new());

/// Looks at the lock before the cache is not used.
const LOOKS: usize = 1000;

impl Kernel {
    /// As [`condensing`](Self::condensing), but the kernel of an equal program, where there is one, is returned again.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn shared(program: &Program, shape: Shape, form: Form, condensed: usize) -> Result<Arc<Kernel>, Refusal> {
        let key = [0, 1].map(|seed: u8| key(seed, program, shape, form, condensed));
        if let Some(kernel) = cache().and_then(|cache| cache.get(&key)?.upgrade()) {
            return Ok(kernel);
        }
        let kernel = Arc::new(Kernel::condensing(program, shape, form, condensed)?); // the cache is not locked meanwhile
        if let Some(mut cache) = cache() {
            cache.retain(|_, kernel| kernel.strong_count() > 0);
            cache.insert(key, Arc::downgrade(&kernel));
        }
        Ok(kernel)
    }
}

/// None if it remains locked: in a fork, the thread that locked it is missing. It is locked for microseconds otherwise.
fn cache() -> Option<MutexGuard<'static, Cache>> {
    for _ in 0..LOOKS {
        match CACHE.try_lock() {
            Ok(cache) => return Some(cache),
            Err(TryLockError::Poisoned(cache)) => return Some(cache.into_inner()),
            Err(TryLockError::WouldBlock) => std::thread::yield_now(),
        }
    }
    None
}

/// Numbers by their bits: −0 and 0 are different programs.
fn key(seed: u8, program: &Program, shape: Shape, form: Form, condensed: usize) -> u64 {
    let mut hasher = DefaultHasher::new();
    (seed, shape, form, condensed.min(program.outputs().len())).hash(&mut hasher);
    for input in program.inputs() {
        input.length.hash(&mut hasher);
    }
    for step in program.steps() {
        match *step {
            Step::Constant(x) => (0_u8, x.to_bits()).hash(&mut hasher),
            Step::Input(array, entry) => (1_u8, array, entry).hash(&mut hasher),
            Step::Apply(function, operands) => (2_u8, function, operands).hash(&mut hasher),
        }
    }
    for output in program.outputs() {
        output.values.hash(&mut hasher);
    }
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::Scalar;

    fn scaled(by: f64) -> Program {
        crate::record("scaled", &[("x", 2)], |x| vec![("y", vec![x[0][0] * crate::Traced::from_f64(by) + x[0][1]])])
            .expect("short")
    }

    #[test]
    fn equal_programs_share_their_code_while_it_is_in_use() {
        if !Shape::OneF64.is_supported() {
            return;
        }
        let code = |by, condensed| {
            Kernel::shared(&scaled(by), Shape::OneF64, Form::Blocks, condensed).expect("a short program")
        };
        let shared = |by| code(by, usize::MAX);
        let kernel = shared(3.5);
        assert!(Arc::ptr_eq(&kernel, &shared(3.5)));
        assert!(!Arc::ptr_eq(&kernel, &shared(3.6)), "another constant");
        assert!(!Arc::ptr_eq(&kernel, &code(3.5, 0)), "condensed");
        let used = Arc::downgrade(&kernel);
        drop(kernel);
        assert!(used.upgrade().is_none(), "the cache keeps nothing alive");
        let again = shared(3.5);
        let (mut y, mut squares) = ([0.0_f64], [0.0]);
        again.call(&[&[2.0, 1.0]], &mut [&mut y], &mut squares);
        assert!((y[0] - 8.0).abs() < 1e-15);
        // a lock that nobody opens stops nobody
        std::thread::scope(|scope| {
            let held = CACHE.lock().expect("sound");
            let made = scope.spawn(|| Kernel::shared(&scaled(3.5), Shape::OneF64, Form::Blocks, usize::MAX));
            let made = made.join().expect("no panic").expect("a short program");
            assert!(!Arc::ptr_eq(&again, &made));
            drop(held);
        });
    }
}
