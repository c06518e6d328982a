//! From rows to registers and back. A register holds one column of WIDTH states; the user's table has a state's numbers side by side.

use crate::lanes::{Lane, MOST};
use mozzi::Scalar;

/// How the numbers of many states lie in a slice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layout {
    /// State by state: row-major (N, columns), as NumPy and torch have it.
    #[default]
    Rows,
    /// In blocks of as many states as a register holds ([`Batch::lanes`](crate::Batch::lanes)), in each column by column:
    /// (N / lanes, columns, lanes). No transposition; the last block is full, its further states whatever they are.
    Blocks,
}

/// A square of WIDTH registers, its rows and columns exchanged: each of log₂ WIDTH perfect shuffles turns the address of a number
/// (row bits, column bits) by one place.
#[inline(always)]
fn transpose<L: Lane>(square: &mut [L; MOST]) {
    let mut size = 1;
    while size < L::WIDTH {
        let old = *square;
        let mut i = 0;
        while i < L::WIDTH / 2 {
            (square[2 * i], square[2 * i + 1]) = old[i].zip(old[i + L::WIDTH / 2]);
            i += 1;
        }
        size *= 2;
    }
}

/// Row `row` of a block, clamped to the last: a block's remainder repeats a state.
#[inline(always)]
fn place(width: usize, first: usize, row: usize, rows: usize, column: usize) -> usize {
    (first + row.min(rows - 1)) * width + column
}

/// `columns[c]` is column c of the `rows` ≤ WIDTH states from `first` on, in a table of `columns.len()` numbers a state. A row is read a
/// register at a time, past its end into the next, whose numbers are dropped.
#[inline(always)]
pub(crate) fn read_rows<L: Lane>(table: &[L::Number], first: usize, rows: usize, columns: &mut [L]) {
    let width = columns.len();
    let mut c = 0;
    while c < width {
        let mut square = [L::zero(); MOST];
        let mut row = 0;
        while row < L::WIDTH {
            let from = &table[place(width, first, row, rows, c)..];
            square[row] = if from.len() >= L::WIDTH { L::load(from) } else { load_part(from) };
            row += 1;
        }
        transpose(&mut square);
        let count = (width - c).min(L::WIDTH);
        columns[c..c + count].copy_from_slice(&square[..count]);
        c += L::WIDTH;
    }
}

/// The inverse of [`read_rows`]. What a register writes past a row's end is overwritten by what follows: the last columns come
/// first, and rows in their order.
#[inline(always)]
pub(crate) fn write_rows<L: Lane>(table: &mut [L::Number], first: usize, rows: usize, columns: &[L]) {
    let width = columns.len();
    let mut c = width.next_multiple_of(L::WIDTH);
    while c > 0 {
        c -= L::WIDTH;
        let mut square = [L::zero(); MOST];
        let count = (width - c).min(L::WIDTH);
        square[..count].copy_from_slice(&columns[c..c + count]);
        transpose(&mut square);
        let mut row = 0;
        while row < rows {
            let to = &mut table[place(width, first, row, rows, c)..];
            if to.len() >= L::WIDTH {
                square[row].store(to)
            } else {
                store_part(square[row], to)
            }
            row += 1;
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

/// Block `block` of a table in blocks.
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
