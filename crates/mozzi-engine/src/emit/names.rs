//! Names that are valid in every language.

use std::collections::BTreeSet;

/// Words that are reserved by one of the languages or its library, that are not allowed as file names on some system,
/// or that the emitted text uses.
const KEPT: &str = " abstract alignas alignof and asm assert auto aux become bool box break case catch char class columns con concept const \
    constexpr continue count crate decltype default delete do double dyn else enum entry explicit export extern extern_c f32 f64 false final \
    float fn for friend goto if impl in inline int let long loop macro match mod move mul_add mut mutable namespace new noexcept not nul \
    nullptr operator or override priv private prn protected pub ref register restrict return self short signed sgn sin_cos sizeof \
    square_root state static std struct super switch template this throw trait true try type typedef typeid typename typeof u32 u64 \
    union unsafe unsigned unsized use using virtual void volatile where while xor yield ";

/// Headers of C's library and of its usual neighbours: a robot's `math.h` would be found instead of <math.h>.
const HEADERS: &str = " alloca complex ctype cuda cuda_runtime errno fenv inttypes iso646 limits locale malloc math memory setjmp signal \
    stdalign stdarg stdatomic stdbit stdbool stdckdint stddef stdint stdio stdlib stdnoreturn string strings tgmath threads time \
    uchar unistd wchar wctype ";

/// A name of ASCII letters, digits and single underscores that begins with a letter; `nothing` if no character is left.
pub(super) fn identifier(name: &str, nothing: &str) -> String {
    let words: Vec<&str> = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let joined = words.join("_");
    let word = format!(" {} ", joined.to_ascii_lowercase());
    let is_kept = KEPT.contains(&word) || HEADERS.contains(&word);
    match joined.chars().next() {
        None => nothing.to_string(),
        Some(first) if first.is_ascii_digit() => format!("{nothing}_{joined}"),
        Some(_) if is_kept => format!("{joined}_"),
        Some(_) => joined,
    }
}

/// Prefixes of local numbers and arrays, followed by digits: `v12`, `r3`, `sin_v12`.
const LOCAL: [&str; 5] = ["v", "r", "x_v", "sin_v", "cos_v"];

/// The name, made unique by a suffix if it is taken or looks like a local name.
pub(super) fn unique(name: &str, taken: &mut BTreeSet<String>) -> String {
    let is_number = |rest: &str| rest.bytes().all(|c| c.is_ascii_digit());
    let is_local = LOCAL.iter().any(|start| name.strip_prefix(start).is_some_and(is_number));
    let mut unique = if is_local { format!("{name}_") } else { name.to_string() };
    for k in 2.. {
        if taken.insert(unique.clone()) {
            break;
        }
        unique = format!("{name}_{k}");
    }
    unique
}

/// A name made safe for a comment: no character ends the comment or its line, or reverses the text direction.
pub(super) fn in_comment(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || "_-.,:+() []".contains(c) { c } else { '_' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_name_becomes_one_that_is_valid() {
        for (name, expected) in [
            ("panda", "panda"),
            ("7dof arm (left)", "robot_7dof_arm_left"),
            ("__x__y_", "x_y"),
            ("ロボット", "robot"),
            ("", "robot"),
            ("match", "match_"),
            ("math", "math_"),
            ("Time", "Time_"),
            ("Class", "Class_"),
            ("a/../b\n", "a_b"),
            ("nul", "nul_"),
        ] {
            assert_eq!(identifier(name, "robot"), expected);
        }
        let mut taken = BTreeSet::new();
        let names = ["a", "a", "v3", "v3", "r", "a_2"].map(|name| unique(name, &mut taken));
        assert_eq!(names, ["a", "a_2", "v3_", "v3_2", "r_", "a_2_2"]);
        assert_eq!(in_comment("a */ b\\\n\u{202e}ü??/"), "a __ b___ü___");
    }
}
