//! The kernel's one function.

use crate::state::{Phase, State};
use crate::verdict::{Reason, Verdict};
use crate::{Arms, Command, Input, Limits, Order, hazard, limit};

/// What of the request may leave at `now_ns`, and the state after.
///
/// Total: any bits in any argument give an answer, and every command let through is finite and
/// within `limits`. Call it once a control period, also while disarmed.
#[must_use]
pub fn step(limits: &Limits, state: State, input: &Input, now_ns: u64) -> (State, Verdict) {
    let steadiness = state.steadiness.after(&input.measured, now_ns);
    let state = obey(limits, State { steadiness, ..state }, input, now_ns);
    match state.phase() {
        Phase::Disarmed => stay(limits, state, input, now_ns, Reason::Disarmed),
        Phase::Blocked(reason) => stay(limits, state, input, now_ns, reason),
        Phase::Handshake { since_ns, acknowledged } => {
            shake_hands(limits, state, input, now_ns, since_ns, acknowledged)
        }
        Phase::Armed => pass(limits, state, input, now_ns),
    }
}

/// The state after the order. An emergency stop outranks and outlasts everything but its release.
fn obey(limits: &Limits, state: State, input: &Input, now_ns: u64) -> State {
    match input.order {
        Order::EmergencyStop => state.go(Phase::Blocked(Reason::EmergencyStop)),
        Order::Release if state.emergency() => state.go(Phase::Disarmed),
        _ if state.emergency() => state,
        Order::Disarm => state.go(Phase::Disarmed),
        Order::Arm if matches!(state.phase(), Phase::Disarmed | Phase::Blocked(_)) => {
            match hazard::before_arming(limits, &state, input, now_ns) {
                Some(_) => state,
                None => state.go(Phase::Handshake { since_ns: now_ns, acknowledged: 0 }),
            }
        }
        Order::None | Order::Arm | Order::Release => state,
    }
}

/// Nothing leaves, for `reason`; but one who asked to arm learns what stands against it.
fn stay(
    limits: &Limits,
    state: State,
    input: &Input,
    now_ns: u64,
    reason: Reason,
) -> (State, Verdict) {
    let why = match input.order {
        Order::Arm if !state.emergency() => hazard::before_arming(limits, &state, input, now_ns),
        _ => None,
    };
    (State { last_ns: now_ns, ..state }, Verdict::Block(why.unwrap_or(reason)))
}

fn shake_hands(
    limits: &Limits,
    state: State,
    input: &Input,
    now_ns: u64,
    since_ns: u64,
    acknowledged: u32,
) -> (State, Verdict) {
    if let Some(reason) = hazard::before_arming(limits, &state, input, now_ns) {
        return block(state, reason, now_ns);
    }
    let steady = state.steadiness.has_all(limits.steady_ns, now_ns);
    if now_ns.saturating_sub(since_ns) > limits.handshake_max_ns {
        let leaping = (!steady).then_some(Reason::MeasurementLeaps);
        let unready = hazard::unready(input).or(leaping).unwrap_or(Reason::HandshakeTimeout);
        return block(state, unready, now_ns);
    }
    let in_step = hazard::both_in_step(limits, input);
    let acknowledged = if in_step { acknowledged.saturating_add(1) } else { 0 };
    if in_step && steady && acknowledged >= limits.handshake_steps {
        let armed = State {
            last: standing(input),
            last_ns: now_ns,
            braking_since_ns: None,
            acknowledged_ns: now_ns,
            plausible_ns: now_ns,
            ..state.go(Phase::Armed)
        };
        return pass(limits, armed, input, now_ns);
    }
    let state = state.go(Phase::Handshake { since_ns, acknowledged });
    (State { last_ns: now_ns, ..state }, Verdict::Block(Reason::Handshake))
}

/// The command that changes nothing: rates start from it, so arming is bumpless.
const fn standing(input: &Input) -> Command {
    Command {
        throttle: 0.0,
        front_angle_rad: input.measured.front_angle_rad,
        arms: Arms::Off,
        brake: input.is_braked,
    }
}

fn pass(limits: &Limits, state: State, input: &Input, now_ns: u64) -> (State, Verdict) {
    let acknowledged_ns =
        if hazard::both_in_step(limits, input) { now_ns } else { state.acknowledged_ns };
    let plausible_ns =
        if input.measured.is_plausible(limits) { now_ns } else { state.plausible_ns };
    let state = State { acknowledged_ns, plausible_ns, ..state };
    if let Some(reason) = hazard::while_armed(limits, &state, input, now_ns) {
        return block(state, reason, now_ns);
    }
    let Some(request) = input.request else {
        // The hazards above include this; the kernel still must not depend on their order.
        return block(state, Reason::Stale(crate::Stream::Policy), now_ns);
    };
    let dt_ns = now_ns.saturating_sub(state.last_ns).min(limits.step_max_ns);
    #[allow(clippy::cast_precision_loss)] // a few milliseconds
    let dt_s = dt_ns as f64 * 1e-9;
    let braking_since_ns = request.brake.then(|| state.braking_since_ns.unwrap_or(now_ns));
    let state = State { last_ns: now_ns, braking_since_ns, ..state };
    let (command, clamps) = limit::hold(limits, &request, &state, &input.measured, dt_s);
    let state = State { last: command, ..state };
    let verdict =
        if clamps.any() { Verdict::Clamp(command, clamps) } else { Verdict::Allow(command) };
    (state, verdict)
}

fn block(state: State, reason: Reason, now_ns: u64) -> (State, Verdict) {
    (State { last_ns: now_ns, ..state.go(Phase::Blocked(reason)) }, Verdict::Block(reason))
}
