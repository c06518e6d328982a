//! XLA's foreign function interface in C, version 0.1, which every jaxlib since 0.4.31 accepts: the structs, a call's
//! buffers as slices, its attributes, and errors as text.
//!
//! XLA passes pointers to structs that live as long as the call. It declares neither lengths nor types of the buffers
//! on its side, so that everything is checked here. All of the binding's `unsafe` for JAX is in this file.

use super::call::{self, Argument, Attributes};
use super::gpu;
use super::registry::Batched;
use crate::numpy::Element;
use mozzi_engine::Precision;
use mozzi_gpu::Stream;
use pyo3::ffi;
use pyo3::prelude::*;
use std::ffi::{CString, c_char, c_int, c_void};
use std::mem::offset_of;
use std::panic::{AssertUnwindSafe, catch_unwind};

#[repr(C)]
struct Extension {
    struct_size: usize,
    kind: c_int,
    next: *mut Extension,
}
#[repr(C)]
struct Version {
    struct_size: usize,
    extension: *mut Extension,
    major: c_int,
    minor: c_int,
}
/// Newer runtimes have more fields, and the same `struct_size`: no more than these may be written.
#[repr(C)]
struct Metadata {
    struct_size: usize,
    version: Version,
    traits: u32,
}
#[repr(C)]
struct MetadataExtension {
    base: Extension,
    metadata: *mut Metadata,
}
#[repr(C)]
struct ErrorArguments {
    struct_size: usize,
    extension: *mut Extension,
    message: *const c_char,
    code: c_int,
}
#[repr(C)]
struct StreamArguments {
    struct_size: usize,
    extension: *mut Extension,
    context: *mut c_void,
    stream: *mut c_void,
}
/// The first fields of the runtime's table of functions.
#[repr(C)]
struct Api {
    struct_size: usize,
    extension: *mut Extension,
    version: Version,
    internal: *const c_void,
    error_create: unsafe extern "C" fn(*mut ErrorArguments) -> *mut c_void,
    others: [*const c_void; 3],
    stream_get: unsafe extern "C" fn(*mut StreamArguments) -> *mut c_void,
}
#[repr(C)]
struct Buffer {
    struct_size: usize,
    extension: *mut Extension,
    dtype: c_int,
    data: *mut c_void,
    rank: i64,
    dims: *const i64,
}
/// The arguments, or the results.
#[repr(C)]
struct Buffers {
    struct_size: usize,
    extension: *mut Extension,
    size: i64,
    types: *const c_int,
    all: *const *const Buffer,
}
/// A text without a final NUL.
#[repr(C)]
struct Span {
    data: *const u8,
    length: usize,
}
#[repr(C)]
struct ScalarAttribute {
    dtype: c_int,
    value: *const c_void,
}
#[repr(C)]
struct AttributeList {
    struct_size: usize,
    extension: *mut Extension,
    size: i64,
    types: *const c_int,
    names: *const *const Span,
    all: *const *const c_void,
}
/// A call. Newer runtimes have further fields.
#[repr(C)]
pub struct CallFrame {
    struct_size: usize,
    extension: *mut Extension,
    api: *const Api,
    context: *mut c_void,
    stage: c_int,
    arguments: Buffers,
    results: Buffers,
    attributes: AttributeList,
}

/// The kind of extension by which the runtime queries the handler's version, once.
const METADATA: c_int = 1;
const SCALAR: c_int = 3;
const TEXT: c_int = 4;
const INT64: c_int = 5;
const FLOAT32: c_int = 11;
const FLOAT64: c_int = 12;
const INVALID_ARGUMENT: c_int = 3;
const INTERNAL: c_int = 13;
/// The name that XLA expects of a capsule with a handler.
const CAPSULE: &std::ffi::CStr = c"xla._CUSTOM_CALL_TARGET";

/// Expressions of C's header with their values here, for a test that compiles it.
pub const LAYOUT: [(&str, usize); 31] = [
    ("offsetof(XLA_FFI_Extension_Base, type)", offset_of!(Extension, kind)),
    ("offsetof(XLA_FFI_Metadata_Extension, metadata)", offset_of!(MetadataExtension, metadata)),
    ("offsetof(XLA_FFI_Api_Version, minor_version)", offset_of!(Version, minor)),
    ("sizeof(XLA_FFI_Api_Version)", size_of::<Version>()),
    ("offsetof(XLA_FFI_Metadata, api_version)", offset_of!(Metadata, version)),
    ("offsetof(XLA_FFI_Metadata, traits)", offset_of!(Metadata, traits)),
    ("offsetof(XLA_FFI_Error_Create_Args, message)", offset_of!(ErrorArguments, message)),
    ("offsetof(XLA_FFI_Error_Create_Args, errc)", offset_of!(ErrorArguments, code)),
    ("offsetof(XLA_FFI_Api, XLA_FFI_Error_Create)", offset_of!(Api, error_create)),
    ("offsetof(XLA_FFI_Api, XLA_FFI_Stream_Get)", offset_of!(Api, stream_get)),
    ("offsetof(XLA_FFI_Stream_Get_Args, ctx)", offset_of!(StreamArguments, context)),
    ("offsetof(XLA_FFI_Stream_Get_Args, stream)", offset_of!(StreamArguments, stream)),
    ("sizeof(XLA_FFI_Stream_Get_Args)", size_of::<StreamArguments>()),
    ("offsetof(XLA_FFI_Buffer, dtype)", offset_of!(Buffer, dtype)),
    ("offsetof(XLA_FFI_Buffer, data)", offset_of!(Buffer, data)),
    ("offsetof(XLA_FFI_Buffer, rank)", offset_of!(Buffer, rank)),
    ("offsetof(XLA_FFI_Buffer, dims)", offset_of!(Buffer, dims)),
    ("offsetof(XLA_FFI_Args, args)", offset_of!(Buffers, all)),
    ("offsetof(XLA_FFI_Rets, rets)", offset_of!(Buffers, all)),
    ("offsetof(struct XLA_FFI_ByteSpan, len)", offset_of!(Span, length)),
    ("offsetof(struct XLA_FFI_Scalar, value)", offset_of!(ScalarAttribute, value)),
    ("offsetof(XLA_FFI_Attrs, names)", offset_of!(AttributeList, names)),
    ("offsetof(XLA_FFI_Attrs, attrs)", offset_of!(AttributeList, all)),
    ("offsetof(XLA_FFI_CallFrame, api)", offset_of!(CallFrame, api)),
    ("offsetof(XLA_FFI_CallFrame, args)", offset_of!(CallFrame, arguments)),
    ("offsetof(XLA_FFI_CallFrame, rets)", offset_of!(CallFrame, results)),
    ("offsetof(XLA_FFI_CallFrame, attrs)", offset_of!(CallFrame, attributes)),
    ("XLA_FFI_Extension_Metadata", METADATA as usize),
    ("XLA_FFI_AttrType_STRING", TEXT as usize),
    ("XLA_FFI_DataType_S64", INT64 as usize),
    ("XLA_FFI_DataType_F64", FLOAT64 as usize),
];

/// Where the arrays are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Host,
    Gpu,
}

/// The handler, as XLA wants it: a capsule with the function's address.
///
/// # Errors
/// `MemoryError`.
pub fn capsule(py: Python<'_>, place: Place) -> PyResult<Bound<'_, PyAny>> {
    let handler = match place {
        Place::Host => on_host as *const (),
        Place::Gpu => on_gpu as *const (),
    };
    // SAFETY: the address is not null; the name is static.
    unsafe {
        let capsule = ffi::PyCapsule_New(handler.cast_mut().cast(), CAPSULE.as_ptr(), None);
        Bound::from_owned_ptr_or_err(py, capsule)
    }
}

/// The handler that XLA calls on the CPU. Returns null, or an error.
///
/// # Safety
/// The frame is one that the runtime passed.
unsafe extern "C" fn on_host(frame: *mut CallFrame) -> *mut c_void {
    // SAFETY: by the caller
    unsafe { respond(frame, answer) }
}

/// The handler that XLA calls on a GPU. Returns null, or an error.
///
/// # Safety
/// The frame is one that the runtime passed.
unsafe extern "C" fn on_gpu(frame: *mut CallFrame) -> *mut c_void {
    // SAFETY: by the caller
    unsafe { respond(frame, launch) }
}

/// # Safety
/// The frame is one that the runtime passed.
unsafe fn respond(frame: *mut CallFrame, answer: fn(&CallFrame) -> Result<(), String>) -> *mut c_void {
    // SAFETY: the runtime keeps the frame, its extension and the metadata while the handler runs.
    let frame = unsafe {
        if let Some(extension) = (*frame).extension.as_ref()
            && extension.kind == METADATA
        {
            let metadata = (*(*frame).extension.cast::<MetadataExtension>()).metadata;
            (*metadata).version =
                Version { struct_size: size_of::<Version>(), extension: std::ptr::null_mut(), major: 0, minor: 1 };
            (*metadata).traits = 0;
            return std::ptr::null_mut();
        }
        &*frame
    };
    // memory left by a panic means nothing between calls
    let (text, code) = match catch_unwind(AssertUnwindSafe(|| answer(frame))) {
        Ok(Ok(())) => return std::ptr::null_mut(),
        Ok(Err(text)) => (text, INVALID_ARGUMENT),
        Err(_) => ("mozzi panicked; standard error has the message".to_string(), INTERNAL),
    };
    let message = CString::new(text.replace('\0', " ")).unwrap_or_default();
    let mut arguments = ErrorArguments {
        struct_size: size_of::<ErrorArguments>(),
        extension: std::ptr::null_mut(),
        message: message.as_ptr(),
        code,
    };
    // SAFETY: the runtime's function copies the message and returns an error that the runtime frees.
    unsafe { ((*frame.api).error_create)(&mut arguments) }
}

/// Launches the kernel on XLA's stream.
fn launch(frame: &CallFrame) -> Result<(), String> {
    frame.check_size()?;
    let (precision, dtype) = match frame.arguments.buffers().next().map(|buffer| buffer.dtype) {
        Some(FLOAT64) => (Precision::F64, FLOAT64),
        Some(FLOAT32) => (Precision::F32, FLOAT32),
        other => return Err(format!("an argument has XLA's type {other:?}, expected float32 or float64")),
    };
    let attributes = &frame.attributes;
    let kernel =
        gpu::kernel(attributes.integer("model")?, attributes.text("quantity")?, attributes.text("frame")?, precision)?;
    let read = |buffers: &Buffers| -> Result<(Vec<u64>, Vec<usize>), String> {
        let each = buffers.buffers().map(|buffer| {
            let length =
                if precision == Precision::F64 { buffer.length::<f64>(dtype) } else { buffer.length::<f32>(dtype) };
            Ok((buffer.data as u64, length?))
        });
        Ok(each.collect::<Result<Vec<_>, String>>()?.into_iter().unzip())
    };
    let ((inputs, given), (outputs, wanted)) = (read(&frame.arguments)?, read(&frame.results)?);
    let states = gpu::states(&kernel, &given, &wanted)?;
    let stream = Stream(frame.stream()? as usize);
    // SAFETY: XLA's buffers are on its device, have the checked lengths, and are used on this stream
    unsafe { kernel.launch(&inputs, &outputs, states, stream) }.map_err(|error| error.to_string())
}

impl CallFrame {
    fn check_size(&self) -> Result<(), String> {
        let (found, expected) = (self.struct_size, size_of::<CallFrame>());
        match found < expected {
            true => Err(format!("XLA's call has {found} bytes, expected at least {expected}: jaxlib is too old")),
            false => Ok(()),
        }
    }

    /// The stream of a call on a GPU.
    fn stream(&self) -> Result<*mut c_void, String> {
        let (extension, stream) = (std::ptr::null_mut(), std::ptr::null_mut());
        let struct_size = size_of::<StreamArguments>();
        let mut arguments = StreamArguments { struct_size, extension, context: self.context, stream };
        // SAFETY: the runtime's function fills in the stream, or returns an error
        let error = unsafe { ((*self.api).stream_get)(&mut arguments) };
        if error.is_null() { Ok(arguments.stream) } else { Err("XLA has no stream for this call".into()) }
    }
}

fn answer(frame: &CallFrame) -> Result<(), String> {
    frame.check_size()?;
    let attributes = Attributes {
        model: frame.attributes.integer("model")?,
        quantity: frame.attributes.text("quantity")?,
        frame: frame.attributes.text("frame")?,
        has_parameters: frame.attributes.integer("parameters")? != 0,
        along: [frame.attributes.integer("along")?, frame.attributes.integer("along_too")?],
        wanted: frame.attributes.integer("wanted")?,
        threads: frame.attributes.integer("threads")?,
    };
    let dtype = frame.arguments.buffers().next().map(|buffer| buffer.dtype);
    match dtype {
        Some(FLOAT64) => run::<f64>(frame, &attributes, FLOAT64),
        Some(FLOAT32) => run::<f32>(frame, &attributes, FLOAT32),
        other => Err(format!("an argument has XLA's type {other:?}, expected float32 or float64")),
    }
}

fn run<T: Element + Batched>(frame: &CallFrame, attributes: &Attributes, dtype: c_int) -> Result<(), String> {
    let mut arguments = Vec::with_capacity(8);
    for buffer in frame.arguments.buffers() {
        let length = buffer.length::<T>(dtype)?;
        let numbers = match length {
            0 => &[],
            // SAFETY: the buffer has this many numbers of this type, aligned; nothing writes to it during the call.
            _ => unsafe { std::slice::from_raw_parts(buffer.data.cast::<T>(), length) },
        };
        arguments.push(Argument { shape: buffer.shape(), numbers });
    }
    let mut results = Vec::with_capacity(4);
    for buffer in frame.results.buffers() {
        let length = buffer.length::<T>(dtype)?;
        let numbers = match length {
            0 => &mut [][..],
            // SAFETY: as above; XLA gives each result memory of its own, because no result is declared to share an
            // argument's.
            _ => unsafe { std::slice::from_raw_parts_mut(buffer.data.cast::<T>(), length) },
        };
        results.push(numbers);
    }
    call::run(attributes, &arguments, results)
}

impl Buffers {
    fn buffers(&self) -> impl Iterator<Item = &Buffer> {
        // SAFETY: there are `size` pointers to buffers, which live as long as the call.
        (0..self.size as usize).map(|k| unsafe { &**self.all.add(k) })
    }
}

impl Buffer {
    fn shape(&self) -> &[i64] {
        match self.rank {
            0 => &[],
            // SAFETY: a buffer has as many dimensions as its rank.
            rank => unsafe { std::slice::from_raw_parts(self.dims, rank as usize) },
        }
    }

    /// The number of entries, if they are of this type.
    fn length<T>(&self, dtype: c_int) -> Result<usize, String> {
        if self.dtype != dtype {
            return Err(format!("an argument has XLA's type {}, expected {dtype} as the others", self.dtype));
        }
        let length = self.shape().iter().product::<i64>() as usize;
        let is_sound = length == 0 || (!self.data.is_null() && self.data.cast::<T>().is_aligned());
        if is_sound { Ok(length) } else { Err("a buffer's address is not aligned".into()) }
    }
}

impl AttributeList {
    /// The value of an attribute of this kind.
    fn find(&self, name: &str, kind: c_int) -> Result<*const c_void, String> {
        for k in 0..self.size as usize {
            // SAFETY: there are `size` types, names and values; they live as long as the call.
            let (found, known, value) = unsafe { (*self.types.add(k), (**self.names.add(k)).text(), *self.all.add(k)) };
            if known == name.as_bytes() {
                return if found == kind { Ok(value) } else { Err(format!("attribute {name} is of kind {found}")) };
            }
        }
        Err(format!("attribute {name} is missing"))
    }

    fn integer(&self, name: &str) -> Result<i64, String> {
        let value = self.find(name, SCALAR)?.cast::<ScalarAttribute>();
        // SAFETY: a scalar attribute points to this struct.
        match unsafe { &*value } {
            // SAFETY: one of type 5 points to an i64.
            ScalarAttribute { dtype: INT64, value } => Ok(unsafe { value.cast::<i64>().read_unaligned() }),
            other => Err(format!("attribute {name} has XLA's type {}, expected int64", other.dtype)),
        }
    }

    fn text(&self, name: &str) -> Result<&str, String> {
        let value = self.find(name, TEXT)?.cast::<Span>();
        // SAFETY: a text attribute points to a span.
        std::str::from_utf8(unsafe { (*value).text() }).map_err(|error| format!("attribute {name}: {error}"))
    }
}

impl Span {
    /// # Safety
    /// The span is one of the runtime's, whose text lives as long as the call.
    unsafe fn text<'a>(&self) -> &'a [u8] {
        match self.length {
            0 => &[],
            // SAFETY: by the caller.
            length => unsafe { std::slice::from_raw_parts(self.data, length) },
        }
    }
}
