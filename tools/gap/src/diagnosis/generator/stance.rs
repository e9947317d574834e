//! How the machine stands on its six wheels: attitude from strokes, weight and its middle from loads,
//! and whether every wheel either touches the ground or carries nothing.

mod beside;
mod carried;
mod filter;
mod followed;
mod holds;
mod instants;
mod layout;
mod lean;
mod motion;
mod plane;
mod strained;
mod sway;

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Wheel};
use xt28_sim::Parts;

use crate::diagnosis::belief::EffectSchedule;
use crate::diagnosis::floor::Signal;
use crate::diagnosis::generator::grade::Grade;
use crate::diagnosis::instant::Instant;
use crate::diagnosis::signals::{DT_S, Samples, Signals};
use beside::Beside;
use carried::Carrier;
pub(super) use holds::{Held, Holds};
use instants::{PRESSURE_FILTER_S, STANDING};
use layout::{Layout, Reach};
pub(super) use lean::antenna_leans_m;
use plane::{Foot, Plane};

/// Standing errors over a run, ten a second; `NaN` where nothing can be said. Attitude and weight are
/// taken for less while arms move.
#[derive(Clone, Debug)]
pub(super) struct StanceErrors {
    /// Roll that the strokes say less the roll measured, rad.
    pub(super) roll_rad: Samples,
    /// Pitch that the strokes say less the pitch measured, rad.
    pub(super) pitch_rad: Samples,
    /// Weight of the machine less what the cylinders carry, N.
    pub(super) weight_n: Samples,
    /// Where the weight should act, forward, less where the cylinders say, m.
    pub(super) weight_x_m: Samples,
    /// The same, left.
    pub(super) weight_y_m: Samples,
    /// How each wheel breaks the rule that it touches the ground or carries nothing, m.
    pub(super) contact_m: PerWheel<Samples>,
    /// Roll that the strokes say less the roll measured, as it changes within seconds, rad.
    pub(super) roll_sway_rad: Samples,
    /// The same of pitch, rad.
    pub(super) pitch_sway_rad: Samples,
}

impl StanceErrors {
    /// Each beside its signal.
    pub(super) fn by_signal(self) -> impl Iterator<Item = (Signal, Samples)> {
        let whole = [
            (Signal::Roll, self.roll_rad),
            (Signal::Pitch, self.pitch_rad),
            (Signal::Weight, self.weight_n),
            (Signal::WeightX, self.weight_x_m),
            (Signal::WeightY, self.weight_y_m),
            (Signal::RollSway, self.roll_sway_rad),
            (Signal::PitchSway, self.pitch_sway_rad),
        ];
        let feet = Wheel::ALL.into_iter().map(Signal::Contact).zip(self.contact_m.0);
        whole.into_iter().chain(feet)
    }
}

/// Errors of one instant, in the order of [`StanceErrors`].
struct Error {
    attitude_rad: [f64; 2],
    weight: [f64; 3],
    contact_m: PerWheel<f64>,
    /// Roll and pitch as [`StanceErrors`] has them, but whatever moves.
    lean_rad: [f64; 2],
}

/// How much more doubtful the place of the weight is while wheels roll: whether rolling resistance acts
/// between wheel and arm or between wheel and ground moves it by 15 mm, and plants differ in that.
const ROLLING_DOUBT: f64 = 2.0;

/// Shares of the rolling resistance that wheel and arm may have between them: all, as a bearing, or none, as the
/// ground. No log says which, and a higher coefficient moves weight between the arms by it.
const INNER_SHARES: [f64; 3] = [1.0, 0.5, 0.0];
/// How fast a wheel's foot may give way to a force along the ground, m/s/N: not at all, as friction does on
/// the labelled machines of a second plant (0.1 m/s at 10 kNm), or as in a rigid-body engine whose friction damps
/// by 60 kN s/m below its cone.
const CREEPS_M_S_N: [f64; 3] = [0.0, 7.0e-6, 1.7e-5];
/// Roll against the ground from which wheels without give push against one another as hard as the ground grips, rad
/// (assumed; how much wider the machine stands goes with the square).
const ROLLED_RAD: f64 = 0.035;
/// What nothing can be said of: the ground is not level, pressures do not say it, brakes hold wheels
/// against their arms, the machine is on fewer than three wheels.
const UNKNOWN: Error = Error {
    attitude_rad: [f64::NAN; 2],
    weight: [f64::NAN; 3],
    contact_m: PerWheel([f64::NAN; 6]),
    lean_rad: [f64::NAN; 2],
};

/// When that was read which the stance says of `signal` at `at_s`, s: it is looked at twice a second, its
/// sway four times.
pub(super) fn read_at_s(signal: Signal, at_s: f64) -> f64 {
    match signal {
        Signal::RollSway | Signal::PitchSway => instants::read_at_s(1, at_s),
        _ => instants::read_at_s(STANDING, at_s),
    }
}

/// Stance over a run, as what was believed then has it: what sways is told beside what was before.
#[must_use]
pub(super) fn stance_errors(
    s: &Signals,
    machine: &Machine,
    schedule: EffectSchedule<'_>,
) -> StanceErrors {
    let instants = s.instants(|| instants::instants(s, machine));
    let each = Beside::each(s, schedule).into_iter().map(|beside| {
        let mut all = errors(s, machine, schedule, &beside, instants);
        // Tyres that go soft underway let the machine down, and no more than that.
        if let Some((earlier, until_s)) = schedule.earlier() {
            let then = instants.iter().take_while(|i| i.sample as f64 * DT_S < until_s);
            let before = errors(s, machine, earlier, &beside, instants);
            all.iter_mut().zip(before).zip(then).for_each(|((is, was), _)| *is = was);
        }
        all
    });
    let errors = each.min_by(|a, b| tilted(a).total_cmp(&tilted(b))).unwrap_or_default();
    let of = |value: &dyn Fn(&Error) -> f64| {
        let standing: Samples = errors.iter().step_by(STANDING).map(value).collect();
        instants::held_between(&standing, STANDING, s.len)
    };
    let [roll_sway_rad, pitch_sway_rad] = [0, 1].map(|angle| {
        let leans = errors.iter().map(|e| e.lean_rad[angle]);
        let sways_rad = sway::sways_rad(leans.zip(instants.iter().map(|i| i.is_calm)));
        instants::held_between(&sways_rad, 1, s.len)
    });
    StanceErrors {
        roll_rad: of(&|e| e.attitude_rad[0]),
        pitch_rad: of(&|e| e.attitude_rad[1]),
        weight_n: of(&|e| e.weight[0]),
        weight_x_m: of(&|e| e.weight[1]),
        weight_y_m: of(&|e| e.weight[2]),
        contact_m: PerWheel::from_fn(|w| of(&|e| e.contact_m[w])),
        roll_sway_rad,
        pitch_sway_rad,
    }
}

/// Errors of every instant, with the ground and the inertial unit's mount as `beside` has them.
fn errors(
    s: &Signals,
    machine: &Machine,
    schedule: EffectSchedule<'_>,
    beside: &Beside,
    instants: &[Instant],
) -> Vec<Error> {
    let effects = schedule.effects;
    let parts = Parts::new(machine, effects);
    let known = Grade::known(s);
    let mut carriers = INNER_SHARES.map(|inner_share| {
        PerWheel::from_fn(|w| Carrier::new(s, machine, schedule, &parts, w, inner_share))
    });
    let carried = |carriers: &PerWheel<Carrier>, holds: Option<&Holds>, instant: &Instant| {
        let ground_rad = beside.ground_rad(instant.sample, instant.heading);
        let Some(ground_rad) = ground_rad.filter(|_| instant.is_read && instant.rolls_freely)
        else {
            return UNKNOWN;
        };
        let held = holds.map_or(PerWheel::splat(0.0), |holds| holds.at(instant.sample));
        let arms = PerWheel::from_fn(|w| carriers[w].at(instant, held[w]));
        let beside_rad = [ground_rad, beside.mount_rad(instant.sample)];
        // By what is known of the ground alone: what is believed of it may not make room for other beliefs.
        let known_rad = known.map_or(0.0, |known| known.attitude_rad(instant.heading)[1]);
        judge(instant, &arms, &parts, machine, beside_rad, known_rad).unwrap_or(UNKNOWN)
    };
    strain(&mut carriers, |carriers| {
        let first = instants.iter().take_while(|instant| strained::begins(instant.sample));
        first.map(|instant| carried(carriers, None, instant)).collect()
    });
    let carried_by = |carriers: &PerWheel<Carrier>, holds: Option<&Holds>| -> Vec<Error> {
        instants.iter().map(|instant| carried(carriers, holds, instant)).collect()
    };
    let rolls_hard = effects.wheels.iter().any(|(_, e)| e.rolling_resistance.added != 0.0);
    let inner_shares = if rolls_hard { &carriers[..] } else { &carriers[..1] };
    let held_by = |holds: Option<&Holds>| {
        let each = inner_shares.iter().map(|carriers| carried_by(carriers, holds));
        each.min_by(|a, b| left(a).total_cmp(&left(b))).unwrap_or_default()
    };
    // No log says how its tyres creep. What the holds of its motors leave does.
    let held = Held::new(s, machine, effects, &parts, PRESSURE_FILTER_S);
    held.iter()
        .flat_map(|held| CREEPS_M_S_N.map(|creep_m_s_n| held.on(creep_m_s_n)))
        .map(|holds| held_by(Some(&holds)))
        .min_by(|a, b| left(a).total_cmp(&left(b)))
        .unwrap_or_else(|| held_by(None))
}

/// Has the seals hold as the log begins what leaves least then of the weight and its place; `judge` says the errors
/// of its first seconds.
fn strain<'a>(
    carriers: &mut [PerWheel<Carrier<'a>>; 3],
    judge: impl Fn(&PerWheel<Carrier<'a>>) -> Vec<Error>,
) {
    let most_n = PerWheel::from_fn(|w| carriers[0][w].seal.most_n);
    if most_n.iter().all(|(_, most_n)| *most_n == 0.0) {
        return;
    }
    let hold = |carriers: &mut PerWheel<Carrier<'a>>, begins_n: &PerWheel<f64>| {
        Wheel::ALL.into_iter().for_each(|w| carriers[w].seal.begins_n = begins_n[w]);
    };
    let mut trial = carriers[0].clone();
    let begins_n = strained::begun_n(&most_n, |begins_n| {
        hold(&mut trial, begins_n);
        let weights = judge(&trial).into_iter().step_by(STANDING).map(|error| error.weight);
        let signals = [Signal::Weight, Signal::WeightX, Signal::WeightY];
        weights.flat_map(|w| [0, 1, 2].map(|k| w[k] / signals[k].floor().sigma)).collect()
    });
    carriers.iter_mut().for_each(|carriers| hold(carriers, &begins_n));
}

/// One instant, with where each wheel is and what it presses on the ground; how far the ground has the nose and the
/// left side up; the roll and pitch by which the inertial unit's mount has the attitude off; and how far the ground is
/// known to have the left side up.
fn judge(
    instant: &Instant,
    arms: &PerWheel<(Reach, f64)>,
    parts: &Parts,
    machine: &Machine,
    [[nose_rad, left_rad], [off_roll_rad, off_pitch_rad]]: [[f64; 2]; 2],
    known_rad: f64,
) -> Option<Error> {
    let reaches = PerWheel::from_fn(|w| arms[w].0);
    let layout = Layout::new(parts, machine, instant.joint_rad, &reaches);
    let feet = PerWheel::from_fn(|w| {
        let ([x, y, z], normal_n) = (layout.contact_m[w], arms[w].1);
        let sag_m = normal_n.max(0.0) / parts.tyres[w].stiffness_n_m;
        Foot { at_m: [x, y], ground_m: z + sag_m, normal_n }
    });
    let plane = Plane::through(&feet)?;
    let contact_m = PerWheel::from_fn(|w| plane.error_m(&feet[w]));
    // What the unit feels of a turn, leaning as it is mounted on a frame that leans: right side high is a turn
    // against the ahead axis, nose up one against the left.
    let [about_ahead, about_left] = [plane.slope_x - off_pitch_rad, plane.slope_y + off_roll_rad];
    let roll = instant.attitude_rad[0] - off_roll_rad - instant.turned_rad[0] * about_ahead;
    let pitch = instant.attitude_rad[1] - off_pitch_rad - instant.turned_rad[1] * about_left;
    let lean_rad = [plane.slope_y - left_rad - roll, nose_rad - plane.slope_x - pitch];
    if !instant.is_calm {
        return Some(Error { contact_m, lean_rad, ..UNKNOWN });
    }
    let [left, ahead] = instant.acceleration_m_s2.map(|a| a / GRAVITY_M_S2);
    let lean = [roll.tan() - left, -pitch.tan() - ahead];
    let weight_n = GRAVITY_M_S2
        * (parts.frames.iter().map(|f| f.mass_kg).sum::<f64>()
            + 6.0 * parts.wheel.mass_kg
            + parts.arms.iter().map(|(_, a)| a.body.mass_kg).sum::<f64>());
    let mut weight = weigh(&feet, &layout, plane, parts.radius_m, lean, weight_n);
    let wedged_m = wedged_m(machine, plane, known_rad);
    weight[2] = (weight[2].abs() - wedged_m).max(0.0).copysign(weight[2]);
    let rolls = instant.wheels.iter().map(|(_, wheel)| wheel.rolls.abs()).sum::<f64>() / 6.0;
    weight[1] /= 1.0 + ROLLING_DOUBT * rolls;
    Some(Error {
        attitude_rad: lean_rad.map(|error| error / instant.doubt),
        weight: weight.map(|error| error / instant.doubt),
        contact_m,
        lean_rad,
    })
}

/// How far the place of the weight may be moved aside by wheels that push against one another along the ground, m.
///
/// A machine that arms have rolled against its ground stands wider on it. Wheels that do not give way sideways then
/// press the ground apart by up to what its grip holds, and on a cross slope those of one side do so higher than those
/// of the other. No log says whether they do; standing as the ground does they do not.
fn wedged_m(machine: &Machine, plane: Plane, left_rad: f64) -> f64 {
    let rolled = (plane.slope_y / ROLLED_RAD).powi(2).min(1.0);
    rolled * 0.5 * machine.wheels.friction * machine.wheels.track_m * left_rad.tan().abs()
}

/// Squares of what is left of weight and attitude, each in units of what it may be off.
fn left(errors: &[Error]) -> f64 {
    let square = |error: f64, signal: Signal| {
        if error.is_finite() { (error / signal.floor().sigma).powi(2) } else { 0.0 }
    };
    let of = |error: &Error| {
        let [newtons, ahead_m, left_m] = error.weight;
        square(newtons, Signal::Weight)
            + square(ahead_m, Signal::WeightX)
            + square(left_m, Signal::WeightY)
            + square(error.attitude_rad[1], Signal::Pitch)
    };
    errors.iter().step_by(STANDING).map(of).sum()
}

/// Squares of what is left of the attitude.
fn tilted(errors: &[Error]) -> f64 {
    let lean_rad = errors.iter().flat_map(|error| error.lean_rad).filter(|lean| lean.is_finite());
    lean_rad.map(|lean| lean * lean).sum()
}

/// Weight less what the wheels carry, N, and where it should act less where they say, m.
///
/// The weight meets the ground below the middle of all masses along the plumb line, which leans in the
/// machine's axes by `lean` (to the left, forward). A slope needs no more than that. A round wheel of
/// a leaning machine touches beside the point that is lowest in the machine's axes.
fn weigh(
    feet: &PerWheel<Foot>,
    layout: &Layout,
    plane: Plane,
    radius_m: f64,
    [left, ahead]: [f64; 2],
    weight_n: f64,
) -> [f64; 3] {
    let (mut sum_n, mut moment) = (0.0, [0.0; 2]);
    let aside_m = [radius_m * plane.slope_x, radius_m * plane.slope_y];
    for (_, foot) in feet.iter() {
        sum_n += foot.normal_n;
        moment = [0, 1].map(|k| moment[k] + foot.normal_n * (foot.at_m[k] + aside_m[k]));
    }
    let [x, y, z] = layout.com_m;
    let high_m = z - plane.height_m([x, y]);
    // Over the weight that is believed: a sum of no loads at all divides nothing.
    let [share, middle_x, middle_y] = [sum_n, moment[0], moment[1]].map(|value| value / weight_n);
    [
        weight_n - sum_n,
        (x + high_m * ahead) * share - middle_x,
        (y + high_m * left) * share - middle_y,
    ]
}

#[cfg(test)]
mod tests {
    use xt28_sim::Effects;

    use super::super::still::still;
    use super::*;
    use crate::diagnosis::belief::Base;
    use crate::diagnosis::onset::Onset;

    /// Change of pitch within seconds, floors, of a machine that has its nose `sinks_rad` lower from 8 s on, and that is
    /// believed, or known by the base, to have soft front tyres from then on.
    fn sways(sinks_rad: f64, is_base: bool) -> Samples {
        let mut s = still(20);
        for w in Wheel::ALL {
            s.cylinder_load_n[w].fill(50.0e3);
            s.chamber_pa[w] = Default::default();
            for stroke_m in [&mut s.stroke_reading_m, &mut s.stroke_m, &mut s.smooth_stroke_m] {
                stroke_m[w].fill(0.17);
            }
        }
        s.pitch_rad[800..].fill(-sinks_rad);
        let (sound, mut soft) = (Effects::default(), Effects::default());
        for w in [Wheel::Fr, Wheel::Fl] {
            soft.wheels[w].soft_tyre.stiffness_n_m = 5.0e5;
        }
        let late = EffectSchedule::late(&sound, 8.0, &soft);
        let base =
            Base { effects: soft.clone(), since: Onset::in_every_run(8.0), before: sound.clone() };
        let base = base.schedule(base.belief(), 0.0);
        let errors = stance_errors(&s, &Machine::xt28(), if is_base { base } else { late });
        errors
            .pitch_sway_rad
            .into_iter()
            .map(|sway| sway / Signal::PitchSway.floor().sigma)
            .collect()
    }

    #[test]
    fn wheels_push_against_one_another_where_arms_have_rolled_a_machine_on_a_cross_slope() {
        let machine = Machine::xt28();
        let of = |rolled: f64, left_rad: f64| {
            wedged_m(&machine, Plane { slope_y: rolled, ..Plane::default() }, left_rad)
        };
        // Level on a cross slope, by the grip of half the weight on either side.
        let most_m = 0.5 * machine.wheels.friction * machine.wheels.track_m * 0.087_f64.tan();
        assert!((of(0.087, 0.087) - most_m).abs() < 1e-12 && of(-0.087, -0.087) == most_m);
        assert_eq!([of(0.087, 0.0), of(0.0, 0.087)], [0.0; 2]);
        assert!(of(0.005, 0.035) < 1e-3, "as a machine stands that nobody levels");
    }

    #[test]
    fn tyres_that_go_soft_underway_let_the_machine_down_once() {
        // A second after, when the attitude's filter has followed.
        for is_base in [false, true] {
            let floors = |sinks_rad: f64| {
                let after = sways(sinks_rad, is_base).into_iter().skip(90);
                after.fold(0.0_f64, |most, sway| most.max(sway.abs()))
            };
            let [stands, sinks] = [0.0, 0.0098].map(floors);
            assert!(stands > 5.0 && sinks < 0.6, "{stands} {sinks}");
        }
    }
}
