//! What the machine is told in runs that look for effects: its arms extend, it drives off, it bends.
#![allow(dead_code)] // each program uses a part

use xt28_dbc::Frame;
use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::{ArmTarget, ArmTargetMode, DriveTarget};

/// Length of a run, s.
pub(crate) const LASTS_S: f64 = 14.0;
/// Strokes asked for at first and from 1 s on, mm.
pub(crate) const TARGETS_MM: [f64; 2] = [170.0, 220.0];
/// The machine drives from here on, and is asked to bend left by 15 degrees from there, s.
pub(crate) const DRIVES_S: f64 = 3.0;
pub(crate) const BENDS_S: f64 = 6.0;
pub(crate) const BEND_DEG: f64 = 15.0;
/// Speed that it is asked for, percent.
pub(crate) const THROTTLE_PERCENT: f64 = 40.0;

/// What the arms are asked for at this time, mm.
pub(crate) fn target_mm(t_s: f64) -> f64 {
    if t_s < 1.0 { TARGETS_MM[0] } else { TARGETS_MM[1] }
}

/// Both command frames of this time.
pub(crate) fn commands(t_s: f64, [arm, drive]: &mut [AliveCounter; 2]) -> [Frame; 2] {
    let mm = target_mm(t_s);
    let arms = ArmTarget {
        fr_mm: mm,
        fl_mm: mm,
        mr_mm: mm,
        ml_mm: mm,
        br_mm: mm,
        bl_mm: mm,
        mode: ArmTargetMode::ManualPosition,
        counter: arm.next_count(),
    };
    let target = DriveTarget {
        throttle_percent: if t_s < DRIVES_S { 0.0 } else { THROTTLE_PERCENT },
        front_angle_deg: if t_s < BENDS_S { 0.0 } else { BEND_DEG },
        engine_speed_rpm: 1200.0,
        brake: false,
        enable: true,
        counter: drive.next_count(),
    };
    [arms.encode().unwrap(), target.encode().unwrap()]
}
