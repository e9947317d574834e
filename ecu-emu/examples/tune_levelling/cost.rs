//! What gains cost: how long the machine takes to be level, at its height and evenly loaded.

use xt28_machine::{Axle, Machine, PerWheel, Side, Wheel};
use xt28_sim::VehicleState;

use crate::rig::Rig;

const RUN_TICKS: u32 = 2_000;
const TICK_S: f64 = 0.01;

/// A start that is wrong in one way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    pub(crate) name: &'static str,
    stroke_m: fn(Wheel) -> f64,
    error: fn(&Machine, &VehicleState) -> f64,
    /// Size of the error that counts as none.
    settled: f64,
    pub(crate) unit: &'static str,
}

/// How a start went.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outcome {
    /// Error at the start.
    pub(crate) first: f64,
    /// When it was last more than settled, s.
    pub(crate) settling_s: f64,
    /// How far it went beyond, percent of the first.
    pub(crate) overshoot_percent: f64,
    /// Greatest error over the last 2 s.
    pub(crate) last: f64,
    /// Integral of time times error over the first error, s².
    pub itae_s2: f64,
}

/// One start for each of the four controllers.
pub(crate) const STARTS: [Start; 4] = [
    Start {
        name: "height",
        stroke_m: |_| 0.15,
        error: |m, s| 1e3 * (m.levelling.height_m - s.stroke_m.mean()),
        settled: 5.0,
        unit: "mm",
    },
    Start {
        name: "roll",
        stroke_m: |w| if w.side() == Side::Right { 0.30 } else { 0.20 },
        error: |_, s| s.roll_rad.to_degrees(),
        settled: 0.5,
        unit: "deg",
    },
    Start {
        name: "pitch",
        stroke_m: |w| match w.axle() {
            Axle::Front => 0.32,
            Axle::Middle => 0.238,
            Axle::Rear => 0.18,
        },
        error: |_, s| s.pitch_rad.to_degrees(),
        settled: 0.3,
        unit: "deg",
    },
    Start {
        name: "load split",
        // 15 mm up and down crosswise: what three stiff frames can hide.
        stroke_m: |w| match w {
            Wheel::Fr | Wheel::Bl => 0.265,
            Wheel::Fl | Wheel::Br => 0.235,
            _ => 0.25,
        },
        // Spread that is not the weight's own adds to it at right angles.
        error: |_, s| (uneven(&s.ground_force_n).powi(2) - EVENEST.powi(2)).max(0.0).sqrt(),
        settled: 0.02,
        unit: "",
    },
];

/// The least spread that the nominal machine's centre of mass allows (see the ground-pressure
/// controller): forces linear in x with the same moment.
const EVENEST: f64 = 0.0797;

/// Standard deviation of the wheel forces over their sum.
pub(crate) fn uneven(force_n: &PerWheel<f64>) -> f64 {
    let share = force_n.map(|f| f / force_n.sum());
    (share.map(|s| (s - share.mean()).powi(2)).mean()).sqrt()
}

impl Start {
    /// Runs 20 s from this start.
    pub(crate) fn run(&self, machine: &Machine, delay_ticks: usize) -> Outcome {
        let mut rig = Rig::new(machine, PerWheel::from_fn(self.stroke_m), delay_ticks);
        let first = (self.error)(machine, rig.state());
        let (mut settling_s, mut beyond, mut last, mut itae) = (0.0, 0.0_f64, 0.0_f64, 0.0);
        for tick in 0..RUN_TICKS {
            rig.tick(PerWheel::splat(0.0));
            let t_s = f64::from(tick + 1) * TICK_S;
            let error = (self.error)(machine, rig.state());
            if error.abs() > self.settled {
                settling_s = t_s;
            }
            beyond = beyond.max(-error / first);
            itae += t_s * (error / first).abs() * TICK_S;
            if tick >= RUN_TICKS - 200 {
                last = last.max(error.abs());
            }
        }
        Outcome { first, settling_s, overshoot_percent: 100.0 * beyond, last, itae_s2: itae }
    }
}
