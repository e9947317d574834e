//! One arm's hydraulics: the valve moves the rest position, the accumulator's soft lock makes the force.
//!
//! Nominal model of the paper (section 3.2): an ideal valve whose flow is proportional to its
//! opening, and a compliant one-dimensional lock in place of the cylinder and its accumulator.

use xt28_machine::Machine;

/// Stiffness of the metal end stops, N/m (assumed).
const STOP_STIFFNESS_N_M: f64 = 2.0e7;
/// Damping of the metal end stops, N s/m (assumed).
const STOP_DAMPING_N_S_M: f64 = 2.0e5;

/// Parameters of one cylinder with its valve and accumulator.
#[derive(Clone, Debug, PartialEq)]
pub struct Cylinder {
    speed_full_m_s: f64,
    stiffness_n_m: f64,
    damping_n_s_m: f64,
    stroke_max_m: f64,
    force_max_n: f64,
    area_bore_m2: f64,
    area_rod_m2: f64,
    return_pressure_pa: f64,
}

/// What a cylinder remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CylinderState {
    /// Stroke at which the lock makes no force, m.
    pub rest_m: f64,
}

/// What acts on a cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CylinderInput {
    /// Spool opening, -1 (retract) to 1 (extend).
    pub opening: f64,
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
    pub const fn new(machine: &Machine) -> Self {
        let (h, a) = (&machine.hydraulics, &machine.arms);
        Self {
            speed_full_m_s: h.speed_full_m_s,
            stiffness_n_m: h.lock_stiffness_n_m,
            damping_n_s_m: h.lock_damping_n_s_m,
            stroke_max_m: a.stroke_max_m,
            force_max_n: a.force_max_n,
            area_bore_m2: a.area_bore_m2,
            area_rod_m2: a.area_rod_m2,
            return_pressure_pa: h.return_pressure_pa,
        }
    }

    /// The state at which the cylinder carries `force_n` at rest at `stroke_m`.
    #[must_use]
    pub fn settled(&self, stroke_m: f64, force_n: f64) -> CylinderState {
        CylinderState { rest_m: stroke_m + force_n / self.stiffness_n_m }
    }

    /// Moves the rest position by the valve's flow over `dt_s` s.
    ///
    /// The rest never runs further from the stroke than the relief valve's force allows.
    #[must_use]
    pub fn step(&self, state: CylinderState, input: &CylinderInput, dt_s: f64) -> CylinderState {
        let opening = input.opening.clamp(-1.0, 1.0);
        let rest_m = state.rest_m + opening * self.speed_full_m_s * dt_s;
        let reach_m = self.force_max_n / self.stiffness_n_m;
        CylinderState { rest_m: rest_m.clamp(input.stroke_m - reach_m, input.stroke_m + reach_m) }
    }

    /// The force at a stroke and a rate: k (rest - s) - c ds/dt, and the end stops beyond 0 and full.
    #[must_use]
    pub fn force(&self, state: CylinderState, input: &CylinderInput) -> CylinderForce {
        let mut out = CylinderForce {
            force_n: self.oil_force_n(state, input),
            stiffness_n_m: self.stiffness_n_m,
            damping_n_s_m: self.damping_n_s_m,
        };
        let beyond_m = input.stroke_m - input.stroke_m.clamp(0.0, self.stroke_max_m);
        if beyond_m != 0.0 {
            out.force_n -=
                STOP_STIFFNESS_N_M * beyond_m + STOP_DAMPING_N_S_M * input.stroke_rate_m_s;
            out.stiffness_n_m += STOP_STIFFNESS_N_M;
            out.damping_n_s_m += STOP_DAMPING_N_S_M;
        }
        out
    }

    /// The force that is in the oil: what the lock makes, without the end stops.
    #[must_use]
    pub fn oil_force_n(&self, state: CylinderState, input: &CylinderInput) -> f64 {
        self.stiffness_n_m * (state.rest_m - input.stroke_m)
            - self.damping_n_s_m * input.stroke_rate_m_s
    }

    /// Pressures of chambers A (bore) and B (rod), Pa, that make `oil_force_n`.
    ///
    /// The chamber that does not carry is at return pressure (assumed, as the machine file says).
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

    #[test]
    fn the_valve_moves_the_rest_at_its_full_speed() {
        let cylinder = Cylinder::new(&Machine::xt28());
        let mut state = cylinder.settled(0.2, 0.0);
        let input = CylinderInput { opening: 0.3, stroke_m: 0.2, stroke_rate_m_s: 0.0 };
        for _ in 0..20 {
            state = cylinder.step(state, &input, 0.005);
        }
        assert!((state.rest_m - (0.2 + 0.3 * 0.212 * 0.1)).abs() < 1e-12);
    }

    #[test]
    fn pressures_make_the_force_on_both_sides_of_zero() {
        let machine = Machine::xt28();
        let cylinder = Cylinder::new(&machine);
        for force_n in [-50_000.0, -1.0, 0.0, 1.0, 55_000.0] {
            let [a, b] = cylinder.pressures_pa(force_n);
            assert!(a >= 0.0 && b >= 0.0);
            let made = a * machine.arms.area_bore_m2 - b * machine.arms.area_rod_m2;
            assert!((made - force_n).abs() < 1e-6, "{force_n}: {made}");
        }
    }

    #[test]
    fn the_slope_is_the_derivative_of_the_force() {
        let cylinder = Cylinder::new(&Machine::xt28());
        for stroke_m in [-0.01, 0.25, 0.51] {
            let at = |ds: f64, dv: f64| {
                let input = CylinderInput {
                    opening: 0.0,
                    stroke_m: stroke_m + ds,
                    stroke_rate_m_s: 0.01 + dv,
                };
                cylinder.force(CylinderState { rest_m: 0.2 }, &input)
            };
            let d = 1e-6;
            let slope = -(at(d, 0.0).force_n - at(-d, 0.0).force_n) / (2.0 * d);
            let rate = -(at(0.0, d).force_n - at(0.0, -d).force_n) / (2.0 * d);
            assert!((slope / at(0.0, 0.0).stiffness_n_m - 1.0).abs() < 1e-6);
            assert!((rate / at(0.0, 0.0).damping_n_s_m - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn the_relief_valve_bounds_the_force() {
        let machine = Machine::xt28();
        let cylinder = Cylinder::new(&machine);
        let input = CylinderInput { opening: 1.0, stroke_m: 0.5, stroke_rate_m_s: 0.0 };
        let mut state = cylinder.settled(0.5, 0.0);
        for _ in 0..10_000 {
            state = cylinder.step(state, &input, 0.005);
        }
        let force_n = cylinder.force(state, &input).force_n;
        assert!((force_n - machine.arms.force_max_n).abs() < 1e-6);
    }
}
