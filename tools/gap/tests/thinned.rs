//! Frames that everybody lacks, and commands alone: both count as lost on the bus, and of the first it is said that it may
//! have been the logger.

mod own_logs;

use std::path::Path;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use xt28_dbc::XT28_DBC;
use xt28_gap::diagnosis::{Generator, Signal, Signals};
use xt28_gap::{Decoder, FieldLog, Mapping, Terrain};
use xt28_machine::Machine;
use xt28_sim::Effects;

/// The two commands of the log: arms and drive.
const COMMANDS: [&str; 2] = ["0CFF4027", "0CFF4127"];

/// A run of our machine of which a twentieth of those frames is missing that `may_go`.
fn without(may_go: fn(&str) -> bool) -> FieldLog {
    let text = own_logs::text("drive", &Effects::default());
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut stays = |line: &&str| !(may_go(line) && random.random_bool(0.05));
    let text: String = text.lines().filter(|line| stays(line)).map(|l| format!("{l}\n")).collect();
    let decoder = Decoder::parse(XT28_DBC, Path::new("xt28.dbc"), &Mapping::default()).unwrap();
    FieldLog::read(text.as_bytes(), "drive", &decoder, false).unwrap()
}

/// The most that a second lacks of its commands, floors.
fn missing(log: &FieldLog) -> f64 {
    let signals = Signals::new(log, Terrain::Flat).unwrap();
    let all = Generator::Bus.residuals(&signals, &Machine::xt28(), &Effects::default());
    let of = all.into_iter().find(|residual| residual.signal == Signal::BusMissing).unwrap();
    of.values.into_iter().filter(|value| value.is_finite()).fold(0.0, |most, v| most.max(v.abs()))
}

#[test]
fn what_everybody_lacks_is_missing_and_may_be_the_loggers() {
    let log = without(|_| true);
    assert!(log.is_thinned(), "{:?}", log.told_faults());
    assert!(missing(&log) > 3.0, "{} floors", missing(&log));
    let told = log.told_faults().join("\n");
    assert!(told.contains("the bus or the logger that lost them"), "{told}");
    let lost: Vec<String> =
        log.each_fault().into_iter().filter(|fault| fault.contains("is missing")).collect();
    assert!(!lost.is_empty() && lost.iter().all(|line| line.contains("the bus or the logger")));
}

#[test]
fn what_is_missing_of_the_commands_alone_was() {
    let log = without(|line| COMMANDS.iter().any(|id| line.contains(id)));
    assert!(!log.is_thinned() && missing(&log) > 3.0, "{} floors", missing(&log));
    assert!(!without(|_| false).is_thinned());
}
