//! What an effect needs before it can show, and which scripted manoeuvre has it.

use xt28_machine::{PerWheel, Wheel};

use super::super::floor::Signal;
use super::measure::{ArmUse, Excitation};

/// Commands that must change before their lateness or loss says anything.
const COMMANDS: usize = 3;

/// For how long what is judged on some ground alone must have been there, s.
const JUDGED_S: f64 = 2.0;

/// The ground on which the whole machine is judged.
const GROUND: &str = "level ground or a known slope";

/// One thing that the machine must have done; the number is the least that will do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Need {
    /// Every arm through a range, m.
    ArmsMove(f64),
    /// Every arm out and in again, m each way.
    ArmsTurn(f64),
    /// Some arm through a range while the machine stands where that is judged, m.
    ArmsMoveStanding(f64),
    /// Every arm under loads that differ, N.
    LoadsDiffer(f64),
    /// Every arm under load with its valve shut, s.
    ArmsHold(f64),
    /// Some arm without load with its valve shut, s.
    ArmsUnloaded(f64),
    /// Several arms at once: sum of the openings.
    SeveralArms(f64),
    /// The stroke of every arm judged for [`JUDGED_S`] at all: its chambers are full.
    ArmsJudged,
    /// The controller of every arm judged for as long: arms in manual position.
    ArmsControlled,
    /// The front joint through a range while the machine moves, rad.
    Steers(f64),
    /// A step of the throttle.
    ThrottleSteps(f64),
    /// A throttle.
    Throttle(f64),
    /// A way, m.
    Rolls(f64),
    /// A receiver.
    Fixes,
    /// Commands that change.
    Commands,
    /// A signal that could be judged for [`JUDGED_S`] at all: how the machine stands and travels, and what
    /// drives it, is judged on level ground or a known slope alone.
    Judged(Signal),
}

impl Need {
    /// What the runs lack, in words; `None` where they have it.
    pub(super) fn unmet(self, did: &Excitation) -> Option<String> {
        let mm = |m: f64| m * 1e3;
        match self {
            Self::ArmsMove(m) => idle(&did.arms, |arm| arm.moves_m < m)
                .map(|who| format!("{who} through less than {:.0} mm", mm(m))),
            Self::ArmsTurn(m) => idle(&did.arms, |arm| arm.turns_m < m)
                .map(|who| format!("{who} through less than {:.0} mm both out and in", mm(m))),
            Self::ArmsMoveStanding(m) => none_of(&did.arms, |arm| arm.moves_standing_m >= m)
                .then(|| {
                    format!("no arm moves by {:.0} mm while the machine stands on {GROUND}", mm(m))
                }),
            Self::LoadsDiffer(n) => {
                let still = Wheel::ALL.into_iter().filter(|w| did.arms[*w].load_range_n < n);
                let still: Vec<&str> = still.map(Wheel::name).collect();
                (!still.is_empty()).then(|| {
                    format!("the load of {} changes by less than {:.0} kN", still.join(" "), n / 1e3)
                })
            }
            Self::ArmsHold(s) => none_of(&did.arms, |arm| arm.holds_s >= s)
                .then(|| format!("no arm stands under load with its valve shut for {s:.0} s")),
            Self::ArmsUnloaded(s) => none_of(&did.arms, |arm| arm.unloaded_s >= s)
                .then(|| format!("no arm hangs free with its valve shut for {s:.0} s")),
            Self::SeveralArms(sum) => (did.openings < sum).then(|| {
                format!(
                    "the arms' valves are never open by more than {:.2} together, of {sum:.1} needed",
                    did.openings
                )
            }),
            Self::ArmsJudged => Self::in_the_dark(&did.arms, |arm| arm.judged_s)
                .map(|who| format!("the stroke of {who}, as a chamber reads empty")),
            Self::ArmsControlled => Self::in_the_dark(&did.arms, |arm| arm.controlled_s)
                .map(|who| format!("the controller of {who} in manual position")),
            Self::Steers(rad) => (did.steers_rad < rad).then(|| {
                let (is, least) = (did.steers_rad.to_degrees(), rad.to_degrees());
                format!("the front joint goes through {is:.1} deg of {least:.1} deg needed while rolling")
            }),
            Self::ThrottleSteps(least) => (did.throttle_step < least).then(|| {
                format!("no step of the throttle by {:.0} % or more", least * 100.0)
            }),
            Self::Throttle(least) => (did.throttle < least).then(|| {
                let (is, least) = (did.throttle * 100.0, least * 100.0);
                format!("the throttle goes up to {is:.0} % of {least:.0} % needed")
            }),
            Self::Rolls(m) => (did.rolls_m < m)
                .then(|| format!("no run rolls {m:.0} m; the longest is {:.1} m", did.rolls_m)),
            Self::Fixes => (did.fixes == 0).then(|| "no fix of a receiver".to_owned()),
            Self::Judged(signal) => {
                let is_s = did.judged_s.get(&signal).copied().unwrap_or(0.0);
                (is_s < JUDGED_S).then(|| {
                    format!(
                        "{signal} could be judged for {is_s:.1} s of {JUDGED_S:.0} s needed, on {GROUND} \
                         and with loads on their scale"
                    )
                })
            }
            Self::Commands => (did.commands < COMMANDS).then(|| "no command changes".to_owned()),
        }
    }

    /// "FR FL could be judged for less than 2 s," for the arms of which that is so.
    fn in_the_dark(arms: &PerWheel<ArmUse>, judged_s: impl Fn(&ArmUse) -> f64) -> Option<String> {
        let dark = arms.iter().filter(|(_, arm)| judged_s(arm) < JUDGED_S);
        let names: Vec<&str> = dark.map(|(wheel, _)| wheel.name()).collect();
        let arms = names.join(" ");
        (!names.is_empty()).then(|| format!("{arms} could be judged for less than {JUDGED_S:.0} s"))
    }

    /// What its manoeuvre needs more of where it was driven and had too little, after "drive it again,".
    pub(super) fn more(self) -> String {
        let mm = |m: f64| m * 1e3;
        match self {
            Self::ArmsMove(m) => format!("every arm through {:.0} mm", mm(m)),
            Self::ArmsTurn(m) => format!("every arm through {:.0} mm both out and in", mm(m)),
            Self::ArmsMoveStanding(m) => {
                format!("an arm through {:.0} mm while the machine stands", mm(m))
            }
            Self::LoadsDiffer(n) => {
                format!("farther, until the load of every arm changes by {:.0} kN", n / 1e3)
            }
            Self::ArmsHold(s) => format!("with a valve shut under load for {s:.0} s"),
            Self::ArmsUnloaded(s) => format!("with an arm free and its valve shut for {s:.0} s"),
            Self::SeveralArms(sum) => format!("with valves open by {sum:.1} together"),
            Self::ArmsJudged => "with oil in every chamber".to_owned(),
            Self::ArmsControlled => format!("in manual position for {JUDGED_S:.0} s"),
            Self::Steers(rad) => {
                format!("the front joint through {:.0} deg while rolling", rad.to_degrees().ceil())
            }
            Self::ThrottleSteps(least) => {
                format!("with a step of the throttle by {:.0} %", least * 100.0)
            }
            Self::Throttle(least) => format!("with {:.0} % of throttle or more", least * 100.0),
            Self::Rolls(m) => format!("for {m:.0} m or more"),
            Self::Fixes => "with a receiver that is logged".to_owned(),
            Self::Judged(signal) => {
                format!("on level ground or a known slope, until {signal} can be judged")
            }
            Self::Commands => "with commands that change".to_owned(),
        }
    }

    /// Whether one arm that did it is enough, whichever it is.
    pub(super) const fn is_of_any_arm(self) -> bool {
        matches!(self, Self::ArmsMoveStanding(_) | Self::ArmsHold(_) | Self::ArmsUnloaded(_))
    }

    /// The scripted manoeuvre that has it.
    pub(super) const fn manoeuvre(self) -> &'static str {
        match self {
            Self::ArmsMove(_) | Self::ArmsTurn(_) | Self::ArmsUnloaded(_) => "single-arm",
            Self::ArmsMoveStanding(_) | Self::SeveralArms(_) => "arm-step",
            Self::LoadsDiffer(_) | Self::Commands => "multisine",
            Self::ArmsHold(_) | Self::ArmsJudged | Self::ArmsControlled => "arm-step",
            Self::Steers(_) => "s-turn",
            Self::ThrottleSteps(_)
            | Self::Throttle(_)
            | Self::Rolls(_)
            | Self::Fixes
            | Self::Judged(_) => "straight",
        }
    }
}

fn none_of(arms: &PerWheel<ArmUse>, did: impl Fn(&ArmUse) -> bool) -> bool {
    !arms.iter().any(|(_, arm)| did(arm))
}

/// "FR FL go" for the arms of which `idle` holds.
fn idle(arms: &PerWheel<ArmUse>, idle: impl Fn(&ArmUse) -> bool) -> Option<String> {
    let names: Vec<&str> =
        arms.iter().filter(|(_, arm)| idle(arm)).map(|(wheel, _)| wheel.name()).collect();
    match names.len() {
        0 => None,
        6 => Some("all arms go".to_owned()),
        1 => Some(format!("arm {} goes", names[0])),
        _ => Some(format!("arms {} go", names.join(" "))),
    }
}
