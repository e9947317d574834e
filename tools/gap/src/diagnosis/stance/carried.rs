//! What each wheel carries, from the pressures of its cylinder.

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Wheel};
use xt28_sim::{Effects, Parts};

use super::instants::{AtWheel, Instant, PRESSURE_FILTER_S};
use super::layout::Reach;
use super::motion::lagged;
use crate::diagnosis::signals::{DT_S, Samples, Signals};

/// Halvings in which the motors' holds are balanced: to a millionth.
const BISECTIONS: usize = 20;

/// One arm as believed: how its sensors read and what hinders it.
pub(super) struct Carrier<'a> {
    wheel: Wheel,
    parts: &'a Parts,
    effects: &'a Effects,
    /// Area by which a bore pressure makes a load, m².
    area_m2: f64,
    /// Weight of wheel and arm that the pivot does not carry, N.
    own_n: f64,
    /// Rolling resistance per load, m.
    resistance_m: f64,
    /// Friction of the seals as late as the pressures are, N; empty without any.
    seal_n: Samples,
}

impl<'a> Carrier<'a> {
    pub(super) fn new(
        s: &Signals,
        machine: &Machine,
        effects: &'a Effects,
        parts: &'a Parts,
        wheel: Wheel,
    ) -> Self {
        let carried_kg =
            parts.wheel.mass_kg + parts.arms[wheel].body.mass_kg * machine.vehicle.arm_com_share;
        let added = effects.wheels[wheel].rolling_resistance.added;
        Self {
            wheel,
            parts,
            effects,
            area_m2: machine.arms.area_bore_m2,
            own_n: carried_kg * GRAVITY_M_S2,
            resistance_m: (machine.wheels.rolling_resistance + added) * machine.wheels.radius_m,
            seal_n: seal_friction_n(s, effects, wheel),
        }
    }

    /// Where the wheel is, and what it presses on the ground, N; its idle motor holds `holds_nm`.
    ///
    /// Moments about the arm's pivot. What the wheel pushes along the ground acts at its contact,
    /// `drop + radius` below the pivot: the motor's torque is between wheel and arm.
    pub(super) fn at(&self, instant: &Instant, holds_nm: f64) -> (Reach, f64) {
        let AtWheel { stroke_m, load_n, torque_nm, rolls, .. } = instant.wheels[self.wheel];
        let e = &self.effects.wheels[self.wheel];
        let stroke_m = (stroke_m - e.stroke_bias.bias_m) / e.stroke_scale.factor;
        let oil_n = (load_n - e.pressure_bias.bias_pa * self.area_m2) / e.pressure_scale.factor;
        let cylinder_n = oil_n - self.seal_n.get(instant.sample).copied().unwrap_or(0.0);
        let drive_nm = torque_nm - holds_nm;
        let pose = self.parts.linkage.at_stroke(stroke_m);
        let radius_m = self.parts.radius_m;
        let below_m = self.parts.arms[self.wheel].extends * (pose.drop_m + radius_m) / radius_m;
        let moment_nm = self.own_n * pose.reach_m + cylinder_n * pose.lever_m - below_m * drive_nm;
        let normal_n = moment_nm / (pose.reach_m - below_m * rolls * self.resistance_m);
        (Reach { reach_m: pose.reach_m, drop_m: pose.drop_m }, normal_n)
    }
}

/// What each idle motor holds its wheel by, Nm: against its last turn, and all together by nothing, for
/// the machine stands still. Wheels that are pushed the same way push the machine instead.
pub(super) fn held_nm(instant: &Instant, effects: &Effects) -> PerWheel<f64> {
    let most_nm = PerWheel::from_fn(|w| effects.wheels[w].standstill_drag.torque_nm);
    if most_nm.iter().all(|(_, nm)| *nm == 0.0) {
        return PerWheel::splat(0.0);
    }
    let each = |less: f64| {
        PerWheel::from_fn(|w| most_nm[w] * (instant.wheels[w].held - less).clamp(-1.0, 1.0))
    };
    let (mut low, mut high) = (-2.0, 2.0);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if each(middle).sum() > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    each(0.5 * (low + high))
}

/// Friction of the seals on the measured motion, as late as the pressures are; N.
fn seal_friction_n(s: &Signals, effects: &Effects, wheel: Wheel) -> Samples {
    let law = &effects.arms[wheel].stiction;
    if law.coulomb_n + law.stribeck_n == 0.0 {
        return Samples::new();
    }
    let scale = effects.wheels[wheel].stroke_scale.factor;
    let mut friction_n = 0.0;
    let step = |rate: &f64| {
        friction_n = law.step(friction_n, rate / scale, DT_S);
        friction_n
    };
    lagged(s.stroke_rate_m_s[wheel].iter().map(step), PRESSURE_FILTER_S)
}
