//! How more than one trouble code goes over the bus: by broadcast, by connection, and not at all.

mod bench;

use bench::Bench;
use xt28_dbc::Frame;
use xt28_machine::PerWheel;

/// All six strokes broken for 1.5 s.
fn broken() -> (Bench, Vec<Frame>) {
    let mut bench = Bench::new();
    bench.run(10);
    bench.arm_pins.stroke_mv = PerWheel::splat(5_000.0);
    let frames = bench.run(150);
    (bench, frames)
}

/// All six strokes were broken and are well again.
fn mended() -> Bench {
    let (mut bench, _) = broken();
    bench.arm_pins.stroke_mv = Bench::new().arm_pins.stroke_mv;
    bench.run(150);
    bench
}

/// Nothing fails at a stand, and that is told as well: once a second, by each ECU.
#[test]
fn active_codes_are_told_once_a_second() {
    let mut bench = Bench::new();
    bench.run(200);
    let frames = bench.run(1000);
    // The drive ECU misses an engine here: one code, which fits a frame.
    for id in [0x18FE_CA28, 0x18FE_CA29] {
        assert_eq!(frames.iter().filter(|f| f.id().raw() == id).count(), 10, "{id:X}");
    }
}

#[test]
fn more_than_one_active_code_goes_by_broadcast() {
    let (_, frames) = broken();
    let packets: Vec<_> = frames.iter().filter(|f| f.id().raw() == 0x1CEB_FF28).collect();
    let announced = frames.iter().find(|f| f.id().raw() == 0x1CEC_FF28).unwrap();
    // Two lamp bytes and six codes are 26 bytes in 4 packets.
    assert_eq!(announced.data(), [0x20, 26, 0, 4, 0xFF, 0xCA, 0xFE, 0]);
    assert!(packets.len() >= 4);
    assert_eq!(packets[0].data()[..6], [1, 0x10, 0xFF, 0x00, 0xF0, 0xE5]);
}

#[test]
fn more_than_one_former_code_goes_by_connection_to_who_asked() {
    let mut bench = mended();
    bench.offer(0x18EA_28F9, &[0xCB, 0xFE, 0]);
    let frames = bench.run(3);
    let rts = frames.iter().find(|f| f.id().raw() == 0x1CEC_F928).expect("to who asked alone");
    assert_eq!(rts.data(), [0x10, 26, 0, 4, 0xFF, 0xCB, 0xFE, 0]);
    assert!(frames.iter().all(|f| f.id().raw() != 0x1CEB_F928), "not before they are asked for");
    bench.offer(0x1CEC_28F9, &[0x11, 4, 1, 0xFF, 0xFF, 0xCB, 0xFE, 0]);
    let frames = bench.run(6);
    let data: Vec<u8> = frames
        .iter()
        .filter(|f| f.id().raw() == 0x1CEB_F928)
        .flat_map(|f| f.data()[1..].to_vec())
        .collect();
    assert_eq!(data.len(), 28);
    assert_eq!(data[..6], [0x00, 0xFF, 0x00, 0xF0, 0xE5, 1], "no lamp, stroke FR");
}

#[test]
fn former_codes_are_cleared_on_request_and_that_is_acknowledged() {
    let mut bench = mended();
    bench.offer(0x18EA_28F9, &[0xCC, 0xFE, 0]);
    let frames = bench.run(2);
    let acknowledged = frames.iter().find(|f| f.id().raw() == 0x18E8_FF28).unwrap();
    assert_eq!(acknowledged.data(), [0, 0xFF, 0xFF, 0xFF, 0xF9, 0xCC, 0xFE, 0]);
    bench.offer(0x18EA_28F9, &[0xCB, 0xFE, 0]);
    let frames = bench.run(2);
    let dm2 = frames.iter().find(|f| f.id().raw() == 0x18FE_CB28).expect("nothing is left");
    assert_eq!(dm2.data(), [0, 0xFF, 0, 0, 0, 0, 0xFF, 0xFF]);
}

/// The connection is over with the acknowledgement of its end: the next answer may go.
#[test]
fn a_connection_ends_with_its_acknowledgement() {
    let mut bench = mended();
    let ask_dm2 = |bench: &mut Bench| {
        bench.offer(0x18EA_28F9, &[0xCB, 0xFE, 0]);
        let frames = bench.run(3);
        frames.iter().filter(|f| f.id().raw() == 0x1CEC_F928).count()
    };
    assert_eq!(ask_dm2(&mut bench), 1);
    bench.offer(0x1CEC_28F9, &[0x11, 4, 1, 0xFF, 0xFF, 0xCB, 0xFE, 0]);
    bench.run(6);
    bench.offer(0x1CEC_28F9, &[0x13, 26, 0, 4, 0xFF, 0xCB, 0xFE, 0]);
    bench.run(1);
    assert_eq!(ask_dm2(&mut bench), 1);
}
