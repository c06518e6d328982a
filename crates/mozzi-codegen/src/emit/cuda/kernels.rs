//! The kernels of a function: many states, a thread each, by rows or by columns.
//!
//! Neighbouring threads should read neighbouring numbers. By columns they do. By rows, each warp copies the rows of its
//! 32 states to shared memory as they lie, and its threads read their own row there: rows of an even length get a
//! number of padding, so that the threads' rows begin in different banks. Outputs return the same way.

use super::super::Precision;
use super::super::body;
use super::super::dialect::{Argument, Emitted, Source};
use super::Cuda;
use crate::program::{Program, Step};

/// Order of the numbers of many states.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CudaLayout {
    /// Entry k of state i at `i · length + k`: arrays (N, length) by rows.
    Rows,
    /// Entry k of state i at `k · N + i`: a structure of arrays.
    Columns,
}

impl CudaLayout {
    /// The end of a kernel's name: `rows` or `columns`.
    pub fn name(self) -> &'static str {
        match self {
            CudaLayout::Rows => "rows",
            CudaLayout::Columns => "columns",
        }
    }
}

/// The block of a kernel: how many threads it may have, and which arrays pass through shared memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// The largest number of threads, a multiple of 32; smaller multiples of 32 are allowed.
    pub threads: usize,
    /// For each input, then each output: whether its rows pass through shared memory.
    pub is_staged: Vec<bool>,
    /// Bytes of shared memory.
    pub shared_bytes: usize,
}

/// Shared memory that a kernel may have without asking the driver for more.
const SHARED_BYTES: usize = 48 * 1024;

/// A thread's state.
const STATE: &str = "    const unsigned long long i = (unsigned long long) blockIdx.x * blockDim.x + threadIdx.x;";

impl Block {
    /// The block of a program's kernel. Rows that do not fit into shared memory with 32 threads, the longest first, are
    /// read and written in place.
    pub fn of(program: &Program, layout: CudaLayout, precision: Precision) -> Block {
        let is_read = |k: usize| program.steps.iter().any(|step| matches!(step, Step::Input(a, _) if *a as usize == k));
        let inputs = program.inputs.iter().enumerate().map(|(k, x)| if is_read(k) { x.length } else { 0 });
        let lengths: Vec<usize> = inputs.chain(program.outputs.iter().map(|output| output.values.len())).collect();
        let mut is_staged: Vec<bool> = lengths.iter().map(|&n| layout == CudaLayout::Rows && n > 1).collect();
        loop {
            let staged = || lengths.iter().zip(&is_staged).filter(|(_, is_staged)| **is_staged).map(|(n, _)| *n);
            let of_thread = staged().map(padded).sum::<usize>() * if precision.is_f64() { 8 } else { 4 };
            if let Some(threads) = [128, 64, 32].into_iter().find(|threads| threads * of_thread <= SHARED_BYTES) {
                return Block { threads, is_staged, shared_bytes: threads * of_thread };
            }
            let longest = staged().max();
            let at = (0..lengths.len()).find(|&k| is_staged[k] && Some(lengths[k]) == longest);
            at.into_iter().for_each(|k| is_staged[k] = false);
        }
    }
}

/// An odd number of entries: 32 rows then begin in 32 banks.
fn padded(length: usize) -> usize {
    length | 1
}

/// How results are stored. By columns the address is computed for this one store: compilers would otherwise share
/// offsets between arrays and keep hundreds of them in registers.
pub(super) fn put(cuda: &Cuda) -> Vec<String> {
    let (number, prefix) = (cuda.c.number(), cuda.prefix);
    let (bits, constraint) = if cuda.is_f64() { (64, 'd') } else { (32, 'f') };
    vec![format!(
        "\n// Entry k of a result; columns are in global memory.\ntemplate <bool columns, unsigned k>\nstatic __device__ \
         __forceinline__ void {prefix}_put({number} *__restrict__ to, const unsigned long long stride, const {number} \
         x)\n{{\n#ifdef __CUDA_ARCH__\n    if (columns) {{\n        asm volatile(\"{{ .reg .u64 a; mad.wide.u32 a, %1, %2, %0; \
         st.global.f{bits} [a], %3; }}\"\n            :: \"l\"(__cvta_generic_to_global(to)), \"r\"((unsigned) stride), \
         \"n\"(k * (unsigned) sizeof x), \"{constraint}\"(x));\n        return;\n    }}\n#endif\n    to[k * stride] = x;\n}}"
    )]
}

/// The copies of rows to and from shared memory that the kernels call.
pub(super) fn copies(source: &Source, cuda: &Cuda) -> Vec<String> {
    let is_staged = |function: &Emitted| {
        let block = Block::of(function.program, CudaLayout::Rows, source.precision);
        block.is_staged.contains(&true)
    };
    if !source.functions.iter().any(is_staged) {
        return Vec::new();
    }
    let (number, prefix) = (cuda.c.number(), cuda.prefix);
    let copy = |name: &str, about: &str, assignment: &str| {
        format!(
            "\n// {about}\ntemplate <unsigned length>\nstatic __device__ __forceinline__ void {prefix}_{name}(\n    \
             const {number} *__restrict__ from, {number} *__restrict__ to, const unsigned states, const unsigned lane)\n\
             {{\n#pragma unroll\n    for (unsigned k = 0; k < length; ++k) {{\n        const unsigned j = lane + 32u * k;\n        \
             const unsigned at = length % 2 ? j : j + j / length;\n        \
             if (j < states * length) {assignment};\n    }}\n}}"
        )
    };
    vec![
        "\n#ifndef MOZZI_ONLY_COLUMNS".to_string(),
        copy("fetch", "Rows of a warp's states, to shared memory.", "to[at] = from[j]"),
        copy("store", "Rows of a warp's states, from shared memory.", "to[j] = from[at]"),
        "#endif".to_string(),
    ]
}

/// The function of one state, and its kernels.
pub(super) fn lines(function: &Emitted, cuda: &Cuda) -> Vec<String> {
    let (number, name) = (cuda.c.number(), format!("{}_{}", cuda.prefix, function.name));
    let pointer = |before: &str, argument: &Argument| format!("{before}{number} *__restrict__ {}", argument.name);
    let inputs = function.inputs.iter().map(|input| pointer("const ", input));
    let arguments: Vec<String> = inputs.chain(function.outputs.iter().map(|output| pointer("", output))).collect();
    let arguments = arguments.join(", ");
    let mut lines = vec![String::new()];
    lines.extend(function.lines().iter().map(|line| format!("// {line}")));
    lines.push("// Of one state: entry k of an array is at k * stride; columns have a stride below 2^32.".to_string());
    lines.push(format!(
        "template <bool columns>\nstatic __device__ __forceinline__ void {name}({arguments}, const unsigned long long stride)\n{{"
    ));
    lines.extend(function.unused().map(|input| format!("    (void) {};", input.name)));
    lines.extend(body::lines(function, cuda).iter().map(|line| format!("    {line}")));
    lines.push("}".to_string());
    let head = |layout: CudaLayout, threads: usize| {
        format!(
            "extern \"C\" __global__ void __launch_bounds__({threads})\n{name}_{}({arguments}, const unsigned long long \
             count)\n{{",
            layout.name()
        )
    };
    rows(function, cuda, &name, head, &mut lines);
    columns(function, cuda, &name, head, &mut lines);
    lines
}

fn columns(
    function: &Emitted,
    cuda: &Cuda,
    name: &str,
    head: impl Fn(CudaLayout, usize) -> String,
    lines: &mut Vec<String>,
) {
    let Block { threads, .. } = Block::of(function.program, CudaLayout::Columns, cuda.c.0);
    let arrays: String = arrays(function).map(|argument| format!("{} + i, ", argument.name)).collect();
    lines.push("\n#ifndef MOZZI_ONLY_ROWS".to_string());
    lines.push(format!(
        "// Of `count` states, a thread each: entry k of state i at k * count + i; blocks of at most {threads} threads."
    ));
    lines.push(head(CudaLayout::Columns, threads));
    lines.push(STATE.to_string());
    lines.push(format!("    if (i < count) {name}<true>({arrays}count);\n}}\n#endif"));
}

fn rows(
    function: &Emitted,
    cuda: &Cuda,
    name: &str,
    head: impl Fn(CudaLayout, usize) -> String,
    lines: &mut Vec<String>,
) {
    let Block { threads, is_staged, .. } = Block::of(function.program, CudaLayout::Rows, cuda.c.0);
    let (number, prefix) = (cuda.c.number(), cuda.prefix);
    let staged: Vec<(&Argument, bool)> = arrays(function).zip(is_staged).collect();
    let is_input = |k: usize| k < function.inputs.len();
    let of_thread: usize = staged.iter().filter(|(_, is_staged)| *is_staged).map(|(x, _)| padded(x.length)).sum();
    lines.push("\n#ifndef MOZZI_ONLY_COLUMNS".to_string());
    lines.push(
        "// Of `count` states, a thread each: entry k of state i at i * length + k; blocks of a multiple of".into(),
    );
    lines.push(format!("// 32 threads, at most {threads}."));
    lines.push(head(CudaLayout::Rows, threads));
    if of_thread == 0 {
        lines.push(STATE.to_string());
        let arrays: String = staged.iter().map(|(x, _)| format!("{0} + i * {1}, ", x.name, x.length)).collect();
        lines.push(format!("    if (i < count) {name}<false>({arrays}1);\n}}\n#endif"));
        return;
    }
    lines.push(format!("    __shared__ {number} shared_[{threads} * {of_thread}];"));
    lines.push("    const unsigned lane_ = threadIdx.x % 32u;".to_string());
    lines
        .push("    // the warp's first state, the number of its states, and its part of the shared memory".to_string());
    lines.push(
        "    const unsigned long long first_ = (unsigned long long) blockIdx.x * blockDim.x + (threadIdx.x - lane_);"
            .to_string(),
    );
    lines.push(
        "    const unsigned states_ = first_ >= count ? 0u : count - first_ < 32u ? (unsigned) (count - first_) : 32u;"
            .to_string(),
    );
    lines.push(format!("    {number} *const warp_ = shared_ + (threadIdx.x - lane_) * {of_thread};"));
    let mut place = 0;
    for (x, _) in staged.iter().filter(|(_, is_staged)| *is_staged) {
        lines.push(format!("    {number} *const {}_ = warp_ + 32 * {place};", x.name));
        place += padded(x.length);
    }
    let copies = |of_inputs: bool| {
        let those =
            staged.iter().enumerate().filter(move |(k, (_, is_staged))| *is_staged && is_input(*k) == of_inputs);
        those.map(move |(_, (x, _))| match of_inputs {
            true => format!("    {prefix}_fetch<{1}>({0} + first_ * {1}, {0}_, states_, lane_);", x.name, x.length),
            false => format!("    {prefix}_store<{1}>({0}_, {0} + first_ * {1}, states_, lane_);", x.name, x.length),
        })
    };
    lines.extend(copies(true));
    lines.push("    __syncwarp();".to_string());
    let row = |(x, is_staged): &(&Argument, bool)| match is_staged {
        true => format!("{}_ + lane_ * {}, ", x.name, padded(x.length)),
        false => format!("{} + (first_ + lane_) * {}, ", x.name, x.length),
    };
    lines.push(format!("    if (lane_ < states_) {name}<false>({}1);", staged.iter().map(row).collect::<String>()));
    lines.push("    __syncwarp();".to_string());
    lines.extend(copies(false));
    lines.push("}\n#endif".to_string());
}

fn arrays<'e>(function: &'e Emitted) -> impl Iterator<Item = &'e Argument> {
    function.inputs.iter().chain(&function.outputs)
}
