//! Writes one case: logs, database and `about.toml` into a folder, the answer beside it.
//!
//! ```sh
//! cargo run --release -p xt28-gap-plants --example write_case -- 7 single out/
//! cargo run --release -p xt28-gap-plants --example write_case -- 7 arm-delay:front out/
//! ```
// A program: it prints and reads its arguments and the clock.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)]

use std::path::PathBuf;
use std::time::Instant;

use xt28_gap_plants::{Case, Cause, Kind, Scope};

fn main() -> Result<(), String> {
    let usage = "usage: write_case SEED nominal|null|single|pair|unknown|CAUSE[:SCOPE] FOLDER";
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [seed, what, folder] = arguments.as_slice() else { return Err(usage.to_owned()) };
    let seed = seed.parse().map_err(|_| usage.to_owned())?;
    let case = match what.as_str() {
        "nominal" => Case::nominal(seed),
        "null" => Case::draw(seed, Kind::Null),
        "single" => Case::draw(seed, Kind::Single),
        "pair" => Case::draw(seed, Kind::Pair),
        "unknown" => Case::draw(seed, Kind::Unknown),
        cause => {
            let (name, scope) = cause.split_once(':').unwrap_or((cause, "all"));
            let cause = Cause::find(name).ok_or_else(|| format!("no cause {name}; {usage}"))?;
            let found = Scope::EVERY.into_iter().find(|known| known.name() == scope);
            Case::of(seed, cause, found.ok_or_else(|| format!("no scope {scope}; {usage}"))?)
        }
    };
    let folder = PathBuf::from(folder).join(case.name());
    let began = Instant::now();
    case.write(&folder).map_err(|error| error.to_string())?;
    println!("{} in {:.1} s", folder.display(), began.elapsed().as_secs_f64());
    let answer = folder.with_extension("answer.toml");
    std::fs::write(&answer, case.answer().text()).map_err(|error| error.to_string())?;
    println!("{}", case.answer().text());
    Ok(())
}
