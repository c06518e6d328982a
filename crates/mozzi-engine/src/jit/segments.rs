//! Segments of long code. Code that exceeds the first-level instruction cache would be fetched anew for every register
//! of states. It is therefore cut into segments that fit; each runs on a group of registers before the next, and is
//! fetched once per group. Between segments all values are in the frame, of which each register of the group has its
//! own.
//!
//! By AVX2 long programs take 0.82 to 0.97 of the time, on a Zen 5 by AVX-512 0.86 to 0.92; on a Zen 4, whose 512-bit
//! instructions take two turns, 0.95 to 1.06 (docs/performance-log.md).

use super::shape::{Encoding, Shape};

/// The longest code in one piece, in bytes, and the longest segment.
const WHOLE: usize = 32 << 10;
const LONGEST: usize = 26 << 10;

/// About a node's bytes of code.
const NODE: usize = 8;

/// Bytes of a slot of the frames of a group.
const SLOT: usize = 512;

/// True if long code of this shape is to be cut: several states, where fetching takes longer than the arithmetic.
pub(crate) fn pay(shape: Shape) -> bool {
    !shape.is_scalar() && (shape.encoding() != Encoding::Evex || has_full_width())
}

/// The bytes after which a segment of code of so many nodes ends: segments are equally long.
pub(crate) fn longest(nodes: usize) -> usize {
    let bytes = NODE * nodes;
    if bytes <= WHOLE { usize::MAX } else { bytes.div_ceil(bytes.div_ceil(LONGEST)) }
}

/// The runs of a segment before the next.
pub(crate) fn group(shape: Shape) -> usize {
    SLOT / shape.width()
}

/// True if the processor reports 512-bit data paths. AMD processors do, in bit 3 of CPUID function 8000001Ah.
#[cfg(target_arch = "x86_64")]
fn has_full_width() -> bool {
    use std::arch::x86_64::__cpuid;
    __cpuid(0x8000_0000).eax >= 0x8000_001a && __cpuid(0x8000_001a).eax & 8 != 0
}

#[cfg(not(target_arch = "x86_64"))]
fn has_full_width() -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::super::{Form, Kernel};
    use super::*;
    use crate::{Arguments, record_quantity};
    use mozzi::quantities::ForwardDynamicsDerivatives;

    #[test]
    fn equal_parts() {
        assert_eq!(longest(WHOLE / NODE), usize::MAX);
        assert_eq!(longest(5000), 20_000);
        assert_eq!(longest(LONGEST / NODE * 3), LONGEST);
        assert_eq!(Shape::ALL.map(group), [64, 16, 128, 16, 8, 8, 64, 64, 32, 128, 32]);
    }

    /// Whole and cut, every number has the same bits, in groups that are full or not.
    #[test]
    fn cut_code_computes_the_same() {
        let model = mozzi_urdf::open("panda").unwrap().build().unwrap();
        let program = record_quantity(&model, ForwardDynamicsDerivatives, Arguments::default()).unwrap();
        let shapes =
            Shape::ALL.into_iter().filter(|shape| !shape.is_scalar() && shape.is_f64() && shape.is_supported());
        for (shape, form) in shapes.flat_map(|shape| [(shape, Form::Blocks), (shape, Form::Rows)]) {
            let of = |cuts| Kernel::cut_if(cuts, &program, shape, form, usize::MAX).unwrap();
            let (whole, cut) = (of(false), of(true));
            assert!(cut.code_bytes() > whole.code_bytes(), "{shape:?}: there is a cut");
            let (inputs, outputs) = whole.extents().split_at(program.inputs().len());
            for runs in [1, 7, 8, 9, 16, 29] {
                let number = |k: usize| 0.1 + 0.37 * (k * k % 101) as f64 / 101.0;
                let given: Vec<Vec<f64>> =
                    inputs.iter().map(|extent| (0..extent.of(runs)).map(number).collect()).collect();
                let given: Vec<&[f64]> = given.iter().map(Vec::as_slice).collect();
                let found = [&whole, &cut].map(|kernel| {
                    let mut found: Vec<Vec<f64>> = outputs.iter().map(|extent| vec![0.0; extent.of(runs)]).collect();
                    let mut slices: Vec<&mut [f64]> = found.iter_mut().map(Vec::as_mut_slice).collect();
                    let (squares, rest) = slices.split_last_mut().unwrap();
                    kernel.run(runs, &given, rest, squares);
                    found.concat().iter().map(|x| x.to_bits()).collect::<Vec<_>>()
                });
                assert!(found[0] == found[1], "{shape:?}, {form:?}, {runs} runs");
                assert!(found[0].iter().any(|&bits| bits != 0));
            }
        }
    }
}
