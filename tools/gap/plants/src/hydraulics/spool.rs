//! A main spool: a mass on springs with dry friction, whose lands overlap the ports.

use crate::truth::SpoolTruth;

/// Substeps of one step: the spool is the quickest thing there is.
const SUBSTEPS: u32 = 4;

/// Where a spool is, share of full travel, and how fast, 1/s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Spool {
    travel: f64,
    rate: f64,
}

impl Spool {
    /// Goes on by `dt_s` s under `command` from -1 to 1; the opening that lets oil flow.
    ///
    /// x'' = w² (u - x) - 2 d w x' - w² f sign(x'), friction taken implicitly: it may stop the spool
    /// and hold it, but never turns it round.
    pub(crate) fn step(&mut self, truth: &SpoolTruth, command: f64, dt_s: f64) -> f64 {
        let h_s = dt_s / f64::from(SUBSTEPS);
        let w2 = truth.natural_rad_s * truth.natural_rad_s;
        let drag = 2.0 * truth.damping_ratio * truth.natural_rad_s;
        for _ in 0..SUBSTEPS {
            let push = self.rate + h_s * w2 * (command.clamp(-1.0, 1.0) - self.travel);
            let free = push / (1.0 + h_s * drag);
            let held = h_s * w2 * truth.friction / (1.0 + h_s * drag);
            self.rate = free - free.clamp(-held, held);
            self.travel += h_s * self.rate;
        }
        self.travel - self.travel.clamp(-truth.overlap, truth.overlap)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT_S: f64 = 0.002;
    const QUICK: SpoolTruth =
        SpoolTruth { natural_rad_s: 200.0, damping_ratio: 0.9, overlap: 0.0, friction: 0.0 };

    fn after(truth: &SpoolTruth, steps: usize, command: f64) -> f64 {
        let mut spool = Spool::default();
        (0..steps).map(|_| spool.step(truth, command, DT_S)).last().unwrap()
    }

    #[test]
    fn it_arrives_and_is_half_way_within_ten_milliseconds() {
        assert!((after(&QUICK, 100, 0.3) - 0.3).abs() < 1e-6);
        assert!(after(&QUICK, 5, 0.3) > 0.15 && after(&QUICK, 1, 0.3) < 0.05);
    }

    #[test]
    fn overlap_is_taken_off_either_side() {
        let truth = SpoolTruth { overlap: 0.04, ..QUICK };
        assert!((after(&truth, 200, 0.3) - 0.26).abs() < 1e-6);
        assert!((after(&truth, 200, -0.3) + 0.26).abs() < 1e-6);
        assert!(after(&truth, 200, 0.03) == 0.0);
    }

    #[test]
    fn friction_leaves_a_loop_twice_as_wide_as_its_force() {
        let truth = SpoolTruth { friction: 0.02, ..QUICK };
        let mut spool = Spool::default();
        let slow = |spool: &mut Spool, from: f64, to: f64| {
            (0..=5000)
                .map(|i| spool.step(&truth, from + (to - from) * f64::from(i) / 5000.0, DT_S))
                .last()
                .unwrap()
        };
        slow(&mut spool, 0.0, 0.1);
        let up = slow(&mut spool, 0.1, 0.2);
        slow(&mut spool, 0.2, 0.3);
        let down = slow(&mut spool, 0.3, 0.2);
        assert!((down - up - 0.04).abs() < 0.003, "{}", down - up);
    }
}
