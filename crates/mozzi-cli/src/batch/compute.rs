//! A quantity at all states of a file, with progress.

use super::quantity::{Precision, Quantity};
use super::results::Output;
use super::states::{States, width};
use crate::failure::{Failure, Result};
use crate::interrupt;
use crate::progress::Progress;
use mozzi::{Environment, FrameId};
use mozzi_batch::{Batch, BatchEnvironment, Error};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// So many states are computed first, between two looks at the clock; then twice or half as many, until a piece takes about as long.
const FIRST: usize = 256;
const PIECE: [Duration; 2] = [Duration::from_millis(40), Duration::from_millis(160)];

/// The results, and the seconds that they took: of all states, or, after Ctrl-C, of as many as the results' shapes say.
pub fn compute<T: Precision>(
    batch: &Batch<T>,
    quantity: Quantity,
    states: States,
    environment: Environment,
) -> Result<(Vec<Output<T>>, f64)> {
    let (model, States { file, count, tables }) = (batch.model(), states);
    let to_T = |(name, table): (_, Vec<f64>)| (name, table.into_iter().map(T::from_f64).collect());
    let tables: BTreeMap<&'static str, Vec<T>> = tables.into_iter().map(to_T).collect();
    let tip: Option<FrameId> = tables.get("wrench").map(|_| model.end_effector()).transpose()?;
    let mut outputs: Vec<Output<T>> =
        quantity.outputs().iter().map(|&output| Output::new(model, output, count)).collect();
    interrupt::listen();
    let (progress, start) = (Progress::new(quantity.name(), count, "states"), Instant::now());
    let (mut first, mut piece) = (0, FIRST);
    while first < count && !interrupt::asked() {
        let (begin, these) = (Instant::now(), piece.min(count - first));
        let input = |name: &'static str| {
            let (table, width) = (tables.get(name).map_or(&[][..], |table| table), width(model, name));
            &table[first * width..][..these * width]
        };
        let wrenches: Vec<(FrameId, &[T])> = tip.map(|tip| (tip, input("wrench"))).into_iter().collect();
        let surroundings = BatchEnvironment { environment, wrenches: &wrenches };
        let slices = outputs.iter_mut().map(|output| {
            let width = output.width();
            &mut output.values[first * width..][..these * width]
        });
        T::evaluate(batch, quantity, &input, &surroundings, slices.collect()).map_err(|error| match error {
            Error::State { index, source } => {
                Failure::wrong(format!("{file}: state {} (counted from 0): {source}", first + index))
            }
            other => Failure::wrong(format!("{file}: {other}")),
        })?;
        first += these;
        progress.at(first);
        piece = match begin.elapsed() {
            short if short < PIECE[0] => piece.saturating_mul(2),
            long if long > PIECE[1] => (piece / 2).max(1),
            _ => piece,
        };
    }
    let seconds = start.elapsed().as_secs_f64();
    outputs.iter_mut().for_each(|output| output.truncate(first));
    Ok((outputs, seconds))
}
