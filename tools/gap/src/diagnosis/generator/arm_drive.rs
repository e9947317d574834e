//! One arm's valve and oil, driven with what was measured.

use xt28_machine::{Machine, Wheel};
use xt28_sim::effects::{
    ArmEffects, Block, CATALOGUE, LOCK_STIFFNESS, Scope, SealStiction, WheelEffects,
};
use xt28_sim::{Arm, ArmInput, ArmState, CylinderMotion, Effects};

use super::loads::{KEPT, Loads};
use crate::diagnosis::belief::EffectSchedule;
use crate::diagnosis::gauge::Sensing;
use crate::diagnosis::signals::{DT_S, Samples, Signals};

/// Time over which the block forgets where it parted from the machine, s. Long enough that a creep of
/// a tenth of a millimetre a second stands out over a run, short enough that what a law has wrong by a
/// few per cent does not add up to more than the fault itself.
const FORGET_S: f64 = 2.0;
/// Share of the relief valve's force below which a load that was measured has not opened it. Were the
/// prediction allowed to open it, an arm that is almost solid would be off by nothing.
const SHUT: f64 = 0.9;
/// Share of a tolerance below which a parameter is where it was.
const ROUNDING: f64 = 1e-3;
/// Samples about the instant at which a sensor becomes another within which its reading jumps.
const JUMPS_ABOUT: usize = 4;
/// Samples from the one with most of a jump to the first that has none of it.
const JUMPS_OVER: usize = 2;

/// One arm with all it is driven with.
pub(super) struct ArmDrive<'a> {
    signals: &'a Signals,
    wheel: Wheel,
    arm: Arm,
    sensing: Sensing,
    /// Sensors that were others at first, in order.
    before: [Option<Before>; 2],
    /// Samples at which the arm becomes another, so that its oil begins anew.
    anew: [Option<usize>; 2],
    /// Samples at which the play of its valve becomes another, so that its spool is still where it was pulled.
    plays: [Option<usize>; 2],
    loads: Loads,
    area_bore_m2: f64,
    force_max_n: f64,
}

/// Sensors of before.
#[derive(Clone, Copy, Debug)]
struct Before {
    sensing: Sensing,
    /// Sample until which they were these.
    until: usize,
    /// Whether the reading of the stroke jumps there.
    jumps: bool,
}

impl<'a> ArmDrive<'a> {
    /// The arm of `wheel` as `effects` have it, to be driven with `signals`.
    pub(super) fn new(
        signals: &'a Signals,
        machine: &Machine,
        effects: &Effects,
        wheel: Wheel,
    ) -> Self {
        // The seals are judged apart.
        let smooth = ArmEffects { stiction: SealStiction::default(), ..effects.arms[wheel] };
        Self {
            signals,
            wheel,
            arm: Arm::new(machine, &smooth),
            sensing: Sensing::new(machine.arms.area_bore_m2, &effects.wheels[wheel]),
            before: [None; 2],
            anew: [None; 2],
            plays: [None; 2],
            loads: Loads::new(signals, machine, &effects.wheels[wheel], wheel),
            area_bore_m2: machine.arms.area_bore_m2,
            force_max_n: machine.arms.force_max_n,
        }
    }

    /// The same over a `schedule` of effects. Sensors are those of before until the others set in: a reading
    /// that jumps is followed. Oil begins anew where the arm becomes another, as it then is what it was: a
    /// leak that had always been there would have emptied it. Not where a sensor jumps, as no load is known
    /// while the ECU's filter still follows.
    pub(super) fn over(mut self, schedule: EffectSchedule<'_>) -> Self {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let sample = |at_s: f64| (at_s / DT_S).round().max(0.0) as usize;
        for (k, change) in schedule.changes().enumerate() {
            let (at, [was, is]) = (sample(change.at_s), change.from_to);
            if is_another_arm(was, is, self.wheel) {
                self.anew[k] = Some(at);
            }
            let play = |effects: &Effects| effects.arms[self.wheel].hysteresis;
            if play(was) != play(is) {
                self.plays[k] = Some(at);
            }
            let [was, is] = [was, is].map(|effects| effects.wheels[self.wheel]);
            let reads = |sensors: &WheelEffects| (sensors.stroke_bias, sensors.stroke_scale);
            let jumps = reads(&was) != reads(&is);
            let [sensing, next] = [was, is].map(|of| Sensing::new(self.area_bore_m2, &of));
            if sensing != next {
                let until = if jumps { self.jump_about(at) } else { at };
                self.before[k] = Some(Before { sensing, until, jumps });
            }
        }
        self
    }

    /// The sample about `i` at which the reading of the stroke jumps: where it goes furthest at once. A log's clock
    /// begins with its first frame, and is some samples off the one by which a cause begins.
    fn jump_about(&self, i: usize) -> usize {
        let stroke_m = &self.signals.stroke_m[self.wheel];
        let goes_m = |at: &usize| (stroke_m[*at] - stroke_m[*at - 1]).abs();
        let last = stroke_m.len().saturating_sub(1);
        let near = i.saturating_sub(JUMPS_ABOUT).max(1)..=(i + JUMPS_ABOUT).min(last);
        near.max_by(|a, b| goes_m(a).total_cmp(&goes_m(b))).unwrap_or(i)
    }

    /// The sensors at sample `i`.
    fn sensing(&self, i: usize) -> &Sensing {
        let before = self.before.iter().flatten().find(|before| i < before.until);
        before.map_or(&self.sensing, |before| &before.sensing)
    }

    /// The sample about `i` at which the reading of the stroke jumps.
    fn jump_at(&self, i: usize) -> Option<usize> {
        let jumps = self.before.iter().flatten().filter(|before| before.jumps);
        jumps.map(|before| before.until).find(|jump| i.abs_diff(*jump) < JUMPS_OVER)
    }

    /// Whether the play of its valve sets in within the run: where its spool then is, is known.
    pub(super) fn plays_late(&self) -> bool {
        self.plays.iter().any(Option::is_some)
    }

    /// Moves the spool with sample `i`; the speed that it asks for, extending > 0, m/s.
    fn open(&self, state: &mut ArmState, i: usize, input: &ArmInput) -> f64 {
        if self.plays.contains(&Some(i)) {
            state.valve.release();
        }
        self.arm.open(state, input, DT_S)
    }

    /// Speed that the valve asks of the oil, extending > 0, m/s.
    ///
    /// The spool begins as near to where it is shut as the first command lets it, or `off` that command by a
    /// share of half its play, -1 to 1.
    pub(super) fn speeds_asked_m_s(&self, off: Option<f64>) -> Samples {
        let mut state = self.started(off);
        (0..self.signals.len).map(|i| self.open(&mut state, i, &self.input(i))).collect()
    }

    /// Stroke predicted less the stroke measured, m, without the friction of the seals; and how far the
    /// sensor's reading goes for a newton, m/N. `share` is what the pump gives of what is asked, by sample; all where
    /// there are none; `off` is where the spool begins, as in [`Self::speeds_asked_m_s`].
    ///
    /// A force counts as the distance that this very arm gives way for it: were it the nominal arm's,
    /// a softer one would seem to be measured better.
    pub(super) fn stroke_errors_m(&self, share: &[f64], off: Option<f64>) -> (Samples, Samples) {
        let is_new = &self.signals.load_is_new[self.wheel];
        let mut state = self.started(off);
        let mut seen_n = self.loads.reading_n[0];
        let (mut error_m, mut m_n, mut began) = (0.0, 0.0, 0);
        let step = |i: usize| {
            let (input, sensing) = (self.input(i), self.sensing(i));
            if self.anew.contains(&Some(i)) {
                state.cylinder = self.arm.resumed(&input, DT_S).cylinder;
                seen_n = self.loads.reading_n[i];
                began = i;
            }
            let made_n = self.arm.oil_force_n(&state, &input.motion);
            seen_n = KEPT * seen_n + (1.0 - KEPT) * self.read(i, made_n);
            if self.loads.is_drained.get(i) == Some(&true) {
                // What came in past the valve is not in the opening: begin anew.
                state.cylinder = self.arm.resumed(&input, DT_S).cylinder;
                (seen_n, error_m) = (self.loads.reading_n[i], f64::NAN);
            } else if is_new[i] {
                m_n = sensing.stroke_scale * self.give_m_n(i, seen_n, &input.motion);
                error_m = m_n * (seen_n - self.loads.reading_n[i]);
            }
            let parted_m = state.cylinder.rest_m - self.arm.rest_m(input.load_n, &input.motion);
            // A single reading is poor to begin with on an arm that swings: it is the mean of those there are.
            let since_s = (i - began + 1) as f64 * DT_S;
            state.cylinder.rest_m -= parted_m * (DT_S / since_s.min(FORGET_S));
            let asked_m_s = self.open(&mut state, i, &input);
            let given_m_s = share.get(i).map_or(asked_m_s, |share| share * asked_m_s);
            if input.load_n.abs() < SHUT * self.force_max_n {
                self.arm.fill_shut(&mut state, &input, given_m_s, DT_S);
            } else {
                self.arm.fill(&mut state, &input, given_m_s, DT_S);
            }
            (error_m, m_n)
        };
        (0..self.signals.len).map(step).unzip()
    }

    /// How far the arm gives way for a newton, on average between the load read at sample `i` and one
    /// that would be read as `seen_n`, m/N. Between them, not about one: gas that would be pressed far
    /// beyond its load is so stiff there that it would seem to be a hair's breadth off.
    fn give_m_n(&self, i: usize, seen_n: f64, motion: &CylinderMotion) -> f64 {
        const LEAST_N: f64 = 1.0;
        let read_n = self.loads.reading_n[i];
        let by_n = if (seen_n - read_n).abs() < LEAST_N { LEAST_N } else { seen_n - read_n };
        let [from_m, to_m] =
            [read_n, read_n + by_n].map(|n| self.arm.rest_m(self.load_n(i, n), motion));
        (to_m - from_m) / by_n
    }

    fn started(&self, off: Option<f64>) -> ArmState {
        let input = self.input(0);
        off.map_or_else(
            || self.arm.resumed(&input, DT_S),
            |share| self.arm.resumed_off(&input, share, DT_S),
        )
    }

    fn input(&self, i: usize) -> ArmInput {
        let stroke = &self.signals.stroke_m[self.wheel];
        let truth = |i: usize| self.sensing(i).stroke_m(stroke[i]);
        // A jump of the reading that samples share is no motion: the arm goes on as it did.
        let last = self.jump_at(i).map_or(i, |jump| jump.saturating_sub(JUMPS_OVER));
        // Over one sample: what the damper makes of it is smoothed by the filter of the pressures.
        let stroke_rate_m_s = (truth(last) - truth(last.saturating_sub(1))) / DT_S;
        let stroke_m = truth(last) + stroke_rate_m_s * (i - last) as f64 * DT_S;
        ArmInput {
            command: self.signals.opening[self.wheel][i],
            load_n: self.sensing(i).gauge.load_n(self.loads.oil_n[i], self.loads.rod_oil_n[i]),
            motion: CylinderMotion { stroke_m, stroke_rate_m_s },
        }
    }

    /// Load that the sensors show as `reading_n` at sample `i`.
    fn load_n(&self, i: usize, reading_n: f64) -> f64 {
        self.sensing(i).gauge.load_n(reading_n, self.loads.rod_n[i])
    }

    /// Load that the sensors show at sample `i` for one of `load_n`.
    fn read(&self, i: usize, load_n: f64) -> f64 {
        self.sensing(i).gauge.reading_n(load_n, self.loads.rod_n[i])
    }
}

/// Whether the arm of `wheel` is another under `is` than under `was`, by more than the rounding of a search.
fn is_another_arm(was: &Effects, is: &Effects, wheel: Wheel) -> bool {
    if was.arms[wheel] == is.arms[wheel] {
        return false;
    }
    let of_arms = CATALOGUE.iter().filter(|effect| effect.block == Block::Arms);
    of_arms.chain([&LOCK_STIFFNESS]).flat_map(|effect| effect.parameters).any(|p| {
        let [before, after] = [was, is].map(|effects| p.get(effects, Scope::Wheel(wheel)));
        (after - before).abs() > ROUNDING * p.tolerance
    })
}

#[cfg(test)]
mod tests {
    use super::super::still::still;
    use crate::diagnosis::belief::Base;
    use crate::diagnosis::gauge::Gauge;
    use crate::diagnosis::onset::Onset;
    use xt28_sim::effects::Effect;

    use super::*;

    /// A shut arm that swings by 6 mm as the log begins, its load as the ECU's filter shows it.
    fn swinging() -> Signals {
        let (machine, w) = (Machine::xt28(), Wheel::Fl);
        let arm = Arm::new(&machine, &ArmEffects::default());
        let motion = |t: f64| CylinderMotion {
            stroke_m: 0.17 + 0.006 * (8.0 * t).sin(),
            stroke_rate_m_s: 0.048 * (8.0 * t).cos(),
        };
        let at_rest = CylinderMotion { stroke_m: 0.17, stroke_rate_m_s: 0.0 };
        let input = ArmInput { command: 0.0, load_n: 8.0e4, motion: at_rest };
        let state = arm.resumed(&input, DT_S);
        let mut s = still(10);
        s.chamber_pa[w] = [Vec::new(), Vec::new()];
        s.load_is_new[w].fill(true);
        let mut seen_n = 8.0e4;
        for i in -500..1000_i32 {
            let motion = motion(f64::from(i) * DT_S);
            seen_n = KEPT * seen_n + (1.0 - KEPT) * arm.oil_force_n(&state, &motion);
            if let Ok(i) = usize::try_from(i) {
                s.stroke_m[w][i] = motion.stroke_m;
                s.cylinder_load_n[w][i] = seen_n;
            }
        }
        s
    }

    /// The load before the filter is not known in the first sample: oil that begins by it alone is off for
    /// seconds.
    #[test]
    fn an_arm_that_swings_as_its_log_begins_is_known_within_a_second() {
        let (machine, effects) = (Machine::xt28(), Effects::default());
        let swings = swinging();
        let drive = ArmDrive::new(&swings, &machine, &effects, Wheel::Fl);
        let (errors_m, _) = drive.stroke_errors_m(&[], None);
        let largest_m = errors_m[100..].iter().fold(0.0_f64, |most, m| most.max(m.abs()));
        assert!(largest_m < 3.0e-4, "{largest_m}");
    }

    /// A base that sets in within the run is believed from there on; what the oil holds then comes from before.
    #[test]
    fn pressures_that_jump_are_no_jump_of_the_oil() {
        let (machine, w) = (Machine::xt28(), Wheel::Fl);
        let mut off = Effects::default();
        off.wheels[w].pressure_bias.bias_pa = -0.9e6;
        let mut s = still(15);
        s.chamber_pa[w] = [Vec::new(), Vec::new()];
        s.load_is_new[w].fill(true);
        let gauge = Gauge::new(machine.arms.area_bore_m2, &off.wheels[w]);
        let mut seen_n = 8.0e4;
        for i in 0..s.len {
            let reading_n = if i < 1000 { 8.0e4 } else { gauge.reading_n(8.0e4, 0.0) };
            seen_n = KEPT * seen_n + (1.0 - KEPT) * reading_n;
            s.cylinder_load_n[w][i] = seen_n;
        }
        let base = Base {
            effects: off.clone(),
            since: Onset::in_every_run(10.0),
            before: Effects::default(),
        };
        let schedule = base.schedule(base.belief(), 0.0);
        let drive = ArmDrive::new(&s, &machine, &off, w).over(schedule);
        let (errors_m, _) = drive.stroke_errors_m(&[], None);
        let largest_m = errors_m[1000..].iter().fold(0.0_f64, |most, m| most.max(m.abs()));
        assert!(largest_m < 3.0e-4, "{largest_m}");
    }

    /// A clock that is two samples off, and a reading that takes a sample to jump.
    #[test]
    fn a_stroke_that_jumps_is_no_jump_of_the_arm() {
        let (machine, w) = (Machine::xt28(), Wheel::Fl);
        let (mut off, sound) = (Effects::default(), Effects::default());
        off.wheels[w].stroke_bias.bias_m = -0.012;
        let mut s = swinging();
        let jumped = |i: usize| [0.0, 0.4, 1.0][(i + 1).saturating_sub(500).min(2)];
        for (i, stroke_m) in s.stroke_m[w].iter_mut().enumerate() {
            *stroke_m -= 0.012 * jumped(i);
        }
        for from_s in [4.98, 5.0, 5.02] {
            let late = EffectSchedule::late(&sound, from_s, &off);
            let drive = ArmDrive::new(&s, &machine, &off, w).over(late);
            let (errors_m, _) = drive.stroke_errors_m(&[], None);
            let largest_m = errors_m[100..].iter().fold(0.0_f64, |most, m| most.max(m.abs()));
            assert!(largest_m < 1.0e-3, "{from_s}: {largest_m}");
        }
    }

    /// Of a stroke's sensor that comes loose, and the pressures' that then goes too, each is followed.
    #[test]
    fn two_sensors_of_one_arm_go_one_after_the_other() {
        let (machine, w) = (Machine::xt28(), Wheel::Fl);
        let (sound, mut loose) = (Effects::default(), Effects::default());
        loose.wheels[w].stroke_bias.bias_m = -0.012;
        let mut both = loose.clone();
        both.wheels[w].pressure_bias.bias_pa = -0.9e6;
        let mut s = swinging();
        s.stroke_m[w][400..].iter_mut().for_each(|stroke_m| *stroke_m -= 0.012);
        let gauge = Gauge::new(machine.arms.area_bore_m2, &both.wheels[w]);
        let by_n = gauge.reading_n(8.0e4, 0.0) - 8.0e4;
        let mut seen_n = 0.0;
        for load_n in &mut s.cylinder_load_n[w][700..] {
            seen_n = KEPT * seen_n + (1.0 - KEPT) * by_n;
            *load_n += seen_n;
        }
        let base = Base { effects: loose, since: Onset::in_every_run(4.0), before: sound.clone() };
        let off = base.with(|effects| {
            let mut off = effects.clone();
            off.wheels[w].pressure_bias = both.wheels[w].pressure_bias;
            off
        });
        let schedule = base.schedule(off.from(Onset::in_every_run(7.0)), 0.0);
        let drive = ArmDrive::new(&s, &machine, &both, w).over(schedule);
        let (errors_m, _) = drive.stroke_errors_m(&[], None);
        let largest_m = errors_m[100..].iter().fold(0.0_f64, |most, m| most.max(m.abs()));
        assert!(largest_m < 1.0e-3, "{largest_m}");
    }

    #[test]
    fn rounding_makes_no_other_arm_and_a_leak_does() {
        let was = Effects::default();
        let find = |name: &str| xt28_sim::effects::find(name).unwrap();
        let with = |effect: &Effect, by: f64| {
            let p = &effect.parameters[0];
            let mut is = was.clone();
            p.set(&mut is, Scope::Wheel(Wheel::Ml), p.neutral + by * p.tolerance);
            [Wheel::Ml, Wheel::Fr].map(|wheel| is_another_arm(&was, &is, wheel))
        };
        assert_eq!(with(find("accumulator-gas"), 1e-6), [false, false]);
        for effect in [find("accumulator-gas"), find("leakage-drift"), &LOCK_STIFFNESS] {
            assert_eq!(with(effect, 1.0), [true, false], "{}", effect.name);
        }
    }
}
