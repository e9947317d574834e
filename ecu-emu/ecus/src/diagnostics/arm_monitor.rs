//! Watches the pendulum-arm ECU's inputs, and tells control and fault memory what it finds.

use xt28_machine::{Machine, PerWheel, SimTime, Wheel};

use super::STREAMS_DUE;
use super::fault_memory::FaultMemory;
use super::parts::arm as part;
use super::stall_check::StallCheck;
use super::trouble_code::Fmi;
use crate::arm::ArmPins;
use crate::input_check::{InputCheck, Supply};
use crate::life::{Health, PERIOD_S};
use crate::pins::Calibration;
use crate::power::Cause;

/// Fault bits of the status frame.
mod fault {
    pub(super) const POSITION: u16 = 1 << 0;
    pub(super) const PRESSURE: u16 = 1 << 1;
    pub(super) const ATTITUDE: u16 = 1 << 2;
    pub(super) const SUPPLY: u16 = 1 << 3;
}

/// No cylinder that a valve moves at `SPEED_FULL_M_S` moves faster, m/s: three times what it retracts with
/// at full flow (facts 1.2, assumed factor). Others are measured by their own full speed.
const STROKE_RATE_MAX_M_S: f64 = 0.85;
const SPEED_FULL_M_S: f64 = 0.212;

/// What the ECU knows of itself at a task period, besides its pins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ArmSeen<'a> {
    /// As the sensing has them.
    pub(crate) stroke_mm: &'a PerWheel<f64>,
    /// The inertial unit is silent.
    pub(crate) attitude_lost: bool,
    /// The commands stopped coming while they were carried out.
    pub(crate) commands_lost: bool,
    /// Why the ECU has started anew, while it waits to be taken into use again.
    pub(crate) restarted_by: Option<Cause>,
}

/// What was found at a task period.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ArmFindings {
    /// Of the strokes, the worst.
    pub(crate) position: Health,
    /// Of the pressures, the worst.
    pub(crate) pressure: Health,
    /// Bits of the status frame.
    pub(crate) faults: u16,
}

/// All checks of the arm ECU.
#[derive(Clone, Debug)]
pub(crate) struct ArmMonitor {
    strokes: PerWheel<InputCheck>,
    stalls: PerWheel<StallCheck>,
    pressures_a: PerWheel<InputCheck>,
    pressures_b: PerWheel<InputCheck>,
    /// Valve openings of the last task period, + extends.
    opening: PerWheel<f64>,
    stroke_max_mm: f64,
    full_travel_m: f64,
    started: Option<SimTime>,
}

impl ArmMonitor {
    pub(crate) fn new(machine: &Machine) -> Self {
        let rate_max_m_s =
            STROKE_RATE_MAX_M_S * (machine.hydraulics.speed_full_m_s / SPEED_FULL_M_S);
        let step_mv = rate_max_m_s * PERIOD_S * Calibration::of(machine).stroke_mv_per_m();
        Self {
            strokes: PerWheel::splat(InputCheck::of_motion(step_mv)),
            stalls: PerWheel::splat(StallCheck::default()),
            pressures_a: PerWheel::splat(InputCheck::default()),
            pressures_b: PerWheel::splat(InputCheck::default()),
            opening: PerWheel::splat(0.0),
            stroke_max_mm: machine.arms.stroke_max_m * 1e3,
            full_travel_m: machine.hydraulics.speed_full_m_s * PERIOD_S,
            started: None,
        }
    }

    /// Notes what the valves are told, for the next task period's judgement.
    pub(crate) const fn commanded(&mut self, opening: PerWheel<f64>) {
        self.opening = opening;
    }

    /// Whether the stroke of an arm was in range at the last task period.
    pub(crate) fn trusts(&self, wheel: Wheel) -> bool {
        !self.strokes[wheel].is_doubtful()
    }

    /// One task period.
    pub(crate) fn step(
        &mut self,
        now: SimTime,
        pins: &ArmPins,
        seen: ArmSeen<'_>,
        memory: &mut FaultMemory,
    ) -> ArmFindings {
        let (mut position, mut pressure) = (Health::Good, Health::Good);
        for (wheel, stroke_mv) in pins.stroke_mv.iter() {
            let (mut health, mut failing) = self.strokes[wheel].test(now, *stroke_mv);
            let stroke_mm = seen.stroke_mm[wheel];
            let stalled = self.stalls[wheel].step(
                self.opening[wheel],
                stroke_mm,
                self.stroke_max_mm,
                self.full_travel_m,
            );
            if stalled && failing.is_none() {
                (health, failing) = (Health::Broken, Some(Fmi::NotResponding));
            }
            memory.report(part::STROKE + wheel.index(), failing);
            position = position.max(health);
        }
        let chambers = [
            (part::PRESSURE_A, &mut self.pressures_a, &pins.pressure_a_mv),
            (part::PRESSURE_B, &mut self.pressures_b, &pins.pressure_b_mv),
        ];
        for (first, checks, mv) in chambers {
            for (wheel, mv) in mv.iter() {
                let (health, failing) = checks[wheel].test(now, *mv);
                memory.report(first + wheel.index(), failing);
                pressure = pressure.max(health);
            }
        }
        let supply = Supply::read(pins.supply_mv);
        let [dark, reset] = Cause::failures(seen.restarted_by);
        memory.report(part::SUPPLY, supply.failure().or(dark));
        memory.report(part::CONTROLLER, reset);
        let started = *self.started.get_or_insert(now);
        let late = now.since(started) >= STREAMS_DUE;
        let away = |lost: bool| (lost && late).then_some(Fmi::UpdateRate);
        memory.report(part::IMU, away(seen.attitude_lost));
        memory.report(part::COMMANDS, away(seen.commands_lost));
        let faults = [
            (position == Health::Broken, fault::POSITION),
            (pressure == Health::Broken, fault::PRESSURE),
            (seen.attitude_lost, fault::ATTITUDE),
            (supply.is_bad(), fault::SUPPLY),
        ];
        let faults = faults.into_iter().filter(|(is, _)| *is).fold(0, |all, (_, bit)| all | bit);
        ArmFindings { position, pressure, faults }
    }
}
