//! The inertial unit alone, fed with the whole vehicle's state: carried on from its readings, the
//! machine is where it is.

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel};
use xt28_sim::{
    Actuation, Bodies, Effects, Imu, Plant, Ramp, RapierBodies, ReducedBodies, STEP, Terrain,
    Vehicle, VehicleState,
};

type V3 = [f64; 3];

/// Throttle, weaving steering, all arms.
fn driven(t: f64) -> Actuation {
    Actuation {
        arm_opening: PerWheel::from_fn(|w| 0.15 * (t + w.index() as f64).sin()),
        steer_opening: [0.3 * (0.8 * t).sin(), 0.2 * (0.8 * t - 0.5).sin()],
        pump_displacement: [(t / 2.0).min(1.0); 2],
        ..Actuation::idle(1200.0)
    }
}

#[test]
fn readings_carried_on_lead_where_the_machine_is() {
    carried_on::<RapierBodies>();
    carried_on::<ReducedBodies>();
}

/// Ten seconds over a ramp in bends, from rates and specific force alone. Tolerances: 20 urad of
/// attitude and 2 mm/s of the front frame's velocity, four times what the engine's single precision
/// leaves of 2000 steps.
fn carried_on<B: Bodies>() {
    let (machine, effects) = (Machine::xt28(), Effects::default());
    let ramp = Ramp { x_m: [1.0, 3.0, 5.0, 7.0], height_m: 0.2, y_min_m: -1.9, y_max_m: -0.5 };
    let terrain = Terrain::ramp(&ramp);
    let mut vehicle: Vehicle<B> =
        Vehicle::with(&machine, &effects, &terrain, PerWheel::splat(0.17), STEP);
    let (imu, dt_s) = (Imu::new(&effects), STEP.as_secs_f64());
    let mut axes = axes_of(vehicle.state());
    let mut velocity = com_velocity_m_s(&machine, vehicle.state());
    let mut worst = [0.0_f64; 2];
    let mut tilted = 0.0_f64;
    for step in 0..2000 {
        vehicle.step(&driven(f64::from(step) * dt_s));
        let (s, sample) = (vehicle.state(), imu.step(vehicle.state()));
        let turning = world(&axes, sample.rate_rad_s);
        axes = orthonormal(axes.map(|axis| plus(axis, cross(turning, axis), dt_s)));
        velocity = plus(velocity, world(&axes, sample.specific_force_m_s2), dt_s);
        velocity[2] -= GRAVITY_M_S2 * dt_s;
        for (axis, truth) in axes.iter().zip(axes_of(s)) {
            worst[0] = worst[0].max(apart(*axis, truth));
        }
        worst[1] = worst[1].max(apart(velocity, com_velocity_m_s(&machine, s)));
        tilted = tilted.max(s.roll_rad.abs());
    }
    assert!(tilted > 0.03, "the ramp leaves it level: {tilted} rad");
    assert!(worst[0] < 2e-5, "{} rad", worst[0]);
    assert!(worst[1] < 2e-3, "{} m/s", worst[1]);
}

/// Axes of the front frame in the world: turned, then nose up, then right side high.
fn axes_of(s: &VehicleState) -> [V3; 3] {
    let [(sp, cp), (sr, cr), (sy, cy)] = [s.pitch_rad, s.roll_rad, s.yaw_rad].map(f64::sin_cos);
    let x = [cp * cy, cp * sy, sp];
    let y = [-sy * cr + cy * sp * sr, cy * cr + sy * sp * sr, -sr * cp];
    [x, y, cross(x, y)]
}

/// Velocity of the front frame's centre of mass, from that of the antenna.
fn com_velocity_m_s(machine: &Machine, s: &VehicleState) -> V3 {
    let (antenna_m, com_m) = (machine.sensors.gnss_antenna_m, machine.frames.front_com_m);
    let axes = axes_of(s);
    let lever = world(&axes, core::array::from_fn(|k| com_m[k] - antenna_m[k]));
    plus(s.antenna_velocity_m_s, cross(world(&axes, s.front_rate_rad_s), lever), 1.0)
}

/// Axes that have left one another a little, square again.
fn orthonormal([x, y, _]: [V3; 3]) -> [V3; 3] {
    let x = unit(x);
    let z = unit(cross(x, y));
    [x, cross(z, x), z]
}

fn world(axes: &[V3; 3], v: V3) -> V3 {
    core::array::from_fn(|k| v[0] * axes[0][k] + v[1] * axes[1][k] + v[2] * axes[2][k])
}

fn plus(a: V3, b: V3, times: f64) -> V3 {
    core::array::from_fn(|k| a[k] + times * b[k])
}

fn apart(a: V3, b: V3) -> f64 {
    plus(a, b, -1.0).iter().map(|d| d * d).sum::<f64>().sqrt()
}

fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: V3) -> V3 {
    a.map(|component| component / apart(a, [0.0; 3]))
}
