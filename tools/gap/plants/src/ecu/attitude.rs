//! Roll and pitch by the firmware's complementary filter, kept in whole thousandths of a degree.

use super::TICK_S;

/// What the inertial unit reads in a tick, in its own axes: x forward, y left, z up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Inertial {
    /// deg/s.
    pub(crate) rate_deg_s: [f64; 3],
    /// Specific force, m/s².
    pub(crate) force_m_s2: [f64; 3],
}

/// Share of its own angle that the filter keeps in a tick: roll, pitch.
const KEEP: [f64; 2] = [0.995, 0.99];

/// Roll (right side high > 0) and pitch (nose up > 0), thousandths of a degree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Attitude {
    angle_mdeg: Option<[f64; 2]>,
}

impl Attitude {
    /// One tick; roll and pitch, deg.
    pub(crate) fn step(&mut self, sample: &Inertial) -> [f64; 2] {
        let [x, y, z] = sample.force_m_s2;
        let leaning = [(-y / z).atan(), (x / z).atan()].map(|rad| rad.to_degrees() * 1e3);
        let turning = [-sample.rate_deg_s[0], -sample.rate_deg_s[1]];
        let angle = match self.angle_mdeg {
            // The machine stood before.
            None => leaning.map(f64::trunc),
            Some(angle) => core::array::from_fn(|i| {
                let turned = angle[i] + turning[i] * 1e3 * TICK_S;
                (KEEP[i] * turned + (1.0 - KEEP[i]) * leaning[i]).trunc()
            }),
        };
        self.angle_mdeg = Some(angle);
        angle.map(|mdeg| mdeg * 1e-3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lean(roll_deg: f64, pitch_deg: f64) -> Inertial {
        let [r, p] = [roll_deg, pitch_deg].map(f64::to_radians);
        Inertial { rate_deg_s: [0.0; 3], force_m_s2: [9.81 * p.tan(), -9.81 * r.tan(), 9.81] }
    }

    #[test]
    fn it_starts_on_the_accelerometer_and_stays() {
        let mut attitude = Attitude::default();
        for _ in 0..200 {
            let [roll, pitch] = attitude.step(&lean(2.0, -1.0));
            assert!((roll - 2.0).abs() < 0.01 && (pitch + 1.0).abs() < 0.01);
        }
    }

    #[test]
    fn a_turn_is_seen_at_once_and_forgotten_by_the_accelerometer() {
        let mut attitude = Attitude::default();
        attitude.step(&lean(0.0, 0.0));
        let turning = Inertial { rate_deg_s: [-10.0, 0.0, 0.0], ..lean(0.0, 0.0) };
        let roll = (0..10).map(|_| attitude.step(&turning)[0]).last().unwrap();
        assert!((roll - 0.97).abs() < 0.02, "{roll}");
        let roll = (0..200).map(|_| attitude.step(&lean(0.0, 0.0))[0]).last().unwrap();
        assert!((roll - 0.97 * (-1.0_f64).exp()).abs() < 0.1, "{roll}");
    }
}
