//! Tyres under the whole vehicle: softened without a jump, calm at any stiffness, brush, rolling on soft ground.

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, TyreModel, Wheel};
use xt28_sim::effects::{Overlay, SoftTyre};
use xt28_sim::{
    Actuation, Bodies, Effects, Plant, Ramp, RapierBodies, ReducedBodies, STEP, Terrain, Track,
    Vehicle, VehicleState,
};

fn overlay(text: &str) -> Effects {
    Overlay::parse(text, std::path::Path::new("o.toml")).unwrap().effects(&Machine::xt28()).unwrap()
}

fn vehicle(machine: &Machine, effects: &Effects, terrain: &Terrain) -> Vehicle {
    Vehicle::with(machine, effects, terrain, PerWheel::splat(0.17), STEP)
}

/// 3 s of standing, then a throttle step to a third of full speed; every state.
fn drive(
    machine: &Machine,
    effects: &Effects,
    terrain: &Terrain,
    seconds: f64,
) -> Vec<VehicleState> {
    let mut vehicle = vehicle(machine, effects, terrain);
    let steps = (seconds / STEP.as_secs_f64()) as u32;
    let states = (0..steps).map(|step| {
        let t = f64::from(step) * STEP.as_secs_f64();
        let pump = ((t - 3.0) / 0.5).clamp(0.0, 1.0);
        vehicle.step(&Actuation { pump_displacement: [pump; 2], ..Actuation::idle(1200.0) });
        *vehicle.state()
    });
    states.collect()
}

fn soft(stiffness_n_m: f64, damping_n_s_m: f64) -> Effects {
    let mut effects = Effects::default();
    for wheel in Wheel::ALL {
        effects.wheels[wheel].soft_tyre = SoftTyre { stiffness_n_m, damping_n_s_m };
    }
    effects
}

/// What the ground pushes the machine with after a fall of 0.8 m, N: most while all wheels are above it, and most.
fn fallen_n<B: Bodies>(effects: &Effects) -> [f64; 2]
where
    Vehicle<B>: Track,
{
    let (machine, idle) = (Machine::xt28(), Actuation::idle(1200.0));
    let mut vehicle: Vehicle<B> =
        Vehicle::with(&machine, effects, &Terrain::Flat, PerWheel::splat(0.17), STEP);
    (0..1000).for_each(|_| vehicle.step(&idle));
    let mut lifted = *vehicle.state();
    lifted.position_m[2] += 0.8;
    lifted.antenna_position_m[2] += 0.8;
    vehicle.place(&lifted, &idle);
    let drop_m = |stroke_m: f64| machine.linkage().at_stroke(stroke_m).drop_m;
    let mut most_n = [0.0_f64; 2];
    for _ in 0..120 {
        let before = *vehicle.state();
        vehicle.step(&idle);
        // With the reference stroke the wheels of a frame at height zero touch.
        let above_m = Wheel::ALL.map(|w| {
            let at_m = |s: &VehicleState| s.position_m[2] - drop_m(s.stroke_m[w]) + drop_m(0.25);
            at_m(&before).min(at_m(vehicle.state()))
        });
        let is_above = above_m.iter().all(|above_m| *above_m > 1e-3);
        let pushed_n = vehicle.state().ground_force_n.sum();
        most_n = [most_n[0].max(if is_above { pushed_n } else { 0.0 }), most_n[1].max(pushed_n)];
    }
    most_n
}

/// However soft a tyre and strong its damper, the air holds nothing.
#[test]
fn a_machine_that_falls_feels_the_ground_when_it_touches_it() {
    for (stiffness_n_m, damping_n_s_m) in [(8e6, 6e4), (4e5, 6e4), (1.5e5, 2e5)] {
        let effects = soft(stiffness_n_m, damping_n_s_m);
        let fallen = [fallen_n::<RapierBodies>(&effects), fallen_n::<ReducedBodies>(&effects)];
        for [above_n, most_n] in fallen {
            assert!(above_n == 0.0 && most_n > 4e5, "{stiffness_n_m}: {above_n}, {most_n} N");
        }
        let ratio = fallen[1][1] / fallen[0][1];
        assert!((ratio - 1.0).abs() < 0.2, "{stiffness_n_m}: {fallen:?} N");
    }
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    values.for_each(|v| (sum, count) = (sum + v * v, count + 1.0));
    f64::sqrt(sum / count)
}

/// From the neutral stiffness down nothing jumps: the first step away from it changes next to nothing,
/// also where a machine without the effect ends.
#[test]
fn softening_sets_in_without_a_jump() {
    let machine = Machine::xt28();
    let ramp = Ramp { x_m: [1.0, 3.0, 4.0, 6.0], height_m: 0.2, y_min_m: -1.9, y_max_m: -0.5 };
    let terrain = Terrain::ramp(&ramp);
    let run = |k: f64| {
        let effects = if k == 8e6 { Effects::default() } else { soft(k, 6e4) };
        drive(&machine, &effects, &terrain, 14.0)
    };
    let (neutral, beside, half) = (run(8e6), run(7.999e6), run(4e6));
    let apart = |a: &[VehicleState], b: &[VehicleState], f: fn(&VehicleState) -> f64| {
        rms(a.iter().zip(b).skip(600).map(|(a, b)| f(a) - f(b)))
    };
    type Signal = (&'static str, fn(&VehicleState) -> f64, f64);
    let signals: [Signal; 4] = [
        ("pitch, rad", |s| s.pitch_rad, 3e-4),
        ("roll, rad", |s| s.roll_rad, 8e-4),
        ("stroke, m", |s| s.stroke_m[Wheel::Mr], 5e-4),
        ("travel, m", |s| s.position_m[0], 0.01),
    ];
    for (name, f, bound) in signals {
        let (jump, step) = (apart(&neutral, &beside, f), apart(&neutral, &half, f));
        assert!(jump < bound, "{name}: {jump} at the seam, {step} for half the stiffness");
    }
}

#[test]
fn any_stiffness_drives_calmly() {
    let machine = Machine::xt28();
    for (k, c) in [(2e5, 5e3), (4e5, 1e4), (1e6, 2e4), (4e6, 5e4), (2e7, 1e5)] {
        let states = drive(&machine, &soft(k, c), &Terrain::Flat, 9.0);
        let end = states.last().unwrap();
        let travel_m = end.position_m[0] - states[0].position_m[0];
        assert!((2.0..4.0).contains(&travel_m), "{k}: {travel_m}");
        let late = &states[states.len() - 400..];
        let shake = rms(late
            .windows(2)
            .map(|w| w[1].front_specific_force_m_s2[2] - w[0].front_specific_force_m_s2[2]));
        assert!(shake < 0.1, "{k}: {shake} m/s2 from step to step");
    }
}

#[test]
fn a_machine_on_brush_tyres_drives_and_turns() {
    let mut machine = Machine::xt28();
    machine.vehicle.tyre_model = TyreModel::Brush;
    machine.vehicle.tyre_stiffness_n_m = 6e5;
    machine.vehicle.tyre_damping_n_s_m = 1.5e4;
    let mut vehicle = vehicle(&machine, &Effects::default(), &Terrain::Flat);
    let mut last: Option<VehicleState> = None;
    let mut shake = 0.0_f64;
    for step in 0..3000 {
        let t = f64::from(step) * STEP.as_secs_f64();
        vehicle.step(&Actuation {
            pump_displacement: [((t - 2.0) / 2.0).clamp(0.0, 1.0); 2],
            steer_opening: if (4.0..9.0).contains(&t) { [0.3, 0.168] } else { [0.0; 2] },
            ..Actuation::idle(1200.0)
        });
        let s = *vehicle.state();
        if let Some(last) = last {
            let jump = s.front_specific_force_m_s2[1] - last.front_specific_force_m_s2[1];
            shake = shake.max(jump.abs());
        }
        last = Some(s);
    }
    let s = vehicle.state();
    assert!(shake < 0.5, "{shake} m/s2 from step to step");
    assert!((s.joint_rad[0].to_degrees() - 15.0).abs() < 0.7, "{:?}", s.joint_rad);
    assert!(s.yaw_rad > 0.3, "{}", s.yaw_rad);
}

/// Rolling steadily, the motors make what the rolling resistance takes: nothing else brakes, and
/// nothing pushes.
#[test]
fn rolling_costs_the_rolling_resistance() {
    let machine = Machine::xt28();
    let w = &machine.wheels;
    let asked_nm = w.rolling_resistance * machine.mass_kg() * GRAVITY_M_S2 * w.radius_m;
    let states = drive(&machine, &Effects::default(), &Terrain::Flat, 20.0);
    let late = &states[states.len() - 1000..];
    let made_nm = late.iter().map(|s| s.wheel_torque_nm.sum()).sum::<f64>() / late.len() as f64;
    assert!((made_nm / asked_nm - 1.0).abs() < 2e-3, "{made_nm} Nm of {asked_nm} Nm");
}

/// Rolling resistance in soil, mire and snow holds a wheel at rest as hard ground does, and once it has
/// been driven.
#[test]
fn a_machine_stands_still_however_hard_it_rolls() {
    let mut machine = Machine::xt28();
    for coefficient in [0.02, 0.05, 0.2, 0.5] {
        machine.wheels.rolling_resistance = coefficient;
        for pump in [0.0, 0.5] {
            let mut vehicle = vehicle(&machine, &Effects::default(), &Terrain::Flat);
            let mut fastest_rad_s = 0.0_f64;
            for step in 0..1600 {
                let pump = if (400..600).contains(&step) { pump } else { 0.0 };
                let throttle =
                    Actuation { pump_displacement: [pump; 2], ..Actuation::idle(1200.0) };
                vehicle.step(&throttle);
                if step >= 1400 {
                    let rates = vehicle.state().wheel_speed_rad_s.0;
                    fastest_rad_s = rates.iter().fold(fastest_rad_s, |w, rate| w.max(rate.abs()));
                }
            }
            let rim_m_s = fastest_rad_s * machine.wheels.radius_m;
            assert!(rim_m_s < 0.003, "{coefficient}, driven by {pump}: {rim_m_s} m/s");
        }
    }
}

/// On a slope with the motors off only the rolling resistance holds. Up to its limit the machine creeps
/// as the resistance fades, and beyond it rolls off with what is left of its weight.
#[test]
fn rolling_resistance_holds_on_a_slope_up_to_its_limit() {
    let mut machine = Machine::xt28();
    let off = Actuation { motor_displacement: PerWheel::splat(0.0), ..Actuation::idle(1200.0) };
    for coefficient in [0.05, 0.2] {
        machine.wheels.rolling_resistance = coefficient;
        let speeds_m_s = |share: f64| {
            let grade_rad = (share * coefficient).atan();
            let text = format!("[[effect]]\nname = \"terrain-slope\"\ngrade_x_rad = {grade_rad}");
            let mut vehicle = vehicle(&machine, &overlay(&text), &Terrain::Flat);
            let after_1_s = |vehicle: &mut Vehicle| {
                (0..200).for_each(|_| vehicle.step(&off));
                -vehicle.state().wheel_speed_rad_s.mean() * machine.wheels.radius_m
            };
            [(); 5].map(|()| after_1_s(&mut vehicle))
        };
        let creep_m_s = 0.05 * 0.5_f64.atanh() * machine.wheels.radius_m;
        let [.., before, last] = speeds_m_s(0.5);
        assert!(
            (last / creep_m_s - 1.0).abs() < 0.03,
            "{coefficient}: {last}, not {creep_m_s} m/s"
        );
        assert!((last - before).abs() < 1e-4, "{coefficient}: {last} m/s after {before} m/s");
        let inertia_kg = 6.0
            * machine.masses.wheel_kg
            * (machine.vehicle.wheel_gyration_m / machine.wheels.radius_m).powi(2);
        let left_m_s2 = 0.5 * coefficient * GRAVITY_M_S2 * (1.5 * coefficient).atan().cos();
        let gains_m_s = left_m_s2 * machine.mass_kg() / (machine.mass_kg() + inertia_kg);
        let [.., before, last] = speeds_m_s(1.5);
        let gained_m_s = last - before;
        assert!((gained_m_s / gains_m_s - 1.0).abs() < 0.02, "{gained_m_s}, not {gains_m_s} m/s");
    }
}
