//! Ordinary tolerances: what differs between two sound machines of one type.

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use xt28_machine::Wheel;

use crate::truth::Truth;

/// Spread of masses, and of stiffness, damping and friction: most that a number is off, share.
const MASS: f64 = 0.03;
const LAW: f64 = 0.05;
/// Most that the ground leans, rad: 0.3 deg.
const SLOPE_RAD: f64 = 0.3 * std::f64::consts::PI / 180.0;
/// Most that a foot gives way along the ground, m/s/N: that of a make whose tyres creep by 8 mm/s
/// under a kilonewton. Makes lie anywhere below.
const CREEP_M_S_N: f64 = 8.0e-6;
/// Unevenness of the senders, s.
const JITTER_S: f64 = 2.5e-4;

impl Truth {
    /// A sound machine with tolerances, sensor noise and an uneven bus, drawn from `random`.
    pub(crate) fn toleranced(random: &mut ChaCha8Rng) -> Self {
        let mut truth = Self::nominal();
        let mut near = |share: f64| {
            let drawn: f64 = StandardNormal.sample(&mut *random);
            // Half the spread is one standard deviation, and no more than the spread.
            1.0 + (0.5 * share * drawn).clamp(-share, share)
        };
        let m = &mut truth.machine.masses;
        for kg in [
            &mut m.front_frame_kg,
            &mut m.middle_frame_kg,
            &mut m.rear_frame_kg,
            &mut m.arm_kg,
            &mut m.wheel_kg,
        ] {
            *kg *= near(MASS);
        }
        for wheel in Wheel::ALL {
            let (arm, tyre) = (&mut truth.arms[wheel], &mut truth.body.tyres[wheel]);
            for number in [
                &mut arm.stiffness_n_m,
                &mut arm.damping_n_s_m,
                &mut tyre.stiffness_n_m,
                &mut tyre.damping_n_s_m,
                &mut tyre.friction,
                &mut tyre.rolling,
            ] {
                *number *= near(LAW);
            }
        }
        for number in [
            &mut truth.steering.stiffness_nm,
            &mut truth.steering.damping_nms,
            &mut truth.drive.slip_nms,
        ] {
            *number *= near(LAW);
        }
        truth.body.slope_rad = [(); 2].map(|()| random.random_range(-SLOPE_RAD..SLOPE_RAD));
        // From a stream of its own, so that what else is drawn stays as it was without.
        let mut make = random.clone();
        make.set_stream(random.get_stream() + 1);
        let creep_m_s_n = make.random_range(0.0..CREEP_M_S_N);
        truth.body.tyres.0.iter_mut().for_each(|tyre| tyre.creep_m_s_n = creep_m_s_n);
        truth.sensors.noise = 1.0;
        truth.bus.jitter_s = JITTER_S;
        truth
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;

    use super::*;

    #[test]
    fn tolerances_are_within_their_spread_and_centred() {
        let nominal = Truth::nominal();
        let (mut sum, mut most) = (0.0, 0.0_f64);
        for seed in 0..500 {
            let truth = Truth::toleranced(&mut ChaCha8Rng::seed_from_u64(seed));
            let mass = truth.machine.masses.front_frame_kg / nominal.machine.masses.front_frame_kg;
            let wheel = Wheel::Ml;
            let lock = truth.arms[wheel].stiffness_n_m / nominal.arms[wheel].stiffness_n_m;
            assert!((mass - 1.0).abs() <= MASS + 1e-12 && (lock - 1.0).abs() <= LAW + 1e-12);
            assert!(truth.body.slope_rad.iter().all(|rad| rad.abs() <= SLOPE_RAD));
            sum += lock - 1.0;
            most = most.max((lock - 1.0).abs());
        }
        assert!((sum / 500.0).abs() < 0.005 && most > 0.03);
    }
}
