//! The scripted manoeuvres, within what a gateway's script may say.

use core::f64::consts::TAU;
use core::fmt::Write as _;
use std::collections::BTreeMap;

use xt28_machine::{PerWheel, Wheel};

use crate::{Channel, FieldLog, Series};

/// Strokes that the arms stand at, mm.
const BASE_MM: f64 = 120.0;
/// Time between two commands on the bus, s.
const TICK_S: f64 = 0.01;

/// What the gateway is to command over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Manoeuvre {
    /// Its name.
    pub name: &'static str,
    /// Its length, s.
    pub end_s: f64,
    steps: Vec<Step>,
}

/// A command, in force until the next.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    at_s: f64,
    stroke_mm: PerWheel<f64>,
    throttle_percent: f64,
    front_deg: f64,
}

/// What the first line of every script ends with.
const PURPOSE: &str = ", to tell causes apart.";
/// What every scenario begins with.
const GOOD_FOR: &str = "# What this drive leaves in the log ";

impl Manoeuvre {
    /// Whether `text` is a script that [`Self::script`] made, of whichever drive.
    #[must_use]
    pub fn wrote(text: &str) -> bool {
        text.lines().next().is_some_and(|line| line.starts_with('#') && line.ends_with(PURPOSE))
    }

    /// Whether `text` is a scenario that [`Self::scenario`] made, of whichever drive.
    #[must_use]
    pub fn is_scenario(text: &str) -> bool {
        text.starts_with(GOOD_FOR)
    }

    /// All of them: a ramp is not among them, for it needs one to be built.
    #[must_use]
    pub fn all() -> Vec<Self> {
        vec![arm_step(), single_arm(), multisine(), straight(), s_turn(), mixed()]
    }

    /// The script for the gateway's policy `script:FILE`.
    #[must_use]
    pub fn script(&self) -> String {
        let mut text = format!("# {}{PURPOSE}\nend_s = {}\n", self.name, self.end_s);
        for step in &self.steps {
            let [fr, fl, mr, ml, br, bl] = step.stroke_mm.0;
            let _ = write!(
                text,
                "\n[[command]]\nat_s = {}\nstroke_mm = [{fr}, {fl}, {mr}, {ml}, {br}, {bl}]\nthrottle_percent = {}\nfront_angle_deg = {}\n",
                step.at_s, step.throttle_percent, step.front_deg
            );
        }
        text
    }

    /// The one of this name.
    #[must_use]
    pub fn find(name: &str) -> Option<Self> {
        Self::all().into_iter().find(|one| one.name == name)
    }

    /// The scenario that plays that script, which lies beside it as the file `script`, with a word on
    /// what it is `good_for`.
    #[must_use]
    pub fn scenario(&self, script: &str, good_for: &str) -> String {
        format!(
            "{GOOD_FOR}{good_for}.\ntitle = \"{}, a test drive\"\npolicy = \"script:{script}\"\nduration_s = {:.1}\n\n# The machine comes through it on its wheels.\n[[expect]]\ncarries-weight = {{ from_s = {:.1}, to_s = {:.1}, within_percent = 5.0 }}\n",
            self.name,
            self.end_s + 2.0,
            self.end_s,
            self.end_s + 1.5
        )
    }

    /// A log that holds only the commands, and where the arms stand at its start.
    pub(super) fn commands(&self) -> FieldLog {
        let mut series: BTreeMap<Channel, Series> = BTreeMap::new();
        let mut say = |channel, at_s, value| {
            series.entry(channel).or_default().push(at_s, value);
        };
        for w in Wheel::ALL {
            say(Channel::Stroke(w), 0.0, self.steps[0].stroke_mm[w] * 1e-3);
        }
        let mut in_force = self.steps[0];
        for tick in 0.. {
            let at_s = f64::from(tick) * TICK_S;
            if at_s > self.end_s {
                break;
            }
            in_force =
                self.steps.iter().rev().find(|s| s.at_s <= at_s).copied().unwrap_or(in_force);
            for w in Wheel::ALL {
                say(Channel::TargetStroke(w), at_s, in_force.stroke_mm[w] * 1e-3);
            }
            say(Channel::ArmMode, at_s, 2.0);
            say(Channel::Throttle, at_s, in_force.throttle_percent / 100.0);
            say(Channel::TargetJoint, at_s, in_force.front_deg.to_radians());
            say(Channel::Enable, at_s, 1.0);
        }
        FieldLog::of_series(self.name, series, self.end_s)
    }
}

const STANDING: Step =
    Step { at_s: 0.0, stroke_mm: PerWheel([BASE_MM; 6]), throttle_percent: 0.0, front_deg: 0.0 };

/// Front and rear axle up and down in large steps, the middle one left where it is.
fn arm_step() -> Manoeuvre {
    let level = |(at_s, mm): (f64, f64)| Step {
        at_s,
        stroke_mm: PerWheel([mm, mm, BASE_MM, BASE_MM, mm, mm]),
        ..STANDING
    };
    let steps = [(0.0, 120.0), (2.0, 220.0), (9.0, 60.0), (17.0, 180.0), (24.0, 120.0)];
    Manoeuvre { name: "arm-step", end_s: 30.0, steps: steps.map(level).to_vec() }
}

/// One arm after the other up and down.
fn single_arm() -> Manoeuvre {
    let mut steps = vec![STANDING];
    for (k, w) in (0_u8..).zip(Wheel::ALL) {
        let from_s = 1.0 + 5.0 * f64::from(k);
        let mut up = Step { at_s: from_s, ..STANDING };
        up.stroke_mm[w] = BASE_MM + 50.0;
        steps.extend([up, Step { at_s: from_s + 2.5, ..STANDING }]);
    }
    Manoeuvre { name: "single-arm", end_s: 32.0, steps }
}

/// All arms at once, each by two sines of its own.
fn multisine() -> Manoeuvre {
    let at = |tick: u8| {
        let at_s = 0.2 * f64::from(tick);
        let swing = |w: Wheel| {
            let k = f64::from(u8::try_from(w.index()).unwrap_or_default());
            let sine = |mm: f64, hz: f64| mm * (TAU * hz * at_s + k).sin();
            // Whole steps of 2 mm, as the wire has them.
            2.0 * ((BASE_MM + sine(20.0, 0.08 + 0.01 * k) + sine(10.0, 0.3 - 0.02 * k)) / 2.0)
                .round()
        };
        Step { at_s, stroke_mm: PerWheel::from_fn(swing), ..STANDING }
    };
    Manoeuvre { name: "multisine", end_s: 30.0, steps: (0..150).map(at).collect() }
}

/// Several speeds in a row, straight on.
fn straight() -> Manoeuvre {
    let speed = |(at_s, throttle_percent): (f64, f64)| Step { at_s, throttle_percent, ..STANDING };
    let steps = [(0.0, 0.0), (2.0, 55.0), (9.0, 85.0), (15.0, 30.0), (20.0, 65.0), (27.0, 0.0)];
    Manoeuvre { name: "straight", end_s: 30.0, steps: steps.map(speed).to_vec() }
}

/// Left, right, left at one speed.
fn s_turn() -> Manoeuvre {
    let bend = |(at_s, throttle_percent, front_deg): (f64, f64, f64)| Step {
        at_s,
        throttle_percent,
        front_deg,
        ..STANDING
    };
    let steps = [
        (0.0, 0.0, 0.0),
        (2.0, 55.0, 0.0),
        (4.5, 55.0, 15.0),
        (13.0, 55.0, -15.0),
        (22.0, 55.0, 8.0),
    ];
    let end = bend((28.0, 0.0, 8.0));
    let steps = steps.map(bend).into_iter().chain([end]).collect();
    Manoeuvre { name: "s-turn", end_s: 30.0, steps }
}

/// Speeds, bends and arms at once.
fn mixed() -> Manoeuvre {
    let mut steps = Vec::new();
    for k in 0..16_u8 {
        let at_s = 1.8 * f64::from(k);
        let mut step = Step { at_s, ..STANDING };
        step.throttle_percent = [0.0, 50.0, 75.0, 35.0, 60.0][usize::from(k.div_ceil(4))];
        step.front_deg = [0.0, 11.0, -12.0, 9.0][usize::from(k / 4)];
        for (i, w) in (0_u8..).zip(Wheel::ALL) {
            let up = (k + i) % 3 == 0;
            step.stroke_mm[w] = if up { BASE_MM + 26.0 } else { BASE_MM };
        }
        steps.push(step);
    }
    steps.push(Step { at_s: 28.8, ..STANDING });
    Manoeuvre { name: "mixed", end_s: 31.0, steps }
}
