//! Exit codes and their meaning: the only list of them.

pub const SUCCESS: u8 = 0;
pub const FAILED: u8 = 1;
pub const USAGE: u8 = 2;
/// The code that shells expect from a program ended by SIGINT.
pub const STOPPED: u8 = 130;

/// Each code with its meaning, as in docs/command-line.md.
const MEANINGS: [(u8, &str); 4] = [
    (SUCCESS, "the result is complete; there may be warnings and notes on standard error"),
    (FAILED, "invalid input, no result, or a negative result (`check`, `compare`, `identify`)"),
    (USAGE, "the command line is wrong: an unknown command or flag, or a missing value"),
    (STOPPED, "stopped by Ctrl-C; results computed so far are written"),
];

/// The list for `mozzi --help`.
pub fn help() -> String {
    let row = |(code, meaning): (u8, &str)| format!("\n  {code:<5}{meaning}");
    String::from("Exit codes:") + &MEANINGS.map(row).concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_of_the_docs_is_this_list() {
        let docs = include_str!("../../../docs/command-line.md").replace("\r\n", "\n");
        let begin = docs.find("## Exit codes").expect("a section");
        let rows = docs[begin..].lines().skip_while(|line| !line.starts_with('|')).take_while(|line| !line.is_empty());
        let found: Vec<&str> = rows.skip(2).collect();
        let expected: Vec<String> = MEANINGS.iter().map(|(code, meaning)| format!("| {code} | {meaning} |")).collect();
        assert_eq!(found, expected);
    }
}
