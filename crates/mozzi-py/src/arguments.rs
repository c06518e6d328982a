//! Arguments as Python passed them, each in its slot. A missing, unknown or repeated argument raises an error in
//! Python's words.

use crate::signature::{ENVIRONMENT, INPUTS, SLOTS, Signature, Slot};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyString, PyTuple};
use std::fmt::Arguments as Words;

/// An optional argument.
pub type Given<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// The arguments of a call by their slots.
#[derive(Default)]
pub struct Arguments<'a, 'py>([Option<Borrowed<'a, 'py, PyAny>>; SLOTS]);

impl<'a, 'py> Arguments<'a, 'py> {
    /// Only these arguments.
    pub fn of(given: impl IntoIterator<Item = (Slot, Given<'a, 'py>)>) -> Self
    where
        'py: 'a,
    {
        let mut arguments = Arguments::default();
        given.into_iter().for_each(|(slot, value)| arguments.0[slot as usize] = value.map(Bound::as_borrowed));
        arguments
    }

    /// Checks that the signature has all arguments that were given.
    ///
    /// # Errors
    /// `TypeError` for another one.
    pub fn check(given: &[(Slot, Given<'_, '_>)], signature: &Signature) -> PyResult<()> {
        let has = |slot: Slot| signature.arguments.iter().any(|argument| argument.slot == slot);
        match given.iter().find(|(slot, value)| value.is_some() && !has(*slot)) {
            Some((slot, _)) => {
                let name = slot.name().unwrap_or_default();
                Err(wrong(signature, format_args!("got an unexpected keyword argument '{name}'")))
            }
            None => Ok(()),
        }
    }

    /// From positional values, and values with their names.
    ///
    /// # Errors
    /// `TypeError` for an argument that is not in the signature.
    #[inline(always)]
    pub fn fill(
        &mut self,
        signature: &Signature,
        positional: &[Borrowed<'a, 'py, PyAny>],
        names: Option<Borrowed<'a, 'py, PyTuple>>,
        named: &[Borrowed<'a, 'py, PyAny>],
    ) -> PyResult<()> {
        let slots = &mut self.0;
        if positional.len() > signature.positional {
            return Err(too_many(signature, positional.len()));
        }
        let inputs = positional.len().min(signature.required);
        for (slot, &value) in slots[..inputs].iter_mut().zip(positional) {
            *slot = Some(value); // the first slots are the state's, in this order
        }
        for (argument, &value) in signature.arguments.iter().zip(positional).skip(inputs) {
            slots[argument.slot as usize] = Some(value);
        }
        if let Some(names) = names {
            for (name, &value) in names.iter_borrowed().zip(named) {
                let name = name.cast::<PyString>()?;
                let name = name.to_str()?;
                let Some(argument) = signature.arguments.iter().find(|argument| argument.name == name) else {
                    return Err(wrong(signature, format_args!("got an unexpected keyword argument '{name}'")));
                };
                if slots[argument.slot as usize].replace(value).is_some() {
                    return Err(wrong(signature, format_args!("got multiple values for argument '{name}'")));
                }
            }
        }
        if slots[inputs..signature.required].iter().any(Option::is_none) {
            return Err(missing(signature, slots));
        }
        Ok(())
    }

    /// The parts of a `mozzi.Environment` that the signature has; the others have no effect on its quantity.
    ///
    /// # Errors
    /// `TypeError` for another object, and for a part that is also an argument of its own.
    pub fn parts_of(
        &self,
        environment: &Bound<'py, PyAny>,
        signature: &Signature,
    ) -> PyResult<Vec<(Slot, Bound<'py, PyAny>)>> {
        let mut parts = Vec::new();
        if !environment.is_instance(&environment.py().import("mozzi")?.getattr("Environment")?)? {
            let kind = environment.get_type().name()?;
            return Err(PyTypeError::new_err(format!("environment is a {kind}, expected a mozzi.Environment")));
        }
        for argument in signature.arguments.iter().filter(|argument| ENVIRONMENT.contains(&(argument.slot as usize))) {
            let part = environment.getattr(argument.name)?;
            if part.is_none() {
                continue;
            }
            if self.get(argument.slot).is_some() {
                let name = argument.name;
                return Err(wrong(signature, format_args!("got '{name}' both by itself and in 'environment'")));
            }
            parts.push((argument.slot, part));
        }
        Ok(parts)
    }

    /// Sets these arguments, too.
    pub fn extend(&mut self, given: &'a [(Slot, Bound<'py, PyAny>)]) {
        given.iter().for_each(|(slot, value)| self.0[*slot as usize] = Some(value.as_borrowed()));
    }

    /// True if an argument of the environment was given.
    #[inline(always)]
    pub fn have_environment(&self) -> bool {
        self.0[ENVIRONMENT].iter().flatten().any(|value| !value.is_none())
    }

    /// An optional argument, if it was given and is not None.
    #[inline(always)]
    pub fn get(&self, slot: Slot) -> Option<&Bound<'py, PyAny>> {
        self.0[slot as usize].as_deref().filter(|value| !value.is_none())
    }

    /// The inputs of the state, in the order of the declaration.
    #[inline(always)]
    pub fn state(&self) -> impl Iterator<Item = &Bound<'py, PyAny>> {
        self.0[..INPUTS.len()].iter().flatten().map(|value| &**value)
    }
}

#[cold]
fn wrong(signature: &Signature, words: Words) -> PyErr {
    PyTypeError::new_err(format!("Model.{}() {words}", signature.name))
}

#[cold]
fn too_many(signature: &Signature, found: usize) -> PyErr {
    let (least, most) = (signature.required, signature.positional);
    let range = if least == most { most.to_string() } else { format!("from {least} to {most}") };
    let were = if found == 1 { "was" } else { "were" };
    wrong(signature, format_args!("takes {range} positional arguments but {found} {were} given"))
}

#[cold]
fn missing(signature: &Signature, slots: &[Option<Borrowed<'_, '_, PyAny>>]) -> PyErr {
    let required = signature.arguments[..signature.required].iter().zip(slots);
    let names: Vec<String> =
        required.filter(|(_, value)| value.is_none()).map(|(argument, _)| format!("'{}'", argument.name)).collect();
    let list = match &names[..] {
        [one] => one.clone(),
        [one, other] => format!("{one} and {other}"),
        [many @ .., last] => format!("{}, and {last}", many.join(", ")),
        [] => String::new(),
    };
    let s = if names.len() == 1 { "" } else { "s" };
    wrong(signature, format_args!("missing {} required positional argument{s}: {list}", names.len()))
}
