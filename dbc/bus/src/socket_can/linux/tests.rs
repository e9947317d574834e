//! The open interface against the other end of a pair of sockets in the place of the kernel.

use std::os::fd::OwnedFd;
use std::os::unix::net::UnixDatagram;

use xt28_dbc::CanId;

use super::*;

/// A bus whose kernel is the other end of a pair of sockets.
fn bus() -> (SocketCan, UnixDatagram) {
    let (ours, kernel) = UnixDatagram::pair().unwrap();
    [&ours, &kernel].into_iter().for_each(|end| end.set_nonblocking(true).unwrap());
    let bus = SocketCan {
        socket: CanSocket::from(OwnedFd::from(ours)),
        interface: "pair".to_owned(),
        zero: SystemTime::UNIX_EPOCH,
        backlog: VecDeque::new(),
        state: BusState::ErrorActive,
        was_off: false,
        counters: SocketCounters::default(),
    };
    (bus, kernel)
}

#[test]
fn a_bus_off_that_is_over_when_it_is_read_is_told_all_the_same() {
    let (mut bus, kernel) = bus();
    bus.socket.set_recv_timestamp(true).unwrap();
    // CAN_ERR_FLAG with CAN_ERR_BUSOFF, then CAN_ERR_RESTARTED, of linux/can/error.h.
    for class in [0x2000_0040_u32, 0x2000_0100] {
        let mut raw = [0; 16];
        raw[..4].copy_from_slice(&class.to_ne_bytes());
        raw[4] = 8;
        kernel.send(&raw).unwrap();
    }
    assert!(!bus.take_bus_off());
    assert_eq!(bus.receive().unwrap(), None);
    assert_eq!((bus.state(), bus.counters().error), (BusState::ErrorActive, 2));
    assert_eq!([bus.take_bus_off(), bus.take_bus_off()], [true, false]);
    bus.enter(BusState::BusOff);
    assert_eq!([bus.take_bus_off(), bus.take_bus_off()], [true; 2], "as long as it is off");
}

#[test]
fn nothing_reaches_the_kernel_while_the_controller_is_known_to_be_bus_off() {
    let (mut bus, kernel) = bus();
    let command = Frame::new(CanId::Standard(1), &[0xA5]).unwrap();
    let frames_of_kernel = || {
        let mut bytes = [0; 64];
        core::iter::from_fn(|| kernel.recv(&mut bytes).ok()).count()
    };
    bus.send(SimTime::ZERO, &command).unwrap();
    assert_eq!(frames_of_kernel(), 1);
    bus.enter(BusState::BusOff);
    for _ in 0..3 {
        bus.send(SimTime::ZERO, &command).unwrap();
    }
    bus.enter(BusState::ErrorActive);
    bus.flush().unwrap();
    assert_eq!((frames_of_kernel(), bus.counters().discarded), (0, 3));
    bus.send(SimTime::ZERO, &command).unwrap();
    assert_eq!((frames_of_kernel(), bus.counters().sent), (1, 2));
}

/// A data frame or an error frame as the kernel hands it over: identifier with flags, length, data.
fn hand_over(kernel: &UnixDatagram, id: u32) {
    let mut raw = [0; 16];
    raw[..4].copy_from_slice(&id.to_ne_bytes());
    raw[4] = 8;
    kernel.send(&raw).unwrap();
}

/// The identifiers that reached the kernel and were not taken from it yet.
fn taken(kernel: &UnixDatagram) -> Vec<u32> {
    let mut raw = [0; 64];
    let received = core::iter::from_fn(|| kernel.recv(&mut raw).ok().map(|_| raw));
    received.map(|raw| u32::from_ne_bytes([raw[0], raw[1], raw[2], raw[3]])).collect()
}

fn numbered(id: u16) -> Frame {
    Frame::new(CanId::Standard(id), &[]).unwrap()
}

#[test]
fn what_the_kernel_does_not_take_waits_in_order_up_to_its_room() {
    let (mut bus, kernel) = bus();
    let mut sent = 0;
    let error = loop {
        match bus.send(SimTime::ZERO, &numbered(sent)) {
            Ok(()) => sent += 1,
            Err(error) => break error,
        }
    };
    assert!(matches!(error, SocketError::BacklogFull { frames: BACKLOG_FRAMES, .. }), "{error}");
    assert_eq!((bus.backlog(), bus.counters().refused), (BACKLOG_FRAMES, 1));
    assert!(bus.counters().queue_full > 0 && bus.counters().sent < u64::from(sent));
    let mut heard = Vec::new();
    while bus.backlog() > 0 {
        heard.extend(taken(&kernel));
        bus.flush().unwrap();
    }
    heard.extend(taken(&kernel));
    assert!(heard.into_iter().eq((0..sent).map(u32::from)));
    assert_eq!(bus.counters().sent, u64::from(sent));
}

#[test]
fn waiting_frames_are_tried_again_while_one_waits_for_another() {
    let (mut bus, kernel) = bus();
    while bus.backlog() < 20 {
        bus.send(SimTime::ZERO, &numbered(7)).unwrap();
    }
    let all = usize::try_from(bus.counters().sent).unwrap() + 20;
    let drained = std::thread::spawn(move || {
        let mut count = 0;
        while count < all {
            // Later, and bit by bit.
            poll(&mut [], Some(&Timespec { tv_sec: 0, tv_nsec: 2_000_000 })).unwrap();
            count += taken(&kernel).len();
        }
        kernel
    });
    assert!(!bus.wait(Duration::from_millis(300)).unwrap(), "nothing came");
    assert_eq!(bus.backlog(), 0);
    hand_over(&drained.join().unwrap(), 5);
    assert!(bus.wait(Duration::from_secs(60)).unwrap());
}

#[test]
fn bus_off_throws_away_what_waits() {
    let (mut bus, _kernel) = bus();
    while bus.backlog() < 3 {
        bus.send(SimTime::ZERO, &numbered(7)).unwrap();
    }
    bus.enter(BusState::ErrorPassive);
    assert_eq!((bus.backlog(), bus.counters().discarded), (3, 0));
    bus.enter(BusState::BusOff);
    assert_eq!((bus.backlog(), bus.counters().discarded), (0, 3));
}

#[test]
fn who_hears_a_frame_is_on_the_bus() {
    let (mut bus, kernel) = bus();
    bus.socket.set_recv_timestamp(true).unwrap();
    for (before, after) in [
        (BusState::BusOff, BusState::ErrorActive),
        (BusState::ErrorPassive, BusState::ErrorPassive),
    ] {
        bus.enter(before);
        hand_over(&kernel, 0x123);
        let heard = bus.receive().unwrap().unwrap();
        assert_eq!((heard.frame.id(), bus.state()), (CanId::Standard(0x123), after));
    }
}

#[test]
fn times_count_from_the_start_and_none_is_before_it() {
    let (mut bus, kernel) = bus();
    bus.socket.set_recv_timestamp(true).unwrap();
    let mut heard_at = |zero| {
        bus.zero = zero;
        hand_over(&kernel, 1);
        bus.receive().unwrap().unwrap().at
    };
    let (year, century) = (Duration::from_secs(365 * 86_400), Duration::from_secs(36_525 * 86_400));
    let since_1970 = heard_at(SystemTime::UNIX_EPOCH);
    let since_1971 = heard_at(SystemTime::UNIX_EPOCH + year);
    assert!(since_1970.since(since_1971) > year / 2, "{since_1970:?}, {since_1971:?}");
    assert_eq!(heard_at(SystemTime::UNIX_EPOCH + 2 * century), SimTime::ZERO);
}

#[test]
fn what_the_kernel_says_of_an_interface_is_told_apart() {
    let (bus, _kernel) = bus();
    let told = |errno: Errno| bus.error("send", errno.into());
    assert!(matches!(told(Errno::NETDOWN), SocketError::Down { .. }));
    assert!(matches!(told(Errno::NODEV), SocketError::Gone { .. }));
    assert!(matches!(told(Errno::NXIO), SocketError::Gone { .. }));
    assert!(matches!(told(Errno::INVAL), SocketError::Io { doing: "send", .. }));
}
