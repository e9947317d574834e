//! What a service tool sees of both ECUs, frame by frame: J1939, UDS, and a life after a brown-out.

mod bench;

use bench::{Bench, Tool};
use xt28_dbc::CanId;
use xt28_dbc::messages::{ArmStatus, ArmStatusReason, ArmStatusState, ArmTargetMode};
use xt28_ecus::diagnostics::{parts, uds};
use xt28_machine::{PerWheel, Wheel};

const ARM: u8 = 0x28;
const DRIVE: u8 = 0x29;

/// SPN 520192 (stroke FR) with FMI 5, 4 and 3, as three bytes.
const STROKE_FR_OPEN: [u8; 3] = [0x00, 0xF0, 0xE5];
const STROKE_FR_LOW: [u8; 3] = [0x00, 0xF0, 0xE4];
const STROKE_FR_HIGH: [u8; 3] = [0x00, 0xF0, 0xE3];

#[test]
fn both_ecus_claim_their_addresses_first() {
    let mut bench = Bench::new();
    let frames = bench.tick();
    let claims: Vec<String> = frames
        .iter()
        .filter(|frame| frame.id().raw() & 0x00FF_0000 == 0x00EE_0000)
        .map(|frame| format!("{frame:?}"))
        .collect();
    assert_eq!(claims, ["18EEFF28#616D000000122820", "18EEFF29#626D000000032820"]);
}

#[test]
fn an_ecu_that_loses_its_address_is_silent_in_diagnostics_and_works_on() {
    let mut bench = Bench::new();
    bench.tick();
    bench.offer(0x18EE_FF28, &[0; 8]);
    let frames = bench.run(150);
    let from_arm = |raw: u32| raw & 0xFF == 0x28 && matches!(raw >> 16 & 0xFF, 0xFE | 0xEB | 0xEC);
    assert!(frames.iter().all(|f| !from_arm(f.id().raw()) || f.id().raw() >> 8 & 0xFF != 0xCA));
    assert!(frames.iter().any(|f| f.id() == CanId::Extended(0x18EE_FFFE)), "says it has none");
    assert!(frames.iter().any(|f| f.id() == ArmStatus::ID), "its own frames go on");
    let mut tool = Tool::new(ARM);
    assert_eq!(tool.ask(&mut bench, &[0x3E, 0]), None);
    assert_eq!(Tool::new(DRIVE).ask(&mut bench, &[0x3E, 0]), Some(vec![0x7E, 0]));
}

#[test]
fn a_broken_wire_is_told_within_its_debounce_and_by_name() {
    let cases = [(5_000.0, STROKE_FR_OPEN), (100.0, STROKE_FR_LOW), (5_400.0, STROKE_FR_HIGH)];
    for (mv, code) in cases {
        let mut bench = Bench::new();
        bench.run(50);
        bench.arm_pins.stroke_mv[Wheel::Fr] = mv;
        let before: Vec<_> = bench.run(20);
        assert!(bench.dm1(&before, ARM).is_none(), "not before 200 ms");
        let frames = bench.run(2);
        let dm1 = bench.dm1(&frames, ARM).expect("at once, not at the next second");
        assert_eq!(dm1, [&[0x10, 0xFF][..], &code, &[1, 0xFF, 0xFF]].concat());
        assert_eq!(bench.arm_status().state, ArmStatusState::Fault);
    }
}

#[test]
fn an_arm_in_doubt_waits_while_the_others_go_on() {
    let mut bench = Bench::new();
    for tick in 0..20 {
        if tick == 10 {
            bench.arm_pins.stroke_mv[Wheel::Fr] = 5_000.0;
        }
        bench.command(ArmTargetMode::ManualPosition, 200.0);
        bench.tick();
        let moves = |wheel| bench.arm_out.solenoid_b_ma[wheel] > 0.0;
        assert!(moves(Wheel::Fl) && bench.arm_status().state == ArmStatusState::Active);
        assert_eq!(moves(Wheel::Fr), tick < 10, "tick {tick}");
        assert_eq!(bench.arm_out.solenoid_a_ma, PerWheel::splat(0.0), "nor back");
    }
}

#[test]
fn a_request_for_what_is_not_there_is_denied_but_not_to_all() {
    let mut bench = Bench::new();
    bench.run(2);
    bench.offer(0x18EA_29F9, &[0xEC, 0xFE, 0]);
    let frames = bench.run(2);
    let denied = frames.iter().find(|f| f.id().raw() == 0x18E8_FF29).unwrap();
    assert_eq!(denied.data(), [1, 0xFF, 0xFF, 0xFF, 0xF9, 0xEC, 0xFE, 0]);
    bench.offer(0x18EA_FFF9, &[0xEC, 0xFE, 0]);
    assert!(bench.run(3).iter().all(|f| f.id().raw() >> 16 & 0xFF != 0xE8));
    bench.offer(0x18EA_FFFE, &[0x00, 0xEE, 0]);
    let claims = bench.run(2).iter().filter(|f| f.id().raw() >> 16 & 0xFF == 0xEE).count();
    assert_eq!(claims, 2, "even a node without an address may ask who is there");
}

#[test]
fn every_identifier_of_the_table_can_be_read() {
    let mut bench = Bench::new();
    bench.run(60);
    for (target, own) in [(ARM, uds::identifier::ARM), (DRIVE, uds::identifier::DRIVE)] {
        let mut tool = Tool::new(target);
        assert_eq!(tool.ask(&mut bench, &[0x10, 3]).unwrap()[..2], [0x50, 3]);
        for identifier in uds::identifier::COMMON.iter().chain(own) {
            let [high, low] = identifier.did.to_be_bytes();
            let reply = tool.ask(&mut bench, &[0x22, high, low]).unwrap();
            assert_eq!(reply[..3], [0x62, high, low], "{}", identifier.name);
            let length = reply.len() - 3;
            let expected = match identifier.layout.split_once(" x ") {
                Some((count, _)) => 2 * count.parse::<usize>().unwrap(),
                None if identifier.layout.starts_with("u8") => 1,
                None if identifier.layout.starts_with("u16") => 2,
                None => length.max(5),
            };
            assert_eq!(length, expected, "{}", identifier.name);
        }
    }
    let strokes = Tool::new(ARM).ask(&mut bench, &[0x22, 0x01, 0x10]).unwrap();
    assert_eq!(strokes[3..5], 170_u16.to_be_bytes());
}

#[test]
fn refusals_are_the_standards() {
    let mut bench = Bench::new();
    bench.run(2);
    let mut tool = Tool::new(ARM);
    let cases: [(&[u8], u8); 12] = [
        (&[0x27, 1], 0x11),
        (&[0x10, 2], 0x12),
        (&[0x10], 0x13),
        (&[0x10, 3, 0], 0x13),
        (&[0x3E, 1], 0x12),
        (&[0x3E, 0, 0], 0x13),
        (&[0x22, 1], 0x13),
        (&[0x22, 0xAB, 0xCD], 0x31),
        (&[0x22, 0x02, 0x10], 0x31),
        (&[0x19, 0x03], 0x12),
        (&[0x19, 0x02], 0x13),
        (&[0x14, 1, 2, 3], 0x31),
    ];
    for (request, code) in cases {
        let reply = tool.ask(&mut bench, request);
        assert_eq!(reply, Some(vec![0x7F, request[0], code]), "{request:02X?}");
    }
    // Not in that many: the ninth identifier is one too many.
    let many = [&[0x22][..], &[0x01, 0x10].repeat(9)].concat();
    assert_eq!(tool.ask(&mut bench, &many), Some(vec![0x7F, 0x22, 0x13]));
    // One that there is and one that there is not.
    let reply = tool.ask(&mut bench, &[0x22, 0xAB, 0xCD, 0x01, 0x01]).unwrap();
    assert_eq!(reply, [0x62, 0x01, 0x01, 0x5D, 0xC0]);
}

#[test]
fn silence_is_kept_where_it_is_asked_for() {
    let mut bench = Bench::new();
    bench.run(2);
    let mut tool = Tool::new(ARM);
    assert_eq!(tool.ask(&mut bench, &[0x3E, 0x80]), None);
    assert_eq!(
        tool.ask(&mut bench, &[0x3E, 0x81]),
        Some(vec![0x7F, 0x3E, 0x12]),
        "a refusal is said"
    );
    // To all: both answer what concerns them, and neither says no.
    assert_eq!(bench.ask_all(&[0x3E, 0]), [(ARM, vec![0x7E, 0]), (DRIVE, vec![0x7E, 0])]);
    assert_eq!(bench.ask_all(&[0x22, 0x01, 0x20]).len(), 1, "the drive ECU's");
    assert_eq!(bench.ask_all(&[0x27, 1]), []);
    assert_eq!(bench.ask_all(&[0x10]).len(), 2, "but a wrong length is told");
}

#[test]
fn a_session_ends_when_nobody_keeps_it_up() {
    let mut bench = Bench::new();
    bench.run(2);
    let mut tool = Tool::new(ARM);
    let raw = [0x22, 0x02, 0x10];
    tool.ask(&mut bench, &[0x10, 3]).unwrap();
    for _ in 0..3 {
        bench.run(450);
        tool.ask(&mut bench, &[0x3E, 0x80]);
    }
    assert_eq!(tool.ask(&mut bench, &raw).unwrap()[0], 0x62);
    bench.run(510);
    assert_eq!(tool.ask(&mut bench, &raw), Some(vec![0x7F, 0x22, 0x31]));
}

/// 127 ms between frames: the list of all codes takes longer than a session lasts.
#[test]
fn a_session_lasts_through_a_slow_answer() {
    let mut bench = Bench::new();
    bench.run(2);
    bench.offer(0x18DA_28F1, &[2, 0x10, 3]);
    bench.offer(0x18DA_28F1, &[2, 0x19, 0x0A]);
    assert!(bench.run(3).iter().all(|f| f.id().raw() != 0x18DA_F128 || f.data()[0] != 0x10));
    bench.offer(0x18DA_28F1, &[2, 0x19, 0x0A]);
    bench.run(2);
    bench.offer(0x18DA_28F1, &[0x30, 0, 0x7F]);
    let frames = bench.run(520);
    let answers = frames.iter().filter(|f| f.id().raw() == 0x18DA_F128);
    assert!((35..45).contains(&answers.count()), "still under way after 5.2 s");
    bench.offer(0x18DB_33F1, &[2, 0x3E, 0x80]);
    bench.offer(0x18DA_28F1, &[3, 0x22, 0x02, 0x10]);
    bench.run(250);
    let raw = Tool::new(ARM).ask(&mut bench, &[0x22, 0x02, 0x10]).unwrap();
    assert_eq!(raw[0], 0x62, "the session stood");
}

#[test]
fn trouble_codes_are_counted_listed_and_cleared() {
    let mut bench = Bench::new();
    bench.arm_pins.stroke_mv[Wheel::Fr] = 5_000.0;
    bench.run(60);
    let mut tool = Tool::new(ARM);
    assert_eq!(tool.ask(&mut bench, &[0x19, 1, 0x01]).unwrap(), [0x59, 1, 0xFF, 2, 0, 1]);
    let active = [&[0x59, 2, 0xFF][..], &STROKE_FR_OPEN, &[0xAF]].concat();
    assert_eq!(tool.ask(&mut bench, &[0x19, 2, 0x01]).unwrap(), active);
    let all = tool.ask(&mut bench, &[0x19, 0x0A]).unwrap();
    let codes: usize = parts::ARM.iter().map(|part| part.modes.len()).sum();
    assert_eq!(all.len(), 3 + 4 * codes);

    bench.arm_pins.stroke_mv = Bench::new().arm_pins.stroke_mv;
    bench.run(2);
    let stored = [&[0x59, 2, 0xFF][..], &STROKE_FR_OPEN, &[0x2E]].concat();
    assert_eq!(tool.ask(&mut bench, &[0x19, 2, 0x08]).unwrap(), stored);
    let [a, b, c] = STROKE_FR_OPEN;
    assert_eq!(tool.ask(&mut bench, &[0x14, a, b, c]).unwrap(), [0x54]);
    assert_eq!(tool.ask(&mut bench, &[0x19, 2, 0x08]).unwrap(), [0x59, 2, 0xFF]);
    assert_eq!(tool.ask(&mut bench, &[0x14, 0xFF, 0xFF, 0xFF]).unwrap(), [0x54]);
}

#[test]
fn a_stroke_that_leaps_is_a_fault_and_one_that_is_off_is_not() {
    let mut bench = Bench::new();
    let rest_mv = bench.arm_pins.stroke_mv[Wheel::Br];
    bench.run(20);
    bench.arm_pins.stroke_mv[Wheel::Br] = rest_mv + 200.0;
    bench.run(50);
    assert_eq!(bench.arm_status().state, ArmStatusState::Standby, "one leap, then off by 24 mm");
    for tick in 0..10 {
        bench.arm_pins.stroke_mv[Wheel::Br] = rest_mv + 100.0 * f64::from(tick % 2);
        bench.tick();
    }
    assert_eq!(bench.arm_status().state, ArmStatusState::Fault);
    // SPN 520196, FMI 10.
    let found = Tool::new(ARM).ask(&mut bench, &[0x19, 2, 0x01]).unwrap();
    assert_eq!(found, [0x59, 2, 0xFF, 0x04, 0xF0, 0xEA, 0xAF]);
    bench.run(30);
    assert_eq!(bench.arm_status().state, ArmStatusState::SafeStop, "quiet again");
}

#[test]
fn a_wheel_without_pulses_is_missed_while_the_others_roll() {
    let mut bench = Bench::new();
    bench.drive_pins.wheel_hz = PerWheel::splat(700.0);
    bench.drive_pins.wheel_hz[Wheel::Fr] = 0.0;
    bench.run(102);
    let mut tool = Tool::new(DRIVE);
    let silent = [0x3A, 0xF0, 0xE8, 0xAF];
    let mut found = || tool.ask(&mut bench, &[0x19, 2, 0x01]).unwrap()[3..].to_vec();
    assert!(found().chunks(4).any(|code| code == silent), "SPN 520250, FMI 8");
    bench.drive_pins.wheel_hz = PerWheel::splat(0.0);
    bench.run(2);
    let mut found = || tool.ask(&mut bench, &[0x19, 2, 0x01]).unwrap()[3..].to_vec();
    assert!(found().chunks(4).all(|code| code != silent), "a machine at rest has no pulses");
}

#[test]
fn a_stuck_stroke_under_an_open_valve_is_found() {
    let mut bench = Bench::new();
    bench.run(60);
    for _ in 0..200 {
        bench.command(ArmTargetMode::ManualPosition, 400.0);
        bench.tick();
    }
    assert_eq!(bench.arm_status().state, ArmStatusState::Fault);
    assert_eq!(bench.arm_out.solenoid_b_ma, PerWheel::splat(0.0));
    let found = Tool::new(ARM).ask(&mut bench, &[0x19, 2, 0x01]).unwrap();
    let codes: Vec<u8> = found[3..].chunks(4).map(|code| code[2] & 0x1F).collect();
    assert_eq!(codes, [7; 6], "all six, the bench's pins do not move");
}

#[test]
fn a_dip_in_motion_darkens_the_ecu_and_it_moves_nothing_before_it_rests() {
    let mut bench = Bench::new();
    let mut last_counter = 0;
    for _ in 0..50 {
        bench.command(ArmTargetMode::ManualPosition, 200.0);
        bench.tick();
        last_counter = bench.arm_status().counter;
    }
    assert_eq!(bench.arm_status().state, ArmStatusState::Active);
    assert_ne!(bench.arm_out.solenoid_b_ma, PerWheel::splat(0.0));

    bench.arm_pins.supply_mv = 6_000.0;
    bench.command(ArmTargetMode::ManualPosition, 200.0);
    assert!(bench.tick().iter().all(|f| f.id() != ArmStatus::ID), "dark");
    assert_eq!(bench.arm_out.solenoid_b_ma, PerWheel::splat(0.0), "within the tick");
    bench.arm_pins.supply_mv = 24_000.0;
    let mut states = Vec::new();
    for _ in 0..60 {
        bench.command(ArmTargetMode::ManualPosition, 200.0);
        let frames = bench.tick();
        assert_eq!(bench.arm_out.solenoid_b_ma, PerWheel::splat(0.0));
        if frames.iter().any(|f| f.id() == ArmStatus::ID) {
            let status = bench.arm_status();
            if states.is_empty() {
                assert_eq!(status.counter, 0, "counters begin anew; {last_counter} before");
            }
            states.push((status.state, status.reason));
        }
    }
    let init = states.iter().filter(|(state, _)| *state == ArmStatusState::Init).count();
    assert_eq!((init, states.len()), (10, 60 - 25), "250 ms of boot, 100 ms of self test");
    assert_eq!(states.last(), Some(&(ArmStatusState::SafeStop, ArmStatusReason::Rearm)));
    // SPN 168, FMI 1: active while it waits for rest, kept after.
    let active = Tool::new(ARM).ask(&mut bench, &[0x19, 2, 0x01]).unwrap();
    assert_eq!(active, [0x59, 2, 0xFF, 168, 0, 1, 0xAF]);

    for _ in 0..4 {
        bench.command(ArmTargetMode::Off, 0.0);
        bench.tick();
    }
    assert_eq!(bench.arm_status().state, ArmStatusState::Standby);
    bench.command(ArmTargetMode::ManualPosition, 200.0);
    bench.tick();
    assert_eq!(bench.arm_status().state, ArmStatusState::Active);
    let kept = Tool::new(ARM).ask(&mut bench, &[0x19, 2, 0x08]).unwrap();
    assert_eq!(kept, [0x59, 2, 0xFF, 168, 0, 1, 0x2E]);
}

#[test]
fn a_restart_of_the_drive_ecu_holds_the_brake_until_it_is_commanded() {
    let mut bench = Bench::new();
    bench.run(10);
    assert!(bench.drive_out.brake_released);
    bench.drive.reset(bench.now);
    bench.run(1);
    assert!(!bench.drive_out.brake_released && bench.drive_out.can1.frames().is_empty());
    bench.run(100);
    assert!(!bench.drive_out.brake_released && !bench.drive_out.can1.frames().is_empty());
    // SPN 629, FMI 2, among what the bench's silent engine and gateway leave.
    let kept = Tool::new(DRIVE).ask(&mut bench, &[0x19, 2, 0x08]).unwrap();
    assert!(kept[3..].chunks(4).any(|code| code == [0x75, 0x02, 0x02, 0xAF]), "{kept:02X?}");
}
