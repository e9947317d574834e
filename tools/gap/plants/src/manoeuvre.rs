//! The scripted manoeuvres: what the gateway commands over time, amplitudes and times drawn anew.

use std::f64::consts::TAU;

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use xt28_machine::{Machine, PerWheel, Side, Wheel};
use xt28_sim::Ramp;

/// The manoeuvres, as the field's test drivers call them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manoeuvre {
    /// Axles go up and down in large steps, standing.
    ArmStep,
    /// One arm after the other goes up and down, standing.
    SingleArm,
    /// All arms swing by sums of sines, standing.
    Multisine,
    /// Several speeds in a row, straight on.
    Straight,
    /// Left, right, left at one speed.
    STurn,
    /// Over a ramp under the right wheels, arms moved to stay level.
    Ramp,
    /// Speeds, bends and arm steps at once.
    Mixed,
}

/// What the gateway commands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Command {
    /// Whole steps of 2 mm.
    pub(crate) stroke_mm: PerWheel<f64>,
    pub(crate) throttle_percent: f64,
    /// Front joint, deg; left > 0.
    pub(crate) front_deg: f64,
}

/// A manoeuvre with its numbers drawn.
#[derive(Clone, Debug)]
pub(crate) struct Script {
    pub(crate) seconds: f64,
    base_mm: PerWheel<f64>,
    /// Time and strokes from then on.
    steps: Vec<(f64, PerWheel<f64>)>,
    /// Amplitude mm, frequency Hz, phase rad, for each arm.
    sines: PerWheel<[[f64; 3]; 4]>,
    /// Time and throttle, percent, from then on.
    throttle: Vec<(f64, f64)>,
    /// Time and front angle, deg, from then on.
    steer: Vec<(f64, f64)>,
    pub(crate) ramp: Option<Ramp>,
}

impl Manoeuvre {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::ArmStep,
        Self::SingleArm,
        Self::Multisine,
        Self::Straight,
        Self::STurn,
        Self::Ramp,
        Self::Mixed,
    ];

    /// Its name in file names and in `about.toml`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::ArmStep => "arm_step",
            Self::SingleArm => "single_arm",
            Self::Multisine => "multisine",
            Self::Straight => "straight",
            Self::STurn => "s_turn",
            Self::Ramp => "ramp",
            Self::Mixed => "mixed",
        }
    }

    /// Whether its log is meant for fitting rather than for validation.
    #[must_use]
    pub const fn is_for_fitting(self) -> bool {
        !matches!(self, Self::Straight | Self::Mixed)
    }

    /// The manoeuvre with its amplitudes and times drawn from `random`.
    pub(crate) fn script(self, machine: &Machine, random: &mut ChaCha8Rng) -> Script {
        let mut draw = Draw { random };
        match self {
            Self::ArmStep => draw.arm_step(),
            Self::SingleArm => draw.single_arm(),
            Self::Multisine => draw.multisine(),
            Self::Straight => draw.straight(),
            Self::STurn => draw.s_turn(),
            Self::Ramp => draw.ramp(machine),
            Self::Mixed => draw.mixed(),
        }
    }
}

fn even(mm: f64) -> f64 {
    (mm / 2.0).round() * 2.0
}

fn since<T: Copy>(list: &[(f64, T)], time_s: f64) -> Option<T> {
    list.iter().rev().find(|(from_s, _)| *from_s <= time_s).map(|(_, value)| *value)
}

impl Script {
    fn standing(seconds: f64, base_mm: f64) -> Self {
        Self {
            seconds,
            base_mm: PerWheel::splat(base_mm),
            steps: Vec::new(),
            sines: PerWheel::splat([[0.0; 3]; 4]),
            throttle: Vec::new(),
            steer: Vec::new(),
            ramp: None,
        }
    }

    /// What is commanded at `time_s` from the start of the log; before it, as at its start.
    pub(crate) fn at(&self, time_s: f64) -> Command {
        let time_s = time_s.max(0.0);
        let stroke_mm = since(&self.steps, time_s).unwrap_or(self.base_mm);
        Command {
            stroke_mm: PerWheel::from_fn(|wheel| {
                let swing = |[mm, hz, phase]: [f64; 3]| mm * (TAU * hz * time_s + phase).sin();
                let swings: f64 = self.sines[wheel].into_iter().map(swing).sum();
                even(stroke_mm[wheel] + swings).clamp(0.0, 480.0)
            }),
            throttle_percent: since(&self.throttle, time_s).unwrap_or(0.0),
            front_deg: since(&self.steer, time_s).unwrap_or(0.0),
        }
    }
}

struct Draw<'a> {
    random: &'a mut ChaCha8Rng,
}

impl Draw<'_> {
    fn one(&mut self, low: f64, high: f64) -> f64 {
        self.random.random_range(low..high)
    }

    /// In whole hundredths of a second.
    fn time(&mut self, about_s: f64, by_s: f64) -> f64 {
        (self.one(about_s - by_s, about_s + by_s) * 100.0).round() / 100.0
    }

    fn arm_step(&mut self) -> Script {
        let base = even(self.one(50.0, 90.0));
        let mut script = Script::standing(32.0, base);
        let levels = [self.one(170.0, 220.0), self.one(300.0, 360.0), self.one(150.0, 210.0), base];
        // Front and rear together, the middle left where it is: the machine stands on two axles.
        for (i, level) in levels.into_iter().enumerate() {
            let strokes = PerWheel::from_fn(|wheel| match wheel {
                Wheel::Mr | Wheel::Ml => base,
                _ => even(level),
            });
            let at_s = self.time(2.5 + 7.2 * i as f64, 0.5);
            script.steps.push((at_s, strokes));
        }
        script
    }

    fn single_arm(&mut self) -> Script {
        let base = even(self.one(150.0, 190.0));
        let mut script = Script::standing(36.0, base);
        let mut order = Wheel::ALL;
        for i in (1..6).rev() {
            order.swap(i, self.random.random_range(0..=i));
        }
        for (i, wheel) in order.into_iter().enumerate() {
            let mut strokes = script.base_mm;
            strokes[wheel] = even(base + self.one(40.0, 60.0));
            let from_s = self.time(1.8 + 5.7 * i as f64, 0.3);
            script.steps.push((from_s, strokes));
            script.steps.push((self.time(from_s + 3.0, 0.2), script.base_mm));
        }
        script
    }

    fn multisine(&mut self) -> Script {
        let mut script = Script::standing(30.0, even(self.one(160.0, 200.0)));
        script.sines = PerWheel::from_fn(|_| {
            [[10.0, 0.07], [9.0, 0.16], [6.0, 0.31], [4.0, 0.53]].map(|[mm, hz]| {
                [mm * self.one(0.8, 1.3), hz * self.one(0.85, 1.15), self.one(0.0, TAU)]
            })
        });
        script
    }

    fn straight(&mut self) -> Script {
        let mut script = Script::standing(30.0, 170.0);
        let levels = [(50.0, 65.0), (78.0, 92.0), (25.0, 38.0), (55.0, 72.0)];
        let times = [1.9, 9.0, 15.0, 19.5];
        for ((low, high), at_s) in levels.into_iter().zip(times) {
            let percent = self.one(low, high).round();
            script.throttle.push((self.time(at_s, 0.6), percent));
        }
        script.throttle.push((self.time(27.3, 0.3), 0.0));
        script
    }

    fn s_turn(&mut self) -> Script {
        let mut script = Script::standing(30.0, 170.0);
        let percent = self.one(48.0, 60.0).round();
        script.throttle = vec![(self.time(1.8, 0.2), percent), (self.time(28.0, 0.3), 0.0)];
        let turn = if self.random.random_bool(0.5) { 1.0 } else { -1.0 };
        for (at_s, low, high) in [(4.5, 13.0, 17.0), (13.0, -17.0, -13.0), (22.5, 6.0, 10.0)] {
            let deg = turn * self.one(low, high).round();
            script.steer.push((self.time(at_s, 0.6), deg));
        }
        script
    }

    fn ramp(&mut self, machine: &Machine) -> Script {
        let base = even(self.one(200.0, 225.0));
        let mut script = Script::standing(30.0, base);
        let percent = self.one(46.0, 54.0).round();
        let from_s = self.time(1.2, 0.2);
        script.throttle = vec![(from_s, percent), (self.time(28.8, 0.2), 0.0)];
        let foot = self.one(3.5, 5.0);
        let ramp = Ramp {
            x_m: [foot, foot + 3.0, foot + 4.5, foot + 7.5].map(|x| (x * 10.0).round() / 10.0),
            height_m: (self.one(0.22, 0.30) * 100.0).round() / 100.0,
            y_min_m: -1.9,
            y_max_m: -0.5,
        };
        // The driver takes the right arms in as their wheels climb; the eye lags a little.
        let speed_m_s = percent / 100.0 * machine.drive.speed_full_m_s;
        let ratio = machine.linkage().at_stroke(base * 1e-3).force_ratio;
        for tick in 0..3000_u32 {
            let time_s = f64::from(tick) * 0.01;
            if tick % 12 != 0 {
                continue;
            }
            let front_m = speed_m_s * (time_s - from_s - 0.3).max(0.0);
            let strokes = PerWheel::from_fn(|wheel| {
                let x_m = front_m + machine.wheels.axle_x_m[wheel.axle() as usize];
                let under_m =
                    if wheel.side() == Side::Right { ramp.height_m(x_m, -1.2) } else { 0.0 };
                even(base - 0.9e3 * ratio * under_m)
            });
            script.steps.push((time_s, strokes));
        }
        script.ramp = Some(ramp);
        script
    }

    fn mixed(&mut self) -> Script {
        let mut script = Script::standing(32.0, 170.0);
        for (at_s, low, high) in
            [(2.0, 45.0, 55.0), (11.0, 65.0, 80.0), (16.5, 30.0, 40.0), (21.0, 52.0, 65.0)]
        {
            let percent = self.one(low, high).round();
            script.throttle.push((self.time(at_s, 0.5), percent));
        }
        script.throttle.push((self.time(29.0, 0.3), 0.0));
        let turn = if self.random.random_bool(0.5) { 1.0 } else { -1.0 };
        for (at_s, low, high) in
            [(4.0, 9.0, 13.0), (11.0, -15.0, -10.0), (18.0, -0.5, 0.5), (22.0, 7.0, 11.0)]
        {
            let deg = turn * self.one(low, high).round();
            script.steer.push((self.time(at_s, 0.5), deg));
        }
        let mut strokes = script.base_mm;
        let mut at_s = 3.0;
        while at_s < 29.0 {
            let wheel = Wheel::ALL[self.random.random_range(0..6)];
            let sign = if strokes[wheel] > 182.0
                || (strokes[wheel] > 158.0 && self.random.random_bool(0.5))
            {
                -1.0
            } else {
                1.0
            };
            strokes[wheel] = even(strokes[wheel] + sign * self.one(10.0, 18.0));
            script.steps.push(((at_s * 100.0_f64).round() / 100.0, strokes));
            at_s += self.one(0.2, 0.9);
        }
        script
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;

    use super::*;

    #[test]
    fn every_script_stays_within_what_the_wire_and_the_arms_take() {
        let machine = Machine::xt28();
        for seed in 0..20 {
            for manoeuvre in Manoeuvre::ALL {
                let script = manoeuvre.script(&machine, &mut ChaCha8Rng::seed_from_u64(seed));
                assert!((30.0..=36.0).contains(&script.seconds));
                for tick in 0..3600 {
                    let command = script.at(f64::from(tick) * 0.01);
                    for mm in command.stroke_mm.0 {
                        assert!((20.0..=400.0).contains(&mm) && mm % 2.0 == 0.0, "{mm}");
                    }
                    assert!((0.0..=100.0).contains(&command.throttle_percent));
                    assert!(command.front_deg.abs() <= 20.0);
                }
            }
        }
    }

    #[test]
    fn a_script_starts_as_it_stood_and_is_drawn_from_its_seed() {
        let machine = Machine::xt28();
        let script = |seed| Manoeuvre::Mixed.script(&machine, &mut ChaCha8Rng::seed_from_u64(seed));
        assert_eq!(script(1).at(-3.0), script(1).at(0.0));
        assert_eq!(script(1).at(20.0), script(1).at(20.0));
        assert_ne!(script(1).at(20.0), script(2).at(20.0));
    }
}
