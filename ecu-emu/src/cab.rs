//! The cab of an emulated machine: armrests, pedals and chair, and the signals they give.

use xt28_dbc::Frame;
use xt28_ecus::firmware_2016::{CabPins, pads};

/// Joystick of the left armrest at its ends and centre, mV (facts 2.4).
const STICK_MV: [f64; 3] = [350.0, 2350.0, 4300.0];
/// Mini-joystick of the right armrest, likewise (facts 2.7).
const STEER_MV: [f64; 3] = [466.0, 2484.0, 4230.0];
/// Roller at its start and end, mV (facts 2.7).
const ROLLER_MV: [f64; 2] = [202.0, 4500.0];
/// Pedals at rest and pressed down, mV: a little beyond what the ECU takes for 0 and 1000 per mille
/// (facts 4.2).
const PEDAL_MV: [f64; 2] = [530.0, 4540.0];
/// Chair switch with the chair to the front and to the back, mV.
const CHAIR_MV: [f64; 2] = [24_000.0, 0.0];

/// Where the operator has all controls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cab {
    /// The chair faces the front; its pedal set acts.
    pub chair_front: bool,
    /// Accelerator, 0 to 1.
    pub gas: f64,
    /// Brake pedal, 0 to 1.
    pub brake: f64,
    /// Button down on the left armrest, 1 to 21.
    pub left_button: Option<u8>,
    /// Button down on the right armrest, 1 to 21.
    pub right_button: Option<u8>,
    /// Left joystick, x (right > 0) and y (forward > 0), -1 to 1.
    pub joystick: [f64; 2],
    /// Mini-joystick, -1 (left) to 1 (right).
    pub steer: f64,
    /// Engine speed roller, 0 to 1.
    pub roller: f64,
    /// The armrests send nothing.
    pub pads_silent: bool,
}

impl Default for Cab {
    /// Nobody touches anything.
    fn default() -> Self {
        Self {
            chair_front: true,
            gas: 0.0,
            brake: 0.0,
            left_button: None,
            right_button: None,
            joystick: [0.0; 2],
            steer: 0.0,
            roller: 0.0,
            pads_silent: false,
        }
    }
}

impl Cab {
    /// What the cab puts on the drive ECU's pins.
    pub(crate) fn pins(&self) -> CabPins {
        let [rest, down] = PEDAL_MV;
        let pedal = |share: f64| {
            let pressed = rest + share.clamp(0.0, 1.0) * (down - rest);
            if self.chair_front { [pressed, rest] } else { [rest, pressed] }
        };
        CabPins {
            gas_mv: pedal(self.gas),
            brake_mv: pedal(self.brake),
            chair_mv: CHAIR_MV[usize::from(!self.chair_front)],
            ..CabPins::IDLE
        }
    }

    /// What the left armrest sends.
    pub(crate) fn left_frames(&self) -> [Frame; 3] {
        pads::left_frames(self.left_button.as_slice(), self.joystick.map(|x| stick(x, STICK_MV)))
    }

    /// What the right armrest sends.
    pub(crate) fn right_frames(&self) -> [Frame; 3] {
        let [start, end] = ROLLER_MV;
        let roller = whole(start + self.roller.clamp(0.0, 1.0) * (end - start));
        pads::right_frames(self.right_button.as_slice(), stick(self.steer, STEER_MV), roller)
    }
}

fn stick(share: f64, [low, centre, high]: [f64; 3]) -> u16 {
    let share = share.clamp(-1.0, 1.0);
    whole(centre + share * if share < 0.0 { centre - low } else { high - centre })
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within 0 to 5000 mV
fn whole(mv: f64) -> u16 {
    mv.round() as u16
}

#[cfg(test)]
mod tests {
    use xt28_dbc::messages::{LeftPadJoystickX, RightPadJoystick, RightPadRoller};

    use super::*;

    #[test]
    fn controls_at_their_ends_give_the_published_voltages() {
        let cab = Cab { joystick: [-1.0, 1.0], steer: -1.0, roller: 1.0, ..Cab::default() };
        let [_, y, x] = cab.left_frames();
        assert_eq!(y.data()[..2], 4300_u16.to_le_bytes());
        assert_eq!(LeftPadJoystickX::decode(&x).unwrap().x_mv, 350.0);
        let [_, roller, steer] = cab.right_frames();
        assert_eq!(RightPadRoller::decode(&roller).unwrap().roller_mv, 4500.0);
        assert_eq!(RightPadJoystick::decode(&steer).unwrap().x_mv, 466.0);
        let back = Cab { chair_front: false, gas: 1.0, ..Cab::default() }.pins();
        assert_eq!((back.gas_mv, back.chair_mv), ([530.0, 4540.0], 0.0));
    }
}
