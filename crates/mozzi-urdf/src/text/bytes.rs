//! From bytes to text: size and encoding.

use crate::report::finding::{Finding, Findings};

/// Larger files are refused unread.
pub(crate) const MOST_BYTES: usize = 64 << 20;

/// How files of other formats begin, what they are, and what to do.
const OTHERS: [(&[u8], &str, &str); 5] = [
    (b"#usda", "USD (Universal Scene Description)", EXPORT),
    (b"PXR-USDC", "binary USD (Universal Scene Description)", EXPORT),
    (b"PK\x03\x04", "a zip archive, such as .usdz", "unpack it; USD is not read: export URDF or MJCF"),
    (b"SQLite format 3", "an SQLite database, such as a bag of ROS 2", "name the robot's file"),
    (b"{", "JSON", "mozzi's own JSON is read from a file whose name ends in .json"),
];
const EXPORT: &str = "USD is not read: export URDF or MJCF from the program that wrote it; `nvidia-srl-usd-to-urdf` (PyPI) \
                      makes a URDF of it";

/// The text without its byte order mark, or the error and the part of the text that can be shown.
pub(crate) fn to_text(bytes: &[u8]) -> Result<&str, (&str, Finding)> {
    if bytes.len() > MOST_BYTES {
        let message = format!("the file has {} bytes, expected at most {MOST_BYTES}", bytes.len());
        return Err(("", Finding::error("too_large", 0..0, message)));
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        let message = "the file is encoded as UTF-16, expected UTF-8".to_string();
        let help = "save it as UTF-8";
        return Err(("", Finding::error("not_utf8", 0..0, message).help(help)));
    }
    if let Some((_, what, help)) = OTHERS.iter().find(|(start, ..)| bytes.starts_with(start)) {
        let message = format!("the file is {what}, expected URDF, xacro, MJCF or SDFormat");
        return Err(("", Finding::error("wrong_root", 0..0, message).help(*help)));
    }
    let file = bytes;
    let bytes = file.strip_prefix(&[0xef, 0xbb, 0xbf]).unwrap_or(file);
    std::str::from_utf8(bytes).map_err(|error| {
        let at = error.valid_up_to();
        let good = std::str::from_utf8(&bytes[..at]).unwrap_or_default();
        // counted as in a byte editor: a byte order mark is three bytes
        let offset = at + file.len() - bytes.len();
        let message = format!("byte {offset} of the file is {:#04x}, which is not UTF-8", bytes[at]);
        let help = "save the file as UTF-8; convert a file that declares another encoding";
        (good, Finding::error("not_utf8", at..at, message).help(help))
    })
}

/// As [`to_text`]; an error is added to the findings, and the part of the text that can be shown is returned.
pub(crate) fn read<'b>(bytes: &'b [u8], findings: &mut Findings) -> &'b str {
    match to_text(bytes) {
        Ok(text) => text,
        Err((shown, finding)) => {
            findings.add(finding);
            shown
        }
    }
}
