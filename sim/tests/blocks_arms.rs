//! The arms' blocks alone, driven by the whole vehicle's own signals.

mod arm_rig;
mod overheard;

use arm_rig::{ArmRig, DT_S};
use overheard::Overheard;
use proptest::prelude::*;
use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Wheel};
use xt28_sim::effects::{Block, CATALOGUE, Effect, Scope};
use xt28_sim::{
    Actuation, Arm, ArmInput, ArmState, Bodies, CylinderForce, CylinderMotion, Effects,
    FlowSharing, HingeMotion, HingeSpring, Plant, RapierBodies, ReducedBodies, STEP, Steering,
    SteeringState, Terrain, Vehicle, VehicleState,
};

const STROKE_M: f64 = 0.17;

/// Every effect of arms and steering a fifth of the way to the end of its range, wheel by wheel a
/// little different, and a pump that runs short.
fn all_at_once() -> Effects {
    let mut effects = Effects::default();
    let ours = |block| matches!(block, Block::Arms | Block::Steering);
    for p in CATALOGUE.iter().filter(|e| ours(e.block)).flat_map(|effect| effect.parameters) {
        for wheel in Wheel::ALL {
            let share = 0.15 + 0.02 * wheel.index() as f64;
            let value = p.neutral + share * (p.range[1] - p.neutral);
            p.set(&mut effects, Scope::Wheel(wheel), value);
        }
    }
    effects.pump_flow.flow_m3_s = 0.002;
    effects
}

fn driven(t: f64) -> Actuation {
    Actuation {
        arm_opening: PerWheel::from_fn(|w| 0.5 * (t * (1.0 + w.index() as f64 * 0.1)).sin()),
        steer_opening: [(t * 0.7).sin(), 0.5 * (t * 0.7).sin()],
        pump_displacement: [(t / 4.0).min(1.0); 2],
        ..Actuation::idle(1200.0)
    }
}

/// All six arms and both steering valves on their pump, without a vehicle.
struct Hydraulics {
    arms: PerWheel<Arm>,
    states: PerWheel<ArmState>,
    steering: [Steering; 2],
    joints: [SteeringState; 2],
    flow: FlowSharing,
    least_share: f64,
}

impl Hydraulics {
    fn new(machine: &Machine, effects: &Effects, dt_s: f64) -> Self {
        let arms = PerWheel::from_fn(|w| Arm::new(machine, &effects.arms[w]));
        let load_n = machine.mass_kg() * GRAVITY_M_S2
            / 6.0
            / machine.linkage().at_stroke(STROKE_M).force_ratio;
        let steering = Steering::both(machine, &effects.steering);
        Self {
            states: PerWheel::from_fn(|w| arms[w].settled(STROKE_M, load_n, dt_s)),
            arms,
            joints: steering.each_ref().map(|joint| joint.straight(dt_s)),
            steering,
            flow: FlowSharing::new(machine, effects.pump_flow),
            least_share: 1.0,
        }
    }

    /// Steps on what the vehicle was commanded and on what it measured before the step.
    fn step(
        &mut self,
        actuation: &Actuation,
        before: &VehicleState,
        dt_s: f64,
    ) -> PerWheel<CylinderForce> {
        let inputs = PerWheel::from_fn(|w| ArmInput {
            command: actuation.arm_opening[w],
            load_n: before.cylinder_force_n[w],
            motion: motion(before, w),
        });
        let speeds =
            PerWheel::from_fn(|w| self.arms[w].open(&mut self.states[w], &inputs[w], dt_s));
        let mut demand_m3_s = speeds.map(|v| self.flow.cylinder_m3_s(v)).sum();
        for (i, joint) in self.joints.iter_mut().enumerate() {
            let opening = actuation.steer_opening[i];
            demand_m3_s += self.flow.joint_m3_s(self.steering[i].open(joint, opening, dt_s));
        }
        let share = self.flow.share(demand_m3_s);
        self.least_share = self.least_share.min(share);
        PerWheel::from_fn(|w| {
            self.arms[w].fill(&mut self.states[w], &inputs[w], share * speeds[w], dt_s)
        })
    }
}

fn motion(state: &VehicleState, wheel: Wheel) -> CylinderMotion {
    CylinderMotion {
        stroke_m: state.stroke_m[wheel],
        stroke_rate_m_s: state.stroke_rate_m_s[wheel],
    }
}

/// All arms into their lower stops and through to their upper ones, each a little slower than the one before; then to
/// and fro, while the machine steers and drives.
fn to_the_stops(t: f64) -> Actuation {
    let sweep = |w: Wheel| {
        let share = 1.0 - 0.05 * w.index() as f64;
        if t < 10.0 {
            -share
        } else if t < 30.0 {
            share
        } else {
            0.5 * (t * (1.0 + w.index() as f64 * 0.1)).sin()
        }
    };
    Actuation { arm_opening: PerWheel::from_fn(sweep), ..driven(t) }
}

/// What a hinge's spring makes of this motion, Nm.
fn torque_nm(spring: &HingeSpring, at: HingeMotion) -> f64 {
    spring.stiffness_nm * (spring.rest_rad - at.angle_rad) - spring.damping_nms * at.rate_rad_s
}

/// Driven by measured stroke, rate and load, the arms alone say the vehicle's forces and pressures, and what it loaded
/// its arms' hinges with: oil, seals and end stops, with their slopes. Tolerance: 1e-6 N and 1e-3 Pa over 36 s, and
/// 1e-9 of the torques and slopes; nothing is hidden between them, so what is left is rounding.
#[test]
fn arms_alone_reproduce_the_whole_with_every_effect_at_once() {
    for effects in [Effects::default(), all_at_once()] {
        arms_reproduced::<RapierBodies>(&effects);
        arms_reproduced::<ReducedBodies>(&effects);
    }
}

fn arms_reproduced<B: Bodies>(effects: &Effects) {
    let (machine, dt_s) = (Machine::xt28(), STEP.as_secs_f64());
    let (strokes, linkage) = (PerWheel::splat(STROKE_M), machine.linkage());
    let mut vehicle: Vehicle<Overheard<B>> =
        Vehicle::with(&machine, effects, &Terrain::Flat, strokes, STEP);
    let mut alone = Hydraulics::new(&machine, effects, dt_s);
    let mut stopped = PerWheel::splat([false; 2]);
    for step in 0..7200 {
        let actuation = to_the_stops(f64::from(step) * dt_s);
        let (before, at) = (*vehicle.state(), vehicle.bodies().motion().arm);
        vehicle.step(&actuation);
        let forces = alone.step(&actuation, &before, dt_s);
        let (after, loads) = (vehicle.state(), &vehicle.bodies().loads);
        for w in Wheel::ALL {
            let force_n = alone.arms[w].oil_force_n(&alone.states[w], &motion(after, w));
            let [a, b] = alone.arms[w].pressures_pa(force_n);
            let wanted = after.cylinder_force_n[w];
            assert!((force_n - wanted).abs() < 1e-6, "{w} {step}: {force_n} N, not {wanted} N");
            assert!((a - after.pressure_a_pa[w]).abs() < 1e-3, "{w} {step}");
            assert!((b - after.pressure_b_pa[w]).abs() < 1e-3, "{w} {step}");
            let lever_m = linkage.lever_m(linkage.at_stroke(before.stroke_m[w]).angle_rad);
            let (ours, theirs) = (&forces[w], &loads.arm[w]);
            for (ours, theirs) in [
                (ours.force_n * lever_m, torque_nm(theirs, at[w])),
                (ours.stiffness_n_m * lever_m * lever_m, theirs.stiffness_nm),
                (ours.damping_n_s_m * lever_m * lever_m, theirs.damping_nms),
            ] {
                let off = (ours - theirs).abs();
                assert!(off <= 1e-9 * theirs.abs().max(1e4), "{w} {step}: {ours}, not {theirs}");
            }
            let [lower, upper] = &mut stopped[w];
            *lower |= before.stroke_m[w] < 0.0;
            *upper |= before.stroke_m[w] > machine.arms.stroke_max_m;
        }
    }
    let both = |wheel: Wheel| stopped[wheel] == [true, true];
    assert!(Wheel::ALL.into_iter().all(both), "stops met: {stopped:?}");
    let short = *effects != Effects::default();
    assert_eq!(alone.least_share < 0.9, short, "pump at {}", alone.least_share);
}

fn arm_effects() -> impl Iterator<Item = &'static Effect> {
    CATALOGUE.iter().filter(|effect| effect.block == Block::Arms)
}

/// A third of the way into an effect's range; the pump just short for one arm.
fn strong(effect: &Effect) -> Effects {
    let mut effects = Effects::default();
    for p in effect.parameters {
        p.set(&mut effects, Scope::All, p.neutral + (p.range[1] - p.neutral) / 3.0);
    }
    if effect.name == "pump-flow-limit" {
        effects.pump_flow.flow_m3_s = 0.000_4;
    }
    effects
}

/// An arm's effect acts on the arms it is set for and leaves the blocks of the others alone.
#[test]
fn an_effect_stays_on_its_arm() {
    let machine = Machine::xt28();
    let dt_s = STEP.as_secs_f64();
    let run = |effects: &Effects| {
        let mut alone = Hydraulics::new(&machine, effects, dt_s);
        let mut seen = VehicleState::default();
        let mut forces = PerWheel::splat(0.0);
        for step in 0..400 {
            let t = f64::from(step) * dt_s;
            seen.stroke_m = PerWheel::splat(STROKE_M + 0.05 * t.sin());
            seen.stroke_rate_m_s = PerWheel::splat(0.05 * t.cos());
            seen.cylinder_force_n = PerWheel::splat(6e4);
            // The middle left wheel hangs.
            seen.cylinder_force_n[Wheel::Ml] = -12e3;
            for (w, force) in alone.step(&driven(t), &seen, dt_s).iter() {
                forces[w] += force.force_n;
            }
        }
        forces
    };
    let nominal = run(&Effects::default());
    for effect in arm_effects().filter(|effect| effect.has_scope() && effect.name != "arm-gain") {
        let strong = strong(effect);
        let mut effects = Effects::default();
        effects.arms[Wheel::Ml] = strong.arms[Wheel::Ml];
        let with = run(&effects);
        for w in Wheel::ALL {
            assert_eq!(with[w] == nominal[w], w != Wheel::Ml, "{} on {w}", effect.name);
        }
    }
}

/// Finite differences of five seconds on the rig: stroke and oil force change in proportion to a
/// nudge of a millionth, for every parameter, alone and on top of all the others.
#[test]
fn outputs_are_smooth_in_every_parameter() {
    let run = |effects: &Effects| -> Vec<[f64; 2]> {
        let mut rig = ArmRig::new(effects, 6e3, STROKE_M, 5e4);
        let steps = (0..1000).map(|step| {
            let t = f64::from(step) * DT_S;
            // A load that lifts off now and then.
            rig.step(0.3 * (1.1 * t).sin(), 4e4 + 5e4 * (2.3 * t).sin());
            [rig.motion.stroke_m, rig.oil_force_n()]
        });
        steps.collect()
    };
    let apart = |a: &[[f64; 2]], b: &[[f64; 2]], i: usize| {
        a.iter().zip(b).map(|(a, b)| (a[i] - b[i]).abs()).fold(0.0, f64::max)
    };
    for (effect, p) in arm_effects().flat_map(|e| e.parameters.iter().map(move |p| (e, p))) {
        for base in [strong(effect), all_at_once()] {
            let nudged = |share: f64| {
                let mut effects = base.clone();
                p.set(&mut effects, Scope::All, p.get(&base, Scope::All) * (1.0 + share));
                run(&effects)
            };
            let (here, once, twice) = (run(&base), nudged(1e-6), nudged(2e-6));
            for (i, bound) in [(0, 1e-6), (1, 0.5)] {
                let (one, two) = (apart(&here, &once, i), apart(&here, &twice, i));
                let what = format!("{} {} [{i}]: {one:e}, {two:e}", effect.name, p.name);
                assert!(one < bound, "{what}");
                assert!(one < bound * 1e-3 || (two / one - 2.0).abs() < 0.01, "{what}");
            }
        }
    }
}

/// Taken up from one measured instant, with hidden states warmed as far as a measurement tells, the
/// arms of a machine in motion make the measured force at once and keep to it for two seconds on the
/// machine's own signals. Tolerance: 1 N, since the command had stood for longer than delay and lag.
#[test]
fn arms_taken_up_from_a_measurement_go_on_like_the_whole() {
    let machine = Machine::xt28();
    let dt_s = STEP.as_secs_f64();
    let mut effects = Effects::default();
    effects.arms = effects.arms.map(|mut arm| {
        (arm.delay.delay_s, arm.lag.time_constant_s, arm.gas.share) = (0.1, 0.05, 1.0);
        arm
    });
    let strokes = PerWheel::splat(STROKE_M);
    let mut vehicle: Vehicle<RapierBodies> =
        Vehicle::with(&machine, &effects, &Terrain::Flat, strokes, STEP);
    let held = Actuation { arm_opening: PerWheel::splat(0.1), ..driven(0.0) };
    (0..200).for_each(|_| vehicle.step(&held));
    let mut alone = Hydraulics::new(&machine, &effects, dt_s);
    let seen = *vehicle.state();
    alone.states = PerWheel::from_fn(|w| {
        let (load_n, motion) = (seen.cylinder_force_n[w], motion(&seen, w));
        let state = alone.arms[w].resumed(&ArmInput { command: 0.1, load_n, motion }, dt_s);
        assert!((alone.arms[w].oil_force_n(&state, &motion) - load_n).abs() < 1e-3);
        state
    });
    for _ in 0..400 {
        let before = *vehicle.state();
        vehicle.step(&held);
        alone.step(&held, &before, dt_s);
        for w in Wheel::ALL {
            let after = vehicle.state();
            let force_n = alone.arms[w].oil_force_n(&alone.states[w], &motion(after, w));
            assert!((force_n - after.cylinder_force_n[w]).abs() < 1.0, "{w}: {force_n}");
        }
    }
}

proptest! {
    /// Whatever is true of an arm and whatever happens to it: numbers stay finite, the relief valve
    /// bounds the oil's spring, and neither spring nor damper ever pushes the wrong way.
    #[test]
    fn an_arm_survives_anything_within_its_ranges(
        shares in proptest::collection::vec(0.0..=1.0_f64, 32),
        steps in proptest::collection::vec(
            (-2.0..2.0_f64, -3e5..3e5_f64, -0.5..1.0_f64, -5.0..5.0_f64), 1..50),
    ) {
        let mut effects = Effects::default();
        for (p, share) in arm_effects().flat_map(|e| e.parameters).zip(&shares) {
            p.set(&mut effects, Scope::All, p.range[0] + share * (p.range[1] - p.range[0]));
        }
        let machine = Machine::xt28();
        let arm = Arm::new(&machine, &effects.arms[Wheel::Fr]);
        let mut state = arm.settled(STROKE_M, 5e4, DT_S);
        for (command, load_n, stroke_m, stroke_rate_m_s) in steps {
            let motion = CylinderMotion { stroke_m, stroke_rate_m_s };
            let force = arm.step(&mut state, &ArmInput { command, load_n, motion }, 1.0, DT_S);
            prop_assert!(force.force_n.is_finite() && force.stiffness_n_m > 0.0);
            prop_assert!(force.damping_n_s_m > 0.0);
            let still = CylinderMotion { stroke_m, stroke_rate_m_s: 0.0 };
            let spring_n = arm.oil_force_n(&state, &still);
            prop_assert!(spring_n.abs() <= machine.arms.force_max_n * (1.0 + 1e-9), "{spring_n}");
        }
    }
}
