//! Whatever is in a policy file, its weights or an observation: a network or one line of refusal, and no demand that
//! is not a number but for weights that grow beyond all bounds.

use std::fs;
use std::path::{Path, PathBuf};

use gateway::policy::{Network, Policy};
use gateway::{Action, Attitude, Located, Observation, Pose};
use proptest::collection::vec;
use proptest::prelude::*;
use xt28_machine::{Machine, PerWheel, SimTime};

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(name)
}

/// Loads a policy file and weights of these bytes.
fn load(policy_file: &[u8], weights: &[u8]) -> Result<Network, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("imitated.toml");
    fs::write(&path, policy_file).unwrap();
    fs::write(folder.path().join("imitated.safetensors"), weights).unwrap();
    let goal = Some(Pose { east_m: 25.0, north_m: 0.0, heading_rad: 0.0 });
    Network::load(&path, &Machine::xt28(), goal, None).map_err(|error| error.to_string())
}

fn observation(bits: &[f64]) -> Observation {
    let six = |k: usize| PerWheel(core::array::from_fn(|wheel| bits[k + wheel]));
    let pose = Pose { east_m: bits[0], north_m: bits[1], heading_rad: bits[2] };
    let velocity_m_s = [bits[3], bits[4], bits[5]];
    Observation {
        at: SimTime::from_millis(125),
        sensed_at: SimTime::from_millis(120),
        since_arming_s: Some(1.0),
        located: Some(Located { at: SimTime::ZERO, pose, velocity_m_s }),
        attitude: Attitude { roll_rad: bits[6], pitch_rad: bits[7] },
        stroke_m: six(8),
        load_n: six(9),
        wheel_speed_rad_s: six(10),
        wheel_speed_m_s: bits[8],
        front_joint_rad: bits[9],
        rear_joint_rad: bits[10],
        previous_action: Action(core::array::from_fn(|k| bits[k])),
    }
}

/// Bytes of the example with some of them others.
fn changed(name: &str, changes: &[(usize, u8)]) -> Vec<u8> {
    let mut bytes = fs::read(example(name)).unwrap();
    let count = bytes.len();
    changes.iter().for_each(|(at, byte)| bytes[at % count] = *byte);
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn any_policy_file_is_a_network_or_a_line(
        changes in vec((any::<usize>(), any::<u8>()), 0..4),
        lines in vec(any::<prop::sample::Index>(), 0..3),
    ) {
        let weights = fs::read(example("imitated.safetensors")).unwrap();
        let bytes = changed("imitated.toml", &changes);
        let text = String::from_utf8_lossy(&bytes);
        let mut kept: Vec<&str> = text.lines().collect();
        for line in lines {
            if !kept.is_empty() {
                kept.remove(line.index(kept.len()));
            }
        }
        for file in [&bytes[..], kept.join("\n").as_bytes()] {
            if let Err(error) = load(file, &weights) {
                prop_assert_eq!(error.lines().count(), 1, "{}", error);
            }
        }
    }

    #[test]
    fn any_weights_are_a_network_or_a_line(
        changes in vec((any::<usize>(), any::<u8>()), 0..6),
        in_header in vec((0..480_usize, any::<u8>()), 0..3),
        cut in any::<prop::sample::Index>(),
        noise in vec(any::<u8>(), 0..64),
    ) {
        let text = fs::read(example("imitated.toml")).unwrap();
        let bytes = changed("imitated.safetensors", &changes);
        let header = changed("imitated.safetensors", &in_header);
        for weights in [&bytes[..], &header, &bytes[..cut.index(bytes.len())], &noise] {
            if let Err(error) = load(&text, weights) {
                prop_assert_eq!(error.lines().count(), 1, "{}", error);
            }
        }
    }

    /// With a squashed action, whatever it is fed with.
    #[test]
    fn any_observation_is_answered_with_numbers_or_not_at_all(
        bits in vec(any::<u64>().prop_map(f64::from_bits), 16),
        near in vec(-1.0..1.0, 16),
    ) {
        let mut network = Network::load(
            &example("imitated.toml"), &Machine::xt28(), Some(Pose::default()), None,
        ).unwrap();
        for numbers in [bits, near] {
            let seen = observation(&numbers);
            let answer = network.act(&seen);
            prop_assert!(answer.is_none_or(|command| command.is_finite()), "{answer:?}");
        }
    }
}
