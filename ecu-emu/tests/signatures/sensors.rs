//! Rows of the sensors: a reading is off what is true by the sensor's own error, and where no loop closes over it,
//! nothing else is.

use xt28_dbc::CanId;
use xt28_dbc::messages::{
    AccelCopy, ActCurrentFront, ActCurrentRear, Attitude, CylLoadFront, CylLoadMidRear, GyroCopy,
    PosFront, PosMidRear, PressFront, PressRear, RefCurrentFront, RefCurrentRear, WheelForceFront,
    WheelForceMidRear, WheelSpeedSigned,
};
use xt28_machine::{Machine, Wheel};
use xt28_sim::VehicleState;
use xt28_ubx::{Geodetic, LocalFrame, Message};

use crate::drive_off::LASTS_S;
use crate::recording::Recording;
use crate::row::{Row, Seen, Size, Stay, mean, messages, most};

/// Frames that tell the front strokes, and what the arm ECU makes of them in the same tick.
const OF_FRONT_STROKES: &[CanId] =
    &[PosFront::ID, RefCurrentFront::ID, ActCurrentFront::ID, WheelForceFront::ID, Attitude::ID];
const OF_REAR_STROKES: &[CanId] =
    &[PosMidRear::ID, RefCurrentRear::ID, ActCurrentRear::ID, WheelForceMidRear::ID, Attitude::ID];
const OF_FRONT_PRESSURES: &[CanId] = &[PressFront::ID, CylLoadFront::ID, WheelForceFront::ID];
const OF_REAR_PRESSURES: &[CanId] = &[PressRear::ID, CylLoadMidRear::ID, WheelForceMidRear::ID];

pub(crate) fn rows() -> Vec<Row> {
    [of_strokes(), of_pressures(), of_motion()].concat()
}

fn of_strokes() -> Vec<Row> {
    vec![
        Row {
            effect: "stroke-bias",
            values: "scope = \"FR\"\nbias_m = 0.01",
            shows: |seen| strokes(seen.with, |w, m| if w == Wheel::Fr { m + 0.01 } else { m }),
            stays: &[
                Stay::Frames(0.0, OF_FRONT_STROKES),
                Stay::Within("wheel speed, rpm", br_rpm, [4.5, 5.9], 0.5),
            ],
        },
        Row {
            effect: "stroke-scale",
            values: "scope = \"BL\"\nfactor = 1.1",
            shows: |seen| strokes(seen.with, |w, m| if w == Wheel::Bl { 1.1 * m } else { m }),
            stays: &[
                Stay::Frames(0.0, OF_REAR_STROKES),
                Stay::Within("wheel speed, rpm", br_rpm, [4.5, 5.9], 0.5),
            ],
        },
    ]
}

fn of_pressures() -> Vec<Row> {
    vec![
        Row {
            effect: "pressure-bias",
            values: "scope = \"FR\"\nbias_pa = 1e6",
            shows: bias,
            stays: &[Stay::Frames(LASTS_S, OF_FRONT_PRESSURES), Stay::Receiver],
        },
        Row {
            effect: "pressure-scale",
            values: "scope = \"BL\"\nfactor = 1.2\nrod_share = 0.5",
            shows: scale,
            stays: &[Stay::Frames(LASTS_S, OF_REAR_PRESSURES), Stay::Receiver],
        },
    ]
}

fn of_motion() -> Vec<Row> {
    vec![
        Row {
            effect: "wheel-speed-scale",
            values: "scope = \"BL\"\nfactor = 1.2",
            shows: wheel_speeds,
            stays: &[Stay::Frames(0.9, &[]), Stay::Within("BR, rpm", br_rpm, [0.0, 6.0], 0.21)],
        },
        Row {
            effect: "imu-offset",
            values: "roll_rad = 0.03\npitch_rad = -0.02",
            shows: askew,
            stays: &[
                Stay::Frames(LASTS_S, &[Attitude::ID, GyroCopy::ID, AccelCopy::ID]),
                Stay::Receiver,
            ],
        },
        Row {
            effect: "gnss-latency",
            values: "delay_s = 0.3",
            shows: |seen| fixes(seen.with, 30),
            stays: &[Stay::Frames(LASTS_S, &[])],
        },
        Row {
            effect: "gnss-lever-arm",
            values: "x_m = 0.8\ny_m = -0.5",
            shows: lever,
            stays: &[Stay::Frames(LASTS_S, &[])],
        },
    ]
}

/// Every stroke reads the whole millimetres of what its sensor makes of the true one.
fn strokes(r: &Recording, reads: fn(Wheel, f64) -> f64) -> Vec<Size> {
    let front = |of: fn(&PosFront) -> f64| r.each(PosFront::decode, of);
    let behind = |of: fn(&PosMidRear) -> f64| r.each(PosMidRear::decode, of);
    let said_mm = [
        front(|m| m.fr_mm),
        front(|m| m.fl_mm),
        behind(|m| m.mr_mm),
        behind(|m| m.ml_mm),
        behind(|m| m.br_mm),
        behind(|m| m.bl_mm),
    ];
    let size = |(w, said_mm): (Wheel, &Vec<f64>)| {
        let cut_mm = r.truth.iter().zip(said_mm).map(|(s, mm)| 1e3 * reads(w, s.stroke_m[w]) - mm);
        // Between none and a whole one is cut off.
        let off_mm = most(cut_mm.map(|cut_mm| cut_mm - 0.5));
        Size::new(format!("{w} off the middle, mm"), off_mm, 0.25, 0.251)
    };
    Wheel::ALL.into_iter().zip(&said_mm).map(size).collect()
}

/// The filtered pressure is more by the bias but for what the filter stops short, and the load by it on the bore.
fn bias(seen: &Seen) -> Vec<Size> {
    let more = |of: fn(&Recording) -> Vec<f64>| {
        let series: Vec<f64> =
            of(seen.with).iter().zip(of(seen.without)).map(|(a, b)| a - b).collect();
        [series[0], mean(&series, [8.0, 13.9])]
    };
    let a_kpa = more(|r| r.each(PressFront::decode, |m| m.fr_a_kpa));
    let b_kpa = more(|r| r.each(PressFront::decode, |m| m.fr_b_kpa));
    let other_kpa = more(|r| r.each(PressFront::decode, |m| m.fl_a_kpa));
    let load_dan = more(|r| r.each(CylLoadFront::decode, |m| m.fr_dan));
    let bore_m2 = Machine::xt28().arms.area_bore_m2;
    vec![
        Size::new("FR A at once, kPa", a_kpa[0], 1000.0, 1.0),
        Size::new("FR A in the end, kPa", a_kpa[1], 1000.0, 20.0),
        Size::new("FR B, kPa", most(b_kpa), 0.0, 0.0),
        Size::new("FL A, kPa", most(other_kpa), 0.0, 0.0),
        Size::new("load at once, daN", load_dan[0], 100_000.0 * bore_m2, 2.0),
    ]
}

/// The filtered pressures are as many times more, those of the other side by the share of it that is said.
fn scale(seen: &Seen) -> Vec<Size> {
    let ratio = |of: fn(&Recording) -> Vec<f64>| {
        let (with, without) = (of(seen.with), of(seen.without));
        [with[0] / without[0], mean(&with, [8.0, 13.9]) / mean(&without, [8.0, 13.9])]
    };
    let sizes = |what: &str, [first, last]: [f64; 2], wanted: f64| {
        [
            Size::new(format!("{what} at once"), first, wanted, 0.004),
            Size::new(format!("{what} in the end"), last, wanted, 0.02),
        ]
    };
    [
        sizes("BL A", ratio(|r| r.each(PressRear::decode, |m| m.bl_a_kpa)), 1.2),
        sizes("BL B", ratio(|r| r.each(PressRear::decode, |m| m.bl_b_kpa)), 1.1),
        sizes("BR A", ratio(|r| r.each(PressRear::decode, |m| m.br_a_kpa)), 1.0),
    ]
    .concat()
}

fn br_rpm(r: &Recording) -> Vec<f64> {
    r.each(WheelSpeedSigned::decode, |m| m.br_rpm)
}

/// The scaled wheel says its speed times the factor, and another one its own, to a step of the frame.
fn wheel_speeds(seen: &Seen) -> Vec<Size> {
    let r = seen.with;
    let size = |w: Wheel, said_rpm: Vec<f64>, factor: f64| {
        let true_rpm = |s: &VehicleState| s.wheel_speed_rad_s[w] * 60.0 / core::f64::consts::TAU;
        let off_rpm = r.truth.iter().zip(said_rpm).map(|(s, rpm)| rpm - factor * true_rpm(s));
        Size::new(format!("{w} off, rpm"), most(off_rpm), 0.0, 0.051)
    };
    vec![
        size(Wheel::Bl, r.each(WheelSpeedSigned::decode, |m| m.bl_rpm), 1.2),
        size(Wheel::Br, br_rpm(r), 1.0),
    ]
}

/// A standing machine's attitude is off by the mount's angles, from the first sample on.
fn askew(seen: &Seen) -> Vec<Size> {
    let by_deg = |of: fn(&Attitude) -> f64| {
        let [with, without] = [seen.with, seen.without].map(|r| r.each(Attitude::decode, of));
        mean(&with, [0.0, 0.9]) - mean(&without, [0.0, 0.9])
    };
    // A count of acceleration is 0.06 degrees.
    vec![
        Size::new("roll, deg", by_deg(|m| m.roll_deg), 0.03_f64.to_degrees(), 0.06),
        Size::new("pitch, deg", by_deg(|m| m.pitch_deg), -0.02_f64.to_degrees(), 0.06),
    ]
}

/// Fixes, each with its tick: east and north, m.
fn places_m(r: &Recording) -> Vec<(usize, [f64; 2])> {
    let frame = LocalFrame::new(Geodetic::BENCH_ORIGIN);
    messages(r, |message| match message {
        Message::HpPosLlh(m) => {
            let at = frame.to_local(m.position);
            Some([at.east_m, at.north_m])
        }
        _ => None,
    })
}

/// The receiver says where the antenna was so many ticks before, how fast it went then, and how the machine headed.
fn fixes(r: &Recording, late: usize) -> Vec<Size> {
    let then = |tick: usize| &r.truth[tick.saturating_sub(late)];
    let place_m = places_m(r)
        .into_iter()
        .flat_map(|(tick, said)| [0, 1].map(|k| said[k] - then(tick).antenna_position_m[k]));
    let speed_m_s = messages(r, |message| match message {
        Message::Pvt(m) => Some([m.velocity_east_m_s, m.velocity_north_m_s]),
        _ => None,
    });
    let speed_m_s = speed_m_s
        .into_iter()
        .flat_map(|(tick, said)| [0, 1].map(|k| said[k] - then(tick).antenna_velocity_m_s[k]));
    let headings = messages(r, |message| match message {
        Message::RelPosNed(m) => Some(m.heading_rad),
        _ => None,
    });
    let heading_rad = headings.into_iter().map(|(tick, clockwise_rad)| {
        (core::f64::consts::FRAC_PI_2 - clockwise_rad - then(tick).yaw_rad).sin()
    });
    vec![
        Size::new("place off, m", most(place_m), 0.0, 5e-4),
        Size::new("velocity off, m/s", most(speed_m_s), 0.0, 1e-3),
        Size::new("heading off, rad", most(heading_rad), 0.0, 1e-5),
    ]
}

/// The antenna is off by the lever, turned with the frame, and the heading is not.
fn lever(seen: &Seen) -> Vec<Size> {
    let both = places_m(seen.with).into_iter().zip(places_m(seen.without));
    let off_m = both.flat_map(|((tick, with), (_, without))| {
        let (sin, cos) = seen.without.truth[tick].yaw_rad.sin_cos();
        let wanted_m = [cos * 0.8 + sin * 0.5, sin * 0.8 - cos * 0.5];
        [0, 1].map(|k| with[k] - without[k] - wanted_m[k])
    });
    let heading = |r: &Recording| {
        messages(r, |m| if let Message::RelPosNed(m) = m { Some(m.heading_rad) } else { None })
    };
    let same = f64::from(u8::from(heading(seen.with) == heading(seen.without)));
    let turned_rad = seen.without.truth[seen.without.truth.len() - 1].yaw_rad;
    vec![
        Size::new("lever off, m", most(off_m), 0.0, 2e-3),
        Size::new("heading is the same", same, 1.0, 0.0),
        Size::new("the machine has turned", f64::from(u8::from(turned_rad > 0.2)), 1.0, 0.0),
    ]
}
