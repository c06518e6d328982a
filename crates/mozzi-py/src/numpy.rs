//! NumPy's arrays, through NumPy's C interface: a table of numbers is borrowed as a slice, and results are arrays from
//! the start. The buffer protocol is in Python's stable interface only from 3.11 on, and is slower.
//!
//! The binding's `unsafe` is here, except that of methods. A slice borrows an array's memory, which the reference to
//! the array keeps alive. While the GIL is held, no other code can write there. Batches run without the GIL: a thread
//! that writes to an array on which another thread computes causes a data race, as with every library that computes on
//! NumPy's arrays.

use pyo3::exceptions::PyImportError;
use pyo3::ffi;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyCapsule;
use std::ffi::{c_char, c_int, c_void};
use std::marker::PhantomData;

/// The head of a `PyArrayObject`, the same in NumPy 1 and 2.
#[repr(C)]
struct ArrayObject {
    object: ffi::PyObject,
    data: *mut c_char,
    rank: c_int,
    dimensions: *mut isize,
    strides: *mut isize,
    base: *mut ffi::PyObject,
    dtype: *mut ffi::PyObject,
    flags: c_int,
}

/// The head of a `PyArray_Descr`, the same in NumPy 1 and 2.
#[repr(C)]
struct DtypeObject {
    object: ffi::PyObject,
    scalar: *mut ffi::PyTypeObject,
    kind: c_char,
    letter: c_char,
    byte_order: c_char,
    flags: c_char,
    number: c_int,
}

/// NumPy's symbol for native byte order.
const OWN_ORDER: [u8; 2] = [b'=', if cfg!(target_endian = "little") { b'<' } else { b'>' }];

const C_CONTIGUOUS: c_int = 0x1;
const ALIGNED: c_int = 0x100;
const WRITEABLE: c_int = 0x400;

// NumPy's type numbers of two dtypes, and the indices in its table of functions.
const FLOAT32: c_int = 11;
const FLOAT64: c_int = 12;
const ARRAY_TYPE: usize = 2;
const DTYPE_OF_NUMBER: usize = 45;
const ZEROS: usize = 183;

type Zeros = unsafe extern "C" fn(c_int, *const isize, *mut ffi::PyObject, c_int) -> *mut ffi::PyObject;

struct Api {
    array_type: *mut ffi::PyTypeObject,
    /// The dtypes float32 and float64 in native byte order.
    dtypes: [*mut ffi::PyObject; 2],
    zeros: Zeros,
}

// SAFETY: addresses of NumPy's own objects, which live as long as the process.
unsafe impl Send for Api {}
// SAFETY: as above; nothing is written.
unsafe impl Sync for Api {}

static API: PyOnceLock<Api> = PyOnceLock::new();

/// Number types that NumPy's arrays and mozzi share.
pub trait Element: mozzi_engine::Number + Default {
    /// NumPy's name for it.
    const NAME: &'static str;
    /// NumPy's type number.
    const NUMBER: c_int;
    /// Its index in `Api::dtypes`.
    const PLACE: usize;
    fn to_f64(self) -> f64;
}
impl Element for f32 {
    fn to_f64(self) -> f64 {
        self.into()
    }
    const NAME: &'static str = "float32";
    const NUMBER: c_int = FLOAT32;
    const PLACE: usize = 0;
}
impl Element for f64 {
    fn to_f64(self) -> f64 {
        self
    }
    const NAME: &'static str = "float64";
    const NUMBER: c_int = FLOAT64;
    const PLACE: usize = 1;
}

/// Finds NumPy. Must be called when the module is imported, before any other function here.
///
/// # Errors
/// `ImportError` if NumPy is not installed.
pub fn prepare(py: Python<'_>) -> PyResult<()> {
    let import = |name| py.import(name);
    let module = import("numpy._core._multiarray_umath").or_else(|_| import("numpy.core._multiarray_umath"))?;
    let capsule = module.getattr("_ARRAY_API")?.cast_into::<PyCapsule>()?;
    let table = capsule.pointer_checked(None)?.cast::<*mut c_void>();
    API.get_or_try_init(py, || {
        // SAFETY: NumPy's table has these functions at these indices in all versions since 1.0; it is never freed.
        let api = unsafe {
            let at = |place: usize| *table.as_ptr().add(place);
            let dtype: unsafe extern "C" fn(c_int) -> *mut ffi::PyObject = std::mem::transmute(at(DTYPE_OF_NUMBER));
            Api {
                array_type: at(ARRAY_TYPE).cast(),
                dtypes: [dtype(FLOAT32), dtype(FLOAT64)],
                zeros: std::mem::transmute::<*mut c_void, Zeros>(at(ZEROS)),
            }
        };
        if api.dtypes.iter().any(|dtype| dtype.is_null()) {
            return Err(PyImportError::new_err("NumPy has no float32 or float64"));
        }
        Ok(api)
    })?;
    Ok(())
}

fn api(py: Python<'_>) -> &'static Api {
    API.get(py).expect("prepared when the module was imported")
}

/// The array, if it is of NumPy's own type, has this number type, and is C-contiguous.
#[inline(always)]
fn behaved<'a, T: Element>(array: &'a Bound<'_, PyAny>) -> Option<&'a ArrayObject> {
    let api = api(array.py());
    // SAFETY: the object is alive, and is an array if its type is NumPy's.
    unsafe {
        if ffi::Py_TYPE(array.as_ptr()) != api.array_type {
            return None;
        }
        let fields = &*array.as_ptr().cast::<ArrayObject>();
        let whole = fields.flags & (C_CONTIGUOUS | ALIGNED) == C_CONTIGUOUS | ALIGNED;
        (whole && (fields.dtype == api.dtypes[T::PLACE] || is_equal::<T>(fields.dtype))).then_some(fields)
    }
}

/// True if this dtype is equal but a different object, as after unpickling an array.
///
/// # Safety
/// The argument is the dtype of an array.
unsafe fn is_equal<T: Element>(dtype: *mut ffi::PyObject) -> bool {
    // SAFETY: an array keeps its dtype, which has this layout.
    let dtype = unsafe { &*dtype.cast::<DtypeObject>() };
    dtype.number == T::NUMBER && OWN_ORDER.contains(&(dtype.byte_order as u8))
}

/// The array's shape.
#[inline(always)]
fn lengths(array: &ArrayObject) -> &[usize] {
    match array.rank {
        0 => &[],
        // SAFETY: an array has as many lengths as its rank; none is negative.
        rank => unsafe { std::slice::from_raw_parts(array.dimensions.cast::<usize>(), rank as usize) },
    }
}

/// Shape and numbers of an array that needs no conversion.
#[inline(always)]
pub fn view<'a, T: Element>(array: &'a Bound<'_, PyAny>) -> Option<(&'a [usize], &'a [T])> {
    let fields = behaved::<T>(array)?;
    let shape = lengths(fields);
    Some((shape, numbers(fields, count(shape))))
}

/// The numbers of an array of this one length that needs no conversion.
#[inline(always)]
pub fn vector<'a, T: Element>(array: &'a Bound<'_, PyAny>, length: usize) -> Option<&'a [T]> {
    let fields = behaved::<T>(array)?;
    (lengths(fields) == [length]).then(|| numbers(fields, length))
}

/// All numbers of an array that [behaves](behaved); there are this many.
#[inline(always)]
fn numbers<T: Element>(array: &ArrayObject, length: usize) -> &[T] {
    if length == 0 {
        return &[];
    }
    // SAFETY: an aligned array without gaps has this many numbers at `data`.
    unsafe { std::slice::from_raw_parts(array.data.cast::<T>(), length) }
}

/// Shape and numbers of an array to write into, which needs no conversion and shares no memory with the inputs. A
/// method calls this once for each array of `out`, with the other arrays of `out` among the inputs.
#[allow(clippy::mut_from_ref)] // NumPy owns the memory, the reference only keeps it alive
pub fn view_mut<'a, 'i, 'py: 'i, T: Element>(
    array: &'a Bound<'_, PyAny>,
    mut inputs: impl Iterator<Item = &'i Bound<'py, PyAny>>,
) -> Option<(&'a [usize], &'a mut [T])> {
    let fields = behaved::<T>(array)?;
    let shape = lengths(fields);
    let length = count(shape);
    let first = fields.data as usize;
    let end = first + length * size_of::<T>();
    let apart = |input: &Bound<'_, PyAny>| match view::<T>(input) {
        Some((_, numbers)) => {
            let start = numbers.as_ptr() as usize;
            start + size_of_val(numbers) <= first || end <= start
        }
        None => false,
    };
    if fields.flags & WRITEABLE == 0 || !inputs.all(apart) {
        return None;
    }
    if length == 0 {
        return Some((shape, &mut []));
    }
    // SAFETY: as in `view`; the array is writable, and no input's slice lies in it.
    Some((shape, unsafe { std::slice::from_raw_parts_mut(fields.data.cast::<T>(), length) }))
}

/// A new array of zeros, to be filled before Python gets it.
pub struct Fresh<'py, T> {
    array: Bound<'py, PyAny>,
    length: usize,
    has_no_axes: bool,
    of: PhantomData<T>,
}

impl<'py, T: Element> Fresh<'py, T> {
    /// # Errors
    /// `MemoryError`, or `ValueError` for more than NumPy can count.
    #[inline(always)]
    pub fn new(py: Python<'py>, shape: &[usize]) -> PyResult<Self> {
        let api = api(py);
        let dtype = api.dtypes[T::PLACE];
        // SAFETY: the function takes ownership of a reference to the dtype, and reads the lengths. It returns a new
        // reference to an array, or null with Python's error set.
        let array = unsafe {
            ffi::Py_IncRef(dtype);
            let array = (api.zeros)(shape.len() as c_int, shape.as_ptr().cast(), dtype, 0);
            Bound::from_owned_ptr_or_err(py, array)?
        };
        Ok(Fresh { array, length: count(shape), has_no_axes: shape.is_empty(), of: PhantomData })
    }

    #[inline(always)]
    pub fn numbers(&mut self) -> &mut [T] {
        // SAFETY: the array was made with this many numbers of this type, and is not shared yet. An empty one has a
        // valid address, too.
        unsafe {
            let data = (*self.array.as_ptr().cast::<ArrayObject>()).data;
            std::slice::from_raw_parts_mut(data.cast::<T>(), self.length)
        }
    }

    /// The number of entries.
    pub fn len(&self) -> usize {
        self.length
    }

    /// True if it is a single number, without axes.
    pub fn has_no_axes(&self) -> bool {
        self.has_no_axes
    }

    pub fn into_array(self) -> Bound<'py, PyAny> {
        self.array
    }
}

/// The number of entries of an existing array: the product of its lengths does not overflow, but a partial product may,
/// if another length is 0.
fn count(shape: &[usize]) -> usize {
    shape.iter().fold(1, |product: usize, &length| product.wrapping_mul(length))
}
