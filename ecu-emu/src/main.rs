//! `ecu-emu`: the two ECUs and the machine behind them on a CAN interface, in real time.
#![forbid(unsafe_code)]
// A binary is the edge: it may read the clock, print and exit.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)]

mod args;
mod listening;
mod realtime;
mod schedule;
mod sending;
mod serial;
mod watch;
mod wire_buses;

use std::fmt::Display;
use std::io::Write;
use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    let args = args::Args::parse();
    match realtime::run(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            tell(problem);
            ExitCode::from(2)
        }
    }
}

/// Says something on stderr. Where nobody reads that any more, nobody is told, and the machine goes on.
fn tell(what: impl Display) {
    let _ = writeln!(std::io::stderr(), "ecu-emu: {what}");
}
