//! A function by its module and name.

#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Function {
    pub module: &'static str,
    pub name: &'static str,
}

/// The functions that are types.
pub(crate) const TYPES: [&str; 11] =
    ["list", "dict", "map", "str", "float", "int", "bool", "tuple", "set", "frozenset", "type"];

/// Names of types that are not functions here.
fn is_type_name(name: &str) -> bool {
    ["complex", "enumerate", "filter", "reversed", "slice", "zip"].contains(&name)
}

impl Function {
    pub fn is_type(self) -> bool {
        self.module == "python" && (TYPES.contains(&self.name) || ["range", "zip"].contains(&self.name))
    }

    /// As Python prints it, if that is the same in each run.
    pub fn shown(self) -> Option<String> {
        match self.module {
            "xacro" => None,
            // xacro wraps these two
            "python" if self.name == "sorted" || self.name == "range" => None,
            _ if self.is_type() || self.module == "python" && is_type_name(self.name) => {
                Some(format!("<class '{}'>", self.name))
            }
            _ => Some(format!("<built-in function {}>", self.name)),
        }
    }
}
