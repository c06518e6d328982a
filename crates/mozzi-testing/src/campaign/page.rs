//! The page docs/campaign.md: a row is added for each campaign.

use crate::campaign::emitted::ONE_IN;
use crate::campaign::log::{Count, Counts, Way};
use crate::campaign::progress::Progress;
use crate::campaign::{CODED, LIMIT, LONG, SECONDS, condition};
use mozzi::quantities::LIST;
use std::fmt::Write;

const HEADER: &str = "| date | commit | first seed | robots | comparisons | numbers | findings | minutes |";

/// The page with a row for this campaign after those of the page as it was. A continued campaign replaces its row.
pub fn write(before: &str, progress: &Progress, date: &str, commit: &str) -> String {
    let earlier = before.lines().skip_while(|line| *line != HEADER).skip(2).take_while(|line| line.starts_with('|'));
    let Progress { first, robots, counts, findings, seconds } = progress;
    let earlier = earlier.filter(|line| !line.contains(&format!("| {commit} | {first} |")));
    let all = counts.sum(|_, _| true);
    let mut page = introduction();
    let _ = writeln!(page, "## Campaigns\n\n{HEADER}\n|---|---|---|---|---|---|---|---|");
    for line in earlier {
        let _ = writeln!(page, "{line}");
    }
    let (comparisons, numbers, minutes) = (grouped(all.comparisons), grouped(all.numbers), seconds / 60.0);
    let (robots, findings) = (grouped(*robots), findings.len());
    let _ = writeln!(
        page,
        "| {date} | {commit} | {first} | {robots} | {comparisons} | {numbers} | {findings} | {minutes:.0} |"
    );
    found(&mut page, progress);
    ways(&mut page, counts);
    quantities(&mut page, counts);
    skipped(&mut page, counts);
    page
}

fn introduction() -> String {
    format!(
        "# Differential campaign\n\n\
Written by `cargo xtask campaign`. Each robot is a function of one seed: 0 to 12 joints of all types on a fixed or \
floating base, mimic joints, springs, rotors, dry friction, damping, massless links, constraints of all kinds, in some \
masses over eight decades; one state, half of the robots with a moving base, another gravity and wrenches. Every \
quantity is computed in two ways and compared.\n\n\
For each robot: all quantities by the kernel in memory full of NaN (equal to the bit), with fused multiply-add, and on \
`f32` (not those that divide); {SECONDS} quantities by their second way, {CODED} as recorded program and as machine \
code, in turn, so that each quantity is covered evenly. Second ways that differentiate the stacked equations along each \
joint are left out in all but one round of {} for robots of more than 6 velocities, of {} for more than 12. One robot of {ONE_IN} is emitted as C and compiled.\n\n\
A difference is measured in units: the largest change of the output when all constants, the state and the environment \
change by one rounding error, ε = 2⁻⁵² (`f32`: 2⁻²³). For quantities that divide, ε κ times the largest entry is added, \
where κ is Skeel's condition of the mass matrix, times that of A M⁻¹Aᵀ or J M⁻¹Jᵀ for constraints and tasks. A \
difference above {LIMIT:.0} units is a finding; so is a panic or NaN. A quantity with κ above {:.0e} is skipped as \
ill-conditioned. Constrained quantities are skipped if ‖G⁻¹‖ times the mean diagonal entry of G = A M⁻¹Aᵀ is above \
{:.0e}: rows of very different sizes (the polynomial of a joint at a large angle) or almost redundant ones.\n\n",
        LONG[0],
        LONG[1],
        condition::LARGEST,
        condition::LARGEST_SPREAD
    )
}

fn found(page: &mut String, progress: &Progress) {
    page.push_str("\n## Findings of the last campaign\n\n");
    for finding in &progress.findings {
        let _ = writeln!(page, "- {}", finding["finding"].as_str().unwrap_or_default());
    }
    if progress.findings.is_empty() {
        page.push_str("None.\n");
    }
}

fn ways(page: &mut String, counts: &Counts) {
    page.push_str("\n## The last campaign by way\n\nLargest differences are in units, without the findings.\n\n| way | comparisons | numbers | largest difference |\n");
    page.push_str("|---|---|---|---|\n");
    for way in Way::ALL {
        let Count { comparisons, numbers, worst } = counts.sum(|_, other| other == way);
        let (comparisons, numbers) = (grouped(comparisons), grouped(numbers));
        let _ = writeln!(page, "| {} | {comparisons} | {numbers} | {} |", way.name(), digits(worst));
    }
}

fn quantities(page: &mut String, counts: &Counts) {
    page.push_str("\n## By quantity\n\n| quantity | comparisons | by the second way | its largest difference | program, machine code, C | largest |\n");
    page.push_str("|---|---|---|---|---|---|\n");
    for declaration in LIST {
        let of = |ways: &[Way]| counts.sum(|name, way| name == declaration.name && ways.contains(&way));
        let (all, second) = (of(&Way::ALL), of(&[Way::Second]));
        let code = of(&[Way::Program, Way::Code, Way::Arrays, Way::SingleArrays, Way::C]);
        let _ = writeln!(
            page,
            "| `{}` | {} | {} | {} | {} | {} |",
            declaration.name,
            grouped(all.comparisons),
            grouped(second.comparisons),
            digits(second.worst),
            grouped(code.comparisons),
            digits(code.worst)
        );
    }
}

fn skipped(page: &mut String, counts: &Counts) {
    page.push_str(
        "\n## Skipped\n\nA quantity of a robot, or a robot, with the reason.\n\n| reason | times |\n|---|---|\n",
    );
    for (why, count) in &counts.skipped {
        let _ = writeln!(page, "| {why} | {} |", grouped(*count));
    }
}

fn digits(x: f64) -> String {
    if x < 10.0 { format!("{x:.1}") } else { format!("{x:.0}") }
}

/// 12,345,678.
fn grouped(x: u64) -> String {
    let digits = x.to_string();
    let first = digits.len() % 3;
    let (head, rest) = digits.split_at(first);
    let groups = rest.as_bytes().chunks(3).map(|group| String::from_utf8_lossy(group).into_owned());
    let groups: Vec<String> = (!head.is_empty()).then(|| head.to_string()).into_iter().chain(groups).collect();
    groups.join(",")
}

#[cfg(test)]
mod tests {
    use super::{grouped, write};
    use crate::campaign::progress::Progress;

    #[test]
    fn a_second_campaign_adds_a_row() {
        let progress = Progress { robots: 12_345, ..Progress::from_seed(3) };
        let once = write("", &progress, "2026-01-01", "abc");
        let twice = write(&once, &progress, "2026-01-02", "def");
        assert!(once.contains("| 2026-01-01 | abc | 3 | 12,345 | 0 | 0 | 0 | 0 |\n"));
        assert!(twice.contains("| 2026-01-01 | abc |") && twice.contains("| 2026-01-02 | def |"));
        assert_eq!(twice.lines().count(), once.lines().count() + 1);
        assert_eq!(write(&twice, &progress, "2026-01-02", "def"), twice, "continued");
    }

    #[test]
    fn thousands_are_separated() {
        assert_eq!([7, 123, 1234, 1_234_567].map(grouped), ["7", "123", "1,234", "1,234,567"]);
    }
}
