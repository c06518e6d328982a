//! Consecutive links, processed together when wrenches are transformed to the base: one product for all of them.

use super::{Link, Turned};
use crate::linalg::Vec3;
use crate::scalar::{Four, FourAtOnce, Scalar};
use crate::spatial::{Twist, Wrench};
use alloc::vec;
use alloc::vec::Vec;

/// Number of links, or columns, that are processed together: two registers of four numbers.
pub(crate) const TOGETHER: usize = 8;
const W: usize = TOGETHER;

/// W links, each the parent of the next, whose joints follow each other in θ̇.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    /// Slot of the first.
    pub first: usize,
    /// Slot of its parent.
    pub parent: usize,
    /// Its place in θ̇.
    pub j: usize,
}

/// The runs of a robot; no link is in two of them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Runs {
    pub list: Vec<Run>,
    /// For each slot, one more than the number of the run that ends there, 0 if none does.
    ending_at: Vec<usize>,
}

impl Runs {
    pub fn new<C>(links: &[Link<C>]) -> Self {
        let mut runs = Runs { list: Vec::new(), ending_at: vec![0; links.len() + 1] };
        let mut length = 0;
        for (k, link) in links.iter().enumerate() {
            let follows = k > 0 && link.parent == k && link.j == links[k - 1].j + 1;
            length = if follows { length + 1 } else { 1 };
            if length == W {
                let first = k + 2 - W;
                runs.list.push(Run { first, parent: links[first - 1].parent, j: links[first - 1].j });
                runs.ending_at[k + 1] = runs.list.len();
                length = 0;
            }
        }
        runs
    }

    /// The number of the run whose last link this is.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn ending_at(&self, slot: usize) -> Option<usize> {
        self.ending_at[slot].checked_sub(1)
    }
}

/// The axes of a run and their pairs in the base's axes, about the origin of its last link: each list has one number
/// per link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<S> {
    A: [[S; W]; 6],
    pub by_theta: [[S; W]; 9],
    pub by_rates: [[S; W]; 9],
    /// From the last link's origin to the first's.
    pub p: Vec3<S>,
}

impl<S: Scalar> Row<S> {
    pub fn zero() -> Self {
        let o = [S::zero(); W];
        Row { A: [o; 6], by_theta: [o; 9], by_rates: [o; 9], p: Vec3::zero() }
    }

    /// Fills the row from the links, with the pairs that are `taken`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn gather(&mut self, run: &Run, links: &[Turned<S>], taken: [bool; 2]) {
        let mut p = Vec3::zero();
        for w in (0..W).rev() {
            let link = &links[run.first + w];
            let about = |V: Twist<S>| Twist { w: V.w, v: p.cross_add(V.w, V.v) };
            set(&mut self.A, w, about(link.A), Vec3::zero());
            if taken[0] {
                set(&mut self.by_theta, w, about(link.by_theta.0), link.by_theta.1);
            }
            if taken[1] {
                set(&mut self.by_rates, w, about(link.by_rates.0), link.by_rates.1);
            }
            self.p = p;
            p += link.p;
        }
    }

    /// A_kᵀF of each link.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn forces(&self, at_once: Option<FourAtOnce>, F: Wrench<S>) -> [S; W] {
        match at_once {
            Some(at_once) => dots_of_four(at_once, &self.A, F.to_array()),
            None => dots(&self.A, F.to_array()),
        }
    }

    /// rᵀ(𝒢ᶜA) + sᵀ(𝓑ᶜᵀA) of each link.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn products(pairs: &[[S; W]; 9], GA: Wrench<S>, BtA: Vec3<S>) -> [S; W] {
        let ([a, b, c], [x, y, z], [u, v, w]) = (GA.m.0, GA.f.0, BtA.0);
        dots(pairs, [a, b, c, x, y, z, u, v, w])
    }
}

/// Sets number w of each list: those of r, then those of s.
#[cfg_attr(not(debug_assertions), inline(always))]
fn set<const K: usize, S: Scalar>(lists: &mut [[S; W]; K], w: usize, r: Twist<S>, s: Vec3<S>) {
    let ([a, b, c], [x, y, z], [u, v, t]) = (r.w.0, r.v.0, s.0);
    for (list, number) in lists.iter_mut().zip([a, b, c, x, y, z, u, v, t]) {
        list[w] = number;
    }
}

/// Σ_k x_k list_k.
#[cfg_attr(not(debug_assertions), inline(always))]
fn dots<const K: usize, S: Scalar>(lists: &[[S; W]; K], x: [S; K]) -> [S; W] {
    let mut sum = [S::zero(); W];
    for k in 0..K {
        for w in 0..W {
            sum[w] = lists[k][w].mul_add(x[k], sum[w]);
        }
    }
    sum
}

/// The same in registers of four, which the compiler does not choose if the numbers go to different places.
#[cfg_attr(not(debug_assertions), inline(always))]
fn dots_of_four<const K: usize, S: Scalar>(at_once: FourAtOnce, lists: &[[S; W]; K], x: [S; K]) -> [S; W] {
    let mut sums = [S::Four::new(at_once, [S::zero(); 4]); 2];
    for k in 0..K {
        let [a, b, c, d, e, f, g, h] = lists[k];
        sums[0] = S::Four::new(at_once, [a, b, c, d]).mul_add(x[k], sums[0]);
        sums[1] = S::Four::new(at_once, [e, f, g, h]).mul_add(x[k], sums[1]);
    }
    let ([a, b, c, d], [e, f, g, h]) = (sums[0].numbers(), sums[1].numbers());
    [a, b, c, d, e, f, g, h]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{chain, floating_tree, tree};

    #[test]
    fn runs_are_of_links_that_follow_each_other() {
        let runs = |model: &crate::Model| model.structure.runs.list.clone();
        let model = chain(&floating_tree(5, 20, 0));
        let [first, second] = runs(&model)[..] else { panic!("two runs of eight, and four links") };
        assert_eq!((first, second), (Run { first: 1, parent: 0, j: 6 }, Run { first: 9, parent: 8, j: 14 }));
        assert_eq!((model.structure.runs.ending_at(16), model.structure.runs.ending_at(17)), (Some(1), None));
        assert!(runs(&tree(5, 20, 0)).is_empty(), "a shallow robot has none");
        // a mimic joint has its source's index: no run extends across it
        let follows = chain(&tree(70, 20, 4));
        for run in runs(&follows) {
            assert!((0..W).all(|w| follows.links[run.first - 1 + w].j == run.j + w));
        }
    }

    #[test]
    fn a_run_answers_as_its_links_do() {
        let turned = |k: u64| {
            let (A, by) = (crate::testing::twist(k), (crate::testing::twist(k + 50), Vec3([0.1, 0.2, k as f64])));
            Turned { p: Vec3([0.1 * k as f64, -0.2, 0.3]), A, by_theta: by, by_rates: by, ..Turned::zero() }
        };
        let links: Vec<Turned<f64>> = (0..10).map(turned).collect();
        let (run, mut row) = (Run { first: 1, parent: 0, j: 0 }, Row::zero());
        row.gather(&run, &links, [true, true]);
        let (mut F, mut P, m) = (crate::testing::wrench(1), crate::testing::wrench(2), Vec3([0.3, -0.1, 0.7]));
        let (forces, products) = (row.forces(None, F), Row::products(&row.by_theta, P, m));
        let (at_first, about) = (F.about(row.p), |F: Wrench, k: usize| F.about(links[k].p));
        for w in (0..W).rev() {
            let (r, s) = links[1 + w].by_theta;
            assert!((forces[w] - links[1 + w].A.dot(F)).abs() < 1e-13);
            assert!((products[w] - r.dot(P) - s.dot(m)).abs() < 1e-13);
            if w > 0 {
                (F, P) = (about(F, 1 + w), about(P, 1 + w));
            }
        }
        assert!((at_first - F).norm() < 1e-13);
    }
}
