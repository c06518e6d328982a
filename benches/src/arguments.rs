//! The arguments from `cargo xtask bench`.

pub const USAGE: &str = "\
usage: compare [--peer NAME=LIBRARY]... [--missing NAME=REASON]... [--models FOLDER]
               [--robots NAME,NAME...] [--seconds S] [--write FOLDER]
       compare --describe FOLDER [--models FOLDER] [--robots NAME,NAME...]";

#[derive(Debug, Default, PartialEq)]
pub struct Arguments {
    /// Name and library.
    pub peers: Vec<(String, String)>,
    /// Name and the reason why it is not available.
    pub missing: Vec<(String, String)>,
    /// The robots of PyPI's `example-robot-data`.
    pub models: Option<String>,
    /// These alone.
    pub robots: Option<Vec<String>>,
    /// For each robot.
    pub seconds: Option<f64>,
    /// The folder for RESULTS.md and results.svg.
    pub write: Option<String>,
    /// The folder for the robots' numbers, used by code generators.
    pub describe: Option<String>,
}

impl Arguments {
    pub fn parse(words: impl IntoIterator<Item = String>) -> Result<Self, String> {
        let (mut arguments, mut words) = (Arguments::default(), words.into_iter());
        while let Some(word) = words.next() {
            let value = words.next().ok_or_else(|| format!("{word}: without a value\n{USAGE}"))?;
            let pair = |value: &str| {
                let (name, rest) = value.split_once('=').ok_or_else(|| format!("{word} {value}: expected NAME=…"))?;
                Ok::<_, String>((name.to_string(), rest.to_string()))
            };
            match word.as_str() {
                "--peer" => arguments.peers.push(pair(&value)?),
                "--missing" => arguments.missing.push(pair(&value)?),
                "--models" => arguments.models = Some(value),
                "--robots" => arguments.robots = Some(value.split(',').map(str::to_string).collect()),
                "--write" => arguments.write = Some(value),
                "--describe" => arguments.describe = Some(value),
                "--seconds" => {
                    let seconds = value.parse().ok().filter(|&s: &f64| (0.0..=3600.0).contains(&s));
                    arguments.seconds =
                        Some(seconds.ok_or_else(|| format!("{value}: expected seconds, at most 3600"))?);
                }
                _ => return Err(format!("{word}: unknown\n{USAGE}")),
            }
        }
        Ok(arguments)
    }
}

#[cfg(test)]
mod tests {
    use super::Arguments;

    fn parse(text: &str) -> Result<Arguments, String> {
        Arguments::parse(text.split_whitespace().map(str::to_string))
    }

    #[test]
    fn each_word_has_its_place() {
        let arguments =
            parse("--peer KDL=a.so --missing Drake=b=c --robots ur5,panda --seconds 2.5").expect("well said");
        assert_eq!(arguments.peers, [("KDL".to_string(), "a.so".to_string())]);
        assert_eq!(arguments.missing, [("Drake".to_string(), "b=c".to_string())]);
        assert_eq!(arguments.robots.expect("given"), ["ur5", "panda"]);
        assert_eq!(arguments.seconds, Some(2.5));
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (text, named) in
            [("--peer KDL", "--peer KDL"), ("--robots", "--robots"), ("--seconds soon", "soon"), ("--x y", "--x")]
        {
            assert!(parse(text).expect_err(text).starts_with(named), "{text}");
        }
    }
}
