//! Each program by each compiler.

use crate::toolchain::{Build, SANITIZERS, copy_of_the_library, eigen, exists, has_sanitizers, run, source};

/// `fork`, `dlopen` and threads beside C99.
const POSIX: &[&str] = &["-D_POSIX_C_SOURCE=200809L"];
const C: [&str; 2] = ["gcc", "clang"];
const CPP: [&str; 2] = ["g++", "clang++"];

/// Those compilers that are here; says which are not.
fn here<'a>(compilers: &[&'a str]) -> Vec<&'a str> {
    let (here, missing): (Vec<&str>, Vec<&str>) = compilers.iter().partition(|compiler| exists(compiler));
    if !missing.is_empty() {
        println!("skipped: {} not installed", missing.join(", "));
    }
    here
}

/// A program of C99 by every compiler, and with sanitizers.
fn c99(program: &str) {
    for compiler in here(&C) {
        let build = Build { compiler, standard: "c99", flags: POSIX, is_static: false };
        build.run(program);
        if !has_sanitizers(compiler) {
            continue;
        }
        let flags = [POSIX, &SANITIZERS[..]].concat();
        Build { flags: &flags, ..build }.run(program);
    }
}

#[test]
fn every_quantity_in_c() {
    c99("quantities.c");
}

/// A program of C++17 and C++20 by every compiler, and with sanitizers.
fn cpp(program: &str, flags: &[&str]) {
    for compiler in here(&CPP) {
        // each compiler with both standards, and with the sanitizers once
        let checked = if compiler == "g++" { "c++17" } else { "c++20" };
        for standard in ["c++17", "c++20"] {
            let sanitizers = if standard == checked && has_sanitizers(compiler) { &SANITIZERS[..] } else { &[] };
            let flags = [flags, sanitizers].concat();
            Build { compiler, standard, flags: &flags, is_static: false }.run(program);
        }
    }
}

#[test]
fn every_quantity_in_cpp() {
    cpp("methods.cpp", &[]);
}

#[test]
fn every_quantity_with_eigen() {
    if let Some(flags) = eigen() {
        let flags: Vec<&str> = flags.iter().map(String::as_str).chain(["-DWITH_EIGEN"]).collect();
        cpp("methods.cpp", &flags);
    }
}

#[test]
fn wrong_arguments_give_statuses() {
    c99("misuse.c");
}

#[test]
fn nothing_is_allocated() {
    // the sanitizers have an allocator of their own
    for compiler in here(&C) {
        let found = Build { compiler, standard: "c99", flags: POSIX, is_static: false }.run("allocations.c");
        print!("{found}");
        assert!(found.starts_with("0 allocations in 1"), "{found}");
    }
}

#[test]
fn threads_and_forks() {
    c99("threads.c");
}

#[test]
fn the_library_twice() {
    for compiler in here(&C) {
        copy_of_the_library();
        let build = Build { compiler, standard: "c99", flags: POSIX, is_static: false };
        build.run("twice.c");
    }
}

#[test]
fn the_static_library() {
    for compiler in here(&C) {
        Build { compiler, standard: "c99", flags: POSIX, is_static: true }.run("quantities.c");
    }
}

#[test]
fn robots_in_c() {
    c99("robots.c");
}

#[test]
fn objects_in_cpp() {
    cpp("objects.cpp", &[]);
    for compiler in here(&CPP) {
        Build { compiler, standard: "c++17", flags: &["-fno-exceptions"], is_static: false }.run("objects.cpp");
    }
}

#[test]
fn the_examples() {
    let place = "../../examples/cpp";
    let eigen = eigen();
    for entry in std::fs::read_dir(source(place)).expect("the examples") {
        let name = entry.expect("a file").file_name().into_string().expect("a name in UTF-8");
        let text = std::fs::read_to_string(source(place).join(&name)).expect("a text");
        let flags = match (&eigen, text.contains("#include <Eigen/")) {
            (None, true) => continue,
            (Some(flags), true) => flags.iter().map(String::as_str).collect(),
            (_, false) => Vec::new(),
        };
        if name.ends_with(".cpp") {
            for compiler in here(&CPP) {
                let build = Build { compiler, standard: "c++17", flags: &flags, is_static: false };
                let program = build.compile(&format!("{place}/{name}"));
                print!("{name}: {}", run(&mut std::process::Command::new(program)));
            }
        }
    }
}
