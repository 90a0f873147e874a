//! `cargo xtask accuracy`: the error of discharge times, measured.

use crate::cli::AccuracyArgs;
use crate::compute;
use crate::error::XtaskError;

pub fn run(args: &AccuracyArgs) -> Result<(), XtaskError> {
    compute::accuracy(compute::preset(args.quality), &super::settings(&args.work)?)
}
