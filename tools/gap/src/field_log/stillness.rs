//! Readings that stand perfectly still while what moves them says that they cannot have.
//!
//! A quantised reading stands still by right while its part does, for minutes on end. So it is held
//! against what moves that very part: an arm's stroke and a joint against their own valve, a wheel's
//! speed against the other wheels. Only what opened *and* closed again counts of a valve: a steady
//! opening may hold against a leak, or press an arm against its end.

use std::collections::BTreeMap;

use xt28_ecus::pins;
use xt28_machine::Wheel;

use crate::{Channel, FaultKind, Series, SteerSide};

/// What stood still for less may have been late, s (assumed).
const STANDS_S: f64 = 3.0;
/// Arms and joints follow their valves within this time at the latest, s: the longest delays are below.
const FOLLOWS_S: f64 = 1.0;
/// Opening below which a valve may pass nothing: a wide deadband (assumed).
const DEADBAND: f64 = 0.08;
/// Travel of an arm that its reading cannot miss, as time at full opening, s: about 8 mm. The largest
/// while a reading of a whole machine stood still, deadband and delay among them, is 0.
const ARM_TRAVEL_S: f64 = 0.04;
/// The same of a joint: some degrees.
const JOINT_TRAVEL_S: f64 = 0.2;
/// Change of the other wheels' speed that a wheel cannot miss, rad/s; of whole machines 0.07 at most.
const SPEED_CHANGE_RAD_S: f64 = 0.3;
/// A valve's current counts no longer than this after it came, s: frames may be lost.
const HOLDS_S: f64 = 0.1;

/// Readings as they are heard, each with the times in which it stood still.
#[derive(Default)]
pub(super) struct Stillness {
    now: BTreeMap<Channel, Stand>,
    long: BTreeMap<Channel, Vec<Stand>>,
}

/// A time in which a reading did not change.
#[derive(Clone, Copy)]
struct Stand {
    line: u64,
    value: f64,
    from_s: f64,
    to_s: f64,
}

impl Stand {
    fn seconds(&self) -> f64 {
        self.to_s - self.from_s
    }
}

impl Stillness {
    /// Notes what `channel` read at `at_s`, on this line.
    pub(super) fn note(&mut self, channel: Channel, line: u64, at_s: f64, value: f64) {
        if !matches!(
            channel,
            Channel::Stroke(_) | Channel::WheelSpeed(_) | Channel::FrontJoint | Channel::RearJoint
        ) {
            return;
        }
        let new = Stand { line, value, from_s: at_s, to_s: at_s };
        let now = self.now.entry(channel).or_insert(new);
        if now.value.to_bits() == value.to_bits() {
            now.to_s = at_s;
        } else {
            if now.seconds() >= STANDS_S {
                self.long.entry(channel).or_default().push(*now);
            }
            *now = new;
        }
    }

    /// Readings that stood still and cannot have, each with the line where it stopped and for the
    /// longest time it did; `all` is what the log says of everything.
    pub(super) fn faults(&self, all: &BTreeMap<Channel, Series>) -> Vec<(u64, FaultKind)> {
        let fault = |(&channel, now): (&Channel, &Stand)| {
            let stands = self.long.get(&channel).into_iter().flatten().chain([now]);
            let odd: Vec<(Stand, String)> = stands
                .filter(|stand| stand.seconds() >= STANDS_S)
                .filter_map(|stand| Some((*stand, meanwhile(channel, stand, all)?)))
                .collect();
            let times = odd.len() as u64;
            let longest =
                odd.into_iter().max_by(|(a, _), (b, _)| a.seconds().total_cmp(&b.seconds()));
            let (Stand { line, value, from_s, to_s }, meanwhile) = longest?;
            let (channel, unit) = (channel.to_string(), channel.dimension().si());
            let kind = FaultKind::Frozen { channel, value, unit, from_s, to_s, meanwhile, times };
            Some((line, kind))
        };
        self.now.iter().filter_map(fault).collect()
    }
}

/// What went on meanwhile that the reading cannot have missed; `None` where it may have stood.
fn meanwhile(channel: Channel, stand: &Stand, all: &BTreeMap<Channel, Series>) -> Option<String> {
    use Channel::{ExtendCurrent, RetractCurrent, SteerCurrent};
    let valve = |currents, opening, least_s| {
        let (travel_s, most) = travel(all, currents, opening, stand)?;
        let percent = 100.0 * most;
        (travel_s >= least_s)
            .then(|| format!("its valve opened and closed by up to {percent:.0} %"))
    };
    match channel {
        Channel::Stroke(w) => {
            valve([RetractCurrent(w), ExtendCurrent(w)], pins::valve_opening, ARM_TRAVEL_S)
        }
        Channel::FrontJoint => {
            let sides = [SteerSide::FrontA, SteerSide::FrontB].map(SteerCurrent);
            valve(sides, pins::steer_opening, JOINT_TRAVEL_S)
        }
        Channel::RearJoint => {
            let sides = [SteerSide::RearA, SteerSide::RearB].map(SteerCurrent);
            valve(sides, pins::steer_opening, JOINT_TRAVEL_S)
        }
        Channel::WheelSpeed(wheel) => {
            let change_rad_s = change_of_others(all, wheel, stand)?;
            (change_rad_s >= SPEED_CHANGE_RAD_S)
                .then(|| format!("the other wheels' speed changed by {change_rad_s:.2} rad/s"))
        }
        _ => None,
    }
}

/// How far a valve moved its part to and fro, as time at full opening in s, and its largest opening, as
/// `opening` has it of its two currents in mA. What opened late in the time may not have moved anything yet.
fn travel(
    all: &BTreeMap<Channel, Series>,
    [a, b]: [Channel; 2],
    opening: fn(f64, f64) -> f64,
    stand: &Stand,
) -> Option<(f64, f64)> {
    let (a, b) = (all.get(&a)?, all.get(&b)?);
    let during = |at_s: f64| (stand.from_s..stand.to_s - FOLLOWS_S).contains(&at_s);
    let beyond = |(at_s, a_a): (f64, f64)| {
        let opening = opening(a_a * 1e3, b.at(at_s)? * 1e3);
        Some((at_s, opening.signum() * (opening.abs() - DEADBAND).max(0.0), opening.abs()))
    };
    let openings: Vec<(f64, f64, f64)> =
        a.iter().filter(|(at_s, _)| during(*at_s)).filter_map(beyond).collect();
    let steps = || {
        let step = |pair: &[(f64, f64, f64)]| ((pair[1].0 - pair[0].0).min(HOLDS_S), pair[0].1);
        openings.windows(2).map(step)
    };
    let (seconds, sum) =
        steps().fold((0.0, 0.0), |(s, x), (dt_s, beyond)| (s + dt_s, x + dt_s * beyond));
    let mean = if seconds > 0.0 { sum / seconds } else { 0.0 };
    let (mut travelled, mut low, mut high) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (dt_s, beyond) in steps() {
        travelled += dt_s * (beyond - mean);
        (low, high) = (low.min(travelled), high.max(travelled));
    }
    let most = openings.iter().map(|(_, _, opening)| *opening).fold(0.0, f64::max);
    Some((high - low, most))
}

/// By how much the median speed of the wheels beside `wheel` changed, rad/s.
fn change_of_others(all: &BTreeMap<Channel, Series>, wheel: Wheel, stand: &Stand) -> Option<f64> {
    let others = Wheel::ALL.into_iter().filter(|other| *other != wheel);
    let others: Vec<&Series> =
        others.map(|other| all.get(&Channel::WheelSpeed(other))).collect::<Option<_>>()?;
    let instants = all.get(&Channel::WheelSpeed(wheel))?.iter().map(|(at_s, _)| at_s);
    let median = |at_s: f64| {
        let mut speeds: Vec<f64> =
            others.iter().map(|other| other.at(at_s)).collect::<Option<_>>()?;
        speeds.sort_by(f64::total_cmp);
        speeds.get(speeds.len() / 2).copied()
    };
    let [low, high] = instants
        .filter(|at_s| (stand.from_s..=stand.to_s).contains(at_s))
        .filter_map(median)
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
    Some(high - low)
}
