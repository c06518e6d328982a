//! `bench [--robots A,B] [--peers A,B] [--seconds S] [--install]`.

use super::peers::{PEERS, Peer};

#[derive(Debug, Default, PartialEq)]
pub struct Options {
    /// Short names, as in the program `compare`.
    pub robots: Option<String>,
    peers: Option<Vec<String>>,
    /// For each robot.
    pub seconds: Option<String>,
    /// Let apt install missing packages.
    pub install: bool,
}

impl Options {
    pub fn parse(words: &[&str]) -> Result<Self, String> {
        let (mut options, mut words) = (Options::default(), words.iter());
        while let Some(&word) = words.next() {
            if word == "--install" {
                options.install = true;
                continue;
            }
            let value = words.next().ok_or_else(|| format!("{word}: unknown, or without a value"))?;
            match word {
                "--robots" => options.robots = Some(value.to_string()),
                "--seconds" => options.seconds = Some(value.to_string()),
                "--peers" => options.peers = Some(known(value)?),
                _ => return Err(format!("{word}: unknown")),
            }
        }
        Ok(options)
    }

    pub fn wants(&self, peer: &Peer) -> bool {
        let is_named = |peers: &Vec<String>| peers.iter().any(|name| name.eq_ignore_ascii_case(peer.name));
        self.peers.as_ref().map_or(!peer.is_mozzi, is_named)
    }

    /// True if all robots and all peers are measured.
    pub fn is_whole(&self) -> bool {
        self.robots.is_none() && self.peers.is_none()
    }
}

/// The peers of a comma-separated list; none if it is empty.
fn known(list: &str) -> Result<Vec<String>, String> {
    let names = list.split(',').filter(|name| !name.is_empty()).map(str::to_string).collect::<Vec<_>>();
    for name in &names {
        if !PEERS.iter().any(|peer| peer.name.eq_ignore_ascii_case(name)) {
            let expected = PEERS.iter().map(|peer| peer.name).collect::<Vec<_>>().join(", ");
            return Err(format!("peer `{name}`, expected of {expected}"));
        }
    }
    Ok(names)
}

#[cfg(test)]
mod tests {
    use super::{Options, PEERS};

    #[test]
    fn a_part_is_no_whole() -> Result<(), String> {
        let wants = |options: &Options, name: &str| PEERS.iter().any(|peer| peer.name == name && options.wants(peer));
        let all = Options::parse(&["--seconds", "3"])?;
        assert!(all.is_whole() && wants(&all, "KDL") && !wants(&all, "C++"));
        let part = Options::parse(&["--peers", "kdl,pinocchio,c++", "--robots", "ur5"])?;
        assert!(!part.is_whole() && wants(&part, "KDL") && wants(&part, "C++") && !wants(&part, "MuJoCo"));
        assert!(!wants(&Options::parse(&["--peers", ""])?, "KDL"));
        Ok(())
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (words, named) in [(&["--peers", "bullet"][..], "bullet"), (&["--fast"], "--fast"), (&["--x", "y"], "--x")]
        {
            assert!(Options::parse(words).is_err_and(|why| why.contains(named)), "{words:?}");
        }
    }
}
