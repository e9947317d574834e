//! What each wheel carries, from the pressures of its cylinder.

use xt28_machine::{Machine, Wheel};
use xt28_sim::{Effects, Parts};

use super::followed::Followed;
use super::instants::PRESSURE_FILTER_S;
use super::layout::Reach;
use super::motion::{lagged, unflickered};
use super::strained::Seal;
use crate::diagnosis::belief::EffectSchedule;
use crate::diagnosis::gauge::Sensing;
use crate::diagnosis::generator::press::own_n;
use crate::diagnosis::instant::{AtWheel, Instant};
use crate::diagnosis::signals::{DT_S, Samples, Signals};

/// One arm as believed: how its sensors read and what hinders it.
#[derive(Clone)]
pub(super) struct Carrier<'a> {
    wheel: Wheel,
    parts: &'a Parts,
    effects: &'a Effects,
    /// Its sensors.
    sensing: Followed<Sensing>,
    /// Weight of wheel and arm that the pivot does not carry, N.
    own_n: f64,
    /// Rolling resistance per load, m.
    resistance_m: f64,
    /// Share of it that wheel and arm have between them, as a bearing's, from none: the rest is between wheel
    /// and ground.
    inner_share: f64,
    /// Grip of the ground.
    friction: f64,
    /// Friction of its seals.
    pub(super) seal: Seal,
}

impl<'a> Carrier<'a> {
    pub(super) fn new(
        s: &Signals,
        machine: &Machine,
        schedule: EffectSchedule<'a>,
        parts: &'a Parts,
        wheel: Wheel,
        inner_share: f64,
    ) -> Self {
        let effects = schedule.effects;
        let of =
            |effects: &Effects| Sensing::new(machine.arms.area_bore_m2, &effects.wheels[wheel]);
        let differs = |was: &Effects, is: &Effects| was.wheels[wheel] != is.wheels[wheel];
        let added = effects.wheels[wheel].rolling_resistance.added;
        Self {
            wheel,
            parts,
            effects,
            sensing: Followed::new(schedule, of, differs),
            own_n: own_n(machine, parts, wheel),
            resistance_m: (machine.wheels.rolling_resistance + added).max(0.0)
                * machine.wheels.radius_m,
            inner_share,
            friction: machine.wheels.friction,
            seal: seal(s, schedule, wheel),
        }
    }

    /// The sensors as the filtered readings of a sample show them.
    fn sensing_at(&self, sample: usize) -> Sensing {
        self.sensing.at(sample, |time_s| (-time_s / PRESSURE_FILTER_S).exp())
    }

    /// Where the wheel is, and what it presses on the ground, N; its idle motor holds it by
    /// `share` of the most.
    pub(super) fn at(&self, instant: &Instant, share: f64) -> (Reach, f64) {
        let moments = self.moments(instant);
        let holds_nm = share * self.effects.wheels[self.wheel].standstill_drag.torque_nm;
        let asked_nm = holds_nm - instant.wheels[self.wheel].torque_nm;
        (moments.reach, moments.normal_n(self.taken_nm(&moments, asked_nm)))
    }

    /// What the ground takes of a torque against rolling that is asked of a wheel's motor, Nm: no more than its grip.
    /// One in the air spins up until its motor turns it for nothing, whatever its circuit pushes the others by.
    fn taken_nm(&self, moments: &Moments, asked_nm: f64) -> f64 {
        let grip_m = self.friction * self.parts.radius_m;
        let slips = asked_nm.abs() > grip_m * moments.normal_n(asked_nm);
        if !slips {
            return asked_nm;
        }
        // What is as large as the grip of the load that it makes itself.
        let grip_m = grip_m.copysign(asked_nm);
        let slips_nm = grip_m * moments.free_nm / (moments.load_arm_m - moments.below_m * grip_m);
        if slips_nm * asked_nm > 0.0 {
            slips_nm.clamp(-asked_nm.abs(), asked_nm.abs())
        } else {
            0.0
        }
    }

    /// Moments about the arm's pivot. What the wheel pushes along the ground acts at its contact,
    /// `drop + radius` below the pivot: the motor's torque is between wheel and arm. So does what resists its
    /// rolling, less the moment of the ground's own resistance about the axle.
    fn moments(&self, instant: &Instant) -> Moments {
        let AtWheel { stroke_m, load_n, rod_n, rolls, .. } = instant.wheels[self.wheel];
        let sensing = self.sensing_at(instant.sample);
        let oil_n = sensing.gauge.load_n(load_n, rod_n);
        let cylinder_n = oil_n - self.seal.at_n(instant.sample);
        let pose = self.parts.linkage.at_stroke(sensing.stroke_m(stroke_m));
        let radius_m = self.parts.radius_m;
        let extends = self.parts.arms[self.wheel].extends;
        let below_m = extends * (pose.drop_m + radius_m) / radius_m;
        let resists_m = (below_m - (1.0 - self.inner_share) * extends) * self.resistance_m;
        Moments {
            reach: Reach { reach_m: pose.reach_m, drop_m: pose.drop_m },
            free_nm: self.own_n * pose.reach_m + cylinder_n * pose.lever_m,
            below_m,
            load_arm_m: pose.reach_m - resists_m * rolls,
        }
    }
}

/// Moments about an arm's pivot at one instant.
struct Moments {
    reach: Reach,
    /// Of everything but the ground's push and the wheel's motor, Nm.
    free_nm: f64,
    /// What a torque against rolling makes of itself about the pivot.
    below_m: f64,
    /// What the ground's push acts by, m.
    load_arm_m: f64,
}

impl Moments {
    /// What the wheel presses on the ground, N, its motor turning it against rolling by `against_nm`.
    fn normal_n(&self, against_nm: f64) -> f64 {
        (self.free_nm + self.below_m * against_nm) / self.load_arm_m
    }
}

/// The seals on the measured motion, each law from when it holds. What one has in common with the law before it
/// carries on; seals that begin to stick hold nothing until the rod moves.
fn seal(s: &Signals, schedule: EffectSchedule<'_>, wheel: Wheel) -> Seal {
    let effects = schedule.effects;
    let law = &effects.arms[wheel].stiction;
    let most_n = law.coulomb_n + law.stribeck_n;
    if most_n == 0.0 {
        return Seal::default();
    }
    let laws = schedule.of(|effects| effects.arms[wheel].stiction);
    let scale = effects.wheels[wheel].stroke_scale.factor;
    let (mut friction_n, mut left) = (0.0, 1.0);
    let mut last_m = None;
    let step = |(sample, stroke_m): (usize, f64)| {
        let travel_m = stroke_m - last_m.replace(stroke_m).unwrap_or(stroke_m);
        let rate_m_s = travel_m / DT_S / scale;
        let law = laws.at(sample as f64 * DT_S);
        friction_n = law.step(friction_n, rate_m_s, DT_S);
        // What it is where they were strained less what it is where they were not, as a share.
        left *= law.ahead(1.0, rate_m_s, DT_S)[0];
        (friction_n, left)
    };
    let both = unflickered(&s.smooth_stroke_m[wheel]).into_iter().enumerate().map(step);
    let (friction_n, left): (Samples, Samples) = both.unzip();
    let late = |samples: Samples| lagged(samples.into_iter(), PRESSURE_FILTER_S);
    Seal { friction_n: late(friction_n), left: late(left), most_n, begins_n: 0.0 }
}

#[cfg(test)]
mod tests {
    use xt28_machine::Wheel;

    use super::super::instants::instants;
    use super::*;
    use crate::diagnosis::belief::Base;
    use crate::diagnosis::generator::still::still;
    use crate::diagnosis::onset::Onset;

    /// A sensor that jumps does so behind the ECU's filter.
    #[test]
    fn a_reading_that_follows_a_jump_shows_the_load_that_is_there() {
        let (machine, sound, w) = (Machine::xt28(), Effects::default(), Wheel::Mr);
        let mut off = sound.clone();
        off.wheels[w].pressure_bias.bias_pa = 0.6e6;
        let (s, parts) = (still(10), Parts::new(&machine, &off));
        let jump_n = 0.6e6 * machine.arms.area_bore_m2;
        let jumps = (0..1000).map(|i| 8.0e4 + if i < 500 { 0.0 } else { jump_n });
        let reading_n = lagged(jumps, PRESSURE_FILTER_S);
        let load_n = |schedule: EffectSchedule<'_>, i: usize| {
            let carrier = Carrier::new(&s, &machine, schedule, &parts, w, 1.0);
            carrier.sensing_at(i).gauge.load_n(reading_n[i], 0.0)
        };
        let late = EffectSchedule::late(&sound, 5.0, &off);
        let base =
            Base { effects: off.clone(), since: Onset::in_every_run(5.0), before: sound.clone() };
        let known = base.schedule(base.belief(), 0.0);
        for i in [500, 510, 525, 550, 999] {
            assert!((load_n(late, i) - 8.0e4).abs() < 300.0, "{i}: {}", load_n(late, i));
            assert_eq!(load_n(known, i), load_n(late, i), "{i}");
        }
        assert!(
            (load_n((&off).into(), 510) - 8.0e4).abs() > 2.0e3,
            "without a jump none is undone"
        );
    }

    /// On a slope the motors of a circuit push all the time, that of a wheel in the air against nothing.
    #[test]
    fn a_wheel_in_the_air_presses_nothing_whatever_its_circuit_pushes() {
        let (machine, sound) = (Machine::xt28(), Effects::default());
        let (s, parts) = (still(10), Parts::new(&machine, &sound));
        let presses_n = |w: Wheel, load_n: f64, torque_nm: f64| {
            let carrier = Carrier::new(&s, &machine, (&sound).into(), &parts, w, 1.0);
            let at = AtWheel { stroke_m: 0.17, load_n, torque_nm, ..AtWheel::default() };
            let mut instant = instants(&s, &machine)[0].clone();
            instant.wheels[w] = at;
            carrier.at(&instant, 0.0).1
        };
        for w in [Wheel::Fr, Wheel::Ml] {
            let pose = machine.linkage().at_stroke(0.17);
            let hangs_n = -own_n(&machine, &parts, w) * pose.reach_m / pose.lever_m;
            for torque_nm in [-2.0e3, 0.0, 2.0e3] {
                let n = presses_n(w, hangs_n, torque_nm);
                assert!(n.abs() < 1.0, "{w}, {torque_nm} Nm: {n}");
            }
            let pushes_n = presses_n(w, 60.0e3, 2.0e3) - presses_n(w, 60.0e3, 0.0);
            assert!(pushes_n.abs() > 1.0e3, "one on the ground does: {pushes_n}");
        }
    }

    #[test]
    fn what_seals_held_before_is_gone_once_a_rod_has_slid() {
        let (mut s, mut effects) = (still(10), Effects::default());
        effects.arms[Wheel::Bl].stiction.coulomb_n = 8.0e3;
        for (i, stroke_m) in s.smooth_stroke_m[Wheel::Bl].iter_mut().enumerate() {
            *stroke_m = 0.2 + 2.0e-5 * i.saturating_sub(500) as f64;
        }
        let seal = seal(&s, (&effects).into(), Wheel::Bl);
        assert_eq!((seal.left[400], seal.friction_n[400], seal.most_n), (1.0, 0.0, 8.0e3));
        assert!(seal.left[999] < 1e-3 && seal.friction_n[999] > 7.9e3);
        let strained = Seal { begins_n: -5.0e3, ..seal };
        assert_eq!(strained.at_n(400), -5.0e3);
        assert!(strained.at_n(999) > 7.9e3);
    }

    #[test]
    fn seals_that_begin_to_stick_hold_nothing_until_the_rod_moves() {
        let (mut s, mut effects, sound) = (still(10), Effects::default(), Effects::default());
        effects.arms[Wheel::Bl].stiction.coulomb_n = 8.0e3;
        for (i, stroke_m) in s.smooth_stroke_m[Wheel::Bl].iter_mut().enumerate() {
            *stroke_m = 0.2 + 2.0e-5 * (i.min(300) + i.saturating_sub(700)) as f64;
        }
        let late = EffectSchedule::late(&sound, 5.0, &effects);
        let seal = [seal(&s, late, Wheel::Bl), seal(&s, (&effects).into(), Wheel::Bl)];
        assert_eq!((seal[0].at_n(600), seal[0].left[600]), (0.0, 0.0));
        assert!(seal[1].at_n(600) > 7.0e3, "those that always did are strained");
        assert!(seal.iter().all(|seal| seal.at_n(999) > 7.9e3));
    }
}
