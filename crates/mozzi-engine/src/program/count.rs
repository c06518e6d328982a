//! Operation counts of programs.

use std::fmt;

/// Operations by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Sums and differences.
    pub add: usize,
    /// Products.
    pub mul: usize,
    /// Fused multiply-adds.
    pub fma: usize,
    /// Divisions.
    pub div: usize,
    /// Square roots.
    pub sqrt: usize,
    /// Sine and cosine pairs.
    pub sin_cos: usize,
    /// Changes of sign, sgn, tanh.
    pub other: usize,
}

impl Count {
    /// Floating-point operations without sines and cosines; a fused multiply-add counts as two.
    pub fn flops(&self) -> usize {
        self.instructions() + self.fma
    }

    /// As [`flops`](Self::flops), with a fused multiply-add counted as one.
    pub fn instructions(&self) -> usize {
        self.add + self.mul + self.fma + self.div + self.sqrt + self.other
    }
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Count { add, mul, fma, div, sqrt, sin_cos, other } = self;
        write!(f, "{} flops: {add} add, {mul} mul, {fma} fma, {div} div", self.flops())?;
        for (count, what) in [(sqrt, "sqrt"), (other, "of other kinds"), (sin_cos, "sin and cos beside")] {
            if *count > 0 {
                write!(f, ", {count} {what}")?;
            }
        }
        Ok(())
    }
}
