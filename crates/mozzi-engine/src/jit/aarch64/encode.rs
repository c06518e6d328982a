//! Loads, stores and addresses.

use super::Address;

/// True if a load or store of so many bytes reaches this byte from the array's beginning: multiples of the size by
/// twelve bits, others by eight.
pub(super) fn reaches(byte: usize, size: usize) -> bool {
    byte < 256 || byte.is_multiple_of(size) && byte / size < 4096
}

/// `ldr`, `ldur`, `str` or `stur` of 4, 8 or 16 bytes.
pub(super) fn load_or_store(is_load: bool, register: u32, base: Address, byte: usize, size: usize) -> u32 {
    assert!(reaches(byte, size), "byte {byte} for {size}");
    let kind = match size {
        4 => 0xbc00_0000,
        8 => 0xfc00_0000,
        16 => 0x3c80_0000,
        _ => unreachable!("4, 8 or 16 bytes"),
    };
    let offset = match byte.is_multiple_of(size) && byte / size < 4096 {
        true => 1 << 24 | (byte / size) << 10,
        false => byte << 12,
    };
    kind | u32::from(is_load) << 22 | offset as u32 | u32::from(base) << 5 | register
}

/// `st1 {v.s}[2], [base]`.
pub(super) fn lane_two(register: u32, base: Address) -> u32 {
    0x4d00_8000 | u32::from(base) << 5 | register
}

/// target ← from + by in one or two instructions, without the register `from`: of the second it is the target.
pub(super) fn add_immediate(target: Address, by: usize) -> impl Iterator<Item = u32> {
    assert!(by < 1 << 24, "{by} bytes");
    let add = move |shift: u32, twelve: usize| 0x9100_0000 | shift << 22 | (twelve as u32) << 10 | u32::from(target);
    let (high, low) = (by >> 12, by & 4095);
    let high = (high > 0).then(|| add(1, high));
    let low = (low > 0 || high.is_none()).then(|| add(0, low));
    high.into_iter().chain(low)
}
