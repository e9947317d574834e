//! The whole vehicle against statics and kinematics, and against itself.

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Wheel};
use xt28_sim::{Actuation, Plant, Ramp, STEP, Terrain, Vehicle, VehicleState};

fn idle() -> Actuation {
    Actuation::idle(1200.0)
}

/// Steps for `seconds`, calling `see` after each.
fn run(
    vehicle: &mut Vehicle,
    seconds: f64,
    mut actuation: impl FnMut(f64) -> Actuation,
    mut see: impl FnMut(&VehicleState),
) {
    let steps = (seconds / STEP.as_secs_f64()).round() as usize;
    for step in 0..steps {
        vehicle.step(&actuation(step as f64 * STEP.as_secs_f64()));
        see(vehicle.state());
    }
}

fn settled(terrain: &Terrain, stroke_m: f64) -> Vehicle {
    let mut vehicle = Vehicle::new(&Machine::xt28(), terrain, PerWheel::splat(stroke_m));
    run(&mut vehicle, 5.0, |_| idle(), |_| ());
    vehicle
}

#[test]
fn the_ground_carries_the_weight() {
    let machine = Machine::xt28();
    let vehicle = settled(&Terrain::Flat, 0.17);
    let weight_n = machine.mass_kg() * GRAVITY_M_S2;
    let sum_n = vehicle.state().ground_force_n.sum();
    assert!((sum_n / weight_n - 1.0).abs() < 1e-3, "{sum_n} N of {weight_n} N");
}

#[test]
fn cylinder_forces_follow_from_ground_forces_through_the_linkage() {
    let machine = Machine::xt28();
    let vehicle = settled(&Terrain::Flat, 0.17);
    let s = vehicle.state();
    for wheel in Wheel::ALL {
        let pose = machine.linkage().at_stroke(s.stroke_m[wheel]);
        // Moments about the pivot; standing wheels may push against one another, hence the width.
        let arm_n = machine.masses.arm_kg * GRAVITY_M_S2 * machine.vehicle.arm_com_share;
        let sprung_n = s.ground_force_n[wheel] - machine.masses.wheel_kg * GRAVITY_M_S2 - arm_n;
        let expected_n = sprung_n / pose.force_ratio;
        let error = s.cylinder_force_n[wheel] - expected_n;
        assert!(error.abs() < 0.05 * expected_n, "{wheel}: {error:.0} N of {expected_n:.0} N");
    }
}

#[test]
fn a_straight_drive_rolls_without_slip_and_keeps_its_line() {
    let machine = Machine::xt28();
    let mut vehicle = settled(&Terrain::Flat, 0.17);
    let start = vehicle.state().position_m;
    let mut rolled_m = 0.0;
    let pump = |t: f64| [(t / 2.0).min(1.0); 2];
    run(
        &mut vehicle,
        12.0,
        |t| Actuation { pump_displacement: pump(t), ..idle() },
        |s| rolled_m += s.wheel_speed_rad_s.mean() * machine.wheels.radius_m * STEP.as_secs_f64(),
    );
    let s = vehicle.state();
    let gone_m = s.position_m[0] - start[0];
    assert!((gone_m / rolled_m - 1.0).abs() < 5e-3, "{gone_m} m of {rolled_m} m rolled");
    assert!(s.position_m[1].abs() < 0.01, "{:?}", s.position_m);
    let third = machine.drive.speed_full_m_s / 3.0;
    let speed_m_s = s.wheel_speed_rad_s.mean() * machine.wheels.radius_m;
    assert!((speed_m_s / third - 1.0).abs() < 0.01, "{speed_m_s} m/s");
}

#[test]
fn a_turning_machine_stays_calm() {
    let mut vehicle = settled(&Terrain::Flat, 0.17);
    let turn = |t: f64| Actuation {
        pump_displacement: [(t / 2.0).min(1.0); 2],
        steer_opening: if (4.0..9.0).contains(&t) { [0.3, 0.168] } else { [0.0; 2] },
        arm_opening: PerWheel::splat(if t > 9.0 { 0.1 } else { 0.0 }),
        ..idle()
    };
    let (mut last, mut shake) = (0.0, 0.0_f64);
    run(&mut vehicle, 15.0, turn, |s| {
        shake = shake.max((s.front_specific_force_m_s2[1] - last).abs());
        last = s.front_specific_force_m_s2[1];
    });
    assert!(shake < 0.5, "sideways force jumps by {shake} m/s2 between steps");
    let s = vehicle.state();
    // The lock gives way to the scrub of the tyres by some tenths of a degree.
    assert!((s.joint_rad[0].to_degrees() - 15.0).abs() < 0.7, "{:?}", s.joint_rad);
    assert!((s.joint_rad[1].to_degrees() - 8.4).abs() < 0.7, "{:?}", s.joint_rad);
    assert!(s.yaw_rad > 0.3, "it turns left: {}", s.yaw_rad);
}

#[test]
fn a_ramp_under_the_right_wheels_lifts_the_right_side() {
    let ramp = Ramp { x_m: [4.0, 7.0, 8.5, 11.5], height_m: 0.3, y_min_m: -1.9, y_max_m: -0.5 };
    let mut vehicle = settled(&Terrain::ramp(&ramp), 0.17);
    let mut roll_max = 0.0_f64;
    let drive = |t: f64| Actuation { pump_displacement: [(t / 2.0).min(1.0); 2], ..idle() };
    run(&mut vehicle, 40.0, drive, |s| roll_max = roll_max.max(s.roll_rad));
    let s = vehicle.state();
    assert!(s.position_m[0] > 17.0, "it crossed: {:?}", s.position_m);
    // 0.3 m over a track of 2.35 m is 7.3 degrees; the other frames stay level, so less.
    assert!((1.5..7.3).contains(&roll_max.to_degrees()), "{}", roll_max.to_degrees());
    assert!(s.roll_rad.abs().to_degrees() < 0.1, "level again: {}", s.roll_rad.to_degrees());
}

#[test]
fn the_brake_holds_what_the_pump_cannot_move() {
    let mut vehicle = settled(&Terrain::Flat, 0.17);
    let start = vehicle.state().position_m[0];
    let braked = Actuation { pump_displacement: [0.2; 2], brake_released: false, ..idle() };
    run(&mut vehicle, 3.0, |_| braked, |_| ());
    assert!((vehicle.state().position_m[0] - start).abs() < 0.01);
}

#[test]
fn twice_the_same_is_the_same_to_the_bit() {
    let once = || {
        let mut vehicle = settled(&Terrain::Flat, 0.1);
        let drive = |t: f64| Actuation {
            pump_displacement: [(t / 2.0).min(1.0); 2],
            steer_opening: [0.1, 0.05],
            ..idle()
        };
        run(&mut vehicle, 5.0, drive, |_| ());
        *vehicle.state()
    };
    assert_eq!(once(), once());
}

/// A stander's sag says what a tyre's stiffness is.
#[test]
fn the_tyres_sag_by_their_stiffness() {
    let machine = Machine::xt28();
    let linkage = machine.linkage();
    let mut vehicle = Vehicle::new(&machine, &Terrain::Flat, PerWheel::splat(0.25));
    for _ in 0..2000 {
        vehicle.step(&Actuation::idle(1200.0));
    }
    let s = vehicle.state();
    for wheel in Wheel::ALL {
        let x_m = machine.wheels.axle_x_m[wheel.axle() as usize];
        let drop_m = linkage.at_stroke(s.stroke_m[wheel]).drop_m - linkage.at_stroke(0.25).drop_m;
        let sag_m = drop_m - s.position_m[2] - x_m * s.pitch_rad;
        let wanted_m = s.ground_force_n[wheel] / machine.vehicle.tyre_stiffness_n_m;
        assert!((sag_m / wanted_m - 1.0).abs() < 0.1, "{wheel}: {sag_m} m, not {wanted_m} m");
    }
}

/// A clone is a snapshot: both go on alike, to the bit, through contact changes on a ramp.
#[test]
fn a_clone_goes_on_bit_for_bit_like_the_original() {
    let ramp = Ramp { x_m: [0.3, 1.3, 3.0, 4.0], height_m: 0.2, y_min_m: -1.9, y_max_m: -0.5 };
    let mut original = settled(&Terrain::ramp(&ramp), 0.17);
    let drive = |step: u32| Actuation {
        pump_displacement: [1.0; 2],
        steer_opening: [0.1, 0.05],
        arm_opening: PerWheel::splat(0.2 * (f64::from(step) * 0.01).sin()),
        ..idle()
    };
    (0..337).for_each(|step| original.step(&drive(step)));
    let mut copy = original.clone();
    for step in 337..1500 {
        original.step(&drive(step));
        copy.step(&drive(step));
        assert_eq!(original.state(), copy.state(), "step {step}");
    }
}
