//! `gateway`: a policy at the wheel of an Xt28, over SocketCAN and a GNSS receiver.
#![forbid(unsafe_code)]
// A binary is the edge: it may read the clock, print and exit.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)]

mod args;
mod departures;
mod freshness;
mod lateness;
mod problem;
mod realtime;
mod report;
mod serial;
mod talk;
mod wire;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    let args = args::Args::parse();
    match realtime::run(&args) {
        Ok(finished) => {
            report::tell(&finished);
            if args.json {
                println!("{}", report::json(&finished));
            }
            match &finished.broke {
                Some(problem) => {
                    eprintln!("gateway: {problem}");
                    ExitCode::from(2)
                }
                None => ExitCode::from(u8::from(report::shortfall(&finished).is_some())),
            }
        }
        Err(problem) => {
            eprintln!("gateway: {problem}");
            ExitCode::from(2)
        }
    }
}
