//! The free model without physics on labelled machines of a second plant: never much worse than no
//! model, however few runs it was shown.

use std::io::{self, Write as _};
use std::path::Path;

use xt28_gap::diagnosis::{FieldRun, HowFar, Inquiry};
use xt28_gap::{Decoder, FieldLog, Mapping, Terrain};
use xt28_machine::Machine;

/// Runs on level ground, and which of them the model is shown: one, two of other manoeuvres, most.
const LEVEL: [&str; 4] = ["run-1-arm_step", "run-2-multisine", "run-4-straight", "run-6-mixed"];
const SHOWN: [&[usize]; 3] = [&[0], &[0, 2], &[0, 1, 2]];
/// What a model may lose that was shown other manoeuvres.
const LEAST: f64 = -0.1;

#[test]
#[cfg_attr(debug_assertions, ignore = "slow unoptimised; run with --release, as CI does")]
fn the_free_model_is_never_much_worse_than_none() {
    let dev = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/field-data/dev");
    if !dev.exists() {
        #[allow(clippy::disallowed_macros)] // A test that skips says so.
        {
            let _ = writeln!(io::stdout(), "SKIPPED: {} is not there", dev.display());
        }
        return;
    }
    for case in ["dev-01", "dev-11"] {
        let folder = dev.join(case);
        let decoder = Decoder::load(&folder.join("xt28-field.dbc"), &Mapping::default()).unwrap();
        for shown in SHOWN {
            let run = |(k, name): (usize, &str)| {
                let path = folder.join(format!("{name}.log.gz"));
                let log = FieldLog::load(&path, &decoder, false).unwrap();
                FieldRun::new(log, Terrain::Flat, shown.contains(&k)).unwrap()
            };
            let runs = LEVEL.into_iter().enumerate().map(run).collect();
            let shrink = HowFar::new(&Inquiry::new(Machine::xt28(), runs)).unwrap().black_box();
            for (horizon, of) in
                [("one step", shrink.one_step), ("5 s", shrink.five_s), ("run", shrink.run)]
            {
                assert!(of >= LEAST, "{case}, shown {shown:?}, {horizon}: {of}");
            }
        }
    }
}
