//! One machine code for equal programs in a process: robots that are loaded again, in each thread or for each test,
//! share it as long as one of them is in use.

use super::{Kernel, Refusal, Shape};
use crate::program::{Program, Step};
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// Two hashes of all that the code depends on, in place of a second copy of the program: 2⁻¹²⁸ is no risk.
type Key = [u64; 2];

static CACHE: Mutex<Option<HashMap<Key, Weak<Kernel>>>> = Mutex::new(None);

impl Kernel {
    /// As [`condensing`](Self::condensing), but the kernel of an equal program, where there is one, is returned again.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn shared(program: &Program, shape: Shape, condensed: usize) -> Result<Arc<Kernel>, Refusal> {
        let key = [0, 1].map(|seed: u8| key(seed, program, shape, condensed));
        if let Some(kernel) = with(|cache| cache.get(&key).and_then(Weak::upgrade)) {
            return Ok(kernel);
        }
        let kernel = Arc::new(Kernel::condensing(program, shape, condensed)?); // other threads need not wait for it
        with(|cache| {
            cache.retain(|_, kernel| kernel.strong_count() > 0);
            cache.insert(key, Arc::downgrade(&kernel));
        });
        Ok(kernel)
    }
}

fn with<R>(f: impl FnOnce(&mut HashMap<Key, Weak<Kernel>>) -> R) -> R {
    f(CACHE.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_default())
}

/// Numbers by their bits: −0 and 0 are different programs.
fn key(seed: u8, program: &Program, shape: Shape, condensed: usize) -> u64 {
    let mut hasher = DefaultHasher::new();
    (seed, shape, condensed.min(program.outputs().len())).hash(&mut hasher);
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
    }

    #[test]
    fn equal_programs_share_their_code_while_it_is_in_use() {
        let shape = Shape::OneF64;
        let shared = |by| Kernel::shared(&scaled(by), shape, usize::MAX);
        let Ok(kernel) = shared(3.5) else { return }; // no machine code here
        assert!(Arc::ptr_eq(&kernel, &shared(3.5).unwrap()));
        assert!(!Arc::ptr_eq(&kernel, &shared(3.6).unwrap()), "another constant");
        assert!(!Arc::ptr_eq(&kernel, &Kernel::shared(&scaled(3.5), shape, 0).unwrap()), "condensed");
        let used = Arc::downgrade(&kernel);
        drop(kernel);
        assert!(used.upgrade().is_none(), "the cache keeps nothing alive");
        let again = shared(3.5).unwrap();
        let (mut y, mut squares) = ([0.0_f64], [0.0]);
        again.call(&[&[2.0, 1.0]], &mut [&mut y], &mut squares);
        assert!((y[0] - 8.0).abs() < 1e-15);
    }
}
