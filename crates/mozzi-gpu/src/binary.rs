//! Machine code for a GPU, and what it needs.

use crate::Arch;

/// A kernel's machine code (CUBIN) for one architecture.
#[derive(Clone, Debug)]
pub struct Binary {
    pub(crate) code: Vec<u8>,
    pub(crate) entry: String,
    pub(crate) arch: Arch,
    pub(crate) resources: Option<Resources>,
}

/// The resources that a thread and a block of a kernel need, as counted by the assembler.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Resources {
    /// 32-bit registers of a thread.
    pub registers: usize,
    /// Bytes of a thread's frame in local memory.
    pub stack_bytes: usize,
    /// Bytes of registers that a thread stores in local memory.
    pub spill_stores: usize,
    /// Bytes that it loads back.
    pub spill_loads: usize,
    /// Bytes of a block's shared memory.
    pub shared_bytes: usize,
}

impl Binary {
    /// The CUBIN file.
    pub fn code(&self) -> &[u8] {
        &self.code
    }

    /// The kernel's name.
    pub fn entry(&self) -> &str {
        &self.entry
    }

    /// The architecture that it was compiled for.
    pub fn arch(&self) -> Arch {
        self.arch
    }

    /// Registers, spilled registers, shared memory; `None` if the assembler does not report them: that of NVRTC 13.0
    /// does not.
    pub fn resources(&self) -> Option<Resources> {
        self.resources
    }
}

impl Resources {
    /// Reads the assembler's messages, such as `Used 89 registers, used 0 barriers, 18432 bytes smem`; `None` if they
    /// are not there.
    pub(crate) fn parse(log: &str) -> Option<Resources> {
        let before = |word: &str| -> Option<usize> {
            let place = log.find(word)?;
            log[..place].split_whitespace().next_back()?.parse().ok()
        };
        let spilled = |word: &str| before(word).unwrap_or(0);
        Some(Resources {
            registers: before(" registers")?,
            stack_bytes: spilled(" bytes stack frame"),
            spill_stores: spilled(" bytes spill stores"),
            spill_loads: spilled(" bytes spill loads"),
            shared_bytes: spilled(" bytes smem"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_assemblers_messages_are_read() {
        let log = "ptxas info    : Function properties for f\nptxas         .     16 bytes stack frame, 8 bytes spill stores, \
                   12 bytes spill loads\nptxas info    : Used 89 registers, used 0 barriers, 18432 bytes smem\n";
        let found = Resources::parse(log).expect("a count of registers");
        let expected =
            Resources { registers: 89, stack_bytes: 16, spill_stores: 8, spill_loads: 12, shared_bytes: 18432 };
        assert_eq!(found, expected);
        assert_eq!(Resources::parse("Used 32 registers").expect("registers").shared_bytes, 0);
        assert_eq!(Resources::parse("warning"), None);
    }
}
