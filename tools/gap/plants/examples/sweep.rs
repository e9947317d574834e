//! Draws many cases and makes their logs: none may go astray, and it says what a case costs.
//!
//! ```sh
//! cargo run --release -p xt28-gap-plants --example sweep -- 40
//! ```
// A program: it prints and reads its arguments and the clock.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)]

use std::time::Instant;

use xt28_gap_plants::{Case, Kind};

fn main() -> Result<(), String> {
    let count = std::env::args().nth(1).map_or(Ok(20), |text| text.parse::<u64>());
    let count = count.map_err(|_| "usage: sweep [CASES]".to_owned())?;
    let kinds = [Kind::Null, Kind::Single, Kind::Pair, Kind::Unknown];
    let began = Instant::now();
    let mut bytes = 0;
    for (seed, kind) in (0..count).zip(kinds.into_iter().cycle()) {
        let case = Case::draw(1000 + seed, kind).at_its_strongest();
        let facts = case.answer().truth;
        let names: Vec<String> =
            facts.iter().map(|fact| format!("{} {}", fact.effect, fact.scope)).collect();
        let logs = case.logs().map_err(|error| format!("{error}: {names:?}"))?;
        bytes += logs.iter().map(|(_, log)| log.len()).sum::<usize>();
    }
    #[allow(clippy::cast_precision_loss)]
    let each_s = began.elapsed().as_secs_f64() / count as f64;
    println!("{count} cases, {bytes} bytes, {each_s:.2} s a case");
    Ok(())
}
