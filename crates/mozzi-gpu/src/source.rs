//! The text of a kernel.

use crate::cache::Key;
use crate::guarded;
use crate::order;
use crate::{Arch, Binary, Error, Number, Nvrtc};
use mozzi::Model;
use mozzi::quantities::Query;
use mozzi_engine::{Block, CudaLayout, Language, Precision, Program, emit_programs};
use std::sync::Arc;

/// How a kernel's numbers are stored. By default `f32`, by rows, full matrices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Form {
    /// The number type, in which it also computes.
    pub precision: Precision,
    /// The order of the numbers of many states.
    pub layout: CudaLayout,
    /// Symmetric matrices as their lower triangles by rows: entry (i, j), i ≥ j, at i(i + 1)/2 + j.
    pub is_packed: bool,
}

impl Default for Form {
    fn default() -> Self {
        Form { precision: Precision::F32, layout: CudaLayout::Rows, is_packed: false }
    }
}

/// An array that a kernel reads or writes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Argument {
    /// Its name, such as `theta`.
    pub name: String,
    /// Numbers for each state.
    pub length: usize,
}

impl Argument {
    /// Checks the length of an array of this many states.
    pub(crate) fn check(&self, found: usize, states: usize) -> Result<(), Error> {
        let (what, width, expected) = (self.name.clone(), self.length, self.length * states);
        if found == expected { Ok(()) } else { Err(Error::WrongLength { what, found, expected, states, width }) }
    }
}

/// A kernel as CUDA C. It depends only on the robot's numbers, the quantity and the form.
#[derive(Clone, Debug)]
pub struct Source {
    pub(crate) text: String,
    pub(crate) entry: String,
    pub(crate) inputs: Vec<Argument>,
    pub(crate) outputs: Vec<Argument>,
    pub(crate) form: Form,
    pub(crate) block: Block,
    /// Options that leave out other kernels of the text.
    pub(crate) kernels: &'static str,
}

impl Source {
    /// The kernel of a quantity of this robot, in the robot's own gravity, its base at rest, without applied wrenches.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for tasks, and for packed forms of quantities that have no symmetric matrix; the errors
    /// of [`record_quantity`](mozzi_engine::record_quantity) and [`emit`](mozzi_engine::emit).
    pub fn new<'q>(model: &Model, query: impl Into<Query<'q>>, form: Form) -> Result<Source, Error> {
        let program = guarded::program(model, query.into(), form.precision, form.is_packed)?;
        let program = order::ordered(program, model.n());
        Source::of_program(&model.description().name, &program, form)
    }

    /// The kernel of any program; `name` is the first part of its names. The form's matrices are ignored.
    ///
    /// # Errors
    /// [`Error::Emit`].
    pub fn of_program(name: &str, program: &Program, form: Form) -> Result<Source, Error> {
        let files = emit_programs(name, std::slice::from_ref(program), Language::Cuda, form.precision)?;
        let text: String = files.into_iter().map(|file| file.text).collect();
        let ending = format!("_{}(", form.layout.name());
        let entry = text
            .lines()
            .find_map(|line| Some(format!("{}{}", line.split_once(&ending)?.0, &ending[..ending.len() - 1])));
        let arguments = |arrays: Vec<(&str, usize)>| {
            arrays.into_iter().map(|(name, length)| Argument { name: name.to_string(), length }).collect()
        };
        Ok(Source {
            entry: entry.unwrap_or_else(|| unreachable!("the text has a kernel of each layout")),
            text,
            inputs: arguments(program.inputs().iter().map(|x| (x.name.as_str(), x.length)).collect()),
            outputs: arguments(program.outputs().iter().map(|x| (x.name.as_str(), x.values.len())).collect()),
            form,
            block: Block::of(program, form.layout, form.precision),
            kernels: match form.layout {
                CudaLayout::Rows => "-DMOZZI_ONLY_ROWS",
                CudaLayout::Columns => "-DMOZZI_ONLY_COLUMNS",
            },
        })
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The kernel's name in the text.
    pub fn entry(&self) -> &str {
        &self.entry
    }

    /// The arrays that it reads, in the order of its parameters.
    pub fn inputs(&self) -> &[Argument] {
        &self.inputs
    }

    /// The arrays that it writes, in the order of its parameters, after the inputs.
    pub fn outputs(&self) -> &[Argument] {
        &self.outputs
    }

    /// How its numbers are stored.
    pub fn form(&self) -> Form {
        self.form
    }

    /// The threads of a block.
    pub fn threads(&self) -> usize {
        self.block.threads
    }

    /// States that a thread should compute if there are many: more than 1 if the program is so long that its
    /// instructions do not stay in a multiprocessor. The kernel is right with any number of threads.
    pub fn states_of_thread(&self) -> usize {
        self.block.states
    }

    /// Bytes that a state reads and writes.
    pub fn bytes_of_state(&self) -> usize {
        let numbers: usize = self.inputs.iter().chain(&self.outputs).map(|array| array.length).sum();
        numbers * if self.form.precision == Precision::F64 { 8 } else { 4 }
    }

    /// Compiles it. Equal texts are compiled once for each architecture and NVRTC of a process; the
    /// variable `MOZZI_GPU_CACHE` names a folder that keeps the code for later processes. No GPU is needed.
    ///
    /// # Errors
    /// [`Error::Compile`].
    pub fn compile(&self, nvrtc: &Nvrtc, arch: Arch) -> Result<Arc<Binary>, Error> {
        let (text, entry) = (self.text.clone(), self.entry.clone());
        nvrtc.compile(Key { text, entry, arch, options: self.options() })
    }

    /// The number of states in inputs of these lengths, of numbers of this type.
    pub(crate) fn states<T: Number>(&self, lengths: &[usize]) -> Result<usize, Error> {
        if T::PRECISION != self.form.precision {
            let (found, expected) = (T::PRECISION, self.form.precision);
            return Err(Error::WrongPrecision { entry: self.entry.clone(), found, expected });
        }
        if lengths.len() != self.inputs.len() {
            let (found, expected) = (lengths.len(), self.inputs.len());
            return Err(Error::WrongCount { entry: self.entry.clone(), what: "inputs", found, expected });
        }
        let first = self.inputs.iter().zip(lengths).find(|(input, _)| input.length > 0);
        let states = first.map_or(0, |(input, found)| found / input.length);
        self.inputs.iter().zip(lengths).try_for_each(|(input, &found)| input.check(found, states))?;
        Ok(states)
    }

    /// NVRTC's options besides the architecture.
    pub(crate) fn options(&self) -> Vec<String> {
        self.kernels.split(' ').map(String::from).collect()
    }
}
