//! All chunks of a call, on this batch's threads.

use crate::Number;
use crate::chunk::Chunk;
use crate::lanes::Lane;
use crate::pool::Pool;
use crate::request::Request;
use crate::threads::Threads;
use crate::worker::Worker;
use mozzi::Model;

/// One call's work: the request, its chunks, and the threads that compute them.
pub struct Run<'r, 'a, T> {
    pub(crate) model: &'r Model<T>,
    pub(crate) threads: &'r Threads,
    pub(crate) pool: &'r Pool,
    pub(crate) request: &'r Request<'r, T>,
    pub(crate) chunks: Vec<Chunk<'a, T>>,
}

/// States that failed, with their errors.
pub type Errors = Vec<(usize, mozzi::Error)>;

impl<T: Number> Run<'_, '_, T> {
    pub(crate) fn map<L: Lane<Number = T>>(
        self,
        entry: impl Fn(&Request<T>, &Model<T>, &mut Worker<L>, Chunk<T>) + Sync,
    ) -> Errors {
        let (model, request) = (self.model, self.request);
        let errors = self.threads.map(
            self.chunks,
            || self.pool.lend::<Worker<L>>(),
            |lent, chunk| {
                let worker = lent.get(|| Worker::new(model));
                entry(request, model, worker, chunk);
                core::mem::take(&mut worker.errors)
            },
        );
        errors.concat()
    }
}
