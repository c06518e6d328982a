//! Which known name was meant by an unknown one.

use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

/// Letters to insert, drop, replace or swap with their neighbour (optimal string alignment).
pub fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let (mut before, mut previous): (Vec<usize>, Vec<usize>) = (Vec::new(), (0..=b.len()).collect());
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let same = usize::from(a[i - 1] != b[j - 1]);
            let mut d = (previous[j] + 1).min(row[j - 1] + 1).min(previous[j - 1] + same);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                d = d.min(before[j - 2] + 1);
            }
            row.push(d);
        }
        (before, previous) = (previous, row);
    }
    previous.last().copied().unwrap_or(0)
}

/// The names most like a word, at most `count`: by shared parts between `_` or `-`, and by letters.
pub fn nearest<'k>(word: &str, known: &[&'k str], count: usize) -> Vec<&'k str> {
    let parts = |text: &str| text.to_lowercase().split(['_', '-']).map(String::from).collect::<Vec<_>>();
    // an endless word is like none; a mass matrix is called an inertia matrix, too
    let word: String = word.chars().take(64).collect::<String>().to_lowercase().replace("inertia", "mass_matrix");
    let asked = parts(&word);
    let unlike = |name: &str| {
        let own = parts(name);
        let shared = asked.iter().filter(|part| part.len() > 2 && own.contains(part)).count();
        let letters = 100 * distance(&word, &name.to_lowercase()) / word.chars().count().max(name.len()).max(1);
        letters + 100 - 100 * shared / own.len().max(asked.len()).max(1)
    };
    let mut all: Vec<&str> = known.to_vec();
    all.sort_by_cached_key(|name| unlike(name));
    all.truncate(count);
    all
}
