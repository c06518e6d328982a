//! The header of a .npy file: a Python dictionary of type, order and shape.

use super::kind::Kind;
use std::io::Read;

/// The contents of an array.
#[derive(Debug, PartialEq)]
pub struct Header {
    pub shape: Vec<usize>,
    /// The first index varies fastest.
    pub by_columns: bool,
    /// The columns of a structured array, by name; one without a name for a plain array.
    pub fields: Vec<(String, Kind)>,
    pub is_structured: bool,
}

const MAGIC: &[u8] = b"\x93NUMPY";
/// A longer header is refused.
const LONGEST: usize = 16 << 20;

impl Header {
    /// Bytes of an entry.
    pub fn size(&self) -> usize {
        self.fields.iter().map(|(_, kind)| kind.size).sum()
    }

    /// Reads the beginning of a file; an error if it is not a header.
    pub fn read(from: &mut dyn Read) -> Result<Self, String> {
        let cut = |_| "it ends inside its header".to_string();
        let mut start = [0; 8];
        from.read_exact(&mut start[..6]).map_err(|_| NO_MAGIC)?;
        if start[..6] != *MAGIC {
            return Err(NO_MAGIC.to_string());
        }
        from.read_exact(&mut start[6..]).map_err(cut)?;
        let mut length = [0; 4];
        let width = match start[6] {
            1 => 2,
            2 | 3 => 4,
            version => return Err(format!("its version is {version}, expected 1, 2 or 3")),
        };
        from.read_exact(&mut length[..width]).map_err(cut)?;
        let length = u32::from_le_bytes(length) as usize;
        if length > LONGEST {
            return Err(format!("its header has {length} bytes, expected at most {LONGEST}"));
        }
        let mut text = Vec::new();
        from.take(length as u64).read_to_end(&mut text).map_err(|error| error.to_string())?;
        if text.len() < length {
            return Err(cut(std::io::ErrorKind::UnexpectedEof.into()));
        }
        Scanner(&String::from_utf8_lossy(&text)).dictionary()
    }
}

/// The error for a file of another format.
pub const NO_MAGIC: &str = "it does not begin with \\x93NUMPY";

/// The rest of the text.
struct Scanner<'h>(&'h str);

impl<'h> Scanner<'h> {
    fn dictionary(&mut self) -> Result<Header, String> {
        let whole = self.0.trim();
        let (mut fields, mut order, mut shape) = (None, None, None);
        let broken = |what: &str| format!("{what}: {whole}");
        if !self.eat('{') {
            return Err(broken("its header is not a dictionary"));
        }
        while let Some(key) = self.string() {
            if !self.eat(':') {
                return Err(broken("its header is not a dictionary"));
            }
            match key.as_str() {
                "descr" => fields = Some(self.kinds()?),
                "fortran_order" => order = Some(self.word()),
                "shape" => shape = Some(self.counts().ok_or_else(|| broken("its shape is not a tuple of numbers"))?),
                _ => return Err(broken(&format!("its header has an unknown key `{key}`"))),
            }
            if !self.eat(',') {
                break;
            }
        }
        let missing = |key: &str| broken(&format!("its header has no `{key}`"));
        let (fields, is_structured) = fields.ok_or_else(|| missing("descr"))?;
        let by_columns = match order.ok_or_else(|| missing("fortran_order"))? {
            "True" => true,
            "False" => false,
            _ => return Err(broken("its `fortran_order` is neither True nor False")),
        };
        Ok(Header { shape: shape.ok_or_else(|| missing("shape"))?, by_columns, fields, is_structured })
    }

    fn eat(&mut self, c: char) -> bool {
        self.0 = self.0.trim_start();
        let rest = self.0.strip_prefix(c);
        self.0 = rest.unwrap_or(self.0);
        rest.is_some()
    }

    fn word(&mut self) -> &'h str {
        let text = self.0.trim_start();
        let end = text.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(text.len());
        self.0 = &text[end..];
        &text[..end]
    }

    /// A string of Python, in either quotes.
    fn string(&mut self) -> Option<String> {
        self.0 = self.0.trim_start();
        let quote = self.0.chars().next().filter(|c| ['\'', '"'].contains(c))?;
        let (mut text, mut chars) = (String::new(), self.0[1..].chars());
        loop {
            match chars.next()? {
                c if c == quote => break,
                '\\' => text.push(match chars.next()? {
                    'n' => '\n',
                    't' => '\t',
                    'r' => '\r',
                    'x' => code(&mut chars, 2)?,
                    'u' => code(&mut chars, 4)?,
                    'U' => code(&mut chars, 8)?,
                    other => other,
                }),
                c => text.push(c),
            }
        }
        self.0 = chars.as_str();
        Some(text)
    }

    /// "(3, 2)"
    fn counts(&mut self) -> Option<Vec<usize>> {
        let mut counts = Vec::new();
        if !self.eat('(') {
            return None;
        }
        while !self.eat(')') {
            counts.push(self.word().parse().ok()?);
            if !self.eat(',') && !self.0.starts_with(')') {
                return None;
            }
        }
        Some(counts)
    }

    /// One type, or names with their types: "[('t', '<f8'), …]".
    fn kinds(&mut self) -> Result<(Vec<(String, Kind)>, bool), String> {
        let known = |name: &str| {
            let expected = "expected float64, float32 or integers";
            Kind::of(name).ok_or_else(|| format!("it has numbers of type {name}, {expected}"))
        };
        if let Some(name) = self.string() {
            return Ok((vec![(String::new(), known(&name)?)], false));
        }
        let mut fields = Vec::new();
        let broken = || "its type is no list of names and types of numbers".to_string();
        if !self.eat('[') {
            return Err(broken());
        }
        while self.eat('(') {
            let (name, _, kind) = (self.string(), self.eat(','), self.string());
            let (Some(name), Some(kind), true) = (name, kind, self.eat(')')) else { return Err(broken()) };
            fields.push((name, known(&kind)?));
            self.eat(',');
        }
        if self.eat(']') && !fields.is_empty() { Ok((fields, true)) } else { Err(broken()) }
    }
}

fn code(chars: &mut std::str::Chars, digits: usize) -> Option<char> {
    let (hex, rest) = chars.as_str().split_at_checked(digits)?;
    *chars = rest.chars();
    char::from_u32(u32::from_str_radix(hex, 16).ok()?)
}

/// A string as Python writes it.
pub fn quoted(text: &str) -> String {
    let escape = |c: char| match c {
        '\'' | '\\' => format!("\\{c}"),
        c if c.is_control() => format!("\\x{:02x}", u32::from(c)),
        c => c.to_string(),
    };
    format!("'{}'", text.chars().map(escape).collect::<String>())
}

/// Digits reserved for the first number of a shape, so that the length of the header does not depend on it.
const ROWS: usize = 20;

/// The bytes before the numbers, as `numpy.save` writes them, for a type and a shape as texts; numbers begin at a
/// multiple of 64 bytes.
pub fn write(descr: &str, rows: Option<usize>, shape: &str) -> Vec<u8> {
    let mut header = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}");
    let room = ROWS - rows.map_or(ROWS, |rows| rows.to_string().len());
    header.extend(std::iter::repeat_n(' ', room));
    // version 1 has a header length of two bytes, and its text is ASCII as in 2; that of 3 is UTF-8
    let is_short = header.len() < usize::from(u16::MAX) - 128;
    let version = if !header.is_ascii() {
        3
    } else if is_short {
        1
    } else {
        2
    };
    let before = MAGIC.len() + if version == 1 { 4 } else { 6 };
    while !(before + header.len() + 1).is_multiple_of(64) {
        header.push(' ');
    }
    header.push('\n');
    let length = (header.len() as u32).to_le_bytes();
    let length = if version == 1 { &length[..2] } else { &length[..] };
    [MAGIC, &[version, 0], length, header.as_bytes()].concat()
}
