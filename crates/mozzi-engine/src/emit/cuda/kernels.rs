//! The kernels of a function: many states, a thread each, by rows or by columns.
//!
//! Neighbouring threads should read neighbouring numbers. By columns they do. By rows, each warp copies the rows of its
//! 32 states to shared memory as they lie, and its threads read their own row there: rows of an even length get a
//! number of padding, so that the threads' rows begin in different banks. Outputs return the same way; of those that
//! do not fit, only different entries are there, and the copy spreads them.
//!
//! By columns a thread goes through a long program in parts, each for several states: see [`parts`].

use super::super::body;
use super::super::dialect::{Argument, Emitted, Source};
use super::parts::{self, Part, parts};
use super::staging::{BY_COLUMNS, Block, Staging, plan};
use super::{Cuda, NONE};
use crate::program::Value;

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

/// Registers that run out go to shared memory first, which rows need, but not columns.
const SPILLED: &str = "#if defined __CUDA_ARCH__ && __CUDACC_VER_MAJOR__ >= 13
    asm volatile (\".pragma \\\"enable_smem_spilling\\\";\");
#endif";

/// A thread's number.
const THREAD: &str = "(unsigned long long) blockIdx.x * blockDim.x + threadIdx.x";

/// The stride of columns, where the compiler does not see that all threads have the same. It would compute addresses
/// in registers that all share, and add the thread's own in twice as many instructions. For short programs that is
/// faster nevertheless: others wait for the same units.
const STRIDE: &str = "    const unsigned long long stride_ = (unsigned) count + (threadIdx.x >> 31);";

/// How results are stored. By columns the address is computed for this one store: compilers would otherwise share
/// offsets between arrays and keep hundreds of them in registers.
pub(super) fn put(cuda: &Cuda) -> Vec<String> {
    let (number, prefix) = (cuda.c.number(), cuda.prefix);
    let (bits, constraint) = if cuda.is_f64() { (64, 'd') } else { (32, 'f') };
    vec![format!(
        "\n// Entry k of a result; columns are in global memory, rows may have other places, or none, for equal \
         entries.\ntemplate <bool columns, unsigned k, unsigned slot = k>\nstatic __device__ \
         __forceinline__ void {prefix}_put({number} *__restrict__ to, const unsigned long long stride, const {number} \
         x)\n{{\n#ifdef __CUDA_ARCH__\n    if (columns) {{\n        asm volatile(\"{{ .reg .u64 a; mul.wide.u32 a, %1, %2; \
         add.u64 a, a, %0; st.global.f{bits} [a], %3; }}\"\n            :: \"l\"(__cvta_generic_to_global(to)), \"r\"((unsigned) stride), \
         \"n\"(k * (unsigned) sizeof x), \"{constraint}\"(x));\n        return;\n    }}\n#endif\n#ifndef MOZZI_ONLY_COLUMNS\n    if (!columns && slot != k) {{\n        if (slot != \
         {NONE}u) to[slot * stride] = x;\n        return;\n    }}\n#endif\n    to[k * stride] = x;\n}}"
    )]
}

/// The copies of rows to and from shared memory that the kernels call.
pub(super) fn copies(source: &Source, cuda: &Cuda) -> Vec<String> {
    let plans = source.functions.iter().map(|function| plan(function.program, source.precision).1);
    let all: Vec<Staging> = plans.flatten().collect();
    if all.iter().all(|staging| *staging == Staging::InPlace) {
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
    let mut lines = vec![
        "\n#ifndef MOZZI_ONLY_COLUMNS".to_string(),
        copy("fetch", "Rows of a warp's states, to shared memory.", "to[at] = from[j]"),
        copy("store", "Rows of a warp's states, from shared memory.", "to[j] = from[at]"),
    ];
    if all.iter().any(|staging| matches!(staging, Staging::Slots(_))) {
        lines.push(format!(
            "\n// Rows of a warp's states, from slots in shared memory; entries without one are 0.\ntemplate <unsigned \
             length, unsigned width>\nstatic __device__ __forceinline__ void {prefix}_spread(\n    const {number} \
             *__restrict__ from, {number} *__restrict__ to, const unsigned short *__restrict__ slots,\n    const unsigned \
             states, const unsigned lane)\n{{\n#pragma unroll 4\n    for (unsigned j = lane; j < states * length; j += 32u) \
             {{\n        const unsigned slot = slots[j % length];\n        to[j] = slot == {NONE}u ? ({number}) 0 : \
             from[j / length * width + slot];\n    }}\n}}"
        ));
    }
    lines.push("#endif".to_string());
    lines
}

/// The arrays that a function takes.
fn parameters(function: &Emitted, cuda: &Cuda) -> String {
    let number = cuda.c.number();
    let pointer = |before: &str, argument: &Argument| format!("{before}{number} *__restrict__ {}", argument.name);
    let inputs = function.inputs.iter().map(|input| pointer("const ", input));
    let all: Vec<String> = inputs.chain(function.outputs.iter().map(|output| pointer("", output))).collect();
    all.join(", ")
}

/// The function of one state, and its kernels.
pub(super) fn lines(function: &Emitted, cuda: &Cuda) -> Vec<String> {
    let name = format!("{}_{}", cuda.prefix, function.name);
    let arguments = parameters(function, cuda);
    let (block, staging) = plan(function.program, cuda.c.0);
    let outputs = function.outputs.iter().zip(&staging[function.inputs.len()..]);
    let slots = outputs.filter_map(|(output, staging)| match staging {
        Staging::Slots(slots) => Some((output.name.clone(), slots.clone())),
        _ => None,
    });
    *cuda.slots.borrow_mut() = slots.collect();
    let mut lines = vec![String::new()];
    for (output, slots) in cuda.slots.borrow().iter() {
        lines.push(format!("// Where the rows of {output} have each entry; {NONE}: it is 0."));
        lines.push(format!("static __device__ const unsigned short {name}_{output}_slots[{}] = {{", slots.of.len()));
        lines.extend(slots.of.chunks(16).map(|row| {
            let row: Vec<String> = row.iter().map(|slot| format!("{},", slot.unwrap_or(NONE))).collect();
            format!("    {}", row.join(" "))
        }));
        lines.push("};".to_string());
    }
    lines.extend(function.lines().iter().map(|line| format!("// {line}")));
    lines.push("// Of one state: entry k of an array is at k * stride; columns have a stride below 2^32.".to_string());
    lines.extend(cuda.slots.borrow().keys().map(|output| format!("// Rows of {output} are in slots.")));
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
    rows(function, cuda, &name, (block, staging), head, &mut lines);
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
    let (threads, states) = (BY_COLUMNS, parts::STATES);
    let arrays: String = arrays(function).map(|argument| format!("{} + i, ", argument.name)).collect();
    lines.push("\n#ifndef MOZZI_ONLY_ROWS".to_string());
    let parts = parts(function.program);
    if let Some((parts, _)) = &parts {
        let steps = body::of_steps(function, cuda);
        let head = |k: usize| {
            format!(
                "// Of one state; kept: its numbers for later parts.\nstatic __device__ __forceinline__ void \
                 {name}_{k}({}, {} *__restrict__ kept, const unsigned long long stride)\n{{\n    const bool columns = true;",
                parameters(function, cuda),
                cuda.c.number()
            )
        };
        lines.extend(parts.iter().enumerate().flat_map(|(k, part)| of_part(part, &steps, cuda, head(k))));
    }
    lines.push(
        "// Of `count` states, a thread each: entry k of state i at k * count + i; blocks of at most".to_string(),
    );
    lines.push(format!("// {threads} threads."));
    if parts.is_some() {
        lines.push(format!("// A thread computes {states} states, if there are fewer threads than states."));
    }
    lines.push(head(CudaLayout::Columns, threads));
    let is_long = parts::is_long(function.program);
    if is_long {
        lines.extend([SPILLED, STRIDE].map(String::from));
    }
    let stride = if is_long { "stride_" } else { "count" };
    let Some((parts, kept)) = parts else {
        lines.push(format!("    const unsigned long long i = {THREAD};"));
        lines.push(format!("    if (i < count) {name}<true>({arrays}{stride});\n}}\n#endif"));
        return;
    };
    lines.push("    const unsigned long long all_ = (unsigned long long) gridDim.x * blockDim.x;".to_string());
    lines.push(format!("    {} kept_[{states}][{kept}];\n#pragma unroll 1", cuda.c.number()));
    lines.push(format!("    for (unsigned long long first_ = {THREAD}; first_ < count; first_ += {states} * all_) {{"));
    for k in 0..parts.len() {
        lines.push(format!("#pragma unroll 1\n        for (unsigned k_ = 0; k_ < {states}; ++k_) {{"));
        lines.push("            const unsigned long long i = first_ + k_ * all_;".to_string());
        lines.push(format!("            if (i < count) {name}_{k}({arrays}kept_[k_], {stride});\n        }}"));
    }
    lines.push("    }\n}\n#endif".to_string());
}

/// A part of a function, by columns.
fn of_part(part: &Part, steps: &[Vec<String>], cuda: &Cuda, head: String) -> Vec<String> {
    let mut lines = vec![head];
    let load = |(value, place): &(Value, usize)| format!("    const {} v{value} = kept[{place}];", cuda.c.number());
    lines.extend(part.loads.iter().map(load));
    lines.extend(steps[part.steps.clone()].iter().flatten().map(|line| format!("    {line}")));
    lines.extend(part.stores.iter().map(|(value, place)| format!("    kept[{place}] = v{value};")));
    lines.push("}\n".to_string());
    lines
}

fn rows(
    function: &Emitted,
    cuda: &Cuda,
    name: &str,
    (Block { threads, .. }, staging): (Block, Vec<Staging>),
    head: impl Fn(CudaLayout, usize) -> String,
    lines: &mut Vec<String>,
) {
    let (number, prefix) = (cuda.c.number(), cuda.prefix);
    let staged: Vec<(&Argument, Staging)> = arrays(function).zip(staging).collect();
    let is_input = |k: usize| k < function.inputs.len();
    let of_thread: usize = staged.iter().map(|(x, staging)| staging.width(x.length)).sum();
    lines.push("\n#ifndef MOZZI_ONLY_COLUMNS".to_string());
    lines.push(
        "// Of `count` states, a thread each: entry k of state i at i * length + k; blocks of a multiple of".into(),
    );
    lines.push(format!("// 32 threads, at most {threads}."));
    lines.push(head(CudaLayout::Rows, threads));
    if of_thread == 0 {
        lines.push(format!("    const unsigned long long i = {THREAD};"));
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
    for (x, staging) in staged.iter().filter(|(_, staging)| *staging != Staging::InPlace) {
        lines.push(format!("    {number} *const {}_ = warp_ + 32 * {place};", x.name));
        place += staging.width(x.length);
    }
    let copies = |of_inputs: bool| {
        let those = staged.iter().enumerate().filter(move |(k, _)| is_input(*k) == of_inputs);
        those.filter_map(move |(_, (x, staging))| {
            let Argument { name: x, length, .. } = x;
            let width = staging.width(*length);
            Some(match (staging, of_inputs) {
                (Staging::InPlace, _) => return None,
                (_, true) => format!("    {prefix}_fetch<{length}>({x} + first_ * {length}, {x}_, states_, lane_);"),
                (Staging::Whole, _) => {
                    format!("    {prefix}_store<{length}>({x}_, {x} + first_ * {length}, states_, lane_);")
                }
                (Staging::Slots(_), _) => format!(
                    "    {prefix}_spread<{length}, {width}>({x}_, {x} + first_ * {length}, {name}_{x}_slots, states_, lane_);"
                ),
            })
        })
    };
    lines.extend(copies(true));
    lines.push("    __syncwarp();".to_string());
    let row = |(x, staging): &(&Argument, Staging)| match staging {
        Staging::InPlace => format!("{} + (first_ + lane_) * {}, ", x.name, x.length),
        _ => format!("{}_ + lane_ * {}, ", x.name, staging.width(x.length)),
    };
    lines.push(format!("    if (lane_ < states_) {name}<false>({}1);", staged.iter().map(row).collect::<String>()));
    lines.push("    __syncwarp();".to_string());
    lines.extend(copies(false));
    lines.push("}\n#endif".to_string());
}

fn arrays<'e>(function: &'e Emitted) -> impl Iterator<Item = &'e Argument> {
    function.inputs.iter().chain(&function.outputs)
}
