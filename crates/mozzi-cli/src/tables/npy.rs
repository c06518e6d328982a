//! NumPy's .npy (numpy.lib.format), of floats: a magic word, the version, the header's length; the header, a Python
//! dictionary of type, order and shape; the numbers.

use super::array::{Array, tuple};
use super::precision::Precision;
use crate::failure::{Failure, Result};
use std::fmt::Display;

const MAGIC: &[u8] = b"\x93NUMPY";

/// `place` is the file, or an archive and its array, which has this name.
pub fn parse(place: &dyn Display, name: &str, bytes: &[u8]) -> Result<Array> {
    let wrong = |what: &str| Failure::wrong(format!("{place} is not a .npy file: {what}"));
    let rest = bytes.strip_prefix(MAGIC).ok_or_else(|| wrong("it does not begin with \\x93NUMPY"))?;
    let cut = || wrong("it ends inside its header");
    let (length, rest) = match rest {
        [1, _, a, b, rest @ ..] => (usize::from(u16::from_le_bytes([*a, *b])), rest),
        [2 | 3, _, a, b, c, d, rest @ ..] => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, rest),
        [version, _, ..] => return Err(wrong(&format!("its version is {version}, expected 1, 2 or 3"))),
        _ => return Err(cut()),
    };
    let (header, data) = rest.split_at_checked(length).ok_or_else(cut)?;
    let header = String::from_utf8_lossy(header);
    let entry = |key: &str| {
        let at = header.find(&format!("'{key}'")).or_else(|| header.find(&format!("\"{key}\"")));
        let value = at.and_then(|at| header[at + key.len() + 2..].trim_start().strip_prefix(':'));
        value.map(str::trim_start).ok_or_else(|| wrong(&format!("its header has no `{key}`: {}", header.trim())))
    };
    let descr = entry("descr")?;
    let kind = descr.strip_prefix(['\'', '"']).and_then(|text| text.split(['\'', '"']).next());
    let (size, number): (usize, fn(&[u8]) -> f64) = match kind {
        Some("<f8") => (8, |x| f64::from_le_bytes(array(x))),
        Some(">f8") => (8, |x| f64::from_be_bytes(array(x))),
        Some("<f4") => (4, |x| f32::from_le_bytes(array(x)).into()),
        Some(">f4") => (4, |x| f32::from_be_bytes(array(x)).into()),
        other => {
            let found = other.unwrap_or("a structure");
            return Err(Failure::wrong(format!("{place} has numbers of type {found}, expected float64 or float32")));
        }
    };
    let by_columns = entry("fortran_order")?.starts_with("True");
    let list = entry("shape")?.strip_prefix('(').and_then(|text| text.split_once(')'));
    let entries = list.map_or("?", |(list, _)| list).split(',').map(str::trim).filter(|entry| !entry.is_empty());
    let shape = entries.map(str::parse).collect::<std::result::Result<Vec<usize>, _>>();
    let shape = shape.map_err(|_| wrong(&format!("its shape is not a tuple of numbers: {}", header.trim())))?;

    let expected = shape.iter().try_fold(size, |product, &count| product.checked_mul(count));
    if expected != Some(data.len()) {
        let (found, shape) = (data.len(), tuple(&shape));
        return Err(wrong(&format!("there are {found} bytes of numbers, expected those of shape {shape}")));
    }
    let mut values: Vec<f64> = data.chunks_exact(size).map(number).collect();
    if by_columns && shape.len() > 1 {
        values = by_rows(&shape, &values);
    }
    Ok(Array::new(name, shape, values))
}

fn array<const K: usize>(bytes: &[u8]) -> [u8; K] {
    let mut all = [0; K];
    all.copy_from_slice(bytes);
    all
}

/// Numbers whose first index runs fastest, in the order in which the last does.
fn by_rows(shape: &[usize], values: &[f64]) -> Vec<f64> {
    let at = |mut place: usize| {
        let (mut source, mut stride) = (0, values.len());
        for &count in shape.iter().rev() {
            stride /= count;
            source += place % count * stride;
            place /= count;
        }
        values[source]
    };
    (0..values.len()).map(at).collect()
}

/// Digits that the first number of a shape has room for, so that a header is as long whatever that number is.
const ROWS: usize = 20;

/// What stands before the numbers, as `numpy.save` writes it: version 1, numbers from a multiple of 64 bytes on.
pub fn header<T: Precision>(shape: &[usize]) -> Vec<u8> {
    let size = size_of::<T>();
    let mut header = format!("{{'descr': '<f{size}', 'fortran_order': False, 'shape': {}, }}", tuple(shape));
    let room = ROWS - shape.first().map_or(ROWS, |rows| rows.to_string().len());
    header.extend(std::iter::repeat_n(' ', room));
    let before = MAGIC.len() + 4;
    while !(before + header.len() + 1).is_multiple_of(64) {
        header.push(' ');
    }
    header.push('\n');
    [MAGIC, &[1, 0], &(header.len() as u16).to_le_bytes(), header.as_bytes()].concat()
}

/// The whole file.
pub fn bytes<T: Precision>(shape: &[usize], values: &[T]) -> Vec<u8> {
    let mut bytes = header::<T>(shape);
    bytes.reserve(size_of_val(values));
    values.iter().for_each(|x| x.write(&mut bytes));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(header: &str, numbers: &[u8]) -> Vec<u8> {
        let length = (header.len() as u16).to_le_bytes();
        [MAGIC, &[1, 0], &length, header.as_bytes(), numbers].concat()
    }

    #[test]
    fn arrays_come_back() {
        for shape in [vec![], vec![6], vec![3, 2], vec![0, 4], vec![1, 3, 2]] {
            let values: Vec<f64> = (0..shape.iter().product()).map(|k| (k as f64).sqrt()).collect();
            let written = bytes(&shape, &values);
            assert_eq!((written.len() - 8 * values.len()) % 64, 0);
            assert_eq!(parse(&"x", "x", &written).expect("an array"), Array::new("x", shape.clone(), values));
        }
        assert_eq!(header::<f64>(&[1, 7]).len(), header::<f64>(&[usize::MAX, 7]).len());
        let single = parse(&"x", "x", &bytes(&[2], &[0.5_f32, -3.0])).expect("an array");
        assert_eq!(single.values, [0.5, -3.0]);
    }

    #[test]
    fn columns_become_rows_and_big_ends_little() {
        let numbers: Vec<u8> = [1.0_f64, 4.0, 2.0, 5.0, 3.0, 6.0].iter().flat_map(|x| x.to_be_bytes()).collect();
        let found = parse(&"x", "x", &file("{\"descr\": '>f8', 'fortran_order': True, 'shape': (2, 3)}", &numbers));
        assert_eq!(found.expect("an array"), Array::new("x", vec![2, 3], vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
    }

    #[test]
    fn what_is_no_array_of_floats_is_refused() {
        let of = |descr: &str, shape: &str| format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}}}");
        let long = file(&of("'<f8'", "(99999999999, 99999999999)"), &[0; 16]);
        for (bytes, word) in [
            (b"PK\x03\x04".to_vec(), "does not begin"),
            (MAGIC.to_vec(), "ends inside its header"),
            ([MAGIC, &[9, 0, 1, 0]].concat(), "version is 9"),
            ([MAGIC, &[1, 0, 200, 0, b'{']].concat(), "ends inside its header"),
            (file("{'descr': '<f8'}", &[]), "no `fortran_order`"),
            (file(&of("'<i8'", "(1,)"), &[0; 8]), "type <i8"),
            (file(&of("[('a', '<f8')]", "(1,)"), &[0; 8]), "a structure"),
            (file(&of("'<f8'", "(x,)"), &[0; 8]), "tuple of numbers"),
            (file(&of("'<f8'", "(2,)"), &[0; 8]), "8 bytes"),
            (long, "16 bytes"),
        ] {
            let Err(Failure::Wrong(message)) = parse(&"x.npy", "x", &bytes) else { panic!("expected {word}") };
            assert!(message.starts_with("x.npy ") && message.contains(word), "{message}");
        }
    }
}
