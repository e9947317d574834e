//! An effect as data: its name, its block and its parameters, each with a place in [`Effects`].

use core::fmt;

use xt28_machine::{Machine, Wheel};

use super::{Effects, Scope};

/// The block of the plant, or the place on the way to it, where an effect acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Block {
    /// Arm hydraulics, from command to cylinder.
    Arms,
    /// The articulation joints.
    Steering,
    /// Throttle to wheel torque.
    Drive,
    /// Wheel against ground.
    Tyre,
    /// Masses.
    Payload,
    /// The ground's lie.
    Ground,
    /// The reading, not the machine.
    Sensor,
    /// What reaches the ECU, and when.
    Bus,
}

impl fmt::Display for Block {
    /// The block's name in verdicts.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Arms => "arms",
            Self::Steering => "steering",
            Self::Drive => "drive",
            Self::Tyre => "tyre",
            Self::Payload => "payload",
            Self::Ground => "ground",
            Self::Sensor => "sensor",
            Self::Bus => "bus",
        })
    }
}

/// Something real that the nominal plant leaves out.
#[derive(Debug)]
pub struct Effect {
    /// Name in overlays and verdicts.
    pub name: &'static str,
    /// Where it acts.
    pub block: Block,
    /// What it is, in one line.
    pub meaning: &'static str,
    /// Where its law and size come from.
    pub source: &'static str,
    /// What can be set.
    pub parameters: &'static [Parameter],
}

/// One number of an effect.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Name in overlays and verdicts, with its unit.
    pub name: &'static str,
    /// Value at which the effect is not there. Where the machine file has the same number, it is the
    /// nominal machine's, and stands for whatever the file says.
    pub neutral: f64,
    /// Standard deviation that a careful engineer would believe, before seeing data, of machines that he calls
    /// sound. Sizes in [`Effect::source`] are of what the effect is where it is worth its name, and are larger.
    pub tolerance: f64,
    /// Values the law is made for, ends included.
    pub range: [f64; 2],
    /// Whether it changes anything while the effect's other parameters are neutral. One that does not says where,
    /// when or how fast another one acts, as where a load lies that weighs nothing.
    pub acts_alone: bool,
    /// Where it sits.
    pub slot: Slot,
}

/// Where a parameter sits in [`Effects`].
#[derive(Clone, Copy, Debug)]
pub enum Slot {
    /// One for each wheel or arm.
    PerWheel(fn(&mut Effects, Wheel) -> &mut f64),
    /// One for the machine.
    Whole(fn(&mut Effects) -> &mut f64),
}

/// Effects of the ECUs, and their parameters that are: a slow rear valve shows in the follower, and is the plant's.
const LAWS_OF_ECUS: [(&str, &[&str]); 3] = [
    ("arm-gain", &["kp_factor", "ki_factor"]),
    ("steer-gain", &["kp_factor", "ki_factor"]),
    ("rear-follower-lag", &["time_constant_s", "ratio_factor"]),
];

/// A name stands for one effect.
impl PartialEq for Effect {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// A parameter sits in one place; its name alone may stand in many effects.
impl PartialEq for Parameter {
    fn eq(&self, other: &Self) -> bool {
        core::ptr::eq(self, other)
    }
}

impl Effect {
    /// Whether it can act on some wheels and not on others.
    #[must_use]
    pub fn has_scope(&self) -> bool {
        self.parameters.iter().any(|p| matches!(p.slot, Slot::PerWheel(_)))
    }

    /// Whether one of its parameters is a number in the law of an ECU as the paper has them, which no plant has.
    #[must_use]
    pub fn is_law_of_an_ecu(&self, parameter: &Parameter) -> bool {
        let own = LAWS_OF_ECUS.iter().filter(|(effect, _)| *effect == self.name);
        own.flat_map(|(_, names)| *names).any(|name| *name == parameter.name)
    }

    /// The same effect as it is on `machine`: each parameter neutral where the machine file says the same number,
    /// and its range with that in it. Where that changes nothing it is the effect itself; else it lives as long as
    /// the program, as effects do.
    #[must_use]
    pub fn on(&'static self, machine: &Machine) -> &'static Self {
        let own = |p: &Parameter| {
            let (neutral, [low, high]) = (p.neutral_on(machine), p.range);
            Parameter { neutral, range: [low.min(neutral), high.max(neutral)], ..*p }
        };
        let parameters: Vec<Parameter> = self.parameters.iter().map(own).collect();
        if parameters.iter().zip(self.parameters).all(|(own, p)| own.neutral == p.neutral) {
            return self;
        }
        Box::leak(Box::new(Self { parameters: parameters.leak(), ..*self }))
    }

    /// The parameter of this name.
    #[must_use]
    pub fn parameter(&self, name: &str) -> Option<&'static Parameter> {
        self.parameters.iter().find(|p| p.name == name)
    }
}

impl Parameter {
    /// Sets it on every wheel of `scope`, or once where it has no wheel.
    pub fn set(&self, effects: &mut Effects, scope: Scope, value: f64) {
        match self.slot {
            Slot::PerWheel(slot) => scope.wheels().for_each(|w| *slot(effects, w) = value),
            Slot::Whole(slot) => *slot(effects) = value,
        }
    }

    /// Value at which the effect is not there on this machine, and from which it sets in: what its file says
    /// of the same number or makes of it, or else [`Self::neutral`].
    #[must_use]
    pub fn neutral_on(&self, machine: &Machine) -> f64 {
        self.get(&Effects::onset_on(machine), Scope::All)
    }

    /// Whether it can be off to one side only: neutral is an end of its range, as of a delay.
    #[must_use]
    pub fn is_one_sided(&self) -> bool {
        self.range.contains(&self.neutral)
    }

    /// Its value on the first wheel of `scope`, or its one value where it has no wheel.
    #[must_use]
    pub fn get(&self, effects: &Effects, scope: Scope) -> f64 {
        let mut copy = effects.clone();
        match self.slot {
            Slot::PerWheel(slot) => {
                let wheel = scope.wheels().next().expect("no scope is empty");
                *slot(&mut copy, wheel)
            }
            Slot::Whole(slot) => *slot(&mut copy),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{CATALOGUE, find};

    #[test]
    fn an_effect_is_neutral_where_the_machine_file_says() {
        let mut machine = Machine::xt28();
        for effect in CATALOGUE {
            assert!(core::ptr::eq(effect.on(&machine), effect), "{}", effect.name);
        }
        machine.vehicle.tyre_stiffness_n_m = 1.0e5; // softer than the law's range reaches
        let soft = find("soft-tyres").unwrap();
        let own = soft.on(&machine);
        assert_eq!(own, soft, "a name stands for one effect");
        let [stiffness, damping] = own.parameters else { panic!("two numbers") };
        assert_eq!((stiffness.neutral, stiffness.range), (1.0e5, [1.0e5, 2.0e7]));
        assert_eq!(damping.neutral, soft.parameters[1].neutral);
        assert_eq!(find("arm-delay").unwrap().on(&machine).parameters[0].neutral, 0.0);
    }
}
