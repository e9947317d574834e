//! The trouble code of commands that stay away: from a stop that silence caused to the next command, and else never.

mod bench;

use bench::{Bench, Tool};
use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::{ArmTargetMode, DriveTarget};

/// ECUs by address, with SPN 520221 (arm commands) and 520222 (drive commands), FMI 9.
const ARM: (u8, [u8; 3]) = (0x28, [0x1D, 0xF0, 0xE9]);
const DRIVE: (u8, [u8; 3]) = (0x29, [0x1E, 0xF0, 0xE9]);
/// Frames of the commands' identifiers that no sender made.
const DAMAGED: [u32; 2] = [0x0CFF_4027, 0x0CFF_4127];

struct Senders(AliveCounter);

impl Senders {
    /// Both ECUs are told to move, or to rest, for so many ticks.
    fn speak(&mut self, bench: &mut Bench, moves: bool, ticks: u32) {
        for _ in 0..ticks {
            bench.command(
                if moves { ArmTargetMode::ManualPosition } else { ArmTargetMode::Off },
                170.0,
            );
            let target = DriveTarget {
                throttle_percent: 0.0,
                front_angle_deg: 0.0,
                engine_speed_rpm: 1200.0,
                brake: false,
                enable: moves,
                counter: self.0.next_count(),
            };
            let frame = target.encode().unwrap();
            bench.offer(frame.id().raw(), frame.data());
            bench.tick();
        }
    }
}

/// Whether each has the code as one that fails now, when a second has gone by.
fn says_so(bench: &mut Bench) -> [bool; 2] {
    bench.run(100);
    [ARM, DRIVE].map(|(ecu, code)| {
        let failing = Tool::new(ecu).ask(bench, &[0x19, 0x02, 0x01]).unwrap();
        failing[3..].chunks(4).any(|entry| entry[..3] == code)
    })
}

#[test]
fn a_damaged_frame_does_not_end_the_silence() {
    let mut bench = Bench::new();
    Senders(AliveCounter::default()).speak(&mut bench, true, 60);
    assert_eq!(says_so(&mut bench), [true; 2]);
    DAMAGED.iter().for_each(|id| bench.offer(*id, &[0; 8]));
    assert_eq!(says_so(&mut bench), [true; 2]);
}

#[test]
fn senders_that_left_at_rest_are_not_missed_for_a_stop_of_before() {
    let mut bench = Bench::new();
    let mut senders = Senders(AliveCounter::default());
    senders.speak(&mut bench, true, 60);
    assert_eq!(says_so(&mut bench), [true; 2]);
    senders.speak(&mut bench, false, 60);
    assert_eq!(says_so(&mut bench), [false; 2]);
}
