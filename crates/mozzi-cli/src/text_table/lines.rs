//! The bytes of a text with lines of limited length, and runs of blanks as one separator.

use crate::input::Input;
use std::io::{self, Read};

/// A longer line is an error; so is a zero byte, which devices may send endlessly.
const LONGEST: u64 = 64 << 20;

pub struct Lines {
    input: Input,
    line: u64,
    length: u64,
    /// Whether lines end with a carriage return alone; None before the first bytes.
    has_returns: Option<bool>,
}

impl Lines {
    pub fn of(input: Input) -> Self {
        Lines { input, line: 1, length: 0, has_returns: None }
    }

    /// Counts further bytes of the line.
    fn add(&mut self, bytes: usize) -> io::Result<()> {
        self.length += bytes as u64;
        if self.length > LONGEST { Err(self.wrong("is longer than 64 MiB, expected a row")) } else { Ok(()) }
    }

    fn wrong(&self, what: &str) -> io::Error {
        io::Error::other(format!("line {} {what}", self.line))
    }
}

impl Read for Lines {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let count = self.input.read(to)?;
        let found = &mut to[..count];
        let has_returns = *self
            .has_returns
            .get_or_insert_with(|| found[..count - 1.min(count)].contains(&b'\r') && !found.contains(&b'\n'));
        if has_returns {
            found.iter_mut().filter(|byte| **byte == b'\r').for_each(|byte| *byte = b'\n');
        }
        let zero = memchr::memchr(0, found).unwrap_or(count);
        let mut begin = 0;
        for end in memchr::memchr_iter(b'\n', &found[..zero]).map(|k| k + 1) {
            self.add(end - begin)?;
            (self.line, self.length, begin) = (self.line + 1, 0, end);
        }
        self.add(zero - begin)?;
        if zero < count {
            return Err(self.wrong("holds a zero byte, expected text"));
        }
        Ok(count)
    }
}

/// Runs of blanks become one space; those at a line's ends are removed.
pub struct Blanks<R> {
    from: R,
    is_begin: bool,
    is_pending: bool,
    buffer: Vec<u8>,
    at: usize,
}

impl<R: Read> Blanks<R> {
    pub fn of(from: R) -> Self {
        Blanks { from, is_begin: true, is_pending: false, buffer: Vec::new(), at: 0 }
    }
}

impl<R: Read> Read for Blanks<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        while self.at == self.buffer.len() {
            let mut raw = [0; 1 << 14];
            let count = self.from.read(&mut raw)?;
            if count == 0 {
                return Ok(0);
            }
            (self.at, _) = (0, self.buffer.clear());
            for &byte in &raw[..count] {
                match byte {
                    b' ' | b'\t' | b'\r' => self.is_pending = !self.is_begin,
                    b'\n' => {
                        (self.is_begin, self.is_pending) = (true, false);
                        self.buffer.push(byte);
                    }
                    _ => {
                        if std::mem::take(&mut self.is_pending) {
                            self.buffer.push(b' ');
                        }
                        self.is_begin = false;
                        self.buffer.push(byte);
                    }
                }
            }
        }
        let count = to.len().min(self.buffer.len() - self.at);
        to[..count].copy_from_slice(&self.buffer[self.at..self.at + count]);
        self.at += count;
        Ok(count)
    }
}
