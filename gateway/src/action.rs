//! The action of the paper, eight numbers in -1..1, and what they mean at the machine.

use xt28_machine::{Machine, PerWheel};
use xt28_safety::{Arms, Command};

/// Throttle, front joint angle, six strokes (FR FL MR ML BR BL), each in -1..1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Action(pub [f64; 8]);

/// The ranges that -1..1 stands for.
///
/// | Component | -1 | +1 |
/// |---|---|---|
/// | 0, throttle | full reverse | full forward |
/// | 1, front joint | `angle_max_rad` right | `angle_max_rad` left |
/// | 2 to 7, strokes | 0 | `stroke_max_m` |
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActionMap {
    /// Front joint angle of 1, rad.
    pub angle_max_rad: f64,
    /// Stroke of 1, m: half the machine's range (paper 4).
    pub stroke_max_m: f64,
}

impl ActionMap {
    /// The ranges of a machine.
    #[must_use]
    pub const fn new(machine: &Machine) -> Self {
        Self {
            angle_max_rad: machine.articulation.angle_max_deg.to_radians(),
            stroke_max_m: machine.hydraulics.manual_stroke_max_m,
        }
    }

    /// The demand an action stands for. Values beyond -1..1 are passed on: the safety kernel limits.
    #[must_use]
    pub fn command(&self, action: &Action) -> Command {
        let [throttle, angle, strokes @ ..] = action.0;
        Command {
            throttle,
            front_angle_rad: angle * self.angle_max_rad,
            arms: Arms::Position(strokes.map(|a| Some((a + 1.0) / 2.0 * self.stroke_max_m))),
            brake: false,
        }
    }

    /// The action nearest to a demand, for the observation. Arms that are not under position
    /// control are told by `stroke_m`, where they are.
    #[must_use]
    pub fn action(&self, command: &Command, stroke_m: &PerWheel<f64>) -> Action {
        let mut action = [0.0; 8];
        action[0] = command.throttle;
        action[1] = command.front_angle_rad / self.angle_max_rad;
        for (wheel, is_m) in stroke_m.0.iter().enumerate() {
            let target_m = match command.arms {
                Arms::Position(targets) => targets[wheel].unwrap_or(*is_m),
                _ => *is_m,
            };
            action[2 + wheel] = target_m / self.stroke_max_m * 2.0 - 1.0;
        }
        Action(action)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_the_range_are_the_papers() {
        let map = ActionMap::new(&Machine::xt28());
        let command = map.command(&Action([1.0, -1.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0]));
        assert!((command.front_angle_rad + 25_f64.to_radians()).abs() < 1e-12);
        let Arms::Position(strokes) = command.arms else { panic!("position control") };
        assert_eq!(strokes[..3], [Some(0.0), Some(0.25), Some(0.125)]);
    }

    #[test]
    fn an_action_survives_being_a_command() {
        let map = ActionMap::new(&Machine::xt28());
        let action = Action([0.5, -0.3, -1.0, -0.5, 0.0, 0.25, 0.5, 1.0]);
        let back = map.action(&map.command(&action), &PerWheel::splat(0.0));
        for (a, b) in action.0.iter().zip(back.0) {
            assert!((a - b).abs() < 1e-12);
        }
    }
}
