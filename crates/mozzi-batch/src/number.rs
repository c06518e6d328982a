//! The number types of batches, with their registers; and the entries: the only place where code is compiled for an
//! instruction set.
//!
//! Everything here is for `f64` or for `f32`, not for any number, so that kernels are compiled in this crate alone.

use crate::InstructionSet;
use crate::chunk::Chunk;
#[cfg(target_arch = "aarch64")]
use crate::lanes::{F32x4, F64x2};
#[cfg(target_arch = "x86_64")]
use crate::lanes::{F32x8, F32x16, F64x4, F64x8};
use crate::lanes::{Lane, Portable};
use crate::programmed::{self, ProgramCall};
use crate::registers;
use crate::request::Request;
use crate::run::{Errors, Run};
use crate::worker::Worker;
use mozzi::Model;
use mozzi::quantities::{self, Kernel, Quantity};
use mozzi::scalar::{Bits, Float};

/// `f64` or `f32`.
pub trait Number: Float + Bits<Number = Self> + Into<f64> + Send + Sync + Entries {}
impl Number for f64 {}
impl Number for f32 {}

/// The registers of a number type, and the functions compiled for them.
pub trait Entries: Sized {
    /// One number on any processor: wider arrays are no faster, and take longer to compile in proportion to their
    /// width.
    type Portable: Lane<Number = Self>;
    /// NEON.
    #[cfg(target_arch = "aarch64")]
    type Neon: Lane<Number = Self>;
    /// AVX2.
    #[cfg(target_arch = "x86_64")]
    type Avx2: Lane<Number = Self>;
    /// AVX-512.
    #[cfg(target_arch = "x86_64")]
    type Avx512: Lane<Number = Self>;

    /// Runs all chunks by the kernel of the quantity at this index of the list.
    fn run_kernel(set: InstructionSet, index: usize, run: Run<Self>) -> Errors
    where
        Self: Number;

    /// Runs all chunks by a program, with the numbers that are the same in all states.
    fn run_program(set: InstructionSet, program: ProgramCall, run: Run<Self>) -> Errors
    where
        Self: Number;
}

/// The functions compiled for one kind of registers: running a program, and each kernel, in a table in the order of the
/// list. Quantities that share a kernel share its function.
macro_rules! entries {
    ($name:ident, $T:ty, $L:ty, [$($features:literal)?]; $($Q:ident)*) => {
        mod $name {
            use super::*;

            fn kernel<K: Kernel>(request: &Request<$T>, model: &Model<$T>, worker: &mut Worker<$L>, chunk: Chunk<$T>) {
                $(#[target_feature(enable = $features)])?
                fn entry<K: Kernel>(
                    request: &Request<$T>, model: &Model<$T>, worker: &mut Worker<$L>, chunk: Chunk<$T>,
                ) {
                    registers::run::<K, $L>(request, model, worker, chunk);
                }
                #[allow(unused_unsafe)] // the portable entries have no target features
                // SAFETY: `run_kernel` has checked that the processor has the instructions.
                unsafe { entry::<K>(request, model, worker, chunk) }
            }

            pub fn program(program: ProgramCall, request: &Request<$T>, worker: &mut Worker<$L>, chunk: Chunk<$T>) {
                $(#[target_feature(enable = $features)])?
                fn entry(program: ProgramCall, request: &Request<$T>, worker: &mut Worker<$L>, chunk: Chunk<$T>) {
                    programmed::run::<$L>(program, request, worker, chunk);
                }
                #[allow(unused_unsafe)] // as above
                // SAFETY: `run_program` has checked that the processor has the instructions.
                unsafe { entry(program, request, worker, chunk) }
            }

            pub const KERNELS: &[registers::Entry<$L>] =
                &[$(kernel::<<quantities::$Q as Quantity>::Registers>),*];
        }
    };
}

macro_rules! all_entries {
    ($($Q:ident)*) => {
        entries!(portable_f64, f64, Portable<f64, 1>, []; $($Q)*);
        entries!(portable_f32, f32, Portable<f32, 1>, []; $($Q)*);
        #[cfg(target_arch = "aarch64")]
        entries!(neon_f64, f64, F64x2, ["neon"]; $($Q)*);
        #[cfg(target_arch = "aarch64")]
        entries!(neon_f32, f32, F32x4, ["neon"]; $($Q)*);
        #[cfg(target_arch = "x86_64")]
        entries!(avx2_f64, f64, F64x4, ["avx2,fma"]; $($Q)*);
        #[cfg(target_arch = "x86_64")]
        entries!(avx2_f32, f32, F32x8, ["avx2,fma"]; $($Q)*);
        #[cfg(target_arch = "x86_64")]
        entries!(avx512_f64, f64, F64x8, ["avx512f,avx512dq,avx512vl,avx2,fma"]; $($Q)*);
        #[cfg(target_arch = "x86_64")]
        entries!(avx512_f32, f32, F32x16, ["avx512f,avx512dq,avx512vl,avx2,fma"]; $($Q)*);
    };
}
mozzi::quantities!(all_entries);

macro_rules! number {
    ($T:ty, $portable:ident, $neon:ident: $Neon:ty, $avx2:ident: $Avx2:ty, $avx512:ident: $Avx512:ty) => {
        impl Entries for $T {
            type Portable = Portable<$T, 1>;
            #[cfg(target_arch = "aarch64")]
            type Neon = $Neon;
            #[cfg(target_arch = "x86_64")]
            type Avx2 = $Avx2;
            #[cfg(target_arch = "x86_64")]
            type Avx512 = $Avx512;

            fn run_kernel(set: InstructionSet, index: usize, run: Run<$T>) -> Errors {
                assert!(set.is_available(), "{} is not of this machine", set.name()); // checked when a batch is made
                match set {
                    #[cfg(target_arch = "x86_64")]
                    InstructionSet::Avx512 => run.map($avx512::KERNELS[index]),
                    #[cfg(target_arch = "x86_64")]
                    InstructionSet::Avx2 => run.map($avx2::KERNELS[index]),
                    #[cfg(target_arch = "aarch64")]
                    InstructionSet::Neon => run.map($neon::KERNELS[index]),
                    _ => run.map($portable::KERNELS[index]),
                }
            }

            fn run_program(set: InstructionSet, program: ProgramCall, run: Run<$T>) -> Errors {
                assert!(set.is_available(), "{} is not of this machine", set.name());
                match set {
                    #[cfg(target_arch = "x86_64")]
                    InstructionSet::Avx512 => {
                        run.map(|request, _, worker, chunk| $avx512::program(program, request, worker, chunk))
                    }
                    #[cfg(target_arch = "x86_64")]
                    InstructionSet::Avx2 => {
                        run.map(|request, _, worker, chunk| $avx2::program(program, request, worker, chunk))
                    }
                    #[cfg(target_arch = "aarch64")]
                    InstructionSet::Neon => {
                        run.map(|request, _, worker, chunk| $neon::program(program, request, worker, chunk))
                    }
                    _ => run.map(|request, _, worker, chunk| $portable::program(program, request, worker, chunk)),
                }
            }
        }
    };
}
number!(f64, portable_f64, neon_f64: F64x2, avx2_f64: F64x4, avx512_f64: F64x8);
number!(f32, portable_f32, neon_f32: F32x4, avx2_f32: F32x8, avx512_f32: F32x16);
