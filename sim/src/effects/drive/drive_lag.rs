//! `drive-lag`: the circuits take up their speed through a further first-order lag.

use crate::effects::{Block, Effect, Lag, Parameter, Slot};

/// The lag of both circuits, beside the nominal machine's own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DriveLag {
    /// Time constant, s.
    pub time_constant_s: f64,
    /// Lead, s: a servo that is slower than the nominal one, and not a second one behind it, has as much of
    /// lead as the nominal one has of lag. No more than the time constant counts.
    pub lead_s: f64,
}

impl DriveLag {
    /// What comes of `asked`: (1 + lead s) / (1 + time constant s), `state` being the lag's.
    pub fn follow(&self, state: &mut Lag, asked: f64, dt_s: f64) -> f64 {
        let lagging = state.step(asked, self.time_constant_s, dt_s);
        if self.lead_s == 0.0 || self.time_constant_s <= 0.0 {
            return lagging;
        }
        lagging + (self.lead_s / self.time_constant_s).min(1.0) * (asked - lagging)
    }
}

/// The stroke of the pumps' swash plates, which takes its time with the pump's size.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "drive-lag",
    block: Block::Drive,
    meaning: "further first-order lag from throttle to wheel speed",
    source: "assumed: stroke times of mobile pump controls are 0.3 to 1.5 s over the full range",
    parameters: &[
        Parameter {
            name: "time_constant_s",
            neutral: 0.0,
            tolerance: 0.05,
            range: [0.0, 3.0],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.drive.lag.time_constant_s),
        },
        Parameter {
            name: "lead_s",
            neutral: 0.0,
            tolerance: 0.05,
            range: [0.0, 0.3],
            acts_alone: false,
            slot: Slot::Whole(|effects| &mut effects.drive.lag.lead_s),
        },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slower_servo_in_place_of_one_is_one_lag_and_not_two() {
        let (servo_s, slow_s, dt_s) = (0.15, 0.6, 0.001);
        let lag = DriveLag { time_constant_s: slow_s, lead_s: servo_s };
        let (mut servo, mut behind, mut alone) = (Lag::new(0.0), Lag::new(0.0), Lag::new(0.0));
        for _ in 0..3000 {
            let asked = servo.step(1.0, servo_s, dt_s);
            let both = lag.follow(&mut behind, asked, dt_s);
            assert!((both - alone.step(1.0, slow_s, dt_s)).abs() < 2e-3);
        }
    }
}
