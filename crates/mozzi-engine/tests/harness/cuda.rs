//! A main program that runs the CUDA text on the host, a warp's threads as threads of the system.

use super::{Module, c_number, compile};
use mozzi_engine::Precision;
use std::path::Path;

/// The parts of CUDA that the text uses.
const HOST: &str = include_str!("cuda_host.hpp");

/// Arrays of all states in both layouts.
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
                main += &format!("        launch([&] {{ {kernel}({data}Array::count); }}, Array::count);\n");
            }
            main += &each(&y, "put");
            main += "    }\n";
        }
    }
    main += "}\n";
    std::fs::write(folder.join("main.cpp"), main).expect("a file");
    compile(folder, compiler, &[flags, &["main.cpp", "-o", "main"]].concat());
}
