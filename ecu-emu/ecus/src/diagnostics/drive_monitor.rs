//! Watches the transmission and steering ECU's inputs, and tells what it finds.

use core::time::Duration;

use xt28_machine::{Machine, PerWheel, SimTime};

use super::STREAMS_DUE;
use super::fault_memory::FaultMemory;
use super::parts::drive as part;
use super::trouble_code::Fmi;
use crate::drive::DrivePins;
use crate::input_check::{InputCheck, Supply};
use crate::life::{Health, PERIOD_S};
use crate::pins::Calibration;
use crate::power::Cause;

/// Fault bits of the status frame.
mod fault {
    pub(super) const JOINT: u16 = 1 << 0;
    pub(super) const WHEEL_SPEED: u16 = 1 << 1;
    pub(super) const PUMP_PRESSURE: u16 = 1 << 2;
    pub(super) const SUPPLY: u16 = 1 << 3;
    pub(super) const ENGINE: u16 = 1 << 4;
}

/// No joint turns faster, deg/s (assumed).
const JOINT_RATE_MAX_DEG_S: f64 = 100.0;
/// The other wheels' mean above which one that reads nothing is missed, Hz: 0.3 m/s (assumed).
const ROLLING_HZ: f64 = 210.0;
/// A wheel that turns at all reads more than this, Hz.
const STANDING_HZ: f64 = 1.0;
/// For this long (assumed).
const SILENT_MAX: Duration = Duration::from_secs(1);

/// What the ECU knows of itself at a task period, besides its pins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DriveSeen {
    /// The engine says nothing.
    pub(crate) engine_lost: bool,
    /// The commands stopped coming while they were carried out.
    pub(crate) commands_lost: bool,
    /// Why the ECU has started anew, while it waits to be taken into use again.
    pub(crate) restarted_by: Option<Cause>,
}

/// All checks of the drive ECU.
#[derive(Clone, Debug)]
pub(crate) struct DriveMonitor {
    joints: [InputCheck; 2],
    pumps: [InputCheck; 4],
    /// Since when a wheel has read nothing while the others turned.
    silent_since: PerWheel<Option<SimTime>>,
    started: Option<SimTime>,
}

impl DriveMonitor {
    pub(crate) fn new(machine: &Machine) -> Self {
        let mv_per_deg = Calibration::of(machine).joint_mv_per_deg();
        let step_mv = JOINT_RATE_MAX_DEG_S * PERIOD_S * mv_per_deg;
        Self {
            joints: [InputCheck::of_motion(step_mv); 2],
            pumps: [InputCheck::default(); 4],
            silent_since: PerWheel::splat(None),
            started: None,
        }
    }

    /// One task period. Only the joint sensors can stop the machine: they close the steering loop.
    pub(crate) fn step(
        &mut self,
        now: SimTime,
        pins: &DrivePins,
        seen: DriveSeen,
        memory: &mut FaultMemory,
    ) -> (Health, u16) {
        let (mut joints, mut pumps) = (Health::Good, Health::Good);
        let joint_mv = [pins.joint_front_mv, pins.joint_rear_mv];
        for (i, (check, mv)) in self.joints.iter_mut().zip(joint_mv).enumerate() {
            let (health, failing) = check.test(now, mv);
            memory.report(part::JOINT + i, failing);
            joints = joints.max(health);
        }
        for (i, (check, mv)) in self.pumps.iter_mut().zip(pins.pump_mv).enumerate() {
            let (health, failing) = check.test(now, mv);
            memory.report(part::PUMP + i, failing);
            pumps = pumps.max(health);
        }
        let wheels_bad = self.wheels(now, &pins.wheel_hz, memory);
        let supply = Supply::read(pins.supply_mv);
        let [dark, reset] = Cause::failures(seen.restarted_by);
        memory.report(part::SUPPLY, supply.failure().or(dark));
        memory.report(part::CONTROLLER, reset);
        let started = *self.started.get_or_insert(now);
        let late = now.since(started) >= STREAMS_DUE;
        let away = |lost: bool| (lost && late).then_some(Fmi::UpdateRate);
        memory.report(part::ENGINE, away(seen.engine_lost));
        memory.report(part::COMMANDS, away(seen.commands_lost));
        let faults = [
            (joints == Health::Broken, fault::JOINT),
            (wheels_bad, fault::WHEEL_SPEED),
            (pumps == Health::Broken, fault::PUMP_PRESSURE),
            (supply.is_bad(), fault::SUPPLY),
            (seen.engine_lost, fault::ENGINE),
        ];
        let bits = faults.into_iter().filter(|(is, _)| *is).fold(0, |all, (_, bit)| all | bit);
        (joints, bits)
    }

    /// A speed sensor without a wire reads no pulses: the other wheels give it away.
    fn wheels(&mut self, now: SimTime, hz: &PerWheel<f64>, memory: &mut FaultMemory) -> bool {
        let mut any = false;
        for (wheel, own_hz) in hz.iter() {
            let others_hz = (hz.sum() - own_hz) / 5.0;
            let silent = *own_hz < STANDING_HZ && others_hz > ROLLING_HZ;
            let since = &mut self.silent_since[wheel];
            *since = if silent { since.or(Some(now)) } else { None };
            let failing = if !(own_hz.is_finite() && *own_hz >= 0.0) {
                Some(Fmi::Erratic)
            } else if since.is_some_and(|since| now.since(since) >= SILENT_MAX) {
                Some(Fmi::Frequency)
            } else {
                None
            };
            memory.report(part::WHEEL + wheel.index(), failing);
            any |= failing.is_some();
        }
        any
    }
}
