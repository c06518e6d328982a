//! The sparsity pattern of M and of its factors.

use alloc::collections::BTreeSet;
use alloc::vec;
use alloc::vec::Vec;

/// The elimination tree: row k of L is nonzero only in the columns of k's ancestors.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// `usize::MAX` for a root.
    pub(super) parent: Vec<usize>,
    /// One past the last descendant of k; k + 1 if it has none.
    pub(super) end: Vec<usize>,
}

impl Pattern {
    /// From the number of the base's own rows, which couple with all, and from each moving link's parent slot and row,
    /// base to tips. In a plain tree the ancestors are the tree's; a mimic joint couples its source joint's row with
    /// another path, and eliminating that row couples both paths.
    pub(crate) fn new(base: usize, n: usize, links: impl ExactSizeIterator<Item = (usize, usize)>) -> Self {
        Self::coupled(base, n, links, core::iter::empty::<[usize; 0]>())
    }

    /// As [`new`](Self::new), with groups of mutually coupled rows in addition.
    pub(crate) fn coupled<L: IntoIterator<Item = usize>>(
        base: usize,
        n: usize,
        links: impl ExactSizeIterator<Item = (usize, usize)>,
        together: impl Iterator<Item = L>,
    ) -> Self {
        let (links, together): (Vec<_>, Vec<L>) = (links.collect(), together.collect());
        let coupled = n < base + links.len() || !together.is_empty();
        let mut parent = vec![usize::MAX; n];
        for j in 1..base {
            parent[j] = j - 1;
        }
        if !coupled {
            for &(carrier, j) in &links {
                match carrier {
                    0 if base == 0 => {}
                    0 => parent[j] = base - 1,
                    _ => parent[j] = links[carrier - 1].1,
                }
            }
            return Pattern::of(parent);
        }
        let mut rows: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); n];
        for &(carrier, j) in &links {
            rows[j].extend(0..base);
            let mut slot = carrier;
            while slot > 0 {
                let (next, k) = links[slot - 1];
                if k != j {
                    rows[j.max(k)].insert(j.min(k));
                }
                slot = next;
            }
        }
        for list in together {
            let list: Vec<usize> = list.into_iter().collect();
            for (at, &j) in list.iter().enumerate() {
                list[..at].iter().for_each(|&k| _ = rows[j.max(k)].insert(j.min(k)));
            }
        }
        for k in (base..n).rev() {
            if let Some(last) = rows[k].pop_last() {
                parent[k] = last;
                let rest = core::mem::take(&mut rows[k]);
                rows[last].extend(rest);
            }
        }
        Pattern::of(parent)
    }

    /// From each row's parent, which precedes it.
    fn of(parent: Vec<usize>) -> Self {
        let mut end: Vec<usize> = (1..=parent.len()).collect();
        for (k, &i) in parent.iter().enumerate().rev().filter(|&(_, &i)| i != usize::MAX) {
            end[i] = end[i].max(end[k]);
        }
        Pattern { parent, end }
    }

    /// Whether k directly follows its parent.
    #[inline(always)]
    pub(super) fn is_next(&self, k: usize) -> bool {
        self.parent.get(k).is_some_and(|i| i.wrapping_add(1) == k && k > 0)
    }

    /// n.
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.parent.len()
    }

    /// k's ancestors, nearest (largest) first. They index a row of n numbers without further bounds checks.
    #[inline(always)]
    pub fn ancestors(&self, k: usize) -> impl Iterator<Item = usize> {
        let mut i = self.parent[k];
        core::iter::from_fn(move || {
            let &next = self.parent.get(i)?;
            Some(core::mem::replace(&mut i, next))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mimic_joint_couples_two_paths() {
        // slots 1 → 2 → 3 and 1 → 4; slot 4 mimics joint 2 (of slot 3): joints 0, 1, 2, 2
        let pattern = Pattern::new(0, 3, [(0, 0), (1, 1), (2, 2), (1, 2)].into_iter());
        assert_eq!(pattern.ancestors(2).collect::<Vec<_>>(), [1, 0]);
        // two arms that share their last joint: joints 0, 1 and 2, 1
        let pattern = Pattern::new(0, 3, [(0, 0), (1, 1), (0, 2), (3, 1)].into_iter());
        assert_eq!(pattern.parent, [usize::MAX, 0, 1], "joint 2 couples with 1, and 1 with 0");
        // two arms of two joints, the last of each turning one rotor
        let pattern = Pattern::coupled(0, 4, [(0, 0), (1, 1), (0, 2), (3, 3)].into_iter(), [[1, 3]].into_iter());
        assert_eq!(pattern.parent, [usize::MAX, 0, 1, 2]);
    }
}
