//! Kernels compiled by g++ and run on the host, a warp's threads as threads of the system.

use mozzi_engine::{CudaLayout, Precision};
use mozzi_gpu::Source;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// The parts of CUDA that the texts use.
const HOST: &str = include_str!("../../../mozzi-engine/tests/harness/cuda_host.hpp");

/// Arrays from and to the test.
const ARRAYS: &str = r#"
template <class T> static std::vector<T> get(size_t n) {
    std::vector<T> x(n);
    if (fread(x.data(), sizeof(T), n, stdin) != n) exit(3);
    return x;
}
template <class T> static void put(const std::vector<T> &x) {
    if (fwrite(x.data(), sizeof(T), x.size(), stdout) != x.size()) exit(4);
}
"#;

/// A kernel, its input arrays in its layout, and what a rollout has besides.
pub struct Call {
    pub source: Source,
    pub inputs: Vec<Vec<f64>>,
    pub states: usize,
    pub rollout: Option<Rollout>,
}

/// Arrays between the inputs and the outputs, rows of the outputs, and arguments between the outputs and the number of
/// states.
pub struct Rollout {
    pub arrays: Vec<Vec<f64>>,
    pub rows: usize,
    pub arguments: String,
}

impl Call {
    fn rows(&self) -> usize {
        self.rollout.as_ref().map_or(1, |rollout| rollout.rows)
    }

    /// All arrays that the program reads.
    fn arrays(&self) -> impl Iterator<Item = &Vec<f64>> {
        self.inputs.iter().chain(self.rollout.iter().flat_map(|rollout| &rollout.arrays))
    }
}

/// True if there is a compiler of C++20.
pub fn exists() -> bool {
    let found = Command::new("g++").arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok();
    if !found {
        eprintln!("skipped: no g++ here");
    }
    found
}

fn number(source: &Source) -> &'static str {
    if source.form().precision == Precision::F64 { "double" } else { "float" }
}

/// The output arrays of each call, in its layout.
pub fn run(name: &str, calls: &[Call]) -> Vec<Vec<Vec<f64>>> {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    let (mut main, mut body) = (format!("{HOST}{ARRAYS}"), String::new());
    for (k, call) in calls.iter().enumerate() {
        let (source, states) = (&call.source, call.states);
        // a function of C has one name in all namespaces
        std::fs::write(folder.join(format!("{k}.cu")), source.text().replace("extern \"C\"", "static"))
            .expect("a file");
        let mut only = vec![if source.form().layout == CudaLayout::Rows { "ROWS" } else { "COLUMNS" }];
        if call.rollout.is_some() {
            only = vec!["ROWS", "COLUMNS"];
        }
        only.iter().for_each(|only| main += &format!("#define MOZZI_ONLY_{only}\n"));
        main += &format!("namespace k{k} {{\n#include \"{k}.cu\"\n}}\n");
        only.iter().for_each(|only| main += &format!("#undef MOZZI_ONLY_{only}\n"));
        let (number, mut arguments) = (number(source), String::new());
        body += "    {\n";
        for (i, input) in call.arrays().enumerate() {
            body += &format!("        auto x{i} = get<{number}>({});\n", input.len());
            arguments += &if input.is_empty() { "nullptr, ".to_string() } else { format!("x{i}.data(), ") };
        }
        for (i, output) in source.outputs().iter().enumerate() {
            body += &format!("        std::vector<{number}> y{i}({});\n", output.length * states * call.rows());
            arguments += &format!("y{i}.data(), ");
        }
        arguments += call.rollout.as_ref().map_or("", |rollout| &rollout.arguments);
        let of_thread = source.states_of_thread().min(3); // the last threads have fewer
        body += &format!(
            "        launch([&] {{ k{k}::{}({arguments}{states}); }}, {states}, {of_thread});\n",
            source.entry()
        );
        (0..source.outputs().len()).for_each(|i| body += &format!("        put(y{i});\n"));
        body += "    }\n";
    }
    main += &format!("int main()\n{{\n{body}}}\n");
    std::fs::write(folder.join("main.cpp"), main).expect("a file");
    let flags = ["-std=c++20", "-pthread", "-O0", "-w", "main.cpp", "-o", "main"];
    let output = Command::new("g++").args(flags).current_dir(&folder).output().expect("a compiler");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));

    let bytes: Vec<u8> =
        calls.iter().flat_map(|call| call.arrays().flatten().flat_map(|&x| to_bytes(x, call))).collect();
    let piped = || Stdio::piped();
    let mut child = Command::new(folder.join("main")).stdin(piped()).stdout(piped()).spawn().expect("a program");
    let mut input = child.stdin.take().expect("a pipe");
    let writer = std::thread::spawn(move || input.write_all(&bytes));
    let output = child.wait_with_output().expect("an end");
    writer.join().expect("a writer").expect("all was read");
    assert!(output.status.success(), "{}", output.status);
    let mut rest = &output.stdout[..];
    let mut array = |length: usize, source: &Source| -> Vec<f64> {
        let size = if source.form().precision == Precision::F64 { 8 } else { 4 };
        let (bytes, after) = rest.split_at(length * size);
        rest = after;
        bytes.chunks_exact(size).map(from_bytes).collect()
    };
    let results = calls
        .iter()
        .map(|call| {
            call.source.outputs().iter().map(|x| array(x.length * call.states * call.rows(), &call.source)).collect()
        })
        .collect();
    assert!(rest.is_empty());
    results
}

fn to_bytes(x: f64, call: &Call) -> Vec<u8> {
    match call.source.form().precision {
        Precision::F64 => x.to_ne_bytes().to_vec(),
        Precision::F32 => (x as f32).to_ne_bytes().to_vec(),
    }
}

fn from_bytes(bytes: &[u8]) -> f64 {
    match bytes.try_into() {
        Ok(eight) => f64::from_ne_bytes(eight),
        Err(_) => f32::from_ne_bytes(bytes.try_into().expect("four or eight bytes")).into(),
    }
}
