//! What a network may see: the terms that a policy file names, how wide each is, and where it is read.

use serde::Deserialize;

use crate::{Action, Observation, Pose};

/// One thing that is seen, SI, wheels in the order FR FL MR ML BR BL. `docs/policy-files.md` has the list for who
/// trains a network.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Term {
    /// Metres ahead and metres to the left of the front axle.
    GoalM,
    /// From the machine's heading to the goal's, -π to π, left > 0.
    GoalHeadingRad,
    /// Of the antenna: ahead, to the left, up.
    VelocityMS,
    /// Mean of the wheels at their nominal radius, forward > 0.
    SpeedMS,
    /// Right side high > 0.
    RollRad,
    /// Nose up > 0.
    PitchRad,
    /// Six cylinders.
    StrokeM,
    /// Six cylinders, weight > 0.
    LoadN,
    /// Six wheels, forward > 0.
    WheelSpeedRadS,
    /// Left > 0.
    FrontJointRad,
    /// Left > 0.
    RearJointRad,
    /// What was asked for last, eight numbers.
    PreviousAction,
    /// 600 heights over the ground under the front axle, in the order of [`xt28_terrain::LocalMap`].
    HeightMapM,
}

/// What there is to see at one instant.
pub(super) struct View<'a> {
    pub(super) seen: &'a Observation,
    pub(super) goal: Option<Pose>,
    /// The local height map; empty where nobody looks at it.
    pub(super) heights_m: &'a [f32],
    /// What was asked for last; nothing as a drive begins.
    pub(super) previous_action: Action,
}

impl Term {
    /// How many numbers it has.
    pub(super) const fn width(self) -> usize {
        match self {
            Self::GoalHeadingRad
            | Self::SpeedMS
            | Self::RollRad
            | Self::PitchRad
            | Self::FrontJointRad
            | Self::RearJointRad => 1,
            Self::GoalM => 2,
            Self::VelocityMS => 3,
            Self::StrokeM | Self::LoadN | Self::WheelSpeedRadS => 6,
            Self::PreviousAction => 8,
            Self::HeightMapM => 600,
        }
    }

    /// Whether it is of a goal.
    pub(super) const fn needs_goal(self) -> bool {
        matches!(self, Self::GoalM | Self::GoalHeadingRad)
    }

    /// Whether it is known only where the machine is.
    pub(super) const fn needs_fix(self) -> bool {
        matches!(self, Self::GoalM | Self::GoalHeadingRad | Self::VelocityMS | Self::HeightMapM)
    }

    /// Calls `each` with every number of it, in order; `None` where it is not known now, as where the machine is before
    /// its first fix.
    pub(super) fn read(self, view: &View<'_>, each: &mut impl FnMut(f64)) -> Option<()> {
        let View { seen, goal, heights_m, previous_action } = view;
        let to_goal = || Some(seen.located.as_ref()?.pose.to_local(goal.as_ref()?));
        match self {
            Self::GoalM => to_goal()?[..2].iter().for_each(|metres| each(*metres)),
            Self::GoalHeadingRad => each(to_goal()?[2]),
            Self::VelocityMS => velocity_m_s(seen)?.into_iter().for_each(each),
            Self::SpeedMS => each(seen.wheel_speed_m_s),
            Self::RollRad => each(seen.attitude.roll_rad),
            Self::PitchRad => each(seen.attitude.pitch_rad),
            Self::StrokeM => seen.stroke_m.0.into_iter().for_each(each),
            Self::LoadN => seen.load_n.0.into_iter().for_each(each),
            Self::WheelSpeedRadS => seen.wheel_speed_rad_s.0.into_iter().for_each(each),
            Self::FrontJointRad => each(seen.front_joint_rad),
            Self::RearJointRad => each(seen.rear_joint_rad),
            Self::PreviousAction => previous_action.0.into_iter().for_each(each),
            Self::HeightMapM if heights_m.len() != self.width() => return None,
            Self::HeightMapM => heights_m.iter().for_each(|height| each(f64::from(*height))),
        }
        Some(())
    }
}

/// The antenna's velocity as the machine heads: ahead, to the left, up, m/s.
fn velocity_m_s(seen: &Observation) -> Option<[f64; 3]> {
    let located = seen.located.as_ref()?;
    let [east, north, up] = located.velocity_m_s;
    let (sin, cos) = libm::sincos(located.pose.heading_rad);
    Some([cos * east + sin * north, cos * north - sin * east, up])
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use xt28_terrain::LocalMap;

    use super::super::made_up::{ALL, seen};
    use super::*;
    use crate::Located;

    fn numbers(term: Term, view: &View<'_>) -> Option<Vec<f64>> {
        let mut numbers = Vec::new();
        term.read(view, &mut |number| numbers.push(number)).map(|()| numbers)
    }

    #[test]
    fn every_term_is_as_wide_as_it_says_and_stands_in_the_documentation() {
        let heights_m = vec![0.5; LocalMap::default().len()];
        let goal = Some(Pose::default());
        let (seen, page) = (seen(), include_str!("../../../../docs/policy-files.md"));
        let view =
            View { seen: &seen, goal, heights_m: &heights_m, previous_action: Action::default() };
        for name in ALL {
            let term: Term = serde_json::from_value(name.into()).unwrap();
            assert_eq!(numbers(term, &view).unwrap().len(), term.width(), "{name}");
            assert!(page.contains(&format!("| `{name}` | {} |", term.width())), "{name}");
        }
    }

    #[test]
    fn a_goal_and_a_velocity_are_seen_as_the_machine_heads() {
        let pose = Pose { east_m: 1.0, north_m: 2.0, heading_rad: FRAC_PI_2 };
        let velocity_m_s = [-0.1, 0.8, 0.02];
        let mut seen = seen();
        seen.located = Some(Located { pose, velocity_m_s, ..Located::default() });
        let goal = Some(Pose { east_m: 0.5, north_m: 5.0, heading_rad: 0.0 });
        let view = View { seen: &seen, goal, heights_m: &[], previous_action: Action::default() };
        let near = |term, wanted: &[f64]| {
            let read = numbers(term, &view).unwrap();
            let pairs = read.iter().zip(wanted);
            assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-12), "{read:?} {wanted:?}");
        };
        near(Term::GoalM, &[3.0, 0.5]);
        near(Term::GoalHeadingRad, &[-FRAC_PI_2]);
        near(Term::VelocityMS, &[0.8, 0.1, 0.02]);
        assert_eq!(numbers(Term::HeightMapM, &view), None, "there is no map");
        seen.located = None;
        let view = View { seen: &seen, goal, heights_m: &[], previous_action: Action::default() };
        assert_eq!(numbers(Term::GoalM, &view), None, "there is no fix");
    }
}
