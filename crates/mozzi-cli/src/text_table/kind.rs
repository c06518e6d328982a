//! Files that are no tables of text, by their first bytes, and the way to convert them.

use crate::failure::{Failure, Result};
use std::io::Read;

/// Formats that are no text are named by their first bytes.
pub fn check_kind(file: &str) -> Result<()> {
    let mut first = [0; 20];
    let count = match std::fs::File::open(file) {
        Ok(mut opened) if opened.metadata().is_ok_and(|found| found.is_file()) => opened.read(&mut first).unwrap_or(0),
        _ => 0,
    };
    let wrong = |what: &str| Err(Failure::wrong(format!("{file} is {what}")));
    match &first[..count] {
        bytes if bytes.starts_with(b"#ROSBAG") => wrong(
            "a bag of ROS 1; `rosbags-convert --src FILE.bag --dst FOLDER` (pip install rosbags) writes one of ROS 2",
        ),
        bytes if bytes.starts_with(b"MATLAB ") => wrong(
            "a .mat file of MATLAB; `writetable(array2table(data, 'VariableNames', names), 'log.csv')` writes CSV, \
             `scipy.io.loadmat` reads it in Python",
        ),
        bytes if bytes.starts_with(b"\x89HDF") => wrong(
            "an HDF5 file (.h5, or .mat of version 7.3); `pandas.read_hdf(file).to_csv(\"log.csv\")` or h5py with \
             numpy.savez writes what is read here: .csv, .npz",
        ),
        bytes if bytes.starts_with(b"PK\x03\x04") => {
            wrong("a spreadsheet or another zip archive; save it as CSV, or name it .npz if NumPy wrote it")
        }
        bytes if bytes.starts_with(b"PAR1") => {
            wrong("a Parquet file; name it .parquet, or write CSV: df.to_csv(\"log.csv\")")
        }
        bytes if bytes.starts_with(b"SQLite format 3") => {
            wrong("a SQLite file; name it .db3 if it is a bag of rosbag2")
        }
        bytes if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) => {
            wrong("UTF-16 text; `iconv -f utf-16 -t utf-8` or \"CSV UTF-8\" in a spreadsheet writes what is read here")
        }
        bytes if bytes.starts_with(b"\x80\x04\x95") || bytes.starts_with(b"\x80\x05\x95") => {
            wrong("a pickle of Python, which is not read since it may run code; df.to_csv(\"log.csv\") writes CSV")
        }
        bytes if bytes.starts_with(b"\xfd7zXZ\0") => wrong("compressed by xz; `unxz` it first"),
        bytes if bytes.starts_with(b"\x28\xb5\x2f\xfd") => wrong("compressed by zstd; `unzstd` it first"),
        [0x1f, 0x8b, ..] => wrong("compressed by gzip; `gunzip` it first"),
        _ => Ok(()),
    }
}

/// JSON by its first characters.
pub fn check_json(name: &str, begin: &[u8]) -> Result<()> {
    let mut rest = begin.iter().enumerate().filter(|(_, byte)| !byte.is_ascii_whitespace());
    let lines = match (rest.next(), rest.next()) {
        (Some((_, b'[')), Some((_, b'{' | b'['))) => "",
        (Some((at, b'{')), _) => {
            let line = begin[at..].split(|&byte| byte == b'\n').next().unwrap_or_default().trim_ascii_end();
            if line.ends_with(b"}") { ", lines=True" } else { "" }
        }
        _ => return Ok(()),
    };
    let record = begin.split(|&byte| byte == b'}').next().unwrap_or_default();
    let is_nested = record.iter().filter(|&&byte| byte == b'{').count() > 1;
    let table = match is_nested {
        true => format!("pandas.json_normalize(pandas.read_json(\"{name}\"{lines}).to_dict(\"records\"))"),
        false => format!("pandas.read_json(\"{name}\"{lines})"),
    };
    Err(Failure::wrong(format!(
        "{name} is JSON, expected a table; in pandas: {table}.to_csv(\"log.csv\", index=False)"
    )))
}
