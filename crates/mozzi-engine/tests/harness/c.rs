//! A main program in C.

use super::{Module, c_number, compile};
use mozzi_engine::Precision;
use std::path::Path;

pub fn build(folder: &Path, precision: Precision, modules: &[Module], compiler: &str, flags: &[&str]) {
    let number = c_number(precision);
    let mut main = String::from("#include <stdio.h>\n#include <stdlib.h>\n");
    modules.iter().for_each(|module| main += &format!("#include \"{}.h\"\n", module.name()));
    main += &format!(
        "static void get({number} *x, size_t n) {{ if (fread(x, sizeof *x, n, stdin) != n) exit(3); }}\n\
         static void put(const {number} *x, size_t n) {{ if (fwrite(x, sizeof *x, n, stdout) != n) exit(4); }}\n\
         int main(void)\n{{\n"
    );
    for module in modules {
        for call in &module.calls {
            let (inputs, outputs) = call.lengths();
            main += &format!("    for (int s = 0; s < {}; s++) {{\n", call.states.len());
            for (k, n) in inputs.iter().enumerate() {
                main += &format!("        {number} x{k}[{n}]; get(x{k}, {n});\n");
            }
            for (k, n) in outputs.iter().enumerate() {
                main += &format!("        {number} y{k}[{n}];\n");
            }
            let names = (0..inputs.len()).map(|k| format!("x{k}")).chain((0..outputs.len()).map(|k| format!("y{k}")));
            let names: Vec<String> = names.collect();
            main += &format!("        {}_{}({});\n", module.name(), call.function, names.join(", "));
            for (k, n) in outputs.iter().enumerate() {
                main += &format!("        put(y{k}, {n});\n");
            }
            main += "    }\n";
        }
    }
    main += "    return 0;\n}\n";
    std::fs::write(folder.join("main.c"), main).expect("a file");
    let sources: Vec<String> = modules.iter().map(|module| format!("{}.c", module.name())).collect();
    let mut arguments = flags.to_vec();
    arguments.push("main.c");
    arguments.extend(sources.iter().map(String::as_str));
    arguments.extend(["-o", "main", "-lm"]);
    compile(folder, compiler, &arguments);
}
