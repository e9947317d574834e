//! The messages that a controller gets and sends, as JSON. `docs/rosbridge.md` has them for its author.

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use xt28_machine::SimTime;
use xt28_safety::Phase;

use crate::policy::Seen;
use crate::{Action, EcuReport, Located, Status};

/// `xt28_msgs/Observation`: [`crate::Observation`] in numbers, wheels in the order FR FL MR ML BR BL.
#[derive(Serialize)]
struct ObservationMessage<'a> {
    seq: u64,
    time_s: f64,
    /// Age of what it is about when it was put together, s.
    age_s: f64,
    since_arming_s: Option<f64>,
    located: Option<LocatedMessage>,
    roll_rad: f64,
    pitch_rad: f64,
    stroke_m: [f64; 6],
    load_n: [f64; 6],
    wheel_speed_rad_s: [f64; 6],
    speed_m_s: f64,
    front_joint_rad: f64,
    rear_joint_rad: f64,
    previous_action: [f64; 8],
    /// Left out where the gateway has no map or does not know where the machine is.
    #[serde(skip_serializing_if = "Option::is_none")]
    height_map_m: Option<&'a [f32]>,
}

#[derive(Serialize)]
struct LocatedMessage {
    age_s: f64,
    east_m: f64,
    north_m: f64,
    heading_rad: f64,
    /// East, north, up.
    velocity_m_s: [f64; 3],
}

/// An observation, with the heights around the machine where they are known.
pub(super) fn observation(seen: &Seen, height_map_m: Option<&[f32]>) -> Value {
    let Seen { seq, observation: o } = seen;
    let age_s = |at: SimTime| o.at.since(at).as_secs_f64();
    let message = ObservationMessage {
        seq: *seq,
        time_s: o.at.as_secs_f64(),
        age_s: age_s(o.sensed_at),
        since_arming_s: o.since_arming_s,
        located: o.located.as_ref().map(|located| located_message(located, age_s(located.at))),
        roll_rad: o.attitude.roll_rad,
        pitch_rad: o.attitude.pitch_rad,
        stroke_m: o.stroke_m.0,
        load_n: o.load_n.0,
        wheel_speed_rad_s: o.wheel_speed_rad_s.0,
        speed_m_s: o.wheel_speed_m_s,
        front_joint_rad: o.front_joint_rad,
        rear_joint_rad: o.rear_joint_rad,
        previous_action: o.previous_action.0,
        height_map_m,
    };
    json!(message)
}

const fn located_message(located: &Located, age_s: f64) -> LocatedMessage {
    let Located { pose, velocity_m_s, .. } = *located;
    LocatedMessage {
        age_s,
        east_m: pose.east_m,
        north_m: pose.north_m,
        heading_rad: pose.heading_rad,
        velocity_m_s,
    }
}

/// `xt28_msgs/Action`: eight numbers of [`Action`], and the `seq` of the observation that they answer.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ActionMessage {
    seq: u64,
    action: [f64; 8],
}

/// What of a message is an action: all of it, or it is none. What comes out is small, whatever came in.
pub(super) fn distil_action(message: &Value) -> Result<Value, String> {
    let (seq, Action(action)) = action(message)?;
    Ok(json!(ActionMessage { seq, action }))
}

/// Reads an action and what it answers.
pub(super) fn action(message: &Value) -> Result<(u64, Action), String> {
    match ActionMessage::deserialize(message) {
        Ok(ActionMessage { seq, action }) => Ok((seq, Action(action))),
        Err(error) => Err(format!(
            "no action: {error}; give {{\"seq\": of the observation, \"action\": eight numbers}}"
        )),
    }
}

/// Whether a task that is over was done, by the name `data` or, as the protocol also has it, by its place.
pub(super) fn distil_finish(args: &Value) -> Result<Value, String> {
    let data = args.get("data").or_else(|| args.get(0)).and_then(Value::as_bool);
    let why = "give data: true where the task is done, false where it is given up";
    data.map(Value::from).ok_or_else(|| why.to_owned())
}

/// `xt28_msgs/Status`: where the gateway is in its life, and what stands against going on.
pub(super) fn status(now: SimTime, status: &Status) -> Value {
    let phase = match status.phase {
        Phase::Disarmed => "disarmed",
        Phase::Handshake { .. } => "handshake",
        Phase::Armed => "armed",
        Phase::Blocked(_) => "blocked",
    };
    let ecu = |report: &EcuReport| report.state.name();
    json!({
        "time_s": now.as_secs_f64(),
        "phase": phase,
        "reason": status.blocked.map(|reason| status.told(reason)),
        "outcome": status.outcome.name(),
        "arm_ecu": ecu(&status.arm_ecu),
        "drive_ecu": ecu(&status.drive_ecu),
        "clamped": status.counts.clamped,
        "allowed": status.counts.allowed,
    })
}

#[cfg(test)]
mod tests {
    use xt28_machine::{Machine, PerWheel};

    use super::*;
    use crate::policy::Hold;
    use crate::{Attitude, Gateway, GatewayConfig, Observation, Pose};

    fn seen() -> Seen {
        let wheels = PerWheel([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let at = SimTime::from_millis;
        let pose = Pose { east_m: 3.0, north_m: -1.0, heading_rad: 0.5 };
        let observation = Observation {
            at: at(1000),
            sensed_at: at(990),
            since_arming_s: None,
            located: Some(Located { at: at(900), pose, velocity_m_s: [0.5, 0.1, f64::NAN] }),
            attitude: Attitude { roll_rad: 0.1, pitch_rad: -0.1 },
            stroke_m: wheels,
            load_n: wheels,
            wheel_speed_rad_s: wheels,
            wheel_speed_m_s: 0.4,
            front_joint_rad: 0.2,
            rear_joint_rad: 0.1,
            previous_action: Action([0.5; 8]),
        };
        Seen { seq: 7, observation }
    }

    fn keys<'a>(value: &'a Value, of: &'a str) -> impl Iterator<Item = String> + use<'a> {
        value.as_object().unwrap().keys().map(move |key| format!("`{of}{key}`"))
    }

    #[test]
    fn an_observation_says_what_is_seen() {
        let said = observation(&seen(), Some(&[0.1, -0.2]));
        assert_eq!((&said["seq"], &said["since_arming_s"]), (&json!(7), &Value::Null));
        assert!((said["age_s"].as_f64().unwrap() - 0.01).abs() < 1e-12);
        assert!((said["located"]["age_s"].as_f64().unwrap() - 0.1).abs() < 1e-12);
        // What is no number has no form in JSON.
        assert_eq!(said["located"]["velocity_m_s"], json!([0.5, 0.1, null]));
        assert_eq!(said["height_map_m"].as_array().unwrap().len(), 2);
        assert_eq!(observation(&seen(), None).get("height_map_m"), None);
    }

    #[test]
    fn the_documentation_has_every_key() {
        let page = include_str!("../../../docs/rosbridge.md");
        let machine = Machine::xt28();
        let gateway = Gateway::new(&machine, GatewayConfig::new(&machine), Box::new(Hold));
        let seen = observation(&seen(), Some(&[]));
        let state = status(SimTime::ZERO, &gateway.status());
        let all = keys(&seen, "").chain(keys(&seen["located"], "located.")).chain(keys(&state, ""));
        let missing: Vec<_> = all.filter(|key| !page.contains(key)).collect();
        assert!(missing.is_empty(), "{missing:?}");
    }

    #[test]
    fn an_action_is_eight_numbers_and_what_they_answer() {
        let (seq, read) =
            action(&json!({ "seq": 3, "action": [0, 1, 2, 3, 4, 5, 6, 7.5] })).unwrap();
        assert_eq!((seq, read), (3, Action([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.5])));
        let eight = [0; 8];
        for (bad, says) in [
            (json!({ "action": eight }), "missing field `seq`"),
            (json!({ "seq": -1, "action": eight }), "invalid value"),
            (json!({ "seq": 1, "action": &eight[1..] }), "length 7"),
            (json!({ "seq": 1, "action": [null] }), "invalid type"),
            (json!({ "seq": 1, "action": eight, "brake": true }), "unknown field `brake`"),
        ] {
            let why = action(&bad).unwrap_err();
            assert!(why.contains(says) && why.contains("eight numbers"), "{bad}: {why}");
        }
    }

    proptest::proptest! {
        /// Any eight numbers are an action if and only if JSON has a form for all of them.
        #[test]
        fn any_bits_are_an_action_or_none(bits in proptest::array::uniform8(proptest::num::u64::ANY)) {
            let sent = bits.map(f64::from_bits);
            let text = json!({ "seq": 1, "action": sent }).to_string();
            let read = action(&serde_json::from_str(&text).unwrap());
            if sent.iter().any(|number| !number.is_finite()) {
                proptest::prop_assert!(read.is_err());
            } else {
                // To the last digit but one, as JSON's numbers are read.
                let (_, Action(read)) = read.unwrap();
                let near = |(a, b): (&f64, &f64)| {
                    (a - b).abs() <= f64::MIN_POSITIVE + 4.0 * f64::EPSILON * b.abs()
                };
                proptest::prop_assert!(read.iter().zip(&sent).all(near), "{:?} {:?}", read, sent);
            }
        }
    }
}
