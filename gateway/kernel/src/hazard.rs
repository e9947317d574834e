//! What must not be while the machine may move.

use crate::{Input, Limits, Reason, State, Stream};

/// The first hazard that forbids even a handshake.
pub(crate) fn before_arming(
    limits: &Limits,
    state: &State,
    input: &Input,
    now_ns: u64,
) -> Option<Reason> {
    let stamps = &input.stamps;
    let streams = [
        (Stream::ArmStatus, limits.status, input.arm.heard_at_ns),
        (Stream::DriveStatus, limits.status, input.drive.heard_at_ns),
        (Stream::Sensors, limits.sensors, stamps.sensors_ns),
        (Stream::Observation, limits.observation, stamps.observation_ns),
        (Stream::Policy, limits.policy, stamps.policy_ns),
    ];
    if !limits.are_sound() {
        return Some(Reason::LimitsUnsound);
    }
    if now_ns < state.last_ns {
        return Some(Reason::ClockBackwards);
    }
    if !input.bus_ok {
        return Some(Reason::BusFault);
    }
    if !input.alone {
        return Some(Reason::NotAlone);
    }
    for (stream, deadline, at_ns) in streams {
        if deadline.missed(at_ns, now_ns) {
            return Some(Reason::Stale(stream));
        }
    }
    match input.request {
        None => return Some(Reason::Stale(Stream::Policy)),
        Some(request) if !request.is_finite() => return Some(Reason::RequestNotFinite),
        Some(_) => {}
    }
    if !input.measured.is_finite() {
        return Some(Reason::MeasurementNotFinite);
    }
    // While armed it has to last: a single odd reading holds targets back and is gone again. The ECU has the first
    // word on a sensor of its own.
    let implausible_ns = now_ns.saturating_sub(state.plausible_ns);
    if !input.measured.is_plausible(limits)
        && (!state.is_armed() || implausible_ns > limits.steady_ns)
    {
        return Some(Reason::MeasurementImplausible);
    }
    if libm::fabs(input.measured.roll_rad) > limits.roll_max_rad {
        return Some(Reason::Roll);
    }
    if libm::fabs(input.measured.pitch_rad) > limits.pitch_max_rad {
        return Some(Reason::Pitch);
    }
    None
}

/// The first hazard while armed.
pub(crate) fn while_armed(
    limits: &Limits,
    state: &State,
    input: &Input,
    now_ns: u64,
) -> Option<Reason> {
    if let Some(reason) = before_arming(limits, state, input, now_ns) {
        return Some(reason);
    }
    if let Some(reason) = unready(input) {
        return Some(reason);
    }
    if limits.acknowledgement.missed(Some(state.acknowledged_ns), now_ns) {
        return Some(Reason::NotAcknowledged);
    }
    None
}

/// The ECU that carries out nothing. A handshake may begin with one all the same: it waits for our frames.
pub(crate) const fn unready(input: &Input) -> Option<Reason> {
    match (input.arm.ready, input.drive.ready) {
        (false, _) => Some(Reason::ArmEcuNotReady),
        (true, false) => Some(Reason::DriveEcuNotReady),
        (true, true) => None,
    }
}

/// Both ECUs are ready and accept what we send.
pub(crate) const fn both_in_step(limits: &Limits, input: &Input) -> bool {
    let (lag, modulus) = (limits.counter_lag_max, limits.counter_modulus);
    input.arm.ready
        && input.drive.ready
        && input.arm.in_step(lag, modulus)
        && input.drive.in_step(lag, modulus)
}
