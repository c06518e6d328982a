//! An array with its name and shape.

/// Numbers by rows.
#[derive(Debug, PartialEq)]
pub struct Array<T = f64> {
    pub name: String,
    pub shape: Vec<usize>,
    pub values: Vec<T>,
}

impl<T> Array<T> {
    pub fn new(name: &str, shape: Vec<usize>, values: Vec<T>) -> Self {
        Array { name: name.to_string(), shape, values }
    }

    /// The number of values in one entry of the first axis.
    pub fn width(&self) -> usize {
        self.shape[1..].iter().product()
    }

    /// The first entries of the first axis alone.
    pub fn truncate(&mut self, count: usize) {
        self.values.truncate(count * self.width());
        self.shape[0] = count;
    }
}

/// "(100, 6)", "(100,)"
pub fn tuple(shape: &[usize]) -> String {
    match shape {
        [one] => format!("({one},)"),
        _ => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}
