//! The log of a campaign: comparisons, skipped quantities with their reasons, differences.

use crate::campaign::LIMIT;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// The two computations that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Way {
    /// The kernel on `f64`, with the second way.
    Second,
    /// The kernel in memory full of NaN, with the kernel: equal to the bit.
    Memory,
    /// The kernel with fused multiply-add, with the kernel.
    Fused,
    /// The kernel on `f32`, with the kernel on `f64`; not for quantities that divide.
    Single,
    /// The recorded program, interpreted, with the kernel.
    Program,
    /// Machine code at one state, with the kernel; in the robot's own environment.
    Code,
    /// Machine code at many states, with the kernel.
    Arrays,
    /// Machine code at many states in `f32`, with the kernel on `f64`; not for quantities that divide.
    SingleArrays,
    /// Emitted C, compiled, with the kernel; in the robot's own environment.
    C,
}

impl Way {
    /// All.
    pub const ALL: [Way; 9] = [
        Way::Second,
        Way::Memory,
        Way::Fused,
        Way::Single,
        Way::Program,
        Way::Code,
        Way::Arrays,
        Way::SingleArrays,
        Way::C,
    ];

    /// Its name in the tables.
    pub fn name(self) -> &'static str {
        match self {
            Way::Second => "second way",
            Way::Memory => "NaN in memory",
            Way::Fused => "FMA",
            Way::Single => "f32",
            Way::Program => "program",
            Way::Code => "machine code",
            Way::Arrays => "arrays",
            Way::SingleArrays => "f32 arrays",
            Way::C => "C",
        }
    }

    /// The way of this name.
    pub fn named(name: &str) -> Option<Way> {
        Way::ALL.into_iter().find(|way| way.name() == name)
    }

    /// ε of the way's number type over 2⁻⁵².
    pub fn epsilon(self) -> f64 {
        match self {
            Way::Single | Way::SingleArrays => f64::from(f32::EPSILON) / f64::EPSILON,
            _ => 1.0,
        }
    }
}

/// The comparisons of one quantity in one way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Count {
    /// Robots.
    pub comparisons: u64,
    /// Numbers.
    pub numbers: u64,
    /// The largest difference that is not a finding, in units.
    pub worst: f64,
}

/// Counts of a campaign.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counts {
    /// By quantity and way.
    pub compared: BTreeMap<(&'static str, Way), Count>,
    /// Reasons, with how often each was met.
    pub skipped: BTreeMap<String, u64>,
}

impl Counts {
    /// Adds a comparison.
    pub fn add(&mut self, quantity: &'static str, way: Way, units: f64, numbers: usize) {
        let count = self.compared.entry((quantity, way)).or_default();
        *count = Count {
            comparisons: count.comparisons + 1,
            numbers: count.numbers + numbers as u64,
            worst: if units <= LIMIT { count.worst.max(units) } else { count.worst },
        };
    }

    /// Counts something that was not compared.
    pub fn skip(&mut self, why: &str) {
        *self.skipped.entry(why.to_string()).or_default() += 1;
    }

    /// The sum over the quantities and ways for which `holds`.
    pub fn sum(&self, holds: impl Fn(&str, Way) -> bool) -> Count {
        let chosen = self.compared.iter().filter(|((quantity, way), _)| holds(quantity, *way));
        chosen.fold(Count::default(), |sum, (_, count)| Count {
            comparisons: sum.comparisons + count.comparisons,
            numbers: sum.numbers + count.numbers,
            worst: sum.worst.max(count.worst),
        })
    }

    /// For the file of progress.
    pub fn to_json(&self) -> Value {
        let row = |((quantity, way), count): (&(&str, Way), &Count)| {
            json!([quantity, way.name(), count.comparisons, count.numbers, count.worst])
        };
        json!({ "compared": self.compared.iter().map(row).collect::<Vec<_>>(), "skipped": self.skipped })
    }

    /// From the file of progress; None if it is not one.
    pub fn from_json(value: &Value) -> Option<Self> {
        let mut counts = Counts::default();
        for row in value["compared"].as_array()? {
            let quantity = mozzi::quantities::Query::named(row[0].as_str()?).ok()?.declaration().name;
            let (comparisons, numbers) = (row[2].as_u64()?, row[3].as_u64()?);
            let count = Count { comparisons, numbers, worst: row[4].as_f64()? };
            counts.compared.insert((quantity, Way::named(row[1].as_str()?)?), count);
        }
        for (why, count) in value["skipped"].as_object()? {
            counts.skipped.insert(why.clone(), count.as_u64()?);
        }
        Some(counts)
    }
}

/// A difference above the limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The robot.
    pub seed: u64,
    /// The quantity's index in the list.
    pub quantity: usize,
    /// The way.
    pub way: Way,
    /// The difference in units; infinite for NaN and for a panic.
    pub units: f64,
    /// The numbers, or the panic's message.
    pub what: String,
}

impl std::fmt::Display for Finding {
    fn fmt(&self, to: &mut std::fmt::Formatter) -> std::fmt::Result {
        let name = mozzi::quantities::LIST[self.quantity].name;
        write!(to, "seed {}, {name}, {}: {:.3e} units, {}", self.seed, self.way.name(), self.units, self.what)
    }
}
