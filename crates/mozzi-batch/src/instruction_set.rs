//! Which registers the machine has, found once when it runs; and the entries: the one place where code is compiled for them.

use crate::chunk::{Chunk, Worker};
use crate::lanes::{Lane, Portable};
use crate::quantity::Quantity;
use mozzi::Model;
use mozzi::scalar::{Bits, Float};

/// The registers that states are computed in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum InstructionSet {
    /// Plain arithmetic, one state at a time, on any processor: bit for bit the results of `mozzi`'s kernels at one state.
    Portable,
    /// 256 bits, with fused multiply-add: 4 `f64` or 8 `f32`.
    Avx2,
    /// 512 bits: 8 `f64` or 16 `f32`.
    Avx512,
}

impl InstructionSet {
    /// Those that this machine has, the fastest last.
    pub fn available() -> Vec<InstructionSet> {
        use InstructionSet::*;
        [Portable, Avx2, Avx512].into_iter().filter(|set| set.is_available()).collect()
    }

    /// The fastest that this machine has.
    pub fn best() -> InstructionSet {
        Self::available().last().copied().unwrap_or(InstructionSet::Portable)
    }

    /// Has this machine it?
    pub fn is_available(self) -> bool {
        match self {
            InstructionSet::Portable => true,
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => std::is_x86_feature_detected!("avx2") && std::is_x86_feature_detected!("fma"),
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => {
                std::is_x86_feature_detected!("avx512f")
                    && std::is_x86_feature_detected!("avx512dq")
                    && std::is_x86_feature_detected!("avx512vl")
            }
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }

    /// How many states a register of these numbers holds.
    pub fn lanes<T: Number>(self) -> usize {
        match self {
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => T::Avx512::WIDTH,
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => T::Avx2::WIDTH,
            _ => T::Portable::WIDTH,
        }
    }

    /// "portable", "avx2" or "avx512".
    pub fn name(self) -> &'static str {
        match self {
            InstructionSet::Portable => "portable",
            InstructionSet::Avx2 => "avx2",
            InstructionSet::Avx512 => "avx512",
        }
    }
}

/// `f64` or `f32`: a number that batches are of, with its registers.
pub trait Number: Float + Bits<Number = Self> + Into<f64> + Send + Sync {
    /// One number on any processor: wider arrays are no faster, and take their width in time to compile.
    type Portable: Lane<Number = Self>;
    /// AVX2.
    #[cfg(target_arch = "x86_64")]
    type Avx2: Lane<Number = Self>;
    /// AVX-512.
    #[cfg(target_arch = "x86_64")]
    type Avx512: Lane<Number = Self>;
}

impl Number for f64 {
    type Portable = Portable<f64, 1>;
    #[cfg(target_arch = "x86_64")]
    type Avx2 = crate::lanes::F64x4;
    #[cfg(target_arch = "x86_64")]
    type Avx512 = crate::lanes::F64x8;
}

impl Number for f32 {
    type Portable = Portable<f32, 1>;
    #[cfg(target_arch = "x86_64")]
    type Avx2 = crate::lanes::F32x8;
    #[cfg(target_arch = "x86_64")]
    type Avx512 = crate::lanes::F32x16;
}

/// A chunk of states, on registers of one kind.
pub(crate) type Entry<Q, L> = fn(&Q, &Model<<L as Bits>::Number>, &mut Worker<L>, Chunk<<L as Bits>::Number>);

/// What is done once a kind of registers is chosen.
pub(crate) trait OnLanes<T: Number, Q> {
    type Output;
    fn on<L: Lane<Number = T>>(self, entry: Entry<Q, L>) -> Self::Output;
}

/// Chooses: the only way to an entry.
pub(crate) fn choose<T: Number, Q: Quantity, F: OnLanes<T, Q>>(set: InstructionSet, f: F) -> F::Output {
    assert!(set.is_available(), "{} is not of this machine", set.name()); // checked where a batch is made
    match set {
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx512 => f.on::<T::Avx512>(avx512),
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx2 => f.on::<T::Avx2>(avx2),
        _ => f.on::<T::Portable>(|q, model, worker, chunk| worker.run(q, model, chunk)),
    }
}

#[cfg(target_arch = "x86_64")]
fn avx2<Q: Quantity, T: Number>(q: &Q, model: &Model<T>, worker: &mut Worker<T::Avx2>, chunk: Chunk<T>) {
    #[target_feature(enable = "avx2,fma")]
    fn entry<Q: Quantity, T: Number>(q: &Q, model: &Model<T>, worker: &mut Worker<T::Avx2>, chunk: Chunk<T>) {
        worker.run(q, model, chunk);
    }
    // SAFETY: `choose` has asked the processor.
    unsafe { entry(q, model, worker, chunk) }
}

#[cfg(target_arch = "x86_64")]
fn avx512<Q: Quantity, T: Number>(q: &Q, model: &Model<T>, worker: &mut Worker<T::Avx512>, chunk: Chunk<T>) {
    #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma")]
    fn entry<Q: Quantity, T: Number>(q: &Q, model: &Model<T>, worker: &mut Worker<T::Avx512>, chunk: Chunk<T>) {
        worker.run(q, model, chunk);
    }
    // SAFETY: `choose` has asked the processor.
    unsafe { entry(q, model, worker, chunk) }
}
