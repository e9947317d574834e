//! SocketCAN on a real interface of the kernel.
//!
//! `XT28_VCAN` names the interface (`vcan0`) and makes these tests a must; without it they run on
//! `vcan0` where there is one, and say so where there is none.
#![cfg(target_os = "linux")]
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // asks for XT28_VCAN, says what it skips

use core::time::Duration;
use std::io::{self, Write as _};
use std::process::{Command, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Instant, SystemTime};

use socketcan::{CanErrorFrame, CanRemoteFrame, CanSocket, EmbeddedFrame, Socket, StandardId};
use xt28_bus::socket_can::{BACKLOG_FRAMES, OpenReason, SocketError};
use xt28_bus::{Bus, BusState, Received, SocketCan};
use xt28_dbc::{CanId, Frame};
use xt28_machine::SimTime;

/// Longer than anything takes on a loaded machine.
const PATIENCE: Duration = Duration::from_secs(10);

/// One test at a time: they share the interface.
static INTERFACE: Mutex<()> = Mutex::new(());

/// The interface to test on, for as long as the guard lives; `None` says that it skips.
fn interface() -> Option<(String, MutexGuard<'static, ()>)> {
    let guard = INTERFACE.lock().unwrap_or_else(PoisonError::into_inner);
    let asked = std::env::var("XT28_VCAN").ok();
    let name = asked.clone().unwrap_or_else(|| "vcan0".to_owned());
    match SocketCan::open(&name) {
        Ok(_) => Some((name, guard)),
        Err(error) if asked.is_some() => panic!("XT28_VCAN is set, but: {error}"),
        Err(error) => {
            let _ = writeln!(io::stdout(), "SKIPPED: SocketCAN was not tested: {error}");
            None
        }
    }
}

fn frame(n: u32) -> Frame {
    Frame::new(CanId::Extended(0x18FE_0000 + n), &n.to_le_bytes()).unwrap()
}

/// Receives until `count` frames are there.
fn receive(bus: &mut SocketCan, count: usize) -> Vec<Received> {
    let mut received = Vec::new();
    let give_up = Instant::now() + PATIENCE;
    while received.len() < count && Instant::now() < give_up {
        bus.wait(Duration::from_millis(100)).unwrap();
        while let Some(frame) = bus.receive().unwrap() {
            received.push(frame);
        }
    }
    received
}

#[test]
fn frames_of_both_formats_go_from_one_socket_to_another() {
    let Some((name, _guard)) = interface() else { return };
    let before = SystemTime::now();
    let [mut a, mut b] = [(); 2].map(|()| SocketCan::open(&name).unwrap().starting_at(before));
    let frames: Vec<Frame> = (0..=8)
        .flat_map(|len| {
            [CanId::Standard(0x7FF), CanId::Standard(0), CanId::Extended(0x0CFF_4027)]
                .map(|id| Frame::new(id, &[0xA5, 0, 0xFF, 1, 2, 3, 4, 5][..len]).unwrap())
        })
        .collect();
    for frame in &frames {
        a.send(SimTime::ZERO, frame).unwrap();
    }
    let received = receive(&mut b, frames.len());
    let took = before.elapsed().unwrap();
    assert_eq!(received.iter().map(|r| r.frame).collect::<Vec<_>>(), frames);
    // The kernel's stamps, in order and between opening and now.
    assert!(received.is_sorted_by_key(|received| received.at));
    assert!(received.last().unwrap().at <= SimTime::ZERO + took);
    assert!(received.last().unwrap().at > SimTime::ZERO);
    // A sender does not hear itself.
    assert_eq!(a.receive().unwrap(), None);
    assert_eq!((a.counters().sent, b.counters().received), (27, 27));
    assert_eq!(b.receive_drops(), Some(0));
}

#[test]
fn waiting_ends_with_a_frame_or_with_the_time() {
    let Some((name, _guard)) = interface() else { return };
    let [mut a, mut b] = [(); 2].map(|()| SocketCan::open(&name).unwrap());
    let start = Instant::now();
    assert!(!b.wait(Duration::from_millis(20)).unwrap());
    assert!(start.elapsed() >= Duration::from_millis(20));
    assert_eq!(b.receive().unwrap(), None);
    a.send(SimTime::ZERO, &frame(1)).unwrap();
    assert!(b.wait(PATIENCE).unwrap());
    assert!(start.elapsed() < PATIENCE);
    assert_eq!(b.receive().unwrap().unwrap().frame, frame(1));
}

#[test]
fn what_a_slow_reader_loses_is_counted() {
    let Some((name, _guard)) = interface() else { return };
    let [mut a, mut slow] = [(); 2].map(|()| SocketCan::open(&name).unwrap());
    let (mut sent, mut drops) = (0, 0);
    while drops == 0 && sent < 200_000 {
        for _ in 0..1_000 {
            a.send(SimTime::ZERO, &frame(sent)).unwrap();
            sent += 1;
        }
        drops = slow.receive_drops().unwrap();
    }
    assert!(drops > 0, "{sent} frames fit into the socket's buffer");
    let received = receive(&mut slow, (sent - drops) as usize);
    assert_eq!(received.len() as u64, u64::from(sent - drops));
    assert!(received.iter().zip(0..).all(|(received, n)| received.frame == frame(n)));
}

#[test]
fn error_frames_move_the_state() {
    let Some((name, _guard)) = interface() else { return };
    let mut bus = SocketCan::open(&name).unwrap();
    // A virtual interface carries error frames that somebody makes up.
    let controller = CanSocket::open(&name).unwrap();
    let mut report = |class: u32, controller_flags: u8| {
        let error = CanErrorFrame::new_error(class, &[0, controller_flags]).unwrap();
        controller.write_frame(&error).unwrap();
        assert!(bus.wait(PATIENCE).unwrap());
        assert_eq!(bus.receive().unwrap(), None);
        bus.state()
    };
    assert_eq!(report(0x004, 0x20), BusState::ErrorPassive);
    assert_eq!(report(0x040, 0), BusState::BusOff);
    assert_eq!(report(0x100, 0), BusState::ErrorActive);
    assert_eq!(report(0x040, 0), BusState::BusOff);
    assert_eq!(bus.counters().error, 4);
    let remote = CanRemoteFrame::new_remote(StandardId::ZERO, 8).unwrap();
    controller.write_frame(&remote).unwrap();
    assert!(bus.wait(PATIENCE).unwrap());
    assert_eq!((bus.receive().unwrap(), bus.counters().remote), (None, 1));
    // Whoever hears frames is on the bus.
    SocketCan::open(&name).unwrap().send(SimTime::ZERO, &frame(1)).unwrap();
    assert_eq!(receive(&mut bus, 1).len(), 1);
    assert_eq!(bus.state(), BusState::ErrorActive);
}

#[test]
fn can_utils_hear_us_and_we_hear_them() {
    let Some((name, _guard)) = interface() else { return };
    let candump =
        Command::new("candump").args(["-L", "-n", "2", &name]).stdout(Stdio::piped()).spawn();
    let Ok(candump) = candump else {
        assert!(std::env::var_os("XT28_VCAN").is_none(), "can-utils are not installed");
        let _ = writeln!(
            io::stdout(),
            "SKIPPED: can-utils are not installed, so SocketCAN was not tested against them"
        );
        return;
    };
    let mut bus = SocketCan::open(&name).unwrap();
    // candump says nothing when it is ready, so sending goes on until it has heard enough.
    let done = std::thread::spawn(move || candump.wait_with_output());
    let give_up = Instant::now() + PATIENCE;
    while !done.is_finished() && Instant::now() < give_up {
        bus.send(SimTime::ZERO, &frame(0x27)).unwrap();
        bus.wait(Duration::from_millis(20)).unwrap();
    }
    let log = String::from_utf8(done.join().unwrap().unwrap().stdout).unwrap();
    let records: Vec<_> =
        xt28_bus::candump::Reader::new(log.as_bytes(), "candump").map(Result::unwrap).collect();
    assert_eq!(records.len(), 2, "{log}");
    assert!(records.iter().all(|r| r.frame == frame(0x27) && *r.interface == *name), "{log}");

    let sent = Command::new("cansend").args([&name, "0CFF4027#DEADBEEF"]).status().unwrap();
    assert!(sent.success());
    let heard = receive(&mut bus, 1);
    assert_eq!(
        heard[0].frame,
        Frame::new(CanId::Extended(0x0CFF_4027), &[0xDE, 0xAD, 0xBE, 0xEF]).unwrap()
    );
}

/// Runs `ip`, which takes the right to administer the network.
fn ip(args: &str) -> bool {
    let status = Command::new("ip").args(args.split(' ')).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}

/// Makes interfaces of its own, so it runs only where it may: always where `XT28_VCAN` is set.
#[test]
fn an_interface_that_is_down_gone_or_no_can_is_named_with_its_remedy() {
    let Some((_, _guard)) = interface() else { return };
    let reason = |name: &str| SocketCan::open(name).unwrap_err().reason;
    assert!(matches!(reason("lo"), OpenReason::NotCan));
    assert!(matches!(reason("xt28none"), OpenReason::NoInterface));
    if !ip("link add dev xt28test type vcan") {
        assert!(std::env::var_os("XT28_VCAN").is_none(), "interfaces cannot be made here");
        let _ = writeln!(
            io::stdout(),
            "SKIPPED: not allowed to make an interface, so none was taken down"
        );
        return;
    }
    assert!(matches!(reason("xt28test"), OpenReason::Down));
    assert!(ip("link set xt28test up"));
    let mut bus = SocketCan::open("xt28test").unwrap();
    bus.send(SimTime::ZERO, &frame(1)).unwrap();
    assert!(ip("link set xt28test down"));
    assert!(matches!(bus.receive(), Err(SocketError::Down { .. })));
    assert!(matches!(bus.send(SimTime::ZERO, &frame(1)), Err(SocketError::Down { .. })));
    assert!(ip("link set xt28test up"));
    bus.send(SimTime::ZERO, &frame(1)).unwrap();
    assert!(ip("link del xt28test"));
    let error = bus.send(SimTime::ZERO, &frame(1)).unwrap_err();
    assert!(matches!(error, SocketError::Gone { .. }), "{error}");
}

/// An interface that lets some 100 frames a second through and queues about ten, removed when
/// dropped. `None` says that it skips.
struct SlowInterface;

impl SlowInterface {
    const NAME: &str = "xt28slow";

    fn new() -> Option<Self> {
        let shaped = ip("link add dev xt28slow type vcan") && ip("link set xt28slow up") && {
            let tc = "qdisc add dev xt28slow root tbf rate 12800bit burst 64 limit 512";
            Command::new("tc").args(tc.split(' ')).status().is_ok_and(|status| status.success())
        };
        let slow = Self;
        if !shaped {
            let _ = writeln!(
                io::stdout(),
                "SKIPPED: no traffic shaping here (tc, sch_tbf): ENOBUFS was not tested"
            );
            return None;
        }
        Some(slow)
    }
}

impl Drop for SlowInterface {
    fn drop(&mut self) {
        ip("link del xt28slow");
    }
}

/// A full queue in front of the interface: the kernel answers ENOBUFS.
#[test]
fn a_full_transmit_queue_delays_frames_and_loses_none() {
    let Some((_, _guard)) = interface() else { return };
    let Some(_slow) = SlowInterface::new() else { return };
    let [mut bus, mut ear] = [(); 2].map(|()| SocketCan::open(SlowInterface::NAME).unwrap());
    let mut sent = 0;
    let error = loop {
        match bus.send(SimTime::ZERO, &frame(sent)) {
            Ok(()) => sent += 1,
            Err(error) => break error,
        }
    };
    assert!(matches!(error, SocketError::BacklogFull { frames: BACKLOG_FRAMES, .. }), "{error}");
    assert!(bus.counters().queue_full > 0 && bus.counters().refused == 1);
    let give_up = Instant::now() + PATIENCE;
    while bus.backlog() > 0 && Instant::now() < give_up {
        bus.wait(Duration::from_millis(10)).unwrap();
    }
    let heard = receive(&mut ear, sent as usize);
    assert!(heard.iter().map(|heard| heard.frame).eq((0..sent).map(frame)), "{}", heard.len());
}

#[test]
fn bus_off_throws_the_waiting_frames_away_and_counts_them() {
    let Some((_, _guard)) = interface() else { return };
    let Some(_slow) = SlowInterface::new() else { return };
    let mut bus = SocketCan::open(SlowInterface::NAME).unwrap();
    while bus.backlog() < 20 {
        bus.send(SimTime::ZERO, &frame(1)).unwrap();
    }
    let controller = CanSocket::open(SlowInterface::NAME).unwrap();
    let bus_off = CanErrorFrame::new_error(0x040, &[]).unwrap();
    let give_up = Instant::now() + PATIENCE;
    while controller.write_frame(&bus_off).is_err() && Instant::now() < give_up {}
    // Receiving alone hands nothing to the kernel, so all twenty still wait.
    while bus.state() != BusState::BusOff && Instant::now() < give_up {
        assert_eq!(bus.receive().unwrap(), None);
    }
    assert_eq!((bus.backlog(), bus.counters().discarded), (0, 20));
    // The queue is still full, and nothing waits for a bus that is off.
    while bus.counters().discarded == 20 && Instant::now() < give_up {
        bus.send(SimTime::ZERO, &frame(2)).unwrap();
    }
    assert_eq!((bus.backlog(), bus.counters().discarded), (0, 21));
}
