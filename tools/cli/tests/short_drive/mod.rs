//! A log of ten seconds on this bench's own machine, for tests of the command.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use tempfile::TempDir;

use crate::command::xt28;

/// The database that this bench's logs are sent with.
pub(crate) const DBC: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../dbc/xt28.dbc");

/// Every block does something, in as little time as that takes; no two arms of an axle alike.
const SCENARIO: &str = r#"
title = "Arms up, off, left"
policy = "script:short.script.toml"
duration_s = 10.0
[[expect]]
carries-weight = { from_s = 0.5, to_s = 1.0, within_percent = 5.0 }
"#;
const SCRIPT: &str = r#"
end_s = 10
[[command]]
at_s = 0
stroke_mm = [100, 100, 100, 100, 100, 100]
[[command]]
at_s = 1
stroke_mm = [140, 100, 100, 100, 100, 100]
throttle_percent = 40
[[command]]
at_s = 3
stroke_mm = [100, 100, 100, 100, 130, 100]
[[command]]
at_s = 5
stroke_mm = [100, 140, 100, 100, 100, 120]
front_angle_deg = 8
"#;

/// The log, driven once.
pub(crate) fn log() -> String {
    static FOLDER: OnceLock<TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("short.script.toml"), SCRIPT).unwrap();
        let (scenario, log) = (path(folder.path(), "short.toml"), path(folder.path(), "short.log"));
        fs::write(&scenario, SCENARIO).unwrap();
        let output = xt28(&["run", &scenario, "--solver", "reduced", "--record", &log]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        folder
    });
    path(folder.path(), "short.log")
}

pub(crate) fn path(folder: &Path, name: &str) -> String {
    folder.join(name).to_str().unwrap().to_owned()
}
