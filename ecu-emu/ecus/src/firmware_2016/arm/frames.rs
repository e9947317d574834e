//! The frames of the arm ECU: 32 on `CAN_1` and 3 on `CAN_4`, every tick (facts 2.1, 2.5).

use xt28_dbc::Outbox;
use xt28_dbc::messages as m;
use xt28_machine::{PerWheel, Wheel};

use super::attitude::Attitude;
use super::forces::Forces;
use super::sensing::Readings;
use crate::firmware_2016::whole::{s16, u8, u16};
use crate::send::send;

/// mm/s per count of the stroke rates, as the database has it.
const RATE_MM_S_PER_COUNT: f64 = 2.0;
/// Sensor supplies 1 and 3, mV.
const SENSOR_SUPPLY_MV: f64 = 5000.0;

pub(super) fn pressures(r: &Readings, out: &mut Outbox) {
    let [fr_a_kpa, fl_a_kpa, mr_a_kpa, ml_a_kpa, br_a_kpa, bl_a_kpa] = r.pressure_a_kpa.map(u16).0;
    let [fr_b_kpa, fl_b_kpa, mr_b_kpa, ml_b_kpa, br_b_kpa, bl_b_kpa] = r.pressure_b_kpa.map(u16).0;
    send(out, &m::PressRear { br_a_kpa, br_b_kpa, bl_a_kpa, bl_b_kpa }.encode());
    send(out, &m::PressMid { mr_a_kpa, mr_b_kpa, ml_a_kpa, ml_b_kpa }.encode());
    send(out, &m::PressFront { fr_a_kpa, fr_b_kpa, fl_a_kpa, fl_b_kpa }.encode());
}

pub(super) fn motion(r: &Readings, out: &mut Outbox) {
    let [fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm] = r.stroke_mm.map(u16).0;
    send(out, &m::PosMidRear { mr_mm, ml_mm, br_mm, bl_mm }.encode());
    send(out, &m::PosFront { fr_mm, fl_mm }.encode());
    let [fr_mm_s, fl_mm_s, mr_mm_s, ml_mm_s, br_mm_s, bl_mm_s] =
        r.rate.map(|counts| s16(counts) * RATE_MM_S_PER_COUNT).0;
    send(out, &m::VelMidRear { mr_mm_s, ml_mm_s, br_mm_s, bl_mm_s }.encode());
    send(out, &m::VelFront { fr_mm_s, fl_mm_s }.encode());
}

pub(super) fn chambers(f: &Forces, out: &mut Outbox) {
    let [fr_a_dan, fl_a_dan, mr_a_dan, ml_a_dan, br_a_dan, bl_a_dan] = f.chamber_a.map(u16).0;
    let [fr_b_dan, fl_b_dan, mr_b_dan, ml_b_dan, br_b_dan, bl_b_dan] = f.chamber_b.map(u16).0;
    send(out, &m::ChamberForceRear { br_a_dan, br_b_dan, bl_a_dan, bl_b_dan }.encode());
    send(out, &m::ChamberForceMid { mr_a_dan, mr_b_dan, ml_a_dan, ml_b_dan }.encode());
    send(out, &m::ChamberForceFront { fr_a_dan, fr_b_dan, fl_a_dan, fl_b_dan }.encode());
}

pub(super) fn loads(f: &Forces, out: &mut Outbox) {
    let [fr_dan, fl_dan, mr_dan, ml_dan, br_dan, bl_dan] = f.load.map(s16).0;
    send(out, &m::CylLoadMidRear { mr_dan, ml_dan, br_dan, bl_dan }.encode());
    send(out, &m::CylLoadFront { fr_dan, fl_dan }.encode());
    let [fr_dan, fl_dan, mr_dan, ml_dan, br_dan, bl_dan] = f.wheel.map(s16).0;
    send(out, &m::WheelForceMidRear { mr_dan, ml_dan, br_dan, bl_dan }.encode());
    send(out, &m::WheelForceFront { fr_dan, fl_dan }.encode());
}

/// Where the weight is and who should carry it: left before right, unlike all others.
pub(super) fn references(f: &Forces, out: &mut Outbox) {
    let [lateral_percent, longitudinal_percent] = f.centre_percent.map(s16);
    send(out, &m::CentreOfMass { lateral_percent, longitudinal_percent }.encode());
    let [fr_dan, fl_dan, mr_dan, ml_dan, br_dan, bl_dan] = f.reference.map(s16).0;
    send(out, &m::OptLoadFrontMid { fl_dan, fr_dan, ml_dan, mr_dan }.encode());
    let [sum_positive_dan, sum_reference_dan] = [f.sum_positive, f.sum_reference].map(s16);
    send(out, &m::OptLoadRear { bl_dan, br_dan, sum_positive_dan, sum_reference_dan }.encode());
    let error = PerWheel::from_fn(|w: Wheel| s16(f.error_percent(w)));
    let [fr_percent, fl_percent, mr_percent, ml_percent, br_percent, bl_percent] = error.0;
    let front_mid = m::ForceErrFrontMid { fl_percent, fr_percent, ml_percent, mr_percent };
    send(out, &front_mid.encode());
    send(out, &m::ForceErrRear { bl_percent, br_percent }.encode());
}

pub(super) fn attitude(r: &Readings, a: &Attitude, out: &mut Outbox) {
    let [pitch_deg, roll_deg] = a.angles_cdeg().map(|cdeg| s16(cdeg) * 0.01);
    let mean_stroke_mm = s16(r.mean_stroke_mm);
    #[allow(clippy::cast_possible_truncation)] // wraps, as the firmware's store does
    let mean_stroke_rate = r.mean_rate as i16;
    let attitude = m::Attitude { mean_stroke_mm, mean_stroke_rate, pitch_deg, roll_deg };
    send(out, &attitude.encode());
    let [pitch_rate_deg_s, roll_rate_deg_s] = a.rates_deg_s();
    send(out, &m::GyroCopy { pitch_rate_deg_s, roll_rate_deg_s }.encode());
    #[allow(clippy::cast_possible_truncation)] // came from 16 bits
    let [x, y, z] = a.acceleration().map(|counts| counts as i16);
    send(out, &m::AccelCopy { x, y, z }.encode());
}

/// Commanded currents; the measured ones are the same, for the output stage holds them (assumed).
pub(super) fn currents(ma: &PerWheel<[i32; 2]>, out: &mut Outbox) {
    let [fr, fl, mr, ml, br, bl] = ma.map(|sides| sides.map(u16)).0;
    let ([fr_a_ma, fr_b_ma], [fl_a_ma, fl_b_ma]) = (fr, fl);
    let ([mr_a_ma, mr_b_ma], [ml_a_ma, ml_b_ma]) = (mr, ml);
    let ([br_a_ma, br_b_ma], [bl_a_ma, bl_b_ma]) = (br, bl);
    send(out, &m::RefCurrentFront { fr_a_ma, fr_b_ma, fl_a_ma, fl_b_ma }.encode());
    send(out, &m::RefCurrentMid { mr_a_ma, mr_b_ma, ml_a_ma, ml_b_ma }.encode());
    send(out, &m::RefCurrentRear { br_a_ma, br_b_ma, bl_a_ma, bl_b_ma }.encode());
    send(out, &m::ActCurrentFront { fl_a_ma, fl_b_ma, fr_a_ma, fr_b_ma }.encode());
    send(out, &m::ActCurrentMid { ml_a_ma, ml_b_ma, mr_a_ma, mr_b_ma }.encode());
    send(out, &m::ActCurrentRear { bl_a_ma, bl_b_ma, br_a_ma, br_b_ma }.encode());
}

/// Supplies and the debug words: last preset, brake byte seen, battery.
pub(super) fn debug(battery_mv: i32, preset: i32, brake_seen: u8, out: &mut Outbox) {
    let (sensor1_mv, sensor3_mv) = (SENSOR_SUPPLY_MV, SENSOR_SUPPLY_MV);
    send(out, &m::Supply { battery_mv: s16(battery_mv), sensor1_mv, sensor3_mv }.encode());
    send(out, &m::ArmDebug1 { preset, d2: 0 }.encode());
    send(out, &m::ArmDebug2 { brake_seen: i32::from(brake_seen), d4: 0 }.encode());
    send(out, &m::ArmDebug3 { d5: 0, battery_mv }.encode());
}

/// What the display is told.
pub(super) struct Shown {
    pub(super) alert: bool,
    pub(super) height_mm: i32,
    pub(super) passive: bool,
    pub(super) levelling: bool,
}

pub(super) fn display(s: &Shown, r: &Readings, out: &mut Outbox) {
    let shown = m::ArmDisplay {
        alert: u8(i32::from(s.alert)),
        height_reference_mm: s16(s.height_mm),
        passive: u8(i32::from(s.passive)),
        levelling: u8(i32::from(s.levelling)),
    };
    send(out, &shown.encode());
    let [fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm] = r.stroke_mm.map(u16).0;
    send(out, &m::DisplayPosMidRear { mr_mm, ml_mm, br_mm, bl_mm }.encode());
    send(out, &m::DisplayPosFront { fr_mm, fl_mm }.encode());
}
