//! A cylinder whose valve holds the load: oil shut in on the side that carries, behind a throttle.
//!
//! Pilot-operated checks shut in the chamber that the load presses on and open the other one to the
//! return line. The shut chamber feels its accumulator through a throttle:
//!
//! ```text
//! valve --> reservoir p --[throttle]-- chamber pc | piston
//! Cr dp/dt = A v - g (p - pc)        Co dpc/dt = g (p - pc) - A ds/dt
//! ```
//!
//! With v the speed that the valve's flow asks for. When the load changes its sign the reservoir
//! runs down to the pressure at which both chambers balance, and the other side takes over. Slow and
//! stiff together (3 ms against 100 s), so both pressures are taken by the trapezoidal rule.

use super::reservoir::{Reservoir, oil_compliance_m3_pa};

/// Substeps of one step: the throttle and the chamber's oil have a time constant of 3 ms.
const SUBSTEPS: u32 = 2;
/// Oil turns to vapour, Pa above the atmosphere.
const VAPOUR_PA: f64 = -0.9e5;

/// The chamber that carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// Chamber A, which weight presses on.
    Bore,
    /// Chamber B, which a hanging wheel draws on.
    Rod,
}

/// Sizes of a cylinder and what is piped to it; sides in the order bore, rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cylinder {
    pub(crate) area_m2: [f64; 2],
    pub(crate) stroke_max_m: f64,
    /// Pressure of the return line, Pa.
    pub(crate) return_pa: f64,
    pub(crate) stiffness_n_m: f64,
    pub(crate) damping_n_s_m: f64,
    /// Instead of the spring on the bore side.
    pub(crate) gas: Option<crate::truth::Gas>,
}

/// How the rod moved over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct RodMotion {
    pub(crate) stroke_m: f64,
    /// At the start and at the end of the step, m/s.
    pub(crate) rate_m_s: [f64; 2],
    /// Travel in the step, m.
    pub(crate) travel_m: f64,
}

/// Pressures of the side that carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Holding {
    side: Side,
    reservoir_pa: f64,
    chamber_pa: f64,
}

impl Cylinder {
    /// Pressure at which a chamber balances the other one at return pressure, Pa.
    fn floor_pa(&self, side: Side) -> f64 {
        match side {
            Side::Bore => self.return_pa * self.area_m2[1] / self.area_m2[0],
            Side::Rod => self.return_pa,
        }
    }

    fn area_m2(&self, side: Side) -> f64 {
        self.area_m2[side as usize]
    }

    fn oil_m3_pa(&self, side: Side, stroke_m: f64) -> f64 {
        let length_m = match side {
            Side::Bore => stroke_m,
            Side::Rod => self.stroke_max_m - stroke_m,
        };
        oil_compliance_m3_pa(self.area_m2(side) * length_m)
    }

    /// The accumulator that, with the oil at 0.2 m, makes the stiffness asked for.
    fn reservoir(&self, side: Side) -> Reservoir {
        if let (Side::Bore, Some(gas)) = (side, self.gas) {
            return Reservoir::Gas(gas);
        }
        let area = self.area_m2(side);
        let whole = area * area / self.stiffness_n_m;
        let compliance_m3_pa = (whole - self.oil_m3_pa(side, 0.2)).max(0.1 * whole);
        Reservoir::Spring { compliance_m3_pa }
    }
}

impl Holding {
    /// At rest under `load_n`, pressed in > 0.
    pub(crate) fn settled(cylinder: &Cylinder, load_n: f64) -> Self {
        let [bore, rod] = cylinder.area_m2;
        let (side, pa) = if load_n >= 0.0 {
            (Side::Bore, (load_n + rod * cylinder.return_pa) / bore)
        } else {
            (Side::Rod, cylinder.return_pa - load_n / rod)
        };
        Self { side, reservoir_pa: pa, chamber_pa: pa }
    }

    /// Pressures of chambers A and B, Pa.
    pub(crate) fn pressures_pa(&self, cylinder: &Cylinder) -> [f64; 2] {
        match self.side {
            Side::Bore => [self.chamber_pa, cylinder.return_pa],
            Side::Rod => [cylinder.floor_pa(Side::Bore), self.chamber_pa],
        }
    }

    /// Force of the oil on the rod, N; outward > 0.
    pub(crate) fn force_n(&self, cylinder: &Cylinder) -> f64 {
        let [a, b] = self.pressures_pa(cylinder);
        cylinder.area_m2[0] * a - cylinder.area_m2[1] * b
    }

    /// Slope of the force against stroke, N/m.
    pub(crate) fn stiffness_n_m(&self, cylinder: &Cylinder, stroke_m: f64) -> f64 {
        let area = cylinder.area_m2(self.side);
        let store = cylinder.reservoir(self.side).compliance_m3_pa(self.reservoir_pa);
        area * area / (store + cylinder.oil_m3_pa(self.side, stroke_m))
    }

    /// Goes on by `dt_s` s in which the rod moved and the valve's flow asked for `speed_m_s`.
    pub(crate) fn step(&mut self, cylinder: &Cylinder, rod: &RodMotion, speed_m_s: f64, dt_s: f64) {
        let h_s = dt_s / f64::from(SUBSTEPS);
        let bend = (rod.rate_m_s[1] - rod.rate_m_s[0]) / dt_s;
        for i in 0..SUBSTEPS {
            let middle_s = (f64::from(i) + 0.5) * h_s - 0.5 * dt_s;
            let rate_m_s = rod.travel_m / dt_s + bend * middle_s;
            self.substep(cylinder, rod.stroke_m, speed_m_s, rate_m_s, h_s);
            self.hand_over(cylinder, rod.stroke_m);
        }
    }

    fn substep(
        &mut self,
        cylinder: &Cylinder,
        stroke_m: f64,
        speed_m_s: f64,
        rate_m_s: f64,
        h_s: f64,
    ) {
        let area = cylinder.area_m2(self.side);
        // Outward travel takes oil from the bore side and gives it on the rod side.
        let area = if self.side == Side::Bore { area } else { -area };
        let store = cylinder.reservoir(self.side).compliance_m3_pa(self.reservoir_pa);
        let oil = cylinder.oil_m3_pa(self.side, stroke_m);
        let conductance = area * area / cylinder.damping_n_s_m;
        let (a, b) = (0.5 * h_s * conductance / store, 0.5 * h_s * conductance / oil);
        let (p, pc) = (self.reservoir_pa, self.chamber_pa);
        let right_p = p + a * (pc - p) + h_s * area * speed_m_s / store;
        let right_pc = pc + b * (p - pc) - h_s * area * rate_m_s / oil;
        let det = 1.0 + a + b;
        self.reservoir_pa = ((1.0 + b) * right_p + a * right_pc) / det;
        self.chamber_pa = (b * right_p + (1.0 + a) * right_pc).max(VAPOUR_PA * det) / det;
    }

    /// Hands the load to the other chamber once this one has nothing left to press with.
    fn hand_over(&mut self, cylinder: &Cylinder, stroke_m: f64) {
        let floor = cylinder.floor_pa(self.side);
        if self.reservoir_pa >= floor {
            return;
        }
        let compliance = |side: Side, pa: f64| {
            cylinder.reservoir(side).compliance_m3_pa(pa) + cylinder.oil_m3_pa(side, stroke_m)
        };
        let travel_m = (floor - self.reservoir_pa) * compliance(self.side, self.reservoir_pa)
            / cylinder.area_m2(self.side);
        self.side = if self.side == Side::Bore { Side::Rod } else { Side::Bore };
        let floor = cylinder.floor_pa(self.side);
        let rise = travel_m * cylinder.area_m2(self.side) / compliance(self.side, floor);
        (self.reservoir_pa, self.chamber_pa) = (floor + rise, floor + rise);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT_S: f64 = 0.002;

    fn cylinder() -> Cylinder {
        Cylinder {
            area_m2: [0.00785, 0.00589],
            stroke_max_m: 0.5,
            return_pa: 5.0e5,
            stiffness_n_m: 2.0e6,
            damping_n_s_m: 8.5e4,
            gas: None,
        }
    }

    /// Force after the rod has gone from 0.2 m to `to_m` at `rate_m_s`, still moving.
    fn moved(load_n: f64, by_m: f64, rate_m_s: f64) -> f64 {
        let cylinder = cylinder();
        let mut holding = Holding::settled(&cylinder, load_n);
        let rate_m_s = rate_m_s * by_m.signum();
        let steps = (by_m / rate_m_s / DT_S).round();
        let mut stroke_m = 0.2;
        let mut done = 0.0;
        while done < steps {
            stroke_m += rate_m_s * DT_S;
            let rod = RodMotion { stroke_m, rate_m_s: [rate_m_s; 2], travel_m: rate_m_s * DT_S };
            holding.step(&cylinder, &rod, 0.0, DT_S);
            done += 1.0;
        }
        holding.force_n(&cylinder)
    }

    #[test]
    fn the_shut_cylinder_is_the_soft_lock() {
        // k s + c ds/dt, within what the oil's own give varies over the stroke.
        for (load_n, by_m) in [(50e3, -0.01), (50e3, 0.01), (-20e3, 0.005), (-20e3, -0.005)] {
            let rate_m_s = 0.02;
            let wanted = load_n - 2.0e6 * by_m - 8.5e4 * rate_m_s * f64::signum(by_m);
            let found = moved(load_n, by_m, rate_m_s);
            assert!((found - wanted).abs() < 0.02 * 20e3, "{load_n} {by_m}: {found} {wanted}");
        }
    }

    #[test]
    fn the_lock_goes_straight_through_zero_and_back() {
        let found = moved(4e3, 0.006, 0.001);
        assert!((found - (4e3 - 12e3 - 85.0)).abs() < 200.0, "{found}");
        let found = moved(-4e3, -0.006, 0.001);
        assert!((found - (-4e3 + 12e3 + 85.0)).abs() < 200.0, "{found}");
    }

    #[test]
    fn the_valve_moves_the_lock_at_its_speed() {
        let cylinder = cylinder();
        let mut holding = Holding::settled(&cylinder, 50e3);
        let rod = |step: i32| RodMotion {
            stroke_m: 0.2 + 0.06 * DT_S * f64::from(step),
            rate_m_s: [0.06; 2],
            travel_m: 0.06 * DT_S,
        };
        for step in 0..500 {
            holding.step(&cylinder, &rod(step), 0.06, DT_S);
        }
        // Driven along at its own speed: only the throttle's drag is missing, and of that what the
        // chamber's oil gave to the accumulator as it expanded.
        assert!((holding.force_n(&cylinder) - (50e3 - 8.5e4 * 0.06)).abs() < 500.0);
    }

    #[test]
    fn a_hanging_load_shows_on_the_rod_side() {
        let cylinder = cylinder();
        let [a, b] = Holding::settled(&cylinder, -5e3).pressures_pa(&cylinder);
        assert!((a - 5.0e5 * 0.00589 / 0.00785).abs() < 1.0);
        assert!((b - (5.0e5 + 5e3 / 0.00589)).abs() < 1.0);
    }
}
