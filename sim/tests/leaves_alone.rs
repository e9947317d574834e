//! What an effect must not touch, it leaves alone to the last bit: sensors, buses and ECU gains the plant,
//! those of steering a machine that does not steer, those of the drive one that does not drive.

use core::time::Duration;

use xt28_machine::{Machine, PerWheel, SimTime};
use xt28_sim::effects::{Block, CATALOGUE, Effect, Scope, find};
use xt28_sim::{
    Actuation, Bodies, Effects, GnssReceiver, Imu, Plant, RapierBodies, Readings, ReducedBodies,
    STEP, Sensors, Terrain, Vehicle, VehicleState,
};

/// Gains of the ECUs, which no plant has.
const OF_ECUS: [&str; 3] = ["arm-gain", "steer-gain", "rear-follower-lag"];

/// What a machine is made to do.
#[derive(Clone, Copy)]
struct Doing {
    arms: bool,
    steers: bool,
    drives: bool,
}

const EVERYTHING: Doing = Doing { arms: true, steers: true, drives: true };

/// Every parameter a tolerance off and the first two, on all wheels: a lag with as much lead is none.
fn off_by_tolerances(effect: &Effect) -> Effects {
    let mut effects = Effects::default();
    for (i, parameter) in effect.parameters.iter().enumerate() {
        let [low, high] = parameter.range;
        let by = if i == 0 { 2.0 * parameter.tolerance } else { parameter.tolerance };
        let (off, back) = (parameter.neutral + by, parameter.neutral - by);
        let value = if off <= high { off } else { back };
        parameter.set(&mut effects, Scope::All, value.clamp(low, high));
    }
    assert_ne!(effects, Effects::default(), "{}", effect.name);
    effects
}

/// All states of 6 s.
fn run<B: Bodies>(effects: &Effects, doing: Doing) -> Vec<VehicleState> {
    let stroke_m = PerWheel::splat(0.17);
    let mut vehicle = Vehicle::<B>::with(&Machine::xt28(), effects, &Terrain::Flat, stroke_m, STEP);
    let step = |k: u32| {
        let t_s = f64::from(k) * STEP.as_secs_f64();
        let on = |does: bool, value: f64| if does && t_s > 1.0 { value } else { 0.0 };
        vehicle.step(&Actuation {
            arm_opening: PerWheel::from_fn(|w| {
                on(doing.arms, 0.3 * (t_s * (1.0 + 0.1 * w.index() as f64)).sin())
            }),
            steer_opening: [on(doing.steers, 0.2 * t_s.sin()), on(doing.steers, 0.1)],
            pump_displacement: [on(doing.drives, 0.5); 2],
            ..Actuation::idle(1200.0)
        });
        *vehicle.state()
    };
    (0..1200).map(step).collect()
}

/// What both solvers make of `effect` while the machine does as `doing` says is what they make of none.
fn assert_leaves(name: &str, doing: Doing) {
    let effects = off_by_tolerances(find(name).unwrap());
    let none = Effects::default();
    // The antenna's own place is the one thing of the state that a sensor's effect may move.
    let bare = |states: Vec<VehicleState>| -> Vec<VehicleState> {
        let (antenna_position_m, antenna_velocity_m_s) = ([0.0; 3], [0.0; 3]);
        let still = |s| VehicleState { antenna_position_m, antenna_velocity_m_s, ..s };
        states.into_iter().map(still).collect()
    };
    let same =
        bare(run::<ReducedBodies>(&effects, doing)) == bare(run::<ReducedBodies>(&none, doing));
    assert!(same, "{name} on the fast core");
    let same =
        bare(run::<RapierBodies>(&effects, doing)) == bare(run::<RapierBodies>(&none, doing));
    assert!(same, "{name} on rapier");
}

#[test]
fn what_is_of_sensors_buses_and_ecus_moves_nothing() {
    let of_none_else = |effect: &&Effect| {
        matches!(effect.block, Block::Sensor | Block::Bus) || OF_ECUS.contains(&effect.name)
    };
    let mut seen = 0;
    for effect in CATALOGUE.iter().filter(of_none_else) {
        assert_leaves(effect.name, EVERYTHING);
        seen += 1;
    }
    assert!(seen > 10, "{seen}");
}

#[test]
fn what_is_of_the_steering_valves_shows_only_in_a_machine_that_steers() {
    for name in ["steer-delay", "steer-lag", "steer-rate"] {
        assert_leaves(name, Doing { steers: false, ..EVERYTHING });
        assert_shows(name, Doing { drives: false, ..EVERYTHING });
    }
}

#[test]
fn what_is_of_the_drive_shows_only_in_a_machine_that_drives() {
    for name in ["throttle-delay", "drive-lag", "engine-droop"] {
        assert_leaves(name, Doing { drives: false, ..EVERYTHING });
    }
    for name in ["throttle-delay", "drive-lag"] {
        assert_shows(name, EVERYTHING);
    }
}

fn assert_shows(name: &str, doing: Doing) {
    let effects = off_by_tolerances(find(name).unwrap());
    let differs =
        run::<ReducedBodies>(&effects, doing) != run::<ReducedBodies>(&Effects::default(), doing);
    assert!(differs, "{name}");
}

/// Joints with play in them: no arm and no motor notices while the machine goes straight on.
#[test]
fn play_in_the_joints_leaves_arms_and_drive_of_a_straight_drive_as_they_are() {
    let effects = off_by_tolerances(find("steer-backlash").unwrap());
    let straight = Doing { steers: false, arms: false, drives: true };
    let [with, without] =
        [&effects, &Effects::default()].map(|e| run::<ReducedBodies>(e, straight));
    for (a, b) in with.iter().zip(&without) {
        let strokes = a.stroke_m.0.iter().zip(b.stroke_m.0).map(|(a, b)| (a - b).abs());
        assert!(strokes.fold(0.0, f64::max) < 5e-4, "{:?}, not {:?}", a.stroke_m, b.stroke_m);
        let apart_m_s = a.antenna_velocity_m_s[0] - b.antenna_velocity_m_s[0];
        assert!(apart_m_s.abs() < 0.02, "{apart_m_s} m/s");
    }
}

/// An inertial unit askew and a late receiver: no other sensor reads anything else.
#[test]
fn a_sensors_own_fault_shows_in_no_other_sensor() {
    let machine = Machine::xt28();
    let states = run::<ReducedBodies>(&Effects::default(), EVERYTHING);
    let read = |effects: &Effects| {
        let (sensors, imu) = (Sensors::new(effects), Imu::new(effects));
        let mut receiver = GnssReceiver::new(&machine, effects, Some(3));
        let mut now = SimTime::ZERO;
        let mut fixes = Vec::new();
        let mut readings: Vec<(Readings, _)> = Vec::new();
        for state in &states {
            readings.push((sensors.read(state), imu.step(state)));
            fixes.extend(receiver.step(now, state));
            now += Duration::from_secs_f64(STEP.as_secs_f64());
        }
        let (wired, tilt): (Vec<_>, Vec<_>) = readings.into_iter().unzip();
        (wired, tilt, fixes)
    };
    let none = read(&Effects::default());
    let of = |name: &str| read(&off_by_tolerances(find(name).unwrap()));
    let (askew, late) = (of("imu-offset"), of("gnss-latency"));
    assert!(askew.0 == none.0 && askew.2 == none.2 && askew.1 != none.1, "imu-offset");
    assert!(late.0 == none.0 && late.1 == none.1 && late.2 != none.2, "gnss-latency");
}
