//! Prints what the logs of a machine say before it is judged: evidence of each cause in nats (and of how much it
//! could foretell it does), what the best one leaves on each signal in floors (root mean square, and the third largest of its bumps), how
//! much of that is what it explains moved in time, and where the tolerances go with it and without any.
//!
//! ```sh
//! cargo run --release -p xt28-gap-plants --example write_case -- 7 standstill-drag:left out/
//! cargo run --release -p xt28-gap-check --example evidence -- out/plant-7
//! cargo run --release -p xt28-gap-check --example evidence -- --without standstill-drag out/plant-7
//! ```
// A program: it prints and reads its arguments.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)]

use std::path::PathBuf;

use xt28_gap::diagnosis::{
    Beginning, Candidate, Echo, Evidence, Findings, Knob, SignalFindings, Signals, Uneven,
};
use xt28_gap_check::Source;
use xt28_sim::Effects;
use xt28_sim::effects::find;

/// Causes and signals printed of each machine.
const LISTED: usize = 8;
/// Echoes printed of each.
const LOUDEST: usize = 3;

fn main() -> Result<(), String> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut withheld = None;
    if arguments.first().is_some_and(|first| first == "--without") {
        let name = arguments.get(1).cloned().unwrap_or_default();
        withheld = Some(find(&name).ok_or(format!("no effect is called '{name}'"))?);
        arguments.drain(..2);
    }
    if arguments.is_empty() {
        let of = "each with logs, DBC and about.toml";
        return Err(format!("usage: evidence [--without EFFECT] FOLDER...; {of}"));
    }
    for folder in arguments.into_iter().map(PathBuf::from) {
        let case = Source::Folder { answer: folder.with_extension("answer.toml"), folder };
        let mut inquiry = case.inquiry().map_err(|error| error.to_string())?;
        if let Some(effect) = withheld {
            inquiry = inquiry.without(effect);
        }
        let findings = inquiry.findings(&|_| ());
        let why = findings.left_over_why();
        println!("{}: left over {:.2}: {why}", case.name(), findings.left_over());
        if let Some((times, why)) = findings.left_over_held() {
            println!("  held out {times:.2}: {why}");
        }
        print(&findings);
        print_tolerances("beside the best", findings.shifts.clone());
        let runs: Vec<Signals> = inquiry.runs.iter().map(|run| run.signals.clone()).collect();
        let none = Effects::default();
        let evidence =
            Evidence::new(&runs, &inquiry.machine, none.clone(), &Knob::of(&inquiry.catalogue));
        print_tolerances("where nothing is believed", evidence.shifts(&none));
    }
    Ok(())
}

fn print(findings: &Findings) {
    for cause in findings.single.iter().take(LISTED) {
        println!("  {}", line(cause));
    }
    for [first, second] in findings.pair.iter().take(LISTED / 2) {
        println!("  {} beside {}", line(second), first.fit.hypothesis.effect.name);
    }
    let mut signals: Vec<&SignalFindings> = findings.signals.iter().collect();
    signals.sort_by(|a, b| b.after.square.total_cmp(&a.after.square));
    for SignalFindings { unbent, after, .. } in signals.into_iter().take(LISTED) {
        let (before, after_floors) = (unbent.square.sqrt(), after.square.sqrt());
        println!(
            "    {} {}: {before:.2} to {after_floors:.2}, again and again {:.1} to {:.1}",
            after.generator, after.signal, unbent.recurring, after.recurring
        );
    }
    let mut echoes: Vec<&Echo> =
        findings.signals.iter().filter_map(|of| of.echo.as_ref()).collect();
    echoes.sort_by(|a, b| b.nats.total_cmp(&a.nats));
    for Echo { generator, signal, nats, explained, .. } in echoes.into_iter().take(LOUDEST) {
        println!("    {generator} {signal}: {nats:.1} nats of echo, {explained:.0} explained");
    }
    let mut unevens: Vec<&Uneven> = findings.unevens.iter().collect();
    unevens.sort_by(|a, b| b.nats().total_cmp(&a.nats()));
    for uneven in unevens.into_iter().take(LOUDEST) {
        let (Uneven { generator, signal, half, .. }, [out, within]) = (uneven, uneven.sizes());
        println!(
            "    {generator} {signal}: {:.1} nats for sizes of {out:.2} and {within:.2} by {half:?}, {:.0} explained",
            uneven.nats(),
            uneven.explained()
        );
    }
}

fn print_tolerances(of: &str, mut shifts: Vec<(Knob, f64)>) {
    let squares: f64 = shifts.iter().map(|(_, by)| by * by).sum();
    println!("    tolerances, {of}: {squares:.0} squares of their own");
    shifts.sort_by(|(_, a), (_, b)| b.abs().total_cmp(&a.abs()));
    for (knob, by) in shifts.into_iter().take(LISTED) {
        println!("      {by:+.1} {knob}");
    }
}

fn line(cause: &Candidate) -> String {
    let fit = &cause.fit;
    let values: Vec<String> = fit.values.iter().map(|value| format!("{value:.4}")).collect();
    let held = cause.held_gain.map_or("-".to_owned(), |held| format!("{held:.1}"));
    format!(
        "{:7.1} nats ({:.1} fitted, {held} of {:.1} foretold, {:.2} its own) {} {} = {}{}",
        cause.score(),
        fit.log_evidence,
        cause.held_most,
        cause.own_share,
        fit.hypothesis.effect.name,
        fit.hypothesis.scope,
        values.join(", "),
        Beginning::of(fit.onset).map_or_else(String::new, |begins| format!(" begins {begins}")),
    )
}
