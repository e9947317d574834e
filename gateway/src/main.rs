//! `gateway`: a policy at the wheel of an Xt28, over SocketCAN and a GNSS receiver.
#![forbid(unsafe_code)]
// A binary is the edge: it may read the clock, print and exit.
#![allow(clippy::disallowed_methods)]

mod announcer;
mod args;
mod departures;
mod freshness;
mod lateness;
mod log;
mod news;
mod problem;
mod realtime;
mod report;
mod serial;
mod wire;

use std::io::Write;
use std::process::ExitCode;
use std::time::Duration;

use clap::Parser;

/// How long whoever reads stderr is waited for at the end.
const LAST_LINES: Duration = Duration::from_secs(1);

fn main() -> ExitCode {
    let args = args::Args::parse();
    match realtime::run(&args) {
        Ok((finished, announcer)) => {
            if args.json {
                // A reader that is gone changes no verdict.
                let _ = writeln!(std::io::stdout(), "{}", report::json(&finished));
            }
            report::lines(&finished).into_iter().for_each(|line| announcer.say(line));
            let status = match &finished.broke {
                Some(problem) => {
                    announcer.say(format!("gateway: {problem}"));
                    ExitCode::from(2)
                }
                None => ExitCode::from(u8::from(report::shortfall(&finished).is_some())),
            };
            announcer.end(LAST_LINES);
            status
        }
        Err(problem) => {
            announcer::announce(&format!("gateway: {problem}"));
            ExitCode::from(2)
        }
    }
}
