//! A crate without `std` that holds the text, and a main program.

use super::{Module, compile};
use mozzi_engine::Precision;
use std::path::Path;

pub fn build(folder: &Path, precision: Precision, modules: &[Module], compiler: &str, flags: &[&str]) {
    let number = if precision == Precision::F64 { "f64" } else { "f32" };
    let mut library = String::from("#![no_std]\n#![forbid(unsafe_code)]\n#![deny(warnings)]\n");
    let mut main = format!(
        "use std::io::{{Read, Write}};\n\
         fn get<const N: usize>(bytes: &mut &[u8]) -> [{number}; N] {{\n    std::array::from_fn(|_| {{\n        \
         let (x, rest) = bytes.split_first_chunk().expect(\"a number\");\n        *bytes = rest;\n        \
         {number}::from_ne_bytes(*x)\n    }})\n}}\n\
         fn put(x: &[{number}]) {{ x.iter().for_each(|x| std::io::stdout().write_all(&x.to_ne_bytes()).expect(\"open\")) }}\n\
         fn main() {{\n    let mut bytes = Vec::new();\n    std::io::stdin().read_to_end(&mut bytes).expect(\"open\");\n    \
         let b = &mut &bytes[..];\n"
    );
    for module in modules {
        let name = module.name();
        // a file has its robot's name
        library += &format!("#[allow(non_snake_case)]\npub mod {name} {{ include!(\"{name}.rs\"); }}\n");
        for call in &module.calls {
            let (inputs, outputs) = call.lengths();
            main += &format!("    for _ in 0..{} {{\n", call.states.len());
            let mut names = Vec::new();
            for (k, n) in inputs.iter().enumerate() {
                main += &format!("        let x{k} = get::<{n}>(b);\n");
                names.push(format!("&x{k}"));
            }
            for (k, n) in outputs.iter().enumerate() {
                main += &format!("        let mut y{k} = [0.0; {n}];\n");
                names.push(format!("&mut y{k}"));
            }
            main += &format!("        emitted::{name}::{}({});\n", call.function, names.join(", "));
            (0..outputs.len()).for_each(|k| main += &format!("        put(&y{k});\n"));
            main += "    }\n";
        }
    }
    main += "}\n";
    std::fs::write(folder.join("emitted.rs"), library).expect("a file");
    std::fs::write(folder.join("main.rs"), main).expect("a file");
    // a library that aborts on panic cannot be linked into a program that unwinds
    let library = ["--edition=2021", "--crate-type=rlib", "--emit=link,asm", "emitted.rs"];
    compile(folder, compiler, &[&library, flags].concat());
    compile(folder, compiler, &["--edition=2021", "-Cpanic=abort", "main.rs", "--extern=emitted=libemitted.rlib"]);
}
