//! Grounds and commands of chance, driven by both solvers for ten seconds, and how far apart they come.

use std::path::Path;
use std::time::Duration;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use xt28_machine::{Machine, PerWheel};
use xt28_sim::{
    Actuation, Bodies, Effects, Plant, RapierBodies, ReducedBodies, Terrain, Vehicle, VehicleState,
};

/// Steps a second of both solvers, as in the comparison with the second engine.
const RATE_HZ: u32 = 200;
const SETTLES_S: f64 = 5.0;
const DRIVES_S: f64 = 10.0;

/// What is compared, in the order of [`apart`].
pub(crate) const KINDS: [&str; 6] = [
    "position, m",
    "heading, deg",
    "roll, pitch, deg",
    "joints, deg",
    "strokes, mm",
    "wheel speed, m/s",
];

/// Natural variation, boulders and a kerb, one or more of them; commands that steer and move every arm.
pub(crate) struct Chance {
    pub(crate) terrain: Terrain,
    steer: [[f64; 3]; 2],
    arms: [[f64; 3]; 6],
}

impl Chance {
    pub(crate) fn drawn(seed: u64) -> Self {
        let mut chance = ChaCha8Rng::seed_from_u64(seed);
        let mut text = format!(
            "[perlin]\namplitude_m = {}\nwavelength_m = {}\nseed = {seed}\n",
            chance.random_range(0.02..0.15),
            chance.random_range(2.0..6.0),
        );
        if chance.random_bool(0.6) {
            text += &format!(
                "[boulders]\ndensity_per_m2 = {}\nradius_m = [0.2, 0.6]\nheight_m = [0.03, {}]\nseed = {seed}\n",
                chance.random_range(0.1..0.4),
                chance.random_range(0.04..0.12),
            );
        }
        if chance.random_bool(0.3) {
            text += &format!(
                "[[step]]\nx_m = {}\nheight_m = {}\n",
                chance.random_range(2.0..5.0),
                chance.random_range(-0.06..0.06),
            );
        }
        // Down a little, so that the machine starts above the ground and not in it.
        text += "[[step]]\nx_m = -15.0\nheight_m = -0.08\n";
        let terrain = Terrain::parse(&text, Path::new("chance.toml")).unwrap();
        let mut wave = |most: f64| {
            [
                chance.random_range(0.0..most),
                chance.random_range(0.4..1.2),
                chance.random_range(0.0..6.3),
            ]
        };
        let steer = [0.3, 0.2].map(&mut wave);
        let arms = [0.1; 6].map(&mut wave);
        Self { terrain, steer, arms }
    }

    fn at(&self, t: f64) -> Actuation {
        let wave = |[size, rate, phase]: [f64; 3]| size * (rate * t + phase).sin();
        Actuation {
            pump_displacement: [(t / 2.0).min(1.0); 2],
            steer_opening: self.steer.map(wave),
            arm_opening: PerWheel(self.arms.map(wave)),
            ..Actuation::idle(1200.0)
        }
    }

    fn driven<B: Bodies>(&self) -> Vec<VehicleState> {
        let step = Duration::from_secs_f64(1.0 / f64::from(RATE_HZ));
        let (machine, effects) = (Machine::xt28(), Effects::default());
        let strokes = PerWheel::splat(0.17);
        let mut vehicle = Vehicle::<B>::with(&machine, &effects, &self.terrain, strokes, step);
        let steps = |seconds: f64| 0..(seconds * f64::from(RATE_HZ)) as u32;
        for _ in steps(SETTLES_S) {
            vehicle.step(&Actuation::idle(1200.0));
        }
        let drive = steps(DRIVES_S).map(|step| {
            vehicle.step(&self.at(f64::from(step) / f64::from(RATE_HZ)));
            *vehicle.state()
        });
        drive.collect()
    }

    /// Largest distance between the two solvers, of each of [`KINDS`].
    pub(crate) fn apart(&self) -> [f64; 6] {
        let radius_m = Machine::xt28().wheels.radius_m;
        let mut most = [0.0_f64; 6];
        let (ours, reference) = (self.driven::<ReducedBodies>(), self.driven::<RapierBodies>());
        for (a, b) in ours.iter().zip(&reference) {
            let largest = |a: &[f64], b: &[f64]| {
                a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            };
            let way: f64 =
                a.position_m.iter().zip(b.position_m).map(|(a, b)| (a - b).powi(2)).sum();
            let now = [
                way.sqrt(),
                (a.yaw_rad - b.yaw_rad).abs().to_degrees(),
                largest(&[a.roll_rad, a.pitch_rad], &[b.roll_rad, b.pitch_rad]).to_degrees(),
                largest(&a.joint_rad, &b.joint_rad).to_degrees(),
                largest(&a.stroke_m.0, &b.stroke_m.0) * 1e3,
                largest(&a.wheel_speed_rad_s.0, &b.wheel_speed_rad_s.0) * radius_m,
            ];
            most.iter_mut().zip(now).for_each(|(most, now)| *most = most.max(now));
        }
        most
    }
}
