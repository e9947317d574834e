//! Both circuits of the drive by the pressures of their pumps: what torque their motors have.

use xt28_machine::{Machine, Wheel};

use crate::diagnosis::signals::Signals;

/// Pressure for the largest torque, Pa (the machine's conventions).
pub(in crate::diagnosis) const PRESSURE_AT_TORQUE_MAX_PA: f64 = 350.0e5;

/// Forward less reverse pressure of both circuits at sample `i`, Pa.
pub(super) fn circuits_pa(signals: &Signals, i: usize) -> [f64; 2] {
    let measured = |side: usize| signals.pump_pressure_pa[side][i];
    [measured(1) - measured(0), measured(3) - measured(2)]
}

/// Whether a wheel's motor is of the first circuit.
pub(super) fn is_of_first(machine: &Machine, wheel: Wheel) -> bool {
    machine.wheels.circuit_1.iter().any(|name| name == wheel.name())
}

/// Torque of a wheel's motor from its circuit's pressures, Nm: equal on the three of a circuit.
pub(super) fn motor_nm(s: &Signals, machine: &Machine, wheel: Wheel, i: usize) -> f64 {
    let over_pa = circuits_pa(s, i)[usize::from(!is_of_first(machine, wheel))];
    over_pa * (machine.wheels.torque_max_nm / PRESSURE_AT_TORQUE_MAX_PA)
}
