//! The lines in which two texts differ, with a line of context before and after.

use std::collections::BTreeMap;
use std::fmt::Write;

/// Longer lines are cut around the change.
const WIDTH: usize = 160;
/// Columns that are kept before and after the change in a longer line.
const AROUND: usize = 60;
/// More lines of one change are cut.
const LINES: usize = 20;

/// A change: the lines of the first text, and those of the second that replace them.
type Change = (std::ops::Range<usize>, std::ops::Range<usize>);

/// The changed parts of both texts, each as an excerpt of Markdown or a terminal. The line of the first text that a
/// diagnostic names, counted from 1, is part of both.
pub fn of(bad: &str, good: &str, named: usize) -> [String; 2] {
    let (bad, good): (Vec<&str>, Vec<&str>) = (bad.lines().collect(), good.lines().collect());
    let mut changes = changes(&bad, &good);
    let line = named - 1;
    if !changes.iter().any(|(own, _)| (own.start..own.end.max(own.start + 1)).contains(&line)) && line < bad.len() {
        let after = changes.iter().take_while(|(own, _)| own.end <= line).count();
        let same = after.checked_sub(1).map_or(line, |last| changes[last].1.end + line - changes[last].0.end);
        changes.insert(after, (line..line + 1, same..same + 1));
    }
    [side(&bad, &good, &changes, false), side(&good, &bad, &changes, true)]
}

/// The changes, in order: what is left between the longest common start and end, split at common lines.
fn changes(bad: &[&str], good: &[&str]) -> Vec<Change> {
    let start = bad.iter().zip(good).take_while(|(a, b)| a == b).count();
    let left = bad.len().min(good.len()) - start;
    let end = bad.iter().rev().zip(good.iter().rev()).take(left).take_while(|(a, b)| a == b).count();
    let (mut found, mut b, mut g) = (Vec::new(), start, start);
    let (last_b, last_g) = (bad.len() - end, good.len() - end);
    while b < last_b || g < last_g {
        // the difference ends at the nearest pair of places where the next two lines, or all remaining ones, are equal
        let same = |i: usize, j: usize| i < last_b && j < last_g && bad[i] == good[j];
        let again = |i: usize, j: usize| same(i, j) && (same(i + 1, j + 1) || i + 1 == last_b && j + 1 == last_g);
        let near = (0..64).flat_map(|sum| (0..=sum).map(move |i| (b + i, g + sum - i)));
        let (to_b, to_g) = near.into_iter().find(|&(i, j)| again(i, j)).unwrap_or((last_b, last_g));
        found.push((b..to_b, g..to_g));
        (b, g) = (to_b, to_g);
        while same(b, g) {
            (b, g) = (b + 1, g + 1);
        }
    }
    found
}

/// The excerpt of one of the texts.
fn side(text: &[&str], other: &[&str], changes: &[Change], is_good: bool) -> String {
    // the lines to show, each with the line of the other text in its place
    let mut shown: BTreeMap<usize, Option<usize>> = BTreeMap::new();
    for (bad, good) in changes {
        let (own, theirs) = if is_good { (good, bad) } else { (bad, good) };
        let context = own.start.saturating_sub(1)..(own.end + 1).min(text.len());
        context.for_each(|k| _ = shown.entry(k).or_insert(None));
        shown.extend(own.clone().map(|k| (k, Some(theirs.start + k - own.start).filter(|k| theirs.contains(k)))));
    }
    let (mut lines, mut last) = (Vec::new(), None);
    let mut run = 0;
    for (k, theirs) in shown {
        run = if last.is_some_and(|last| last + 1 == k) { run + 1 } else { 0 };
        if last.is_some() && run == 0 {
            lines.push("…".to_string());
        }
        last = Some(k);
        let is_repeated = run > 1 && text[k - 1] == text[k] && text[k - 2] == text[k];
        match run {
            _ if run >= LINES || is_repeated => {
                if lines.last().is_some_and(|line| line != "…") {
                    lines.push("…".to_string());
                }
            }
            _ => lines.push(cut(text[k], theirs.map_or("", |k| other[k]))),
        }
    }
    let indent = |line: &String| line.len() - line.trim_start().len();
    let is_whole = |line: &&String| !line.trim().is_empty() && !line.starts_with('…');
    let common = lines.iter().filter(is_whole).map(indent).min().unwrap_or(0);
    lines.iter().fold(String::new(), |mut all, line| {
        let line = if is_whole(&line) { &line[common..] } else { line };
        let _ = writeln!(all, "{}", line.trim_end());
        all
    })
}

/// A line, cut to the surroundings of its difference from another if it is long.
fn cut(line: &str, other: &str) -> String {
    let letters: Vec<char> = line.chars().collect();
    if letters.len() <= WIDTH {
        return line.to_string();
    }
    let theirs: Vec<char> = other.chars().collect();
    let same = letters.iter().zip(&theirs).take_while(|(a, b)| a == b).count();
    let from = if same == letters.len() { 0 } else { same.saturating_sub(AROUND) };
    let to = (from + 2 * AROUND + 20).min(letters.len());
    let dots = |is: bool| if is { "…" } else { "" };
    format!("{}{}{}", dots(from > 0), letters[from..to].iter().collect::<String>(), dots(to < letters.len()))
}

#[test]
fn excerpts_show_each_change_with_its_neighbours() {
    let bad = "a\n  b\n  c\n  d\n  e\n  f\ng\n";
    let good = "a\n  B\n  c\n  d\n  e\n  f\n  f2\ng\n";
    assert_eq!(of(bad, good, 2), ["a\n  b\n  c\n…\n  f\ng\n", "a\n  B\n  c\n…\n  f\n  f2\ng\n"]);
    assert_eq!(of("  a\n  b\n", "  a\n", 2)[1], "a\n");
    assert_eq!(of("a\nb\nb\nb\nb\nc\n", "a\nc\n", 2)[0], "a\nb\nb\n…\nc\n");
    assert_eq!(of("a\nb\nc\nd\ne\nf\ng\n", "A\nX\nb\nc\nd\ne\nf\ng\n", 6)[1], "A\nX\nb\n…\ne\nf\ng\n");
    assert_eq!(of("a\nb\nc\n", "A\nb\nc\n", 2)[0], "a\nb\nc\n");
    let long = format!("{}x{}", "a".repeat(200), "b".repeat(200));
    let [bad, _] = of(&long, &long.replace('x', "y"), 1);
    assert!(bad.starts_with("…aaa") && bad.contains("ax") && bad.ends_with("b…\n") && bad.chars().count() < WIDTH);
}
