//! Where numbers are: registers and memory.

/// A vector register.
pub(crate) type Register = u8;

/// An array in memory, by its number in the order of [`Assembler::new`](super::target::Assembler::new).
pub(crate) type Memory = usize;

/// Where an instruction's last operand is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Operand {
    Register(Register),
    /// A register's lanes, at this byte offset.
    Lanes(Memory, usize),
    /// One number broadcast to all lanes, at this byte offset: with EVEX anywhere, else only in loads of several lanes.
    Repeated(Memory, usize),
}
