//! Counts in a disassembly.

/// Instructions of a kernel by kind. Code without loops: each thread executes each one once, except the rare paths of
/// divisions, square roots and large sines, which are functions or branches of their own and are counted, too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Instructions {
    /// Fused multiply-adds in the kernel's precision.
    pub fma: usize,
    /// Sums and products in the kernel's precision.
    pub add_mul: usize,
    /// Reciprocals, square roots and conversions (the special unit).
    pub special: usize,
    /// Loads and stores of global memory.
    pub global: usize,
    /// Those of shared memory.
    pub shared: usize,
    /// Those of local memory: spilled registers.
    pub local: usize,
    /// Integers, bits, moves, comparisons, constants.
    pub other: usize,
}

impl Instructions {
    /// Counts the lines of `nvdisasm -c`.
    pub fn count(text: &str) -> Instructions {
        let mut count = Instructions::default();
        for line in text.lines() {
            let Some((_, rest)) = line.split_once("*/") else { continue };
            let words = rest.split_whitespace().map(|word| word.trim_end_matches(';'));
            let Some(word) = words.into_iter().find(|word| !word.starts_with('@')) else { continue };
            let name = word.split('.').next().unwrap_or(word);
            *match name {
                "NOP" | "" => continue,
                "FFMA" | "DFMA" => &mut count.fma,
                "FADD" | "FMUL" | "DADD" | "DMUL" => &mut count.add_mul,
                "MUFU" => &mut count.special,
                "LDG" | "STG" | "LD" | "ST" => &mut count.global,
                "LDS" | "STS" => &mut count.shared,
                "LDL" | "STL" => &mut count.local,
                _ if name.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit()) => &mut count.other,
                _ => continue,
            } += 1;
        }
        count
    }

    /// Instructions of the kernel's arithmetic units.
    pub fn arithmetic(&self) -> usize {
        self.fma + self.add_mul
    }

    /// Instructions of memory.
    pub fn memory(&self) -> usize {
        self.global + self.shared + self.local
    }

    /// All.
    pub fn all(&self) -> usize {
        self.arithmetic() + self.special + self.memory() + self.other
    }
}
