//! Tables in files, written and read by other code than the program's.

use arrow_array::{ArrayRef, Float64Array, RecordBatch};
use arrow_ipc::{reader::FileReader, writer::FileWriter};
use std::fs::File;
use std::io::{Read, Write};
use std::path::Path;

/// As `numpy.save` writes it, by rows or by columns.
pub fn npy(shape: &[usize], values: &[f64], by_columns: bool) -> Vec<u8> {
    let order = if by_columns { "True" } else { "False" };
    let tuple: String = shape.iter().map(|count| format!("{count}, ")).collect();
    let header = format!("{{'descr': '<f8', 'fortran_order': {order}, 'shape': ({tuple}), }}\n");
    let mut bytes = [b"\x93NUMPY\x01\x00", &(header.len() as u16).to_le_bytes()[..], header.as_bytes()].concat();
    values.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    bytes
}

pub fn save(folder: &Path, name: &str, bytes: &[u8]) -> String {
    let path = folder.join(name);
    std::fs::write(&path, bytes).expect("a file");
    path.to_str().expect("text").to_string()
}

pub fn npz(folder: &Path, name: &str, arrays: &[(&str, &[usize], &[f64])]) -> String {
    let path = folder.join(name);
    let mut archive = zip::ZipWriter::new(File::create(&path).expect("a file"));
    for (name, shape, values) in arrays {
        // compressed, as numpy.savez_compressed does
        let options = zip::write::SimpleFileOptions::default();
        archive.start_file(format!("{name}.npy"), options).expect("an entry");
        archive.write_all(&npy(shape, values, false)).expect("a file");
    }
    archive.finish().expect("an archive");
    path.to_str().expect("text").to_string()
}

/// Shape and numbers of an output file.
pub fn parse(bytes: &[u8]) -> (String, Vec<f64>) {
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let (header, data) = bytes[10..].split_at(length);
    let header = String::from_utf8(header.to_vec()).expect("text");
    let shape = header.split_once("'shape': ").expect("a shape").1.split(')').next().expect("an end").to_string() + ")";
    let values = match header.contains("'<f8'") {
        true => data.chunks_exact(8).map(|x| f64::from_le_bytes(x.try_into().expect("8"))).collect(),
        false => data.chunks_exact(4).map(|x| f32::from_le_bytes(x.try_into().expect("4")).into()).collect(),
    };
    (shape, values)
}

pub fn read_npz(path: &str) -> Vec<(String, String, Vec<f64>)> {
    let mut archive = zip::ZipArchive::new(File::open(path).expect("a file")).expect("an archive");
    (0..archive.len())
        .map(|index| {
            let mut entry = archive.by_index(index).expect("an entry");
            let name = entry.name().expect("a name").trim_end_matches(".npy").to_string();
            let mut bytes = Vec::new();
            entry.read_to_end(&mut bytes).expect("bytes");
            let (shape, values) = parse(&bytes);
            (name, shape, values)
        })
        .collect()
}

/// The columns of an array by rows.
pub fn to_columns(shape: &str, values: &[f64]) -> Vec<Vec<f64>> {
    let states: usize = shape.trim_start_matches('(').split([',', ')']).next().expect("N").parse().expect("a number");
    let width = values.len() / states;
    (0..width).map(|c| values.iter().skip(c).step_by(width).copied().collect()).collect()
}

pub fn write_arrow(folder: &Path, name: &str, columns: Vec<(&str, ArrayRef)>) -> String {
    let path = folder.join(name);
    let batch = RecordBatch::try_from_iter(columns).expect("columns");
    let mut writer = FileWriter::try_new(File::create(&path).expect("a file"), &batch.schema()).expect("a writer");
    writer.write(&batch).expect("a batch");
    writer.write(&batch.slice(0, 0)).expect("an empty batch");
    writer.finish().expect("an end");
    path.to_str().expect("text").to_string()
}

pub fn read_arrow(path: &str) -> Vec<(String, Vec<f64>)> {
    let mut reader = FileReader::try_new(File::open(path).expect("a file"), None).expect("arrow");
    let batch = reader.next().expect("a batch").expect("columns");
    let column = |k: usize| batch.column(k).as_any().downcast_ref::<Float64Array>().expect("floats").values().to_vec();
    batch.schema().fields().iter().enumerate().map(|(k, field)| (field.name().clone(), column(k))).collect()
}
