//! What each ECU watches: the table of its trouble codes. `docs/diagnostics.md` is held to it.
//!
//! SPNs of SAE where the part has one; 520192 and up are the manufacturer's own (J1939-73).

use super::trouble_code::{FailureMode, Fmi, Lamp, Part};

const fn stop(fmi: Fmi) -> FailureMode {
    FailureMode { fmi, lamp: Lamp::Stop }
}

const fn warn(fmi: Fmi) -> FailureMode {
    FailureMode { fmi, lamp: Lamp::Warning }
}

/// An analogue input in a control loop, of a part that can only move so fast.
const MOTION: &[FailureMode] =
    &[stop(Fmi::High), stop(Fmi::Low), stop(Fmi::Open), stop(Fmi::ChangeRate)];
/// The same, moved by a valve whose opening the ECU knows.
const STROKE: &[FailureMode] = &[
    stop(Fmi::High),
    stop(Fmi::Low),
    stop(Fmi::Open),
    stop(Fmi::ChangeRate),
    stop(Fmi::NotResponding),
];
/// An analogue input that no loop needs.
const ANALOGUE: &[FailureMode] = &[warn(Fmi::High), warn(Fmi::Low), warn(Fmi::Open)];
const WHEEL_SPEED: &[FailureMode] = &[warn(Fmi::Erratic), warn(Fmi::Frequency)];
const STREAM: &[FailureMode] = &[warn(Fmi::UpdateRate)];
const SUPPLY: &[FailureMode] = &[warn(Fmi::High), warn(Fmi::Low), warn(Fmi::FarBelow)];
const CONTROLLER: &[FailureMode] = &[warn(Fmi::Erratic)];

const fn part(spn: u32, name: &'static str, modes: &'static [FailureMode]) -> Part {
    Part { spn, name, modes }
}

/// Battery potential, power input 1.
const SUPPLY_PART: Part = part(168, "supply voltage", SUPPLY);
/// Controller 1: this ECU itself.
const CONTROLLER_PART: Part = part(629, "controller, restarted", CONTROLLER);

/// Parts of the pendulum-arm ECU. The first eighteen are in wheel order.
pub const ARM: &[Part] = &[
    part(520_192, "stroke FR", STROKE),
    part(520_193, "stroke FL", STROKE),
    part(520_194, "stroke MR", STROKE),
    part(520_195, "stroke ML", STROKE),
    part(520_196, "stroke BR", STROKE),
    part(520_197, "stroke BL", STROKE),
    part(520_200, "pressure FR A", ANALOGUE),
    part(520_201, "pressure FL A", ANALOGUE),
    part(520_202, "pressure MR A", ANALOGUE),
    part(520_203, "pressure ML A", ANALOGUE),
    part(520_204, "pressure BR A", ANALOGUE),
    part(520_205, "pressure BL A", ANALOGUE),
    part(520_210, "pressure FR B", ANALOGUE),
    part(520_211, "pressure FL B", ANALOGUE),
    part(520_212, "pressure MR B", ANALOGUE),
    part(520_213, "pressure ML B", ANALOGUE),
    part(520_214, "pressure BR B", ANALOGUE),
    part(520_215, "pressure BL B", ANALOGUE),
    part(520_220, "inertial unit", STREAM),
    part(520_221, "arm commands", STREAM),
    SUPPLY_PART,
    CONTROLLER_PART,
];

/// Where the parts stand in [`ARM`].
pub(crate) mod arm {
    pub(crate) const STROKE: usize = 0;
    pub(crate) const PRESSURE_A: usize = 6;
    pub(crate) const PRESSURE_B: usize = 12;
    pub(crate) const IMU: usize = 18;
    pub(crate) const COMMANDS: usize = 19;
    pub(crate) const SUPPLY: usize = 20;
    pub(crate) const CONTROLLER: usize = 21;
}

/// Parts of the transmission and steering ECU.
pub const DRIVE: &[Part] = &[
    part(520_230, "front joint angle", MOTION),
    part(520_231, "rear joint angle", MOTION),
    part(520_240, "pressure pump 1 A", ANALOGUE),
    part(520_241, "pressure pump 1 B", ANALOGUE),
    part(520_242, "pressure pump 2 A", ANALOGUE),
    part(520_243, "pressure pump 2 B", ANALOGUE),
    part(520_250, "wheel speed FR", WHEEL_SPEED),
    part(520_251, "wheel speed FL", WHEEL_SPEED),
    part(520_252, "wheel speed MR", WHEEL_SPEED),
    part(520_253, "wheel speed ML", WHEEL_SPEED),
    part(520_254, "wheel speed BR", WHEEL_SPEED),
    part(520_255, "wheel speed BL", WHEEL_SPEED),
    part(190, "engine speed", STREAM),
    part(520_222, "drive commands", STREAM),
    SUPPLY_PART,
    CONTROLLER_PART,
];

/// Where the parts stand in [`DRIVE`].
pub(crate) mod drive {
    pub(crate) const JOINT: usize = 0;
    pub(crate) const PUMP: usize = 2;
    pub(crate) const WHEEL: usize = 6;
    pub(crate) const ENGINE: usize = 12;
    pub(crate) const COMMANDS: usize = 13;
    pub(crate) const SUPPLY: usize = 14;
    pub(crate) const CONTROLLER: usize = 15;
}

#[cfg(test)]
mod tests {
    use xt28_machine::Wheel;

    use super::*;

    #[test]
    fn the_positions_name_what_stands_there() {
        for wheel in Wheel::ALL {
            let i = wheel.index();
            assert_eq!(ARM[arm::STROKE + i].name, format!("stroke {wheel}"));
            assert_eq!(ARM[arm::PRESSURE_A + i].name, format!("pressure {wheel} A"));
            assert_eq!(ARM[arm::PRESSURE_B + i].name, format!("pressure {wheel} B"));
            assert_eq!(DRIVE[drive::WHEEL + i].name, format!("wheel speed {wheel}"));
        }
        assert_eq!(ARM[arm::IMU].name, "inertial unit");
        assert_eq!(ARM[arm::COMMANDS].name, "arm commands");
        assert_eq!((ARM[arm::SUPPLY], ARM[arm::CONTROLLER]), (SUPPLY_PART, CONTROLLER_PART));
        assert_eq!(DRIVE[drive::JOINT + 1].name, "rear joint angle");
        assert_eq!(DRIVE[drive::PUMP + 3].name, "pressure pump 2 B");
        assert_eq!(DRIVE[drive::ENGINE].spn, 190);
        assert_eq!(DRIVE[drive::COMMANDS].name, "drive commands");
        assert_eq!(
            (DRIVE[drive::SUPPLY], DRIVE[drive::CONTROLLER]),
            (SUPPLY_PART, CONTROLLER_PART)
        );
    }

    #[test]
    fn numbers_are_unique_and_fit() {
        for parts in [ARM, DRIVE] {
            for (i, part) in parts.iter().enumerate() {
                assert!(part.spn < 1 << 19, "{}", part.name);
                assert!(parts[..i].iter().all(|other| other.spn != part.spn), "{}", part.name);
                let fmis: Vec<_> = part.modes.iter().map(|mode| mode.fmi).collect();
                assert!((1..fmis.len()).all(|j| !fmis[..j].contains(&fmis[j])), "{}", part.name);
            }
        }
    }
}
