//! A foreign machine: rigid bodies of the bench, every other law of its own, tyres and ground included.

use glam::DVec3;
use xt28_machine::{Linkage, PerWheel, Wheel};
use xt28_sim::terrain::Plane;
use xt28_sim::{HingeSpring, Loads, Motion, Parts, Placed, REFERENCE_STROKE_M, Ramp, Terrain};

use crate::body::parts;
use crate::drive::{Drive, DriveDemand};
use crate::ground::ground;
use crate::hydraulics::{Arm, RodMotion, Supply};
use crate::rims::rims;
use crate::steering::Joint;
use crate::truth::Truth;
use crate::tyre::Carcass;

/// Step of the machine, s; the bench's own plant takes another.
pub(crate) const STEP_S: f64 = 0.002;
/// How far below the yard the solver has its own ground, m: its own tyres never touch it.
const PIT_M: f64 = 50.0;

/// What the ECUs hold at the machine's inputs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Inputs {
    /// Openings of the arms' valves, extending > 0.
    pub(crate) arm: PerWheel<f64>,
    /// Openings of the front and the rear steering valve, left > 0.
    pub(crate) steer: [f64; 2],
    pub(crate) drive: DriveDemand,
}

/// What is to be seen of the machine at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Instant {
    pub(crate) stroke_m: PerWheel<f64>,
    /// Chambers A and B, Pa.
    pub(crate) pressure_pa: PerWheel<[f64; 2]>,
    pub(crate) joint_rad: [f64; 2],
    pub(crate) wheel_rad_s: PerWheel<f64>,
    /// Pumps 1A 1B 2A 2B, Pa.
    pub(crate) pump_pa: [f64; 4],
    pub(crate) engine_rpm: f64,
    pub(crate) position_m: [f64; 3],
    axes: [[f64; 3]; 3],
    /// Of the front frame's centre of mass, m/s.
    pub(crate) velocity_m_s: [f64; 3],
    pub(crate) rate_rad_s: [f64; 3],
    com_m: [f64; 3],
}

/// Bodies and laws. A clone goes on alike.
#[derive(Clone, Debug)]
pub(crate) struct Foreign<B> {
    bodies: B,
    parts: Parts,
    linkage: Linkage,
    ground: Terrain,
    carcasses: PerWheel<Carcass>,
    motion: Motion,
    /// Stroke and rate a step ago.
    rod: PerWheel<[f64; 2]>,
    arms: PerWheel<Arm>,
    supply: Supply,
    joints: [Joint; 2],
    drive: Drive,
}

impl<B: Placed> Foreign<B> {
    /// Set down on the yard, with `ramp` on it, at `stroke_m`, valves closed.
    pub(crate) fn new(truth: &Truth, ramp: Option<&Ramp>, stroke_m: PerWheel<f64>) -> Self {
        let parts = parts(truth);
        let slope_rad = truth.body.slope_rad;
        let pit = Plane { height_m: -PIT_M, rise: slope_rad.map(f64::tan) };
        let mut bodies = B::new(&parts, &Terrain::Plane(pit), stroke_m);
        let mut motion = bodies.motion();
        motion.position_m[2] += PIT_M;
        bodies.place(&motion);
        Self {
            motion,
            bodies,
            linkage: parts.linkage,
            ground: ground(slope_rad, ramp),
            carcasses: PerWheel::default(),
            rod: stroke_m.map(|stroke_m| [stroke_m, 0.0]),
            arms: PerWheel::from_fn(|wheel| {
                let load_n = truth.mean_load_n(stroke_m[wheel]);
                Arm::settled(truth, &truth.arms[wheel], load_n, STEP_S)
            }),
            supply: Supply::default(),
            joints: [(); 2].map(|()| Joint::straight(STEP_S)),
            drive: Drive::at_rest(&truth.machine, STEP_S),
            parts,
        }
    }

    /// Goes on by [`STEP_S`] from `time_s`.
    pub(crate) fn step(&mut self, truth: &Truth, inputs: &Inputs, time_s: f64) {
        let machine = &truth.machine;
        let arms = PerWheel::from_fn(|wheel| {
            let beside = Wheel::ALL[wheel.index() ^ 1];
            let commands = [inputs.arm[wheel], inputs.arm[beside]];
            self.arms[wheel].open(truth, &truth.arms[wheel], commands, time_s, STEP_S)
        });
        let joints =
            [0, 1].map(|i| self.joints[i].open(&truth.steering, machine, inputs.steer[i], STEP_S));
        let asked = arms.map(|arm| arm.flow_m3_s).sum() + joints[0][1] + joints[1][1];
        let share = self.supply.step(&truth.supply, asked, STEP_S);
        let rolling = truth.body.tyres.map(|tyre| tyre.rolling);
        let torques =
            self.drive.step(&truth.drive, machine, &rolling, &inputs.drive, &self.motion, STEP_S);
        let rims = rims(&self.parts, &self.motion);
        let loads = Loads {
            arm: PerWheel::from_fn(|wheel| {
                self.press(truth, wheel, share * arms[wheel].speed_m_s, time_s)
            }),
            joint: [0, 1].map(|i| {
                let rate = share * joints[i][0];
                self.joints[i].turn(&truth.steering, machine, self.motion.joint[i], rate, STEP_S)
            }),
            drive_nm: torques.drive_nm,
            hold_nm: torques.hold_nm,
            on_wheel: PerWheel::from_fn(|wheel| {
                let (tyre, radius_m) = (&truth.body.tyres[wheel], self.parts.radius_m);
                let rim = &rims[wheel];
                let mut push =
                    self.carcasses[wheel].step(tyre, radius_m, rim, &self.ground, STEP_S);
                // What resists the rolling is the ground's here, and no arm feels it.
                let drag = rim.axle * torques.drag_nm[wheel];
                push.torque_nm = (DVec3::from(push.torque_nm) + drag).to_array();
                push
            }),
            ..Loads::default()
        };
        self.bodies.advance(&loads, STEP_S);
        self.motion = self.bodies.motion();
        self.motion.ground_force_n = loads.on_wheel.map(|wrench| wrench.force_n[2]);
    }

    /// An arm's cylinder about its hinge, with the oil let in for `speed_m_s`.
    fn press(&mut self, truth: &Truth, wheel: Wheel, speed_m_s: f64, time_s: f64) -> HingeSpring {
        let hinge = self.motion.arm[wheel];
        let angle_rad = self.angle_rad(wheel);
        let lever_m = self.linkage.lever_m(angle_rad);
        let (stroke_m, rate_m_s) = (self.linkage.stroke_m(angle_rad), hinge.rate_rad_s * lever_m);
        let [before_m, before_m_s] = self.rod[wheel];
        self.rod[wheel] = [stroke_m, rate_m_s];
        let rod =
            RodMotion { stroke_m, rate_m_s: [before_m_s, rate_m_s], travel_m: stroke_m - before_m };
        let arm = &truth.arms[wheel];
        let force = self.arms[wheel].press(truth, arm, &rod, speed_m_s, time_s, STEP_S);
        let square = lever_m * lever_m;
        HingeSpring::through(
            hinge,
            force.force_n * lever_m,
            force.stiffness_n_m * square,
            force.damping_n_s_m * square,
        )
    }

    fn angle_rad(&self, wheel: Wheel) -> f64 {
        self.linkage.at_stroke(REFERENCE_STROKE_M).angle_rad + self.motion.arm[wheel].angle_rad
    }

    /// What is to be seen now.
    pub(crate) fn now(&self, truth: &Truth) -> Instant {
        let motion = &self.motion;
        Instant {
            stroke_m: PerWheel::from_fn(|wheel| self.linkage.stroke_m(self.angle_rad(wheel))),
            pressure_pa: PerWheel::from_fn(|wheel| {
                self.arms[wheel].pressures_pa(truth, &truth.arms[wheel])
            }),
            joint_rad: motion.joint.map(|joint| joint.angle_rad),
            wheel_rad_s: motion.wheel_rate_rad_s,
            pump_pa: self.drive.pressures_pa(),
            engine_rpm: self.drive.engine_rpm(),
            position_m: motion.position_m,
            axes: motion.axes,
            velocity_m_s: motion.velocity_m_s,
            rate_rad_s: motion.rate_rad_s,
            com_m: self.parts.frames[0].com_m,
        }
    }
}

impl Instant {
    /// A vector of the world along the front frame's axes.
    pub(crate) fn in_frame(&self, v: [f64; 3]) -> [f64; 3] {
        self.axes.map(|axis| axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2])
    }

    /// Heading, rad, counter-clockwise from east.
    pub(crate) fn yaw_rad(&self) -> f64 {
        self.axes[0][1].atan2(self.axes[0][0])
    }

    /// Position and velocity of a point of the front frame, m and m/s.
    pub(crate) fn antenna(&self, point_m: [f64; 3]) -> ([f64; 3], [f64; 3]) {
        let [x, y, z] = self.axes;
        let out = |v: [f64; 3]| -> [f64; 3] {
            core::array::from_fn(|i| v[0] * x[i] + v[1] * y[i] + v[2] * z[i])
        };
        let arm = out(core::array::from_fn(|i| point_m[i] - self.com_m[i]));
        let w = self.rate_rad_s;
        let turn = [
            w[1] * arm[2] - w[2] * arm[1],
            w[2] * arm[0] - w[0] * arm[2],
            w[0] * arm[1] - w[1] * arm[0],
        ];
        let point = out(point_m);
        (
            core::array::from_fn(|i| self.position_m[i] + point[i]),
            core::array::from_fn(|i| self.velocity_m_s[i] + turn[i]),
        )
    }
}
