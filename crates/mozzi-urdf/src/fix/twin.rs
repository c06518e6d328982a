//! The other one of a pair: left and right, front and rear.

/// Words that come in pairs, as they stand in names.
const PAIRS: [(&str, &str); 12] = [
    ("left", "right"),
    ("Left", "Right"),
    ("LEFT", "RIGHT"),
    ("front", "rear"),
    ("Front", "Rear"),
    ("front", "back"),
    ("fore", "hind"),
    ("L", "R"),
    ("l", "r"),
    ("F", "H"),
    ("F", "R"),
    ("f", "h"),
];

/// The names that another of its kind may have: its mirror images, and others of a row.
pub(super) fn names(name: &str) -> Vec<String> {
    let mut found = mirrored(name);
    found.extend(numbered(name));
    found
}

/// The names on the other side: left_hip, right_hip.
pub(super) fn mirrored(name: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (a, b) in PAIRS.into_iter().flat_map(|(a, b)| [(a, b), (b, a)]) {
        for (at, _) in name.match_indices(a) {
            // a single letter is a word of its own, or one of two capitals: l_hip, RF_knee
            let is_letter = |c: Option<char>| c.is_some_and(|c| c.is_alphabetic());
            let (before, after) = (name[..at].chars().next_back(), name[at + a.len()..].chars().next());
            let stands = |c: Option<char>| !is_letter(c) || a.chars().all(char::is_uppercase) && is_upper(c);
            if a.len() > 1 || stands(before) && stands(after) {
                found.push(format!("{}{b}{}", &name[..at], &name[at + a.len()..]));
            }
        }
    }
    found
}

/// The names of others in a row: finger1, finger2. Joints in a row need not be alike.
fn numbered(name: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (at, digit) in name.char_indices().filter(|(_, c)| c.is_ascii_digit()) {
        for other in ('0'..='9').filter(|other| *other != digit) {
            found.push(format!("{}{other}{}", &name[..at], &name[at + 1..]));
        }
    }
    found
}

fn is_upper(c: Option<char>) -> bool {
    c.is_some_and(char::is_uppercase)
}

#[cfg(test)]
mod tests {
    use super::{mirrored, names};

    #[test]
    fn left_is_the_twin_of_right() {
        for (one, other) in [
            ("left_hip", "right_hip"),
            ("RF_knee", "LF_knee"),
            ("l_arm", "r_arm"),
            ("arm_r", "arm_l"),
            ("RF_knee", "RH_knee"),
        ] {
            assert!(names(one).contains(&other.to_string()), "{one}: {:?}", names(one));
        }
        assert!(names("elbow").is_empty(), "{:?}", names("elbow"));
        assert!(names("finger1_tip").contains(&"finger2_tip".to_string()));
        assert!(mirrored("finger1_tip").is_empty());
    }
}
