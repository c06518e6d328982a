//! Round trips with NumPy and PyArrow: they write the program's input and read its output.

use crate::common::folder;

/// Of `cargo xtask test`.
fn python(imports: &str) -> Option<String> {
    let python = std::env::var("MOZZI_PYTHON").ok()?;
    let mut import = std::process::Command::new(&python);
    let has = import.args(["-c", &format!("import {imports}")]).output().is_ok_and(|output| output.status.success());
    has.then_some(python)
}

/// Writes states, runs the program, reads the results.
const BY_NUMPY: &str = "
import subprocess, sys
import numpy as np
program, folder = sys.argv[1:]
def run(quantity, states, result):
    command = [program, 'compute', 'ur5', quantity, '--in', f'{folder}/{states}', '--out', f'{folder}/{result}']
    subprocess.run(command, check=True)
theta = np.random.default_rng(1).uniform(-1, 1, (50, 6))
np.save(f'{folder}/c.npy', theta)
np.save(f'{folder}/f.npy', np.asfortranarray(theta))
np.savez_compressed(f'{folder}/theta.npz', theta=theta)
for states in ['c.npy', 'f.npy', 'theta.npz']:
    run('mass-matrix', states, 'M.npy')
    run('mass-matrix', states, 'M.npz')
    M = np.load(f'{folder}/M.npy')
    assert M.shape == (50, 6, 6) and M.dtype == np.float64
    assert np.abs(M - M.transpose(0, 2, 1)).max() < 1e-12 and np.linalg.eigvalsh(M).min() > 0
    assert (np.load(f'{folder}/M.npz')['M'] == M).all()
np.save(f'{folder}/single.npy', theta.astype(np.float32))
run('potential-energy', 'single.npy', 'P.npy')
assert np.load(f'{folder}/P.npy').shape == (50,)
";

#[test]
fn numpy_reads_what_is_written_and_writes_what_is_read() {
    let Some(python) = python("numpy") else {
        println!("skipped: MOZZI_PYTHON names no Python with NumPy (cargo xtask test makes one)");
        return;
    };
    by_python(&python, BY_NUMPY, "compute_numpy");
}

const BY_PYARROW: &str = "
import subprocess, sys
import numpy as np, pyarrow as pa, pyarrow.feather as feather
program, folder = sys.argv[1:]
theta = np.random.default_rng(1).uniform(-1, 1, (50, 6))
table = pa.table({f'theta_{j + 1}': theta[:, j] for j in range(6)})
for compression in ['uncompressed', 'lz4']:
    feather.write_feather(table, f'{folder}/states.feather', compression=compression)
    command = [program, 'compute', 'ur5', 'gravity-forces', '--in', f'{folder}/states.feather']
    subprocess.run(command + ['--out', f'{folder}/g.arrow'], check=True)
    subprocess.run(command + ['--out', f'{folder}/g.npy'], check=True)
    g = feather.read_table(f'{folder}/g.arrow')
    assert g.column_names == [f'g_{j + 1}' for j in range(6)]
    assert (np.stack([g[name].to_numpy() for name in g.column_names], 1) == np.load(f'{folder}/g.npy')).all()
";

#[test]
fn pyarrow_reads_what_is_written_and_writes_what_is_read() {
    let Some(python) = python("numpy, pyarrow") else {
        println!("skipped: MOZZI_PYTHON names no Python with pyarrow");
        return;
    };
    by_python(&python, BY_PYARROW, "compute_pyarrow");
}

fn by_python(python: &str, script: &str, name: &str) {
    let folder = folder(name);
    let output = std::process::Command::new(python)
        .args(["-c", script, env!("CARGO_BIN_EXE_mozzi"), folder.to_str().expect("text")])
        .output()
        .expect("Python runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
