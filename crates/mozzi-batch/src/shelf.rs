//! Memory that calls leave behind for those that follow: for a few states it would take longer to make than they take to compute.

use std::any::Any;
use std::fmt;
use std::sync::{Arc, Mutex};

/// What is not in use. Clones share it.
#[derive(Clone, Default)]
pub(crate) struct Shelf(Arc<Mutex<Vec<Box<dyn Any + Send>>>>);

impl fmt::Debug for Shelf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Shelf")
    }
}

/// Memory of one kind, from a shelf if it has any; it returns there, but not from a panic.
pub(crate) struct Lent<'s, M: Any + Send> {
    shelf: &'s Shelf,
    memory: Option<Box<M>>,
}

impl Shelf {
    pub fn lend<M: Any + Send>(&self) -> Lent<'_, M> {
        Lent { shelf: self, memory: None }
    }

    fn find<M: Any + Send>(&self) -> Option<Box<M>> {
        let mut list = self.0.lock().ok()?;
        let place = list.iter().position(|memory| memory.is::<M>())?;
        list.swap_remove(place).downcast().ok()
    }
}

impl<M: Any + Send> Lent<'_, M> {
    /// The memory, made if there is none.
    pub fn get(&mut self, make: impl FnOnce() -> M) -> &mut M {
        self.memory.get_or_insert_with(|| self.shelf.find().unwrap_or_else(|| Box::new(make())))
    }
}

impl<M: Any + Send> Drop for Lent<'_, M> {
    fn drop(&mut self) {
        if let (Some(memory), Ok(mut list), false) = (self.memory.take(), self.shelf.0.lock(), std::thread::panicking())
        {
            list.push(memory);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Shelf;

    #[test]
    fn what_was_lent_comes_back_to_its_kind() {
        let shelf = Shelf::default();
        shelf.lend::<Vec<u8>>().get(Vec::new).push(1);
        let (mut first, mut second, mut other) =
            (shelf.lend::<Vec<u8>>(), shelf.lend::<Vec<u8>>(), shelf.lend::<String>());
        assert_eq!(first.get(Vec::new), &[1]);
        assert!(second.get(Vec::new).is_empty(), "one at a time");
        assert!(other.get(String::new).is_empty());
        drop((first, second, other));
        assert_eq!(shelf.0.lock().map(|list| list.len()).ok(), Some(3));
    }
}
