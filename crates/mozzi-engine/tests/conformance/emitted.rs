//! Every quantity of a robot as C, compiled and called.

use super::{Case, close};
use mozzi::quantities::{LIST, Query};
use mozzi_engine::{Arguments, Language, Precision, emit_into, record_quantity};
use std::process::Command;

/// Compiles one file with every quantity, and compares each function with the model's result at the first state.
pub fn every_quantity_as_c(case: &Case) {
    // another processor's tests need its compiler, which `CC` names
    let compiler = std::env::var_os("CC").unwrap_or_else(|| "gcc".into());
    if Command::new(&compiler).arg("--version").output().is_err() {
        eprintln!("emitted C is skipped: there is no {}", compiler.display());
        return;
    }
    let all = (0..LIST.len()).map(|index| case.query(Query::at(index)));
    // without constraints there is nothing to emit
    let queries: Vec<Query> = all.filter(|query| query.output_lengths(case.model).all(|length| length > 0)).collect();
    let slug: String = case.name.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
    let folder = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("conformance_{slug}"));
    std::fs::create_dir_all(&folder).expect("a folder");
    emit_into(&folder, case.model, &queries, Arguments::default(), Language::C, Precision::F64).expect("text");
    let library = folder.join("robot.so");
    let mut cc = Command::new(&compiler);
    cc.args(["-O0", "-std=c99", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-o"]).arg(&library);
    let output = cc.arg(folder.join("tree.c")).arg("-lm").output().expect("a C compiler");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    // SAFETY: the library was compiled above, and has no initialisers.
    let library = unsafe { libloading::Library::new(&library) }.expect("a library");
    let own = case.model.environment();
    for query in queries {
        let program = record_quantity(case.model, query, Arguments::default()).expect("its own frames");
        let inputs = case.inputs(query, &case.states[0]);
        let mut outputs: Vec<Vec<f64>> =
            program.outputs().iter().map(|output| vec![f64::NAN; output.values.len()]).collect();
        let frame = query.subject.frame.map(|frame| format!("_{}", case.model.frame_name(frame))).unwrap_or_default();
        call(&library, &format!("tree_{}{frame}", query.name()), &inputs, &mut outputs);
        let expected = case.model.compute(query, &inputs, &own).expect("regular");
        outputs.truncate(expected.len());
        close(&format!("{} of {}, as C", query.name(), case.name), &outputs, &expected, 1e-6);
    }
}

/// Calls a function of arrays, inputs before outputs.
fn call(library: &libloading::Library, name: &str, inputs: &[&[f64]], outputs: &mut [Vec<f64>]) {
    let mut arrays: Vec<*mut f64> = inputs.iter().map(|x| x.as_ptr().cast_mut()).collect();
    arrays.extend(outputs.iter_mut().map(|x| x.as_mut_ptr()));
    macro_rules! call {
        ($($count:literal: $($k:literal)*;)*) => {
            match arrays.len() {
                $($count => {
                    type Function = unsafe extern "C" fn($(call!(@pointer $k)),*);
                    // SAFETY: the emitted function of this name takes this many arrays, each with the length of the
                    // program's; inputs are const.
                    unsafe {
                        let function: libloading::Symbol<Function> = library.get(name.as_bytes()).expect(name);
                        function($(arrays[$k]),*)
                    }
                })*
                count => panic!("{name} has {count} arrays"),
            }
        };
        (@pointer $k:literal) => { *mut f64 };
    }
    call! { 2: 0 1; 3: 0 1 2; 4: 0 1 2 3; 5: 0 1 2 3 4; 6: 0 1 2 3 4 5; 7: 0 1 2 3 4 5 6; 8: 0 1 2 3 4 5 6 7; 9: 0 1 2 3 4 5 6 7 8; }
}
