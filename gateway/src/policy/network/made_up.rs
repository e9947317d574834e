//! A policy file, weights and an observation for tests to change.

use safetensors::Dtype;
use safetensors::tensor::TensorView;
use xt28_machine::{PerWheel, SimTime};

use crate::{Action, Attitude, Located, Observation};

/// Every term by its name.
pub(super) const ALL: [&str; 13] = [
    "goal_m",
    "goal_heading_rad",
    "velocity_m_s",
    "speed_m_s",
    "roll_rad",
    "pitch_rad",
    "stroke_m",
    "load_n",
    "wheel_speed_rad_s",
    "front_joint_rad",
    "rear_joint_rad",
    "previous_action",
    "height_map_m",
];

/// One layer of five numbers, of which the second frame's roll is the last before the goal.
pub(super) const FILE: &str = r#"weights = "w.safetensors"
layers = ["0"]
activation = "tanh"
squash = "none"
rate = "fix"

[[input]]
frames = 2
newest = "last"
terms = [
    { name = "roll_rad", scale = 10, clip = 1 },
]

[[input]]
terms = [
    { name = "goal_m", scale = [1.0, 2.0], clip = 5 },
    { name = "goal_heading_rad" },
]
"#;

/// Name, shape and numbers of a tensor.
pub(super) fn tensor(
    name: &str,
    shape: &[usize],
    numbers: &[f32],
) -> (String, Vec<usize>, Vec<u8>) {
    let bytes = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    (name.to_owned(), shape.to_vec(), bytes)
}

/// A safetensors file of `tensors`.
pub(super) fn file(tensors: &[(String, Vec<usize>, Vec<u8>)]) -> Vec<u8> {
    let views = tensors.iter().map(|(name, shape, bytes)| {
        let view = TensorView::new(Dtype::F32, shape.clone(), bytes);
        (name.as_str(), view.unwrap())
    });
    safetensors::serialize(views, None).unwrap()
}

/// A machine that stands at the origin, heads east and is armed.
pub(super) fn seen() -> Observation {
    let wheels = PerWheel([0.10, 0.11, 0.12, 0.13, 0.14, 0.15]);
    Observation {
        at: SimTime::ZERO,
        sensed_at: SimTime::ZERO,
        since_arming_s: Some(1.0),
        located: Some(Located::default()),
        attitude: Attitude::default(),
        stroke_m: wheels,
        load_n: wheels,
        wheel_speed_rad_s: wheels,
        wheel_speed_m_s: 0.0,
        front_joint_rad: 0.05,
        rear_joint_rad: 0.0,
        previous_action: Action::default(),
    }
}
