//! Reads tables of SQLite files, as rosbag2 writes them: rows in the order of their keys, page by page
//! (<https://www.sqlite.org/fileformat2.html>). Nothing is written, indices are not used.

mod record;
mod varint;

use mozzi_urdf::files;
use record::Record;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;
use varint::varint;

/// The first bytes of every file.
const MAGIC: &[u8; 16] = b"SQLite format 3\0";

/// Deeper trees are damaged: each level has at least two pages below.
const DEEPEST: usize = 40;

/// A value of a row.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Null,
    Integer(i64),
    Real(f64),
    Text(String),
    Blob(Vec<u8>),
}

impl Value {
    pub fn integer(&self) -> Option<i64> {
        if let Value::Integer(x) = self { Some(*x) } else { None }
    }

    pub fn text(&self) -> Option<&str> {
        if let Value::Text(text) = self { Some(text) } else { None }
    }
}

/// Why a file is not read.
type Fails<T> = Result<T, String>;

/// A file whose pages are read when they are needed.
pub struct Database {
    file: File,
    page_size: usize,
    /// Bytes of a page that hold content.
    usable: usize,
    pages: u64,
}

/// A table: the number of its first page, and the names of its columns.
pub struct Table {
    root: u64,
    columns: Vec<String>,
    /// The column that is the row's key, which rows do not repeat.
    key: Option<usize>,
}

impl Table {
    /// The index of a column.
    pub fn column(&self, name: &str) -> Fails<usize> {
        let found = self.columns.iter().position(|column| column == name);
        found.ok_or_else(|| {
            format!("its table has no column `{name}`, expected one; it has {}", self.columns.join(", "))
        })
    }
}

impl Database {
    /// Opens a file; one whose changes wait in a write-ahead log is refused.
    pub fn open(path: &str) -> Fails<Self> {
        let mut file = files::open(Path::new(path)).map_err(|error| error.to_string())?;
        let length = file.metadata().map_err(|error| error.to_string())?.len();
        let mut header = [0; 100];
        file.read_exact(&mut header).map_err(|_| "it is no SQLite file: it is too short".to_string())?;
        if &header[..16] != MAGIC {
            return Err("it is no SQLite file: it does not begin with `SQLite format 3`".into());
        }
        let page_size = match u16::from_be_bytes([header[16], header[17]]) {
            1 => 65536,
            size => usize::from(size),
        };
        let usable = page_size.saturating_sub(usize::from(header[20]));
        if !page_size.is_power_of_two() || page_size < 512 || usable < 480 {
            return Err(format!("its pages have {page_size} bytes, expected a power of two from 512"));
        }
        if header[56..60] != [0, 0, 0, 1] {
            return Err("its texts are UTF-16, expected UTF-8".into());
        }
        if std::fs::metadata(format!("{path}-journal")).is_ok_and(|journal| journal.len() > 0) {
            return Err(format!(
                "{path}-journal is there: its last transaction was not finished; `sqlite3 {path} 'PRAGMA user_version'` rolls \
                 it back"
            ));
        }
        if std::fs::metadata(format!("{path}-wal")).is_ok_and(|log| log.len() > 0) {
            return Err(format!(
                "{path}-wal holds changes that are not in it yet; `sqlite3 {path} 'PRAGMA wal_checkpoint(TRUNCATE)'` \
                 writes them"
            ));
        }
        Ok(Database { file, page_size, usable, pages: length / page_size as u64 })
    }

    fn page(&mut self, number: u64) -> Fails<Vec<u8>> {
        if number == 0 || number > self.pages {
            return Err(format!("it is damaged: page {number} is named, and it has {}", self.pages));
        }
        let mut page = vec![0; self.page_size];
        let start = (number - 1) * self.page_size as u64;
        let read = self.file.seek(SeekFrom::Start(start)).and_then(|_| self.file.read_exact(&mut page));
        read.map_err(|error| format!("page {number} cannot be read: {error}"))?;
        Ok(page)
    }

    /// A table by its name.
    pub fn table(&mut self, name: &str) -> Fails<Table> {
        let schema = Table {
            root: 1,
            columns: ["type", "name", "tbl_name", "rootpage", "sql"].map(String::from).to_vec(),
            key: None,
        };
        let mut found = None;
        self.rows(&schema, |row| {
            let values = [row.value(0)?, row.value(1)?, row.value(3)?];
            if values[0].text() == Some("table") && values[1].text() == Some(name) {
                let root = values[2].integer().and_then(|root| u64::try_from(root).ok()).unwrap_or_default();
                let definition = row.value(4)?.text().unwrap_or_default().to_string();
                if definition.to_lowercase().split_whitespace().collect::<Vec<_>>().join(" ").contains("without rowid")
                {
                    return Err(format!(
                        "its table `{name}` is WITHOUT ROWID, expected a table with row numbers, as rosbag2 writes"
                    ));
                }
                let (columns, key) = columns(&definition);
                found = Some(Table { root, columns, key });
            }
            Ok(())
        })?;
        found.ok_or_else(|| format!("it has no table `{name}`, expected a bag of rosbag2"))
    }

    /// Calls `each` with every row, in the order of keys.
    pub fn rows(&mut self, table: &Table, mut each: impl FnMut(&mut Row<'_>) -> Fails<()>) -> Fails<()> {
        // pages to read, those of later keys first; each page belongs to one tree
        let (mut open, mut read) = (vec![(table.root, 0)], 0);
        let whole = self.pages * self.page_size as u64;
        let mut content: u64 = 0;
        while let Some((number, depth)) = open.pop() {
            read += 1;
            if read > self.pages || depth > DEEPEST {
                return Err("it is damaged: its pages name each other in a circle".into());
            }
            let page = self.page(number)?;
            let damaged = || format!("it is damaged: page {number} is no page of a table");
            let at = if number == 1 { 100 } else { 0 };
            let short =
                |k: usize| page.get(k..k + 2).map(|bytes| usize::from(u16::from_be_bytes([bytes[0], bytes[1]])));
            let cells = short(at + 3).ok_or_else(damaged)?;
            let head = match page[at] {
                0x05 => 12,
                0x0d => 8,
                _ => return Err(damaged()),
            };
            let mut places = Vec::with_capacity(cells.min(self.page_size));
            for k in 0..cells {
                places.push(short(at + head + 2 * k).filter(|&place| place < self.usable).ok_or_else(damaged)?);
            }
            let child = |k: usize| page.get(k..k + 4).map(|b| u64::from(u32::from_be_bytes([b[0], b[1], b[2], b[3]])));
            if page[at] == 0x05 {
                open.push((child(at + 8).ok_or_else(damaged)?, depth + 1));
                for &place in places.iter().rev() {
                    open.push((child(place).ok_or_else(damaged)?, depth + 1));
                }
                continue;
            }
            for place in places {
                let cell = page.get(place..self.usable).ok_or_else(damaged)?;
                let (length, more) = varint(cell).ok_or_else(damaged)?;
                let (key, further) = varint(&cell[more..]).ok_or_else(damaged)?;
                let length =
                    usize::try_from(length).ok().filter(|&length| length as u64 <= self.pages * self.page_size as u64);
                let length = length.ok_or_else(damaged)?;
                content += length as u64;
                if content > whole {
                    return Err("it is damaged: its cells overlap, so that its rows are longer than the file".into());
                }
                let local = self.local(length);
                let payload = cell.get(more + further..more + further + local).ok_or_else(damaged)?;
                let next = if local < length { child(place + more + further + local).ok_or_else(damaged)? } else { 0 };
                let record = Record::new(payload, length).ok_or_else(damaged)?;
                each(&mut Row {
                    database: &mut *self,
                    key,
                    table_key: table.key,
                    record,
                    local: payload.to_vec(),
                    length,
                    next,
                })?;
            }
        }
        Ok(())
    }

    /// How much of a payload is in its cell; the rest is in a chain of further pages.
    fn local(&self, length: usize) -> usize {
        let most = self.usable - 35;
        if length <= most {
            return length;
        }
        let least = (self.usable - 12) * 32 / 255 - 23;
        let fitting = least + (length - least) % (self.usable - 4);
        if fitting <= most { fitting } else { least }
    }
}

/// A row whose long values are read when they are needed.
pub struct Row<'d> {
    database: &'d mut Database,
    key: i64,
    table_key: Option<usize>,
    record: Record,
    /// The payload as far as it is known.
    local: Vec<u8>,
    length: usize,
    /// The page with the rest.
    next: u64,
}

impl Row<'_> {
    /// The value of a column; Null beyond the last one.
    pub fn value(&mut self, column: usize) -> Fails<Value> {
        if Some(column) == self.table_key {
            return Ok(Value::Integer(self.key));
        }
        let Some((kind, place)) = self.record.column(column) else { return Ok(Value::Null) };
        if place.end > self.local.len() {
            self.load()?;
        }
        let bytes = self.local.get(place).ok_or("it is damaged: a row is shorter than its values")?;
        record::value(kind, bytes).ok_or_else(|| "it is damaged: a text is not UTF-8".to_string())
    }

    /// Reads the rest of the payload.
    fn load(&mut self) -> Fails<()> {
        while self.local.len() < self.length {
            let page = self.database.page(self.next)?;
            self.next = u64::from(u32::from_be_bytes([page[0], page[1], page[2], page[3]]));
            let count = (self.length - self.local.len()).min(self.database.usable - 4);
            self.local.extend(&page[4..4 + count]);
        }
        Ok(())
    }
}

/// The names of a table's columns, and the one that is its key, from its definition.
fn columns(sql: &str) -> (Vec<String>, Option<usize>) {
    let inside = sql.split_once('(').map_or("", |(_, rest)| rest);
    let inside = inside.rsplit_once(')').map_or(inside, |(inside, _)| inside);
    let (mut parts, mut depth) = (vec![String::new()], 0);
    for c in inside.chars() {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        match (c, depth, parts.last_mut()) {
            (',', 0, _) => parts.push(String::new()),
            (_, _, Some(part)) => part.push(c),
            _ => {}
        }
    }
    const CONSTRAINTS: [&str; 5] = ["constraint", "primary", "unique", "check", "foreign"];
    let words = |part: &String| part.split_whitespace().map(str::to_lowercase).collect::<Vec<_>>();
    let parts: Vec<Vec<String>> = parts.iter().map(words).filter(|words| !words.is_empty()).collect();
    let parts: Vec<_> = parts.into_iter().filter(|words| !CONSTRAINTS.contains(&words[0].as_str())).collect();
    let is_key = |words: &Vec<String>| words.join(" ").contains("integer primary key");
    let key = parts.iter().position(is_key);
    (parts.into_iter().map(|words| words[0].trim_matches(['"', '`', '[', ']', '\'']).to_string()).collect(), key)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_read_from_the_definition() {
        let sql = "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, \
                   \"data\" BLOB NOT NULL, size DECIMAL(3, 1), FOREIGN KEY (topic_id) REFERENCES topics(id))";
        let names = ["id", "topic_id", "timestamp", "data", "size"].map(String::from).to_vec();
        assert_eq!(columns(sql), (names, Some(0)));
        assert_eq!(columns(""), (Vec::new(), None));
    }
}
