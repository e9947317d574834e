//! Rows of the arms' hydraulics: what the oil does for a command, and what the cylinder makes of it.

use xt28_machine::{GRAVITY_M_S2, Wheel};
use xt28_sim::{STEP, VehicleState};

use crate::row::{MACHINE, Row, Seen, Signal, Size, Stay, Values, joints_rad, strokes_m, wheels};
use crate::scene::{OPENS_S, STROKE_M, Scene, step_at};

/// Speed of a cylinder whose valve is fully open, m/s.
const FULL_M_S: f64 = 0.212;
/// While the arms extend by 0.2 of the valves, and while they go back by 0.1, s.
const UP_S: [f64; 2] = [2.6, 3.4];
const DOWN_S: [f64; 2] = [3.9, 4.4];

/// What acts on a command alone: nothing shows while the arms' valves are closed. The other arms' oil goes
/// where it goes anyway.
const OF_VALVES: &[Stay] = &[
    Stay::ToTheBit(Scene::Bends),
    Stay::ToTheBitUntil(OPENS_S),
    Stay::Within("oil of the others", OTHERS, [0.0, 6.0], 1e-9),
    Stay::Within("joints", joints_rad, [0.0, 6.0], 1e-3),
];
/// What acts on its own: the oil of the others goes where it goes anyway.
const OF_ONE: &[Stay] = &[
    Stay::Within("oil of the others", OTHERS, [0.0, 6.0], 1e-9),
    Stay::Within("joints", joints_rad, [0.0, 6.0], 1e-3),
];
const OTHERS: Signal = |s| wheels("middle").chain(wheels("BR")).map(|w| oil_m(s, w)).collect();

/// Stroke at which the oil of a nominal cylinder would make no force, m.
fn oil_m(s: &VehicleState, wheel: Wheel) -> f64 {
    let h = &MACHINE.hydraulics;
    let spring_n = s.cylinder_force_n[wheel] + h.lock_damping_n_s_m * s.stroke_rate_m_s[wheel];
    s.stroke_m[wheel] + spring_n / h.lock_stiffness_n_m
}

/// The way that the oil of both front arms makes between two times against that of `speed_m_s`, which is told the
/// opening and the state before each step.
fn oil(
    seen: &Seen,
    between_s: [f64; 2],
    speed_m_s: impl Fn(&VehicleState, Wheel) -> f64,
) -> Vec<Size> {
    let range = Seen::steps(between_s);
    let size = |w: Wheel| {
        let made_m = oil_m(&seen.with[range.end], w) - oil_m(&seen.with[range.start], w);
        let steps = seen.with[range.clone()].iter();
        let wanted_m = steps.map(|s| speed_m_s(s, w) * STEP.as_secs_f64()).sum::<f64>();
        Size::new(format!("oil of {w}, m"), made_m, wanted_m, 1e-6)
    };
    wheels("front").map(size).collect()
}

/// Both ways at these openings in place of 0.2 and -0.1.
fn both_ways(seen: &Seen, [up, down]: [f64; 2]) -> Vec<Size> {
    [(UP_S, up), (DOWN_S, down)]
        .into_iter()
        .flat_map(|(between_s, opening)| oil(seen, between_s, |_, _| opening * FULL_M_S))
        .collect()
}

/// How far the front arms are behind the nominal ones at a time: their oil to a micrometre, their strokes to a
/// millimetre, for arms that are behind leave some of their load to the others.
fn behind(seen: &Seen, t_s: f64, wanted_m: f64) -> Vec<Size> {
    let at = step_at(t_s);
    let sizes = wheels("front").flat_map(|w| {
        let by =
            |of: fn(&VehicleState, Wheel) -> f64| of(&seen.without[at], w) - of(&seen.with[at], w);
        [
            Size::new(format!("oil of {w} behind, m"), by(oil_m), wanted_m, 1e-6),
            Size::new(format!("{w} behind, m"), by(|s, w| s.stroke_m[w]), wanted_m, 1e-3),
        ]
    });
    sizes.collect()
}

fn valve(effect: &'static str, values: Values) -> Row {
    Row { scope: "front", stays: OF_VALVES, ..Row::new(effect, values, Scene::Swings) }
}

pub(crate) fn rows() -> Vec<Row> {
    [of_commands(), of_cylinders()].concat()
}

/// From command to flow.
fn of_commands() -> Vec<Row> {
    vec![
        Row {
            shows: Some(|seen| behind(seen, 3.4, 0.2 * FULL_M_S * 0.2)),
            ..valve("arm-delay", &[("delay_s", 0.2)])
        },
        Row {
            shows: Some(|seen| {
                // A spool that is held over each step is ahead of one that moves by half of one.
                let dt_s = STEP.as_secs_f64();
                behind(seen, 3.4, 0.2 * FULL_M_S * dt_s / (dt_s / 0.1).exp_m1())
            }),
            ..valve("valve-lag", &[("time_constant_s", 0.1)])
        },
        Row {
            shows: Some(|seen| both_ways(seen, [0.18, -0.08])),
            ..valve("valve-hysteresis", &[("width", 0.04)])
        },
        Row {
            shows: Some(|seen| both_ways(seen, [0.16, -0.06])),
            ..valve("valve-deadband", &[("deadband", 0.04)])
        },
        Row {
            shows: Some(|seen| both_ways(seen, [0.26, -0.13])),
            ..valve("valve-gain", &[("factor", 1.3)])
        },
        Row {
            shows: Some(|seen| both_ways(seen, [0.14, -0.14])),
            ..valve("speed-asymmetry", &[("extension_factor", 0.7), ("contraction_factor", 1.4)])
        },
        Row {
            shows: Some(load_dependent),
            ..valve(
                "load-dependent-speed",
                &[("droop", 0.02), ("set_at_pa", 2e6), ("contraction_factor", 1.5)],
            )
        },
        Row {
            shows: Some(short_pump),
            stays: &[
                Stay::ToTheBit(Scene::Bends),
                Stay::ToTheBitUntil(OPENS_S),
                Stay::Within("joints", joints_rad, [0.0, 6.0], 1e-3),
            ],
            ..Row::new("pump-flow-limit", &[("flow_m3_s", 0.001)], Scene::Swings)
        },
    ]
}

/// From flow to force.
fn of_cylinders() -> Vec<Row> {
    vec![
        Row {
            scope: "front",
            shows: Some(|seen| {
                oil(seen, [0.0, OPENS_S], |s, w| -0.004 * s.cylinder_force_n[w] / weight_n(0.25))
            }),
            stays: OF_ONE,
            ..Row::new("leakage-drift", &[("rate_m_s", 0.004)], Scene::Stands)
        },
        Row {
            scope: "front",
            shows: Some(|seen| {
                oil(seen, [0.0, OPENS_S], |s, w| {
                    0.01 * ((80e3 - s.cylinder_force_n[w]) / hanging_n()).clamp(0.0, 1.0)
                })
            }),
            stays: OF_ONE,
            ..Row::new("unsupported-sag", &[("rate_m_s", 0.01), ("below_n", 80e3)], Scene::Stands)
        },
        gas(),
        damping(),
        seals(Scene::Swings, |seen| loop_n(seen, UP_S, 0.2)),
        seals(Scene::Swings, |seen| loop_n(seen, DOWN_S, -0.1)),
        seals(Scene::Creeps, |seen| loop_n(seen, [4.0, 6.0], 0.02)),
    ]
}

/// Load of a cylinder at `stroke_m` that carries a sixth of the machine, N.
fn weight_n(stroke_m: f64) -> f64 {
    let machine = &*MACHINE;
    machine.mass_kg() * GRAVITY_M_S2 / 6.0 / machine.linkage().at_stroke(stroke_m).force_ratio
}

/// What the wheel that hangs on it draws a cylinder with, N.
fn hanging_n() -> f64 {
    let machine = &*MACHINE;
    let hanging_kg =
        machine.masses.wheel_kg + machine.masses.arm_kg * machine.vehicle.arm_com_share;
    hanging_kg * GRAVITY_M_S2 / machine.linkage().at_stroke(0.25).force_ratio
}

/// The root of the drop that the load of each moment leaves of 8 bar.
fn load_dependent(seen: &Seen) -> Vec<Size> {
    let speed_m_s = |opening: f64| {
        move |s: &VehicleState, w: Wheel| {
            let load_pa = s.cylinder_force_n[w] / MACHINE.arms.area_bore_m2;
            let lost = 0.02 * (load_pa - 2e6) / 8e5;
            let drop = if opening < 0.0 { 1.0 + 1.5 * lost } else { 1.0 - lost };
            opening * FULL_M_S * drop.sqrt()
        }
    };
    [oil(seen, UP_S, speed_m_s(0.2)), oil(seen, DOWN_S, speed_m_s(-0.1))].concat()
}

/// Six arms at 0.2 ask for twice what there is; on the way back at 0.1, by the rod sides, for less.
fn short_pump(seen: &Seen) -> Vec<Size> {
    let asked_m3_s = 6.0 * 0.2 * FULL_M_S * seen.machine.arms.area_bore_m2;
    both_ways(seen, [0.2 * 0.001 / asked_m3_s, -0.1])
}

/// A cylinder whose stroke was set under a sixth of the weight gives way, under what it carries, by p V^n constant
/// and some 30 MN/m of oil.
fn gas() -> Row {
    let shows = |seen: &Seen| {
        let a = &seen.machine.arms;
        let compression_m = |load_n: f64| {
            let absolute_pa = (load_n + 5e5 * a.area_rod_m2) / a.area_bore_m2 + 1.013e5;
            let left = ((2e6 + 1.013e5) / absolute_pa).powf(1.0 / 1.2);
            0.8e-3 / a.area_bore_m2 * (1.0 - left) + load_n / 3.0e7
        };
        let last = seen.with[step_at(10.0)];
        let size = |w: Wheel| {
            let given_m = STROKE_M - last.stroke_m[w];
            let wanted_m =
                compression_m(last.cylinder_force_n[w]) - compression_m(weight_n(STROKE_M));
            Size::new(format!("{w} gives, m"), given_m, wanted_m, 2e-5)
        };
        wheels("front").map(size).collect()
    };
    Row {
        scope: "front",
        shows: Some(shows),
        stays: OF_ONE,
        ..Row::new(
            "accumulator-gas",
            &[("share", 1.0), ("precharge_pa", 2e6), ("volume_m3", 0.8e-3), ("exponent", 1.2)],
            Scene::Stands,
        )
    }
}

/// A moving cylinder is behind its oil by what its damper takes, and at rest where it would be anyway.
fn damping() -> Row {
    let shows = |seen: &Seen| {
        let h = &seen.machine.hydraulics;
        let wanted_m = h.lock_damping_n_s_m * 0.2 * FULL_M_S / h.lock_stiffness_n_m;
        let size = |w: Wheel| {
            let [without, with] = seen.means(UP_S, |s| s.stroke_m[w]);
            Size::new(format!("{w} behind, m"), without - with, wanted_m, 1e-4)
        };
        Wheel::ALL.into_iter().map(size).collect()
    };
    Row {
        shows: Some(shows),
        stays: &[
            Stay::Within("joints", joints_rad, [0.0, 6.0], 1e-3),
            Stay::Within("strokes at rest", strokes_m, [5.8, 6.0], 1e-4),
        ],
        ..Row::new("lock-damping", &[("factor", 2.0)], Scene::Swings)
    }
}

fn seals(scene: Scene, shows: fn(&Seen) -> Vec<Size>) -> Row {
    Row {
        shows: Some(shows),
        stays: &[Stay::Within("joints", joints_rad, [0.0, 6.0], 1e-3)],
        ..Row::new(
            "seal-stiction",
            &[("coulomb_n", 3000.0), ("stribeck_n", 2000.0), ("stribeck_speed_m_s", 0.008)],
            scene,
        )
    }
}

/// The oil bears what the seals drag at this speed beside the load, whose mean is what it was but for what the wheels
/// that go along resist.
fn loop_n(seen: &Seen, between_s: [f64; 2], opening: f64) -> Vec<Size> {
    let fade = opening * FULL_M_S / 0.008;
    let wanted_n = (3000.0 + 2000.0 * (-fade * fade).exp()).copysign(opening);
    let [without, with] = seen.means(between_s, |s| s.cylinder_force_n.mean());
    vec![Size::new("oil's force, N", with - without, wanted_n, 250.0)]
}
