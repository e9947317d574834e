//! Rows of engine, circuits and rolling, on the wheels of a machine that starts from rest.

use xt28_machine::{Axle, GRAVITY_M_S2, Wheel};
use xt28_sim::{STEP, VehicleState};

use crate::row::{
    MACHINE, Row, Seen, Signal, Size, Stay, Values, joints_rad, mean_speed_rad_s, strokes_m, wheels,
};
use crate::scene::{OPENS_S, Scene};

/// Nothing shows before the pumps open, nor in a machine that does not drive.
const OF_DRIVES: &[Stay] = &[
    Stay::ToTheBit(Scene::Swings),
    Stay::ToTheBitUntil(OPENS_S),
    Stay::Within("strokes in the end", strokes_m, [9.5, 10.0], 1e-3),
    Stay::Within("joints", joints_rad, [0.0, 10.0], 1e-3),
];
/// What the mean wheel comes to is held by the integral, whatever comes on the way.
const SAME_SPEED: Stay = Stay::Within("speed in the end", mean_speed_rad_s, [9.5, 10.0], 1e-3);

/// Speed that the pumps ask for at this displacement, m/s.
fn asked_m_s(pump: f64) -> f64 {
    MACHINE.drive.speed_full_m_s / 3.0 * pump
}

/// How far the mean wheel has rolled less than the nominal one: what is late by a time, or lags by a constant, is so
/// much of the speed behind, whatever comes after it.
fn behind(seen: &Seen, late_s: f64) -> Vec<Size> {
    let [without, with] = seen.rolled_m(10.0);
    let wanted_m = late_s * asked_m_s(0.5);
    vec![Size::new("rolled behind, m", without - with, wanted_m, 0.02 * wanted_m)]
}

fn row(effect: &'static str, values: Values, scene: Scene) -> Row {
    Row { stays: OF_DRIVES, ..Row::new(effect, values, scene) }
}

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            shows: Some(|seen| behind(seen, 0.4)),
            ..row("throttle-delay", &[("delay_s", 0.4)], Scene::Drives(0.5))
        },
        Row {
            shows: Some(|seen| behind(seen, 0.6)),
            ..row("drive-lag", &[("time_constant_s", 0.6)], Scene::Drives(0.5))
        },
        Row {
            shows: Some(|seen| behind(seen, 0.6 - 0.2)),
            ..row("drive-lag", &[("time_constant_s", 0.6), ("lead_s", 0.2)], Scene::Drives(0.5))
        },
        Row {
            scope: "left",
            shows: Some(resistance),
            stays: &[
                SAME_SPEED,
                Stay::Within("strokes at rest", strokes_m, [1.9, 2.0], 1e-4),
                Stay::Within("load of the machine", WEIGHT, [1.5, 2.0], 200.0),
            ],
            ..row("rolling-resistance", &[("added", 0.1)], Scene::Drives(0.5))
        },
        Row {
            shows: Some(pinch),
            stays: &[
                Stay::Within("load of the machine", WEIGHT, [5.5, 6.0], 500.0),
                Stay::Within("joints", joints_rad, [0.0, 6.0], 1e-3),
            ],
            ..row("standstill-drag", &[("torque_nm", HOLD_NM)], Scene::Spreads)
        },
        Row {
            shows: Some(droop),
            // Arms that swing turn wheels, and the engine feels their power.
            stays: &[
                Stay::ToTheBit(Scene::Stands),
                Stay::ToTheBitUntil(OPENS_S),
                Stay::Within("strokes in the end", strokes_m, [9.5, 10.0], 1e-3),
            ],
            ..row("engine-droop", &[("droop_per_w", DROOP_PER_W)], Scene::Drives(1.0))
        },
        Row {
            shows: Some(short_of_power),
            ..row("engine-droop", &[("power_factor", 0.008)], Scene::Drives(1.0))
        },
    ]
}

const WEIGHT: Signal = |s| vec![s.ground_force_n.sum()];

/// The motors make what more the left wheels take.
fn resistance(seen: &Seen) -> Vec<Size> {
    let between_s = [8.0, 10.0];
    let [without, with] = seen.means(between_s, |s| s.wheel_torque_nm.sum());
    let [_, left_n] = seen.means(between_s, |s| wheels("left").map(|w| s.ground_force_n[w]).sum());
    let wanted_nm = 0.1 * left_n * seen.machine.wheels.radius_m;
    vec![Size::new("torque, Nm", with - without, wanted_nm, 0.02 * wanted_nm)]
}

/// Torque that holds a wheel at rest, Nm: little enough that all slide in their brakes.
const HOLD_NM: f64 = 1500.0;
/// Rate over which rolling resistance fades at rest, rad/s.
const DRAG_FADE_RAD_S: f64 = 0.05;

/// While front and rear arms swing, their wheels slide in their brakes. The ground then pushes each as hard as turns it
/// evenly against motor, brake and rolling resistance, on the lever of the pivot's height, and the cylinders weigh it.
fn pinch(seen: &Seen) -> Vec<Size> {
    let (m, between_s) = (seen.machine, [2.6, 2.95]);
    let own_kg = m.masses.wheel_kg + m.masses.arm_kg * m.vehicle.arm_com_share;
    let false_n = |s: &VehicleState, w: Wheel| {
        let ratio = m.linkage().at_stroke(s.stroke_m[w]).force_ratio;
        s.cylinder_force_n[w] * ratio + own_kg * GRAVITY_M_S2 - s.ground_force_n[w]
    };
    let push_n = |s: &VehicleState, w: Wheel, hold_nm: f64| {
        let (rate_rad_s, radius_m) = (s.wheel_speed_rad_s[w], m.wheels.radius_m);
        let drag_nm = m.wheels.rolling_resistance * s.ground_force_n[w] * radius_m;
        let against_nm = drag_nm * (rate_rad_s / DRAG_FADE_RAD_S).tanh();
        (s.wheel_torque_nm[w] - against_nm - hold_nm * rate_rad_s.signum()) / radius_m
    };
    let size = |w: Wheel| {
        let [without_n, with_n] = seen.means(between_s, |s| false_n(s, w));
        let [free_n, _] = seen.means(between_s, |s| push_n(s, w, 0.0));
        let [_, held_n] = seen.means(between_s, |s| push_n(s, w, HOLD_NM));
        let [_, stroke_m] = seen.means(between_s, |s| s.stroke_m[w]);
        let pose = m.linkage().at_stroke(stroke_m);
        // Forward pushes lift arms that point forward.
        let sense = if w.axle() == Axle::Front { 1.0 } else { -1.0 };
        let lever = sense * (pose.drop_m + m.wheels.radius_m) / pose.reach_m;
        let alone_n = HOLD_NM / m.wheels.radius_m * lever.abs();
        let wanted_n = lever * (held_n - free_n);
        Size::new(format!("false weight of {w}, N"), with_n - without_n, wanted_n, 0.05 * alone_n)
    };
    wheels("front").chain(wheels("rear")).map(size).collect()
}

/// Share of speed lost per watt: some 8 % at what full pumps take on the level.
const DROOP_PER_W: f64 = 5e-5;

/// Power that the wheels take in the step that leads from one state to the next, W.
fn power_w(before: &VehicleState, after: &VehicleState) -> f64 {
    after.wheel_torque_nm.iter().map(|(w, nm)| nm * before.wheel_speed_rad_s[w]).sum()
}

/// The engine loses its share of the power that it felt, a fifth of a second late; the wheels turn slower with it.
fn droop(seen: &Seen) -> Vec<Size> {
    let keeps = (-STEP.as_secs_f64() / 0.2_f64).exp();
    let (mut felt_w, mut power_before_w, mut worst_rpm) = (0.0, 0.0, 0.0_f64);
    for pair in seen.with.windows(2) {
        felt_w = power_before_w + (felt_w - power_before_w) * keeps;
        power_before_w = power_w(&pair[0], &pair[1]);
        let wanted_rpm = 1200.0 * (1.0 - DROOP_PER_W * felt_w.max(0.0)).max(0.5);
        worst_rpm = worst_rpm.max((pair[1].engine_speed_rpm - wanted_rpm).abs());
    }
    let m = seen.machine;
    let [_, speed_rad_s] = seen.means([8.0, 10.0], |s| s.wheel_speed_rad_s.mean());
    // v = asked (1 - droop c m g v).
    let drag_n = m.wheels.rolling_resistance * m.mass_kg() * GRAVITY_M_S2;
    let wanted_m_s = asked_m_s(1.0) / (1.0 + asked_m_s(1.0) * DROOP_PER_W * drag_n);
    let speed_m_s = speed_rad_s * m.wheels.radius_m;
    vec![
        Size::new("engine off its law, rpm", worst_rpm, 0.0, 1e-6),
        Size::new("speed, m/s", speed_m_s, wanted_m_s, 0.005 * wanted_m_s),
    ]
}

/// What power there is goes into rolling resistance: v = P / (c m g), and all of it is used.
fn short_of_power(seen: &Seen) -> Vec<Size> {
    let m = seen.machine;
    let most_w = 0.008 * m.drive.engine_power_w;
    let range = Seen::steps([7.0, 10.0]);
    let used_w = range.clone().map(|i| power_w(&seen.with[i - 1], &seen.with[i])).sum::<f64>()
        / range.len() as f64;
    let [_, speed_rad_s] = seen.means([8.0, 10.0], |s| s.wheel_speed_rad_s.mean());
    let wanted_m_s = most_w / (m.wheels.rolling_resistance * m.mass_kg() * GRAVITY_M_S2);
    vec![
        Size::new("power, W", used_w, most_w, 1e-6 * most_w),
        Size::new("speed, m/s", speed_rad_s * m.wheels.radius_m, wanted_m_s, 0.02 * wanted_m_s),
    ]
}
