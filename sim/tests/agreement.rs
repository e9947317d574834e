//! On ground and commands of chance the fast core goes where the reference goes, and stands and turns as it does.

mod agreement_rig;

use agreement_rig::{Chance, KINDS};

/// How far the reference and MuJoCo come apart in ten seconds: what `docs/second-engine.md` has for *rough*; of
/// strokes and wheel speeds, which edges of the ground tell most of, for *ramp*.
const REFERENCE_TO_MUJOCO: [f64; 6] = [0.033, 0.60, 0.15, 0.40, 7.4, 0.36];

#[test]
fn it_is_no_further_from_the_reference_than_another_engine_is() {
    for seed in 0..16 {
        let apart = Chance::drawn(seed).apart();
        for ((kind, apart), bound) in KINDS.iter().zip(apart).zip(REFERENCE_TO_MUJOCO) {
            assert!(apart < bound, "seed {seed}, {kind}: {apart}, {bound} allowed");
        }
    }
}
