//! The tables, as Markdown.

use crate::Contender;
use crate::kernel::KERNELS;
use crate::machine;
use crate::peer::Peer;
use mozzi_benches::States;
use std::fmt::Write;

/// One robot's.
pub struct Table {
    robot: String,
    rounds: usize,
    rows: Vec<String>,
}

/// The least and the middle of some times.
fn least_and_median(times: &[f64]) -> (f64, f64) {
    let mut sorted = times.to_vec();
    sorted.sort_by(f64::total_cmp);
    (sorted[0], sorted[sorted.len() / 2])
}

impl Table {
    /// From the times of all contenders, and the largest difference of each kernel.
    pub fn new(robot: &str, contenders: &[Contender], differences: &[f64]) -> Self {
        let mut rows = Vec::new();
        for (kernel, difference) in KERNELS.iter().zip(differences) {
            let of_kernel = || contenders.iter().filter(|contender| contender.kernel.name == kernel.name);
            let mut row = format!("| {} |", kernel.name);
            let mut ours = Vec::new();
            for contender in of_kernel().filter(|contender| !contender.is_peer) {
                let (least, median) = least_and_median(&contender.times);
                ours.push((least, median));
                let _ = write!(row, " {least:.0} / {median:.0} |");
            }
            let theirs = of_kernel().filter(|contender| contender.is_peer);
            let theirs = theirs.map(|contender| (contender.path, least_and_median(&contender.times)));
            match theirs.min_by(|a, b| a.1.0.total_cmp(&b.1.0)) {
                None => row += " – | – | – |",
                Some((path, (least, median))) => {
                    let (a, b) = (least / ours[0].0, median / ours[0].1);
                    let _ =
                        write!(row, " {least:.0} / {median:.0} ({path}) | **{a:.2}** / {b:.2} | {difference:.0e} |");
                }
            }
            rows.push(row);
        }
        Table { robot: robot.into(), rounds: contenders[0].times.len(), rows }
    }
}

/// Everything, with where and how it was measured.
pub fn text(tables: &[Table], peer: Option<&Peer>) -> String {
    let (processor, date, rustc) = (machine::processor(), machine::date(), machine::rustc());
    let (version, flags) = peer.map_or(("no peer".into(), String::new()), |peer| (peer.version(), peer.flags()));
    let mut text = format!(
        "\
# One state on one core, beside Pinocchio

`cargo xtask bench`, {date}, {processor}.

- mozzi: {rustc}, release profile, no flags: `mozzi::native` finds AVX2 and FMA when it runs; portable is the same source
  without them.
- {version}, `{flags}`; of `Convention::WORLD` and `LOCAL` the faster. Its mass matrix is the upper triangle alone.
- Both get the robot by numbers, armature and friction zero, and the same {} random states. One process on one
  processor; in each round everything runs over all states, in turn, once untimed and once timed.
- Nanoseconds for one evaluation: least of all rounds / median. Ratio: Pinocchio's time over mozzi's with FMA, of the
  least / of the medians. Difference: the largest between the two results at any state, over the result's largest
  entry, checked before anything is timed.
",
        States::COUNT
    );
    for Table { robot, rounds, rows } in tables {
        let _ = write!(
            text,
            "\n## {robot}, {rounds} rounds\n\n| ns | mozzi | portable | Pinocchio | ratio | difference |\n|---|---|---|---|---|---|\n{}\n",
            rows.join("\n")
        );
    }
    text
}
