//! A main program that runs the CUDA text on the host, a warp's threads as threads of the system.

use super::{Module, c_number, compile};
use mozzi_codegen::Precision;
use std::path::Path;

/// The parts of CUDA that the text uses.
const HOST: &str = r#"
#include <barrier>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>
#define __constant__ static const
#define __shared__ static
#define __launch_bounds__(threads)
#define __syncwarp() warp.arrive_and_wait()
#define __device__
#define __global__
#define __forceinline__ inline
struct Index { unsigned x; };
static const Index blockDim = {32};
static thread_local Index blockIdx, threadIdx;
static std::barrier<> warp(32);
[[maybe_unused]] static long long __double_as_longlong(double x) { long long y; memcpy(&y, &x, 8); return y; }
[[maybe_unused]] static double __longlong_as_double(long long x) { double y; memcpy(&y, &x, 8); return y; }
[[maybe_unused]] static unsigned __float_as_uint(float x) { unsigned y; memcpy(&y, &x, 4); return y; }
[[maybe_unused]] static float __fdividef(float x, float y) { return x / y; }
[[maybe_unused]] static float __uint_as_float(unsigned x) { float y; memcpy(&y, &x, 4); return y; }
"#;

/// Arrays of all states in both layouts. There is one block more than needed, so that some threads have no state.
const ARRAYS: &str = r#"
struct Array {
    std::vector<number> rows, columns;
    size_t n;
    Array(size_t n) : rows(n * count), columns(n * count), n(n) {}
    static size_t count;
    void get(size_t s) {
        if (fread(&rows[s * n], sizeof(number), n, stdin) != n) exit(3);
        for (size_t k = 0; k < n; k++) columns[k * count + s] = rows[s * n + k];
    }
    void put(size_t s) const {
        for (size_t k = 0; k < n; k++) {
            const number x = rows[s * n + k], y = columns[k * count + s];
            if (!(x == y || (x != x && y != y))) { fprintf(stderr, "%g by rows, %g by columns\n", x, y); exit(5); }
        }
        if (fwrite(&rows[s * n], sizeof(number), n, stdout) != n) exit(4);
    }
};
size_t Array::count;
template <class Kernel> static void launch(Kernel kernel) {
    std::vector<std::thread> threads;
    for (unsigned t = 0; t < blockDim.x; t++)
        threads.emplace_back([=] {
            threadIdx.x = t;
            for (blockIdx.x = 0; blockIdx.x < Array::count / blockDim.x + 2; blockIdx.x++) {
                kernel();
                __syncwarp(); // the next block has the same shared memory
            }
        });
    for (std::thread &thread : threads) thread.join();
}
"#;

pub fn build(folder: &Path, precision: Precision, modules: &[Module], compiler: &str, flags: &[&str]) {
    let mut main = String::from(HOST);
    modules.iter().for_each(|module| main += &format!("#include \"{}.cu\"\n", module.name()));
    main += &format!("typedef {} number;\n{ARRAYS}int main()\n{{\n", c_number(precision));
    for module in modules {
        for call in &module.calls {
            let (inputs, outputs) = call.lengths();
            main += &format!("    {{\n        Array::count = {};\n", call.states.len());
            let of = |prefix: &str, lengths: &[usize]| {
                let arrays: Vec<String> = (0..lengths.len()).map(|k| format!("{prefix}{k}")).collect();
                arrays
            };
            let (x, y) = (of("x", &inputs), of("y", &outputs));
            for (name, n) in x.iter().chain(&y).zip(inputs.iter().chain(&outputs)) {
                main += &format!("        Array {name}({n});\n");
            }
            let each = |names: &[String], method: &str| {
                let calls: String = names.iter().map(|name| format!("{name}.{method}(s); ")).collect();
                format!("        for (size_t s = 0; s < Array::count; s++) {{ {calls}}}\n")
            };
            main += &each(&x, "get");
            for layout in ["rows", "columns"] {
                let data: String = x.iter().chain(&y).map(|name| format!("{name}.{layout}.data(), ")).collect();
                let kernel = format!("{}_{}_{layout}", module.name(), call.function);
                main += &format!("        launch([&] {{ {kernel}({data}Array::count); }});\n");
            }
            main += &each(&y, "put");
            main += "    }\n";
        }
    }
    main += "}\n";
    std::fs::write(folder.join("main.cpp"), main).expect("a file");
    compile(folder, compiler, &[flags, &["main.cpp", "-o", "main"]].concat());
}
