//! Both circuits of the drive by the pressures of their pumps: what torque their motors have.

use xt28_machine::{Machine, PerWheel, Wheel};

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

/// What each motor has of its circuit's displacement, 1 each where all three have the same.
pub(in crate::diagnosis) fn weights(s: &Signals, machine: &Machine, i: usize) -> PerWheel<f64> {
    let shares = s.motor_shares(i);
    if shares.iter().all(|(_, share)| *share == 1.0) {
        return shares;
    }
    let means = circuit_means(machine, &shares);
    PerWheel::from_fn(|w| shares[w] / means[usize::from(!is_of_first(machine, w))])
}

/// Mean of each circuit's three.
pub(super) fn circuit_means(machine: &Machine, of: &PerWheel<f64>) -> [f64; 2] {
    let mut means = [0.0; 2];
    for (w, value) in of.iter() {
        means[usize::from(!is_of_first(machine, w))] += value / 3.0;
    }
    means
}

/// Torque of a wheel's motor from its circuit's pressures, Nm: on the three of a circuit by their displacements.
pub(super) fn motor_nm(s: &Signals, machine: &Machine, wheel: Wheel, i: usize) -> f64 {
    let over_pa = circuits_pa(s, i)[usize::from(!is_of_first(machine, wheel))];
    let nm = over_pa * (machine.wheels.torque_max_nm / PRESSURE_AT_TORQUE_MAX_PA);
    nm * weights(s, machine, i)[wheel]
}

#[cfg(test)]
mod tests {
    use super::super::still::still;
    use super::*;

    #[test]
    fn motors_of_a_circuit_share_its_torque_by_their_displacements() {
        let (machine, mut s) = (Machine::xt28(), still(1));
        for forward in [1, 3] {
            s.pump_pressure_pa[forward].fill(0.1 * PRESSURE_AT_TORQUE_MAX_PA);
        }
        s.motor_share = PerWheel::from_fn(|w| vec![if w == Wheel::Br { 0.4 } else { 1.0 }; s.len]);
        let nm = |w| motor_nm(&s, &machine, w, 50) / machine.wheels.torque_max_nm;
        // BR is with FL and MR: 2.4 of three displacements.
        for (wheel, share) in
            [(Wheel::Br, 0.5), (Wheel::Fl, 1.25), (Wheel::Mr, 1.25), (Wheel::Fr, 1.0)]
        {
            assert!((nm(wheel) - 0.1 * share).abs() < 1e-12, "{wheel}: {}", nm(wheel));
        }
    }
}
