//! `valve-hysteresis`: play between command and spool.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The play of one arm's valve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ValveHysteresis {
    /// Whole width of the play, share of full opening.
    pub width: f64,
}

impl ValveHysteresis {
    /// Where the spool comes to stand: it stays until the command has crossed the play, then goes
    /// along at half its width behind.
    #[must_use]
    pub fn spool(&self, spool: f64, command: f64) -> f64 {
        let half = 0.5 * self.width;
        spool.max(command - half).min(command + half)
    }
}

/// Friction of spool and solenoid: the flow differs between a rising and a falling current.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "valve-hysteresis",
    block: Block::Arms,
    meaning: "play between command and spool",
    source: "play operator; assumed: makers of mobile valves state 2 to 8 % of full current",
    parameters: &[Parameter {
        name: "width",
        neutral: 0.0,
        tolerance: 0.03,
        range: [0.0, 0.5],
        acts_alone: true,
        slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].hysteresis.width),
    }],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_sweep_runs_round_a_loop_as_wide_as_the_play() {
        let play = ValveHysteresis { width: 0.06 };
        let (mut spool, mut up, mut down) = (0.0, 0.0, 0.0);
        for step in 0..=800 {
            let t = f64::from(step) / 200.0;
            let command = 0.3 * (1.0 - (t - 2.0).abs()).clamp(-1.0, 1.0);
            spool = play.spool(spool, command);
            // Half way up at 1.5 s, half way down again at 2.5 s.
            (up, down) = if step == 300 {
                (spool, down)
            } else {
                (up, if step == 500 { spool } else { down })
            };
        }
        assert!((down - up - 0.06).abs() < 1e-12, "{down} - {up}");
    }

    #[test]
    fn without_play_the_spool_is_where_the_command_is() {
        assert_eq!(ValveHysteresis::default().spool(0.3, 0.123), 0.123);
    }
}
