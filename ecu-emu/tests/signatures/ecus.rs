//! Rows of the ECUs' own numbers: what an ECU sends follows from what it said it read, by its law with other gains.

use xt28_dbc::messages::{
    DriveCurrent, DriveStatus, PosFront, PosMidRear, RefCurrentFront, RefCurrentRear,
    WheelSpeedJoint, WheelSpeedSigned,
};
use xt28_machine::Machine;

use crate::drive_off::{BEND_DEG, BENDS_S, DRIVES_S, target_mm};
use crate::recording::{Recording, tick_at};
use crate::row::{Row, Seen, Size, Stay, mean, most};

const PERIOD_S: f64 = 0.01;
/// An arm's valve opens at 400 mA and is full at 400 mA more, a joint's at 415 and at 315 more.
const VALVE_MA: f64 = 400.0;
const STEER_MA: [f64; 2] = [415.0, 315.0];

/// Arms may shake one another while they go to their targets, and do not drive.
const OF_ARMS: &[Stay] = &[
    Stay::Within("wheel speed, rpm", fr_rpm, [4.0, 14.0], 0.3),
    Stay::Within("joint, deg", front_deg, [0.0, 14.0], 0.1),
];
/// Joints wait until the machine drives.
const OF_JOINTS: &[Stay] = &[
    Stay::Frames(DRIVES_S, &[]),
    Stay::Within("stroke, mm", fr_mm, [0.0, 14.0], 3.0),
    Stay::Within("wheel speed, rpm", fr_rpm, [0.0, BENDS_S], 0.11),
];

fn fr_rpm(r: &Recording) -> Vec<f64> {
    r.each(WheelSpeedSigned::decode, |m| m.fr_rpm)
}

fn fr_mm(r: &Recording) -> Vec<f64> {
    r.each(PosFront::decode, |m| m.fr_mm)
}

fn front_deg(r: &Recording) -> Vec<f64> {
    r.each(WheelSpeedJoint::decode, |m| m.front_joint_deg)
}

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            effect: "arm-gain",
            values: "scope = \"front\"\nkp_factor = 1.4",
            shows: |seen| arm_gains(seen.with, [1.4, 1.0]),
            stays: OF_ARMS,
        },
        Row {
            effect: "arm-gain",
            values: "scope = \"front\"\nki_factor = 5.0",
            shows: |seen| arm_gains(seen.with, [1.0, 5.0]),
            stays: OF_ARMS,
        },
        Row {
            effect: "steer-gain",
            values: "kp_factor = 1.5",
            shows: |seen| steering(seen.with, Law { kp: 1.5, ..Law::NOMINAL }),
            stays: OF_JOINTS,
        },
        Row {
            effect: "steer-gain",
            values: "ki_factor = 3.0",
            shows: |seen| steering(seen.with, Law { ki: 3.0, ..Law::NOMINAL }),
            stays: OF_JOINTS,
        },
        Row {
            effect: "rear-follower-lag",
            values: "ratio_factor = 0.5",
            shows: |seen| steering(seen.with, Law { ratio: 0.5, ..Law::NOMINAL }),
            stays: OF_JOINTS,
        },
        Row {
            effect: "rear-follower-lag",
            values: "time_constant_s = 1.0",
            shows: |seen| {
                let law = Law { time_constant_s: 1.0, ..Law::NOMINAL };
                [steering(seen.with, law), late_joint(seen)].concat()
            },
            stays: OF_JOINTS,
        },
    ]
}

/// Current that extends an arm at each tick by what it reads and its gains, mA: whole ones, cut off.
fn extends_ma(stroke_mm: &[f64], [kp, ki]: [f64; 2]) -> Vec<f64> {
    let h = Machine::xt28().hydraulics;
    let mut integral_mm_s = 0.0_f64;
    let current = |(tick, mm): (usize, &f64)| {
        let error_mm = target_mm(tick as f64 * PERIOD_S) - mm;
        let windup_mm_s = h.manual_windup;
        integral_mm_s = (integral_mm_s + error_mm * PERIOD_S).clamp(-windup_mm_s, windup_mm_s);
        let asked = kp * h.manual_kp_per_mm * error_mm + ki * h.manual_ki_per_mm_s * integral_mm_s;
        let above_ma = (VALVE_MA * asked.clamp(0.0, h.manual_opening_max)).trunc();
        if above_ma == 0.0 { 0.0 } else { VALVE_MA + above_ma }
    };
    stroke_mm.iter().enumerate().map(current).collect()
}

/// Front arms go by the gains with these factors and a rear one by the machine's own, and neither by the other's.
fn arm_gains(r: &Recording, factors: [f64; 2]) -> Vec<Size> {
    let front = (fr_mm(r), r.each(RefCurrentFront::decode, |m| m.fr_b_ma));
    let rear =
        (r.each(PosMidRear::decode, |m| m.br_mm), r.each(RefCurrentRear::decode, |m| m.br_b_ma));
    // The first tick's command is there before the ECU is active.
    let off_ma = |(mm, ma): &(Vec<f64>, Vec<f64>), factors| {
        let law = extends_ma(mm, factors);
        most(law.iter().zip(ma).skip(2).map(|(law, ma)| law - ma))
    };
    let told_apart = |arm, factors| f64::from(u8::from(off_ma(arm, factors) > 1.0));
    vec![
        Size::new("FR off its law, mA", off_ma(&front, factors), 0.0, 1.0),
        Size::new("BR off its law, mA", off_ma(&rear, [1.0, 1.0]), 0.0, 1.0),
        Size::new("FR is off the machine's own", told_apart(&front, [1.0, 1.0]), 1.0, 0.0),
        Size::new("BR is off the front ones'", told_apart(&rear, factors), 1.0, 0.0),
    ]
}

/// A law of the steering: gains over the machine's own, ratio over its own, and the follower's lag.
#[derive(Clone, Copy)]
struct Law {
    kp: f64,
    ki: f64,
    ratio: f64,
    time_constant_s: f64,
}

impl Law {
    const NOMINAL: Self = Self { kp: 1.0, ki: 1.0, ratio: 1.0, time_constant_s: 0.0 };
}

/// Mean distance of both valves' currents to the left from what this law makes of the joints' angles from the bend on, mA.
fn off_ma(r: &Recording, law: Law) -> [f64; 2] {
    let a = Machine::xt28().articulation;
    let joint = |of: fn(&WheelSpeedJoint) -> f64| r.each(WheelSpeedJoint::decode, of);
    let current = |of: fn(&DriveCurrent) -> f64| r.each(DriveCurrent::decode, of);
    let (front_deg, rear_deg) = (joint(|m| m.front_joint_deg), joint(|m| m.rear_joint_deg));
    let made_ma = [current(|m| m.steer_front_a_ma), current(|m| m.steer_rear_a_ma)];
    let speed_m_s = r.each(DriveStatus::decode, |m| m.speed_m_s);
    let keeps =
        if law.time_constant_s > 0.0 { (-PERIOD_S / law.time_constant_s).exp() } else { 0.0 };
    let (mut followed_deg, mut integral_deg_s, mut off) =
        (front_deg[0], [0.0; 2], [vec![], vec![]]);
    for tick in 0..front_deg.len() {
        followed_deg = front_deg[tick] + (followed_deg - front_deg[tick]) * keeps;
        if speed_m_s[tick] <= a.speed_threshold_m_s {
            continue;
        }
        let target_deg = if tick < tick_at(BENDS_S) { 0.0 } else { BEND_DEG };
        let rear_target_deg = law.ratio * a.rear_ratio * followed_deg;
        let errors_deg = [target_deg - front_deg[tick], rear_target_deg - rear_deg[tick]];
        for i in 0..2 {
            integral_deg_s[i] += errors_deg[i] * PERIOD_S;
            let integral = law.ki * a.ki_per_s * integral_deg_s[i];
            let opening = law.kp * a.kp_per_deg * (errors_deg[i] + integral);
            if tick >= tick_at(BENDS_S) && opening > 0.01 {
                off[i].push((made_ma[i][tick] - STEER_MA[0] - STEER_MA[1] * opening).abs());
            }
        }
    }
    off.map(|off| off.iter().sum::<f64>() / off.len() as f64)
}

/// Both valves follow from the joints' angles by this law, to what a tenth of a degree opens; with any number of it off
/// by a tenth, one of them does so worse.
fn steering(r: &Recording, law: Law) -> Vec<Size> {
    let within_ma = 0.1 * law.kp * Machine::xt28().articulation.kp_per_deg * STEER_MA[1];
    let [front_ma, rear_ma] = off_ma(r, law);
    let mut sizes = vec![
        Size::new("front valve off its law, mA", front_ma, 0.0, within_ma),
        Size::new("rear valve off its law, mA", rear_ma, 0.0, within_ma),
    ];
    for share in [0.9, 1.1] {
        let wrong = [
            ("kp", Law { kp: share * law.kp, ..law }),
            ("ki", Law { ki: share * law.ki, ..law }),
            ("ratio", Law { ratio: share * law.ratio, ..law }),
            ("lag", Law { time_constant_s: share * law.time_constant_s, ..law }),
        ];
        for (what, wrong) in
            wrong.iter().filter(|(what, _)| *what != "lag" || law.time_constant_s > 0.0)
        {
            let [front, rear] = off_ma(r, *wrong);
            let worse = front > 1.5 * front_ma || rear > 1.5 * rear_ma;
            let told = f64::from(u8::from(worse));
            sizes.push(Size::new(format!("{what} by {share} is told apart"), told, 1.0, 0.0));
        }
    }
    sizes
}

/// Angle of a rear joint that goes where its law asks it to, for this front one, deg.
fn follows_deg(r: &Recording, law: Law) -> Vec<f64> {
    let a = Machine::xt28().articulation;
    let keeps =
        if law.time_constant_s > 0.0 { (-PERIOD_S / law.time_constant_s).exp() } else { 0.0 };
    let speed_m_s = r.each(DriveStatus::decode, |m| m.speed_m_s);
    let (mut followed_deg, mut rear_deg, mut integral_deg_s) = (0.0, 0.0, 0.0);
    let step = |(front_deg, speed_m_s): (f64, f64)| {
        followed_deg = front_deg + (followed_deg - front_deg) * keeps;
        if speed_m_s > a.speed_threshold_m_s {
            let error_deg = a.rear_ratio * followed_deg - rear_deg;
            integral_deg_s += error_deg * PERIOD_S;
            let opening = a.kp_per_deg * (error_deg + a.ki_per_s * integral_deg_s);
            rear_deg += a.rate_max_deg_s * opening.clamp(-1.0, 1.0) * PERIOD_S;
        }
        rear_deg
    };
    front_deg(r).into_iter().zip(speed_m_s).map(step).collect()
}

/// The rear joint itself turns late: over the bend it is behind the nominal one by the area that the law has between
/// them. Tolerance: a tenth, what the lock gives way to the tyres.
fn late_joint(seen: &Seen) -> Vec<Size> {
    let area_deg_s = |series: &[f64]| mean(series, [BENDS_S, 13.9]) * (13.9 - BENDS_S);
    let rear = |r: &Recording| area_deg_s(&r.each(WheelSpeedJoint::decode, |m| m.rear_joint_deg));
    let late = Law { time_constant_s: 1.0, ..Law::NOMINAL };
    let wanted_deg_s = area_deg_s(&follows_deg(seen.without, Law::NOMINAL))
        - area_deg_s(&follows_deg(seen.with, late));
    let behind_deg_s = rear(seen.without) - rear(seen.with);
    vec![Size::new("rear joint behind, deg s", behind_deg_s, wanted_deg_s, 0.1 * wanted_deg_s)]
}
