//! NVRTC, NVIDIA's compiler at run time: a library with a dozen functions of C, found and loaded at the first use.

use crate::binary::Resources;
use crate::cache::Key;
use crate::{Binary, Error};
use libloading::{Library, Symbol};
use std::collections::HashMap;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The loaded library, with the code that it has compiled. Clones share both.
#[derive(Clone, Debug)]
pub struct Nvrtc {
    library: Arc<Loaded>,
}

#[derive(Debug)]
struct Loaded {
    library: Library,
    path: String,
    version: (u32, u32),
    compiled: Mutex<HashMap<Key, Arc<Binary>>>,
}

type Program = *mut c_void;

/// Names of the library under Linux and Windows, the newest first.
const NAMES: [&str; 6] =
    ["libnvrtc.so.13", "libnvrtc.so.12", "libnvrtc.so.11.2", "libnvrtc.so", "nvrtc64_130_0.dll", "nvrtc64_120_0.dll"];

/// Folders of Python's packages and of toolkits in which the library lies.
const FOLDERS: [&str; 4] =
    ["nvidia/cu13/lib", "nvidia/cu13/bin/x86_64", "nvidia/cuda_nvrtc/lib", "nvidia/cuda_nvrtc/bin"];

impl Nvrtc {
    /// The first NVRTC of: the file named by the variable `MOZZI_NVRTC`; Python's packages `nvidia-cuda-nvrtc` and
    /// `nvidia-cuda-nvrtc-cu12` in `VIRTUAL_ENV`; the toolkit in `CUDA_HOME` or `CUDA_PATH`; the system's libraries;
    /// `/usr/local/cuda`. It is searched once in a process.
    ///
    /// # Errors
    /// [`Error::NoCompiler`] with the paths, [`Error::NotNvrtc`] if `MOZZI_NVRTC` names another file.
    pub fn find() -> Result<Nvrtc, Error> {
        static FOUND: OnceLock<Nvrtc> = OnceLock::new();
        if let Some(nvrtc) = FOUND.get() {
            return Ok(nvrtc.clone());
        }
        let found = match std::env::var_os("MOZZI_NVRTC") {
            Some(path) => Nvrtc::open(Path::new(&path))?,
            None => search(&candidates(|name| std::env::var_os(name).map(PathBuf::from)))?,
        };
        Ok(FOUND.get_or_init(|| found).clone())
    }

    /// The first NVRTC in these folders of Python's packages, such as `site-packages`.
    ///
    /// # Errors
    /// [`Error::NoCompiler`].
    pub fn in_packages(folders: &[PathBuf]) -> Result<Nvrtc, Error> {
        search(&folders.iter().flat_map(|folder| of_packages(folder)).collect::<Vec<_>>())
    }

    /// Loads this library, once in a process.
    ///
    /// # Errors
    /// [`Error::NotNvrtc`] if it cannot be loaded, or lacks NVRTC's functions.
    pub fn open(path: &Path) -> Result<Nvrtc, Error> {
        static OPENED: Mutex<Vec<(PathBuf, Nvrtc)>> = Mutex::new(Vec::new());
        let mut opened = OPENED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, nvrtc)) = opened.iter().find(|(known, _)| known == path) {
            return Ok(nvrtc.clone());
        }
        let nvrtc = Nvrtc::load(path)?;
        opened.push((path.to_path_buf(), nvrtc.clone()));
        Ok(nvrtc)
    }

    fn load(path: &Path) -> Result<Nvrtc, Error> {
        let name = path.display().to_string();
        let wrong = |reason: String| Error::NotNvrtc { path: name.clone(), reason };
        // SAFETY: loading runs the library's initialization; the caller, the user's variable or NVIDIA's names chose it
        let library = unsafe { Library::new(path) }.map_err(|error| wrong(error.to_string()))?;
        let (mut major, mut minor) = (0, 0);
        // SAFETY: the type of NVRTC's function of this name
        let version: Symbol<unsafe extern "C" fn(*mut c_int, *mut c_int) -> c_int> =
            unsafe { library.get(b"nvrtcVersion") }.map_err(|error| wrong(error.to_string()))?;
        // SAFETY: both pointers are of living numbers
        let result = unsafe { version(&mut major, &mut minor) };
        let version = (u32::try_from(major).unwrap_or(0), u32::try_from(minor).unwrap_or(0));
        if result != 0 || version < (11, 1) {
            return Err(wrong(format!("its version is {major}.{minor}")));
        }
        Ok(Nvrtc { library: Arc::new(Loaded { library, path: name, version, compiled: Mutex::default() }) })
    }

    /// The library's path or name.
    pub fn path(&self) -> &str {
        &self.library.path
    }

    /// Its version, major and minor.
    pub fn version(&self) -> (u32, u32) {
        self.library.version
    }

    /// Compiles a text, or returns the code of an equal text with the same options, of this process or, if the variable
    /// `MOZZI_GPU_CACHE` names a folder, of an earlier one.
    pub(crate) fn compile(&self, key: Key) -> Result<Arc<Binary>, Error> {
        let compiled = || self.library.compiled.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(binary) = compiled().get(&key) {
            return Ok(binary.clone());
        }
        let binary = match key.read() {
            Some(binary) => binary,
            None => {
                let binary = self.library.compile(&key)?;
                key.write(&binary);
                binary
            }
        };
        Ok(compiled().entry(key).or_insert(Arc::new(binary)).clone())
    }
}

/// The first of these that can be loaded.
fn search(candidates: &[PathBuf]) -> Result<Nvrtc, Error> {
    candidates.iter().find_map(|path| Nvrtc::open(path).ok()).ok_or_else(|| Error::NoCompiler {
        searched: candidates.iter().map(|path| path.display().to_string()).collect(),
    })
}

/// Where Python's packages, in this folder, have the library.
fn of_packages(folder: &Path) -> Vec<PathBuf> {
    FOLDERS
        .iter()
        .flat_map(|inner| NAMES.iter().map(move |name| folder.join(inner).join(name)))
        .filter(|x| x.is_file())
        .collect()
}

/// The places of [`Nvrtc::find`], given the variables of the environment.
fn candidates(variable: impl Fn(&str) -> Option<PathBuf>) -> Vec<PathBuf> {
    let mut found = Vec::new();
    if let Some(environment) = variable("VIRTUAL_ENV").or_else(|| variable("CONDA_PREFIX")) {
        let versions = std::fs::read_dir(environment.join("lib")).into_iter().flatten().filter_map(Result::ok);
        let mut packages: Vec<PathBuf> = versions.map(|version| version.path().join("site-packages")).collect();
        packages.push(environment.join("Lib/site-packages"));
        found.extend(packages.iter().flat_map(|folder| of_packages(folder)));
    }
    let toolkit = |folder: PathBuf| ["lib64", "lib", "bin"].map(|inner| folder.join(inner));
    let toolkits = ["CUDA_HOME", "CUDA_PATH"].into_iter().filter_map(&variable).flat_map(toolkit);
    let exists = |folder: PathBuf| NAMES.map(|name| folder.join(name)).into_iter().filter(|path| path.is_file());
    found.extend(toolkits.flat_map(exists));
    found.extend(NAMES.map(PathBuf::from));
    found.extend(toolkit(PathBuf::from("/usr/local/cuda")).into_iter().flat_map(exists));
    found
}

impl Loaded {
    fn compile(&self, key: &Key) -> Result<Binary, Error> {
        let (Key { text, entry, options, .. }, arch) = (key, key.arch);
        let failed = |reason: String, log: String| Error::Compile { entry: entry.to_string(), arch, reason, log };
        let c_string = |text: &str| CString::new(text).map_err(|error| failed(error.to_string(), String::new()));
        let (source, name) = (c_string(text)?, c_string(&format!("{entry}.cu"))?);
        let fixed = [format!("--gpu-architecture={arch}"), "--std=c++17".into(), "--ptxas-options=--verbose".into()];
        let options =
            fixed.iter().chain(options).map(|option| c_string(option)).collect::<Result<Vec<CString>, _>>()?;
        let pointers: Vec<*const c_char> = options.iter().map(|option| option.as_ptr()).collect();

        let mut program = Handle { loaded: self, program: std::ptr::null_mut() };
        type Create = unsafe extern "C" fn(
            *mut Program,
            *const c_char,
            *const c_char,
            c_int,
            *const *const c_char,
            *const *const c_char,
        ) -> c_int;
        let none = std::ptr::null();
        // SAFETY: NVRTC copies the two strings, which end with 0; there are no headers
        self.call("nvrtcCreateProgram", |create: Create| unsafe {
            create(&mut program.program, source.as_ptr(), name.as_ptr(), 0, none, none)
        })
        .map_err(|reason| failed(reason, String::new()))?;
        type Compile = unsafe extern "C" fn(Program, c_int, *const *const c_char) -> c_int;
        let count = c_int::try_from(pointers.len()).unwrap_or(0);
        // SAFETY: the program is alive, as are `count` strings that end with 0
        let result = self.call("nvrtcCompileProgram", |compile: Compile| unsafe {
            compile(program.program, count, pointers.as_ptr())
        });
        let log = self.bytes(&program, "nvrtcGetProgramLogSize", "nvrtcGetProgramLog").unwrap_or_default();
        let log = String::from_utf8_lossy(&log).trim_end_matches('\0').trim().to_string();
        result.map_err(|reason| failed(reason, log.clone()))?;
        let code =
            self.bytes(&program, "nvrtcGetCUBINSize", "nvrtcGetCUBIN").map_err(|reason| failed(reason, log.clone()))?;
        Ok(Binary { code, entry: entry.to_string(), arch, resources: Resources::parse(&log) })
    }

    /// A result of NVRTC: its length by one function, its bytes by another.
    fn bytes(&self, program: &Handle, size: &str, get: &str) -> Result<Vec<u8>, String> {
        let mut length = 0_usize;
        type Size = unsafe extern "C" fn(Program, *mut usize) -> c_int;
        // SAFETY: the program and the number are alive
        self.call(size, |size: Size| unsafe { size(program.program, &mut length) })?;
        let mut bytes = vec![0_u8; length];
        type Get = unsafe extern "C" fn(Program, *mut c_char) -> c_int;
        // SAFETY: NVRTC writes as many bytes as it just said
        self.call(get, |get: Get| unsafe { get(program.program, bytes.as_mut_ptr().cast()) })?;
        Ok(bytes)
    }

    /// Calls the library's function of this name; the error has NVRTC's reason.
    fn call<F: Copy>(&self, name: &str, call: impl FnOnce(F) -> c_int) -> Result<(), String> {
        // SAFETY: each caller names the type that NVRTC declares for this function
        let function: Symbol<F> = unsafe { self.library.get(name) }.map_err(|error| error.to_string())?;
        match call(*function) {
            0 => Ok(()),
            code => Err(self.reason(code)),
        }
    }

    fn reason(&self, code: c_int) -> String {
        type Text = unsafe extern "C" fn(c_int) -> *const c_char;
        // SAFETY: the type that NVRTC declares; it returns a constant string for every number
        match unsafe { self.library.get::<Text>(b"nvrtcGetErrorString") } {
            // SAFETY: as above
            Ok(text) => unsafe { CStr::from_ptr(text(code)) }.to_string_lossy().into_owned(),
            Err(_) => format!("error {code}"),
        }
    }
}

/// A program of NVRTC, destroyed at the end.
struct Handle<'l> {
    loaded: &'l Loaded,
    program: Program,
}

impl Drop for Handle<'_> {
    fn drop(&mut self) {
        if !self.program.is_null() {
            type Destroy = unsafe extern "C" fn(*mut Program) -> c_int;
            // SAFETY: NVRTC made it, and nobody uses it any more; an error would leave it allocated
            let _ = self.loaded.call("nvrtcDestroyProgram", |destroy: Destroy| unsafe { destroy(&mut self.program) });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_environments_packages_come_before_the_toolkit_and_the_system() {
        let folder = std::env::temp_dir().join(format!("mozzi-nvrtc-{}", std::process::id()));
        let inner = folder.join("lib/python3.12/site-packages/nvidia/cuda_nvrtc/lib");
        let toolkit = folder.join("cuda/lib64");
        for folder in [&inner, &toolkit] {
            std::fs::create_dir_all(folder).unwrap();
            std::fs::write(folder.join("libnvrtc.so.12"), "text").unwrap();
        }
        let variable = |name: &str| match name {
            "VIRTUAL_ENV" => Some(folder.clone()),
            "CUDA_HOME" => Some(folder.join("cuda")),
            _ => None,
        };
        let found = candidates(variable);
        assert_eq!(found[..2], [inner.join("libnvrtc.so.12"), toolkit.join("libnvrtc.so.12")]);
        assert_eq!(found[2], Path::new("libnvrtc.so.13"));
        // a file that is no library
        let error = Nvrtc::open(&found[0]).expect_err("text").to_string();
        assert!(error.contains("libnvrtc.so.12 is not NVRTC"), "{error}");
        let error = Nvrtc::in_packages(&[folder.join("lib")]).expect_err("no packages").to_string();
        assert!(error.contains("MOZZI_NVRTC"), "{error}");
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
