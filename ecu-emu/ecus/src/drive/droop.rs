//! Keeps the engine alive: less displacement while it is dragged below the speed it was asked for.
//!
//! The target speed is what the throttle says at the working speed of the engine. At another speed
//! asked of it the displacements make up for the difference; a speed that it cannot hold is not made
//! up for, since more displacement is more torque, but taken as a sign to ask for less.

use crate::life::PERIOD_S;

/// Speed over the speed asked for, above which the engine is free (assumed: a governor's droop).
const FREE: f64 = 0.93;
/// At this it would stall; the demand is at its least (assumed).
const STALLING: f64 = 0.75;
/// Least share of the demand that is left (assumed).
const SHARE_MIN: f64 = 0.2;
/// Time constant with which the demand comes back, s (assumed); it is taken away at once.
const RECOVERY_S: f64 = 1.0;

/// The relief of the engine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Relief {
    share: f64,
}

impl Default for Relief {
    fn default() -> Self {
        Self { share: 1.0 }
    }
}

impl Relief {
    /// Share of the demand that the engine can bear, for its speed over the speed that it should have; `None`
    /// while nothing is heard of it, when nothing is done. What was taken away comes back only to a
    /// machine that is `driven`.
    pub(crate) fn step(&mut self, speed_share: Option<f64>, driven: bool) -> f64 {
        let bearable = speed_share
            .map_or(1.0, |share| ((share - STALLING) / (FREE - STALLING)).clamp(SHARE_MIN, 1.0));
        let back = if driven { 1.0 - (-PERIOD_S / RECOVERY_S).exp() } else { 0.0 };
        self.share = bearable.min(self.share + back * (1.0 - self.share));
        // The way back never quite ends; a thousandth is no displacement.
        if self.share > 0.999 && bearable == 1.0 {
            self.share = 1.0;
        }
        self.share
    }
}

/// Demand that makes the target speed of `throttle` with an engine asked for `requested_rpm`.
pub(crate) fn demand(throttle: f64, working_rpm: f64, requested_rpm: f64) -> f64 {
    (throttle * working_rpm / requested_rpm).clamp(-1.0, 1.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_free_engine_and_a_silent_one_bear_everything() {
        let mut relief = Relief::default();
        for share in [None, Some(1.0), Some(1.2), Some(0.94)] {
            assert_eq!(relief.step(share, true), 1.0);
        }
    }

    #[test]
    fn a_dragged_engine_is_relieved_at_once_and_loaded_again_slowly() {
        let mut relief = Relief::default();
        assert!((relief.step(Some(0.84), true) - 0.5).abs() < 1e-12);
        assert_eq!(relief.step(Some(1.0), false), relief.share);
        assert!((relief.share - 0.5).abs() < 1e-12, "it runs out with what it has");
        assert!(relief.step(Some(1.0), true) < 0.51);
        let after_1_s = (0..99).map(|_| relief.step(Some(1.0), true)).last().unwrap();
        assert!((after_1_s - (1.0 - 0.5 * (-1.0_f64).exp())).abs() < 1e-9, "{after_1_s}");
        let later = (0..1000).map(|_| relief.step(Some(1.0), true)).last().unwrap();
        assert_eq!(later, 1.0);
    }

    #[test]
    fn the_target_speed_is_the_same_at_any_engine_speed_that_can_make_it() {
        assert_eq!(demand(0.5, 1200.0, 1200.0), 0.5);
        assert_eq!(demand(0.5, 1200.0, 1600.0), 0.375);
        assert_eq!(demand(-0.9, 1200.0, 800.0), -1.0);
    }

    proptest! {
        #[test]
        fn the_share_stays_in_its_bounds(speeds in prop::collection::vec((prop::option::of(-1.0..3.0_f64), any::<bool>()), 1..300)) {
            let mut relief = Relief::default();
            for (speed, driven) in speeds {
                prop_assert!((SHARE_MIN..=1.0).contains(&relief.step(speed, driven)));
            }
        }
    }
}
