//! The command itself, as people start it.

use std::process::{Command, Output};

pub(crate) fn xt28(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_xt28")).args(arguments).output().expect("xt28 starts")
}
