//! Rows of the way to the ECUs: what their status says of the last command they took.

use xt28_dbc::messages::{ArmStatus, DriveStatus, PosFront, WheelSpeedSigned};

use crate::recording::Recording;
use crate::row::{Row, Seen, Size, Stay};

/// A machine that is asked for the same for seconds comes to do the same.
const SAME_IN_THE_END: &[Stay] = &[
    Stay::Within("stroke, mm", |r| r.each(PosFront::decode, |m| m.fr_mm), [5.0, 14.0], 2.0),
    Stay::Within(
        "wheel speed, rpm",
        |r| r.each(WheelSpeedSigned::decode, |m| m.fr_rpm),
        [4.5, 5.9],
        0.11,
    ),
];

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            effect: "frame-loss",
            values: "share = 0.02",
            shows: |seen| lost(seen.with, 0.02),
            stays: SAME_IN_THE_END,
        },
        Row {
            effect: "frame-loss",
            values: "share = 0.3",
            shows: |seen| lost(seen.with, 0.3),
            // What is not commanded stays: a machine that has stopped stands as it stood.
            stays: &[Stay::Frames(0.0, &[])],
        },
        Row {
            effect: "command-jitter",
            values: "latest_s = 0.02",
            shows: late,
            stays: SAME_IN_THE_END,
        },
    ]
}

/// How many frames behind the one of its tick each ECU is with the last command that it took; ticks by ECU.
fn behind(r: &Recording) -> [Vec<u8>; 2] {
    let arm = r.each(ArmStatus::decode, |m| f64::from(m.accepted));
    let drive = r.each(DriveStatus::decode, |m| f64::from(m.accepted));
    [arm, drive].map(|accepted| {
        // The first frame's counter is 0, and counters come round after 16.
        let behind = accepted
            .iter()
            .enumerate()
            .map(|(tick, accepted)| (tick as i64 - *accepted as i64).rem_euclid(16) as u8);
        behind.skip(20).collect()
    })
}

/// The share of ticks whose own frame did not come. Tolerance: three deviations of so many draws.
fn lost(r: &Recording, share: f64) -> Vec<Size> {
    let ticks = behind(r).concat();
    let missing = ticks.iter().filter(|behind| **behind > 0).count();
    let count = ticks.len() as f64;
    let deviation = (share * (1.0 - share) / count).sqrt();
    vec![Size::new("share lost", missing as f64 / count, share, 3.0 * deviation)]
}

/// Late by up to two periods, all lates alike likely, a frame is there one tick late or two. None overtakes another: the
/// arms' frame, sent first, is one tick late by its own chance of a half, the drive's by both theirs.
fn late(seen: &Seen) -> Vec<Size> {
    let sizes = behind(seen.with).into_iter().zip([("arms'", 0.5), ("drive's", 0.25)]);
    let sizes = sizes.flat_map(|(ticks, (whose, once))| {
        let count = ticks.len() as f64;
        let share = |by: u8| ticks.iter().filter(|behind| **behind == by).count() as f64 / count;
        let within = 3.0 * (once * (1.0 - once) / count).sqrt();
        [(1, once), (2, 1.0 - once)].map(|(by, wanted)| {
            Size::new(format!("{whose} {by} ticks late"), share(by), wanted, within)
        })
    });
    let prompt = behind(seen.without).concat().iter().filter(|behind| **behind > 0).count();
    sizes.chain([Size::new("late without it", prompt as f64, 0.0, 0.0)]).collect()
}
