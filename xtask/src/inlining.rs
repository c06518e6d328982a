//! Whether the passes on fused numbers have no function beside them that is not compiled for fused multiply-add: there
//! each product with a sum is a call of `fma`, and a kernel takes six times as long. A closure that is called twice is
//! enough (docs/performance-log.md).

use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;
use std::collections::BTreeSet;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

/// Functions that may call an operation: they run once for each workspace.
const MAY: [&str; 5] = ["::new", "::zero", "std_detect::", "compiler_builtins::", "core::core_arch::"];

/// Reads the disassembly of the release build of `mozzi`, which is there already: only linked once more, with names.
pub fn check(workspace: &Workspace) -> Outcome {
    if !cfg!(all(target_arch = "x86_64", target_os = "linux")) {
        return Outcome::Skipped("only on x86-64 Linux".into());
    }
    let link = ["rustc", "--quiet", "--release", "--package", "mozzi-cli", "--bin", "mozzi", "--", "-Cstrip=none"];
    if let Err(why) = command::run(workspace.cargo(&link)) {
        return Outcome::Failed(why);
    }
    let mut objdump = Command::new("objdump");
    objdump.args(["--disassemble", "--demangle", "--no-show-raw-insn"]).arg(workspace.target().join("release/mozzi"));
    let Ok(mut child) = objdump.stdin(Stdio::null()).stdout(Stdio::piped()).spawn() else {
        return Outcome::Skipped("`apt install binutils` installs objdump".into());
    };
    let lines = child.stdout.take().into_iter().flat_map(|stdout| BufReader::new(stdout).split(b'\n'));
    let found = calls(lines.map_while(Result::ok).map(|line| String::from_utf8_lossy(&line).into_owned()));
    match child.wait() {
        Ok(status) if status.success() && found.is_empty() => Outcome::Passed("no fused operation is a call".into()),
        Ok(status) if status.success() => Outcome::Failed(found.into_iter().collect::<Vec<_>>().join("\n")),
        _ => Outcome::Failed(format!("`{}` failed", command::shown(&objdump))),
    }
}

/// `caller calls operation`, for each function that may not.
fn calls(disassembly: impl Iterator<Item = String>) -> BTreeSet<String> {
    let (mut caller, mut found) = (String::new(), BTreeSet::new());
    for line in disassembly {
        let Some((_, named)) = line.split_once('<') else { continue };
        if let Some(name) = named.strip_suffix(">:") {
            caller = name.to_owned();
        } else if (named == "fma>" || named.starts_with("fma@")) && caller.contains("mozzi") {
            found.insert(format!("{caller} calls fma"));
        } else if let Some((_, operation)) = named.trim_end_matches('>').split_once("core_arch::") {
            let is_call = !operation.contains("+0x");
            let is_constant = operation.contains("_set1_"); // memory is filled with it
            if is_call && !is_constant && !MAY.iter().any(|may| caller.contains(may)) {
                found.insert(format!("{caller} calls {operation}"));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::calls;

    #[test]
    fn only_calls_of_operations_are_found() {
        let text = "\
0000000000617850 <core::core_arch::x86::avx::_mm256_add_pd>:
  617850: jmp 617860 <core::core_arch::x86::avx::_mm256_add_pd+0x10>
0000000000700000 <mozzi::dynamics::path::carried::{{closure}}>:
  700000: call 617850 <core::core_arch::x86::avx::_mm256_add_pd>
  700005: call 617900 <mozzi::spatial::inertia>
0000000000780000 <mozzi::dynamics::mass_matrix::fill::{{closure}}>:
  780000: call *0x1234(%rip)        # 790000 <fma@GLIBC_2.2.5>
  780005: call 7a0000 <fma_rn+0x10>
0000000000800000 <mozzi::quantity::memory::Memory<S>::new>:
  800000: call 617850 <core::core_arch::x86::avx::_mm256_add_pd>
";
        let expected = [
            "mozzi::dynamics::mass_matrix::fill::{{closure}} calls fma",
            "mozzi::dynamics::path::carried::{{closure}} calls x86::avx::_mm256_add_pd",
        ];
        let found = calls(text.lines().map(str::to_owned));
        assert_eq!(found.into_iter().collect::<Vec<_>>(), expected);
    }
}
