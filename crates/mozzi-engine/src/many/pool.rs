//! Memory that is reused between calls: for a few states, allocating it would take longer than the computation.

use std::any::Any;
use std::fmt;
use std::sync::{Arc, Mutex};

/// The memory that is not in use. Clones share it.
#[derive(Clone, Default)]
pub(crate) struct Pool(Arc<Mutex<Vec<Box<dyn Any + Send>>>>);

impl fmt::Debug for Pool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Pool")
    }
}

/// Memory of one kind, taken from a pool if the pool has any. It returns to the pool when dropped, except in a panic.
pub(crate) struct Pooled<'s, M: Any + Send> {
    pool: &'s Pool,
    memory: Option<Box<M>>,
}

impl Pool {
    pub fn lend<M: Any + Send>(&self) -> Pooled<'_, M> {
        Pooled { pool: self, memory: None }
    }

    fn find<M: Any + Send>(&self) -> Option<Box<M>> {
        let mut list = self.0.lock().ok()?;
        let place = list.iter().position(|memory| memory.is::<M>())?;
        list.swap_remove(place).downcast().ok()
    }
}

impl<M: Any + Send> Pooled<'_, M> {
    /// Takes memory from the pool, or makes it if there is none.
    pub fn get(&mut self, make: impl FnOnce() -> M) -> &mut M {
        self.memory.get_or_insert_with(|| self.pool.find().unwrap_or_else(|| Box::new(make())))
    }
}

impl<M: Any + Send> Drop for Pooled<'_, M> {
    fn drop(&mut self) {
        if let (Some(memory), Ok(mut list), false) = (self.memory.take(), self.pool.0.lock(), std::thread::panicking())
        {
            list.push(memory);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Pool;

    #[test]
    fn what_was_lent_comes_back_to_its_kind() {
        let pool = Pool::default();
        pool.lend::<Vec<u8>>().get(Vec::new).push(1);
        let (mut first, mut second, mut other) =
            (pool.lend::<Vec<u8>>(), pool.lend::<Vec<u8>>(), pool.lend::<String>());
        assert_eq!(first.get(Vec::new), &[1]);
        assert!(second.get(Vec::new).is_empty(), "one at a time");
        assert!(other.get(String::new).is_empty());
        drop((first, second, other));
        assert_eq!(pool.0.lock().map(|list| list.len()).ok(), Some(3));
    }
}
