//! Rows of the steering valves, on the angles of the joints of a machine that drives through a bend.

use xt28_sim::STEP;

use crate::row::{MACHINE, Row, Seen, Size, Stay, Values, mean_speed_rad_s, strokes_m};
use crate::scene::{Scene, TURNS_BY, TURNS_S, step_at};

/// What the tyres scrub differs a little from place to place in the bend, rad, and more once the joints have come to rest.
const SCRUB_RAD: f64 = 4e-4;
const SCRUB_AT_REST_RAD: f64 = 1.5e-3;

/// Nothing shows before the joints are turned, nor ever in a machine that does not steer.
const OF_JOINTS: &[Stay] = &[
    Stay::ToTheBit(Scene::Swings),
    Stay::ToTheBit(Scene::Drives(0.5)),
    Stay::ToTheBitUntil(TURNS_S[0][0]),
    Stay::Within("strokes", strokes_m, [5.0, 11.0], 1e-3),
    Stay::Within("mean wheel speed", mean_speed_rad_s, [5.0, 11.0], 0.02),
];

/// Rates that the valves ask of both joints, rad/s.
fn rates_rad_s() -> [f64; 2] {
    let full_rad_s = MACHINE.articulation.rate_max_deg_s.to_radians();
    TURNS_BY.map(|opening| opening * full_rad_s)
}

/// How far both joints are behind the nominal ones on the mean of a span of time.
fn behind(seen: &Seen, between_s: [f64; 2], wanted_rad: [f64; 2]) -> Vec<Size> {
    let size = |i: usize| {
        let [without, with] = seen.means(between_s, |s| s.joint_rad[i]);
        let what = format!("joint {i} behind at {between_s:?} s, rad");
        let turns = TURNS_S.iter().any(|[from, to]| between_s[0] >= *from && between_s[1] <= *to);
        let within_rad = if turns { SCRUB_RAD } else { SCRUB_AT_REST_RAD };
        Size::new(what, without - with, wanted_rad[i], within_rad)
    };
    vec![size(0), size(1)]
}

/// A late joint turns as the nominal one did, by so much later.
fn late_by(seen: &Seen, late_s: f64) -> Vec<Size> {
    let late = step_at(late_s);
    let apart_rad = |i: usize| {
        let both = seen.without.iter().zip(&seen.with[late..]);
        both.map(|(then, now)| (now.joint_rad[i] - then.joint_rad[i]).abs()).fold(0.0, f64::max)
    };
    (0..2)
        .map(|i| Size::new(format!("joint {i}, {late_s} s later"), apart_rad(i), 0.0, 2e-4))
        .collect()
}

fn row(effect: &'static str, values: Values, shows: fn(&Seen) -> Vec<Size>) -> Row {
    Row { shows: Some(shows), stays: OF_JOINTS, ..Row::new(effect, values, Scene::Bends) }
}

pub(crate) fn rows() -> Vec<Row> {
    vec![
        row("steer-delay", &[("delay_s", 0.2)], |seen| {
            let wanted_rad = rates_rad_s().map(|rate| 0.2 * rate);
            [behind(seen, [6.0, 7.0], wanted_rad), late_by(seen, 0.2)].concat()
        }),
        row("steer-lag", &[("time_constant_s", 0.15)], |seen| {
            // Once on the way, by the time constant's way; at rest, by nothing.
            let dt_s = STEP.as_secs_f64();
            let wanted_rad = rates_rad_s().map(|rate| rate * dt_s / (dt_s / 0.15).exp_m1());
            let back_rad = wanted_rad.map(|rad| -rad);
            [
                behind(seen, [6.2, 7.0], wanted_rad),
                behind(seen, [7.9, 8.0], [0.0; 2]),
                behind(seen, [9.2, 10.0], back_rad),
            ]
            .concat()
        }),
        // The rear joint as with a slow valve, the front one as ever.
        row("rear-follower-lag", &[("valve_time_constant_s", 0.15)], |seen| {
            let dt_s = STEP.as_secs_f64();
            let [_, rear_rad] = rates_rad_s().map(|rate| rate * dt_s / (dt_s / 0.15).exp_m1());
            [
                behind(seen, [6.2, 7.0], [0.0, rear_rad]),
                behind(seen, [7.9, 8.0], [0.0; 2]),
                behind(seen, [9.2, 10.0], [0.0, -rear_rad]),
            ]
            .concat()
        }),
        row("steer-rate", &[("factor", 0.7)], |seen| {
            let missing_rad = rates_rad_s().map(|rate| 0.3 * rate * 2.0);
            // On the way both are behind their oil by what the joint's damper takes.
            let v = &seen.machine.vehicle;
            let turned_s = 1.5 - v.joint_damping_nms / v.joint_stiffness_nm;
            let half_rad = rates_rad_s().map(|rate| 0.3 * rate * turned_s);
            [
                behind(seen, [6.4, 6.6], half_rad),
                behind(seen, [7.8, 8.0], missing_rad),
                behind(seen, [10.9, 11.0], [0.0; 2]),
            ]
            .concat()
        }),
        // Half the play behind on the way there, half of it on the way back, and there it stays.
        row("steer-backlash", &[("width_rad", 0.03)], |seen| {
            let half_rad = [0.015; 2];
            let back_rad = [-0.015; 2];
            [
                behind(seen, [6.0, 7.0], half_rad),
                behind(seen, [7.8, 8.0], half_rad),
                behind(seen, [9.5, 10.0], back_rad),
                behind(seen, [10.9, 11.0], back_rad),
            ]
            .concat()
        }),
    ]
}
