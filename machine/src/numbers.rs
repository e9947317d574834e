//! The machine file: every number of the machine with its unit in the key, refused when a key is unknown.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::{Levelling, Linkage, Wheel, range};

/// The numbers of one machine. Units are in the field names; sources stand in `xt28.toml`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)]
pub struct Machine {
    pub masses: Masses,
    pub frames: Frames,
    pub articulation: Articulation,
    pub wheels: Wheels,
    pub arms: Arms,
    pub hydraulics: Hydraulics,
    pub drive: Drive,
    pub sensors: Sensors,
    #[serde(default)]
    pub vehicle: Vehicle,
    #[serde(default)]
    pub levelling: Levelling,
}

/// Why a machine file was refused.
#[derive(Debug, thiserror::Error)]
pub enum MachineError {
    /// The file could not be read.
    #[error("{path}: cannot read the machine file: {source}; give --machine an existing file")]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The text is not a machine: bad TOML, an unknown or missing key, a value of another type.
    #[error("{path}:{line}: {problem}; keys carry their unit, see machine/xt28.toml")]
    Parse {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong there.
        problem: String,
    },
    /// A number is outside what a machine can be.
    #[error("{path}: {key} = {value} is out of range: {must}")]
    Range {
        /// The file.
        path: PathBuf,
        /// Section and key.
        key: String,
        /// The value found.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
    /// The two circuits do not drive each wheel once.
    #[error(
        "{path}: wheels.circuit_1 and wheels.circuit_2 must name each of FR FL MR ML BR BL once, not {found}"
    )]
    Circuits {
        /// The file.
        path: PathBuf,
        /// The names found, both circuits.
        found: String,
    },
}

macro_rules! section {
    ($(#[$doc:meta])* $name:ident { $($field:ident: $kind:ty),* $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq, Deserialize)]
        #[serde(deny_unknown_fields)]
        #[allow(missing_docs)]
        pub struct $name { $(pub $field: $kind),* }
    };
}

section! {
    /// Rigid masses.
    Masses {
        front_frame_kg: f64, middle_frame_kg: f64, rear_frame_kg: f64, arm_kg: f64, wheel_kg: f64,
        load_max_kg: f64,
    }
}
section! {
    /// Centres of mass and boxes of the three frames, at stroke 0.25 m on level ground.
    Frames {
        front_com_m: [f64; 3], middle_com_m: [f64; 3], rear_com_m: [f64; 3],
        front_box_m: [f64; 3], middle_box_m: [f64; 3], rear_box_m: [f64; 3],
        underside_below_pivot_m: f64,
    }
}
section! {
    /// The two articulation joints and the steering law of the transmission ECU.
    Articulation {
        front_joint_x_m: f64, rear_joint_x_m: f64, angle_max_deg: f64, rate_max_deg_s: f64,
        torque_max_nm: f64, rear_ratio: f64, kp_per_deg: f64, ki_per_s: f64,
        speed_threshold_m_s: f64,
    }
}
section! {
    /// Wheels and the two hydrostatic circuits.
    Wheels {
        radius_m: f64, track_m: f64, axle_x_m: [f64; 3], circuit_1: [String; 3],
        circuit_2: [String; 3], friction: f64, rolling_resistance: f64, torque_max_nm: f64,
    }
}
section! {
    /// The pendulum arms and their cylinders.
    Arms {
        pivot_to_cylinder_eye_m: f64, pivot_to_rod_eye_m: f64, pivot_to_wheel_m: f64,
        closed_length_m: f64, angle_frame_rad: f64, angle_arm_rad: f64, front_arms_point: Pointing,
        stroke_max_m: f64, area_bore_m2: f64, area_rod_m2: f64, force_max_n: f64,
    }
}
section! {
    /// The nominal actuator and the manual position controller of the pendulum-arm ECU.
    Hydraulics {
        flow_full_m3_s: f64, speed_full_m_s: f64, lock_stiffness_n_m: f64,
        lock_damping_n_s_m: f64, return_pressure_pa: f64, manual_kp_per_mm: f64,
        manual_ki_per_mm_s: f64, manual_windup: f64, manual_opening_max: f64,
        manual_stroke_max_m: f64,
    }
}
section! {
    /// Engine and hydrostatic transmission.
    Drive {
        speed_full_m_s: f64, engine_speed_rpm: f64, engine_torque_max_nm: f64,
        engine_power_w: f64, speed_time_constant_s: f64,
    }
}
section! {
    /// Standard deviations and rates of the sensors.
    Sensors {
        gnss_position_m: f64, gnss_velocity_xy_m_s: f64, gnss_velocity_z_m_s: f64,
        gnss_heading_rad: f64, gnss_rate_hz: f64, gnss_antenna_m: [f64; 3], height_map_m: f64,
    }
}

/// What our model needs beside the published numbers. All assumed; a file may leave the section out.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Vehicle {
    /// Centre of mass of an arm, as a share of the way from pivot to wheel.
    pub arm_com_share: f64,
    /// Radius of gyration of a wheel about its axle, m.
    pub wheel_gyration_m: f64,
    /// Stiffness of a tyre on the ground, N/m.
    pub tyre_stiffness_n_m: f64,
    /// Damping of a tyre on the ground, N s/m.
    pub tyre_damping_n_s_m: f64,
    /// How a wheel meets the ground.
    pub tyre_model: TyreModel,
    /// Stiffness of a tyre's patch along its rolling, N/m; the brush model's.
    pub tyre_longitudinal_n_m: f64,
    /// Stiffness of a tyre's patch along the axle, N/m; the brush model's.
    pub tyre_lateral_n_m: f64,
    /// Distance rolled until a tyre's side force has grown to 63 %, m; the brush model's.
    pub tyre_relaxation_m: f64,
    /// Whether the front articulation also lets the frames roll against one another.
    pub roll_hinge: bool,
    /// Stiffness of the roll hinge, Nm/rad.
    pub roll_hinge_stiffness_nm: f64,
    /// Damping of the roll hinge, Nm s/rad.
    pub roll_hinge_damping_nms: f64,
    /// Where the roll hinge meets its stops, on either side, deg.
    pub roll_hinge_max_deg: f64,
    /// Arm pivot from the centre line, m. The wheel hangs outboard of it.
    pub arm_pivot_y_m: f64,
    /// Torque per speed error of a circuit's mean, Nm per rad/s and wheel.
    pub circuit_gain_nms: f64,
    /// Torque per wheel that builds up in 1 s for 1 rad/s of the mean of all six, Nm/rad.
    pub mean_integral_nm: f64,
    /// Stiffness of a held articulation joint, Nm/rad.
    pub joint_stiffness_nm: f64,
    /// Damping of a held articulation joint, Nm s/rad.
    pub joint_damping_nms: f64,
}

impl Default for Vehicle {
    fn default() -> Self {
        Self {
            arm_com_share: 0.5,
            wheel_gyration_m: 0.6,
            tyre_stiffness_n_m: 8.0e6,
            tyre_damping_n_s_m: 6.0e4,
            tyre_model: TyreModel::Rigid,
            tyre_longitudinal_n_m: 6.0e5,
            tyre_lateral_n_m: 4.0e5,
            tyre_relaxation_m: 0.6,
            roll_hinge: false,
            roll_hinge_stiffness_nm: 0.0,
            roll_hinge_damping_nms: 2.0e4,
            roll_hinge_max_deg: 15.0,
            arm_pivot_y_m: 1.175,
            circuit_gain_nms: 10_000.0,
            mean_integral_nm: 145_000.0,
            joint_stiffness_nm: 2.5e6,
            joint_damping_nms: 2.8e5,
        }
    }
}

/// How a wheel meets the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TyreModel {
    /// A near rigid ball with dry friction.
    Rigid,
    /// A springy tyre whose patch gives along the ground before it slides.
    Brush,
}

/// Which way an arm points from its pivot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Pointing {
    /// The pivot is behind the wheel.
    Forward,
    /// The pivot is ahead of the wheel.
    Backward,
}

const XT28: &str = include_str!("../xt28.toml");

impl Machine {
    /// The nominal Xt28, built in.
    ///
    /// # Panics
    /// Never: a test parses the built-in file.
    #[must_use]
    pub fn xt28() -> Self {
        Self::parse(XT28, Path::new("xt28.toml")).expect("the built-in machine file is valid")
    }

    /// A machine from a file.
    ///
    /// # Errors
    /// [`MachineError`], with the file, the line and the remedy.
    pub fn load(path: &Path) -> Result<Self, MachineError> {
        let text = std::fs::read_to_string(path)
            .map_err(|source| MachineError::Read { path: path.to_owned(), source })?;
        Self::parse(&text, path)
    }

    /// A machine from TOML text; `path` only names it in errors.
    ///
    /// # Errors
    /// [`MachineError::Parse`] or [`MachineError::Range`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, MachineError> {
        let machine: Self = toml::from_str(text).map_err(|error| MachineError::Parse {
            path: path.to_owned(),
            line: error.span().map_or(1, |span| line_of(text, span.start)),
            problem: error.message().replace('\n', " "),
        })?;
        if let Some((key, value, must)) = range::beyond_all_machines(text) {
            return Err(MachineError::Range { path: path.to_owned(), key, value, must });
        }
        machine.check(path)?;
        Ok(machine)
    }

    /// The built-in machine file's text.
    #[must_use]
    pub const fn builtin_text() -> &'static str {
        XT28
    }

    /// The arm linkage.
    #[must_use]
    pub const fn linkage(&self) -> Linkage {
        let a = &self.arms;
        Linkage {
            pivot_to_cylinder_eye_m: a.pivot_to_cylinder_eye_m,
            pivot_to_rod_eye_m: a.pivot_to_rod_eye_m,
            pivot_to_wheel_m: a.pivot_to_wheel_m,
            closed_length_m: a.closed_length_m,
            angle_frame_rad: a.angle_frame_rad,
            angle_arm_rad: a.angle_arm_rad,
        }
    }

    /// Mass of the empty machine, kg.
    #[must_use]
    pub fn mass_kg(&self) -> f64 {
        let m = &self.masses;
        m.front_frame_kg + m.middle_frame_kg + m.rear_frame_kg + 6.0 * (m.arm_kg + m.wheel_kg)
    }

    /// The wheels of the two hydrostatic circuits; `None` unless they name each wheel once.
    #[must_use]
    pub fn circuits(&self) -> Option<[[Wheel; 3]; 2]> {
        let w = &self.wheels;
        let mut circuits = [[Wheel::Fr; 3]; 2];
        let mut driven = [false; 6];
        for (wheels, names) in circuits.iter_mut().zip([&w.circuit_1, &w.circuit_2]) {
            for (wheel, name) in wheels.iter_mut().zip(names) {
                *wheel = Wheel::from_name(name)?;
                driven[wheel.index()] = true;
            }
        }
        driven.iter().all(|&once| once).then_some(circuits)
    }

    fn check(&self, path: &Path) -> Result<(), MachineError> {
        if self.circuits().is_none() {
            let found = [&self.wheels.circuit_1[..], &self.wheels.circuit_2[..]].concat().join(" ");
            return Err(MachineError::Circuits { path: path.to_owned(), found });
        }
        let fault = range::too_low(self).or_else(|| range::unusable(self));
        let fault = fault.or_else(|| range::misplaced(self)).or_else(|| range::unhinged(self));
        let fault = fault.or_else(|| range::at_odds(self)).or_else(|| range::too_light(self));
        let fault = fault.or_else(|| self.levelling.fault());
        if let Some((key, value, must)) = fault {
            let key = key.to_owned();
            return Err(MachineError::Range { path: path.to_owned(), key, value, must });
        }
        Ok(())
    }
}

fn line_of(text: &str, offset: usize) -> usize {
    text.as_bytes()[..offset.min(text.len())].iter().filter(|&&b| b == b'\n').count() + 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_built_in_machine_weighs_seventeen_tonnes() {
        assert!((Machine::xt28().mass_kg() - 17_000.0).abs() < 1e-9);
    }

    #[test]
    fn an_unknown_key_is_refused_with_its_line() {
        let text = XT28.replace("arm_kg = 200.0", "arm_lb = 441.0");
        let error = Machine::parse(&text, Path::new("m.toml")).unwrap_err().to_string();
        let line = text.lines().position(|l| l.starts_with("arm_lb")).unwrap() + 1;
        assert!(error.starts_with(&format!("m.toml:{line}: unknown field `arm_lb`")), "{error}");
        assert!(error.contains("arm_kg"), "{error}");
    }

    #[test]
    fn a_number_no_machine_can_have_is_refused() {
        for bad in ["-1.0", "0.0", "nan", "inf"] {
            let text = XT28.replace("radius_m = 0.74", &format!("radius_m = {bad}"));
            let error = Machine::parse(&text, Path::new("m.toml")).unwrap_err().to_string();
            assert!(error.contains("wheels.radius_m"), "{error}");
        }
    }

    #[test]
    fn circuits_that_miss_a_wheel_or_name_none_are_refused() {
        for bad in ["\"FX\"", "\"ML\""] {
            let text = XT28.replace("circuit_1 = [\"FR\"", &format!("circuit_1 = [{bad}"));
            assert_ne!(text, XT28);
            let error = Machine::parse(&text, Path::new("m.toml")).unwrap_err().to_string();
            assert!(error.starts_with("m.toml: wheels.circuit_1 and"), "{error}");
        }
    }
}
