//! What the arm ECU sends every tick (facts 2.1), and its status.

use xt28_dbc::Outbox;
use xt28_dbc::messages::{
    AccelCopy, ActCurrentFront, ActCurrentMid, ActCurrentRear, ArmStatus, ArmStatusMode, Attitude,
    CylLoadFront, CylLoadMidRear, GyroCopy, PosFront, PosMidRear, PressFront, PressMid, PressRear,
    RefCurrentFront, RefCurrentMid, RefCurrentRear, VelFront, VelMidRear, WheelForceFront,
    WheelForceMidRear,
};

use super::attitude::AttitudeFilter;
use super::automatic::Currents;
use super::command::ArmDemand;
use super::sensing::ArmReadings;
use crate::Refusal;
use crate::input_check::Supply;
use crate::life::State;
use crate::send::send;

/// mm/s per count of the stroke rates, as the frames' description has it (facts 2.1).
const RATE_MM_S_PER_COUNT: f64 = 2.0;

pub(super) fn pressures(r: &ArmReadings, out: &mut Outbox) {
    let [fr_a_kpa, fl_a_kpa, mr_a_kpa, ml_a_kpa, br_a_kpa, bl_a_kpa] = r.pressure_a_kpa.0;
    let [fr_b_kpa, fl_b_kpa, mr_b_kpa, ml_b_kpa, br_b_kpa, bl_b_kpa] = r.pressure_b_kpa.0;
    send(out, &PressRear { br_a_kpa, br_b_kpa, bl_a_kpa, bl_b_kpa }.encode());
    send(out, &PressMid { mr_a_kpa, mr_b_kpa, ml_a_kpa, ml_b_kpa }.encode());
    send(out, &PressFront { fr_a_kpa, fr_b_kpa, fl_a_kpa, fl_b_kpa }.encode());
}

pub(super) fn motion(r: &ArmReadings, out: &mut Outbox) {
    let [fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm] = r.stroke_mm.0;
    send(out, &PosMidRear { mr_mm, ml_mm, br_mm, bl_mm }.encode());
    send(out, &PosFront { fr_mm, fl_mm }.encode());
    let [fr_mm_s, fl_mm_s, mr_mm_s, ml_mm_s, br_mm_s, bl_mm_s] =
        r.stroke_rate.0.map(|counts| counts * RATE_MM_S_PER_COUNT);
    send(out, &VelMidRear { mr_mm_s, ml_mm_s, br_mm_s, bl_mm_s }.encode());
    send(out, &VelFront { fr_mm_s, fl_mm_s }.encode());
}

pub(super) fn forces(r: &ArmReadings, out: &mut Outbox) {
    let [fr_dan, fl_dan, mr_dan, ml_dan, br_dan, bl_dan] = r.load_dan.0;
    send(out, &CylLoadMidRear { mr_dan, ml_dan, br_dan, bl_dan }.encode());
    send(out, &CylLoadFront { fr_dan, fl_dan }.encode());
    let [fr_dan, fl_dan, mr_dan, ml_dan, br_dan, bl_dan] = r.wheel_force_dan.0;
    send(out, &WheelForceMidRear { mr_dan, ml_dan, br_dan, bl_dan }.encode());
    send(out, &WheelForceFront { fr_dan, fl_dan }.encode());
}

pub(super) fn attitude(r: &ArmReadings, filter: &AttitudeFilter, out: &mut Outbox) {
    let [pitch_deg, roll_deg] = filter.angles_deg();
    let mean_stroke_mm = r.mean_stroke_mm;
    #[allow(clippy::cast_possible_truncation)] // a whole number; `as` saturates
    let mean_stroke_rate = r.mean_stroke_rate as i16;
    let attitude = Attitude { mean_stroke_mm, mean_stroke_rate, pitch_deg, roll_deg };
    send(out, &attitude.encode());
    let [pitch_rate_deg_s, roll_rate_deg_s] = filter.rates_deg_s();
    send(out, &GyroCopy { pitch_rate_deg_s, roll_rate_deg_s }.encode());
    #[allow(clippy::cast_possible_truncation)] // came from 16 bits
    let [x, y, z] = filter.acceleration().map(|counts| counts as i16);
    send(out, &AccelCopy { x, y, z }.encode());
}

/// Commanded currents, and measured ones: left before right (facts 2.1).
pub(super) fn currents(currents: &Currents, out: &mut Outbox) {
    let [front_right, front_left, middle_right, middle_left, back_right, back_left] =
        currents.wanted_ma.0;
    let ([fr_a_ma, fr_b_ma], [fl_a_ma, fl_b_ma]) = (front_right, front_left);
    let ([mr_a_ma, mr_b_ma], [ml_a_ma, ml_b_ma]) = (middle_right, middle_left);
    let ([br_a_ma, br_b_ma], [bl_a_ma, bl_b_ma]) = (back_right, back_left);
    send(out, &RefCurrentFront { fr_a_ma, fr_b_ma, fl_a_ma, fl_b_ma }.encode());
    send(out, &RefCurrentMid { mr_a_ma, mr_b_ma, ml_a_ma, ml_b_ma }.encode());
    send(out, &RefCurrentRear { br_a_ma, br_b_ma, bl_a_ma, bl_b_ma }.encode());
    let [front_right, front_left, middle_right, middle_left, back_right, back_left] =
        currents.actual_ma.0;
    let ([fr_a_ma, fr_b_ma], [fl_a_ma, fl_b_ma]) = (front_right, front_left);
    let ([mr_a_ma, mr_b_ma], [ml_a_ma, ml_b_ma]) = (middle_right, middle_left);
    let ([br_a_ma, br_b_ma], [bl_a_ma, bl_b_ma]) = (back_right, back_left);
    send(out, &ActCurrentFront { fl_a_ma, fl_b_ma, fr_a_ma, fr_b_ma }.encode());
    send(out, &ActCurrentMid { ml_a_ma, ml_b_ma, mr_a_ma, mr_b_ma }.encode());
    send(out, &ActCurrentRear { bl_a_ma, bl_b_ma, br_a_ma, br_b_ma }.encode());
}

/// What the status frame is made of.
pub(super) struct Status<'a> {
    /// In force: off unless the ECU is active.
    pub(super) demand: &'a ArmDemand,
    pub(super) state: State,
    pub(super) faults: u16,
    pub(super) accepted: u8,
    pub(super) refusal: Refusal,
    pub(super) supply: Supply,
    pub(super) counter: u8,
}

pub(super) fn status(s: &Status<'_>, out: &mut Outbox) {
    let mode = match s.demand {
        ArmDemand::Off => ArmStatusMode::Off,
        ArmDemand::Automatic(_) => ArmStatusMode::Automatic,
        ArmDemand::Position(_) => ArmStatusMode::ManualPosition,
        ArmDemand::Valve(_) => ArmStatusMode::ManualValve,
    };
    let status = ArmStatus {
        mode,
        state: s.state.into(),
        faults: s.faults,
        accepted: s.accepted,
        reason: s.refusal.into(),
        supply_v: s.supply.volts(),
        counter: s.counter,
    };
    send(out, &status.encode());
}
