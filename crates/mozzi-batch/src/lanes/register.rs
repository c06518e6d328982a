//! What registers of every instruction set share: a type of one, made of its instructions.
//!
//! Its values are made and used only inside the entries of `number.rs`, which run only if the processor has the
//! instructions: every unsafe block here relies on that. Each method is inlined into an entry, where it becomes one or
//! two instructions. Negation is −0 − x, which the compiler merges into a fused multiply-add. Some instructions are
//! safe to call where every processor has them, hence `unused_unsafe`.

/// A register. Instructions are named in the order of their use.
macro_rules! register {
    (
        $(#[$doc:meta])* $L:ident($register:ty) of $width:literal $number:ty;
        $add:ident $sub:ident $mul:ident $div:ident $fma:ident $sqrt:ident $min:ident $max:ident $set:ident $load:ident $store:ident;
        $xor:ident $and:ident $to_bits:ident $from_bits:ident $and_bits:ident $sub_bits:ident $shift:ident::<$places:literal> $set_bits:ident;
        sign |$x:ident, $zero:ident, $one:ident, $minus_one:ident| $sign:expr;
        zip |$a:ident, $b:ident| $zip:expr;
        within |$y:ident, $low:ident, $high:ident| $within:expr;
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        #[repr(transparent)]
        pub struct $L($register);

        // SAFETY (all blocks of this macro): see the module's documentation.
        #[allow(clippy::undocumented_unsafe_blocks, unused_unsafe)]
        impl $L {
            #[inline(always)]
            fn add(self, other: Self) -> Self { $L(unsafe { $add(self.0, other.0) }) }
            #[inline(always)]
            fn sub(self, other: Self) -> Self { $L(unsafe { $sub(self.0, other.0) }) }
            #[inline(always)]
            fn mul(self, other: Self) -> Self { $L(unsafe { $mul(self.0, other.0) }) }
            #[inline(always)]
            fn div(self, other: Self) -> Self { $L(unsafe { $div(self.0, other.0) }) }
            #[inline(always)]
            fn negative(self) -> Self { Self::from(-0.0) - self }
            #[inline(always)]
            fn square_root(self) -> Self { $L(unsafe { $sqrt(self.0) }) }
            #[inline(always)]
            fn sign(self) -> Self {
                $L(unsafe {
                    let ($x, $zero, $one, $minus_one) = (self.0, $set(0.0), $set(1.0), $set(-1.0));
                    $sign
                })
            }
            #[inline(always)]
            fn times_plus(self, a: Self, b: Self) -> Self { $L(unsafe { $fma(self.0, a.0, b.0) }) }
        }
        super::lane!([] $L);

        impl From<$number> for $L {
            #[inline(always)]
            #[allow(clippy::undocumented_unsafe_blocks, unused_unsafe)]
            fn from(x: $number) -> Self { $L(unsafe { $set(x) }) }
        }

        #[allow(clippy::undocumented_unsafe_blocks, unused_unsafe)]
        impl mozzi::scalar::Bits for $L {
            type Number = $number;
            #[inline(always)]
            fn constant(x: $number) -> Self { x.into() }
            #[inline(always)]
            fn xor(self, other: Self) -> Self { $L(unsafe { $xor(self.0, other.0) }) }
            #[inline(always)]
            fn and(self, other: Self) -> Self { $L(unsafe { $and(self.0, other.0) }) }
            #[inline(always)]
            fn lowest_everywhere(self) -> Self {
                $L(unsafe { $from_bits($sub_bits($set_bits(0), $and_bits($to_bits(self.0), $set_bits(1)))) })
            }
            #[inline(always)]
            fn second_lowest_as_sign(self) -> Self {
                $L(unsafe { $from_bits($shift::<$places>($and_bits($to_bits(self.0), $set_bits(2)))) })
            }
        }

        #[allow(clippy::undocumented_unsafe_blocks, unused_unsafe)]
        impl super::Lane for $L {
            const WIDTH: usize = $width;
            #[inline(always)]
            fn load(from: &[$number]) -> Self {
                let from = &from[..$width]; // exactly the numbers that are read
                $L(unsafe { $load(from.as_ptr()) })
            }
            #[inline(always)]
            fn store(self, to: &mut [$number]) {
                let to = &mut to[..$width]; // exactly the numbers that are written
                unsafe { $store(to.as_mut_ptr(), self.0) }
            }
            #[inline(always)]
            fn numbers(registers: &[Self]) -> &[$number] {
                // a register holds its numbers in order, is at least as aligned as they are, and every bit pattern is a
                // valid number
                unsafe { core::slice::from_raw_parts(registers.as_ptr().cast(), registers.len() * $width) }
            }
            #[inline(always)]
            fn numbers_mut(registers: &mut [Self]) -> &mut [$number] {
                // likewise; the borrow is exclusive
                unsafe { core::slice::from_raw_parts_mut(registers.as_mut_ptr().cast(), registers.len() * $width) }
            }
            #[inline(always)]
            fn zip(self, other: Self) -> (Self, Self) {
                let (low, high) = unsafe {
                    let ($a, $b) = (self.0, other.0);
                    $zip
                };
                ($L(low), $L(high))
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self { $L(unsafe { $min(self.0, other.0) }) }
            #[inline(always)]
            fn max(self, other: Self) -> Self { $L(unsafe { $max(self.0, other.0) }) }
            #[inline(always)]
            fn within(self, bound: $number) -> bool {
                unsafe {
                    let ($y, $low, $high) = (self.0, $set(-bound), $set(bound));
                    $within
                }
            }
        }
    };
}
pub(crate) use register;
