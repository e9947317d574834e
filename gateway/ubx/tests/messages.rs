//! Messages survive the wire to its resolution, wherever the stream is cut and whatever is between.

use proptest::prelude::*;
use xt28_ubx::{
    CarrierSolution, FixType, Geodetic, Message, NavHpPosLlh, NavPvt, NavRelPosNed, Parser, Utc,
};

fn pvt() -> NavPvt {
    NavPvt {
        time_of_week_ms: 123_456_000,
        utc: Utc {
            year: 2025,
            month: 9,
            day: 21,
            hour: 7,
            minute: 42,
            second: 59,
            nanosecond: -17,
            valid: 7,
        },
        fix_type: FixType::ThreeD,
        fix_ok: true,
        differential: true,
        carrier: CarrierSolution::Fixed,
        position_valid: true,
        satellites: 17,
        position: Geodetic::from_degrees(59.800_123_4, 17.900_432_1, 23.456),
        height_msl_m: -1.234,
        accuracy_horizontal_m: 0.014,
        accuracy_vertical_m: 0.02,
        velocity_north_m_s: -0.8,
        velocity_east_m_s: 0.075,
        velocity_down_m_s: -0.025,
        speed_ground_m_s: 0.804,
        course_rad: 3.1,
        accuracy_speed_m_s: 0.05,
        accuracy_course_rad: 0.1,
        dilution: 1.23,
    }
}

fn bytes_of(message: Message) -> Vec<u8> {
    let mut bytes = Vec::new();
    message.encode(&mut bytes).unwrap();
    bytes
}

#[test]
fn nav_pvt_sits_where_the_interface_description_puts_it() {
    let bytes = bytes_of(Message::Pvt(pvt()));
    assert_eq!(bytes.len(), 100);
    assert_eq!(bytes[..6], [0xB5, 0x62, 0x01, 0x07, 92, 0]);
    let payload = &bytes[6..98];
    let i32_at = |at: usize| i32::from_le_bytes(payload[at..at + 4].try_into().unwrap());
    assert_eq!(payload[20..24], [3, 0b1000_0011, 0, 17]);
    assert_eq!(i32_at(24), 179_004_321);
    assert_eq!(i32_at(28), 598_001_234);
    assert_eq!(i32_at(32), 23_456);
    assert_eq!(i32_at(48), -800);
    assert_eq!(i32_at(52), 75);
}

#[test]
fn nav_relposned_sits_where_the_interface_description_puts_it() {
    let relative = NavRelPosNed {
        north_m: -1.234_5,
        heading_rad: 90.5_f64.to_radians(),
        heading_valid: true,
        carrier: CarrierSolution::Fixed,
        ..NavRelPosNed::default()
    };
    let bytes = bytes_of(Message::RelPosNed(relative));
    assert_eq!(bytes.len(), 72);
    assert_eq!(bytes[..7], [0xB5, 0x62, 0x01, 0x3C, 64, 0, 1]);
    let payload = &bytes[6..70];
    assert_eq!(payload[8..12], (-123_i32).to_le_bytes());
    assert_eq!(payload[32].cast_signed(), -45);
    assert_eq!(payload[24..28], 9_050_000_i32.to_le_bytes());
    assert_eq!(payload[60..64], 0x110_u32.to_le_bytes());
}

#[test]
fn the_fine_position_resolves_a_tenth_of_a_millimetre() {
    let position = Geodetic::from_degrees(59.800_123_456_7, -17.900_432_198_7, -0.000_1);
    let fine = NavHpPosLlh { valid: true, position, ..NavHpPosLlh::default() };
    let bytes = bytes_of(Message::HpPosLlh(fine));
    let Some(Message::HpPosLlh(read)) = Parser::new().push(&bytes).next() else {
        panic!("no message")
    };
    let half_step_rad = 0.51e-9_f64.to_radians();
    assert!((read.position.latitude_rad - position.latitude_rad).abs() < half_step_rad);
    assert!((read.position.longitude_rad - position.longitude_rad).abs() < half_step_rad);
    assert!((read.position.height_m - position.height_m).abs() < 1e-9);
}

#[test]
fn what_does_not_fit_is_refused_and_nothing_is_written() {
    let mut bytes = vec![1, 2];
    let bad = NavPvt { velocity_east_m_s: f64::NAN, ..pvt() };
    assert!(bad.encode(&mut bytes).unwrap_err().to_string().contains("velocity east"));
    assert_eq!(bytes, [1, 2]);
}

#[test]
fn a_flipped_bit_costs_one_message_and_is_counted() {
    let good = bytes_of(Message::Pvt(pvt()));
    for at in 6..good.len() {
        let mut stream = good.clone();
        stream[at] ^= 0x10;
        stream.extend_from_slice(&good);
        let mut parser = Parser::new();
        assert_eq!(parser.push(&stream).count(), 1, "byte {at}");
        assert_eq!(parser.counts().bad_checksum, 1, "byte {at}");
    }
}

#[test]
fn a_length_that_cannot_be_does_not_stall_the_stream() {
    let mut stream = vec![0xB5, 0x62, 0x01, 0x07, 0xFF, 0xFF];
    stream.extend(bytes_of(Message::Pvt(pvt())));
    let mut parser = Parser::new();
    assert_eq!(parser.push(&stream).count(), 1);
    assert_eq!(parser.counts().oversize, 1);
    assert_eq!(parser.counts().skipped_bytes, 6);
}

#[test]
fn a_wrong_version_and_an_unused_kind_are_counted_apart() {
    let mut relative = bytes_of(Message::RelPosNed(NavRelPosNed::default()));
    relative[6] = 0;
    let sum = xt28_ubx::checksum(&relative[2..70]);
    relative[70..].copy_from_slice(&sum);
    let mut parser = Parser::new();
    assert_eq!(parser.push(&relative).count(), 0);
    assert_eq!(parser.push(&[0xB5, 0x62, 0x0A, 0x04, 0, 0, 0x0E, 0x34]).count(), 0);
    assert_eq!((parser.counts().malformed, parser.counts().other), (1, 1));
}

prop_compose! {
    fn any_message()(kind in 0..3, raw in proptest::collection::vec(any::<u8>(), 92)) -> Message {
        // Any payload of the right length decodes; that gives every representable message.
        let mut fitting = raw;
        match kind {
            0 => Message::Pvt(NavPvt::decode(&fitting).unwrap()),
            1 => {
                fitting.truncate(NavHpPosLlh::LEN);
                fitting[0] = 0;
                fitting[24..28].fill(0);
                Message::HpPosLlh(NavHpPosLlh::decode(&fitting).unwrap())
            }
            _ => {
                fitting.truncate(NavRelPosNed::LEN);
                fitting[0] = 1;
                fitting[32..36].fill(0);
                Message::RelPosNed(NavRelPosNed::decode(&fitting).unwrap())
            }
        }
    }
}

proptest! {
    #[test]
    fn encode_then_decode_then_encode_is_the_same_bytes(message in any_message()) {
        let bytes = bytes_of(message);
        let read: Vec<_> = Parser::new().push(&bytes).collect();
        prop_assert_eq!(read.len(), 1);
        prop_assert_eq!(bytes_of(read[0]), bytes);
    }

    #[test]
    fn any_bytes_in_any_portions_give_the_same_and_never_panic(
        noise in proptest::collection::vec(prop_oneof![Just(0xB5_u8), Just(0x62), Just(1), any::<u8>()], 0..400),
        cuts in proptest::collection::vec(1..40_usize, 1..60),
    ) {
        let mut stream = noise.clone();
        stream.extend(bytes_of(Message::Pvt(pvt())));
        stream.extend(&noise);
        let mut whole = Parser::new();
        let at_once: Vec<_> = whole.push(&stream).collect();
        let mut portioned = Parser::new();
        let mut in_parts = Vec::new();
        let mut rest = &stream[..];
        for cut in cuts.iter().cycle() {
            if rest.is_empty() { break; }
            let (head, tail) = rest.split_at((*cut).min(rest.len()));
            in_parts.extend(portioned.push(head));
            rest = tail;
        }
        prop_assert_eq!(at_once, in_parts);
        prop_assert_eq!(whole.counts(), portioned.counts());
    }

    #[test]
    fn garbage_without_a_start_never_costs_a_message(
        garbage in proptest::collection::vec(any::<u8>().prop_filter("no sync", |b| *b != 0xB5), 0..200),
    ) {
        let mut stream = garbage.clone();
        stream.extend(bytes_of(Message::Pvt(pvt())));
        let mut parser = Parser::new();
        prop_assert_eq!(parser.push(&stream).count(), 1);
        prop_assert_eq!(parser.counts().skipped_bytes, garbage.len() as u64);
    }
}
