//! What wheels push the ground with, how far they slip by it, and which of them slide.
//!
//! Motors of a circuit push alike, by its pressures, but for the trim of one that runs away; the ground
//! carries no more than friction times what a wheel presses it with. A wheel that is pushed harder spins,
//! and its speed says nothing of how fast the machine goes but that it goes no faster.

use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::{Effects, slip_trim_nm};

use super::circuits::{is_of_first, motor_nm, weights};
use crate::diagnosis::signals::{SMOOTHED, Samples, Signals, slope_over, smooth};
use crate::diagnosis::wheel_torques::WheelTorques;

/// Push over friction up to which a wheel surely holds, and from which on it surely slides: pressures come
/// twenty times a second, and friction differs from place to place (assumed).
const HOLDS: [f64; 2] = [0.8, 1.2];
/// A wheel that slid and is within this of what it should have is caught by the ground, m/s, in this time, s
/// (assumed).
const CAUGHT_M_S: f64 = 0.1;
const CAUGHT_S: f64 = 0.5;
/// Speed over which rolling resistance changes its sign, rad/s (assumed).
pub(super) const TURNS_RAD_S: f64 = 0.05;
/// Samples before and after one over which a wheel is seen to spin up.
const SPUN: usize = 5;
/// Samples from one look to the next where a push that smooth wheel speeds tell before it is there is sought.
const APART: usize = 10;

/// Inertia of a wheel about its axle, kg m^2.
pub(super) fn wheel_kg_m2(machine: &Machine) -> f64 {
    machine.masses.wheel_kg * machine.vehicle.wheel_gyration_m.powi(2)
}

/// What the motors of a run turn its wheels with.
fn wheel_torques<'a>(s: &'a Signals, machine: &Machine) -> &'a WheelTorques {
    s.wheel_torques(|| {
        let first = PerWheel::from_fn(|w| is_of_first(machine, w));
        let torque_nm = PerWheel::from_fn(|w| {
            let nm = |i| {
                let weights = weights(s, machine, i);
                let of = Wheel::ALL.into_iter().filter(|other| first[*other] == first[w]);
                let flow = of.map(|other| weights[other] * s.wheel_speed_rad_s[other][i]);
                let off_rad_s = s.wheel_speed_rad_s[w][i] - flow.sum::<f64>() / 3.0;
                let nm = motor_nm(s, machine, w, i) - weights[w] * slip_trim_nm(off_rad_s);
                if nm.is_finite() { nm } else { 0.0 }
            };
            (0..s.len).map(nm).collect::<Samples>()
        });
        let inertia_kg_m2 = wheel_kg_m2(machine);
        let pushes_nm = |w| {
            let gains_rad_s2 = slope_over(&s.smooth_wheel_speed_rad_s[w], SPUN);
            let smooth_nm = smooth(&torque_nm[w]).into_iter().zip(gains_rad_s2);
            smooth_nm.map(|(nm, gains)| nm - inertia_kg_m2 * gains).collect()
        };
        let ways = |w| s.wheel_speed_rad_s[w].iter().map(|speed| (speed / TURNS_RAD_S).tanh());
        WheelTorques {
            pushes_nm: PerWheel::from_fn(pushes_nm),
            ways: PerWheel::from_fn(|w| smooth(&ways(w).collect())),
            torque_nm,
        }
    })
}

/// The largest of `torque_nm` that shows in a smooth speed at sample `i`.
fn peak_nm(torque_nm: &Samples, i: usize) -> f64 {
    let near = (0..=SMOOTHED).step_by(APART).map(|by| torque_nm[(i + by).min(torque_nm.len() - 1)]);
    near.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0)
}

/// Push of all wheels at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Traction {
    /// What each wheel would push the machine forward with if it held, N.
    force_n: PerWheel<f64>,
    /// How much of its rolling each wheel's speed tells, from one to nothing where it slides.
    pub(super) holds: PerWheel<f64>,
    /// Speed at which each wheel slips forward by its push while it holds, m/s.
    pub(super) creeps_m_s: PerWheel<f64>,
    /// Most that the ground carries of each, N.
    most_n: PerWheel<f64>,
    /// What each was pushed with when it began to slide, N.
    slid_n: PerWheel<f64>,
    /// How near each came to what it should have since, from none to one.
    caught: PerWheel<f64>,
}

/// Torque that the motors have at sample `i`, mean of all wheels, Nm: what a wheel in the air is held back by, its
/// circuit's others have the more.
pub(super) fn mean_torque_nm(s: &Signals, machine: &Machine, i: usize) -> f64 {
    wheel_torques(s, machine).torque_nm.iter().map(|(_, nm)| nm[i]).sum::<f64>() / 6.0
}

impl Traction {
    /// At sample `i`, where wheels press with `normal_n`, `since_s` after it was `before`.
    pub(super) fn new(
        s: &Signals,
        machine: &Machine,
        effects: &Effects,
        normal_n: &PerWheel<f64>,
        i: usize,
        (before, since_s): (Option<&Self>, f64),
    ) -> Self {
        let WheelTorques { torque_nm, pushes_nm, ways } = wheel_torques(s, machine);
        let wheels = &machine.wheels;
        let of = |w| &effects.wheels[w].slippery_ground;
        let resists_n = PerWheel::from_fn(|w| {
            let added = effects.wheels[w].rolling_resistance.added;
            (wheels.rolling_resistance + added) * normal_n[w] * ways[w][i]
        });
        let by_n = |nm: f64, w| nm / wheels.radius_m - resists_n[w];
        let force_n = PerWheel::from_fn(|w| by_n(pushes_nm[w][i], w));
        let peak_n = PerWheel::from_fn(|w| by_n(peak_nm(&torque_nm[w], i), w));
        let most_n = PerWheel::from_fn(|w| wheels.friction * of(w).friction_factor * normal_n[w]);
        let pushed = PerWheel::from_fn(|w| {
            let over = peak_n[w].abs() / most_n[w].max(1.0);
            ((HOLDS[1] - over) / (HOLDS[1] - HOLDS[0])).clamp(0.0, 1.0)
        });
        // It slides on until the ground has caught it.
        let caught =
            |w| before.map_or(1.0, |b| b.holds[w] + b.caught[w] * since_s / CAUGHT_S).min(1.0);
        let holds = PerWheel::from_fn(|w| pushed[w].min(caught(w)));
        let slid_n = PerWheel::from_fn(|w| match before {
            Some(before) if pushed[w] == 1.0 => before.slid_n[w],
            _ => peak_n[w],
        });
        let creeps_m_s =
            PerWheel::from_fn(|w| of(w).creep_m_s_n * force_n[w].clamp(-most_n[w], most_n[w]));
        Self { force_n, holds, creeps_m_s, most_n, slid_n, caught: PerWheel::splat(1.0) }
    }

    /// What the ground carries of each wheel's push, N.
    pub(super) fn carried_n(&self) -> PerWheel<f64> {
        PerWheel::from_fn(|w| self.force_n[w].clamp(-self.most_n[w], self.most_n[w]))
    }

    /// How fast what the ground carries speeds `mass_kg` up, m/s^2.
    pub(super) fn speeds_up_m_s2(&self, mass_kg: f64) -> f64 {
        self.carried_n().sum() / mass_kg
    }

    /// What is left of a wheel's error, the speed that it should have less the one it has, m/s: one that slides
    /// may be any faster than the machine in the direction in which it was pushed.
    pub(super) fn told_m_s(&mut self, w: Wheel, error_m_s: f64) -> f64 {
        if error_m_s * self.slid_n[w] >= 0.0 {
            return error_m_s;
        }
        self.caught[w] = (1.0 - error_m_s.abs() / CAUGHT_M_S).max(0.0);
        error_m_s * self.holds[w]
    }
}

#[cfg(test)]
mod tests {
    use super::super::circuits::PRESSURE_AT_TORQUE_MAX_PA;
    use super::super::still::still;
    use super::*;
    use crate::diagnosis::signals::DT_S;

    const PRESSES_N: f64 = 27.0e3;

    /// A run in which circuits push with `torque_nm` on each wheel from 5 s to 6 s.
    fn pushed(torque_nm: f64) -> Signals {
        let mut s = still(10);
        let over_pa = torque_nm / Machine::xt28().wheels.torque_max_nm * PRESSURE_AT_TORQUE_MAX_PA;
        for forward in [1, 3] {
            s.pump_pressure_pa[forward][500..600].fill(over_pa);
        }
        s
    }

    fn on_ice(friction: f64) -> Effects {
        let mut effects = Effects::default();
        for wheel in Wheel::ALL {
            let slippery = &mut effects.wheels[wheel].slippery_ground;
            slippery.friction_factor = friction / Machine::xt28().wheels.friction;
            slippery.creep_m_s_n = 1.0e-5;
        }
        effects
    }

    fn at(s: &Signals, effects: &Effects, i: usize, before: Option<&Traction>) -> Traction {
        Traction::new(s, &Machine::xt28(), effects, &PerWheel::splat(PRESSES_N), i, (before, 0.05))
    }

    #[test]
    fn a_wheel_slides_where_it_is_pushed_harder_than_friction_holds() {
        let s = pushed(4.0e3);
        let radius_m = Machine::xt28().wheels.radius_m;
        let over = |friction: f64| 4.0e3 / radius_m / (friction * PRESSES_N);
        for (friction, holds) in [(0.4, 1.0), (0.1, 0.0)] {
            assert!(if holds == 1.0 { over(friction) < 0.8 } else { over(friction) > 1.2 });
            let traction = at(&s, &on_ice(friction), 550, None);
            assert_eq!(traction.holds[Wheel::Ml], holds);
            let carried_n = (4.0e3 / radius_m).min(friction * PRESSES_N);
            assert!((traction.creeps_m_s[Wheel::Ml] - 1.0e-5 * carried_n).abs() < 1e-6);
            let mass_kg = Machine::xt28().mass_kg();
            let speeds_up = traction.speeds_up_m_s2(mass_kg);
            assert!((speeds_up - 6.0 * carried_n / mass_kg).abs() < 1e-6, "{speeds_up}");
        }
    }

    #[test]
    fn one_that_slides_may_be_faster_as_it_was_pushed_and_no_slower_until_it_is_caught() {
        let (s, ice) = (pushed(4.0e3), on_ice(0.1));
        let mut traction = at(&s, &ice, 595, None);
        assert_eq!(traction.told_m_s(Wheel::Fr, 0.5), 0.5);
        assert_eq!(traction.told_m_s(Wheel::Fr, -0.5), 0.0);
        // No longer pushed, it slides on as long as it is faster than the machine.
        for i in (600..800).step_by(5) {
            traction = at(&s, &ice, i, Some(&traction));
            assert_eq!(traction.told_m_s(Wheel::Fr, -0.5), 0.0);
        }
        for i in (800..900).step_by(5) {
            traction = at(&s, &ice, i, Some(&traction));
            traction.told_m_s(Wheel::Fr, 0.0);
        }
        assert_eq!(traction.told_m_s(Wheel::Fr, -0.5), -0.5);
    }

    #[test]
    fn what_spins_a_wheel_up_pushes_nothing() {
        let (machine, mut s) = (Machine::xt28(), pushed(0.0));
        for w in Wheel::ALL {
            let gains = (0..s.len).map(|i| 2.0 * i as f64 * DT_S);
            s.smooth_wheel_speed_rad_s[w] = gains.collect();
        }
        let inertia_kg_m2 = machine.masses.wheel_kg * machine.vehicle.wheel_gyration_m.powi(2);
        let wanted_n = -2.0 * inertia_kg_m2 / machine.wheels.radius_m;
        let push_n = at(&s, &on_ice(0.4), 500, None).carried_n()[Wheel::Ml];
        assert!((push_n / wanted_n - 1.0).abs() < 1e-6, "{push_n}, not {wanted_n}");
    }

    /// Smooth speeds tell a start before it is there. What resists the rolling does not come before it rolls.
    #[test]
    fn what_resists_comes_no_earlier_than_what_pushes() {
        let (machine, mut s) = (Machine::xt28(), pushed(0.0));
        let resists_nm = machine.wheels.rolling_resistance * PRESSES_N * machine.wheels.radius_m;
        let over_pa = resists_nm / machine.wheels.torque_max_nm * PRESSURE_AT_TORQUE_MAX_PA;
        for forward in [1, 3] {
            s.pump_pressure_pa[forward][500..].fill(over_pa);
        }
        for w in Wheel::ALL {
            s.wheel_speed_rad_s[w][500..].fill(1.0);
            // Smooth, it turns from 4.7 s on.
            s.smooth_wheel_speed_rad_s[w][470..].fill(1.0);
        }
        for i in [485, 500, 515, 600] {
            let push_n = at(&s, &on_ice(0.4), i, None).carried_n()[Wheel::Ml];
            let resists_n = resists_nm / machine.wheels.radius_m;
            assert!(push_n.abs() < 0.01 * resists_n, "{push_n} N at sample {i}");
        }
    }
}
