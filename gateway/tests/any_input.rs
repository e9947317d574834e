//! Whatever comes in from bus, receiver and people: no panic, and nothing moves that may not.

use std::path::Path;

use gateway::policy::{Goto, Script, from_spec};
use gateway::{Gateway, GatewayConfig, Order, Pose};
use proptest::prelude::*;
use xt28_dbc::messages::{
    ArmStatus, ArmTarget, ArmTargetMode, Attitude, CylLoadFront, CylLoadMidRear, DriveStatus,
    DriveTarget, PosFront, PosMidRear, WheelSpeedJoint, WheelSpeedSigned,
};
use xt28_dbc::{CanId, Frame, Outbox};
use xt28_machine::{Machine, SimTime};
use xt28_safety::Limits;

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
    let order = prop_oneof![
        Just(Order::Arm),
        Just(Order::Disarm),
        Just(Order::EmergencyStop),
        Just(Order::Release)
    ];
    prop_oneof![
        8 => frame,
        2 => proptest::collection::vec(any::<u8>(), 0..120).prop_map(In::Gnss),
        1 => order.prop_map(In::Order),
        1 => any::<bool>().prop_map(In::Bus),
        4 => (0..40_u64).prop_map(In::Tick),
    ]
}

proptest! {
    #[test]
    fn a_gateway_fed_anything_never_panics_nor_moves_an_unarmed_machine(
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
                    let armed = gateway.status().armed_at.is_some();
                    for frame in out.frames().iter().filter(|_| !armed) {
                        if frame.id() == DriveTarget::ID {
                            let target = DriveTarget::decode(frame).unwrap();
                            prop_assert!(!target.enable && target.throttle_percent == 0.0);
                        }
                        if frame.id() == ArmTarget::ID {
                            let target = ArmTarget::decode(frame).unwrap();
                            prop_assert_eq!(target.mode, ArmTargetMode::Off);
                        }
                    }
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
