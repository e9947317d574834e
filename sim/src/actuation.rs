//! What the ECUs' output stages do to the hydraulics, as openings and displacements.

use xt28_machine::PerWheel;

/// One set of actuator inputs, held over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actuation {
    /// Spool opening of each arm valve, -1 (retract) to 1 (extend).
    pub arm_opening: PerWheel<f64>,
    /// Opening of the front and the rear steering valve, -1 (right) to 1 (left).
    pub steer_opening: [f64; 2],
    /// Displacement of pumps 1 and 2, -1 (full reverse) to 1 (full forward).
    pub pump_displacement: [f64; 2],
    /// Displacement of each wheel motor, 0 to 1 (full).
    pub motor_displacement: PerWheel<f64>,
    /// Speed the engine governor holds, rpm.
    pub engine_speed_rpm: f64,
    /// The spring-applied parking brake is released.
    pub brake_released: bool,
}

impl Actuation {
    /// Everything closed, motors at full displacement, engine at `engine_speed_rpm`, brake released.
    #[must_use]
    pub const fn idle(engine_speed_rpm: f64) -> Self {
        Self {
            arm_opening: PerWheel::splat(0.0),
            steer_opening: [0.0; 2],
            pump_displacement: [0.0; 2],
            motor_displacement: PerWheel::splat(1.0),
            engine_speed_rpm,
            brake_released: true,
        }
    }

    /// What the machine does of it: no spool and no swash plate goes beyond its stop, no engine turns
    /// backwards, and what is no number moves nothing: springs bring a spool to its middle.
    #[must_use]
    pub fn saturated(&self) -> Self {
        let within = |value: f64, least: f64| {
            if value.is_nan() { 0.0 } else { value.clamp(least, 1.0) }
        };
        let engine = self.engine_speed_rpm;
        Self {
            arm_opening: self.arm_opening.map(|opening| within(opening, -1.0)),
            steer_opening: self.steer_opening.map(|opening| within(opening, -1.0)),
            pump_displacement: self.pump_displacement.map(|pump| within(pump, -1.0)),
            motor_displacement: self.motor_displacement.map(|motor| within(motor, 0.0)),
            engine_speed_rpm: if engine.is_finite() { engine.max(0.0) } else { 0.0 },
            ..*self
        }
    }
}
