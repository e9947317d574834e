//! What `xt28 replay` says of a log of our own machine: its exit status, its data, its picture.

mod command;

use std::fs;

use command::xt28;
use serde_json::Value;

const DBC: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../dbc/xt28.dbc");

#[test]
fn our_own_log_is_within_bounds_and_one_of_another_machine_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let [log, late, plot] = ["own.log", "late.toml", "own.svg"]
        .map(|name| folder.path().join(name).to_str().unwrap().to_owned());
    assert!(xt28(&["run", "arm-step-response", "--record", &log]).status.success());
    let overlay = xt28(&["effects", "arm-delay", "delay_s=0.9"]).stdout;
    fs::write(&late, overlay).unwrap();
    for (more, passed) in [(&["--plot", &plot][..], true), (&["--effects", &late], false)] {
        let arguments = [&["replay", &log, "--dbc", DBC, "--json"], more].concat();
        let output = xt28(&arguments);
        assert_eq!(output.status.code(), Some(i32::from(!passed)), "{output:?}");
        let json: Value = serde_json::from_slice(&output.stdout).expect("one JSON value");
        assert_eq!(json["passed"], passed, "{json}");
    }
    assert!(fs::read_to_string(&plot).unwrap().starts_with("<svg"));
}
