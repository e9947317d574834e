//! One GNSS epoch out of the receiver's messages: position, velocity and heading of one instant.

use core::f64::consts::{FRAC_PI_2, PI};

use xt28_ubx::{
    CarrierSolution, Counts, FixType, Geodetic, Message, NavHpPosLlh, NavPvt, NavRelPosNed, Parser,
};

use crate::pose::wrap;

/// The worst direction that is driven by, rad (assumed: 3 degrees put the machine 0.3 m aside of its way within 6 m).
const HEADING_ACCURACY_MAX_RAD: f64 = 3.0 * PI / 180.0;

/// What the receiver says of one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Epoch {
    /// The antenna, from NAV-HPPOSLLH where there is one, else NAV-PVT. It means nothing without a fix, and
    /// there is none where the receiver calls either invalid.
    pub(crate) position: Geodetic,
    /// East, north, up, m/s.
    pub(crate) velocity_m_s: [f64; 3],
    /// Counter-clockwise from east, rad; `None` when the receiver does not vouch for it.
    pub(crate) heading_rad: Option<f64>,
    pub(crate) quality: Quality,
}

/// How good a fix is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quality {
    /// What the fix rests on.
    pub fix: Fix,
    /// Satellites used.
    pub satellites: u8,
    /// Horizontal accuracy estimate, m.
    pub accuracy_horizontal_m: f64,
}

/// What a fix rests on, worst first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fix {
    /// Nothing to drive by.
    #[default]
    None,
    /// Satellites alone, metres.
    Single,
    /// With corrections to the code, some decimetres.
    Differential,
    /// Carrier phase, decimetres.
    RtkFloat,
    /// Carrier phase with fixed ambiguities, centimetres and better.
    RtkFixed,
}

impl core::fmt::Display for Fix {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::None => "no fix",
            Self::Single => "single",
            Self::Differential => "differential",
            Self::RtkFloat => "RTK float",
            Self::RtkFixed => "RTK fixed",
        })
    }
}

/// Collects the messages of an epoch. They carry its time of week, so it does not matter in which
/// order or in which portions they come.
#[derive(Clone, Debug, Default)]
pub(crate) struct EpochCollector {
    parser: Parser,
    time_of_week_ms: Option<u32>,
    pvt: Option<NavPvt>,
    fine: Option<NavHpPosLlh>,
    relative: Option<NavRelPosNed>,
    /// The receiver sends the fine position, so it is waited for.
    sends_fine: bool,
    /// The epoch at hand was given out already.
    given: bool,
    incomplete: u64,
}

impl EpochCollector {
    /// Takes bytes of the receiver's stream; the last epoch completed by them.
    pub(crate) fn push(&mut self, bytes: &[u8]) -> Option<Epoch> {
        let mut parser = core::mem::take(&mut self.parser);
        let newest = parser.push(bytes).filter_map(|message| self.add(&message)).last();
        self.parser = parser;
        newest
    }

    /// What the parser met, and epochs that never got complete.
    pub(crate) const fn counts(&self) -> (Counts, u64) {
        (self.parser.counts(), self.incomplete)
    }

    fn add(&mut self, message: &Message) -> Option<Epoch> {
        let time_of_week_ms = message.time_of_week_ms();
        if self.time_of_week_ms != Some(time_of_week_ms) {
            if self.time_of_week_ms.is_some() && !self.given {
                self.incomplete += 1;
            }
            // A receiver that stops sending the fine position is read without it from then on.
            self.sends_fine &= self.fine.is_some() || self.time_of_week_ms.is_none();
            self.time_of_week_ms = Some(time_of_week_ms);
            (self.pvt, self.fine, self.relative, self.given) = (None, None, None, false);
        }
        match message {
            Message::Pvt(pvt) => self.pvt = Some(*pvt),
            Message::HpPosLlh(fine) => {
                self.fine = Some(*fine);
                self.sends_fine = true;
            }
            Message::RelPosNed(relative) => self.relative = Some(*relative),
        }
        let (Some(pvt), Some(relative)) = (self.pvt, self.relative) else { return None };
        if self.given || (self.sends_fine && self.fine.is_none()) {
            return None;
        }
        self.given = true;
        Some(epoch(&pvt, self.fine.as_ref(), &relative))
    }
}

fn epoch(pvt: &NavPvt, fine: Option<&NavHpPosLlh>, relative: &NavRelPosNed) -> Epoch {
    let valid = pvt.position_valid && fine.is_none_or(|fine| fine.valid);
    // The baseline points forward: base antenna behind, rover antenna ahead. To a base that stands somewhere it
    // points there.
    // A receiver calls it valid before its ambiguities are fixed, however far it is off.
    let sure = matches!(relative.carrier, CarrierSolution::Float | CarrierSolution::Fixed)
        && relative.accuracy_heading_rad <= HEADING_ACCURACY_MAX_RAD;
    let on_board = relative.moving_base;
    let heading_rad = (relative.heading_valid && relative.fix_ok && sure && on_board)
        .then(|| wrap(FRAC_PI_2 - relative.heading_rad));
    Epoch {
        position: fine.map_or(pvt.position, |fine| fine.position),
        velocity_m_s: [pvt.velocity_east_m_s, pvt.velocity_north_m_s, -pvt.velocity_down_m_s],
        heading_rad,
        quality: Quality {
            fix: if valid { fix(pvt) } else { Fix::None },
            satellites: pvt.satellites,
            accuracy_horizontal_m: fine
                .map_or(pvt.accuracy_horizontal_m, |fine| fine.accuracy_horizontal_m),
        },
    }
}

fn fix(pvt: &NavPvt) -> Fix {
    if !pvt.fix_ok {
        return Fix::None;
    }
    match (pvt.fix_type, pvt.carrier) {
        (FixType::ThreeD | FixType::Combined, CarrierSolution::Fixed) => Fix::RtkFixed,
        (FixType::ThreeD | FixType::Combined, CarrierSolution::Float) => Fix::RtkFloat,
        (FixType::ThreeD | FixType::Combined, _) if pvt.differential => Fix::Differential,
        (FixType::ThreeD | FixType::Combined, _) => Fix::Single,
        // Without satellites, or with the height assumed, there is nothing to drive by.
        _ => Fix::None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: Geodetic = Geodetic::BENCH_ORIGIN;

    fn bytes(messages: &[Message]) -> Vec<u8> {
        let mut bytes = Vec::new();
        messages.iter().for_each(|m| m.encode(&mut bytes).unwrap());
        bytes
    }

    fn messages(time_of_week_ms: u32) -> [Message; 3] {
        let carrier = CarrierSolution::Fixed;
        let fine_height_m = HERE.height_m + 0.0004;
        let fine = Geodetic { height_m: fine_height_m, ..HERE };
        [
            Message::Pvt(NavPvt {
                time_of_week_ms,
                carrier,
                position: HERE,
                fix_ok: true,
                position_valid: true,
                fix_type: FixType::ThreeD,
                velocity_down_m_s: 0.5,
                ..NavPvt::default()
            }),
            Message::HpPosLlh(NavHpPosLlh {
                time_of_week_ms,
                valid: true,
                position: fine,
                ..NavHpPosLlh::default()
            }),
            Message::RelPosNed(NavRelPosNed {
                time_of_week_ms,
                heading_rad: 0.0,
                heading_valid: true,
                moving_base: true,
                fix_ok: true,
                carrier,
                ..NavRelPosNed::default()
            }),
        ]
    }

    #[test]
    fn an_epoch_is_complete_in_any_order() {
        let [a, b, c] = messages(125);
        for order in [[a, b, c], [c, b, a], [b, c, a]] {
            let mut collector = EpochCollector::default();
            // From the second epoch on, the fine position is known to come.
            collector.push(&bytes(&messages(0)));
            let epoch = collector.push(&bytes(&order)).unwrap();
            assert!((epoch.position.height_m - HERE.height_m - 0.0004).abs() < 1e-9, "{order:?}");
            assert_eq!(epoch.quality.fix, Fix::RtkFixed);
            assert!((epoch.velocity_m_s[2] + 0.5).abs() < 1e-12);
            assert!((epoch.heading_rad.unwrap() - FRAC_PI_2).abs() < 1e-12);
        }
    }

    #[test]
    fn an_invalid_position_is_no_fix_whichever_message_says_so() {
        let fix = |change: fn(&mut [Message; 3])| {
            let mut collector = EpochCollector::default();
            collector.push(&bytes(&messages(0)));
            let mut epoch = messages(125);
            change(&mut epoch);
            collector.push(&bytes(&epoch)).unwrap().quality.fix
        };
        assert_eq!(fix(|_| ()), Fix::RtkFixed);
        let fine = |epoch: &mut [Message; 3]| {
            let Message::HpPosLlh(fine) = &mut epoch[1] else { unreachable!() };
            fine.valid = false;
        };
        let coarse = |epoch: &mut [Message; 3]| {
            let Message::Pvt(pvt) = &mut epoch[0] else { unreachable!() };
            pvt.position_valid = false;
        };
        assert_eq!([fix(fine), fix(coarse)], [Fix::None; 2]);
    }

    #[test]
    fn a_heading_counts_only_where_it_is_valid_and_its_fix_is() {
        let (fixed, float) = (CarrierSolution::Fixed, CarrierSolution::Float);
        for (heading_valid, fix_ok, carrier, accuracy_deg, counts) in [
            (true, true, fixed, 0.3, true),
            (true, true, float, 2.9, true),
            (true, false, fixed, 0.3, false),
            (false, true, fixed, 0.3, false),
            (true, true, CarrierSolution::None, 0.3, false),
            (true, true, float, 3.1, false),
        ] {
            let mut collector = EpochCollector::default();
            let mut epoch = messages(0);
            let Message::RelPosNed(relative) = &mut epoch[2] else { unreachable!() };
            (relative.heading_valid, relative.fix_ok) = (heading_valid, fix_ok);
            relative.carrier = carrier;
            relative.accuracy_heading_rad = f64::to_radians(accuracy_deg);
            // The fine position last: of a first epoch it is not waited for.
            let [pvt, _, relative] = epoch;
            let epoch = collector.push(&bytes(&[pvt, relative])).unwrap();
            assert_eq!(epoch.heading_rad.is_some(), counts);
        }
    }

    #[test]
    fn messages_of_two_epochs_are_never_mixed() {
        let mut collector = EpochCollector::default();
        let [pvt, fine, _] = messages(0);
        let [_, _, relative] = messages(125);
        assert_eq!(collector.push(&bytes(&[pvt, fine, relative])), None);
        assert_eq!(collector.counts().1, 1);
    }

    #[test]
    fn a_receiver_without_the_fine_position_is_read_as_it_is() {
        let mut collector = EpochCollector::default();
        collector.push(&bytes(&messages(0)));
        for (time_of_week_ms, complete) in [(125, false), (250, true)] {
            let [pvt, _, relative] = messages(time_of_week_ms);
            assert_eq!(collector.push(&bytes(&[pvt, relative])).is_some(), complete);
        }
    }
}
