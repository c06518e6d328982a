//! Rules for inlining.
//!
//! Kernels are generic over the number, and one number, [`Fused`](super::Fused), is only fast in code that is compiled
//! for fused multiply-add. So
//!
//! - **operators**, on twists, wrenches, inertias, are inlined into the passes that use them: otherwise they would be
//!   functions without that instruction. In builds without optimisation they are not: a pass would need more stack than
//!   a thread has.
//! - **passes** over the robot are functions of their own, one for each number, which all quantities share: [`pass!`].
//!   That of fused numbers is compiled for the instruction.
//! - the rest of a quantity's kernel is inlined into its entry (`fast.rs`).

/// Defines a pass over the robot: a function of its own per number type, compiled once and shared by all quantities;
/// for [`Fused`](super::Fused) numbers it is compiled for fused multiply-add.
macro_rules! pass {
    (
        $(#[$attribute:meta])*
        $visibility:vis fn $pass:ident<$(const $K:ident: $N:ty,)? S: Scalar + From<$C:ident>, $D:ident: Scalar>(
            $($argument:ident: $Type:ty),* $(,)?
        ) $(-> $R:ty)? $body:block
    ) => {
        $(#[$attribute])*
        #[cfg_attr(not(debug_assertions), inline(always))]
        #[allow(clippy::too_many_arguments)]
        $visibility fn $pass<$(const $K: $N,)? S: Scalar + From<$C>, $D: Scalar>($($argument: $Type),*) $(-> $R)? {
            #[cfg_attr(not(debug_assertions), inline(always))]
            #[allow(clippy::too_many_arguments)]
            fn here<$(const $K: $N,)? S: Scalar + From<$C>, $D: Scalar>($($argument: $Type),*) $(-> $R)? $body

            #[inline(never)]
            #[allow(clippy::too_many_arguments)]
            fn plain<$(const $K: $N,)? S: Scalar + From<$C>, $D: Scalar>($($argument: $Type),*) $(-> $R)? {
                here::<$($K,)? S, $D>($($argument),*)
            }

            #[cfg(all(feature = "std", target_arch = "x86_64"))]
            #[inline(never)]
            #[target_feature(enable = "fma")]
            #[allow(clippy::too_many_arguments)]
            fn fused<$(const $K: $N,)? S: Scalar + From<$C>, $D: Scalar>($($argument: $Type),*) $(-> $R)? {
                here::<$($K,)? S, $D>($($argument),*)
            }

            #[cfg(all(feature = "std", target_arch = "x86_64"))]
            if S::IS_FUSED {
                crate::scalar::assert_fma();
                // SAFETY: the processor has it.
                return unsafe { fused::<$($K,)? S, $D>($($argument),*) };
            }
            plain::<$($K,)? S, $D>($($argument),*)
        }
    };
}
pub(crate) use pass;

/// # Panics
/// If the processor has no fused multiply-add.
#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[inline(always)]
pub(crate) fn assert_fma() {
    assert!(std::is_x86_feature_detected!("fma"), "fused numbers without fused multiply-add");
}
