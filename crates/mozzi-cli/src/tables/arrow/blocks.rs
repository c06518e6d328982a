//! The offsets and lengths of an Arrow file, compared with its size before the reader follows them.
//!
//! A file is the magic bytes, blocks, a footer that lists the blocks, and the footer's length. A block is a message (a
//! flatbuffer that lists buffers) and a body (the buffers). A compressed buffer begins with its unpacked length.

use crate::tables::bound::Unpacked;
use arrow_ipc::{Block, CompressionType, Footer, Message, RecordBatch, root_as_footer, root_as_message};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};

type Checked<T> = Result<T, String>;

const MAGIC: &[u8; 6] = b"ARROW1";
/// Bytes at the end: the footer's length and the magic bytes.
const END: u64 = 10;
const CONTINUATION: [u8; 4] = [0xff; 4];
/// The unpacked length of a buffer that is not compressed.
const PLAIN: i64 = -1;

/// Checks that all parts are inside of the file, and that the unpacked size is acceptable.
pub fn check(file: &mut File) -> Checked<()> {
    let length = file.seek(SeekFrom::End(0)).map_err(said)?;
    let start = bytes(file, 0, length.min(8))?;
    if !start.starts_with(MAGIC) {
        return Err(match start.get(..4) {
            Some(b"FEA1") => "it is a Feather file of version 1, expected version 2 (ARROW1)".into(),
            Some(&[0xff, 0xff, 0xff, 0xff]) => "it is an Arrow stream, expected an Arrow file (ARROW1)".into(),
            _ => "it does not begin with ARROW1".into(),
        });
    }
    let end = length.checked_sub(END).ok_or("it ends inside its header")?;
    let tail = bytes(file, end, END)?;
    if tail.get(4..) != Some(MAGIC) {
        return Err("it does not end with ARROW1; it may be cut off".into());
    }
    let footer = u64::try_from(int32(&tail)).ok().and_then(|footer| end.checked_sub(footer));
    let begin = footer.ok_or("its footer is longer than the file")?;
    let footer = bytes(file, begin, end - begin)?;
    let footer = root_as_footer(&footer).map_err(|error| format!("its footer is damaged: {error:?}"))?;
    blocks(file, &footer, begin, length)
}

/// Checks the blocks. They do not overlap: together they are not longer than the file.
fn blocks(file: &mut File, footer: &Footer, end: u64, length: u64) -> Checked<()> {
    let (mut left, mut unpacked) = (end, Unpacked::of(length));
    let (dictionaries, batches) = (footer.dictionaries(), footer.recordBatches());
    for block in dictionaries.into_iter().flatten().chain(batches.into_iter().flatten()) {
        let place = Place::of(block, end).ok_or("a block is outside of the file")?;
        left = left.checked_sub(place.message + place.body).ok_or("its blocks overlap")?;
        let message = bytes(file, place.at, place.message)?;
        let message = match message.strip_prefix(&CONTINUATION) {
            Some(rest) => rest.get(4..),
            None => message.get(4..),
        };
        let message = root_as_message(message.ok_or("a message is cut off")?);
        let message = message.map_err(|error| format!("a message is damaged: {error:?}"))?;
        let batch = batch(&message).ok_or("a block holds no rows")?;
        buffers(file, &batch, &place, &mut unpacked)?;
    }
    Ok(())
}

/// The place of a block, in bytes.
struct Place {
    at: u64,
    message: u64,
    body: u64,
}

impl Place {
    fn of(block: &Block, end: u64) -> Option<Self> {
        let (at, body) = (u64::try_from(block.offset()).ok()?, u64::try_from(block.bodyLength()).ok()?);
        let message = u64::try_from(block.metaDataLength()).ok()?;
        let last = at.checked_add(message)?.checked_add(body)?;
        (last <= end).then_some(Place { at, message, body })
    }
}

fn batch<'m>(message: &Message<'m>) -> Option<RecordBatch<'m>> {
    let dictionary = || message.header_as_dictionary_batch().and_then(|dictionary| dictionary.data());
    message.header_as_record_batch().or_else(dictionary)
}

/// Checks the buffers, which do not overlap either, and lie in the body.
fn buffers(file: &mut File, batch: &RecordBatch, place: &Place, unpacked: &mut Unpacked) -> Checked<()> {
    let outside = "a buffer is outside of its block";
    let codec = batch.compression().map(|compression| compression.codec());
    if codec == Some(CompressionType::ZSTD) {
        return Err("it is compressed by zstd, which mozzi does not read; write it with LZ4 or without compression: \
                    in pandas df.to_feather(file, compression=\"lz4\"), in polars df.write_ipc(file, compression=\"lz4\")"
            .into());
    }
    let mut left = place.body;
    for buffer in batch.buffers().into_iter().flatten() {
        let (offset, length) = (u64::try_from(buffer.offset()), u64::try_from(buffer.length()));
        let (Ok(offset), Ok(length)) = (offset, length) else { return Err(outside.into()) };
        if offset.checked_add(length).is_none_or(|last| last > place.body) {
            return Err(outside.into());
        }
        left = left.checked_sub(length).ok_or("its buffers overlap")?;
        if codec.is_some() && length > 0 {
            let start = bytes(file, place.at + place.message + offset, length.min(8))?;
            let found = i64::from_le_bytes(start.try_into().map_err(|_| "a compressed buffer is cut off")?);
            if found != PLAIN {
                let found = u64::try_from(found).map_err(|_| "the length of a compressed buffer is negative")?;
                unpacked.take(found)?;
            }
        }
    }
    let rows = u64::try_from(batch.length()).map_err(|_| "a block has a negative number of rows")?;
    let is_negative = |node: &arrow_ipc::FieldNode| node.length() < 0 || node.null_count() < 0;
    match batch.nodes().into_iter().flatten().any(is_negative) {
        true => Err(format!("a column of a block of {rows} rows has a negative length")),
        false => Ok(()),
    }
}

/// Bytes of the file; the caller checks that they exist.
fn bytes(file: &mut File, at: u64, count: u64) -> Checked<Vec<u8>> {
    let mut found = Vec::new();
    file.seek(SeekFrom::Start(at)).map_err(said)?;
    file.take(count).read_to_end(&mut found).map_err(said)?;
    Ok(found)
}

fn int32(bytes: &[u8]) -> i32 {
    bytes.first_chunk().copied().map_or(-1, i32::from_le_bytes)
}

fn said(error: std::io::Error) -> String {
    error.to_string()
}
