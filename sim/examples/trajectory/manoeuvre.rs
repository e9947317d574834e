//! Manoeuvres from `tools/yardstick/manoeuvres.toml`, which another engine's side reads as well.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use xt28_machine::PerWheel;
use xt28_sim::{Actuation, Plant, Terrain, VehicleState};

/// Knots `[time in s, value]`: linear in between, held before the first and after the last.
type Knots = Vec<[f64; 2]>;

/// The file of manoeuvres.
#[derive(Deserialize)]
struct File {
    start_stroke_m: f64,
    duration_s: f64,
    sample_s: f64,
    engine_speed_rpm: f64,
    motor_displacement: f64,
    #[serde(flatten)]
    manoeuvres: BTreeMap<String, Inputs>,
}

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Inputs {
    terrain: String,
    settle_s: f64,
    arm_opening: Option<[Knots; 6]>,
    steer_opening: Option<[Knots; 2]>,
    pump_displacement: Option<Knots>,
}

/// One manoeuvre: actuator inputs over time, and where and how long.
pub(crate) struct Manoeuvre {
    /// Stroke of all cylinders at the start of the settling, m.
    pub(crate) start_stroke_m: f64,
    /// Name of the terrain's file, without its ending.
    pub(crate) terrain: String,
    duration_s: f64,
    sample_s: f64,
    engine_speed_rpm: f64,
    motor_displacement: f64,
    inputs: Inputs,
}

/// What a manoeuvre shows at one sample.
pub(crate) struct Sample {
    /// Time since the end of the settling, s.
    pub(crate) time_s: f64,
    /// The state at that time.
    pub(crate) state: VehicleState,
    /// Mean of the ground forces since the last sample, N.
    pub(crate) ground_force_n: PerWheel<f64>,
}

/// Where the files that both sides read are.
#[must_use]
pub(crate) fn yardstick() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tools/yardstick")
}

/// Level ground, or a terrain file of the yardstick.
///
/// # Errors
/// When the file cannot be read or is no terrain.
pub(crate) fn terrain(name: &str) -> Result<Terrain, String> {
    if name == "flat" {
        return Ok(Terrain::Flat);
    }
    Terrain::load(&yardstick().join(format!("{name}.toml"))).map_err(|error| error.to_string())
}

impl Manoeuvre {
    /// The manoeuvre of this name.
    ///
    /// # Errors
    /// When the file cannot be read or has no such manoeuvre.
    pub(crate) fn load(name: &str) -> Result<Self, String> {
        let path = yardstick().join("manoeuvres.toml");
        let says = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let text = std::fs::read_to_string(&path).map_err(|error| says(&error))?;
        let file: File = toml::from_str(&text).map_err(|error| says(&error))?;
        let known = file.manoeuvres.keys().cloned().collect::<Vec<_>>().join(", ");
        let Some(inputs) = file.manoeuvres.get(name) else {
            return Err(says(&format!("no manoeuvre `{name}`; there are {known}")));
        };
        Ok(Self {
            start_stroke_m: file.start_stroke_m,
            terrain: inputs.terrain.clone(),
            duration_s: file.duration_s,
            sample_s: file.sample_s,
            engine_speed_rpm: file.engine_speed_rpm,
            motor_displacement: file.motor_displacement,
            inputs: inputs.clone(),
        })
    }

    /// Actuator inputs at a time; before zero everything is closed.
    #[must_use]
    pub(crate) fn at(&self, time_s: f64) -> Actuation {
        let along = |knots: &Knots| if time_s < 0.0 { 0.0 } else { interpolate(knots, time_s) };
        let i = &self.inputs;
        let mut actuation = Actuation::idle(self.engine_speed_rpm);
        actuation.motor_displacement = PerWheel::splat(self.motor_displacement);
        if let Some(arms) = &i.arm_opening {
            actuation.arm_opening = PerWheel(core::array::from_fn(|wheel| along(&arms[wheel])));
        }
        if let Some(steer) = &i.steer_opening {
            actuation.steer_opening = core::array::from_fn(|joint| along(&steer[joint]));
        }
        if let Some(pump) = &i.pump_displacement {
            actuation.pump_displacement = [along(pump); 2];
        }
        actuation
    }

    /// Number of steps of the settling and of the manoeuvre proper.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub(crate) fn steps(&self, rate_hz: u32) -> [usize; 2] {
        let steps = |seconds: f64| (seconds * f64::from(rate_hz)).round() as usize;
        [steps(self.inputs.settle_s), steps(self.duration_s)]
    }

    /// Lets the plant settle.
    pub(crate) fn settle(&self, plant: &mut impl Plant, rate_hz: u32) {
        for _ in 0..self.steps(rate_hz)[0] {
            plant.step(&self.at(-1.0));
        }
    }

    /// Drives a settled plant through the manoeuvre and calls `see` at each sample.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
    pub(crate) fn drive(&self, plant: &mut impl Plant, rate_hz: u32, mut see: impl FnMut(Sample)) {
        let every = (self.sample_s * f64::from(rate_hz)).round() as usize;
        let mut force_n = PerWheel::splat(0.0);
        for step in 0..self.steps(rate_hz)[1] {
            plant.step(&self.at(step as f64 / f64::from(rate_hz)));
            let now_n = plant.state().ground_force_n;
            force_n = PerWheel::from_fn(|wheel| force_n[wheel] + now_n[wheel] / every as f64);
            if (step + 1) % every == 0 {
                let time_s = (step + 1) as f64 / f64::from(rate_hz);
                see(Sample { time_s, state: *plant.state(), ground_force_n: force_n });
                force_n = PerWheel::splat(0.0);
            }
        }
    }
}

impl Sample {
    /// The names of [`Sample::numbers`], as a line of CSV.
    #[must_use]
    pub(crate) fn header() -> String {
        let wheels = ["FR", "FL", "MR", "ML", "BR", "BL"];
        let per_wheel = |name: &str, unit: &str| wheels.map(|w| format!("{name}_{w}_{unit}"));
        let first = "t_s,x_m,y_m,z_m,yaw_rad,roll_rad,pitch_rad,joint_front_rad,joint_rear_rad";
        let signals = [("stroke", "m"), ("wheel_speed", "rad_s"), ("ground_force", "n")];
        let rest = signals.map(|(name, unit)| per_wheel(name, unit).join(","));
        format!("{first},{}", rest.join(","))
    }

    /// Time, position, yaw, roll, pitch, joints, strokes, wheel speeds, ground forces; SI.
    #[must_use]
    pub(crate) fn numbers(&self) -> Vec<f64> {
        let s = &self.state;
        let mut row = vec![self.time_s];
        row.extend(s.position_m);
        row.extend([s.yaw_rad, s.roll_rad, s.pitch_rad]);
        row.extend(s.joint_rad);
        row.extend(s.stroke_m.0);
        row.extend(s.wheel_speed_rad_s.0);
        row.extend(self.ground_force_n.0);
        row
    }
}

fn interpolate(knots: &Knots, time_s: f64) -> f64 {
    let after = knots.partition_point(|[t, _]| *t <= time_s);
    match (after.checked_sub(1).and_then(|i| knots.get(i)), knots.get(after)) {
        (Some([t0, a]), Some([t1, b])) => a + (b - a) * (time_s - t0) / (t1 - t0),
        (Some([_, value]), None) | (None, Some([_, value])) => *value,
        (None, None) => 0.0,
    }
}
