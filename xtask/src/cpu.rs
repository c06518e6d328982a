//! CPU time of the programs that this one has started and waited for.

use std::fmt;

/// Linux counts in these parts of a second for all its programs (`getconf CLK_TCK`).
const TICKS: f64 = 100.0;
/// The fields of `/proc/self/stat` after the program's name: 11 user, 12 system time, 13 and 14 of waited-for children.
const OF_CHILDREN: [usize; 2] = [13, 14];

/// Seconds of user and system time; none elsewhere than on Linux.
#[derive(Clone, Copy, Default, PartialEq, Debug)]
pub struct Seconds(Option<f64>);

impl Seconds {
    /// Until now.
    pub fn of_children() -> Seconds {
        Seconds(std::fs::read_to_string("/proc/self/stat").ok().as_deref().and_then(parse))
    }

    pub fn since(self, start: Seconds) -> Seconds {
        Seconds(self.0.zip(start.0).map(|(now, start)| now - start))
    }

    pub fn known(self) -> Option<f64> {
        self.0
    }
}

impl fmt::Display for Seconds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(seconds) => write!(f, ", {seconds:.0} CPU s"),
            None => Ok(()),
        }
    }
}

fn parse(stat: &str) -> Option<f64> {
    // the name may contain spaces and parentheses
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = OF_CHILDREN.map(|k| fields.get(k).and_then(|field| field.parse::<f64>().ok()));
    Some((ticks[0]? + ticks[1]?) / TICKS)
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn the_times_of_children_are_found_behind_any_name() {
        let stat = "7 (a) b) S 1 7 7 0 -1 4194560 0 0 0 0 11 22 330 44 20 0 1 0 5 0 0";
        assert_eq!(parse(stat), Some(3.74));
        assert_eq!(parse("7 (a"), None);
    }
}
