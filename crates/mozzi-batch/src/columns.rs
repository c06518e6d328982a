//! Converts rows to registers and back. A register holds one column of WIDTH states; in the user's table, the numbers
//! of a state are contiguous.

use crate::lanes::{Lane, MOST};
use mozzi::Scalar;

/// Layout of the numbers of many states in a slice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layout {
    /// State by state: row-major (N, columns), as NumPy and torch have it.
    #[default]
    Rows,
    /// In blocks of one register's states ([`Batch::lanes`](crate::Batch::lanes)), each block column by column: (N /
    /// lanes, columns, lanes). No transposition is needed. The last block is complete; the values of its surplus states
    /// do not matter.
    Blocks,
}

/// The index of a state's number in a table of `width` columns, in blocks of `lanes` states; rows are blocks of one.
/// `lanes` is a power of two, so this needs only shifts: a division takes as long as the register arithmetic of a whole
/// link.
#[inline(always)]
pub(crate) fn place(state: usize, column: usize, width: usize, lanes: usize) -> usize {
    let places = lanes.trailing_zeros();
    (((state >> places) * width + column) << places) + (state & (lanes - 1))
}

/// Transposes a square of WIDTH registers: each of log₂ WIDTH perfect shuffles rotates the address of a number (row
/// bits, column bits) by one bit.
#[inline(always)]
fn transpose<L: Lane>(mut square: [L; MOST]) -> [L; MOST] {
    let mut size = 1;
    while size < L::WIDTH {
        let old = square;
        let mut i = 0;
        while i < L::WIDTH / 2 {
            (square[2 * i], square[2 * i + 1]) = old[i].zip(old[i + L::WIDTH / 2]);
            i += 1;
        }
        size *= 2;
    }
    square
}

/// The registers of a slice, at most WIDTH; further ones are 0. Every index is a constant once the loop is unrolled, so
/// that a square stays in registers: a copy of variable length would put it into memory.
#[inline(always)]
fn take<L: Lane>(part: &[L]) -> [L; MOST] {
    let mut square = [L::zero(); MOST];
    let mut k = 0;
    while k < L::WIDTH {
        if k < part.len() {
            square[k] = part[k];
        }
        k += 1;
    }
    square
}

/// The inverse of [`take`].
#[inline(always)]
fn put<L: Lane>(square: [L; MOST], part: &mut [L]) {
    let mut k = 0;
    while k < L::WIDTH {
        if k < part.len() {
            part[k] = square[k];
        }
        k += 1;
    }
}

/// Sets `columns[c]` to column c of the `rows` ≤ WIDTH states from `first` on, in a table of `columns.len()` columns;
/// the last state is repeated to fill a register. A row is read one register at a time; numbers read past its end are
/// dropped.
#[inline(always)]
pub(crate) fn read_rows<L: Lane>(table: &[L::Number], first: usize, rows: usize, columns: &mut [L]) {
    let width = columns.len();
    let table = &table[first * width..];
    let last = (rows - 1) * width;
    for (k, part) in columns.chunks_mut(L::WIDTH).enumerate() {
        let c = k * L::WIDTH;
        let mut square = [L::zero(); MOST];
        let (mut row, mut place) = (0, c);
        while row < L::WIDTH {
            let from = &table[place..];
            square[row] = if from.len() >= L::WIDTH { L::load(from) } else { load_part(from) };
            place = (place + width).min(last + c);
            row += 1;
        }
        put(transpose(square), part);
    }
}

/// The inverse of [`read_rows`]. Numbers written past a row's end are overwritten later: the last columns are written
/// first, and rows in their order.
#[inline(always)]
pub(crate) fn write_rows<L: Lane>(table: &mut [L::Number], first: usize, rows: usize, columns: &[L]) {
    let width = columns.len();
    let table = &mut table[first * width..];
    // of wide tables, whole squares without a test for each row
    let squares = if rows == L::WIDTH && width >= 2 * L::WIDTH { width / L::WIDTH } else { 0 };
    for (k, part) in columns.chunks(L::WIDTH).enumerate().skip(squares).rev() {
        let c = k * L::WIDTH;
        let square = transpose(take(part));
        let (mut row, mut place) = (0, c);
        while row < L::WIDTH {
            if row < rows {
                let to = &mut table[place..];
                if to.len() >= L::WIDTH { square[row].store(to) } else { store_part(square[row], to) }
            }
            place += width;
            row += 1;
        }
    }
    if squares > 0 {
        let mut rows: [&mut [L::Number]; MOST] = Default::default();
        rows.iter_mut().zip(table.chunks_exact_mut(width)).take(L::WIDTH).for_each(|(to, row)| *to = row);
        for (k, part) in columns.chunks_exact(L::WIDTH).enumerate() {
            let square = transpose(take(part));
            let mut row = 0;
            while row < L::WIDTH {
                square[row].store(&mut rows[row][k * L::WIDTH..]);
                row += 1;
            }
        }
    }
}

#[inline(always)]
fn load_part<L: Lane>(from: &[L::Number]) -> L {
    let mut whole = [L::Number::zero(); MOST];
    whole[..from.len()].copy_from_slice(from);
    L::load(&whole)
}

#[inline(always)]
fn store_part<L: Lane>(x: L, to: &mut [L::Number]) {
    let mut whole = [L::Number::zero(); MOST];
    x.store(&mut whole);
    let count = to.len();
    to.copy_from_slice(&whole[..count]);
}

/// Reads block `block` of a table in blocks.
#[inline(always)]
pub(crate) fn read_block<L: Lane>(table: &[L::Number], block: usize, columns: &mut [L]) {
    let first = block * columns.len() * L::WIDTH;
    for (c, column) in columns.iter_mut().enumerate() {
        *column = L::load(&table[first + c * L::WIDTH..]);
    }
}

/// The inverse of [`read_block`].
#[inline(always)]
pub(crate) fn write_block<L: Lane>(table: &mut [L::Number], block: usize, columns: &[L]) {
    let first = block * columns.len() * L::WIDTH;
    for (c, column) in columns.iter().enumerate() {
        column.store(&mut table[first + c * L::WIDTH..]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::Portable;

    type Four = Portable<f64, 4>;

    #[test]
    fn rows_come_back_whatever_the_width_and_the_remainder() {
        for width in 1..=11 {
            for states in 1..=13 {
                let table: Vec<f64> = (0..states * width).map(|k| k as f64 + 1.0).collect();
                let mut back = vec![0.0; table.len()];
                for first in (0..states).step_by(4) {
                    let rows = (states - first).min(4);
                    let mut columns = vec![Portable([f64::NAN; 4]) as Four; width];
                    read_rows(&table, first, rows, &mut columns);
                    for (c, column) in columns.iter().enumerate() {
                        for lane in 0..4 {
                            assert_eq!(column.0[lane], table[(first + lane.min(rows - 1)) * width + c]);
                        }
                    }
                    write_rows(&mut back, first, rows, &columns);
                }
                assert_eq!(back, table);
            }
        }
    }
}
