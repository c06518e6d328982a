//! A sample of docs/campaign.md: some seeds, and those of past findings, with every quantity in every way.
#![allow(missing_docs)]

use mozzi::quantities::LIST;
use mozzi_testing::campaign::{Counts, LIMIT, Way, emitted, generate, one, replay};
use rayon::prelude::*;

/// Robots of past findings. 2384: a chain that moves fast as a whole and little at its end, where {s} has larger terms.
/// 7458: constraints of very different sizes. 15869, 19177: a task row that only rounding moves.
const FOUND: [u64; 4] = [2384, 7458, 15869, 19177];

#[test]
fn no_robot_differs() {
    let is_small = |seed: &u64| generate::case(*seed).robot.build().is_ok_and(|model| model.n() <= 7);
    let seeds: Vec<u64> = (1..).filter(is_small).take(30).chain(FOUND).collect();
    let all: Vec<Counts> = seeds
        .into_par_iter()
        .map(|seed| {
            let mut counts = Counts::default();
            let findings = replay(seed, &mut counts);
            assert!(findings.is_empty(), "{}", findings[0]);
            counts
        })
        .collect();
    for declaration in LIST {
        for way in [Way::Second, Way::Memory, Way::Program] {
            let sum = |counts: &Counts| counts.sum(|name, other| name == declaration.name && way == other).comparisons;
            let comparisons: u64 = all.iter().map(sum).sum();
            assert!(comparisons >= 3, "{}, {}: {comparisons} comparisons", declaration.name, way.name());
        }
    }
    let worst = all.iter().map(|counts| counts.sum(|_, _| true).worst).fold(0.0, f64::max);
    assert!(worst > 0.0 && worst <= LIMIT, "{worst} units");
}

#[test]
fn consecutive_seeds_cover_the_list_evenly() {
    let mut counts = Counts::default();
    let first = 1_000_000;
    for seed in first..first + LIST.len() as u64 {
        assert_eq!(one(seed, &mut counts), []);
    }
    let seconds = counts.sum(|_, way| way == Way::Second).comparisons;
    let skipped: u64 = counts.skipped.values().sum();
    assert!(seconds > 100 && skipped > 0, "{seconds} second ways, {skipped} skipped");
}

#[test]
fn emitted_c_agrees() {
    if !emitted::has_compiler() {
        eprintln!("emitted C is skipped: there is no compiler");
        return;
    }
    let (folder, mut counts) =
        (std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("campaign"), Counts::default());
    for seed in [emitted::ONE_IN, 3 * emitted::ONE_IN] {
        assert_eq!(emitted::one(seed, &folder, &mut counts), Ok(Vec::new()));
    }
    assert!(counts.sum(|_, way| way == Way::C).comparisons > 10);
}
