//! The receiver and the wired sensors alone, fed with the whole vehicle's state.

use xt28_machine::{Machine, PerWheel, SimTime, Wheel};
use xt28_sim::{
    Actuation, Bodies, Effects, GnssFix, GnssReceiver, Plant, Ramp, RapierBodies, ReducedBodies,
    STEP, Sensors, Terrain, Vehicle, VehicleState,
};

/// The states of 10 s over a ramp in bends, all arms moving.
fn driven<B: Bodies>() -> Vec<VehicleState> {
    let ramp = Ramp { x_m: [1.0, 3.0, 5.0, 7.0], height_m: 0.2, y_min_m: -1.9, y_max_m: -0.5 };
    run::<B>(&Terrain::ramp(&ramp), |t| Actuation {
        arm_opening: PerWheel::from_fn(|w| 0.15 * (t + w.index() as f64).sin()),
        steer_opening: [0.3 * (0.8 * t).sin(), 0.2 * (0.8 * t - 0.5).sin()],
        ..ahead(t)
    })
}

fn ahead(t: f64) -> Actuation {
    Actuation { pump_displacement: [(t / 2.0).min(1.0); 2], ..Actuation::idle(1200.0) }
}

fn run<B: Bodies>(terrain: &Terrain, doing: impl Fn(f64) -> Actuation) -> Vec<VehicleState> {
    let (machine, effects) = (Machine::xt28(), Effects::default());
    let mut vehicle: Vehicle<B> =
        Vehicle::with(&machine, &effects, terrain, PerWheel::splat(0.17), STEP);
    let states = (0..2000).map(|step| {
        vehicle.step(&doing(f64::from(step) * STEP.as_secs_f64()));
        *vehicle.state()
    });
    states.collect()
}

/// What a receiver makes of the states, with the state of each moment: it is asked every other step.
fn fixes(states: &[VehicleState], seed: Option<u64>) -> Vec<(GnssFix, VehicleState)> {
    let mut receiver = GnssReceiver::new(&Machine::xt28(), &Effects::default(), seed);
    let asked = states.iter().enumerate().step_by(2);
    let fixes = asked.filter_map(|(step, state)| {
        let now = SimTime::ZERO + STEP * u32::try_from(step).unwrap();
        receiver.step(now, state).map(|fix| (fix, *state))
    });
    fixes.collect()
}

/// Where the antenna is by the front frame's place and attitude, m.
fn antenna_m(s: &VehicleState) -> [f64; 3] {
    let [(sp, cp), (sr, cr), (sy, cy)] = [s.pitch_rad, s.roll_rad, s.yaw_rad].map(f64::sin_cos);
    // Yaw, then nose up, then right side high.
    let axes = [
        [cp * cy, cp * sy, sp],
        [-sy * cr + cy * sp * sr, cy * cr + sy * sp * sr, -sr * cp],
        [-sy * sr - cy * sp * cr, cy * sr - sy * sp * cr, cr * cp],
    ];
    let at = Machine::xt28().sensors.gnss_antenna_m;
    core::array::from_fn(|k| s.position_m[k] + (0..3).map(|i| at[i] * axes[i][k]).sum::<f64>())
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn the_receiver_alone_says_where_the_vehicle_is() {
    says_where::<RapierBodies>();
    says_where::<ReducedBodies>();
}

/// Exact fixes come at 8 Hz, to a tick of 10 ms; they are where place and attitude have the antenna, and their velocities,
/// summed up over the steps between, lead from each to the next. Tolerances: 0.1 mm, the single precision of
/// the engine's axes 4 m away, and 2 mm/s.
fn says_where<B: Bodies>() {
    let states = driven::<B>();
    let fixes = fixes(&states, None);
    assert_eq!(fixes.len(), 80);
    for (k, (fix, state)) in fixes.iter().enumerate() {
        let due_s = k as f64 / 8.0;
        let late_s = fix.at.as_secs_f64() - due_s;
        assert!((0.0..0.01).contains(&late_s), "{k}: {late_s} s late");
        let off_m = apart(fix.position_m, antenna_m(state));
        assert!(off_m < 1e-4, "{k}: {off_m} m");
        assert_eq!(fix.heading_rad, state.yaw_rad);
    }
    let dt_s = STEP.as_secs_f64();
    let step_of = |fix: &GnssFix| (fix.at.as_secs_f64() / dt_s).round() as usize;
    for pair in fixes.windows(2) {
        let ((one, _), (next, _)) = (&pair[0], &pair[1]);
        let between = &states[step_of(one) + 1..=step_of(next)];
        let lasts_s = dt_s * between.len() as f64;
        let mean_m_s: [f64; 3] = core::array::from_fn(|i| {
            between.iter().map(|s| s.antenna_velocity_m_s[i]).sum::<f64>() / between.len() as f64
        });
        let gone_m_s = core::array::from_fn(|i| (next.position_m[i] - one.position_m[i]) / lasts_s);
        let off_m_s = apart(mean_m_s, gone_m_s);
        assert!(off_m_s < 2e-3, "{off_m_s} m/s");
        assert_eq!(next.velocity_m_s, between[between.len() - 1].antenna_velocity_m_s);
    }
}

/// Noise is what the machine file says, about what an exact receiver says. Tolerance: a fifth, of 240 draws
/// three and more times what chance does.
#[test]
fn a_receivers_noise_lies_about_where_the_vehicle_is() {
    let states = driven::<ReducedBodies>();
    let (exact, s) = (fixes(&states, None), Machine::xt28().sensors);
    let (mut position, mut level, mut up, mut heading) = ([0.0; 2], [0.0; 2], [0.0; 2], [0.0; 2]);
    let add = |sum: &mut [f64; 2], by: f64| *sum = [sum[0] + by * by, sum[1] + 1.0];
    for seed in 0..4 {
        for ((fix, _), (exact, _)) in fixes(&states, Some(seed)).iter().zip(&exact) {
            for i in 0..3 {
                add(&mut position, fix.position_m[i] - exact.position_m[i]);
                let sum = if i < 2 { &mut level } else { &mut up };
                add(sum, fix.velocity_m_s[i] - exact.velocity_m_s[i]);
            }
            add(&mut heading, fix.heading_rad - exact.heading_rad);
        }
    }
    for ([squares, count], wanted) in [
        (position, s.gnss_position_m),
        (level, s.gnss_velocity_xy_m_s),
        (up, s.gnss_velocity_z_m_s),
        (heading, s.gnss_heading_rad),
    ] {
        let deviation = (squares / count).sqrt();
        assert!((deviation / wanted - 1.0).abs() < 0.2, "{deviation}, not {wanted}");
    }
}

#[test]
fn readings_alone_say_what_the_vehicle_does() {
    reads::<RapierBodies>();
    reads::<ReducedBodies>();
}

/// Exact readings against one another and against what no wire carries: pressures on their areas are the cylinders'
/// force, to 1e-9 of it; strokes and joints go on by their rates, to 0.1 mm and 0.1 mrad a step, which arms that
/// start and the engine's single precision leave.
fn reads<B: Bodies>() {
    let (machine, sensors, dt_s) = (Machine::xt28(), Sensors::default(), STEP.as_secs_f64());
    let states = driven::<B>();
    let mut before = sensors.read(&states[0]);
    for s in &states[1..] {
        let now = sensors.read(s);
        for w in Wheel::ALL {
            let force_n = now.pressure_a_pa[w] * machine.arms.area_bore_m2
                - now.pressure_b_pa[w] * machine.arms.area_rod_m2;
            let off_n = (force_n - s.cylinder_force_n[w]).abs();
            assert!(off_n < 1e-9 * s.cylinder_force_n[w].abs().max(1.0), "{w}: {off_n} N");
            let went_m = now.stroke_m[w] - before.stroke_m[w];
            let off_m = (went_m - dt_s * s.stroke_rate_m_s[w]).abs();
            assert!(off_m < 1e-4, "{w}: {off_m} m");
        }
        for i in 0..2 {
            let turned_rad = now.joint_rad[i] - before.joint_rad[i];
            assert!((turned_rad - dt_s * s.joint_rate_rad_s[i]).abs() < 1e-4, "joint {i}");
        }
        before = now;
    }
}

#[test]
fn wheel_readings_alone_roll_as_far_as_the_vehicle_goes() {
    rolls::<RapierBodies>();
    rolls::<ReducedBodies>();
}

/// Straight ahead on level ground each wheel's reading, summed up, is the way. Tolerance: 1 %, what a wheel is pressed in.
fn rolls<B: Bodies>() {
    let (machine, sensors, dt_s) = (Machine::xt28(), Sensors::default(), STEP.as_secs_f64());
    let states = run::<B>(&Terrain::Flat, ahead);
    let gone_m = states[1999].antenna_position_m[0] - states[0].antenna_position_m[0];
    for wheel in Wheel::ALL {
        let rates = states[1..].iter().map(|s| sensors.read(s).wheel_speed_rad_s[wheel]);
        let rolled_m = dt_s * rates.sum::<f64>() * machine.wheels.radius_m;
        assert!((rolled_m / gone_m - 1.0).abs() < 0.01, "{wheel}: {rolled_m} m, {gone_m} m");
    }
}
