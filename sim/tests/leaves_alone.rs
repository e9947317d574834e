//! A sensor's own fault is that sensor's alone: what the others read of the same machine stays to the last bit.

use core::time::Duration;

use xt28_machine::{Machine, PerWheel, SimTime};
use xt28_sim::effects::{Effect, Scope, find};
use xt28_sim::{
    Actuation, Effects, GnssReceiver, Imu, Plant, Readings, ReducedBodies, STEP, Sensors, Terrain,
    Vehicle, VehicleState,
};

/// Every parameter a tolerance off and the first two, on all wheels.
fn off_by_tolerances(effect: &Effect) -> Effects {
    let mut effects = Effects::default();
    for (i, parameter) in effect.parameters.iter().enumerate() {
        let by = if i == 0 { 2.0 * parameter.tolerance } else { parameter.tolerance };
        parameter.set(&mut effects, Scope::All, parameter.neutral + by);
    }
    assert_ne!(effects, Effects::default(), "{}", effect.name);
    effects
}

/// All states of 6 s in which arms, joints and wheels move.
fn driven() -> Vec<VehicleState> {
    let mut vehicle: Vehicle<ReducedBodies> = Vehicle::with(
        &Machine::xt28(),
        &Effects::default(),
        &Terrain::Flat,
        PerWheel::splat(0.17),
        STEP,
    );
    let step = |k: u32| {
        let t_s = f64::from(k) * STEP.as_secs_f64();
        vehicle.step(&Actuation {
            arm_opening: PerWheel::from_fn(|w| 0.3 * (t_s * (1.0 + 0.1 * w.index() as f64)).sin()),
            steer_opening: [0.2 * t_s.sin(), 0.1],
            pump_displacement: [0.5; 2],
            ..Actuation::idle(1200.0)
        });
        *vehicle.state()
    };
    (0..1200).map(step).collect()
}

/// An inertial unit askew and a late receiver: no other sensor reads anything else.
#[test]
fn a_sensors_own_fault_shows_in_no_other_sensor() {
    let machine = Machine::xt28();
    let states = driven();
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

/// Asked at every step or at every second or fourth, a late receiver reads the state of its delay ago.
#[test]
fn a_late_receiver_is_as_late_however_often_it_is_asked() {
    let states = driven();
    let mut effects = Effects::default();
    effects.sensors.gnss_latency.delay_s = 0.4;
    let ago = 80;
    for every in [1, 2, 4] {
        let mut receiver = GnssReceiver::new(&Machine::xt28(), &effects, None);
        let mut fixes = 0;
        for (step, state) in states.iter().enumerate().step_by(every) {
            let now = SimTime::ZERO + STEP * u32::try_from(step).unwrap();
            let fix = receiver.step(now, state);
            if let (Some(fix), Some(then)) = (fix, step.checked_sub(ago)) {
                let was_m = states[then].antenna_position_m;
                assert_eq!(fix.position_m, was_m, "asked every {every} steps, at step {step}");
                fixes += 1;
            }
        }
        assert!(fixes > 40, "{fixes}");
    }
}
