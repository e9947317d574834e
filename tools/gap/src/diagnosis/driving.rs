//! Engine and circuits from the throttle alone: mean wheel speed and mean pressure out.

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel};
use xt28_sim::effects::Lag;
use xt28_sim::{Drive, DriveInput, Effects};

use super::signals::{DT_S, Samples, Signals};

/// What the lumped machine did less what was measured.
#[derive(Clone, Debug, Default)]
pub(super) struct DriveErrors {
    /// Mean wheel speed, rad/s.
    pub(super) speed_rad_s: Samples,
    /// Forward less reverse pressure, mean of both circuits, Pa.
    pub(super) pressure_pa: Samples,
}

/// Steps between two samples: the drive's law is stiff against the wheels' inertia.
const SUBSTEPS: u32 = 2;

/// Drives the block and a mass on wheels with the throttle commanded.
#[must_use]
pub(super) fn drive_errors(signals: &Signals, machine: &Machine, effects: &Effects) -> DriveErrors {
    let dt_s = DT_S / f64::from(SUBSTEPS);
    let drive = Drive::new(machine, effects);
    let mut state = drive.at_rest(dt_s);
    let w = &machine.wheels;
    let payload_kg = effects.masses.payload.mass_kg;
    let weight_n = (machine.mass_kg() + payload_kg) * GRAVITY_M_S2;
    let wheel_kg_m2 = machine.masses.wheel_kg * machine.vehicle.wheel_gyration_m.powi(2);
    let inertia_kg_m2 =
        (machine.mass_kg() + payload_kg) * w.radius_m * w.radius_m + 6.0 * wheel_kg_m2;
    let added = effects.wheels.iter().map(|(_, e)| e.rolling_resistance.added).sum::<f64>() / 6.0;
    let drag_nm = (w.rolling_resistance + added) * weight_n * w.radius_m;
    let slope_nm = -weight_n * effects.slope.grade_x_rad.sin() * w.radius_m;
    let (mut lag, mut speed) = (Lag::new(signals.throttle[0]), signals.mean_wheel_speed_rad_s(0));
    let mut errors = DriveErrors::default();
    for i in 0..signals.len {
        let mut pressure_pa = 0.0;
        for _ in 0..SUBSTEPS {
            let throttle = lag.step(signals.throttle[i], machine.drive.speed_time_constant_s, dt_s);
            let input = DriveInput {
                // Motors at a third: what the pump then gives is the throttle's share of full speed.
                pump_displacement: [throttle; 2],
                motor_displacement: PerWheel::splat(1.0 / 3.0),
                engine_speed_rpm: machine.drive.engine_speed_rpm,
                wheel_speed_rad_s: PerWheel::splat(speed),
            };
            let out = drive.step(&mut state, &input, dt_s);
            let p = out.pump_pressure_pa;
            pressure_pa = (p[1] - p[0] + p[3] - p[2]) / 2.0;
            let torque_nm = out.wheel_torque_nm.sum() - drag_nm * (speed / 0.05).tanh() + slope_nm;
            speed += torque_nm / inertia_kg_m2 * dt_s;
        }
        let measured = |side: usize| signals.pump_pressure_pa[side][i];
        errors.speed_rad_s.push(speed - signals.mean_wheel_speed_rad_s(i));
        errors
            .pressure_pa
            .push(pressure_pa - (measured(1) - measured(0) + measured(3) - measured(2)) / 2.0);
    }
    errors
}
