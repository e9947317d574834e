//! What the numbers of a machine file can be, beyond their types.

use core::f64::consts::PI;

use crate::{ArmPose, Machine};

/// Nothing of a machine is further from zero, whatever its unit (assumed): the stiffest is 8e6 N/m.
const MAGNITUDE_MAX: f64 = 1e9;
/// Nor longer, m (assumed).
const LENGTH_MAX_M: f64 = 100.0;
/// Least lever of a cylinder about its arm's pivot, m (assumed): with none it moves nothing.
const LEVER_MIN_M: f64 = 0.05;
/// Least reach of a wheel from its arm's pivot, m, and least share of its cylinder's force that lifts it (assumed):
/// below its pivot a wheel is lifted by nothing, and beyond it the wrong way.
const REACH_MIN_M: f64 = 0.05;
const FORCE_RATIO_MIN: f64 = 0.01;
/// Least rate of GNSS fixes, Hz (assumed): a fix in a quarter of an hour.
const GNSS_RATE_MIN_HZ: f64 = 0.001;
/// What no articulation joint turns by, degrees: there its frames stand across one another.
const JOINT_ACROSS_DEG: f64 = 90.0;
/// How far beyond its ends a cylinder may be driven, m: its metal stops give way.
const STOP_GIVES_M: f64 = 0.02;
/// How far two numbers that follow from one another may part: both are rounded.
const ROUNDING: f64 = 0.01;
/// Least inertia of a wheel about its axle, kg m² (assumed), and least time in which its circuit may take
/// it along, s (assumed): with either a plant has to make some twenty of a step.
const SPIN_MIN_KG_M2: f64 = 3.0;
const DRIVE_GRIPS_S: f64 = 0.5e-3;
/// What may lie on either side of zero; all else is a size or a gain.
const SIGNED: [&str; 9] = [
    "front_com_m",
    "middle_com_m",
    "rear_com_m",
    "front_joint_x_m",
    "rear_joint_x_m",
    "axle_x_m",
    "gnss_antenna_m",
    "angle_frame_rad",
    "angle_arm_rad",
];

/// The first number of a machine file's `text` that no machine can have: section and key, the value, what
/// it must be.
pub(crate) fn beyond_all_machines(text: &str) -> Option<(String, f64, &'static str)> {
    let sections: toml::Table = toml::from_str(text).ok()?;
    sections.iter().find_map(|(section, keys)| {
        keys.as_table()?.iter().find_map(|(key, value)| {
            let (value, must) = beyond(key, value)?;
            Some((format!("{section}.{key}"), value, must))
        })
    })
}

/// The first such number in the value of `key`, or in a list of them.
fn beyond(key: &str, value: &toml::Value) -> Option<(f64, &'static str)> {
    let number = match value {
        toml::Value::Float(x) => *x,
        #[allow(clippy::cast_precision_loss)] // Nobody writes such integers.
        toml::Value::Integer(x) => *x as f64,
        toml::Value::Array(list) => return list.iter().find_map(|value| beyond(key, value)),
        _ => return None,
    };
    // Newtons to a metre are no length.
    let is_length = key.ends_with("_m") && !key.contains("_n_");
    if number.is_nan() || number.abs() > MAGNITUDE_MAX {
        Some((number, "it must be finite, and no further from zero than 1e9"))
    } else if is_length && number.abs() > LENGTH_MAX_M {
        Some((number, "it must be no further from zero than 100 m"))
    } else if number < 0.0 && !SIGNED.contains(&key) {
        Some((number, "it must be at least zero"))
    } else {
        None
    }
}

/// A place that is on the wrong side: section and key, the value, what it must be.
pub(crate) fn misplaced(machine: &Machine) -> Option<(&'static str, f64, &'static str)> {
    let Machine { articulation, wheels, sensors, .. } = machine;
    let [front_m, middle_m, rear_m] = wheels.axle_x_m;
    let backward = [
        ("wheels.axle_x_m", front_m),
        ("articulation.front_joint_x_m", articulation.front_joint_x_m),
        ("wheels.axle_x_m", middle_m),
        ("articulation.rear_joint_x_m", articulation.rear_joint_x_m),
        ("wheels.axle_x_m", rear_m),
    ];
    let order = "front axle, front joint, middle axle, rear joint and rear axle must follow one another \
                 backward, x forward";
    let wrong = backward.windows(2).find(|pair| pair[1].1 >= pair[0].1).map(|pair| pair[1]);
    if let Some((key, value)) = wrong {
        return Some((key, value, order));
    }
    let high_m = sensors.gnss_antenna_m[2];
    (high_m <= 0.0).then_some(("sensors.gnss_antenna_m", high_m, "it must be above the ground"))
}

/// A number above zero that is still of no use: section and key, the value, what it must be.
pub(crate) fn unusable(machine: &Machine) -> Option<(&'static str, f64, &'static str)> {
    let (rate_hz, angle_deg) = (machine.sensors.gnss_rate_hz, machine.articulation.angle_max_deg);
    if rate_hz < GNSS_RATE_MIN_HZ {
        return Some(("sensors.gnss_rate_hz", rate_hz, "it must be at least 0.001 Hz"));
    }
    let must = "it must be below 90 degrees, where two frames stand across one another";
    (angle_deg >= JOINT_ACROSS_DEG).then_some(("articulation.angle_max_deg", angle_deg, must))
}

/// A cylinder that does not close the triangle with its two eyes, or only just, or an arm that it does not lift:
/// section and key, the value, what it must be.
pub(crate) fn unhinged(machine: &Machine) -> Option<(&'static str, f64, &'static str)> {
    let (arms, linkage) = (&machine.arms, machine.linkage());
    let moves = |stroke_m: f64| linkage.at_stroke(stroke_m).lever_m >= LEVER_MIN_M;
    if !moves(-STOP_GIVES_M) {
        let must = "20 mm shorter still, the cylinder must reach between the arm's two eyes \
                    (arms.pivot_to_cylinder_eye_m, arms.pivot_to_rod_eye_m) with a lever of 0.05 m \
                    about the pivot";
        return Some(("arms.closed_length_m", arms.closed_length_m, must));
    }
    let must = "with arms.closed_length_m and 20 mm more, the cylinder must reach between the arm's two \
                eyes (arms.pivot_to_cylinder_eye_m, arms.pivot_to_rod_eye_m) with a lever of 0.05 m \
                about the pivot";
    let far_m = arms.stroke_max_m + STOP_GIVES_M;
    if !moves(far_m) {
        return Some(("arms.stroke_max_m", arms.stroke_max_m, must));
    }
    not_lifted(machine, [-STOP_GIVES_M, far_m].map(|stroke_m| linkage.at_stroke(stroke_m)))
}

/// An arm whose wheel its cylinder does not lift in one of the poses at the `ends` of its stroke: with both it does
/// in between, as the arm turns by less than half a turn. Section and key, the value, what it must be.
fn not_lifted(machine: &Machine, ends: [ArmPose; 2]) -> Option<(&'static str, f64, &'static str)> {
    let arms = &machine.arms;
    if arms.pivot_to_wheel_m < REACH_MIN_M {
        let must = "it must be at least 0.05 m";
        return Some(("arms.pivot_to_wheel_m", arms.pivot_to_wheel_m, must));
    }
    let reaches =
        |pose: &ArmPose| (0.0..PI).contains(&pose.angle_rad) && pose.reach_m >= REACH_MIN_M;
    if !ends.iter().all(reaches) {
        let must = "with arms.angle_arm_rad, and the cylinder 20 mm shorter than arms.closed_length_m or 20 mm \
                    longer than with arms.stroke_max_m, the wheel must still reach 0.05 m from the pivot to its \
                    own side";
        return Some(("arms.angle_frame_rad", arms.angle_frame_rad, must));
    }
    let must = "at every stroke a newton of the cylinder must lift the wheel by 0.01 N";
    let is_weak = ends.iter().any(|pose| pose.force_ratio < FORCE_RATIO_MIN);
    is_weak.then_some(("arms.pivot_to_wheel_m", arms.pivot_to_wheel_m, must))
}

/// A number that others of the file give too, and otherwise: section and key, the value, what it must be.
pub(crate) fn at_odds(machine: &Machine) -> Option<(&'static str, f64, &'static str)> {
    let Machine { arms, hydraulics, .. } = machine;
    let speed_m_s = hydraulics.flow_full_m3_s / arms.area_bore_m2;
    let parts = (hydraulics.speed_full_m_s / speed_m_s - 1.0).abs() > ROUNDING;
    let must = "it must be hydraulics.flow_full_m3_s over arms.area_bore_m2 to 1 %, the speed at which a \
                valve fully open extends its cylinder";
    parts.then_some(("hydraulics.speed_full_m_s", hydraulics.speed_full_m_s, must))
}

/// Wheels that turn too lightly for their drive: section and key, the value, what it must be.
pub(crate) fn too_light(machine: &Machine) -> Option<(&'static str, f64, &'static str)> {
    let (wheel_kg, v) = (machine.masses.wheel_kg, &machine.vehicle);
    let spins_kg_m2 = wheel_kg * v.wheel_gyration_m * v.wheel_gyration_m;
    let least_kg_m2 = (DRIVE_GRIPS_S * v.circuit_gain_nms).max(SPIN_MIN_KG_M2);
    let must = "times vehicle.wheel_gyration_m squared it must be at least 3 kg m², and at least \
                vehicle.circuit_gain_nms times 0.5 ms: with less the drive is stiffer than a plant can follow";
    (spins_kg_m2 < least_kg_m2).then_some(("masses.wheel_kg", wheel_kg, must))
}

/// A number that is too low: section and key, the value, what it must be.
pub(crate) fn too_low(machine: &Machine) -> Option<(&'static str, f64, &'static str)> {
    let Machine { masses, articulation, wheels, arms, hydraulics, drive, sensors, vehicle, .. } =
        machine;
    let positive = [
        ("masses.front_frame_kg", masses.front_frame_kg),
        ("masses.middle_frame_kg", masses.middle_frame_kg),
        ("masses.rear_frame_kg", masses.rear_frame_kg),
        ("masses.arm_kg", masses.arm_kg),
        ("masses.wheel_kg", masses.wheel_kg),
        ("articulation.angle_max_deg", articulation.angle_max_deg),
        ("articulation.rate_max_deg_s", articulation.rate_max_deg_s),
        ("articulation.torque_max_nm", articulation.torque_max_nm),
        ("wheels.radius_m", wheels.radius_m),
        ("wheels.track_m", wheels.track_m),
        ("wheels.torque_max_nm", wheels.torque_max_nm),
        ("arms.pivot_to_cylinder_eye_m", arms.pivot_to_cylinder_eye_m),
        ("arms.pivot_to_rod_eye_m", arms.pivot_to_rod_eye_m),
        ("arms.pivot_to_wheel_m", arms.pivot_to_wheel_m),
        ("arms.closed_length_m", arms.closed_length_m),
        ("arms.stroke_max_m", arms.stroke_max_m),
        ("arms.area_bore_m2", arms.area_bore_m2),
        ("arms.area_rod_m2", arms.area_rod_m2),
        ("arms.force_max_n", arms.force_max_n),
        ("vehicle.wheel_gyration_m", vehicle.wheel_gyration_m),
        ("vehicle.tyre_stiffness_n_m", vehicle.tyre_stiffness_n_m),
        ("vehicle.tyre_damping_n_s_m", vehicle.tyre_damping_n_s_m),
        ("vehicle.tyre_longitudinal_n_m", vehicle.tyre_longitudinal_n_m),
        ("vehicle.tyre_lateral_n_m", vehicle.tyre_lateral_n_m),
        ("vehicle.tyre_relaxation_m", vehicle.tyre_relaxation_m),
        ("vehicle.joint_stiffness_nm", vehicle.joint_stiffness_nm),
        ("hydraulics.speed_full_m_s", hydraulics.speed_full_m_s),
        ("hydraulics.flow_full_m3_s", hydraulics.flow_full_m3_s),
        ("hydraulics.lock_stiffness_n_m", hydraulics.lock_stiffness_n_m),
        ("hydraulics.manual_opening_max", hydraulics.manual_opening_max),
        ("hydraulics.manual_stroke_max_m", hydraulics.manual_stroke_max_m),
        ("drive.speed_full_m_s", drive.speed_full_m_s),
        ("drive.engine_speed_rpm", drive.engine_speed_rpm),
        ("drive.engine_torque_max_nm", drive.engine_torque_max_nm),
        ("drive.engine_power_w", drive.engine_power_w),
        ("drive.speed_time_constant_s", drive.speed_time_constant_s),
        ("sensors.gnss_rate_hz", sensors.gnss_rate_hz),
    ];
    let low = positive.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0));
    low.map(|(key, value)| (key, value, "it must be finite and above zero"))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn refusal(from: &str, to: &str) -> String {
        let text = Machine::builtin_text().replace(from, to);
        assert_ne!(text, Machine::builtin_text(), "{from}");
        Machine::parse(&text, Path::new("m.toml")).unwrap_err().to_string()
    }

    #[test]
    fn no_number_may_be_infinite_or_none_at_all() {
        for bad in ["nan", "inf", "-inf", "1e300"] {
            for (key, from) in [
                ("articulation.front_joint_x_m", "front_joint_x_m = -1.85 "),
                ("sensors.gnss_position_m", "gnss_position_m = 0.005 "),
                ("arms.angle_arm_rad", "angle_arm_rad = 0.2983 "),
            ] {
                let name = key.split_once('.').unwrap().1;
                let error = refusal(from, &format!("{name} = {bad} "));
                assert!(error.starts_with(&format!("m.toml: {key} = ")), "{error}");
            }
            let error = refusal("[0.0, -3.70, -6.05]", &format!("[0.0, {bad}, -6.05]"));
            assert!(error.starts_with("m.toml: wheels.axle_x_m = "), "{error}");
        }
    }

    #[test]
    fn what_divides_or_bounds_is_above_zero() {
        for bad in ["0.0", "-1.0"] {
            let error =
                refusal("engine_torque_max_nm = 1300.0", &format!("engine_torque_max_nm = {bad}"));
            assert!(error.contains("drive.engine_torque_max_nm"), "{error}");
            let error = refusal("force_max_n = 270000.0", &format!("force_max_n = {bad}"));
            assert!(error.contains("arms.force_max_n"), "{error}");
        }
    }

    #[test]
    fn what_has_no_sign_is_no_less_than_zero() {
        for (from, key) in [
            ("friction = 0.7 ", "wheels.friction"),
            ("engine_power_w = 150000.0 ", "drive.engine_power_w"),
            ("lock_damping_n_s_m = 8.5e4 ", "hydraulics.lock_damping_n_s_m"),
            ("return_pressure_pa = 5.0e5 ", "hydraulics.return_pressure_pa"),
            ("front_box_m = [3.4,", "frames.front_box_m"),
            ("kp_per_deg = 0.025 ", "articulation.kp_per_deg"),
            ("gnss_position_m = 0.005 ", "sensors.gnss_position_m"),
            ("circuit_gain_nms = 10000.0 ", "vehicle.circuit_gain_nms"),
        ] {
            let negative = if from.contains('[') {
                from.replace("= [", "= [-")
            } else {
                from.replace("= ", "= -")
            };
            let error = refusal(from, &negative);
            assert!(error.starts_with(&format!("m.toml: {key} = -")), "{error}");
            // A whole number is a number too.
            let error = refusal(from, &negative.replace(".0 ", " "));
            assert!(error.starts_with(&format!("m.toml: {key} = -")), "{error}");
        }
    }

    #[test]
    fn places_lie_on_their_side_and_no_further_than_a_machine_is_long() {
        for (from, to, wanted) in [
            (
                "front_joint_x_m = -1.85",
                "front_joint_x_m = 1.85",
                "articulation.front_joint_x_m = 1.85",
            ),
            ("[0.0, -3.70, -6.05]", "[0.0, 3.70, 6.05]", "wheels.axle_x_m = 3.7"),
            ("[-0.30, 0.0, 3.1]", "[0.30, 0.0, -3.1]", "sensors.gnss_antenna_m = -3.1"),
            (
                "rear_joint_x_m = -4.875",
                "rear_joint_x_m = -1e9",
                "articulation.rear_joint_x_m = -1",
            ),
        ] {
            let error = refusal(from, to);
            assert!(error.starts_with(&format!("m.toml: {wanted}")), "{error}");
        }
    }

    #[test]
    fn a_valves_flow_and_its_cylinders_speed_are_one_number() {
        for (from, to) in [
            ("flow_full_m3_s = 0.0016667 ", "flow_full_m3_s = 0.002 "),
            ("speed_full_m_s = 0.212 ", "speed_full_m_s = 0.2 "),
            ("area_bore_m2 = 0.00785 ", "area_bore_m2 = 0.0095 "),
        ] {
            let error = refusal(from, to);
            assert!(error.starts_with("m.toml: hydraulics.speed_full_m_s = 0.2"), "{error}");
            assert!(error.contains("hydraulics.flow_full_m3_s over arms.area_bore_m2"), "{error}");
        }
        let faster = Machine::builtin_text()
            .replace("flow_full_m3_s = 0.0016667 ", "flow_full_m3_s = 0.002 ")
            .replace("speed_full_m_s = 0.212 ", "speed_full_m_s = 0.255 ");
        assert!(Machine::parse(&faster, Path::new("m.toml")).is_ok());
    }

    #[test]
    fn a_wheel_is_not_too_light_for_its_drive() {
        for (from, to) in [
            ("wheel_kg = 550.0 ", "wheel_kg = 8.0 "),
            ("wheel_gyration_m = 0.6 ", "wheel_gyration_m = 0.05 "),
            ("circuit_gain_nms = 10000.0 ", "circuit_gain_nms = 4.0e5 "),
        ] {
            let error = refusal(from, to);
            assert!(error.starts_with("m.toml: masses.wheel_kg = "), "{error}");
            assert!(error.contains("vehicle.circuit_gain_nms times 0.5 ms"), "{error}");
        }
        let lighter = Machine::builtin_text().replace("wheel_kg = 550.0 ", "wheel_kg = 15.0 ");
        assert!(Machine::parse(&lighter, Path::new("m.toml")).is_ok());
    }

    #[test]
    fn a_cylinder_closes_the_triangle_at_every_stroke() {
        for (from, to) in [
            // Shorter than the eyes come together, longer than they come apart, and only just.
            ("closed_length_m = 0.85", "closed_length_m = 0.45"),
            ("closed_length_m = 0.85", "closed_length_m = 0.714"),
            ("closed_length_m = 0.85", "closed_length_m = 1.8"),
            ("stroke_max_m = 0.50 ", "stroke_max_m = 0.9 "),
            ("stroke_max_m = 0.50 ", "stroke_max_m = 0.855 "),
        ] {
            assert_refused("arms", from, to, "lever of 0.05 m");
        }
        let longer =
            Machine::builtin_text().replace("stroke_max_m = 0.50 ", "stroke_max_m = 0.70 ");
        assert!(Machine::parse(&longer, Path::new("m.toml")).is_ok());
    }

    #[test]
    fn a_cylinder_lifts_its_wheel_at_every_stroke() {
        for (from, to, says) in [
            // Beyond its pivot at the long end and nearly, beyond it at the short end, turned right round.
            ("angle_frame_rad = 0.3370", "angle_frame_rad = 2.0", "0.05 m from the pivot"),
            ("angle_frame_rad = 0.3370", "angle_frame_rad = 1.1", "0.05 m from the pivot"),
            ("angle_frame_rad = 0.3370", "angle_frame_rad = -0.9", "0.05 m from the pivot"),
            ("angle_frame_rad = 0.3370", "angle_frame_rad = 6.6202", "0.05 m from the pivot"),
            ("pivot_to_wheel_m = 1.008", "pivot_to_wheel_m = 1e-12", "at least 0.05 m"),
            ("pivot_to_wheel_m = 1.008", "pivot_to_wheel_m = 60.0", "lift the wheel by 0.01 N"),
        ] {
            assert_refused("arms", from, to, says);
        }
        // A stroke that its triangle allows and its wheel does not.
        let error = refusal("stroke_max_m = 0.50 ", "stroke_max_m = 0.80 ");
        assert!(error.starts_with("m.toml: arms.angle_frame_rad = 0.337 "), "{error}");
        assert!(error.contains("longer than with arms.stroke_max_m"), "{error}");
    }

    #[test]
    fn a_number_above_zero_may_still_be_of_no_use() {
        let (rate, angle) = ("gnss_rate_hz = 8.0 ", "angle_max_deg = 25.0 ");
        for (section, from, to, wanted) in [
            ("sensors", rate, "gnss_rate_hz = 1e-20 ", "it must be at least 0.001 Hz"),
            ("articulation", angle, "angle_max_deg = 90.0 ", "it must be below 90 degrees"),
            ("articulation", angle, "angle_max_deg = 400.0 ", "it must be below 90 degrees"),
        ] {
            assert_refused(section, from, to, wanted);
        }
    }

    /// `from`, a key of a section and its value, refused as `to` with what is `wanted` of it.
    fn assert_refused(section: &str, from: &str, to: &str, wanted: &str) {
        let error = refusal(from, to);
        let key = from.split(' ').next().unwrap();
        assert!(error.starts_with(&format!("m.toml: {section}.{key} = ")), "{error}");
        assert!(error.contains(wanted), "{error}");
    }
}
