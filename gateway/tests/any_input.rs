//! Whatever comes in from bus, receiver and people: no panic, and nothing moves that may not.

mod bench;
mod vehicle;

use std::path::Path;

use bench::Bench;
use gateway::policy::{Goto, Script, from_spec};
use gateway::{Gateway, GatewayConfig, Order, Phase, Pose};
use proptest::prelude::*;
use vehicle::Variant;
use xt28_dbc::messages::{
    ArmStatus, ArmTargetMode, Attitude, CylLoadFront, CylLoadMidRear, DriveStatus, PosFront,
    PosMidRear, WheelSpeedJoint, WheelSpeedSigned,
};
use xt28_dbc::{CanId, Frame, Outbox};
use xt28_machine::{Machine, SimTime};
use xt28_safety::Limits;

/// A machine that does what it is told, at a stand: it is not stepped here.
const STRAIGHT: Variant =
    Variant { throttle_delay_s: 0.0, steering_delay_s: 0.0, speed_factor: 1.0, noise: false };

#[derive(Clone, Debug)]
enum In {
    Frame(Frame),
    Gnss(Vec<u8>),
    Order(Order),
    Bus(bool),
    /// Milliseconds until the next tick.
    Tick(u64),
}

const HEARD: [CanId; 9] = [
    ArmStatus::ID,
    DriveStatus::ID,
    PosFront::ID,
    PosMidRear::ID,
    CylLoadFront::ID,
    CylLoadMidRear::ID,
    Attitude::ID,
    WheelSpeedJoint::ID,
    WheelSpeedSigned::ID,
];

fn any_in() -> impl Strategy<Value = In> {
    let frame = (0..HEARD.len(), proptest::collection::vec(any::<u8>(), 0..=8))
        .prop_map(|(id, data)| In::Frame(Frame::new(HEARD[id], &data).unwrap()));
    prop_oneof![
        8 => frame,
        2 => proptest::collection::vec(any::<u8>(), 0..120).prop_map(In::Gnss),
        1 => any_order().prop_map(In::Order),
        1 => any::<bool>().prop_map(In::Bus),
        4 => (0..40_u64).prop_map(In::Tick),
    ]
}

/// What becomes of a frame or of the receiver's bytes on their way.
#[derive(Clone, Copy, Debug)]
enum Way {
    Well,
    Lost,
    /// This byte becomes that one.
    Spoilt(usize, u8),
}

impl Way {
    fn of(self, bytes: &[u8]) -> Option<Vec<u8>> {
        let mut bytes = bytes.to_vec();
        match self {
            Self::Well => {}
            Self::Lost => return None,
            Self::Spoilt(at, with) => {
                let at = at % bytes.len().max(1);
                bytes.get_mut(at).into_iter().for_each(|byte| *byte = with);
            }
        }
        Some(bytes)
    }
}

/// One period: what becomes of its ten frames or so and of the receiver's bytes, and an order.
fn any_period() -> impl Strategy<Value = (Vec<Way>, Option<Order>)> {
    let way = prop_oneof![
        40 => Just(Way::Well),
        1 => Just(Way::Lost),
        2 => (any::<usize>(), any::<u8>()).prop_map(|(at, with)| Way::Spoilt(at, with)),
    ];
    let order = prop_oneof![40 => Just(None), 1 => any_order().prop_map(Some)];
    (proptest::collection::vec(way, 12), order)
}

fn any_order() -> impl Strategy<Value = Order> {
    // Most arm: it would not be armed for long otherwise.
    prop_oneof![
        6 => Just(Order::Arm),
        1 => Just(Order::Disarm),
        1 => Just(Order::EmergencyStop),
        2 => Just(Order::Release),
    ]
}

/// One period of a machine of which something else may come in than it says.
fn period(bench: &mut Bench, ways: &[Way], order: Option<Order>) {
    let now = bench.now;
    let seen = bench.vehicle.observe(now);
    let mut ways = ways.iter().copied().cycle();
    let mut way = || ways.next().unwrap_or(Way::Well);
    for frame in bench.frames(&seen) {
        if let Some(data) = way().of(frame.data()) {
            bench.gateway.on_frame(now, &Frame::new(frame.id(), &data).unwrap());
        }
    }
    if now.as_nanos().is_multiple_of(120_000_000)
        && let Some(bytes) = way().of(&bench.receiver_bytes(&seen))
    {
        bench.gateway.on_gnss(now, &bytes);
    }
    order.into_iter().for_each(|order| bench.gateway.order(order));
    bench.sent.clear();
    bench.gateway.tick(now, &mut bench.sent);
    for frame in bench.sent.clone().frames() {
        bench.take(frame);
    }
    bench.now = SimTime::from_nanos(now.as_nanos() + 10_000_000);
}

proptest! {
    /// It is armed when the noise begins, and now and then again.
    #[test]
    fn on_a_bus_that_spoils_frames_nothing_moves_unless_it_is_armed(
        periods in proptest::collection::vec(any_period(), 0..200),
    ) {
        let machine = Machine::xt28();
        let goal = Pose { east_m: 25.0, ..Pose::default() };
        let policy = Box::new(Goto::new(&machine, goal));
        let gateway = Gateway::new(&machine, GatewayConfig::new(&machine), policy);
        let mut bench = Bench::new(gateway, STRAIGHT);
        (0..60).for_each(|_| period(&mut bench, &[Way::Well], None));
        prop_assert_eq!(bench.gateway.status().phase, Phase::Armed);
        prop_assert!(bench.drive_target().unwrap().enable);
        for (ways, order) in periods {
            period(&mut bench, &ways, order);
            let (drive, arm) = (bench.drive_target(), bench.arm_target());
            match bench.gateway.status().phase {
                Phase::Armed => {
                    prop_assert!(drive.is_some_and(|drive| drive.enable) && arm.is_some());
                }
                Phase::Disarmed | Phase::Blocked(_) | Phase::Handshake { .. } => {
                    prop_assert!(drive.is_none_or(|d| !d.enable && d.throttle_percent == 0.0));
                    prop_assert!(arm.is_none_or(|arm| arm.mode == ArmTargetMode::Off));
                }
            }
        }
    }

    #[test]
    fn a_gateway_fed_anything_never_panics(
        inputs in proptest::collection::vec(any_in(), 0..300),
    ) {
        let machine = Machine::xt28();
        let goal = Pose { east_m: 25.0, ..Pose::default() };
        let policy = Box::new(Goto::new(&machine, goal));
        let mut gateway = Gateway::new(&machine, GatewayConfig::new(&machine), policy);
        let (mut now_ms, mut out) = (0, Outbox::default());
        for input in inputs {
            let now = SimTime::from_millis(now_ms);
            match input {
                In::Frame(frame) => gateway.on_frame(now, &frame),
                In::Gnss(bytes) => gateway.on_gnss(now, &bytes),
                In::Order(order) => gateway.order(order),
                In::Bus(ok) => gateway.on_bus(ok),
                In::Tick(after_ms) => {
                    now_ms += after_ms;
                    out.clear();
                    gateway.tick(SimTime::from_millis(now_ms), &mut out);
                    prop_assert!(gateway.status().phase != Phase::Armed, "no receiver was heard");
                }
            }
        }
    }

    #[test]
    fn any_text_is_a_script_or_a_one_line_refusal(
        text in r#"(\[\[command\]\]\n)?((at_s|ramp_s|throttle_percent|end_s|arms|stroke_mm) ?= ?[-0-9.e"a-z\[\],]{0,12}\n){0,5}"#,
        noise in ".{0,40}",
    ) {
        for text in [text.clone(), format!("{text}{noise}")] {
            if let Err(error) = Script::parse(&text, Path::new("any.toml"), &Limits::XT28) {
                prop_assert_eq!(error.to_string().lines().count(), 1);
            }
        }
    }

    #[test]
    fn any_name_is_a_policy_or_a_refusal(name in "(goto:|hold|)[-0-9,.einfa ]{0,20}") {
        let machine = Machine::xt28();
        if let Err(error) = from_spec(&name, &machine, None) {
            prop_assert_eq!(error.to_string().lines().count(), 1);
        }
    }
}
