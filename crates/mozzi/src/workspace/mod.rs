//! Memory for the kernels.

mod articulated;
mod axis_pairs;
mod composite;
mod constraints;
mod long_limbs;
mod recursion;

pub(crate) use articulated::Articulated;
pub(crate) use axis_pairs::{ByRates, ByTheta};
pub(crate) use composite::Composite;
pub use constraints::ConstraintMemory;
pub(crate) use constraints::MOST_ROWS;
pub(crate) use long_limbs::{Columns, LongLimbs, Passed, Source, Turned, W};
pub(crate) use recursion::Recursion;

use crate::model::Model;
use crate::scalar::Scalar;
use alloc::vec;
use alloc::vec::Vec;

/// Scratch memory for the kernels; nothing in it survives a call. Slot 0 is the base, slot i moving link i.
#[derive(Clone, Debug)]
pub struct Workspace<S = f64> {
    /// The slots between a frame and the base.
    pub(crate) path: Vec<usize>,
    pub(crate) recursion: Recursion<S>,
    pub(crate) composite: Composite<S>,
    pub(crate) articulated: Articulated<S>,
    /// Scratch for ∂θ̈ of long limbs; `None` for other robots.
    pub(crate) long_limbs: Option<LongLimbs<S>>,
    /// The pivots of the last solve, for the caller that can compare numbers.
    pub(crate) pivots: Vec<S>,
    /// n zeros or a right-hand side.
    pub(crate) vector: Vec<S>,
    /// n × n for robots with mimic joints; else empty, and filled on demand by the caller.
    pub(crate) matrix: Vec<S>,
}

impl<S: Scalar> Workspace<S> {
    /// Memory for this model: O(n), and n × n more for robots with mimic joints.
    pub fn new<C: Scalar>(model: &Model<C>) -> Self {
        let (n, o) = (model.n(), S::zero());
        Workspace {
            path: Vec::with_capacity(model.links.len() + 1),
            recursion: Recursion::new(model),
            composite: Composite::new(model),
            articulated: Articulated::new(model),
            long_limbs: model.structure.has_long_limbs.then(|| LongLimbs::new(model)),
            pivots: vec![o; n],
            vector: vec![o; n],
            matrix: if model.solves_by_mass_matrix() { vec![o; n * n] } else { Vec::new() },
        }
    }

    /// The pivots of the last forward dynamics or its derivatives, one per velocity. [`Pivots`](crate::Pivots) judges
    /// them: a kernel cannot compare numbers, the methods of [`Model`] can.
    pub fn pivots(&self) -> &[S] {
        &self.pivots
    }

    /// Sets every number to NaN, to test that results do not depend on old contents.
    pub fn fill_nan(&mut self) {
        let nan = S::from_f64(f64::NAN);
        let Workspace { path, recursion, composite, articulated, long_limbs, pivots, vector, matrix } = self;
        path.clear();
        recursion.fill(nan);
        composite.fill(nan);
        articulated.fill(nan);
        if let Some(limbs) = long_limbs {
            limbs.fill(nan);
        }
        for list in [pivots, vector, matrix] {
            list.fill(nan);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{chain, floating_mixed_tree};
    use alloc::format;

    /// A workspace prints all its numbers.
    #[test]
    fn nan_fills_every_number() {
        for model in [floating_mixed_tree(5, 12, 0), chain(&floating_mixed_tree(5, 30, 0))] {
            let mut workspace = Workspace::<f64>::new(&model);
            assert_eq!(workspace.long_limbs.is_some(), model.structure.has_long_limbs);
            workspace.fill_nan();
            let text = format!("{workspace:?}");
            let number = text.find(".0"); // 0.0, 1.0
            assert!(
                text.contains("NaN") && number.is_none(),
                "{}",
                &text[number.unwrap_or(0).saturating_sub(200)..][..210]
            );
        }
    }
}
