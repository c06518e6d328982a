//! `mozzi derive` in a program that was built without it.

use crate::failure::{Failure, Result};
use clap::Args;

#[derive(Args, Debug)]
#[command(before_help = "Not in this program: cargo install --path crates/mozzi-cli --features derive")]
pub struct DeriveArguments {
    /// A robot and quantities
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    given: Vec<String>,
}

pub fn run(_: &DeriveArguments) -> Result<String> {
    Err(Failure::wrong(
        "derive: this program was built without the feature `derive`; build it with: cargo install --path \
         crates/mozzi-cli --features derive",
    ))
}
