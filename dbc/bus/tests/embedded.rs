//! Code written against `embedded-can` on our buses, and a driver of that kind as one of ours.

use core::convert::Infallible;
use std::collections::VecDeque;

use embedded_can::{ErrorKind, Frame as _, Id, StandardId, blocking};
use xt28_bus::embedded::{
    BlockingController, CanFrame, Controller, ControllerError, Driver, DriverError,
};
use xt28_bus::{Bitrate, Bus, BusState, Received, VirtualBus};
use xt28_dbc::{CanId, Frame};
use xt28_machine::SimTime;

fn frame(id: u16) -> Frame {
    Frame::new(CanId::Standard(id), &[0xA5]).unwrap()
}

/// Somebody's code: answers every frame with one of the next identifier. Knows only the trait.
fn answer<C: embedded_can::nb::Can>(can: &mut C) -> nb::Result<(), C::Error> {
    let asked = can.receive()?;
    let Id::Standard(id) = asked.id() else { return Ok(()) };
    let answer = C::Frame::new(StandardId::new(id.as_raw() + 1).unwrap(), asked.data()).unwrap();
    can.transmit(&answer).map(drop)
}

#[test]
fn their_code_runs_on_our_bus() {
    let mut bus = VirtualBus::new(Bitrate::MBIT_1);
    let [ours, theirs] = ["ours", "theirs"].map(|name| bus.attach(name));
    assert!(matches!(answer(&mut Controller::new(bus.port(theirs))), Err(nb::Error::WouldBlock)));

    bus.send(ours, SimTime::ZERO, &frame(0x100));
    bus.advance(SimTime::from_millis(1));
    let mut controller = Controller::new(bus.port(theirs));
    controller.set_now(SimTime::from_millis(5));
    answer(&mut controller).unwrap();
    bus.advance(SimTime::from_millis(10));
    let answered = bus.receive(ours).unwrap();
    assert_eq!(answered.frame, frame(0x101));
    assert!(answered.at > SimTime::from_millis(5), "sent at the time that was set");
}

#[test]
fn blocking_code_lets_time_pass_until_a_frame_comes() {
    let mut bus = VirtualBus::new(Bitrate::MBIT_1);
    let [ours, theirs] = ["ours", "theirs"].map(|name| bus.attach(name));
    bus.send(ours, SimTime::from_millis(30), &frame(0x100));
    let mut now = SimTime::ZERO;
    let mut controller = BlockingController::new(bus.port(theirs), |port| {
        now += core::time::Duration::from_millis(10);
        port.advance(now);
        Ok::<_, Infallible>(now)
    });
    let heard = blocking::Can::receive(&mut controller).unwrap();
    assert_eq!(heard, CanFrame::Data(frame(0x100)));
    blocking::Can::transmit(&mut controller, &CanFrame::Data(frame(0x7))).unwrap();
    assert_eq!(now, SimTime::from_millis(40));
    bus.advance(SimTime::from_millis(50));
    assert!(bus.receive(ours).unwrap().at > SimTime::from_millis(40));
}

/// A bus that keeps when it was sent what.
#[derive(Default)]
struct Notebook(Vec<(SimTime, Frame)>, VecDeque<Received>);

impl Bus for Notebook {
    type Error = Infallible;

    fn send(&mut self, now: SimTime, frame: &Frame) -> Result<(), Infallible> {
        self.0.push((now, *frame));
        Ok(())
    }

    fn receive(&mut self) -> Result<Option<Received>, Infallible> {
        Ok(self.1.pop_front())
    }

    fn state(&self) -> BusState {
        BusState::ErrorActive
    }
}

#[test]
fn blocking_code_sends_at_the_time_to_which_it_waited() {
    let mut controller = BlockingController::new(Notebook::default(), |bus| {
        bus.1.push_back(Received { at: SimTime::from_millis(3), frame: frame(1) });
        Ok::<_, Infallible>(SimTime::from_millis(4))
    });
    blocking::Can::receive(&mut controller).unwrap();
    blocking::Can::transmit(&mut controller, &CanFrame::Data(frame(2))).unwrap();
    let sent = &controller.controller().bus().0;
    assert_eq!(sent, &[(SimTime::from_millis(4), frame(2))]);
}

#[test]
fn an_identifier_that_their_traits_cannot_show_is_passed_over() {
    let mut notebook = Notebook::default();
    let at = SimTime::ZERO;
    notebook.1 = [0x800, 0x7FF].map(|id| Received { at, frame: frame(id) }).into();
    let heard = embedded_can::nb::Can::receive(&mut Controller::new(notebook)).unwrap();
    assert_eq!(heard, CanFrame::Data(frame(0x7FF)));
}

#[test]
fn a_remote_frame_is_refused_and_not_sent_as_data() {
    let mut bus = VirtualBus::default();
    let node = bus.attach("theirs");
    let remote = CanFrame::new_remote(StandardId::ZERO, 8).unwrap();
    let sent = embedded_can::nb::Can::transmit(&mut Controller::new(bus.port(node)), &remote);
    assert!(matches!(sent, Err(nb::Error::Other(ControllerError::Remote))));
    assert_eq!(bus.pending(node), 0);
}

/// A controller as microcontrollers have them: two mailboxes, the most urgent leaves first, and
/// a full one hands back what is less urgent than the frame it takes.
#[derive(Default)]
struct Mailboxes {
    boxes: Vec<CanFrame>,
    heard: VecDeque<Result<CanFrame, ErrorKind>>,
}

impl Mailboxes {
    const COUNT: usize = 2;

    /// Puts the most urgent frame on the wire.
    fn leave(&mut self) -> Option<CanFrame> {
        let urgent = (0..self.boxes.len()).min_by_key(|&i| self.boxes[i].id())?;
        Some(self.boxes.remove(urgent))
    }
}

impl embedded_can::nb::Can for Mailboxes {
    type Frame = CanFrame;
    type Error = ErrorKind;

    fn transmit(&mut self, frame: &CanFrame) -> nb::Result<Option<CanFrame>, ErrorKind> {
        let mut replaced = None;
        if self.boxes.len() == Self::COUNT {
            let idle = (0..Self::COUNT).max_by_key(|&i| self.boxes[i].id()).unwrap();
            if self.boxes[idle].id() <= frame.id() {
                return Err(nb::Error::WouldBlock);
            }
            replaced = Some(self.boxes.remove(idle));
        }
        self.boxes.push(*frame);
        Ok(replaced)
    }

    fn receive(&mut self) -> nb::Result<CanFrame, ErrorKind> {
        self.heard.pop_front().ok_or(nb::Error::WouldBlock)?.map_err(nb::Error::Other)
    }
}

#[test]
fn every_frame_leaves_their_driver_once() {
    let mut bus = Driver::new(Mailboxes::default());
    let ids = [0x300, 0x200, 0x100, 0x250, 0x050, 0x300];
    for id in ids {
        bus.send(SimTime::ZERO, &frame(id)).unwrap();
    }
    let mut left = Vec::new();
    while let Some(frame) = bus.driver().leave() {
        left.push(frame.id());
        bus.flush();
    }
    left.sort();
    let mut expected = ids.map(|id| Id::Standard(StandardId::new(id).unwrap()));
    expected.sort();
    assert_eq!(left, expected);
    assert_eq!(bus.backlog(), 0);
}

#[test]
fn frames_of_one_identifier_leave_in_the_order_sent() {
    let mut bus = Driver::new(Mailboxes::default());
    let numbered = |n: u8| Frame::new(CanId::Standard(0x100), &[n]).unwrap();
    for n in 0..10 {
        bus.send(SimTime::ZERO, &numbered(n)).unwrap();
    }
    for n in 0..10 {
        assert_eq!(bus.driver().leave(), Some(CanFrame::Data(numbered(n))));
        bus.flush();
    }
}

#[test]
fn a_frame_that_made_room_is_next_again_before_later_ones() {
    let mut bus = Driver::new(Mailboxes::default());
    let sent = [(0x300, 1), (0x300, 2), (0x100, 0), (0x050, 0), (0x300, 3)];
    for (id, number) in sent {
        let frame = Frame::new(CanId::Standard(id), &[number]).unwrap();
        bus.send(SimTime::ZERO, &frame).unwrap();
    }
    let mut left = Vec::new();
    while let Some(frame) = bus.driver().leave() {
        left.push(frame.data()[0]);
        bus.flush();
    }
    assert_eq!(left, [0, 0, 1, 2, 3]);
}

#[test]
fn a_driver_that_takes_nothing_is_an_error_before_anything_is_lost() {
    let mut bus = Driver::new(Mailboxes::default());
    let mut sent = 0;
    let error = loop {
        match bus.send(SimTime::ZERO, &frame(0x100)) {
            Ok(()) => sent += 1,
            Err(error) => break error,
        }
    };
    assert_eq!(error, DriverError::BacklogFull { frames: sent - Mailboxes::COUNT });
    assert_eq!((sent - Mailboxes::COUNT, bus.backlog()), (256, 256));
}

#[test]
fn errors_of_their_driver_are_counted_and_remote_frames_passed_over() {
    let mut bus = Driver::new(Mailboxes::default());
    let remote = CanFrame::new_remote(StandardId::ZERO, 1).unwrap();
    bus.driver().heard = [Err(ErrorKind::Stuff), Ok(remote), Ok(CanFrame::Data(frame(1)))].into();
    bus.set_now(SimTime::from_millis(7));
    bus.set_state(BusState::ErrorPassive);
    assert_eq!(bus.receive(), Ok(None));
    let heard = bus.receive().unwrap().unwrap();
    assert_eq!((heard.at, heard.frame), (SimTime::from_millis(7), frame(1)));
    assert_eq!((bus.faults()[&ErrorKind::Stuff], bus.remote()), (1, 1));
    assert_eq!(bus.state(), BusState::ErrorPassive);
    bus.send(SimTime::from_millis(9), &frame(2)).unwrap();
    bus.driver().heard = [Ok(CanFrame::Data(frame(1)))].into();
    assert_eq!(bus.receive().unwrap().unwrap().at, SimTime::from_millis(9));
}
