//! The database of a foreign machine's logs: the bench's frames, some of them logged less often.

use xt28_dbc::messages::{
    CylLoadFront, CylLoadMidRear, DriveCurrent, Eec1, PumpPressure, WheelForceFront,
    WheelForceMidRear,
};
use xt28_dbc::{CanId, XT28_DBC};

/// What is logged at another period than the bench sends it, ms.
const LOGGED_MS: [(CanId, u32); 7] = [
    (CylLoadMidRear::ID, 50),
    (CylLoadFront::ID, 50),
    (WheelForceMidRear::ID, 50),
    (WheelForceFront::ID, 50),
    (PumpPressure::ID, 50),
    (DriveCurrent::ID, 20),
    (Eec1::ID, 50),
];

/// The database's text.
pub(crate) fn text() -> String {
    let mut text = String::with_capacity(XT28_DBC.len());
    for line in XT28_DBC.lines() {
        let logged = LOGGED_MS.iter().find_map(|(id, ms)| {
            let period = format!("BA_ \"GenMsgCycleTime\" BO_ {} ", id.dbc());
            line.starts_with(&period).then(|| format!("{period}{ms};"))
        });
        text.push_str(logged.as_deref().unwrap_or(line));
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seven_periods_differ_and_nothing_else() {
        let (theirs, ours) = (text(), XT28_DBC);
        let differ = theirs.lines().zip(ours.lines()).filter(|(a, b)| a != b).count();
        assert_eq!((differ, theirs.lines().count()), (7, ours.lines().count()));
        assert!(theirs.contains("BO_ 2566787093 20;"));
    }
}
