//! A tyre on the ground, near rigid or soft: a spring and damper that only push, and a patch that gives
//! before it slides.
//!
//! The carcass lets the tread be pushed aside from the rim by a vector d, the smallest that clears the
//! ground at every point touched; its force is k d + c d'. Along the ground the patch is a brush:
//! bristles deflect by z with z' = v - |u|/relaxation z, where v is the tread's slip and u its rolling,
//! and push with k z + c z' up to friction times load (Pacejka, Tire and Vehicle Dynamics, chapters 7
//! and 8: single contact point with relaxation; the brush's slip stiffness is k times relaxation). A tyre
//! that touches in several points has one brush, of which each has the share that it has of the load.
//!
//! Both are stepped implicitly, without asking the solver of the rigid bodies for anything: the velocity
//! at the end of the step is foreseen from the acceleration of the step before and from what the change
//! of the force itself does to the least mass that it moves. That keeps 5 ms stable for tyres from 0.2
//! to 30 MN/m.

use crate::parts::{Brush, TyrePart};

/// Most points at which one tyre touches.
pub const PATCHES_MAX: usize = 4;
/// Damping of the bristles as a share of critical with the mass they move (assumed).
const BRISTLE_DAMPING: f64 = 0.5;
/// Passes over the points touched; two points need one, four in a gully some more.
const PASSES: usize = 12;
/// Two patches of successive steps are one if their normals are this parallel.
const SAME_PATCH: f64 = 0.95;

/// The rigid wheel's dry friction, but for a give of a millimetre or two before it slides.
const NEAR_RIGID: Brush =
    Brush { longitudinal_n_m: 1.0e7, lateral_n_m: 1.0e7, relaxation_m: f64::INFINITY };

/// One tyre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tyre {
    stiffness_n_m: f64,
    damping_n_s_m: f64,
    friction: f64,
    creep_m_s_n: f64,
    brush: Brush,
    /// What it moves along the ground's normal and along the ground at the least, kg.
    moves_kg: [f64; 2],
}

/// What one point of contact remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PatchState {
    /// The ground's normal, out of the ground; by it the patch is known again.
    pub normal: [f64; 3],
    /// Load, N.
    pub load_n: f64,
    /// Share of the tyre's load that it is.
    pub share: f64,
    /// Force along the ground on the tread: forward and to the left, N.
    pub along_n: [f64; 2],
    /// Deflection of the bristles: forward and to the left, m.
    pub bristle_m: [f64; 2],
    /// How fast the patch got deeper, m/s.
    pub depth_rate_m_s: f64,
    /// How the tread slipped: forward and to the left, m/s.
    pub slip_m_s: [f64; 2],
}

impl PatchState {
    /// What there was before a point that is `input` now; one newly touched moved as it does.
    fn before(input: &PatchInput, patches: &[Self]) -> Self {
        let likeness = |state: &Self| dot(state.normal, input.normal);
        let nearest = patches.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
        let known = nearest.filter(|state| likeness(state) > SAME_PATCH && state.load_n > 0.0);
        known.copied().unwrap_or_else(|| Self {
            depth_rate_m_s: input.depth_rate_m_s,
            slip_m_s: input.slip_m_s,
            ..Self::default()
        })
    }
}

/// How one point of the tread meets the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PatchInput {
    /// The ground's normal there, out of the ground.
    pub normal: [f64; 3],
    /// How deep the undeformed tread would be in the ground, m.
    pub depth_m: f64,
    /// How fast that grows, m/s.
    pub depth_rate_m_s: f64,
    /// Slip of the tread on the ground: forward and to the left, m/s.
    pub slip_m_s: [f64; 2],
    /// Speed at which tread rolls through the patch, m/s.
    pub rolling_m_s: f64,
}

impl Tyre {
    /// The tyre of a wheel.
    ///
    /// `moves_kg`: the least mass that moves with the tread along the normal, and along the ground.
    #[must_use]
    pub const fn new(part: &TyrePart, moves_kg: [f64; 2]) -> Self {
        Self {
            stiffness_n_m: part.stiffness_n_m,
            damping_n_s_m: part.damping_n_s_m,
            friction: part.friction,
            creep_m_s_n: part.creep_m_s_n,
            brush: match part.brush {
                Some(brush) => brush,
                None => NEAR_RIGID,
            },
            moves_kg,
        }
    }

    /// The patches after `dt_s` s, in the order of `inputs`, at most [`PATCHES_MAX`]; those of the
    /// step `before` in any order.
    #[must_use]
    pub fn step(&self, before: &[PatchState], inputs: &[PatchInput], dt_s: f64) -> Patches {
        let mut known = [PatchState::default(); PATCHES_MAX];
        for (own, input) in known.iter_mut().zip(inputs) {
            *own = PatchState::before(input, before);
        }
        let before = &known[..inputs.len()];
        let mut after = Patches::default();
        let loads_n = self.loads_n(before, inputs, dt_s);
        let sum_n: f64 = loads_n.iter().sum();
        for ((state, input), load_n) in before.iter().zip(inputs).zip(loads_n) {
            after.push(self.drag(state, input, [load_n, load_n / sum_n], dt_s));
        }
        after
    }

    /// Loads of the patches: each tread point is pushed back until all are clear of the ground.
    fn loads_n(
        &self,
        before: &[PatchState],
        inputs: &[PatchInput],
        dt_s: f64,
    ) -> [f64; PATCHES_MAX] {
        let rate_n_s_m = self.damping_n_s_m + dt_s * self.stiffness_n_m;
        let follows = dt_s * rate_n_s_m / self.moves_kg[0];
        let mut wanted_n = [0.0; PATCHES_MAX];
        for ((wanted, state), input) in wanted_n.iter_mut().zip(before).zip(inputs) {
            let coming_m_s = 2.0 * input.depth_rate_m_s - state.depth_rate_m_s;
            let now_n = self.stiffness_n_m * input.depth_m + rate_n_s_m * coming_m_s;
            *wanted = (now_n + follows * state.load_n) / (1.0 + follows);
        }
        let mut loads_n = [0.0; PATCHES_MAX];
        for _ in 0..PASSES {
            for (i, own) in inputs.iter().enumerate() {
                let others: f64 = (inputs.iter().zip(loads_n).enumerate())
                    .filter(|&(j, _)| j != i)
                    .map(|(_, (other, load_n))| dot(own.normal, other.normal) * load_n)
                    .sum();
                loads_n[i] = (wanted_n[i] - others).max(0.0);
            }
        }
        loads_n
    }

    /// The patch under `load_n`, which is `share` of the tyre's, after `dt_s` s.
    fn drag(
        &self,
        state: &PatchState,
        input: &PatchInput,
        [load_n, share]: [f64; 2],
        dt_s: f64,
    ) -> PatchState {
        if load_n <= 0.0 {
            return PatchState { normal: input.normal, ..PatchState::default() };
        }
        let whole = [self.brush.longitudinal_n_m, self.brush.lateral_n_m];
        let stiffness = whole.map(|k| share * k);
        let limit_n = self.friction * load_n;
        let rolled = dt_s * input.rolling_m_s.abs() / self.brush.relaxation_m;
        // What the ground shears by a force is a share of the deflection that makes it.
        let renewal = whole.map(|k| 1.0 + rolled + dt_s * self.creep_m_s_n * k);
        // The step that has just been made carried the bristles along, as far as friction let it.
        let carried = |i: usize| (state.bristle_m[i] + dt_s * input.slip_m_s[i]) / renewal[i];
        let bristle_m = if state.load_n > 0.0 { [carried(0), carried(1)] } else { [0.0; 2] };
        let held_n = (stiffness[0] * bristle_m[0]).hypot(stiffness[1] * bristle_m[1]);
        let kept = if held_n > limit_n { limit_n / held_n } else { 1.0 };
        let bristle_m = bristle_m.map(|z| z * kept);
        let mut along_n: [f64; 2] = core::array::from_fn(|i| {
            // k z + c z' at the end of the coming step, with the slip that this very force leaves.
            let damping_n_s_m =
                share * 2.0 * BRISTLE_DAMPING * (whole[i] * self.moves_kg[1]).sqrt();
            let rate_n_m = damping_n_s_m / dt_s;
            let hold_n_m = (stiffness[i] + rate_n_m) / renewal[i];
            let coming_m_s = 2.0 * input.slip_m_s[i] - state.slip_m_s[i];
            let now_n = hold_n_m * (bristle_m[i] + dt_s * coming_m_s) - rate_n_m * bristle_m[i];
            let follows = hold_n_m * dt_s * dt_s / self.moves_kg[1];
            // Of what the whole brush held with a patch that may have been another share of it.
            let held_n =
                if state.share > 0.0 { state.along_n[i] * share / state.share } else { 0.0 };
            (follows * held_n - now_n) / (1.0 + follows)
        });
        let asked_n = along_n[0].hypot(along_n[1]);
        if asked_n > limit_n {
            along_n = along_n.map(|n| n * limit_n / asked_n);
        }
        PatchState {
            normal: input.normal,
            load_n,
            share,
            along_n,
            bristle_m,
            depth_rate_m_s: input.depth_rate_m_s,
            slip_m_s: input.slip_m_s,
        }
    }
}

/// The patches of one tyre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Patches {
    states: [PatchState; PATCHES_MAX],
    count: usize,
}

impl Patches {
    fn push(&mut self, state: PatchState) {
        self.states[self.count] = state;
        self.count += 1;
    }

    /// The patches, in the order of the inputs.
    #[must_use]
    pub fn states(&self) -> &[PatchState] {
        &self.states[..self.count]
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use xt28_machine::{GRAVITY_M_S2, Machine};

    use super::*;
    use crate::{Effects, Parts};

    const DT_S: f64 = 0.005;
    const UP: [f64; 3] = [0.0, 0.0, 1.0];

    fn tyre(stiffness_n_m: f64, damping_n_s_m: f64, brush: Brush) -> Tyre {
        let nominal = Parts::new(&Machine::xt28(), &Effects::default()).tyres.0[0];
        let part = TyrePart { stiffness_n_m, damping_n_s_m, brush: Some(brush), ..nominal };
        Tyre::new(&part, [600.0, 360.0])
    }

    fn brush() -> Brush {
        Brush { longitudinal_n_m: 6e5, lateral_n_m: 4e5, relaxation_m: 0.6 }
    }

    proptest! {
        /// A mass dropped on the tyre comes to rest at its weight over the stiffness, whatever the
        /// tyre, whatever the mass is taken for, at 5 ms.
        #[test]
        fn a_dropped_mass_settles_for_any_tyre(
            log_k in 5.2..7.5_f64, zeta in 0.1..1.5_f64, taken_for in 0.2..1.0_f64,
        ) {
            let (mass_kg, k) = (3000.0, 10.0_f64.powf(log_k));
            let c = 2.0 * zeta * (k * mass_kg).sqrt();
            let tyre = Tyre { moves_kg: [taken_for * mass_kg; 2], ..tyre(k, c.min(2e5), brush()) };
            let mut patch = PatchState::default();
            let (mut z, mut v) = (0.1, 0.0);
            for _ in 0..4000 {
                let input = PatchInput {
                    normal: UP, depth_m: -z, depth_rate_m_s: -v, ..PatchInput::default()
                };
                if input.depth_m > 0.0 {
                    patch = tyre.step(&[patch], &[input], DT_S).states()[0];
                } else {
                    patch = PatchState::default();
                }
                prop_assert!(patch.load_n >= 0.0);
                v += DT_S * (patch.load_n / mass_kg - GRAVITY_M_S2);
                z += DT_S * v;
                prop_assert!(z < 0.1 + 1e-9, "it jumps higher than it fell: {z}");
            }
            let sag_m = mass_kg * GRAVITY_M_S2 / k;
            prop_assert!((z + sag_m).abs() < 0.02 * sag_m + 1e-6, "{z} m, not {} m", -sag_m);
        }
    }

    #[test]
    fn one_ground_felt_twice_carries_once() {
        let tyre = tyre(4e5, 1e4, brush());
        let at = |tilt: f64| PatchInput {
            normal: [tilt.sin(), 0.0, tilt.cos()],
            depth_m: 0.05,
            ..PatchInput::default()
        };
        let carried = |inputs: &[PatchInput]| {
            let before = vec![PatchState::default(); inputs.len()];
            let after = tyre.step(&before, inputs, 1e-9);
            let up = after.states().iter().zip(inputs).map(|(s, i)| s.load_n * i.normal[2]);
            up.sum::<f64>()
        };
        let once_n = carried(&[at(0.0)]);
        assert!((once_n - 2e4).abs() < 1.0, "{once_n}");
        for tilt in [0.0, 0.01, 0.1] {
            let twice_n = carried(&[at(0.0), at(tilt)]);
            assert!((twice_n / once_n - 1.0).abs() < 0.01, "{tilt}: {twice_n}");
        }
    }

    /// Where the ground under a tyre that is pushed aside breaks into two planes, its bristles hold on.
    #[test]
    fn a_patch_that_splits_in_two_holds_as_one() {
        let tyre = tyre(8e6, 6e4, brush());
        let held = PatchState {
            normal: UP,
            load_n: 4e4,
            share: 1.0,
            along_n: [0.0, -4e3],
            bristle_m: [0.0, 0.01],
            ..PatchState::default()
        };
        let at = |tilt: f64| PatchInput {
            normal: [tilt.sin(), 0.0, tilt.cos()],
            depth_m: 0.005,
            ..PatchInput::default()
        };
        let aside_n = |inputs: &[PatchInput]| -> f64 {
            tyre.step(&[held], inputs, DT_S).states().iter().map(|s| s.along_n[1]).sum()
        };
        let once_n = aside_n(&[at(0.0)]);
        assert!(once_n < -3.9e3, "{once_n} N");
        for tilt in [0.04, 0.1, 0.2] {
            let twice_n = aside_n(&[at(-tilt), at(tilt)]);
            assert!((twice_n / once_n - 1.0).abs() < 0.05, "{tilt}: {twice_n}, not {once_n} N");
        }
    }

    /// Rolling at a steady slip angle, the side force is k relaxation slip until friction is used up,
    /// and grows to 63 % within one relaxation length.
    #[test]
    fn side_force_grows_over_the_relaxation_length_up_to_friction() {
        let tyre = tyre(4e5, 1e4, brush());
        let roll = |angle: f64, way_m: f64| {
            let input = PatchInput {
                normal: UP,
                depth_m: 0.1,
                slip_m_s: [0.0, angle],
                rolling_m_s: 1.0,
                ..PatchInput::default()
            };
            let mut patch = PatchState { normal: UP, load_n: 4e4, ..PatchState::default() };
            for _ in 0..(way_m / DT_S) as u32 {
                patch = tyre.step(&[patch], &[input], DT_S).states()[0];
            }
            -patch.along_n[1]
        };
        let steady_n = 4e5 * 0.6 * 0.05;
        assert!((roll(0.05, 6.0) / steady_n - 1.0).abs() < 0.01, "{}", roll(0.05, 6.0));
        assert!((roll(0.05, 0.6) / steady_n - 0.632).abs() < 0.03);
        assert!((roll(0.5, 6.0) / (0.7 * 4e4) - 1.0).abs() < 1e-6);
    }

    /// Pushed along with less than friction holds, a standing patch gives and stays there: no creep.
    #[test]
    fn a_standing_patch_holds_without_creeping() {
        let stiff = Brush { longitudinal_n_m: 4e6, lateral_n_m: 4e6, relaxation_m: f64::INFINITY };
        for brush in [brush(), stiff] {
            let tyre = tyre(8e6, 6e4, brush);
            let (mass_kg, push_n) = (800.0, 1e4);
            let mut patch = PatchState { normal: UP, load_n: 4e4, ..PatchState::default() };
            let (mut x, mut v) = (0.0, 0.0);
            for _ in 0..2000 {
                let input = PatchInput {
                    normal: UP,
                    depth_m: 0.005,
                    slip_m_s: [v, 0.0],
                    ..PatchInput::default()
                };
                patch = tyre.step(&[patch], &[input], DT_S).states()[0];
                v += DT_S * (push_n + patch.along_n[0]) / mass_kg;
                x += DT_S * v;
            }
            let give_m = push_n / brush.longitudinal_n_m;
            assert!((x / give_m - 1.0).abs() < 0.1 && v.abs() < 1e-6, "{x} m, {v} m/s");
        }
    }
}
