//! One arm's cylinder: oil moves the rest position, the closed oil makes the force, seals hold it up.
//!
//! Nominal model of the paper (section 3.2): a compliant one-dimensional lock in place of the
//! cylinder and its accumulator. The lock stands for all that gives way between valve and piston, so
//! the chambers' pressures follow from its force and have no state of their own.

use xt28_machine::Machine;

use super::Lock;
use crate::effects::{ArmEffects, SealStiction};
use crate::end_stop::EndStop;

/// The metal stops at both ends, N/m, N s/m and m (assumed).
const STOP: EndStop = EndStop { stiffness: 2.0e7, damping: 2.0e5, damped_at: 1e-3 };

/// Parameters of one cylinder with its accumulator.
#[derive(Clone, Debug, PartialEq)]
pub struct Cylinder {
    lock: Lock,
    damping_n_s_m: f64,
    stiction: SealStiction,
    stroke_max_m: f64,
    area_bore_m2: f64,
    area_rod_m2: f64,
    return_pressure_pa: f64,
}

/// What a cylinder remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CylinderState {
    /// Stroke at which the oil makes no force, m.
    pub rest_m: f64,
    /// Friction of the seals, N; positive against extension.
    pub friction_n: f64,
}

/// How a cylinder moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CylinderMotion {
    /// Stroke, m.
    pub stroke_m: f64,
    /// Stroke rate, m/s.
    pub stroke_rate_m_s: f64,
}

/// What a cylinder does at one stroke and rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CylinderForce {
    /// Force that extends, N; positive when the weight compresses the cylinder.
    pub force_n: f64,
    /// -d(force)/d(stroke), N/m.
    pub stiffness_n_m: f64,
    /// -d(force)/d(stroke rate), N s/m.
    pub damping_n_s_m: f64,
}

impl Cylinder {
    /// A cylinder of this machine.
    #[must_use]
    pub fn new(machine: &Machine, effects: &ArmEffects) -> Self {
        let (h, a) = (&machine.hydraulics, &machine.arms);
        Self {
            lock: Lock::new(machine, effects),
            damping_n_s_m: h.lock_damping_n_s_m * effects.lock_damping.factor,
            stiction: effects.stiction,
            stroke_max_m: a.stroke_max_m,
            area_bore_m2: a.area_bore_m2,
            area_rod_m2: a.area_rod_m2,
            return_pressure_pa: h.return_pressure_pa,
        }
    }

    /// The state in which the oil carries `force_n` in this motion.
    #[must_use]
    pub fn carrying(&self, force_n: f64, motion: &CylinderMotion) -> CylinderState {
        let spring_n = force_n + self.damping_n_s_m * motion.stroke_rate_m_s;
        let rest_m = motion.stroke_m + self.lock.compression_m(spring_n);
        CylinderState { rest_m, friction_n: 0.0 }
    }

    /// Lets oil for an extending speed of `speed_m_s` in over `dt_s` s, and the seals follow.
    ///
    /// The rest never runs further from the stroke than the relief valve's force allows.
    #[must_use]
    pub fn step(
        &self,
        state: CylinderState,
        motion: &CylinderMotion,
        speed_m_s: f64,
        dt_s: f64,
    ) -> CylinderState {
        let [drawn_m, pushed_m] = self.lock.reach_m();
        let next = self.step_shut(state, motion.stroke_rate_m_s, speed_m_s, dt_s);
        let rest_m = next.rest_m.clamp(motion.stroke_m + drawn_m, motion.stroke_m + pushed_m);
        CylinderState { rest_m, ..next }
    }

    /// The same while the relief valve is known to be shut, so that it does not matter where the stroke is.
    #[must_use]
    pub fn step_shut(
        &self,
        state: CylinderState,
        stroke_rate_m_s: f64,
        speed_m_s: f64,
        dt_s: f64,
    ) -> CylinderState {
        CylinderState {
            rest_m: state.rest_m + speed_m_s * dt_s,
            friction_n: self.stiction.step(state.friction_n, stroke_rate_m_s, dt_s),
        }
    }

    /// The force on the arm about this motion, over the coming `dt_s` s: of the oil, of the seals,
    /// and of the end stops beyond 0 and full.
    #[must_use]
    pub fn force(&self, state: CylinderState, motion: &CylinderMotion, dt_s: f64) -> CylinderForce {
        let rate_m_s = motion.stroke_rate_m_s;
        let [spring_n, spring_n_m] =
            self.lock.spring_along(state.rest_m - motion.stroke_m, -rate_m_s * dt_s);
        let [seal_n, seal_n_m] = self.stiction.ahead(state.friction_n, rate_m_s, dt_s);
        let mut out = CylinderForce {
            force_n: spring_n - self.damping_n_s_m * rate_m_s - seal_n,
            stiffness_n_m: spring_n_m + seal_n_m,
            damping_n_s_m: self.damping_n_s_m,
        };
        let beyond_m = motion.stroke_m - motion.stroke_m.clamp(0.0, self.stroke_max_m);
        let side = 1.0_f64.copysign(beyond_m);
        if let Some(push) = STOP.push(beyond_m.abs(), side * rate_m_s) {
            out.force_n -= side * push.force;
            out.stiffness_n_m += push.stiffness;
            out.damping_n_s_m += push.damping;
        }
        out
    }

    /// The force that is in the oil, and so in the pressures: without seals and end stops.
    #[must_use]
    pub fn oil_force_n(&self, state: CylinderState, motion: &CylinderMotion) -> f64 {
        let [spring_n, _] = self.lock.spring(state.rest_m - motion.stroke_m);
        spring_n - self.damping_n_s_m * motion.stroke_rate_m_s
    }

    /// Pressures of chambers A (bore) and B (rod), Pa, that make `oil_force_n`.
    ///
    /// While the cylinder pushes, B is at return pressure (assumed, as the machine file says); while it pulls, A
    /// stays at what balances that, so that neither jumps where the force changes its sign.
    #[must_use]
    pub fn pressures_pa(&self, oil_force_n: f64) -> [f64; 2] {
        if oil_force_n >= 0.0 {
            let b = self.return_pressure_pa;
            [(oil_force_n + b * self.area_rod_m2) / self.area_bore_m2, b]
        } else {
            let a = self.return_pressure_pa * self.area_rod_m2 / self.area_bore_m2;
            [a, (a * self.area_bore_m2 - oil_force_n) / self.area_rod_m2]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT_S: f64 = 0.005;

    fn nominal() -> Cylinder {
        Cylinder::new(&Machine::xt28(), &ArmEffects::default())
    }

    fn at(stroke_m: f64) -> CylinderMotion {
        CylinderMotion { stroke_m, stroke_rate_m_s: 0.0 }
    }

    #[test]
    fn oil_moves_the_rest() {
        let cylinder = nominal();
        let mut state = cylinder.carrying(0.0, &at(0.2));
        for _ in 0..20 {
            state = cylinder.step(state, &at(0.2), 0.3 * 0.212, DT_S);
        }
        assert!((state.rest_m - (0.2 + 0.3 * 0.212 * 0.1)).abs() < 1e-12);
    }

    #[test]
    fn pressures_make_the_force_on_both_sides_of_zero() {
        let machine = Machine::xt28();
        for force_n in [-50_000.0, -1.0, 0.0, 1.0, 55_000.0] {
            let [a, b] = nominal().pressures_pa(force_n);
            assert!(a >= 0.0 && b >= 0.0);
            let made = a * machine.arms.area_bore_m2 - b * machine.arms.area_rod_m2;
            assert!((made - force_n).abs() < 1e-6, "{force_n}: {made}");
        }
    }

    #[test]
    fn the_slope_is_the_derivative_of_the_force() {
        let mut soft = ArmEffects::default();
        (soft.gas.share, soft.lock_damping.factor) = (0.7, 1.4);
        for effects in [ArmEffects::default(), soft] {
            let cylinder = Cylinder::new(&Machine::xt28(), &effects);
            for stroke_m in [-0.01, -5e-4, 0.17, 0.25, 0.5005, 0.51] {
                let at = |ds: f64, dv: f64| {
                    let motion =
                        CylinderMotion { stroke_m: stroke_m + ds, stroke_rate_m_s: 0.01 + dv };
                    let state = CylinderState { rest_m: 0.2, friction_n: 0.0 };
                    cylinder.force(state, &motion, DT_S)
                };
                let d = 1e-6;
                let slope = -(at(d, 0.0).force_n - at(-d, 0.0).force_n) / (2.0 * d);
                let rate = -(at(0.0, d).force_n - at(0.0, -d).force_n) / (2.0 * d);
                assert!((slope / at(0.0, 0.0).stiffness_n_m - 1.0).abs() < 1e-6);
                assert!((rate / at(0.0, 0.0).damping_n_s_m - 1.0).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn an_end_stop_pushes_and_never_pulls() {
        let cylinder = nominal();
        let state = CylinderState { rest_m: 0.25, friction_n: 0.0 };
        for (stroke_m, outward) in [(0.502, 1.0), (0.5004, 1.0), (-0.002, -1.0), (-0.0004, -1.0)] {
            for rate_m_s in [-0.5, -0.05, 0.0, 0.05, 0.5] {
                let motion = CylinderMotion { stroke_m, stroke_rate_m_s: rate_m_s };
                let force_n = cylinder.force(state, &motion, DT_S).force_n;
                let stop_n = force_n - cylinder.oil_force_n(state, &motion);
                assert!(-outward * stop_n >= 0.0, "{stroke_m} m, {rate_m_s} m/s: {stop_n} N");
                let leaves = outward * rate_m_s < -0.3;
                assert_eq!(stop_n == 0.0, leaves, "{stroke_m} m, {rate_m_s} m/s: {stop_n} N");
            }
        }
    }

    #[test]
    fn the_relief_valve_bounds_the_force() {
        let machine = Machine::xt28();
        let mut gas = ArmEffects::default();
        gas.gas.share = 1.0;
        for effects in [ArmEffects::default(), gas] {
            let cylinder = Cylinder::new(&machine, &effects);
            let mut state = cylinder.carrying(0.0, &at(0.5));
            for _ in 0..10_000 {
                state = cylinder.step(state, &at(0.5), 0.212, DT_S);
            }
            let force_n = cylinder.force(state, &at(0.5), DT_S).force_n;
            assert!((force_n - machine.arms.force_max_n).abs() < 1e-3, "{force_n}");
        }
    }
}
