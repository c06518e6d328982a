//! Suggestions for misspelled words.

use mozzi::spelling::distance;

/// The known word nearest to an unknown one, if it is near enough for a misspelling.
pub(crate) fn nearest<'k>(word: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    if word.len() > 64 {
        return None;
    }
    let lower = word.to_lowercase();
    let near = |known: &'k str| {
        let d = distance(&lower, &known.to_lowercase());
        // one slip in three letters or more, two in six, three in nine
        (d <= word.chars().count().min(known.chars().count()) / 3).then_some((d, known))
    };
    let letters = |word: &str| {
        let mut letters: Vec<char> = word.chars().collect();
        letters.sort_unstable();
        letters
    };
    // among equally near words, prefer those with the same letters: `iyx` is `ixy`, not `ixx`
    let rank = |&(d, known): &(usize, &str)| (d, letters(known) != letters(&lower));
    known.into_iter().filter(|known| known.len() <= 64).filter_map(near).min_by_key(rank).map(|(_, known)| known)
}

/// A known name that begins or ends with the given one, which lacks its suffix or prefix.
fn longer_name<'k>(name: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    let is_joint = ['_', '/', '-', '.'];
    let is_longer = |known: &&str| {
        name.len() > 2
            && (known.strip_suffix(name).is_some_and(|start| start.ends_with(is_joint))
                || known.strip_prefix(name).is_some_and(|end| end.starts_with(is_joint)))
    };
    known.into_iter().find(is_longer)
}

/// A number and its noun: "1 number", "3 numbers".
#[must_use]
pub fn counted(n: usize, noun: &str) -> String {
    if n == 1 { format!("1 {noun}") } else { format!("{n} {noun}s") }
}

/// "did you mean `x`?"
pub(crate) fn meant(word: &str) -> String {
    format!("did you mean `{word}`?")
}

/// "did you mean `x`?" with the known word nearest to an unknown one, if it is near enough for a misspelling, or with
/// the first that has a prefix or a suffix more.
pub fn did_you_mean<'k>(word: &str, known: impl IntoIterator<Item = &'k str>) -> Option<String> {
    let known: Vec<&str> = known.into_iter().collect();
    nearest(word, known.iter().copied()).or_else(|| longer_name(word, known)).map(meant)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_near_and_other_words_are_not() {
        assert_eq!(nearest("intertial", ["inertial", "visual"]), Some("inertial"));
        assert_eq!(nearest("Lower", ["upper", "lower"]), Some("lower"));
        assert_eq!(nearest("revolut", ["revolute"]), Some("revolute"));
        assert_eq!(nearest("xzy", ["xyz", "rpy"]), Some("xyz"));
        assert_eq!(nearest("gravity", ["inertial", "visual", "collision"]), None);
        assert_eq!(nearest("iyx", ["ixx", "iyy", "ixy"]), Some("ixy"));
        assert_eq!(nearest("D", ["damping"]), None);
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(longer_name("index_q1", ["index", "Left_index_q1"]), Some("Left_index_q1"));
        assert_eq!(did_you_mean("elbow", ["elbows_up", "elbow_joint"]).as_deref(), Some("did you mean `elbow_joint`?"));
    }
}
