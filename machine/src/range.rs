//! What the numbers of a machine file can be, beyond their types.

use crate::Machine;

/// Nothing of a machine is further from zero, whatever its unit (assumed): the stiffest is 8e6 N/m.
const MAGNITUDE_MAX: f64 = 1e9;

/// The first number of a machine file's `text` that no machine can have, with section and key.
pub(crate) fn beyond_all_machines(text: &str) -> Option<(String, f64)> {
    let sections: toml::Table = toml::from_str(text).ok()?;
    sections.iter().find_map(|(section, keys)| {
        let of_key = |(key, value)| Some((format!("{section}.{key}"), beyond(value)?));
        keys.as_table()?.iter().find_map(of_key)
    })
}

/// The first such number in a value or a list of them.
fn beyond(value: &toml::Value) -> Option<f64> {
    match value {
        toml::Value::Float(x) => (x.is_nan() || x.abs() > MAGNITUDE_MAX).then_some(*x),
        toml::Value::Array(list) => list.iter().find_map(beyond),
        _ => None,
    }
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
        ("hydraulics.lock_stiffness_n_m", hydraulics.lock_stiffness_n_m),
        ("drive.speed_full_m_s", drive.speed_full_m_s),
        ("drive.engine_speed_rpm", drive.engine_speed_rpm),
        ("drive.engine_torque_max_nm", drive.engine_torque_max_nm),
        ("drive.engine_power_w", drive.engine_power_w),
        ("drive.speed_time_constant_s", drive.speed_time_constant_s),
        ("sensors.gnss_rate_hz", sensors.gnss_rate_hz),
    ];
    // A machine may stand on ice.
    let zero_or_more = [
        ("wheels.friction", wheels.friction),
        ("wheels.rolling_resistance", wheels.rolling_resistance),
    ];
    let above = positive.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0));
    let above = above.map(|(key, value)| (key, value, "it must be finite and above zero"));
    above.or_else(|| {
        let low = zero_or_more.into_iter().find(|(_, value)| *value < 0.0);
        low.map(|(key, value)| (key, value, "it must be at least zero"))
    })
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
        let error = refusal("friction = 0.7 ", "friction = -0.7 ");
        assert!(error.contains("wheels.friction"), "{error}");
    }
}
