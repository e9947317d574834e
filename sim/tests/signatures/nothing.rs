//! Rows of what is no part of the plant: readings, buses, gains of ECUs. Nothing of the machine may move.

use xt28_sim::VehicleState;

use crate::row::{Row, Seen, Size, Stay, Values};
use crate::scene::Scene;

/// To the bit, whatever the machine does.
const UNMOVED: &[Stay] = &[Stay::ToTheBit(Scene::Everything)];

pub(crate) fn rows() -> Vec<Row> {
    let unmoved: [(&str, Values); 12] = [
        ("arm-gain", &[("kp_factor", 1.4), ("ki_factor", 5.0)]),
        ("steer-gain", &[("kp_factor", 1.4), ("ki_factor", 5.0)]),
        ("rear-follower-lag", &[("time_constant_s", 1.0), ("ratio_factor", 0.5)]),
        ("stroke-bias", &[("bias_m", 0.01)]),
        ("stroke-scale", &[("factor", 1.1)]),
        ("pressure-bias", &[("bias_pa", 1e6)]),
        ("pressure-scale", &[("factor", 1.2), ("rod_share", 0.5)]),
        ("imu-offset", &[("roll_rad", 0.03), ("pitch_rad", -0.02)]),
        ("wheel-speed-scale", &[("factor", 1.2)]),
        ("gnss-latency", &[("delay_s", 0.3)]),
        ("frame-loss", &[("share", 0.3)]),
        ("command-jitter", &[("latest_s", 0.1)]),
    ];
    let row = |(effect, values)| Row { stays: UNMOVED, ..Row::new(effect, values, Scene::Stands) };
    let mut rows: Vec<Row> = unmoved.into_iter().map(row).collect();
    rows.push(Row {
        shows: Some(antenna),
        stays: &[Stay::AllButAntenna(Scene::Everything)],
        ..Row::new("gnss-lever-arm", LEVER, Scene::Bends)
    });
    rows
}

const LEVER: Values = &[("x_m", 0.8), ("y_m", -0.5)];

/// The antenna is off by the lever, turned with the frame.
fn antenna(seen: &Seen) -> Vec<Size> {
    let last = |states: &[VehicleState]| states[states.len() - 1];
    let (without, with) = (last(&seen.without), last(&seen.with));
    let (sin, cos) = without.yaw_rad.sin_cos();
    let wanted_m = [cos * 0.8 + sin * 0.5, sin * 0.8 - cos * 0.5];
    let size = |k: usize| {
        let by_m = with.antenna_position_m[k] - without.antenna_position_m[k];
        Size::new("antenna, m", by_m, wanted_m[k], 2e-3)
    };
    vec![size(0), size(1)]
}
