//! A quantity at all states of a file, with progress.

use super::quantity::{Precision, Quantity};
use super::results::Output;
use super::states::{States, width};
use crate::failure::{Failure, Result};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use mozzi::{Environment, FrameId};
use mozzi_batch::{Batch, Error, Surroundings};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// About as many numbers are computed at a time, between two looks at the clock.
const PIECE: usize = 1 << 22;

/// The progress of what may be long: shown after a second, where standard error is a terminal.
pub struct Progress {
    bar: ProgressBar,
    since: Instant,
}

impl Progress {
    pub fn new(count: u64, what: &str) -> Self {
        let bar = ProgressBar::with_draw_target(Some(count), ProgressDrawTarget::hidden());
        let template = format!("{{bar:40}} {{human_pos}}/{{human_len}} {what}, {{per_sec}}, {{eta}} left");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
        Progress { bar, since: Instant::now() }
    }

    pub fn set(&self, done: u64) {
        if self.bar.is_hidden() && self.since.elapsed() > Duration::from_secs(1) {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.set_position(done);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// The results, and the seconds that they took.
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
    let widths = tables.keys().map(|name| width(model, name)).chain(outputs.iter().map(Output::width));
    let piece = (PIECE / widths.sum::<usize>().max(1)).max(1);

    let progress = Progress::new(count as u64, "states");
    let start = Instant::now();
    for first in (0..count).step_by(piece) {
        let these = piece.min(count - first);
        let input = |name: &'static str| {
            let (table, width) = (tables.get(name).map_or(&[][..], |table| table), width(model, name));
            &table[first * width..][..these * width]
        };
        let wrenches: Vec<(FrameId, &[T])> = tip.map(|tip| (tip, input("wrench"))).into_iter().collect();
        let surroundings = Surroundings { environment, wrenches: &wrenches };
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
        progress.set((first + these) as u64);
    }
    Ok((outputs, start.elapsed().as_secs_f64()))
}
