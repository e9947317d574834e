//! Rows of the drive that the plant's table has on the vehicle, here as its frames show them.

use xt28_dbc::messages::{Eec1, WheelSpeedSigned};
use xt28_machine::Machine;

use crate::drive_off::{DRIVES_S, THROTTLE_PERCENT};
use crate::recording::Recording;
use crate::row::{Row, Seen, Size, Stay, mean, most};

const STARTS_LATER: &[Stay] = &[
    Stay::Frames(DRIVES_S, &[]),
    Stay::Within("speed in the end, rpm", mean_rpm, [13.0, 13.9], 0.06),
];

fn mean_rpm(r: &Recording) -> Vec<f64> {
    r.each(WheelSpeedSigned::decode, |m| {
        (m.fr_rpm + m.fl_rpm + m.mr_rpm + m.ml_rpm + m.br_rpm + m.bl_rpm) / 6.0
    })
}

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            effect: "throttle-delay",
            values: "delay_s = 0.4",
            shows: |seen| behind(seen, 0.4),
            stays: STARTS_LATER,
        },
        Row {
            effect: "drive-lag",
            values: "time_constant_s = 0.8",
            shows: |seen| behind(seen, 0.8),
            stays: STARTS_LATER,
        },
        Row {
            effect: "engine-droop",
            values: "droop_per_w = 2e-5",
            shows: droop,
            // What the arms do before they are asked for anything.
            stays: &[Stay::Frames(0.9, &[])],
        },
    ]
}

/// The wheels have rolled less by as much of their speed as the drive is late.
fn behind(seen: &Seen, late_s: f64) -> Vec<Size> {
    let lasts_s = 13.9 - DRIVES_S;
    let rolled_turns = |r: &Recording| mean(&mean_rpm(r), [DRIVES_S, 13.9]) / 60.0 * lasts_s;
    let m = Machine::xt28();
    let turns_s = 1e-2 * THROTTLE_PERCENT * m.drive.speed_full_m_s
        / (core::f64::consts::TAU * m.wheels.radius_m);
    let wanted = turns_s * late_s;
    let is = rolled_turns(seen.without) - rolled_turns(seen.with);
    vec![Size::new("turns behind", is, wanted, 0.02 * wanted)]
}

/// The engine says the speed that its law makes of the power that the wheels take, a fifth of a second late.
fn droop(seen: &Seen) -> Vec<Size> {
    let said_rpm = seen.with.each_eec1();
    let keeps = (-0.01_f64 / 0.2).exp();
    let (mut felt_w, mut off_rpm) = (0.0, vec![]);
    for (tick, s) in seen.with.truth.iter().enumerate() {
        let power_w: f64 =
            s.wheel_torque_nm.iter().map(|(w, nm)| nm * s.wheel_speed_rad_s[w]).sum();
        if let Some(said_rpm) = said_rpm[tick] {
            off_rpm.push(said_rpm - 1200.0 * (1.0 - 2e-5 * f64::max(felt_w, 0.0)));
        }
        felt_w = power_w + (felt_w - power_w) * keeps;
    }
    let least_rpm = said_rpm.iter().flatten().copied().fold(f64::MAX, f64::min);
    let lost = f64::from(u8::from(least_rpm < 1150.0));
    let mean_rpm = off_rpm.iter().map(|rpm: &f64| rpm.abs()).sum::<f64>() / off_rpm.len() as f64;
    // The plant makes two steps a tick; while the power rises, that is some rpm.
    vec![
        Size::new("engine off its law on the mean, rpm", mean_rpm, 0.0, 0.5),
        Size::new("engine off its law, rpm", most(off_rpm), 0.0, 8.0),
        Size::new("it loses more than 50 rpm", lost, 1.0, 0.0),
    ]
}

impl Recording {
    /// What the engine says of its speed in each tick in which it does, rpm.
    fn each_eec1(&self) -> Vec<Option<f64>> {
        let of_tick = |frames: &Vec<xt28_dbc::Frame>| {
            frames.iter().find_map(|frame| Eec1::decode(frame).ok()).map(|m| m.engine_speed_rpm)
        };
        self.frames.iter().map(of_tick).collect()
    }
}
