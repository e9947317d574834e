//! A wheel that spins gets less displacement, so that its circuit's oil pushes the others.
//!
//! Three motors in parallel share one pressure: a wheel in the air takes all the flow. The trim
//! compares each wheel with what the bend says of it (`turn`) and takes displacement off a motor that
//! runs away. The rest of its circuit would then speed up on the same flow; the pump gives way as the
//! displacement of its motors does.

use xt28_machine::{Machine, PerWheel, Wheel};

use super::turn::Turn;
use crate::life::PERIOD_S;

/// Free slip: a speed and a share of the expected speed (assumed: above what nominal machines show
/// while all wheels carry, 0.03 m/s).
const FREE_RAD_S: f64 = 1.0 * core::f64::consts::TAU / 60.0;
const FREE_SHARE: f64 = 0.25;
/// Displacement taken off per slip beyond that, over the expected speed (assumed).
const GAIN: f64 = 2.0;
/// Least share of its displacement that a motor keeps (assumed).
const SHARE_MIN: f64 = 0.3;
/// Time constant of the trim, s (assumed).
const TIME_CONSTANT_S: f64 = 0.5;
/// Slower than this the mean says nothing of slip, rad/s: 0.04 m/s.
const STANDING_RAD_S: f64 = 0.05;

/// The trim of all motors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SlipTrim {
    turn: Turn,
    circuits: [[Wheel; 3]; 2],
    share: PerWheel<f64>,
}

/// What the trim makes of the displacements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Trimmed {
    /// Share of their displacement that the motors keep, 0.3 to 1.
    pub(crate) motor: PerWheel<f64>,
    /// Share of theirs that the two pumps keep.
    pub(crate) pump: [f64; 2],
}

impl SlipTrim {
    /// # Panics
    /// For circuits that no machine file can have: reading one refuses them.
    pub(crate) fn new(machine: &Machine) -> Self {
        Self {
            turn: Turn::new(machine),
            circuits: machine.circuits().expect("checked when the machine was read"),
            share: PerWheel::splat(1.0),
        }
    }

    /// One tick, with wheels at `wheel_rad_s` and joints at `joint_deg`.
    pub(crate) fn step(&mut self, wheel_rad_s: &PerWheel<f64>, joint_deg: [f64; 2]) -> Trimmed {
        let shares = self.turn.shares(joint_deg);
        let pace_rad_s = median(&PerWheel::from_fn(|w| wheel_rad_s[w] / shares[w]));
        let keep = 1.0 - (-PERIOD_S / TIME_CONSTANT_S).exp();
        for wheel in Wheel::ALL {
            let wanted = wanted_share(wheel_rad_s[wheel], pace_rad_s * shares[wheel]);
            self.share[wheel] += keep * (wanted - self.share[wheel]);
            // The lag never quite ends; a thousandth is no current.
            if wanted == 1.0 && self.share[wheel] > 0.999 {
                self.share[wheel] = 1.0;
            }
        }
        self.hold()
    }

    /// The trim as it is, for a machine that is not driven but runs out: what falls shall not rise
    /// again by a wheel that finds grip.
    pub(crate) fn hold(&self) -> Trimmed {
        let pump = self.circuits.map(|c| c.iter().map(|&w| self.share[w]).sum::<f64>() / 3.0);
        Trimmed { motor: self.share, pump }
    }

    /// Every motor has all its displacement, for a machine that has run out.
    pub(crate) const fn reset(&mut self) {
        self.share = PerWheel::splat(1.0);
    }
}

/// Share of its displacement that a motor keeps at `rad_s` where `expected_rad_s` would be right.
fn wanted_share(rad_s: f64, expected_rad_s: f64) -> f64 {
    if expected_rad_s.abs() < STANDING_RAD_S {
        return 1.0;
    }
    // Ahead of the others, whichever way they go.
    let slip_rad_s = (rad_s - expected_rad_s) * expected_rad_s.signum();
    let beyond_rad_s = slip_rad_s - FREE_RAD_S - FREE_SHARE * expected_rad_s.abs();
    (1.0 - GAIN * beyond_rad_s.max(0.0) / expected_rad_s.abs()).max(SHARE_MIN)
}

/// Middle of the six, so that one or two that spin do not set the pace.
fn median(values: &PerWheel<f64>) -> f64 {
    let mut sorted = values.0;
    sorted.sort_unstable_by(f64::total_cmp);
    0.5 * (sorted[2] + sorted[3])
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn trim() -> SlipTrim {
        SlipTrim::new(&Machine::xt28())
    }

    fn settled(wheel_rad_s: PerWheel<f64>, joint_deg: [f64; 2]) -> Trimmed {
        let mut trim = trim();
        (0..1000).map(|_| trim.step(&wheel_rad_s, joint_deg)).last().unwrap()
    }

    #[test]
    fn wheels_that_roll_keep_all_in_any_bend() {
        let turn = Turn::new(&Machine::xt28());
        for front_deg in [-25.0, -10.0, 0.0, 25.0] {
            let joint_deg = [front_deg, 0.56 * front_deg];
            let rolling = turn.shares(joint_deg).map(|share| 0.8 * share);
            let all = Trimmed { motor: PerWheel::splat(1.0), pump: [1.0; 2] };
            assert_eq!(settled(rolling, joint_deg), all);
        }
    }

    #[test]
    fn a_wheel_in_the_air_gives_way_and_so_does_its_pump() {
        for direction in [1.0, -1.0] {
            let mut wheels = PerWheel::splat(0.5 * direction);
            wheels[Wheel::Mr] = 1.2 * direction;
            let trimmed = settled(wheels, [0.0; 2]);
            assert!((trimmed.motor[Wheel::Mr] - SHARE_MIN).abs() < 1e-6);
            assert_eq!(trimmed.motor[Wheel::Fr], 1.0);
            // Circuit 2 has FL, MR and BR.
            assert_eq!(trimmed.pump[0], 1.0);
            assert!((trimmed.pump[1] - (2.0 + SHARE_MIN) / 3.0).abs() < 1e-6);
        }
    }

    /// Others at 0.5 rad/s, one at 0.8: ahead by 0.3, of which 1 rpm, 0.1047 rad/s, and a quarter of 0.5
    /// are free. Twice the rest, 0.0703, over 0.5 is taken off: 28.1 %.
    #[test]
    fn a_wheel_that_slips_a_little_gives_way_a_little() {
        let mut wheels = PerWheel::splat(0.5);
        wheels[Wheel::Bl] = 0.8;
        let trimmed = settled(wheels, [0.0; 2]);
        assert!((trimmed.motor[Wheel::Bl] - 0.719).abs() < 5e-4, "{trimmed:?}");
        wheels[Wheel::Bl] = 0.5 + 0.2297;
        assert_eq!(settled(wheels, [0.0; 2]).motor, PerWheel::splat(1.0), "all of it is free");
    }

    #[test]
    fn a_wheel_that_lags_and_a_machine_that_stands_are_left_alone() {
        let mut wheels = PerWheel::splat(0.5);
        wheels[Wheel::Fl] = -0.2;
        assert_eq!(settled(wheels, [0.0; 2]).motor, PerWheel::splat(1.0));
        let mut wheels = PerWheel::splat(0.0);
        wheels[Wheel::Fl] = 1.0;
        assert_eq!(settled(wheels, [0.0; 2]).motor, PerWheel::splat(1.0));
    }

    proptest! {
        #[test]
        fn shares_stay_in_their_bounds(
            ticks in prop::collection::vec(prop::array::uniform6(-20.0..20.0_f64), 1..200),
            joint_deg in prop::array::uniform2(-25.0..25.0_f64),
        ) {
            let mut trim = trim();
            for wheel_rad_s in ticks {
                let trimmed = trim.step(&PerWheel(wheel_rad_s), joint_deg);
                let all = trimmed.motor.0.iter().chain(&trimmed.pump);
                prop_assert!(all.clone().all(|s| (SHARE_MIN..=1.0).contains(s)), "{:?}", trimmed);
            }
        }
    }
}
