//! The two articulation joints: a valve turns the rest angle, the closed oil holds it.
//!
//! The same soft lock as a cylinder's: torque = k (rest - angle) - c d(angle)/dt, with the rest no
//! further from the joint than the largest torque twists it. The damper acts on the joint's own
//! rate, so against the scrub of the tyres the torque also bounds how fast the joint turns.
//! Beyond the largest angle the frames meet metal: what the relief valve lets go, that holds.

use xt28_machine::Machine;

use crate::bodies::{HingeMotion, HingeSpring};
use crate::effects::{DelayLine, Lag, SteeringEffects};
use crate::end_stop::EndStop;

/// The metal between two frames, Nm/rad, Nm s/rad and rad (assumed): the whole machine pushing at half
/// its weight on a lever of 2 m twists it by half a degree.
const STOP: EndStop = EndStop { stiffness: 2.0e7, damping: 5.0e5, damped_at: 2e-3 };

/// Parameters of one articulation joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Steering {
    rate_max_rad_s: f64,
    angle_max_rad: f64,
    torque_max_nm: f64,
    stiffness_nm: f64,
    damping_nms: f64,
    /// Of the valve's spool, s.
    lag_s: f64,
    effects: SteeringEffects,
}

/// What a joint remembers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SteeringState {
    commands: DelayLine,
    spool: Lag,
    oil_rad: f64,
    /// Angle at which the oil makes no torque, rad; left > 0.
    pub rest_rad: f64,
}

/// What acts on a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteeringInput {
    /// Valve opening asked for, -1 (right) to 1 (left).
    pub opening: f64,
    /// Joint angle, rad; left > 0.
    pub angle_rad: f64,
    /// Joint rate, rad/s.
    pub rate_rad_s: f64,
}

impl Steering {
    /// The front and the rear joint of this machine: alike, but for a rear valve that may be slower.
    #[must_use]
    pub const fn both(machine: &Machine, effects: &SteeringEffects) -> [Self; 2] {
        let lag_s = effects.lag.time_constant_s;
        let rear_lag_s = lag_s + effects.rear_follower.valve_time_constant_s;
        [Self::with_lag(machine, effects, lag_s), Self::with_lag(machine, effects, rear_lag_s)]
    }

    const fn with_lag(machine: &Machine, effects: &SteeringEffects, lag_s: f64) -> Self {
        let (a, v) = (&machine.articulation, &machine.vehicle);
        Self {
            rate_max_rad_s: a.rate_max_deg_s.to_radians(),
            angle_max_rad: a.angle_max_deg.to_radians(),
            torque_max_nm: a.torque_max_nm,
            stiffness_nm: v.joint_stiffness_nm,
            damping_nms: v.joint_damping_nms,
            lag_s,
            effects: *effects,
        }
    }

    /// A straight joint with its valve closed, to be stepped every `dt_s` s.
    #[must_use]
    pub fn straight(&self, dt_s: f64) -> SteeringState {
        let commands = DelayLine::new(self.effects.delay.delay_s, dt_s, 0.0);
        SteeringState { commands, ..SteeringState::default() }
    }

    /// A joint taken up in the middle of what was measured: its valve has stood at `opening` for long,
    /// its oil leads as far as the damping of this motion asks. What the tyres scrub is not known.
    #[must_use]
    pub fn resumed(&self, opening: f64, joint: HingeMotion, dt_s: f64) -> SteeringState {
        let opening = opening.clamp(-1.0, 1.0);
        let leads_rad = joint.rate_rad_s * self.damping_nms / self.stiffness_nm;
        SteeringState {
            commands: DelayLine::new(self.effects.delay.delay_s, dt_s, opening),
            spool: Lag::new(opening),
            oil_rad: joint.angle_rad + leads_rad,
            rest_rad: joint.angle_rad + leads_rad,
        }
    }

    /// Lets the rest lead this motion by its damping, the oil be no further from it than the play
    /// allows; the valve stays as it is.
    pub(crate) fn refill(&self, state: &mut SteeringState, joint: HingeMotion) {
        let half_rad = 0.5 * self.effects.backlash.width_rad;
        state.rest_rad = joint.angle_rad + joint.rate_rad_s * self.damping_nms / self.stiffness_nm;
        state.oil_rad = state.oil_rad.clamp(state.rest_rad - half_rad, state.rest_rad + half_rad);
    }

    /// First half of a step: moves the spool; gives the rate that it asks of the joint, rad/s.
    pub fn open(&self, state: &mut SteeringState, opening: f64, dt_s: f64) -> f64 {
        let e = &self.effects;
        let asked = opening.clamp(-1.0, 1.0);
        let arrived = state.commands.step(asked, e.delay.delay_s, dt_s);
        let spool = state.spool.step(arrived, self.lag_s, dt_s);
        spool * self.rate_max_rad_s * e.rate.factor
    }

    /// Second half: turns the rest angle at `rate_rad_s` over `dt_s` s. The relief valve lets the
    /// rest go no further from the joint than the largest torque twists it.
    pub fn turn(&self, state: &mut SteeringState, joint: HingeMotion, rate_rad_s: f64, dt_s: f64) {
        let play = &self.effects.backlash;
        let half_rad = 0.5 * play.width_rad;
        let reach = self.torque_max_nm / self.stiffness_nm;
        // Where the joint will be: a limit around where it was would give way to its own motion.
        let angle = joint.angle_rad + joint.rate_rad_s * dt_s;
        let led_rad =
            (state.oil_rad + rate_rad_s * dt_s).clamp(-self.angle_max_rad, self.angle_max_rad);
        // The rest makes the torque, so the valve bounds the rest: a bound on the oil would let the play
        // that lies between them add to the torque, where the joint leaves the oil behind.
        state.rest_rad = play.held_rad(state.rest_rad, led_rad).clamp(angle - reach, angle + reach);
        state.oil_rad = led_rad.clamp(state.rest_rad - half_rad, state.rest_rad + half_rad);
    }

    /// A whole step of a joint alone, which gets all the oil that it asks for.
    pub fn step(&self, state: &mut SteeringState, input: &SteeringInput, dt_s: f64) {
        let rate_rad_s = self.open(state, input.opening, dt_s);
        let joint = HingeMotion { angle_rad: input.angle_rad, rate_rad_s: input.rate_rad_s };
        self.turn(state, joint, rate_rad_s, dt_s);
    }

    /// What acts about the joint in this motion: the oil, and beyond the largest angle the metal.
    #[must_use]
    pub fn spring(&self, state: &SteeringState, joint: HingeMotion) -> HingeSpring {
        let oil = HingeSpring {
            stiffness_nm: self.stiffness_nm,
            damping_nms: self.damping_nms,
            rest_rad: state.rest_rad,
        };
        oil.stopped(joint, self.angle_max_rad, &STOP)
    }

    /// Stiffness of the held joint, Nm/rad.
    #[must_use]
    pub const fn stiffness_nm(&self) -> f64 {
        self.stiffness_nm
    }

    /// Damping of the held joint, Nm s/rad.
    #[must_use]
    pub const fn damping_nms(&self) -> f64 {
        self.damping_nms
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{SteerBacklash, SteerDelay, SteerLag, SteerRate};

    const DT_S: f64 = 0.005;

    fn steering(effects: SteeringEffects) -> Steering {
        let [front, _] = Steering::both(&Machine::xt28(), &effects);
        front
    }

    /// Rest angle after each step of a joint that follows its rest.
    fn follow(effects: SteeringEffects, openings: impl IntoIterator<Item = f64>) -> Vec<f64> {
        let steering = steering(effects);
        let mut state = steering.straight(DT_S);
        let step = |opening| {
            let angle_rad = state.rest_rad;
            let input = SteeringInput { opening, angle_rad, rate_rad_s: 0.0 };
            steering.step(&mut state, &input, DT_S);
            state.rest_rad
        };
        openings.into_iter().map(step).collect()
    }

    #[test]
    fn a_full_valve_turns_ten_degrees_a_second_up_to_the_stop() {
        let rest = follow(SteeringEffects::default(), [1.0; 1200]);
        assert!((rest[199].to_degrees() - 10.0).abs() < 1e-9);
        assert!((rest[1199].to_degrees() - 25.0).abs() < 1e-9);
    }

    #[test]
    fn a_blocked_joint_takes_no_more_than_its_torque() {
        let machine = Machine::xt28();
        let steering = steering(SteeringEffects::default());
        let mut state = steering.straight(DT_S);
        let input = SteeringInput { opening: 1.0, angle_rad: 0.0, rate_rad_s: 0.0 };
        (0..1000).for_each(|_| steering.step(&mut state, &input, DT_S));
        let torque_nm = state.rest_rad * steering.stiffness_nm();
        assert!((torque_nm - machine.articulation.torque_max_nm).abs() < 1e-6);
    }

    /// Whether the valve pushes or the ground does, and whichever side of the play the oil is on.
    #[test]
    fn a_joint_with_play_takes_no_more_than_its_torque_either_way() {
        let max_nm = Machine::xt28().articulation.torque_max_nm;
        for (width_rad, side) in [(0.01, 1.0), (0.01, -1.0), (0.2, 1.0), (0.2, -1.0)] {
            let backlash = SteerBacklash { width_rad };
            let steering = steering(SteeringEffects { backlash, ..Default::default() });
            let mut state = steering.straight(DT_S);
            let mut torque_nm = |opening: f64, angle_rad: f64| {
                let input = SteeringInput { opening, angle_rad, rate_rad_s: 0.0 };
                steering.step(&mut state, &input, DT_S);
                let nm = steering.stiffness_nm() * (state.rest_rad - angle_rad);
                assert!(nm.abs() < max_nm + 1e-6, "play of {width_rad} rad: {nm} Nm");
                nm
            };
            // Blocked, the valve pushes one way, then the other.
            for opening in [side, -side] {
                let last_nm = (0..1000).map(|_| torque_nm(opening, 0.0)).last().unwrap();
                assert!((last_nm - opening * max_nm).abs() < 1e-6, "{last_nm} Nm");
            }
            // With the valve shut, the ground turns it against what holds it, then back again.
            let there = (0..1000).map(|i| side * 1e-3 * f64::from(i));
            let last_nm = there.clone().map(|rad| torque_nm(0.0, rad)).last().unwrap();
            assert!((last_nm + side * max_nm).abs() < 1e-6, "{last_nm} Nm");
            let last_nm = there.rev().map(|rad| torque_nm(0.0, rad)).last().unwrap();
            assert!((last_nm - side * max_nm).abs() < 1e-6, "{last_nm} Nm");
        }
    }

    #[test]
    fn beyond_the_largest_angle_the_metal_pushes_back_and_within_it_the_oil_is_alone() {
        let steering = steering(SteeringEffects::default());
        let mut state = steering.straight(DT_S);
        state.rest_rad = 0.4;
        let max_rad = 25.0_f64.to_radians();
        let torque_nm = |angle_rad: f64, rate_rad_s: f64| {
            let spring = steering.spring(&state, HingeMotion { angle_rad, rate_rad_s });
            spring.stiffness_nm * (spring.rest_rad - angle_rad) - spring.damping_nms * rate_rad_s
        };
        for side in [-1.0, 1.0] {
            let within = HingeMotion { angle_rad: side * max_rad, rate_rad_s: side };
            let spring = steering.spring(&state, within);
            assert_eq!(
                (spring.stiffness_nm, spring.damping_nms, spring.rest_rad),
                (steering.stiffness_nm(), steering.damping_nms(), 0.4)
            );
            for rate_rad_s in [-1.0, 0.0, 0.3] {
                for past_rad in [1e-4, 0.01, 0.05] {
                    let (angle, rate) = (side * (max_rad + past_rad), side * rate_rad_s);
                    let oil_nm =
                        steering.stiffness_nm() * (0.4 - angle) - steering.damping_nms() * rate;
                    let metal_nm = -side * (torque_nm(angle, rate) - oil_nm);
                    assert!(metal_nm > -1e-6, "{past_rad} rad, {rate_rad_s} rad/s: {metal_nm} Nm");
                    if rate_rad_s >= 0.0 {
                        assert!(metal_nm > 1.9e7 * past_rad, "{past_rad} rad: {metal_nm} Nm");
                    }
                }
            }
        }
    }

    #[test]
    fn a_delay_shifts_the_whole_response() {
        let delay = SteerDelay { delay_s: 0.2 };
        let openings = || (0..400).map(|i| (f64::from(i) * 0.03).sin());
        let prompt = follow(SteeringEffects::default(), openings());
        let late = follow(SteeringEffects { delay, ..Default::default() }, openings());
        assert!(late[..40].iter().all(|rest| *rest == 0.0));
        for (a, b) in prompt.iter().zip(&late[40..]) {
            assert!((a - b).abs() < 1e-12);
        }
    }

    #[test]
    fn a_lag_costs_its_time_constant_on_a_steady_turn() {
        let lag = SteerLag { time_constant_s: 0.15 };
        let late = follow(SteeringEffects { lag, ..Default::default() }, [0.5; 400]);
        // The integral of a first-order rise lags a ramp by one time constant.
        let wanted_deg = 10.0 * 0.5 * (2.0 - 0.15);
        assert!((late[399].to_degrees() - wanted_deg).abs() < 0.02, "{}", late[399].to_degrees());
    }

    #[test]
    fn a_rate_factor_scales_the_turn() {
        let rate = SteerRate { factor: 0.7 };
        let slow = follow(SteeringEffects { rate, ..Default::default() }, [1.0; 200]);
        assert!((slow[199].to_degrees() - 7.0).abs() < 1e-9);
    }

    #[test]
    fn backlash_leaves_the_joint_behind_at_each_turn() {
        let backlash = SteerBacklash { width_rad: 0.04 };
        let there_and_back = (0..400).map(|i| if i < 200 { 0.5 } else { -0.5 });
        let rest = follow(SteeringEffects { backlash, ..Default::default() }, there_and_back);
        let oil_deg = 5.0;
        assert!((rest[199].to_degrees() - (oil_deg - 0.02_f64.to_degrees())).abs() < 1e-6);
        // The oil goes back 0.04 rad, at 5 degrees a second, before the joint does.
        let still = rest[200..].iter().take_while(|r| **r == rest[199]).count();
        assert!((still as f64 * DT_S - 0.04_f64.to_degrees() / 5.0).abs() < 2.0 * DT_S);
    }
}
