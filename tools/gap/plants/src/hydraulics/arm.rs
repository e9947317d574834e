//! One arm from the current in its solenoids to the force on its rod.

use super::compensator::flow_share;
use super::holding::{Cylinder, Holding, RodMotion};
use super::seal::Seal;
use super::spool::Spool;
use crate::history::History;
use crate::truth::{ArmTruth, Truth};

/// Range of load over which an unloaded arm begins to draw out, N (assumed: a hanging wheel's).
const SAG_SPAN_N: f64 = 6.0e3;

/// What an arm remembers.
#[derive(Clone, Debug)]
pub(crate) struct Arm {
    commands: History,
    pilot: f64,
    spool: Spool,
    holding: Holding,
    seal: Seal,
    stuck: f64,
    force: RodForce,
}

/// Force on the rod and its slopes about the present motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct RodForce {
    /// Outward > 0, N.
    pub(crate) force_n: f64,
    pub(crate) stiffness_n_m: f64,
    pub(crate) damping_n_s_m: f64,
}

/// What an arm asks of the pump.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Demand {
    /// Speed at the pump's full margin, m/s; extending > 0.
    pub(crate) speed_m_s: f64,
    /// Oil drawn for it, m³/s.
    pub(crate) flow_m3_s: f64,
}

fn cylinder(truth: &Truth, arm: &ArmTruth, time_s: f64) -> Cylinder {
    let a = &truth.machine.arms;
    // The oil warms up: from `cold_factor` at the start to its inverse after `heating_s`.
    let warm = (1.0 - 2.0 * time_s / arm.heating_s).clamp(-1.0, 1.0);
    Cylinder {
        area_m2: [a.area_bore_m2, a.area_rod_m2],
        stroke_max_m: a.stroke_max_m,
        return_pa: truth.machine.hydraulics.return_pressure_pa,
        stiffness_n_m: arm.stiffness_n_m,
        damping_n_s_m: arm.damping_n_s_m * arm.cold_factor.powf(warm),
        gas: arm.gas,
    }
}

impl Arm {
    /// At rest under `load_n` with its valve closed, stepped every `dt_s` s.
    pub(crate) fn settled(truth: &Truth, arm: &ArmTruth, load_n: f64, dt_s: f64) -> Self {
        let mut new = Self {
            commands: History::new(dt_s, 0.0),
            pilot: 0.0,
            spool: Spool::default(),
            holding: Holding::settled(&cylinder(truth, arm, 0.0), load_n),
            seal: Seal::default(),
            stuck: 0.0,
            force: RodForce::default(),
        };
        new.force = RodForce { force_n: load_n, ..new.force };
        new
    }

    /// Moves pilot and spool over `dt_s` s under the ECU's `command`, `partner` being the one of the
    /// valve beside it.
    pub(crate) fn open(
        &mut self,
        truth: &Truth,
        arm: &ArmTruth,
        [command, partner]: [f64; 2],
        time_s: f64,
        dt_s: f64,
    ) -> Demand {
        if time_s.rem_euclid(arm.stuck_every_s) >= arm.stuck_s {
            self.stuck = command;
        }
        self.commands.note(self.stuck + arm.cross_talk * partner);
        let arrived = self.commands.back(arm.delay_s);
        // Trapezoidal over the step for a held command.
        let keep = ((arm.pilot_s - 0.5 * dt_s) / (arm.pilot_s + 0.5 * dt_s)).max(0.0);
        self.pilot = arrived + keep * (self.pilot - arrived);
        let opening = self.spool.step(&arm.spool, self.pilot, dt_s);
        let cylinder = cylinder(truth, arm, time_s);
        let [a_pa, b_pa] = self.holding.pressures_pa(&cylinder);
        let notch = arm.notches[usize::from(opening < 0.0)];
        let load_pa = a_pa - b_pa * cylinder.area_m2[1] / cylinder.area_m2[0];
        let share = flow_share(arm.compensator_loss, opening, load_pa) * arm.margin.sqrt();
        let speed_m_s = opening * truth.machine.hydraulics.speed_full_m_s * notch * share;
        let area_m2 = cylinder.area_m2[usize::from(opening < 0.0)];
        Demand { speed_m_s, flow_m3_s: speed_m_s.abs() * area_m2 }
    }

    /// Presses on the rod, which moved as `rod` in the last `dt_s` s, with oil for `speed_m_s`.
    pub(crate) fn press(
        &mut self,
        truth: &Truth,
        arm: &ArmTruth,
        rod: &RodMotion,
        speed_m_s: f64,
        time_s: f64,
        dt_s: f64,
    ) -> RodForce {
        let cylinder = cylinder(truth, arm, time_s);
        let oil_n = self.holding.force_n(&cylinder);
        let creep_m_s = -arm.leak_m_s * oil_n / truth.mean_load_n(rod.stroke_m);
        let unloaded = ((arm.sag_below_n - oil_n) / SAG_SPAN_N).clamp(0.0, 1.0);
        let all_m_s = speed_m_s + creep_m_s + arm.sag_m_s * unloaded;
        self.holding.step(&cylinder, rod, all_m_s, dt_s);
        let friction_n = self.seal.step(&arm.seal, rod.travel_m, rod.rate_m_s[1]);
        self.force = RodForce {
            force_n: self.holding.force_n(&cylinder) - friction_n,
            stiffness_n_m: self.holding.stiffness_n_m(&cylinder, rod.stroke_m)
                + self.seal.stiffness_n_m(&arm.seal),
            damping_n_s_m: cylinder.damping_n_s_m,
        };
        self.force
    }

    /// Pressures of chambers A and B, Pa.
    pub(crate) fn pressures_pa(&self, truth: &Truth, arm: &ArmTruth) -> [f64; 2] {
        self.holding.pressures_pa(&cylinder(truth, arm, 0.0))
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::Wheel;

    use super::*;

    const DT_S: f64 = 0.002;

    /// Speed asked for after `seconds` of full manual opening.
    fn speed_after(change: impl Fn(&mut ArmTruth), seconds: f64, command: f64) -> f64 {
        let truth = Truth::nominal();
        let mut law = truth.arms[Wheel::Fr].clone();
        change(&mut law);
        let mut arm = Arm::settled(&truth, &law, 55e3, DT_S);
        let (mut time_s, mut last) = (0.0, 0.0);
        while time_s < seconds {
            last = arm.open(&truth, &law, [command, 0.3], time_s, DT_S).speed_m_s;
            time_s += DT_S;
        }
        last
    }

    #[test]
    fn a_third_of_the_opening_is_a_third_of_the_speed_whatever_the_load() {
        // Less the overlap that the ECU's starting current does not cover.
        assert!((speed_after(|_| (), 1.0, 0.3) - 0.299 * 0.212).abs() < 1e-6);
        assert!((speed_after(|_| (), 1.0, -0.3) + 0.299 * 0.212).abs() < 1e-6);
    }

    #[test]
    fn a_delay_and_a_slow_pilot_come_before_the_spool() {
        assert_eq!(speed_after(|arm| arm.delay_s = 0.2, 0.19, 0.3), 0.0);
        assert!(speed_after(|arm| arm.delay_s = 0.2, 0.3, 0.3) > 0.06);
        let lagged = speed_after(|arm| arm.pilot_s = 0.3, 0.31, 0.3) / 0.0636;
        assert!((lagged - 0.632).abs() < 0.03, "{lagged}");
    }

    #[test]
    fn a_stuck_output_keeps_what_it_had() {
        let stuck = |arm: &mut ArmTruth| (arm.stuck_s, arm.stuck_every_s) = (1.0, 3.0);
        assert_eq!(speed_after(stuck, 0.9, 0.3), 0.0);
        assert!(speed_after(stuck, 2.0, 0.3) > 0.06);
    }

    #[test]
    fn talk_between_valves_moves_an_arm_that_was_not_asked() {
        assert_eq!(speed_after(|_| (), 1.0, 0.0), 0.0);
        let asked = speed_after(|arm| arm.cross_talk = 0.4, 1.0, 0.0);
        assert!((asked - (0.12 - 0.001) * 0.212).abs() < 1e-4, "{asked}");
    }

    #[test]
    fn a_leak_sinks_under_load_and_an_unloaded_arm_draws_out() {
        let truth = Truth::nominal();
        let creep = |law: &ArmTruth, load_n: f64| {
            let mut arm = Arm::settled(&truth, law, load_n, DT_S);
            let rod = RodMotion { stroke_m: 0.2, ..RodMotion::default() };
            let before = arm.press(&truth, law, &rod, 0.0, 0.0, DT_S).force_n;
            for _ in 0..500 {
                arm.press(&truth, law, &rod, 0.0, 0.0, DT_S);
            }
            (arm.force.force_n - before) / 2.0e6
        };
        let nominal = &truth.arms[Wheel::Fr];
        let leaky = ArmTruth { leak_m_s: 0.005, ..nominal.clone() };
        let sagging = ArmTruth { sag_m_s: 0.005, sag_below_n: 8e3, ..nominal.clone() };
        assert!(creep(nominal, 55e3).abs() < 1e-6);
        assert!(creep(&leaky, 55e3) < -0.003);
        assert!(creep(&sagging, 55e3).abs() < 1e-6);
        assert!(creep(&sagging, 1e3) > 0.002);
    }
}
