//! The two steering valves: the joystick's rate control, and who steers what (facts 4.6).

use super::follower::Follower;
use super::sequence::DriveState;
use super::steering_valve::{FULL_MA, REAR_MA, REST_MA, written};
use crate::firmware_2016::Quirks;

/// Between these the mini-joystick is at rest; its ends, mV.
const REST_MV: [i32; 2] = [2284, 2684];
const ENDS_MV: [i32; 2] = [466, 4230];
const FULL: i32 = 1000;

/// Which joints steer, as the display's byte has it (facts 2.5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum TurnMode {
    #[default]
    Front = 1,
    Rear = 4,
    Combined = 16,
    Follow = 64,
}

/// Turn mode and follower.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steering {
    quirks: Quirks,
    mode: TurnMode,
    /// The button logic has seen a press; until then it believes in combined steering.
    pressed: bool,
    follower: Follower,
}

/// What steering depends on.
#[derive(Clone, Copy, Debug)]
pub(super) struct SteerInputs {
    /// -1000 to 1000, left < 0.
    pub(super) joystick: i32,
    /// Front and rear joint, 0.01 deg, left > 0.
    pub(super) joint: [i32; 2],
    /// Mean wheel speed, counts.
    pub(super) mean_count: i32,
    pub(super) state: DriveState,
}

impl Steering {
    pub(super) fn new(quirks: Quirks) -> Self {
        Self { quirks, mode: TurnMode::Front, pressed: false, follower: Follower::default() }
    }

    /// Buttons 13 front, 14 rear, 15 combined and, from there, following.
    pub(super) const fn press(&mut self, button: u8) {
        let believes_combined = !self.pressed && self.quirks.first_turn_press_skips_combined;
        self.mode = match button {
            13 => TurnMode::Front,
            14 => TurnMode::Rear,
            _ if believes_combined || matches!(self.mode, TurnMode::Combined) => TurnMode::Follow,
            _ => TurnMode::Combined,
        };
        self.pressed = true;
    }

    /// Which joints steer.
    pub(super) const fn mode(&self) -> TurnMode {
        self.mode
    }

    /// The follower's integral starts anew when the direction of travel turns.
    pub(super) const fn direction_turned(&mut self) {
        self.follower.forget();
    }

    /// Currents `[A, B]` of front and rear, mA.
    pub(super) fn step(&mut self, i: &SteerInputs) -> [[i32; 2]; 2] {
        let (alone, none) = (rate_ma(i.joystick, FULL_MA), [0; 2]);
        match self.mode {
            TurnMode::Front => [alone, none],
            TurnMode::Rear => [none, alone],
            TurnMode::Combined => [alone, rate_ma(i.joystick, REAR_MA)],
            TurnMode::Follow => {
                let error = i.joint[0] - i.joint[1];
                let follows = self.follower.step(error, i.mean_count, self.quirks);
                if i.state == DriveState::Reverse {
                    // The front one follows: its angle must fall for the error to.
                    let [a, b] = follows;
                    [[b, a], alone]
                } else {
                    [alone, follows]
                }
            }
        }
    }
}

/// Joystick -1000 (left) to 1000 from its voltage; an input that never spoke is at rest. Turned
/// round for a chair to the back.
pub(super) fn joystick(mv: i32, chair_front: bool) -> i32 {
    let [low, high] = REST_MV;
    let j = if mv == 0 || (low..=high).contains(&mv) {
        0
    } else if mv > high {
        ((mv - high) * FULL / (ENDS_MV[1] - high)).min(FULL)
    } else {
        ((mv - low) * FULL / (low - ENDS_MV[0])).max(-FULL)
    };
    if chair_front { j } else { -j }
}

/// Currents `[A, B]`, mA, for a joystick that gives `full_ma` at its end: left by A.
fn rate_ma(joystick: i32, full_ma: i32) -> [i32; 2] {
    written(joystick.abs() * (full_ma - REST_MA) / FULL, joystick < 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_joystick_has_its_rest_its_ends_and_its_chair() {
        let ends =
            [(0, 0), (2284, 0), (2684, 0), (4230, 1000), (466, -1000), (5000, 1000), (1, -1000)];
        for (mv, j) in ends {
            assert_eq!(joystick(mv, true), j, "{mv} mV");
            assert_eq!(joystick(mv, false), -j);
        }
        assert_eq!(joystick(2684 + 773, true), 500);
    }

    #[test]
    fn currents_are_the_published_ones() {
        assert_eq!(rate_ma(-1000, FULL_MA), [730, 0]);
        assert_eq!(rate_ma(1000, REAR_MA), [0, 500]);
        assert_eq!([rate_ma(3, FULL_MA), rate_ma(4, FULL_MA)], [[0, 0], [0, 416]]);
    }

    #[test]
    fn the_first_press_of_15_follows_at_once() {
        let modes = |quirks, buttons: &[u8]| -> Vec<TurnMode> {
            let mut steering = Steering::new(quirks);
            buttons
                .iter()
                .map(|b| {
                    steering.press(*b);
                    steering.mode()
                })
                .collect()
        };
        use TurnMode::{Combined, Follow, Front, Rear};
        assert_eq!(modes(Quirks::firmware(), &[15, 15, 15]), [Follow, Combined, Follow]);
        assert_eq!(modes(Quirks::none(), &[15, 15, 15]), [Combined, Follow, Combined]);
        assert_eq!(modes(Quirks::firmware(), &[13, 15, 14, 15]), [Front, Combined, Rear, Combined]);
    }
}
