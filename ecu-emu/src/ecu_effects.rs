//! ECUs whose parameters are not those of the machine file.

use xt28_ecus::{ArmEcu, DriveEcu, PositionGains, SteeringGains};
use xt28_machine::{Machine, PerWheel};
use xt28_sim::Effects;

/// The pendulum-arm ECU with the gains that `effects` give it.
pub(crate) fn arm_ecu(machine: &Machine, effects: &Effects) -> ArmEcu {
    let mut ecu = ArmEcu::new(machine);
    let nominal = PositionGains::new(&machine.hydraulics);
    ecu.set_position_gains(PerWheel::from_fn(|wheel| {
        let gain = effects.arms[wheel].gain;
        PositionGains {
            kp_per_mm: nominal.kp_per_mm * gain.kp_factor,
            ki_per_mm_s: nominal.ki_per_mm_s * gain.ki_factor,
            ..nominal
        }
    }));
    ecu
}

/// The transmission ECU with the gains and the follower that `effects` give it.
pub(crate) fn drive_ecu(machine: &Machine, effects: &Effects) -> DriveEcu {
    let mut ecu = DriveEcu::new(machine);
    let nominal = SteeringGains::new(&machine.articulation);
    let (gain, follower) = (effects.steering.gain, effects.steering.rear_follower);
    ecu.set_steering_gains(SteeringGains {
        kp_per_deg: nominal.kp_per_deg * gain.kp_factor,
        ki_per_s: nominal.ki_per_s * gain.ki_factor,
        rear_ratio: nominal.rear_ratio * follower.ratio_factor,
        rear_time_constant_s: follower.time_constant_s,
        ..nominal
    });
    ecu
}
