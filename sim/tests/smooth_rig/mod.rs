//! A drive that steers, moves its arms, lifts a wheel and lands it, seen by every sensor there is.

pub(crate) mod numbers;

use std::sync::Arc;

use xt28_machine::{Machine, PerWheel, SimTime, Wheel};
use xt28_sim::terrain::{Extent, Grid};
use xt28_sim::{
    Actuation, Effects, GnssReceiver, Imu, Plant, Ramp, Readings, ReducedBodies, STEP, Sensors,
    Terrain, Vehicle, VehicleState,
};

/// How long the drive lasts, steps: 3.6 s.
const STEPS: u32 = 720;
/// The wheel that is lifted, while its five neighbours carry the machine.
const LIFTED: Wheel = Wheel::Ml;
/// When it leaves the ground, at the earliest, and when it is let down again, s.
const LIFTED_S: [f64; 2] = [0.6, 2.4];

/// What is looked at: its name, how many numbers it is, and what of it the solver leaves open, in its SI unit.
/// It ends where impulses are out of balance by less than would move the machine by 1e-9 m/s; of positions that
/// leaves what a step makes of it, of forces what makes it in a step.
pub(crate) const QUANTITIES: [(&str, usize, f64); 16] = [
    ("place", 3, 1e-11),
    ("attitude", 3, 1e-11),
    ("joints", 2, 1e-11),
    ("strokes", 6, 1e-11),
    ("strokes read", 6, 1e-11),
    ("fix", 3, 1e-11),
    ("velocity of the fix", 3, 1e-9),
    ("wheel speeds", 6, 1e-9),
    ("wheel speeds read", 6, 1e-9),
    ("rates read", 3, 1e-9),
    ("specific force read", 3, 2e-7),
    ("cylinder forces", 6, 1e-3),
    ("ground forces", 6, 1e-3),
    ("bore pressures read", 6, 0.2),
    ("rod pressures read", 6, 0.2),
    ("pump pressures read", 4, 0.2),
];

/// For each step the numbers of all [`QUANTITIES`], in order.
pub(crate) type Trace = Vec<Vec<f64>>;

/// Level; slopes of some 15 degrees, hollows and crests of a few metres; edges of a ramp under one side;
/// a boulder under the other.
pub(crate) fn grounds() -> [(&'static str, Terrain); 4] {
    let drawn = |height_m: fn(f64, f64) -> f64| {
        Terrain::Grid(Arc::new(Grid::from_fn(Extent::default(), height_m)))
    };
    let ramp = Ramp { x_m: [0.4, 1.0, 1.6, 2.2], height_m: 0.2, y_min_m: -1.9, y_max_m: -0.5 };
    let gentle = |x: f64, y: f64| {
        0.15 * (1.1 * x).sin() * (0.9 * y + 0.4).cos() + 0.02 * (3.0 * x - 2.0 * y).sin()
    };
    let boulder = |x: f64, y: f64| {
        let apart2 = (x - 1.3).powi(2) + (y - 1.3).powi(2);
        0.25 * (1.0 - apart2 / 0.25).max(0.0).sqrt()
    };
    [
        ("level ground", Terrain::Flat),
        ("gentle ground", drawn(gentle)),
        ("the ramp", Terrain::ramp(&ramp)),
        ("the boulder", drawn(boulder)),
    ]
}

fn drive(t_s: f64) -> Actuation {
    let [from_s, to_s] = LIFTED_S;
    let turn = core::f64::consts::TAU * (t_s - from_s) / (to_s - from_s);
    let lift = if (from_s..to_s).contains(&t_s) { -0.6 * turn.sin() } else { 0.0 };
    let swing = |w: Wheel| 0.15 * (1.3 * t_s + w.index() as f64).sin();
    Actuation {
        pump_displacement: [(t_s - 0.5).clamp(0.0, 0.8); 2],
        steer_opening: [0.3 * (0.8 * t_s).sin(), 0.2 * (0.8 * t_s - 0.5).sin()],
        arm_opening: PerWheel::from_fn(|w| if w == LIFTED { lift } else { swing(w) }),
        ..Actuation::idle(1200.0)
    }
}

/// The drive of this machine, from being set down on.
pub(crate) fn trace(machine: &Machine, effects: &Effects, terrain: &Terrain) -> Trace {
    let strokes = PerWheel::splat(0.17);
    let mut vehicle = Vehicle::<ReducedBodies>::with(machine, effects, terrain, strokes, STEP);
    let (sensors, imu) = (Sensors::new(effects), Imu::new(effects));
    let mut receiver = GnssReceiver::new(machine, effects, None);
    let (mut now, mut fix) = (SimTime::ZERO, [[0.0; 3]; 2]);
    let mut trace = Trace::new();
    for step in 0..STEPS {
        vehicle.step(&drive(f64::from(step) * STEP.as_secs_f64()));
        let state = vehicle.state();
        // Receivers are asked every 10 ms.
        if step % 2 == 0
            && let Some(new) = receiver.step(now, state)
        {
            fix = [new.position_m, new.velocity_m_s];
        }
        now += STEP;
        let imu = imu.step(state);
        let of_imu = [imu.rate_rad_s, imu.specific_force_m_s2];
        trace.push(instant(state, &sensors.read(state), fix, of_imu));
    }
    trace
}

/// The numbers of [`QUANTITIES`].
fn instant(
    s: &VehicleState,
    read: &Readings,
    [fix_m, fix_m_s]: [[f64; 3]; 2],
    [rate_rad_s, force_m_s2]: [[f64; 3]; 2],
) -> Vec<f64> {
    let all: [&[f64]; QUANTITIES.len()] = [
        &s.position_m,
        &[s.yaw_rad, s.roll_rad, s.pitch_rad],
        &s.joint_rad,
        &s.stroke_m.0,
        &read.stroke_m.0,
        &fix_m,
        &fix_m_s,
        &s.wheel_speed_rad_s.0,
        &read.wheel_speed_rad_s.0,
        &rate_rad_s,
        &force_m_s2,
        &s.cylinder_force_n.0,
        &s.ground_force_n.0,
        &read.pressure_a_pa.0,
        &read.pressure_b_pa.0,
        &read.pump_pressure_pa,
    ];
    let mut instant = Vec::with_capacity(QUANTITIES.iter().map(|(_, count, _)| count).sum());
    for ((name, count, _), values) in QUANTITIES.iter().zip(all) {
        assert_eq!(*count, values.len(), "{name}");
        instant.extend(values);
    }
    instant
}

/// Whether the wheel left the ground and came back.
pub(crate) fn lifted_and_landed(trace: &Trace) -> bool {
    let before = QUANTITIES.iter().take_while(|(name, ..)| *name != "ground forces");
    let force = before.map(|(_, count, _)| count).sum::<usize>() + LIFTED.index();
    let mut from_lifted = trace.iter().skip_while(|instant| instant[force] > 0.0);
    from_lifted.next().is_some() && from_lifted.any(|instant| instant[force] > 0.0)
}
