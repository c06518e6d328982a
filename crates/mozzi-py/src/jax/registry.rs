//! The robots that compiled programs of JAX refer to, by a hash of their content: the number in a program is the same
//! in every process, so that JAX's persistent cache of programs stays right.
//!
//! A robot is never removed: a program that JAX keeps may be called at any time. It takes some kilobytes.

use mozzi::Model;
use mozzi_engine::{Batch, Error, Number};
use std::collections::BTreeMap;
use std::sync::{Arc, PoisonError, RwLock};

static ROBOTS: RwLock<BTreeMap<i64, Arc<Entry>>> = RwLock::new(BTreeMap::new());

/// A robot and its batches.
pub struct Entry {
    pub model: Model,
    double: Batch<f64>,
    single: Batch<f32>,
}

/// A number type of batches.
pub trait Batched: Number {
    fn batch(entry: &Entry) -> &Batch<Self>;
}
impl Batched for f64 {
    fn batch(entry: &Entry) -> &Batch<f64> {
        &entry.double
    }
}
impl Batched for f32 {
    fn batch(entry: &Entry) -> &Batch<f32> {
        &entry.single
    }
}

impl Entry {
    /// The batch on at most this many threads; 0 for all cores. All share their machine code.
    pub fn batch<T: Batched>(&self, threads: usize) -> Result<Batch<T>, Error> {
        let batch = T::batch(self).clone();
        if threads == 0 { Ok(batch) } else { batch.with_threads(threads) }
    }
}

/// FNV-1a of 64 bits: defined once for all, unlike the hash of Rust's library.
fn hash(text: &str) -> i64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
        as i64
}

/// Registers the robot. Returns its number, which depends on its description alone.
///
/// # Errors
/// If another robot has the same number, which is as unlikely as for any hash of 64 bits.
pub fn register(model: &Model) -> Result<i64, String> {
    let handle = hash(&format!("{:?}", model.description())); // floats are written with all digits
    let mut robots = ROBOTS.write().unwrap_or_else(PoisonError::into_inner);
    let entry = robots.entry(handle).or_insert_with(|| {
        Arc::new(Entry { model: model.clone(), double: Batch::of(model), single: Batch::of(model) })
    });
    match entry.model.description() == model.description() {
        true => Ok(handle),
        false => Err(format!(
            "robots `{}` and `{}` have the same hash",
            entry.model.description().name,
            model.description().name
        )),
    }
}

/// The robot with this number.
///
/// # Errors
/// If it was not registered in this process.
pub fn find(handle: i64) -> Result<Arc<Entry>, String> {
    let robots = ROBOTS.read().unwrap_or_else(PoisonError::into_inner);
    robots.get(&handle).cloned().ok_or_else(|| {
        format!(
            "no robot in this process has the hash {handle:#018x}; call a function of mozzi.jax with its model first"
        )
    })
}
