//! The two armrest pads: which button is which bits, and their frames (facts 2.4, 2.7, 3.8, 4.7).

use xt28_dbc::messages::{
    LeftPadButtons, LeftPadJoystickX, LeftPadJoystickY, RightPadButtons, RightPadJoystick,
    RightPadRoller,
};
use xt28_dbc::{CanId, Frame};

/// Byte and value of buttons 1 to 21.
pub type Table = [(usize, u8); 21];

/// Buttons of the left armrest.
pub const LEFT: Table = [
    (3, 0x01),
    (3, 0x04),
    (3, 0x10),
    (3, 0x40),
    (4, 0x01),
    (4, 0x04),
    (4, 0x10),
    (4, 0x40),
    (5, 0x01),
    (0, 0x01),
    (0, 0x04),
    (0, 0x10),
    (0, 0x40),
    (1, 0x01),
    (1, 0x04),
    (1, 0x10),
    (1, 0x40),
    (2, 0x01),
    (2, 0x04),
    (2, 0x10),
    (2, 0x40),
];

/// Buttons of the right armrest.
pub const RIGHT: Table = [
    (3, 0x01),
    (3, 0x04),
    (3, 0x10),
    (3, 0x40),
    (4, 0x01),
    (4, 0x04),
    (4, 0x10),
    (4, 0x40),
    (5, 0x01),
    (2, 0x04),
    (2, 0x10),
    (2, 0x40),
    (1, 0x10),
    (1, 0x40),
    (2, 0x01),
    (0, 0x40),
    (1, 0x01),
    (1, 0x04),
    (0, 0x01),
    (0, 0x04),
    (0, 0x10),
];

/// Buttons as a frame carries them, with the table that reads them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pattern {
    bytes: [u8; 8],
    table: &'static Table,
}

impl Default for Pattern {
    fn default() -> Self {
        Self { bytes: [0; 8], table: &LEFT }
    }
}

impl Pattern {
    /// Those buttons pressed together.
    pub(super) fn of(table: &'static Table, pressed: &[u8]) -> Self {
        let mut bytes = [0; 8];
        for button in pressed {
            if let Some((byte, value)) = entry(table, *button) {
                bytes[byte] |= value;
            }
        }
        Self { bytes, table }
    }

    /// From a frame; `None` for one of another length.
    fn from_frame(table: &'static Table, frame: &Frame) -> Option<Self> {
        Some(Self { bytes: frame.data().try_into().ok()?, table })
    }

    /// Anything pressed at all.
    pub(super) fn any(self) -> bool {
        self.bytes != [0; 8]
    }

    /// The button whose byte is exactly its value: two pressed in one byte are none.
    pub(super) fn button(self) -> Option<u8> {
        (1..=21).find(|b| entry(self.table, *b).is_some_and(|(i, value)| self.bytes[i] == value))
    }
}

fn entry(table: &Table, button: u8) -> Option<(usize, u8)> {
    table.get(usize::from(button).checked_sub(1)?).copied()
}

/// One frame of an armrest, as its ECU reads it.
#[derive(Clone, Copy, Debug)]
pub(super) enum PadReading {
    Buttons(Pattern),
    /// Left joystick, to the sides, mV.
    StickX(i32),
    /// Left joystick, fore and aft, mV.
    StickY(i32),
    /// Right mini-joystick, mV.
    Steer(i32),
    /// Roller for the engine speed, mV.
    Roller(i32),
}

/// What a frame of the left armrest says; `None` for others.
pub(super) fn read_left(frame: &Frame) -> Option<PadReading> {
    Some(match frame.id() {
        LeftPadButtons::ID => PadReading::Buttons(Pattern::from_frame(&LEFT, frame)?),
        LeftPadJoystickX::ID => PadReading::StickX(word(frame, 6)?),
        LeftPadJoystickY::ID => PadReading::StickY(word(frame, 0)?),
        _ => return None,
    })
}

/// What a frame of the right armrest says; `None` for others.
pub(super) fn read_right(frame: &Frame) -> Option<PadReading> {
    Some(match frame.id() {
        RightPadButtons::ID => PadReading::Buttons(Pattern::from_frame(&RIGHT, frame)?),
        RightPadJoystick::ID => PadReading::Steer(word(frame, 6)?),
        RightPadRoller::ID => PadReading::Roller(word(frame, 2)?),
        _ => return None,
    })
}

fn word(frame: &Frame, at: usize) -> Option<i32> {
    let [low, high] = *frame.data().get(at..at + 2)? else { return None };
    Some(i32::from(u16::from_le_bytes([low, high])))
}

/// The three frames of the left armrest: buttons pressed, joystick `[x, y]`, mV.
#[must_use]
pub fn left_frames(pressed: &[u8], stick_mv: [u16; 2]) -> [Frame; 3] {
    let [x_mv, y_mv] = stick_mv;
    [
        bytes(LeftPadButtons::ID, Pattern::of(&LEFT, pressed).bytes),
        at(LeftPadJoystickY::ID, 0, y_mv),
        at(LeftPadJoystickX::ID, 6, x_mv),
    ]
}

/// The three frames of the right armrest: buttons pressed, mini-joystick and roller, mV.
#[must_use]
pub fn right_frames(pressed: &[u8], steer_mv: u16, roller_mv: u16) -> [Frame; 3] {
    [
        bytes(RightPadButtons::ID, Pattern::of(&RIGHT, pressed).bytes),
        at(RightPadRoller::ID, 2, roller_mv),
        at(RightPadJoystick::ID, 6, steer_mv),
    ]
}

fn at(id: CanId, start: usize, mv: u16) -> Frame {
    let mut data = [0; 8];
    data[start..start + 2].copy_from_slice(&mv.to_le_bytes());
    bytes(id, data)
}

fn bytes(id: CanId, data: [u8; 8]) -> Frame {
    Frame::new(id, &data).expect("eight bytes")
}

#[cfg(test)]
mod tests {
    use xt28_dbc::messages::RightPadRoller;

    use super::*;

    /// The database has the buttons as signals of two bits; the table as bytes. Both must agree.
    #[test]
    fn every_button_is_the_one_that_the_database_names() {
        let database = xt28_dbc::database();
        for (id, table) in [(LeftPadButtons::ID, &LEFT), (RightPadButtons::ID, &RIGHT)] {
            let message = database.message(id.dbc()).unwrap();
            for button in 1..=21_u8 {
                let named: Vec<(String, f64)> = (1..=21)
                    .map(|n| (format!("Button{n}"), f64::from(u8::from(n == button))))
                    .collect();
                let named: Vec<(&str, f64)> = named.iter().map(|(n, v)| (n.as_str(), *v)).collect();
                let pattern = Pattern::of(table, &[button]);
                assert_eq!(message.encode(&named).unwrap(), pattern.bytes, "button {button}");
                assert_eq!(pattern.button(), Some(button));
            }
        }
    }

    #[test]
    fn voltages_come_back_from_their_frames() {
        let [buttons, y, x] = left_frames(&[18], [1111, 2222]);
        assert!(
            matches!(read_left(&buttons), Some(PadReading::Buttons(p)) if p.button() == Some(18))
        );
        assert!(matches!(read_left(&y), Some(PadReading::StickY(2222))));
        assert!(matches!(read_left(&x), Some(PadReading::StickX(1111))));
        let [buttons, roller, steer] = right_frames(&[], 2484, 202);
        assert!(matches!(read_right(&buttons), Some(PadReading::Buttons(p)) if !p.any()));
        assert!(matches!(read_right(&roller), Some(PadReading::Roller(202))));
        assert!(matches!(read_right(&steer), Some(PadReading::Steer(2484))));
        assert_eq!(RightPadRoller::decode(&roller).unwrap().roller_mv, 202.0);
        assert!(read_left(&roller).is_none());
    }
}
