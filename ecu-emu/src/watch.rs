//! What there is to tell of the bus: a double of the machine, and a controller that went bus-off.

use xt28_dbc::messages::{PosFront, WheelSpeedJoint};
use xt28_dbc::{CanId, Frame};

/// Sent every tick by either profile's arm ECU and drive ECU, and by nobody else.
const ONLY_OURS: [(CanId, &str); 2] =
    [(PosFront::ID, "PosFront"), (WheelSpeedJoint::ID, "WheelSpeedJoint")];

/// What there is to tell of the bus.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    /// The first frame from somebody else that only this machine's ECUs send.
    double: Option<&'static str>,
    told: bool,
    is_off: bool,
}

impl Watch {
    /// Takes note of a frame from somebody else.
    pub(crate) fn note(&mut self, frame: &Frame) {
        let ours = ONLY_OURS.iter().find(|(id, _)| *id == frame.id());
        self.double = self.double.or(ours.map(|(_, name)| *name));
    }

    /// News since the last call of the bus called `name`, a line each: of a double of the machine (another
    /// emulator, a log that is played back, the machine itself), as who listens then follows two at once; and of
    /// a controller that `was_off` the bus since, be it for less than a tick, or `is_off`.
    pub(crate) fn news(&mut self, name: &str, [was_off, is_off]: [bool; 2]) -> [Option<String>; 2] {
        let double = self.double.filter(|_| !self.told);
        self.told |= double.is_some();
        let went_off = was_off && !self.is_off;
        self.is_off = is_off;
        [
            double.map(|frame| {
                format!(
                    "somebody else on {name} sends {frame}, which only this machine's ECUs do: stop the other \
                     emulator, or the playing of the log"
                )
            }),
            went_off.then(|| {
                format!(
                    "{name}: the controller went bus-off, and frames are lost until it restarts; see \
                     `ip -details -statistics link show {name}`"
                )
            }),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WELL: [bool; 2] = [false; 2];

    #[test]
    fn a_double_of_the_machine_is_told_once() {
        let heard = |id| {
            let mut watch = Watch::default();
            (0..2).for_each(|_| watch.note(&Frame::new(id, &[0; 8]).unwrap()));
            watch
        };
        let mut watch = heard(CanId::Extended(0x18FE_1026));
        let [double, off] = watch.news("vcan0", WELL);
        assert!(double.is_some_and(|line| line.contains("vcan0 sends PosFront")) && off.is_none());
        watch.note(&Frame::new(PosFront::ID, &[0; 4]).unwrap());
        assert_eq!(watch.news("vcan0", WELL), [None, None]);
        assert_eq!(heard(CanId::Standard(0x026)).news("vcan0", WELL), [None, None]);
    }

    #[test]
    fn a_bus_off_is_told_as_often_as_it_comes_and_however_short_it_is() {
        let mut watch = Watch::default();
        let looks = [WELL, [true, false], WELL, [true, true], [true, true], [true, false]];
        let told = looks.map(|off| watch.news("can0", off)[1].is_some());
        assert_eq!(told, [false, true, false, true, false, false]);
    }
}
