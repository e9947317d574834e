//! Every effect there is, in the order of blocks along the machine.

use super::effect::Effect;
use super::{arms, bus, drive, ground, payload, sensors, steering, tyres};

/// All effects.
pub static CATALOGUE: &[Effect] = &[
    arms::arm_gain::EFFECT,
    arms::arm_delay::EFFECT,
    arms::valve_lag::EFFECT,
    arms::valve_hysteresis::EFFECT,
    arms::valve_deadband::EFFECT,
    arms::valve_gain::EFFECT,
    arms::speed_asymmetry::EFFECT,
    arms::load_dependent_speed::EFFECT,
    arms::pump_flow_limit::EFFECT,
    arms::leakage_drift::EFFECT,
    arms::unsupported_sag::EFFECT,
    arms::accumulator_gas::EFFECT,
    arms::lock_damping::EFFECT,
    arms::seal_stiction::EFFECT,
    steering::steer_delay::EFFECT,
    steering::steer_lag::EFFECT,
    steering::steer_backlash::EFFECT,
    steering::steer_rate::EFFECT,
    steering::steer_gain::EFFECT,
    steering::rear_follower_lag::EFFECT,
    drive::throttle_delay::EFFECT,
    drive::drive_lag::EFFECT,
    drive::rolling_resistance::EFFECT,
    drive::standstill_drag::EFFECT,
    drive::engine_droop::EFFECT,
    tyres::slippery_ground::EFFECT,
    tyres::soft_tyres::EFFECT,
    payload::load::EFFECT,
    payload::com_shift::EFFECT,
    ground::terrain_slope::EFFECT,
    sensors::stroke_bias::EFFECT,
    sensors::stroke_scale::EFFECT,
    sensors::pressure_bias::EFFECT,
    sensors::pressure_scale::EFFECT,
    sensors::imu_offset::EFFECT,
    sensors::wheel_speed_scale::EFFECT,
    sensors::gnss_latency::EFFECT,
    sensors::gnss_lever_arm::EFFECT,
    bus::frame_loss::EFFECT,
    bus::command_jitter::EFFECT,
];

/// The effect of this name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Effect> {
    CATALOGUE.iter().find(|effect| effect.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Block, Effects, Scope};

    #[test]
    fn names_are_unique_and_neutral_is_the_default() {
        let nominal = Effects::default();
        for (i, effect) in CATALOGUE.iter().enumerate() {
            assert!(CATALOGUE[..i].iter().all(|other| other.name != effect.name));
            assert!(!effect.parameters.is_empty(), "{}", effect.name);
            for p in effect.parameters {
                assert!(p.tolerance > 0.0, "{} {}", effect.name, p.name);
                assert!(
                    p.range[0] < p.range[1] && p.range[0] <= p.neutral && p.neutral <= p.range[1]
                );
                for scope in Scope::ALL {
                    assert_eq!(p.get(&nominal, scope), p.neutral, "{} {}", effect.name, p.name);
                }
            }
        }
    }

    /// Verdicts are compared across plants by these names, so none may change its block or go.
    #[test]
    fn every_name_that_verdicts_share_is_there_and_in_its_block() {
        let shared = [
            (
                Block::Arms,
                "arm-delay valve-lag valve-deadband valve-hysteresis valve-gain speed-asymmetry \
                 load-dependent-speed pump-flow-limit leakage-drift unsupported-sag seal-stiction \
                 accumulator-gas lock-damping arm-gain",
            ),
            (
                Block::Steering,
                "steer-delay steer-lag steer-backlash steer-rate steer-gain rear-follower-lag",
            ),
            (
                Block::Drive,
                "throttle-delay drive-lag rolling-resistance standstill-drag slippery-ground engine-droop",
            ),
            (Block::Tyre, "soft-tyres"),
            (Block::Payload, "payload com-shift"),
            (Block::Ground, "terrain-slope"),
            (
                Block::Sensor,
                "stroke-bias stroke-scale pressure-bias pressure-scale imu-offset wheel-speed-scale \
                 gnss-latency gnss-lever-arm",
            ),
            (Block::Bus, "frame-loss command-jitter"),
        ];
        for (block, names) in shared {
            for name in names.split(' ') {
                assert_eq!(find(name).map(|effect| effect.block), Some(block), "{name}");
            }
        }
    }

    #[test]
    fn every_parameter_has_a_place_of_its_own() {
        let mut effects = Effects::default();
        let mut value = 1.0;
        for p in CATALOGUE.iter().flat_map(|effect| effect.parameters) {
            for wheel in xt28_machine::Wheel::ALL {
                value += 1.0;
                p.set(&mut effects, Scope::Wheel(wheel), value);
            }
        }
        let mut value = 1.0;
        for p in CATALOGUE.iter().flat_map(|effect| effect.parameters) {
            let whole = matches!(p.slot, crate::effects::Slot::Whole(_));
            for wheel in xt28_machine::Wheel::ALL {
                value += 1.0;
                let last = wheel == xt28_machine::Wheel::Bl;
                assert!(
                    whole && !last || p.get(&effects, Scope::Wheel(wheel)) == value,
                    "{}",
                    p.name
                );
            }
        }
    }
}
