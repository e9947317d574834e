//! Masses and ground of the whole vehicle: load, centre of mass, slope, a joint that rolls.

use std::path::Path;

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Wheel};
use xt28_sim::effects::Overlay;
use xt28_sim::{Actuation, Effects, Plant, Ramp, STEP, Terrain, Vehicle, VehicleState};

fn overlay(text: &str) -> Effects {
    Overlay::parse(text, Path::new("o.toml")).unwrap().effects(&Machine::xt28()).unwrap()
}

/// The state after 8 s at rest on level ground, wheels free to roll: braked, they push against one
/// another and the cylinders weigh that too.
fn stand(effects: &Effects) -> VehicleState {
    stand_on(&Machine::xt28(), effects, &Terrain::Flat)
}

fn stand_on(machine: &Machine, effects: &Effects, terrain: &Terrain) -> VehicleState {
    let mut vehicle: Vehicle =
        Vehicle::with(machine, effects, terrain, PerWheel::splat(0.17), STEP);
    for _ in 0..1600 {
        vehicle.step(&Actuation::idle(1200.0));
    }
    *vehicle.state()
}

/// Weight that the cylinders say stands on the wheels, through the linkage, N.
fn weighed_n(s: &VehicleState) -> f64 {
    let machine = Machine::xt28();
    let own_kg = machine.masses.wheel_kg + machine.masses.arm_kg * machine.vehicle.arm_com_share;
    let on_wheel = |wheel: Wheel| {
        let ratio = machine.linkage().at_stroke(s.stroke_m[wheel]).force_ratio;
        s.cylinder_force_n[wheel] * ratio + own_kg * GRAVITY_M_S2
    };
    Wheel::ALL.into_iter().map(on_wheel).sum()
}

#[test]
fn cylinders_weigh_any_load_up_to_the_most() {
    let machine = Machine::xt28();
    for mass_kg in [0.0, 1.0, 4000.0, machine.masses.load_max_kg] {
        let mut effects = Effects::default();
        effects.masses.payload.mass_kg = mass_kg;
        let s = stand(&effects);
        let weight_n = (machine.mass_kg() + mass_kg) * GRAVITY_M_S2;
        assert!((s.ground_force_n.sum() / weight_n - 1.0).abs() < 2e-3, "{mass_kg}");
        let weighed_n = weighed_n(&s);
        assert!(
            (weighed_n / weight_n - 1.0).abs() < 0.01,
            "{mass_kg}: {weighed_n} N, {weight_n} N"
        );
    }
}

/// The inertial unit is screwed to the frame: it feels what the place feels at which the machine file has
/// the centre of mass, wherever that has gone.
#[test]
fn a_shifted_centre_of_mass_leaves_the_inertial_unit_where_it_is() {
    let machine = Machine::xt28();
    let shift = "[[effect]]\nname = \"com-shift\"\nx_m = 0.8\ny_m = 0.4\nz_m = 0.5";
    let slope = "\n[[effect]]\nname = \"terrain-slope\"\ngrade_x_rad = 0.05";
    let mut vehicle: Vehicle = Vehicle::with(
        &machine,
        &overlay(&format!("{shift}{slope}")),
        &Terrain::Flat,
        PerWheel::splat(0.17),
        STEP,
    );
    let lever_m: [f64; 3] =
        core::array::from_fn(|i| machine.frames.front_com_m[i] - machine.sensors.gnss_antenna_m[i]);
    let mut before_m_s: Option<[f64; 3]> = None;
    for step in 0..1000 {
        let arms = if step % 100 < 50 { 0.6 } else { -0.6 };
        vehicle.step(&Actuation {
            arm_opening: PerWheel([arms, -arms, arms, -arms, arms, -arms]),
            ..Actuation::idle(1200.0)
        });
        let s = vehicle.state();
        let [(sp, cp), (sr, cr), (sy, cy)] = [s.pitch_rad, s.roll_rad, s.yaw_rad].map(f64::sin_cos);
        // Yaw, then nose up, then right side high.
        let axes = [
            [cp * cy, cp * sy, sp],
            [-sy * cr + cy * sp * sr, cy * cr + sy * sp * sr, -sr * cp],
            [-sy * sr - cy * sp * cr, cy * sr - sy * sp * cr, cr * cp],
        ];
        let world = |v: [f64; 3]| -> [f64; 3] {
            core::array::from_fn(|i| v[0] * axes[0][i] + v[1] * axes[1][i] + v[2] * axes[2][i])
        };
        let ([wx, wy, wz], [x, y, z]) = (world(s.front_rate_rad_s), world(lever_m));
        let swing_m_s = [wy * z - wz * y, wz * x - wx * z, wx * y - wy * x];
        let now_m_s: [f64; 3] = core::array::from_fn(|i| s.antenna_velocity_m_s[i] + swing_m_s[i]);
        if let Some(before_m_s) = before_m_s.replace(now_m_s) {
            for (axis, felt_m_s2) in axes.iter().zip(s.front_specific_force_m_s2) {
                let along = |i: usize| {
                    let up_m_s2 = if i == 2 { GRAVITY_M_S2 } else { 0.0 };
                    let gained_m_s: f64 = now_m_s[i] - before_m_s[i];
                    axis[i] * (gained_m_s / STEP.as_secs_f64() + up_m_s2)
                };
                let wanted_m_s2 = along(0) + along(1) + along(2);
                // The engine's axes are single precision.
                let off_m_s2 = (felt_m_s2 - wanted_m_s2).abs();
                assert!(off_m_s2 < 2e-3, "{step}: {felt_m_s2}, not {wanted_m_s2} m/s2");
            }
        }
    }
}

/// On ground that rises by a grade the IMU sees the lean, the receiver the climb, the wheels less
/// normal load; strokes and joints stay.
#[test]
fn a_slope_is_seen_by_every_sensor_as_a_slope() {
    let grade = 0.1_f64;
    let up = overlay("[[effect]]\nname = \"terrain-slope\"\ngrade_x_rad = 0.1");
    let (level, s) = (stand(&Effects::default()), stand(&up));
    assert!((s.pitch_rad - level.pitch_rad - grade).abs() < 5e-3, "{}", s.pitch_rad);
    assert!((s.front_specific_force_m_s2[0] / GRAVITY_M_S2 - s.pitch_rad.sin()).abs() < 1e-3);
    let weight_n = Machine::xt28().mass_kg() * GRAVITY_M_S2 * grade.cos();
    assert!((s.ground_force_n.sum() / weight_n - 1.0).abs() < 2e-3);
    let side = stand(&overlay("[[effect]]\nname = \"terrain-slope\"\ngrade_y_rad = 0.1"));
    // Ground rising to the left lifts the left side.
    assert!((side.roll_rad + grade).abs() < 0.02, "{}", side.roll_rad);
    assert!(side.ground_force_n[Wheel::Fr] > side.ground_force_n[Wheel::Fl] + 3000.0);
    assert_strokes_and_joints_stay(&s, &level);
    assert_strokes_and_joints_stay(&side, &level);

    // Driving up, a metre of way is a metre times the sine of climb.
    let mut vehicle: Vehicle =
        Vehicle::with(&Machine::xt28(), &up, &Terrain::Flat, PerWheel::splat(0.17), STEP);
    let mut at_2_s = *vehicle.state();
    for step in 0..2000 {
        vehicle.step(&Actuation { pump_displacement: [1.0; 2], ..Actuation::idle(1200.0) });
        if step == 1000 {
            at_2_s = *vehicle.state();
        }
    }
    let way =
        |axis: usize| vehicle.state().antenna_position_m[axis] - at_2_s.antenna_position_m[axis];
    assert!((way(2).atan2(way(0)) - grade).abs() < 2e-3, "{} {}", way(0), way(2));
    let climb_m_s = vehicle.state().antenna_velocity_m_s;
    assert!((climb_m_s[2].atan2(climb_m_s[0]) - grade).abs() < 5e-3, "{climb_m_s:?}");
}

/// Strokes are those of `level` but for what the locks give way under loads that have moved downhill, to 2 um and by
/// less than 3 mm in all; joints to 0.2 mrad, which uneven scrub of the tyres takes across the slope.
fn assert_strokes_and_joints_stay(s: &VehicleState, level: &VehicleState) {
    let stiffness_n_m = Machine::xt28().hydraulics.lock_stiffness_n_m;
    for wheel in Wheel::ALL {
        let by_m = s.stroke_m[wheel] - level.stroke_m[wheel];
        let by_n = s.cylinder_force_n[wheel] - level.cylinder_force_n[wheel];
        assert!(by_m.abs() < 3e-3, "{wheel}: {by_m} m");
        assert!(
            (by_m + by_n / stiffness_n_m).abs() < 2e-6,
            "{wheel}: {by_m} m under {by_n} N more"
        );
    }
    for (joint_rad, level_rad) in s.joint_rad.iter().zip(level.joint_rad) {
        assert!((joint_rad - level_rad).abs() < 2e-4, "{joint_rad} rad");
    }
}

/// With a joint that rolls, the rear wheels on one side of a hump do not lift the front ones.
#[test]
fn a_roll_hinge_lets_the_frames_twist() {
    let hump = Ramp { x_m: [-1.0, -0.6, 0.6, 1.0], height_m: 0.25, y_min_m: -1.9, y_max_m: -0.5 };
    let terrain = Terrain::ramp(&hump);
    let mut free = Machine::xt28();
    free.vehicle.roll_hinge = true;
    let least = |s: &VehicleState| s.ground_force_n.0.into_iter().fold(f64::MAX, f64::min);
    let stiff = stand_on(&Machine::xt28(), &Effects::default(), &terrain);
    let twisting = stand_on(&free, &Effects::default(), &terrain);
    assert!(twisting.roll_rad > stiff.roll_rad + 0.01, "{} {}", twisting.roll_rad, stiff.roll_rad);
    assert!(least(&twisting) > least(&stiff) + 1000.0, "{} {}", least(&twisting), least(&stiff));
    let weight_n = free.mass_kg() * GRAVITY_M_S2;
    assert!((twisting.ground_force_n.sum() / weight_n - 1.0).abs() < 5e-3);
}
