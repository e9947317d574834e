//! A row of the table: an effect in force, what it must show, what must stay.

use core::ops::Range;
use std::rc::Rc;
use std::sync::LazyLock;

use xt28_machine::{Machine, Wheel};
use xt28_sim::effects::{Scope, find};
use xt28_sim::{Bodies, Effects, STEP, VehicleState};

use crate::scene::{Scene, step_at};

/// The nominal machine, read once.
pub(crate) static MACHINE: LazyLock<Machine> = LazyLock::new(Machine::xt28);

/// Some numbers of a state.
pub(crate) type Signal = fn(&VehicleState) -> Vec<f64>;
/// Names and values of an effect's parameters.
pub(crate) type Values = &'static [(&'static str, f64)];

/// A number seen, and what the law has it be.
#[derive(Clone)]
pub(crate) struct Size {
    pub(crate) what: String,
    pub(crate) is: f64,
    pub(crate) wanted: f64,
    pub(crate) within: f64,
}

impl Size {
    pub(crate) fn new(what: impl ToString, is: f64, wanted: f64, within: f64) -> Self {
        Self { what: what.to_string(), is, wanted, within }
    }

    /// What is to say of it if it is not as wanted; what is no number never is.
    fn off(&self) -> Option<String> {
        let Self { what, is, wanted, within } = self;
        let holds = (is - wanted).abs() <= *within;
        (!holds).then(|| format!("{what}: {is}, not {wanted} within {within}"))
    }
}

/// What an effect must leave alone.
#[derive(Clone, Copy)]
pub(crate) enum Stay {
    /// The whole state while the machine does this, to the bit.
    ToTheBit(Scene),
    /// The same in the row's own scene, until this time, s.
    ToTheBitUntil(f64),
    /// The same, but for where the antenna is and how it moves.
    AllButAntenna(Scene),
    /// This signal in the row's own scene between these times, s, by no more than this.
    Within(&'static str, Signal, [f64; 2], f64),
}

/// What the two machines did, with the effect and without.
pub(crate) struct Seen {
    pub(crate) machine: &'static Machine,
    pub(crate) without: Rc<Vec<VehicleState>>,
    pub(crate) with: Rc<Vec<VehicleState>>,
}

impl Seen {
    /// Steps that end in this span of time.
    pub(crate) fn steps([from_s, to_s]: [f64; 2]) -> Range<usize> {
        step_at(from_s)..step_at(to_s)
    }

    /// Mean of a number of the states between two times, without the effect and with it.
    pub(crate) fn means(&self, between_s: [f64; 2], of: impl Fn(&VehicleState) -> f64) -> [f64; 2] {
        let range = Self::steps(between_s);
        [&self.without, &self.with]
            .map(|states| states[range.clone()].iter().map(&of).sum::<f64>() / range.len() as f64)
    }

    /// Way that the mean wheel has rolled by this time, m, without the effect and with it.
    pub(crate) fn rolled_m(&self, to_s: f64) -> [f64; 2] {
        let per_step_m = STEP.as_secs_f64() * self.machine.wheels.radius_m;
        [&self.without, &self.with].map(|states| {
            states[..step_at(to_s)].iter().map(|s| s.wheel_speed_rad_s.mean()).sum::<f64>()
                * per_step_m
        })
    }

    /// Most that a signal differs between the two machines.
    fn apart(&self, signal: Signal, between_s: [f64; 2]) -> f64 {
        let range = Self::steps(between_s);
        let both = self.without[range.clone()].iter().zip(&self.with[range]);
        let apart = both
            .flat_map(|(a, b)| signal(a).into_iter().zip(signal(b)).map(|(a, b)| (a - b).abs()));
        apart.fold(0.0, f64::max)
    }
}

/// One effect, at one set of values.
#[derive(Clone, Copy)]
pub(crate) struct Row {
    pub(crate) effect: &'static str,
    pub(crate) scope: &'static str,
    pub(crate) values: Values,
    /// Effects that both machines have.
    pub(crate) both: &'static [(&'static str, Values)],
    pub(crate) scene: Scene,
    pub(crate) shows: Option<fn(&Seen) -> Vec<Size>>,
    pub(crate) stays: &'static [Stay],
}

impl Row {
    /// A row of the whole machine with neither size nor bound.
    pub(crate) const fn new(effect: &'static str, values: Values, scene: Scene) -> Self {
        Self { effect, scope: "all", values, both: &[], scene, shows: None, stays: &[] }
    }

    fn effects(&self) -> [Effects; 2] {
        let mut without = Effects::default();
        for (name, values) in self.both {
            set(&mut without, name, Scope::All, values);
        }
        let mut with = without.clone();
        set(&mut with, self.effect, self.scope.parse().unwrap(), self.values);
        assert_ne!(with, without, "{}", self.effect);
        [without, with]
    }

    /// What is not as the row has it.
    pub(crate) fn off<B: Bodies>(&self, runs: &mut Runs) -> Vec<String> {
        let [without, with] = self.effects();
        let mut states =
            |scene: Scene| [runs.states::<B>(scene, &without), Rc::new(scene.states::<B>(&with))];
        let [without, with] = states(self.scene);
        let seen = Seen { machine: &MACHINE, without, with };
        let sizes = self.shows.map(|shows| shows(&seen)).unwrap_or_default();
        let mut off: Vec<String> = sizes.iter().filter_map(Size::off).collect();
        for stay in self.stays {
            match *stay {
                Stay::ToTheBit(scene) => {
                    let [without, with] = states(scene);
                    off.extend((without != with).then(|| format!("shows in {scene:?}")));
                }
                Stay::ToTheBitUntil(t_s) => {
                    let range = ..=step_at(t_s);
                    let differs = seen.without[range] != seen.with[range];
                    off.extend(differs.then(|| format!("shows before {t_s} s")));
                }
                Stay::AllButAntenna(scene) => {
                    let [without, with] = states(scene).map(|states| without_antenna(&states));
                    off.extend((without != with).then(|| format!("shows in {scene:?}")));
                }
                Stay::Within(what, signal, between_s, bound) => {
                    let apart = seen.apart(signal, between_s);
                    off.extend((apart > bound).then(|| format!("{what} is {apart:e} off")));
                }
            }
        }
        off.iter().map(|off| format!("{} {:?}: {off}", self.effect, self.values)).collect()
    }
}

fn set(effects: &mut Effects, name: &str, scope: Scope, values: Values) {
    let effect = find(name).expect("the effect is in the catalogue");
    for (key, value) in values {
        effect.parameter(key).expect("the effect has the parameter").set(effects, scope, *value);
    }
}

/// States of which the antenna's own are not looked at.
fn without_antenna(states: &[VehicleState]) -> Vec<VehicleState> {
    let (antenna_position_m, antenna_velocity_m_s) = ([0.0; 3], [0.0; 3]);
    let away = |s: &VehicleState| VehicleState { antenna_position_m, antenna_velocity_m_s, ..*s };
    states.iter().map(away).collect()
}

/// Runs of machines without a row's effect, each made once for all rows of a solver.
#[derive(Default)]
pub(crate) struct Runs {
    made: Vec<(Scene, Effects, Rc<Vec<VehicleState>>)>,
}

impl Runs {
    fn states<B: Bodies>(&mut self, scene: Scene, effects: &Effects) -> Rc<Vec<VehicleState>> {
        let known = self.made.iter().find(|(of, by, _)| *of == scene && by == effects);
        if let Some((.., states)) = known {
            return Rc::clone(states);
        }
        let states = Rc::new(scene.states::<B>(effects));
        self.made.push((scene, effects.clone(), Rc::clone(&states)));
        states
    }
}

/// Wheels of a scope, by its name.
pub(crate) fn wheels(scope: &str) -> impl Iterator<Item = Wheel> {
    scope.parse::<Scope>().expect("a scope").wheels()
}

/// Angles of both joints, rad.
pub(crate) fn joints_rad(s: &VehicleState) -> Vec<f64> {
    s.joint_rad.to_vec()
}

/// Strokes, m.
pub(crate) fn strokes_m(s: &VehicleState) -> Vec<f64> {
    s.stroke_m.0.to_vec()
}

/// Speed of the mean wheel, rad/s.
pub(crate) fn mean_speed_rad_s(s: &VehicleState) -> Vec<f64> {
    vec![s.wheel_speed_rad_s.mean()]
}
