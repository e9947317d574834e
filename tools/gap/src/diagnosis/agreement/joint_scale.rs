//! Whether the joints' angles are on the scale of what their valves and the command make of them, and of the same
//! sign: a wrong factor in a DBC makes a machine that is steered by nobody.

mod commanded;

use core::fmt;

use xt28_machine::Machine;

use super::COMPARED_EVERY;
use super::along::Along;
use crate::diagnosis::signals::{DT_S, Samples, Signals};
use commanded::commanded_rad;

/// The two joints by their names.
const JOINTS: [&str; 2] = ["front", "rear"];
/// Time over which an angle's change is held against what its valve let in, s.
const SPAN_S: f64 = 2.0;
/// Root mean square of what is told of a joint or of what it reads, whichever is more, that is too little to tell
/// a scale by, rad: 0.3 deg ...
const TURNS_RAD: f64 = 0.005;
/// ... and of the lesser of the two, which another unit makes sixty times smaller.
const TOLD_RAD: f64 = 1.0e-4;
/// How many times more or less than both say an angle may read: valves that let in a third or a tenth, a controller
/// of another machine, not another unit.
const TIMES_MAX: f64 = 6.0;

/// A joint that does not turn as it is steered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OddJoint {
    /// Its name.
    pub joint: &'static str,
    /// How many times what the command asks its angle reads; less than zero where it turns the other way.
    pub over_command: f64,
    /// The same of what its valve lets in.
    pub over_valve: f64,
    /// What both together say is odd.
    pub odd: Odd,
}

/// Which of three that should agree does not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Odd {
    /// The angle read: neither valve nor command bears it out.
    Angle,
    /// The command: angle and valve agree.
    Command,
    /// The valve's currents: angle and command agree.
    Valve,
}

/// Joints that do not turn as they are steered, though all that tells of it goes along.
#[derive(Clone, Debug, PartialEq)]
pub struct JointScale {
    /// Each of them.
    pub joints: Vec<OddJoint>,
}

/// The joints of all `runs` whose angles, valves or command are of another sign or unit than the other two. A valve
/// says it whatever the controller does, and the command whatever the valve does; where only one of the two says so,
/// a joint that turns too little or too slowly is left to the diagnosis, as machines can have that.
pub(super) fn joint_scale(runs: &[Signals], machine: &Machine) -> Option<JointScale> {
    let commanded: Vec<[Samples; 2]> = runs.iter().map(|s| commanded_rad(s, machine)).collect();
    let odd = |(k, joint): (usize, &'static str)| {
        let asked = runs.iter().zip(&commanded).flat_map(|(s, all)| beside(s, &all[k], k));
        let over_command = times(asked)?;
        let over_valve = times(runs.iter().flat_map(|s| turned_rad(s, machine, k)))?;
        let odd = odd(over_command, over_valve)?;
        // A rear joint that its valve turns against the front one is steered so.
        let is_told = odd != Odd::Command || k == 0;
        is_told.then_some(OddJoint { joint, over_command, over_valve, odd })
    };
    let joints: Vec<_> = JOINTS.into_iter().enumerate().filter_map(odd).collect();
    (!joints.is_empty()).then_some(JointScale { joints })
}

/// What is odd of a joint that reads so many times what the command asks and its valve lets in.
fn odd(over_command: f64, over_valve: f64) -> Option<Odd> {
    let both = [over_command, over_valve];
    if both.iter().all(|times| *times < 1.0 / TIMES_MAX)
        || both.iter().all(|times| *times > TIMES_MAX)
    {
        return Some(Odd::Angle);
    }
    match both.map(|times| times < 0.0) {
        [true, false] => Some(Odd::Command),
        [false, true] => Some(Odd::Valve),
        _ => (over_command > TIMES_MAX).then_some(Odd::Command),
    }
}

/// What is commanded of a joint and what it reads, rad, a few times a second.
fn beside<'a>(
    s: &'a Signals,
    commanded_rad: &'a Samples,
    joint: usize,
) -> impl Iterator<Item = [f64; 2]> + 'a {
    (0..s.len).step_by(COMPARED_EVERY).map(move |i| [commanded_rad[i], s.joint_rad[joint][i]])
}

/// What the valve of a joint lets in over some seconds and by how much it turns meanwhile, rad, each less its mean
/// over the run: a joint that creeps to one side is held by its valve.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
fn turned_rad(s: &Signals, machine: &Machine, joint: usize) -> Vec<[f64; 2]> {
    let rate_rad_s = machine.articulation.rate_max_deg_s.to_radians();
    let span = (SPAN_S / DT_S) as usize;
    let (openings, angle_rad) = (&s.steer_opening[joint], &s.joint_rad[joint]);
    let pair = |i: usize| {
        let opened_s = openings[i - span..i].iter().sum::<f64>() * DT_S;
        [rate_rad_s * opened_s, angle_rad[i] - angle_rad[i - span]]
    };
    let all: Vec<[f64; 2]> = (span..s.len).step_by(COMPARED_EVERY).map(pair).collect();
    let mean = |k: usize| all.iter().map(|pair| pair[k]).sum::<f64>() / all.len().max(1) as f64;
    let means = [mean(0), mean(1)];
    all.iter().map(|pair| [pair[0] - means[0], pair[1] - means[1]]).collect()
}

/// How many times what should be an angle one is; nothing where little turns or another thing is read.
fn times(pairs: impl Iterator<Item = [f64; 2]>) -> Option<f64> {
    let along = Along::of(pairs);
    let [told_rad, read_rad] = along.means();
    let turns = told_rad.max(read_rad) > TURNS_RAD && told_rad.min(read_rad) > TOLD_RAD;
    along.times().filter(|_| turns)
}

impl fmt::Display for JointScale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, OddJoint { joint, over_command, over_valve, odd }) in self.joints.iter().enumerate()
        {
            let between = if i > 0 { "; " } else { "" };
            write!(
                f,
                "{between}the {joint} joint angle reads {over_command:.2} times what is commanded and \
                 {over_valve:.2} times what its valve lets in: check "
            )?;
            match odd {
                Odd::Angle => write!(f, "unit, factor and sign of joint.{joint}")?,
                Odd::Command => write!(f, "unit, factor and sign of target.front_joint")?,
                Odd::Valve => write!(
                    f,
                    "whether steer_current.{joint}_A and steer_current.{joint}_B are each other's"
                )?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Channel, Series, Terrain};

    /// A machine that drives at 0.75 m/s for 30 s and is steered left and right, whose joints turn as the command
    /// says, on valves that let in what they turn by; then what is read is as `said`.
    fn steered(said: impl Fn(&mut Signals)) -> [Signals; 1] {
        let series = |value: &dyn Fn(f64) -> f64| -> Series {
            (0..3000).map(|i| f64::from(i) * 0.01).map(|at_s| (at_s, value(at_s))).collect()
        };
        let reads = |channel: Channel| match channel {
            Channel::WheelSpeed(_) => series(&|_| 0.75 / 0.74),
            Channel::TargetJoint => series(&|at_s| if at_s % 16.0 < 8.0 { 0.15 } else { -0.15 }),
            _ => series(&|_| 0.0),
        };
        let all = Channel::all().into_iter().map(|channel| (channel, reads(channel)));
        let mut s = Signals::of_series("made up", &all.collect(), 30.0, Terrain::Flat).unwrap();
        let machine = Machine::xt28();
        s.joint_rad = commanded_rad(&s, &machine);
        let rate_rad_s = machine.articulation.rate_max_deg_s.to_radians();
        for k in 0..2 {
            for i in 1..s.len {
                let turned_rad = s.joint_rad[k][i] - s.joint_rad[k][i - 1];
                s.steer_opening[k][i - 1] = turned_rad / DT_S / rate_rad_s;
            }
        }
        said(&mut s);
        [s]
    }

    fn scale(samples: &mut Samples, factor: f64) {
        samples.iter_mut().for_each(|value| *value *= factor);
    }

    fn told(said: impl Fn(&mut Signals)) -> Vec<(&'static str, Odd)> {
        let found = joint_scale(&steered(said), &Machine::xt28());
        found.map_or_else(Vec::new, |all| {
            all.joints.iter().map(|one| (one.joint, one.odd)).collect()
        })
    }

    #[test]
    fn an_angle_of_another_sign_or_unit_is_told_by_its_joint() {
        for factor in [-1.0, 10.0, 0.1, 1.0_f64.to_radians(), -1.0_f64.to_degrees()] {
            for (k, joint) in JOINTS.into_iter().enumerate() {
                let one = told(|s| scale(&mut s.joint_rad[k], factor));
                assert_eq!(one, [(joint, Odd::Angle)], "{factor}");
            }
            let both = told(|s| s.joint_rad.iter_mut().for_each(|angle| scale(angle, factor)));
            assert_eq!(both, JOINTS.map(|joint| (joint, Odd::Angle)), "{factor}");
        }
    }

    #[test]
    fn a_command_or_a_valve_that_the_other_two_deny_is_told_as_that() {
        for factor in [-1.0, 1.0_f64.to_radians()] {
            let command = told(|s| scale(&mut s.target_joint_rad, factor));
            assert_eq!(command, [("front", Odd::Command)], "{factor}");
        }
        for (k, joint) in JOINTS.into_iter().enumerate() {
            let valve = told(|s| scale(&mut s.steer_opening[k], -1.0));
            assert_eq!(valve, [(joint, Odd::Valve)]);
        }
    }

    #[test]
    fn what_is_odd_is_told_with_the_channels_to_mend() {
        let text = |said: &dyn Fn(&mut Signals)| {
            joint_scale(&steered(said), &Machine::xt28()).unwrap().to_string()
        };
        let angle = text(&|s| scale(&mut s.joint_rad[0], -1.0));
        assert!(
            angle.starts_with("the front joint angle reads -1.00 times what is commanded"),
            "{angle}"
        );
        assert!(angle.ends_with("check unit, factor and sign of joint.front"), "{angle}");
        let valve = text(&|s| scale(&mut s.steer_opening[1], -1.0));
        assert!(valve.contains("steer_current.rear_A and steer_current.rear_B"), "{valve}");
    }

    /// Valves of another size, a joint that does not move, that creeps or moves as it likes.
    #[test]
    fn what_a_joint_can_do_is_not_complained_of() {
        for factor in [0.2, 0.5, 1.0, 2.0, 5.0] {
            assert_eq!(told(|s| scale(&mut s.steer_opening[0], factor)), [], "{factor}");
        }
        assert_eq!(told(|s| s.joint_rad[0].fill(0.1)), [], "it stands");
        let creeps = |s: &mut Signals| s.steer_opening[0].iter_mut().for_each(|open| *open += 0.2);
        assert_eq!(told(creeps), []);
        let wanders = |s: &mut Signals| {
            let other = |i: usize| 0.1 * (f64::from(u32::try_from(i).unwrap()) * 0.004).cos();
            s.joint_rad[1] = (0..s.len).map(other).collect();
        };
        assert_eq!(told(wanders), []);
    }
}
