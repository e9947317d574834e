//! Where the antenna was, for a receiver that is late.

use std::collections::VecDeque;

use xt28_machine::SimTime;

use crate::VehicleState;

/// Unit in which ages are counted, s: receivers are asked every 10 ms, and whole numbers stay exact.
const LOOK_S: f64 = 0.01;

/// What the antenna did as far back as the delay reaches.
///
/// Looks are kept with their times, so that the delay is the same however often a receiver is asked.
#[derive(Clone, Debug)]
pub(super) struct Past {
    delay_s: f64,
    /// Oldest first.
    looks: VecDeque<Look>,
}

/// The antenna at one time.
#[derive(Clone, Copy, Debug)]
struct Look {
    at: SimTime,
    position_m: [f64; 3],
    velocity_m_s: [f64; 3],
    /// Cosine and sine: an angle would jump at half a turn.
    heading: [f64; 2],
}

impl Look {
    fn new(at: SimTime, state: &VehicleState) -> Self {
        Self {
            at,
            position_m: state.antenna_position_m,
            velocity_m_s: state.antenna_velocity_m_s,
            heading: [state.yaw_rad.cos(), state.yaw_rad.sin()],
        }
    }

    /// How long ago it was, in [`LOOK_S`].
    fn age(&self, now: SimTime) -> f64 {
        now.since(self.at).as_nanos() as f64 / (LOOK_S * 1e9)
    }
}

impl Past {
    /// Nothing seen yet. `delay_s` is above zero.
    pub(super) const fn new(delay_s: f64) -> Self {
        Self { delay_s, looks: VecDeque::new() }
    }

    /// Takes in where the antenna is; gives the state with the antenna where it was: between two looks on the
    /// straight line from one to the other, and before the first where that has it.
    pub(super) fn step(&mut self, now: SimTime, state: &VehicleState) -> VehicleState {
        // Time that goes back, or stands, makes void what was seen from then on.
        while self.looks.back().is_some_and(|look| look.at >= now) {
            self.looks.pop_back();
        }
        self.looks.push_back(Look::new(now, state));
        let then = self.delay_s / LOOK_S;
        while self.looks.get(1).is_some_and(|look| look.age(now) >= then) {
            self.looks.pop_front();
        }
        let older = self.looks[0];
        // Now only the first can be that old.
        let is_between = self.looks.len() > 1 && older.age(now) > then;
        let newer = if is_between { self.looks[1] } else { older };
        let share = if is_between {
            (then - newer.age(now)) / (older.age(now) - newer.age(now))
        } else {
            0.0
        };
        let between = |newer: f64, older: f64| newer + share * (older - newer);
        let mut was = *state;
        for axis in 0..3 {
            was.antenna_position_m[axis] = between(newer.position_m[axis], older.position_m[axis]);
            was.antenna_velocity_m_s[axis] =
                between(newer.velocity_m_s[axis], older.velocity_m_s[axis]);
        }
        let [cos, sin] = [0, 1].map(|k| between(newer.heading[k], older.heading[k]));
        was.yaw_rad = sin.atan2(cos);
        was
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::DelayLine;

    fn at(t_s: f64) -> VehicleState {
        VehicleState {
            antenna_position_m: [(1.3 * t_s).sin(), -0.0, 3.0 - t_s],
            antenna_velocity_m_s: [1.3 * (1.3 * t_s).cos(), -t_s, 0.0],
            yaw_rad: 3.0 + 0.4 * t_s,
            ..VehicleState::default()
        }
    }

    /// Whatever the steps between two asks, be they as uneven as they like.
    #[test]
    fn the_delay_is_the_same_however_often_it_is_asked() {
        let mut uneven = [3_u64, 17, 10, 1, 29].into_iter().cycle();
        for delay_s in [0.013, 0.25, 0.4] {
            for step_ms in [Some(1), Some(5), Some(7), Some(10), Some(20), None] {
                let (mut past, mut ms) = (Past::new(delay_s), 0);
                while ms < 2000 {
                    let now = SimTime::from_millis(ms);
                    let t_s = now.as_secs_f64();
                    let was = past.step(now, &at(t_s));
                    // Of a sine the straight line between looks 29 ms apart is 0.2 mm off at most.
                    let apart_m = was.antenna_position_m[0] - (1.3 * (t_s - delay_s)).sin();
                    let said = t_s < delay_s + 0.03 || apart_m.abs() < 2e-4;
                    assert!(said, "{delay_s} s, {step_ms:?} ms, at {t_s} s: {apart_m} m");
                    ms += step_ms.unwrap_or_else(|| uneven.next().unwrap());
                }
            }
        }
    }

    /// Asked every 10 ms it gives what a delay line of that step does, to the bit.
    #[test]
    fn even_looks_are_a_delay_line() {
        for delay_s in [0.004, 0.01, 0.013, 0.07, 0.25, 0.4, 2.0] {
            let mut past = Past::new(delay_s);
            let mut lines =
                [0, 1, 2].map(|k| DelayLine::new(delay_s, LOOK_S, at(0.0).antenna_position_m[k]));
            for tick in 0..500 {
                let now = SimTime::from_millis(10 * tick);
                let state = at(now.as_secs_f64());
                let was = past.step(now, &state);
                for (k, line) in lines.iter_mut().enumerate() {
                    let late = line.step(state.antenna_position_m[k], delay_s, LOOK_S);
                    let made = was.antenna_position_m[k];
                    assert_eq!(
                        made.to_bits(),
                        late.to_bits(),
                        "{delay_s} s, {tick}: {made} {late}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_clock_that_is_set_back_forgets_what_came_after() {
        let mut past = Past::new(0.1);
        for ms in (0..1000).step_by(10).chain((300..400).step_by(10)) {
            let now = SimTime::from_millis(ms);
            let was = past.step(now, &at(now.as_secs_f64()));
            let z_m = was.antenna_position_m[2];
            assert!((2.0..=3.0 + 1e-12).contains(&z_m), "{ms} ms: {z_m}");
        }
        assert!(past.looks.len() <= 12);
    }
}
