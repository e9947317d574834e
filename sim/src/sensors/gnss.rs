//! The GNSS receiver on the cab roof: position, velocity and heading at 8 Hz with the paper's noise.

use core::time::Duration;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use xt28_machine::{Machine, SimTime};

use super::past::Past;
use crate::{Effects, VehicleState};

/// One fix of the antenna's position in the local frame: x east, y north, z up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GnssFix {
    /// When the receiver gives it. The antenna was there then, or `gnss-latency` earlier.
    pub at: SimTime,
    /// Position, m.
    pub position_m: [f64; 3],
    /// Velocity, m/s.
    pub velocity_m_s: [f64; 3],
    /// Heading of the machine, rad, counter-clockwise from east.
    pub heading_rad: f64,
    /// Standard deviation of the horizontal position, m.
    pub accuracy_m: f64,
}

/// The receiver: when the next fix is due, and its noise.
#[derive(Clone, Debug)]
pub struct GnssReceiver {
    period: Duration,
    due: SimTime,
    accuracy_m: f64,
    /// None where a fix is as old as it says.
    past: Option<Past>,
    noise: Option<Noise>,
}

#[derive(Clone, Debug)]
struct Noise {
    random: ChaCha8Rng,
    position_m: Normal<f64>,
    velocity_xy_m_s: Normal<f64>,
    velocity_z_m_s: Normal<f64>,
    heading_rad: Normal<f64>,
}

impl GnssReceiver {
    /// A receiver with the paper's noise (section 4.4) drawn from `seed`, or exact without a seed.
    #[must_use]
    pub fn new(machine: &Machine, effects: &Effects, seed: Option<u64>) -> Self {
        let s = &machine.sensors;
        let delay_s = effects.sensors.gnss_latency.delay_s;
        let normal = |sigma: f64| Normal::new(0.0, sigma.max(0.0)).expect("a finite deviation");
        Self {
            period: Duration::from_secs_f64(1.0 / s.gnss_rate_hz),
            due: SimTime::ZERO,
            accuracy_m: s.gnss_position_m,
            past: (delay_s > 0.0).then(|| Past::new(delay_s)),
            noise: seed.map(|seed| Noise {
                random: ChaCha8Rng::seed_from_u64(seed),
                position_m: normal(s.gnss_position_m),
                velocity_xy_m_s: normal(s.gnss_velocity_xy_m_s),
                velocity_z_m_s: normal(s.gnss_velocity_z_m_s),
                heading_rad: normal(s.gnss_heading_rad),
            }),
        }
    }

    /// The fix that is due at `now`, if one is. To be asked every 10 ms: a fix comes when it is first asked for, and
    /// asked less often a late one is less exact where the antenna does not go straight.
    pub fn step(&mut self, now: SimTime, state: &VehicleState) -> Option<GnssFix> {
        let late = self.past.as_mut().map(|past| past.step(now, state));
        let state = late.as_ref().unwrap_or(state);
        if now < self.due {
            return None;
        }
        self.due += self.period;
        let mut fix = GnssFix {
            at: now,
            position_m: state.antenna_position_m,
            velocity_m_s: state.antenna_velocity_m_s,
            heading_rad: state.yaw_rad,
            accuracy_m: self.accuracy_m,
        };
        if let Some(noise) = &mut self.noise {
            for axis in 0..3 {
                fix.position_m[axis] += noise.position_m.sample(&mut noise.random);
                let velocity = if axis < 2 { noise.velocity_xy_m_s } else { noise.velocity_z_m_s };
                fix.velocity_m_s[axis] += velocity.sample(&mut noise.random);
            }
            fix.heading_rad += noise.heading_rad.sample(&mut noise.random);
        }
        Some(fix)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_receiver_begins_where_the_antenna_stands() {
        let mut effects = Effects::default();
        effects.sensors.gnss_latency.delay_s = 2.0;
        let mut receiver = GnssReceiver::new(&Machine::xt28(), &effects, None);
        let state = VehicleState {
            antenna_position_m: [-0.3, 0.0, 3.1],
            yaw_rad: 1.0,
            ..VehicleState::default()
        };
        let fix = receiver.step(SimTime::ZERO, &state).unwrap();
        assert_eq!(fix.position_m, state.antenna_position_m);
        assert!((fix.heading_rad - 1.0).abs() < 1e-12);
    }

    #[test]
    fn eight_fixes_a_second_with_the_stated_noise() {
        let machine = Machine::xt28();
        let mut receiver = GnssReceiver::new(&machine, &Effects::default(), Some(7));
        let state = VehicleState::default();
        let fixes: Vec<GnssFix> = (0..100_000)
            .filter_map(|tick| receiver.step(SimTime::from_millis(tick * 10), &state))
            .collect();
        assert_eq!(fixes.len(), 8_000);
        let sigma = |of: &dyn Fn(&GnssFix) -> f64| {
            (fixes.iter().map(|f| of(f).powi(2)).sum::<f64>() / fixes.len() as f64).sqrt()
        };
        assert!((sigma(&|f| f.position_m[0]) / 0.005 - 1.0).abs() < 0.05);
        assert!((sigma(&|f| f.velocity_m_s[1]) / 0.075 - 1.0).abs() < 0.05);
        assert!((sigma(&|f| f.velocity_m_s[2]) / 0.025 - 1.0).abs() < 0.05);
        assert!((sigma(&|f| f.heading_rad) / 0.005 - 1.0).abs() < 0.05);
    }

    #[test]
    fn the_same_seed_gives_the_same_fixes() {
        let machine = Machine::xt28();
        let state = VehicleState::default();
        let fix = |seed| {
            GnssReceiver::new(&machine, &Effects::default(), Some(seed)).step(SimTime::ZERO, &state)
        };
        assert_eq!(fix(3), fix(3));
        assert_ne!(fix(3), fix(4));
    }

    #[test]
    fn a_late_receiver_shows_where_the_antenna_was() {
        let mut effects = Effects::default();
        effects.sensors.gnss_latency.delay_s = 0.25;
        let mut receiver = GnssReceiver::new(&Machine::xt28(), &effects, None);
        let mut fixes = 0;
        for tick in 0..200 {
            let t = f64::from(tick) * 0.01;
            let state = VehicleState {
                antenna_position_m: [1.5 * t, 0.0, 3.0],
                antenna_velocity_m_s: [1.5, 0.0, 0.0],
                yaw_rad: 3.0 + 0.4 * t,
                ..VehicleState::default()
            };
            let fix = receiver.step(SimTime::from_millis(10 * tick as u64), &state);
            if let (Some(fix), true) = (fix, t > 0.3) {
                assert!((fix.position_m[0] - 1.5 * (t - 0.25)).abs() < 1e-9);
                let turned = fix.heading_rad - (3.0 + 0.4 * (t - 0.25));
                assert!(turned.sin().abs() < 1e-6, "{turned}");
                fixes += 1;
            }
        }
        assert!(fixes > 10);
    }
}
