//! One cylinder's load as the ECU reads it, and as it was before the ECU's pressure filter.

use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::effects::WheelEffects;

use crate::diagnosis::gauge::rod_n;
use crate::diagnosis::signals::{Samples, Signals};

/// What the ECU's pressure filter keeps of its last output a tick (facts 3.2): 0.164 s.
pub(super) const KEPT: f64 = 0.940_88;

/// Share of the pressure of an idle chamber below which it counts as drained (assumed: above what
/// a reading in whole kilopascals leaves open, below any chamber that is full).
const DRAINED: f64 = 0.8;

/// Stroke rate at which a rod is slow, m/s (assumed): a damper of four times the nominal 85 kN s/m then
/// holds 1.7 kN.
const SLOW_M_S: f64 = 0.005;

/// Pressure at which a chamber's frame is full, Pa: 25 000 kPa (facts 2.1), less the 17 steps of a kilopascal by which
/// the ECU's filter, which cuts off, stops short of it.
const FULL_PA: f64 = 24.98e6;

/// Samples between two readings at the slowest rate that pressures are logged at, 20 Hz.
const READINGS_APART: usize = 5;

/// How long before and after a reading at the end of its scale the filter cannot be undone, samples.
const OFF_SCALE_SAMPLES: usize = 4 * READINGS_APART;

/// Loads of one cylinder over a run, positive under weight.
pub(super) struct Loads {
    /// As read, N.
    pub(super) reading_n: Samples,
    /// With the filter undone, N.
    pub(super) oil_n: Samples,
    /// What the rod chamber shows against the rod, as read, N.
    pub(super) rod_n: Samples,
    /// The same with the filter undone, N.
    pub(super) rod_oil_n: Samples,
    /// Whether a chamber was drained: the piston ran ahead of its oil, so that what came in came past
    /// the valve, and has not come to rest since; or whether its sensor was off its scale. Empty where
    /// no pressures are logged.
    pub(super) is_drained: Vec<bool>,
}

impl Loads {
    /// From the chambers' pressures where the log has them, else from the loads that it derives.
    ///
    /// Between two readings the load before the filter is the one that, held, leads from the first
    /// to the second. A reading is whole kilopascals, so what is undone is right to 0.2 kN.
    pub(super) fn new(
        signals: &Signals,
        machine: &Machine,
        sensors: &WheelEffects,
        wheel: Wheel,
    ) -> Self {
        let [bore, rod] = &signals.chamber_pa[wheel];
        let (a, is_new) = (&machine.arms, &signals.load_is_new[wheel]);
        let reading_n: Samples = if bore.is_empty() || rod.is_empty() {
            signals.cylinder_load_n[wheel].clone()
        } else {
            let load = |(bore, rod): (&f64, &f64)| bore * a.area_bore_m2 - rod * a.area_rod_m2;
            bore.iter().zip(rod).map(load).collect()
        };
        let rod_pa = DRAINED * machine.hydraulics.return_pressure_pa;
        let bore_pa = rod_pa * a.area_rod_m2 / a.area_bore_m2;
        let (true_bore, true_rod) = (undone(bore, is_new), undone(rod, is_new));
        let (bias_pa, scale) = (sensors.pressure_bias.bias_pa, sensors.pressure_scale.factor);
        let each = true_bore.iter().zip(&true_rod).enumerate();
        let drained = |(i, (bore, rod)): (usize, (&f64, &f64))| {
            // As read too, so that no belief is to begin anew less often than another.
            let least = bore.min((bore - bias_pa) / scale);
            least < bore_pa || *rod < rod_pa || is_off_scale(signals, wheel, i)
        };
        let mut is_drained: Vec<bool> = each.map(drained).collect();
        // Until the rod is slow again nobody knows how much of the load is the damper's.
        let rate_m_s = &signals.stroke_rate_m_s[wheel];
        for i in 1..is_drained.len() {
            is_drained[i] |= is_drained[i - 1] && rate_m_s[i].abs() > SLOW_M_S;
        }
        let oil_n = undone(&reading_n, is_new);
        let rod_n = (0..signals.len).map(|i| rod_n(signals, machine, wheel, i)).collect();
        let rod_oil_n = undone(&rod_n, is_new);
        Self { reading_n, oil_n, rod_n, rod_oil_n, is_drained }
    }
}

/// Whether a pressure of a cylinder is at the least or at the most that its frame tells, or was or will be
/// shortly, so that nobody knows what it is: a sensor that reads too little, under little load, or a heavy machine
/// on a ramp.
pub(in crate::diagnosis) fn is_off_scale(signals: &Signals, wheel: Wheel, i: usize) -> bool {
    let off =
        signals.off_scale(|| PerWheel::from_fn(|wheel| off_scale(&signals.chamber_pa[wheel])));
    off[wheel].get(i) == Some(&true)
}

/// The same of every sample of a cylinder's `chambers`. Told with the filter undone: one that climbs to the end of the
/// scale shows it a second after its sensor.
fn off_scale(chambers: &[Samples; 2]) -> Vec<bool> {
    let mut off = vec![false; chambers[0].len()];
    let kept = KEPT.powi(READINGS_APART as i32);
    for pa in chambers {
        for i in 0..pa.len() {
            let before_pa = pa[i.saturating_sub(READINGS_APART)];
            let sensed_pa = (pa[i] - kept * before_pa) / (1.0 - kept);
            if sensed_pa <= 0.0 || sensed_pa >= FULL_PA {
                let end = off.len().min(i + OFF_SCALE_SAMPLES + 1);
                off[i.saturating_sub(OFF_SCALE_SAMPLES).min(end)..end].fill(true);
            }
        }
    }
    off
}

/// Input of a filter that keeps [`KEPT`] of itself every sample, from its output where that is new.
fn undone(output: &Samples, is_new: &[bool]) -> Samples {
    let mut input = output.clone();
    let (mut from, mut kept) = (0, 1.0);
    for i in 1..output.len() {
        kept *= KEPT;
        if is_new[i] {
            let held = (output[i] - kept * output[from]) / (1.0 - kept);
            input[from + 1..=i].fill(held);
            (from, kept) = (i, 1.0);
        }
    }
    input
}

#[cfg(test)]
mod tests {
    use super::super::still::still;
    use super::*;

    #[test]
    fn a_chamber_that_its_frame_cannot_tell_is_off_scale_and_for_a_while_beside() {
        let mut s = still(10);
        for pa in s.chamber_pa[Wheel::Fr].iter_mut() {
            pa.fill(8.0e6);
        }
        // 25 000 kPa as the ECU's filter shows it.
        s.chamber_pa[Wheel::Fr][0][500..600].fill(24.986e6);
        let off = |i| is_off_scale(&s, Wheel::Fr, i);
        assert!(!off(400) && off(490) && off(550) && off(610) && !off(700));
    }

    /// A load that bounces is at the end of its sensor's scale for a tenth of a second, which the filter never shows.
    #[test]
    fn a_sensor_at_the_end_of_its_scale_is_seen_behind_the_filter() {
        for every in [1, 5] {
            let mut shown_pa = 15.0e6;
            let climbs = |i: usize| if (500..510).contains(&i) { 25.0e6 } else { 15.0e6 };
            let mut s = still(10);
            let [bore, rod] = &mut s.chamber_pa[Wheel::Fr];
            rod.fill(5.0e5);
            let mut held_pa = shown_pa;
            for (i, pa) in bore.iter_mut().enumerate() {
                // In whole kilopascals, cut off.
                shown_pa = 1e3 * ((KEPT * shown_pa + (1.0 - KEPT) * climbs(i)) * 1e-3).trunc();
                held_pa = if i % every == every - 1 { shown_pa } else { held_pa };
                *pa = held_pa;
            }
            assert!(bore.iter().all(|pa| *pa < 20.0e6));
            let off = |i| is_off_scale(&s, Wheel::Fr, i);
            assert!(!off(470) && off(500) && off(509) && !off(540), "{every}");
        }
    }

    #[test]
    fn what_the_filter_does_is_undone_at_any_rate_of_readings() {
        for every in [1, 5] {
            let input: Samples = (0..200).map(|i| f64::from(i / 20) * 1e3).collect();
            let mut kept = 0.0;
            let filtered: Samples = input
                .iter()
                .map(|n| {
                    kept = KEPT * kept + (1.0 - KEPT) * n;
                    kept
                })
                .collect();
            let is_new: Vec<bool> = (0..200).map(|i| i % every == every - 1).collect();
            let mut last = 0.0;
            let held: Samples = filtered
                .iter()
                .zip(&is_new)
                .map(|(now, is_new)| {
                    last = if *is_new { *now } else { last };
                    last
                })
                .collect();
            let found = undone(&held, &is_new);
            let worst = (every..200).map(|i| (found[i] - input[i]).abs()).fold(0.0, f64::max);
            assert!(worst < 1e-6, "{every}: {worst}");
        }
    }
}
