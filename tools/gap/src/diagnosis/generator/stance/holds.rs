//! How hard idle motors hold their wheels: each against its own turning, all together against what the
//! ground's slope pulls and the pumps do not push, and against the machine's inertia.
//!
//! An arm that swings at standstill wants its wheel to roll. The machine moves to where the wheels'
//! holds balance, so that each wheel rolls by its arm's swing less that of all. A hold builds up over
//! a little rolling, then slips, and stays when the arms come to rest. Wheel speeds are read too
//! coarsely for this (7 mm/s at the rim), strokes are not. On tyres that creep a wheel that is held
//! slips all the while that arms swing, and that its speed does tell.

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Wheel};
use xt28_sim::{Effects, Parts};

use super::instants::pump_torque_nm;
use super::motion::{lagged, unflickered};
use crate::diagnosis::generator::grade::{Grade, climbs};
use crate::diagnosis::generator::press::{normal_n, own_n};
use crate::diagnosis::kinematics::swung_m;
use crate::diagnosis::signals::{DT_S, Samples, Signals};

/// Rolling over which a hold builds up, m (assumed).
const YIELDS_M: f64 = 0.001;
/// Speed of the wheels, all together, at which the machine travels, rad/s (2 cm/s at the rim), and the
/// samples until it has come to rest after that. A machine that brakes is held by all of its wheels.
const TRAVELS_RAD_S: f64 = 0.03;
const COMES_TO_REST: usize = 100;
/// Swing after which the wheels are held by that alone, m.
const SWUNG_M: f64 = 2.0 * YIELDS_M;
/// Samples of the log from one step to the next.
const SAMPLES_PER_STEP: usize = 5;
const STEP_S: f64 = SAMPLES_PER_STEP as f64 * DT_S;
/// Halvings in which the holds are balanced: to a millionth.
const BISECTIONS: usize = 20;

/// Wheels that idle motors hold over a run, on tyres of which nothing is said yet.
pub(in crate::diagnosis::generator) struct Held<'a> {
    s: &'a Signals,
    radius_m: f64,
    /// Most that each motor holds by, Nm.
    most_nm: PerWheel<f64>,
    rims: PerWheel<Rim>,
    /// Torque on all wheels that the ground's slope asks for, step by step, Nm.
    pulled_nm: Samples,
    /// Torque on all wheels that moves the machine by [`YIELDS_M`] in a step from rest, Nm.
    inertia_nm: f64,
    /// Rolling resistance as a share of the grip.
    resisting: f64,
}

/// How each wheel is held, step by step.
pub(in crate::diagnosis::generator) struct Holds {
    /// Share of its most, -1 to 1, forward where it rolled forward.
    steps: Vec<PerWheel<f64>>,
    /// Speed at which its foot slips forward, m/s.
    slips_m_s: Vec<PerWheel<f64>>,
}

/// What a log says of one wheel, step by step.
struct Rim {
    /// How far the wheel would have rolled beside its arm by the arm's swing, m.
    swing_m: Samples,
    /// Torque at which it slips, Nm.
    grip_nm: Samples,
    /// Torque that the pumps make, Nm.
    pushed_nm: Samples,
}

impl<'a> Held<'a> {
    /// Wheels with what `effects` say of the motors, `late_s` behind the strokes; none where no motor holds.
    pub(in crate::diagnosis::generator) fn new(
        s: &'a Signals,
        machine: &Machine,
        effects: &Effects,
        parts: &Parts,
        late_s: f64,
    ) -> Option<Self> {
        let most_nm = PerWheel::from_fn(|w| effects.wheels[w].standstill_drag.torque_nm.abs());
        if most_nm.iter().all(|(_, nm)| *nm == 0.0) {
            return None;
        }
        let mass_kg = machine.mass_kg() + effects.masses.payload.mass_kg;
        let pull_nm = mass_kg * GRAVITY_M_S2 * parts.radius_m;
        let ground = Grade::believed(s, effects).unwrap_or_default();
        let pulled_nm = |i| pull_nm * climbs(s, machine, effects, ground, i);
        Some(Self {
            s,
            radius_m: parts.radius_m,
            most_nm,
            rims: PerWheel::from_fn(|w| Rim::new(s, machine, parts, w, late_s)),
            pulled_nm: (0..s.len).step_by(SAMPLES_PER_STEP).map(pulled_nm).collect(),
            inertia_nm: mass_kg * parts.radius_m * YIELDS_M / STEP_S.powi(2),
            resisting: machine.wheels.rolling_resistance / machine.wheels.friction,
        })
    }

    /// How they are held on tyres that give way to a force along the ground by `creep_m_s_n` m/s/N.
    pub(in crate::diagnosis::generator) fn on(&self, creep_m_s_n: f64) -> Holds {
        let (s, none) = (self.s, PerWheel::splat(0.0));
        let (mut held, mut resting, mut swung_m) = (none, COMES_TO_REST, 0.0_f64);
        let mut backs = 0.0;
        let mut holds = Holds { steps: vec![none], slips_m_s: vec![none] };
        for (k, i) in (0..s.len).step_by(SAMPLES_PER_STEP).enumerate().skip(1) {
            let travels = s.throttle[i] != 0.0 || s.mean_wheel_speed_rad_s(i).abs() > TRAVELS_RAD_S;
            resting = if travels { 0 } else { resting + SAMPLES_PER_STEP };
            if resting <= COMES_TO_REST {
                (held, swung_m, backs) = (none, 0.0, 0.0);
                holds.push(none, none);
                continue;
            }
            let rims = &self.rims;
            let swing = PerWheel::from_fn(|w| rims[w].swing_m[k] - rims[w].swing_m[k - 1]);
            swung_m += swing.iter().map(|(_, m)| m.abs()).fold(0.0, f64::max);
            let wanted = PerWheel::from_fn(|w| held[w] + swing[w] / YIELDS_M);
            let most_nm = PerWheel::from_fn(|w| self.most_nm[w].min(rims[w].grip_nm[k]));
            let weight_nm = PerWheel::from_fn(|w| most_nm[w] + self.resisting * rims[w].grip_nm[k]);
            let pushed_nm: f64 = rims.iter().map(|(_, rim)| rim.pushed_nm[k]).sum();
            let by_m_s = creep_m_s_n / self.radius_m;
            let yields = PerWheel::from_fn(|w| 1.0 + by_m_s * weight_nm[w] * STEP_S / YIELDS_M);
            let pushed = Pushed {
                sum_nm: pushed_nm - self.pulled_nm[k],
                inertia_nm: self.inertia_nm,
                backs,
            };
            (held, backs) = balanced(&wanted, &yields, &weight_nm, &pushed);
            // How the wheels were held when they came to rest is not known.
            let known = if swung_m > SWUNG_M { held } else { none };
            // What holds a wheel back from rolling forward drags its foot backward.
            let slips_m_s = PerWheel::from_fn(|w| -by_m_s * held[w] * most_nm[w]);
            holds.push(known, slips_m_s);
        }
        holds
    }
}

impl Holds {
    fn push(&mut self, shares: PerWheel<f64>, slips_m_s: PerWheel<f64>) {
        self.steps.push(shares);
        self.slips_m_s.push(slips_m_s);
    }

    /// Shares at a sample of the log.
    pub(super) fn at(&self, sample: usize) -> PerWheel<f64> {
        self.steps[(sample / SAMPLES_PER_STEP).min(self.steps.len() - 1)]
    }

    /// Speed at which each wheel's foot slips forward at a sample of the log, m/s.
    pub(in crate::diagnosis::generator) fn slips_m_s(&self, sample: usize) -> PerWheel<f64> {
        self.slips_m_s[(sample / SAMPLES_PER_STEP).min(self.slips_m_s.len() - 1)]
    }
}

impl Rim {
    fn new(s: &Signals, machine: &Machine, parts: &Parts, wheel: Wheel, late_s: f64) -> Self {
        let late = |samples: Samples| lagged(samples.into_iter(), late_s);
        let arm = &parts.arms[wheel];
        let own_n = own_n(machine, parts, wheel);
        let slips_m = machine.wheels.friction * parts.radius_m;
        let stroke_m = late(unflickered(&s.smooth_stroke_m[wheel]));
        let loads_n = s.cylinder_load_n[wheel].iter();
        let steps =
            stroke_m.iter().zip(loads_n).step_by(SAMPLES_PER_STEP).map(|(stroke_m, load_n)| {
                let pose = parts.linkage.at_stroke(*stroke_m);
                let turned_m = swung_m(arm.extends, parts.radius_m, &pose);
                (turned_m, slips_m * normal_n(own_n, *load_n, &pose))
            });
        let (swing_m, grip_nm) = steps.unzip();
        let pushed_nm = late(pump_torque_nm(s, machine, wheel));
        Self {
            swing_m,
            grip_nm,
            pushed_nm: pushed_nm.into_iter().step_by(SAMPLES_PER_STEP).collect(),
        }
    }
}

/// What moves a machine beside the holds of its wheels.
struct Pushed {
    /// Torque on all wheels that drives it forward, Nm.
    sum_nm: f64,
    /// Torque that moves it by one [`YIELDS_M`] more in this step than in the last, Nm.
    inertia_nm: f64,
    /// How far it backed in the last step, as a share of [`YIELDS_M`].
    backs: f64,
}

/// Shares nearest to `wanted`, all less by what the machine backs in this step, so that their torques balance
/// what pushes it and its inertia; and how far it backs. Tyres that creep hold so many times less as `yields`
/// says.
fn balanced(
    wanted: &PerWheel<f64>,
    yields: &PerWheel<f64>,
    weight_nm: &PerWheel<f64>,
    pushed: &Pushed,
) -> (PerWheel<f64>, f64) {
    let less = |by: f64| PerWheel::from_fn(|w| ((wanted[w] - by) / yields[w]).clamp(-1.0, 1.0));
    let excess_nm = |by: f64| {
        let held_nm: f64 = less(by).iter().map(|(w, share)| share * weight_nm[w]).sum();
        held_nm - pushed.sum_nm - pushed.inertia_nm * (by - pushed.backs)
    };
    let reach = yields.iter().map(|(_, times)| *times).fold(1.0, f64::max)
        + wanted.iter().map(|(_, share)| share.abs()).fold(pushed.backs.abs(), f64::max);
    let (mut low, mut high) = (-reach, reach);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if excess_nm(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let by = 0.5 * (low + high);
    (less(by), by)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RIGID: PerWheel<f64> = PerWheel([1.0; 6]);
    /// Nothing pushes, and nothing weighs.
    const LIGHT: Pushed = Pushed { sum_nm: 0.0, inertia_nm: 0.0, backs: 0.0 };

    #[test]
    fn tyres_that_creep_let_go() {
        let wanted = PerWheel([0.9, 0.9, 0.0, 0.0, -0.9, -0.9]);
        let held = balanced(&wanted, &PerWheel::splat(3.0), &PerWheel::splat(4e3), &LIGHT).0;
        assert!((held[Wheel::Fr] - 0.3).abs() < 1e-4 && (held[Wheel::Bl] + 0.3).abs() < 1e-4);
    }

    #[test]
    fn wheels_that_want_the_same_move_the_machine_and_are_not_held() {
        let held = balanced(&PerWheel::splat(3.0), &RIGID, &PerWheel::splat(4e3), &LIGHT).0;
        assert!(held.iter().all(|(_, share)| share.abs() < 1e-4), "{held:?}");
    }

    #[test]
    fn wheels_that_want_to_part_are_held_against_each_other() {
        let wanted = PerWheel([2.0, 2.0, 0.0, 0.0, -2.0, -2.0]);
        let held = balanced(&wanted, &RIGID, &PerWheel::splat(4e3), &LIGHT).0;
        assert!(held[Wheel::Fr] > 0.99 && held[Wheel::Bl] < -0.99, "{held:?}");
        assert!(held[Wheel::Mr].abs() < 1e-4, "{held:?}");
    }

    #[test]
    fn a_wheel_held_alone_moves_the_machine() {
        let weight = PerWheel::from_fn(|w| if w == Wheel::Fr { 4e3 } else { 0.0 });
        let wanted = PerWheel([2.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(balanced(&wanted, &RIGID, &weight, &LIGHT).0[Wheel::Fr].abs() < 1e-4);
    }

    #[test]
    fn a_machine_that_weighs_is_held_by_one_wheel_until_it_moves() {
        let weight = PerWheel::from_fn(|w| if w == Wheel::Fr { 4e3 } else { 0.0 });
        let (mut held, mut backs) = (PerWheel::splat(0.0), 0.0);
        let step = |held: PerWheel<f64>, backs| {
            let swung = PerWheel::from_fn(|w| held[w] + 0.2);
            balanced(&swung, &RIGID, &weight, &Pushed { inertia_nm: 4e3, backs, ..LIGHT })
        };
        (held, backs) = step(held, backs);
        assert!((held[Wheel::Fr] - 0.1).abs() < 1e-4 && (backs - 0.1).abs() < 1e-4);
        for _ in 0..40 {
            (held, backs) = step(held, backs);
        }
        assert!(held[Wheel::Fr].abs() < 1e-2 && (backs - 0.2).abs() < 1e-2, "{held:?} {backs}");
    }
}
