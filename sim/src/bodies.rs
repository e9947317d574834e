//! What a solver of the rigid bodies is asked for: loads in, motion out.
//!
//! The plant's blocks (hydraulics, drive, tyres) turn motion into [`Loads`]; a solver turns loads
//! into [`Motion`]. There are two behind this trait: the reference on rapier3d and the fast core.

use xt28_machine::PerWheel;

use crate::end_stop::EndStop;
use crate::{Parts, RollHinge, Terrain, Tilt};

/// The roll hinge's stops, Nm/rad, Nm s/rad and rad (assumed): the machine's weight on one side's wheels
/// twists them by a degree and a half.
const ROLL_STOP: EndStop = EndStop { stiffness: 8.0e6, damping: 4.0e5, damped_at: 2e-3 };

/// A torque held over a step turns a free wheel past where it wants it by 2 J/dt a rad/s, J its inertia; this much
/// is asked of a step (assumed), for more leaves wheels that lose their ground to swing on for long.
pub(crate) const HELD_SHARE: f64 = 1.5;

/// A solver of the vehicle's rigid bodies. A clone is a snapshot: it goes on bit for bit alike.
pub trait Bodies: Clone {
    /// The parts set down on the terrain, front axle at the origin heading east, arms at `stroke_m`.
    fn new(parts: &Parts, terrain: &Terrain, stroke_m: PerWheel<f64>) -> Self;

    /// The motion after the last step.
    fn motion(&self) -> Motion;

    /// Longest step, s, over which a torque may be held that grows by `slope_nms` Nm with each rad/s of a wheel's
    /// spin, on wheels of `inertia_kg_m2` about their axles: beyond, they are thrown to and fro.
    fn held_at_most_s(inertia_kg_m2: f64, slope_nms: f64) -> f64;

    /// Advances by `dt_s` s under `loads`.
    fn advance(&mut self, loads: &Loads, dt_s: f64);
}

/// A solver that can be put where a measurement has the machine.
///
/// Of its own: a solver without it cannot be resumed from a measurement, and that shows in the types.
pub trait Placed: Bodies {
    /// Puts every part where `motion` has it, moving as it does; forces in it are not looked at, and
    /// what contacts remember stays.
    fn place(&mut self, motion: &Motion);
}

/// Angle and rate of a hinge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HingeMotion {
    /// Angle, rad.
    pub angle_rad: f64,
    /// Rate, rad/s.
    pub rate_rad_s: f64,
}

/// A spring and a damper about a hinge, to be integrated implicitly:
/// torque = stiffness (rest - angle) - damping rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HingeSpring {
    /// Stiffness, Nm/rad.
    pub stiffness_nm: f64,
    /// Damping, Nm s/rad.
    pub damping_nms: f64,
    /// Angle without torque, rad.
    pub rest_rad: f64,
}

impl HingeSpring {
    /// The spring and damper that make `torque_nm` in this motion, with these slopes around it.
    #[must_use]
    pub fn through(
        motion: HingeMotion,
        torque_nm: f64,
        stiffness_nm: f64,
        damping_nms: f64,
    ) -> Self {
        let twist_rad = (torque_nm + damping_nms * motion.rate_rad_s) / stiffness_nm;
        Self { stiffness_nm, damping_nms, rest_rad: motion.angle_rad + twist_rad }
    }

    /// The same with a metal stop beyond `max_rad` on either side, linearised around this motion; within
    /// the stops the same to the bit.
    #[must_use]
    pub(crate) fn stopped(self, motion: HingeMotion, max_rad: f64, stop: &EndStop) -> Self {
        let HingeMotion { angle_rad, rate_rad_s } = motion;
        let side = 1.0_f64.copysign(angle_rad);
        let Some(push) = stop.push(angle_rad.abs() - max_rad, side * rate_rad_s) else {
            return self;
        };
        let spring_nm = self.stiffness_nm * (self.rest_rad - angle_rad);
        Self::through(
            motion,
            spring_nm - self.damping_nms * rate_rad_s - side * push.force,
            self.stiffness_nm + push.stiffness,
            self.damping_nms + push.damping,
        )
    }

    /// The spring of a roll hinge in this motion, with its stops.
    #[must_use]
    pub(crate) fn of_roll(law: &RollHinge, motion: HingeMotion) -> Self {
        let RollHinge { stiffness_nm, damping_nms, max_rad } = *law;
        Self { stiffness_nm, damping_nms, rest_rad: 0.0 }.stopped(motion, max_rad, &ROLL_STOP)
    }
}

/// What resists a wheel's rolling, without a jump at rest.
///
/// It acts in the axle, between wheel and arm. Of a tyre alone it would be the ground's, against the wheel's turn in the
/// world, and its arm would feel nothing of it; of bearings, seals and planets it is the arm's. The machines whose logs are at hand have it
/// there: wheel loads are 0.06 kN off for 0.39 kN (`docs/second-opinion.md`).
///
/// The torque falls from `most_nm` through nothing to its opposite within some hundredths of a rad/s,
/// on soft ground so steeply that it would turn a wheel alone around within a step: one that slides, or
/// whose tyre reckons with the wheel alone. So a solver takes it at the step's end:
/// torque + most (tanh(rate / fade) at the start - tanh(rate / fade) at the end).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RollingDrag {
    /// Torque in the motion at the step's start, Nm, forward > 0.
    pub torque_nm: f64,
    /// What it comes to as the wheel turns faster, Nm.
    pub most_nm: f64,
    /// Rate at which it has come to some three quarters of that, rad/s.
    pub fade_rad_s: f64,
}

impl RollingDrag {
    /// At most `most_nm` against a turn of `rate_rad_s`: most tanh(rate / fade).
    #[must_use]
    pub fn tanh(most_nm: f64, fade_rad_s: f64, rate_rad_s: f64) -> Self {
        Self { torque_nm: -most_nm * (rate_rad_s / fade_rad_s).tanh(), most_nm, fade_rad_s }
    }
}

/// A force and a torque on a body, along the solver's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force, N.
    pub force_n: [f64; 3],
    /// Torque about the point at which the force acts, Nm.
    pub torque_nm: [f64; 3],
}

/// How the rigid bodies move at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Arms, from their angle at [`crate::REFERENCE_STROKE_M`]; extending (wheel down) > 0.
    pub arm: PerWheel<HingeMotion>,
    /// Front and rear articulation joint; left > 0.
    pub joint: [HingeMotion; 2],
    /// The machine's rear against its front about the roll hinge, where it has one; right side high > 0.
    pub roll_hinge: HingeMotion,
    /// Wheels about their axles, against their arms, rad/s; forward > 0.
    pub wheel_rate_rad_s: PerWheel<f64>,
    /// Origin of the front frame in the world, m. A solver's world has the ground's axes: where the
    /// ground leans as a whole, gravity leans ([`Parts::tilt`]).
    pub position_m: [f64; 3],
    /// The front frame's axes x (forward), y (left), z (up), each in the world.
    pub axes: [[f64; 3]; 3],
    /// Velocity of the front frame's centre of mass in the world, m/s.
    pub velocity_m_s: [f64; 3],
    /// Angular velocity of the front frame in the world, rad/s.
    pub rate_rad_s: [f64; 3],
    /// Vertical force of the ground on each wheel, mean of the last step, N.
    pub ground_force_n: PerWheel<f64>,
    /// What the ground presses on anything but the wheels with, mean of the last step, N; see
    /// [`crate::VehicleState::chassis_force_n`] on what is summed and on its peaks.
    pub chassis_force_n: f64,
}

impl Motion {
    /// The same motion, seen from the level world instead of from ground that leans by `tilt`.
    /// Forces stay what they are: square to the ground.
    #[must_use]
    pub fn in_world(&self, tilt: &Tilt) -> Self {
        Self {
            position_m: tilt.to_world(self.position_m),
            axes: self.axes.map(|axis| tilt.to_world(axis)),
            velocity_m_s: tilt.to_world(self.velocity_m_s),
            rate_rad_s: tilt.to_world(self.rate_rad_s),
            ..*self
        }
    }
}

/// What acts on the rigid bodies over a step, beside gravity and the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loads {
    /// Cylinders, about the arms' hinges; signs as in [`Motion::arm`].
    pub arm: PerWheel<HingeSpring>,
    /// Articulation joints; signs as in [`Motion::joint`].
    pub joint: [HingeSpring; 2],
    /// Motor torques on the wheels, Nm, forward > 0; the arm bears the reaction.
    pub drive_nm: PerWheel<f64>,
    /// Rolling resistance, in the axle: the arm bears the reaction.
    pub drag: PerWheel<RollingDrag>,
    /// Dry friction that holds each wheel against its arm, Nm.
    pub hold_nm: PerWheel<f64>,
    /// What else acts on each wheel, at its centre: the ground of who has tyres of their own.
    pub on_wheel: PerWheel<Wrench>,
}
