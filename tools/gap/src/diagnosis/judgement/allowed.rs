//! What a right answer may leave of each signal: a floor, and a share of the gap that was there; and how
//! much of that may be what it explains, moved in time.

use super::super::evidence::{Echo, Left, Uneven};
use super::super::floor::Signal;
use super::super::generator::Generator;
use super::super::vague_laws::{controls, vagueness};

/// Share of a gap that a right cause may leave: laws of one name differ from make to make in their
/// details.
const LAW: f64 = 0.03;
/// What sound machines leave in roll, in floors, and the share of a gap in it: one make half of one,
/// another up to 1.4, by which wheels carry.
const ROLL: [f64; 2] = [1.3, 0.15];
/// The same of how roll and pitch change within seconds: machines that turn on a slope differ in when their filters
/// learn of it.
const SWAY: [f64; 2] = [1.0, 0.15];
/// The same of the course over ground, which a receiver tells the worse the slower the machine is.
const COURSE: [f64; 2] = [1.3, LAW];
/// Signals with fewer independent samples say nothing of what is left.
const SAMPLES_MIN: f64 = 8.0;

/// How large a bump may be at its peak that comes a third time, in floors of the signal: wheels that lift jolt
/// a machine again and again. Right answers leave up to 3.2 of what has many samples, 4.0 of the weight.
const RECURRING: f64 = 4.0;

/// An echo that chance makes on a signal, nats: the seven taps of the filter, and what correlates.
const ECHO: f64 = 8.0;
/// The share of a gap that an echo may have on what a joint does within a second: models of one joint
/// differ there by as much as most effects do.
const JOINT_ECHO: f64 = 0.5;

/// What chance and what correlates make of two sizes on a signal, nats.
const UNEVEN: f64 = 8.0;

/// What `after` leaves, by what a right answer, which is one of `names` or both, may leave where `before`
/// was there or, if that is more, squares of `explained` floors on average; about one at most if it is
/// right.
pub(super) fn excess(names: &[&str], [before, after]: [&Left; 2], explained: f64) -> f64 {
    if after.samples < SAMPLES_MIN {
        return 0.0;
    }
    let [floor, share] = floor_and_share_of(names, before, explained);
    // A wheel that lifts jolts arms and attitude; nothing jolts the pressure that a law asks for, and
    // what is late shows there for moments alone.
    let jolts = after.signal != Signal::DrivePressure;
    let left = if jolts { after.steady } else { after.square };
    left.sqrt() / (floor + share * before.square.max(explained).sqrt())
}

/// How large the bump of `after` that comes a third time is beside the largest that a right answer, which is
/// one of `names` or both, leaves where `before` was there and squares of `explained` floors on average are explained.
pub(super) fn recurring(names: &[&str], [before, after]: [&Left; 2], explained: f64) -> f64 {
    // A controller that took another of a bunch of commands is off by as much as the target had moved, and is
    // again with the next bunch: no bump is too large for that, and none comes too often.
    let bunches = names.contains(&"command-jitter");
    if after.samples < SAMPLES_MIN || bunches && answers_commands(after) {
        return 0.0;
    }
    let [floor, share] = floor_and_share_of(names, before, explained);
    after.recurring / (RECURRING * floor + share * before.recurring)
}

/// [`floor_and_share`] of a gap of which squares of `explained` floors on average are explained: a law that explains
/// little of a gap leaves the rest of it to something else, however vague it is.
fn floor_and_share_of(names: &[&str], before: &Left, explained: f64) -> [f64; 2] {
    let [floor, share] = floor_and_share(names, before.generator, before.signal);
    let of_gap = (explained / before.square.max(f64::MIN_POSITIVE)).sqrt();
    let [_, of_any] = floor_and_share(&[], before.generator, before.signal);
    [floor, share.min(of_gap).max(of_any)]
}

/// What a right answer, which is one of `names` or both, may leave of `signal`: floors, and a share of the gap.
fn floor_and_share(names: &[&str], generator: Generator, signal: Signal) -> [f64; 2] {
    let [floor, law] = match signal {
        Signal::Roll => ROLL,
        Signal::RollSway | Signal::PitchSway => SWAY,
        Signal::TravelCourse => COURSE,
        _ => [1.0, LAW],
    };
    [floor, vagueness(names, generator, signal).max(law)]
}

/// How loud `echo` is beside the loudest that a right answer, which is one of `names` or both, has there.
pub(super) fn echoing(names: &[&str], echo: &Echo) -> f64 {
    let law = if echo.signal == Signal::JointFast { JOINT_ECHO } else { LAW };
    let share = vagueness(names, echo.generator, echo.signal).max(law);
    (echo.nats / (ECHO + share * share * echo.explained)).sqrt()
}

/// How far the sizes of `uneven` part beside the furthest that those of a right answer, which is one of `names` or
/// both, part there. Two sizes of what has an `evidence` of next to nothing, nats, are as little.
pub(super) fn parting(names: &[&str], uneven: &Uneven, evidence: f64) -> f64 {
    let [_, share] = floor_and_share(names, uneven.generator, uneven.signal);
    let share = if uneven.signal == Signal::JointFast { share.max(JOINT_ECHO) } else { share };
    (uneven.nats().min(evidence) / (UNEVEN + share * share * uneven.explained())).sqrt()
}

/// Whether the signal is what a controller makes of a command within a tick.
fn answers_commands(left: &Left) -> bool {
    controls(left.generator, left.signal) || left.signal == Signal::DrivePressure
}

#[cfg(test)]
mod tests {
    use xt28_machine::Wheel;

    use super::*;

    fn left(generator: Generator, signal: Signal, floors: f64, steady: f64) -> Left {
        let [square, steady] = [floors, steady].map(|floors| floors * floors);
        Left { steady, ..Left::evenly(generator, signal, square, 100.0) }
    }

    #[test]
    fn a_vague_law_may_leave_more_where_it_is_vague() {
        let of = |name: &str, signal: Signal| {
            let at = |floors| left(Generator::Stance, signal, floors, floors);
            excess(&[name], [&at(10.0), &at(4.0)], 49.0)
        };
        assert!(of("payload", Signal::Weight) > 2.0);
        assert!(of("seal-stiction", Signal::Weight) < 1.0);
        assert!(of("rolling-resistance", Signal::Weight) < 1.0);
        assert!(of("rolling-resistance", Signal::Pitch) > 2.0);
    }

    #[test]
    fn a_vague_law_that_explains_more_than_there_is_may_leave_its_share_of_that() {
        let at = |floors| left(Generator::Stance, Signal::WeightX, floors, floors);
        let of = |name, explained| excess(&[name], [&at(1.6), &at(2.6)], explained);
        assert!(of("rolling-resistance", 4.3_f64.powi(2)) < 1.1);
        assert!(of("rolling-resistance", 0.0) > 1.5);
        assert!(of("payload", 4.3_f64.powi(2)) > 1.5);
    }

    #[test]
    fn a_vague_law_leaves_no_more_of_a_gap_than_it_explains() {
        let stroke = |floors, recurring| {
            let of = left(Generator::ArmStroke(Wheel::Fr), Signal::Stroke, floors, floors);
            Left { recurring, ..of }
        };
        let (before, after) = (stroke(21.6, 62.0), stroke(20.0, 50.0));
        for (explained, is_excused) in [(0.0, false), (8.0, false), (20.0, true)] {
            let square = f64::powi(explained, 2);
            let names = ["stroke-bias", "standstill-drag"];
            let times = excess(&names, [&before, &after], square);
            assert_eq!(times < 1.5, is_excused, "{explained} explained: {times}");
            let times = recurring(&names, [&before, &after], square);
            assert_eq!(times < 1.5, is_excused, "{explained} explained: {times}");
        }
    }

    #[test]
    fn jolts_are_overlooked_where_there_can_be_jolts() {
        let of = |generator, signal| {
            let before = left(generator, signal, 10.0, 10.0);
            excess(&["throttle-delay"], [&before, &left(generator, signal, 4.0, 0.5)], 0.0)
        };
        assert!(of(Generator::ArmStroke(Wheel::Fr), Signal::Stroke) < 0.5);
        assert!(of(Generator::Drive, Signal::DrivePressure) > 2.0);
    }

    #[test]
    fn a_bump_that_comes_again_and_again_is_no_jolt() {
        let of = |name: &str, was, is| {
            let at = |recurring| {
                let evenly = left(Generator::ArmStroke(Wheel::Ml), Signal::Stroke, 20.0, 0.5);
                Left { recurring, ..evenly }
            };
            recurring(&[name], [&at(was), &at(is)], 400.0)
        };
        assert!(of("valve-lag", 3.0, 3.0) < 1.0);
        assert!(of("valve-lag", 70.0, 28.0) > 2.0);
        assert!(of("valve-lag", 2800.0, 28.0) < 1.0);
        assert!(of("seal-stiction", 70.0, 28.0) < 1.0);
    }

    #[test]
    fn commands_that_come_in_bunches_leave_bumps_where_a_controller_answers_them() {
        let of = |name, generator, signal| {
            let at = |recurring| Left { recurring, ..left(generator, signal, 20.0, 0.5) };
            recurring(&[name], [&at(40.0), &at(40.0)], 100.0)
        };
        let arm = (Generator::ArmEcu(Wheel::Fr), Signal::ArmOpening);
        let drive = (Generator::Drive, Signal::DrivePressure);
        for (generator, signal) in [arm, drive] {
            assert!(of("command-jitter", generator, signal) < 1.0);
            assert!(of("throttle-delay", generator, signal) > 2.0);
        }
        assert!(of("command-jitter", Generator::ArmStroke(Wheel::Fr), Signal::Stroke) > 2.0);
    }

    #[test]
    fn an_echo_is_none_where_a_law_is_vague_or_chance_makes_as_much() {
        let of = |name: &str, signal, nats| {
            let generator = Generator::ArmStroke(Wheel::Fr);
            echoing(&[name], &Echo { generator, signal, nats, explained: 4000.0, samples: 150.0 })
        };
        assert!(of("valve-lag", Signal::Stroke, 100.0) > 2.0);
        assert!(of("valve-lag", Signal::Stroke, 5.0) < 1.0);
        assert!(of("accumulator-gas", Signal::Stroke, 100.0) < 1.0);
        assert!(of("steer-lag", Signal::JointFast, 100.0) < 1.0);
    }

    #[test]
    fn few_samples_say_nothing() {
        let few = Left { samples: 7.0, ..left(Generator::Drive, Signal::DriveForce, 50.0, 50.0) };
        assert!(excess(&[], [&few, &few], 0.0).abs() < f64::EPSILON);
    }
}
