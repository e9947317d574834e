//! What the analogue sensors read: the state, with the offsets and scales of each sensor.

use xt28_machine::PerWheel;

use crate::effects::WheelEffects;
use crate::{Effects, VehicleState};

/// Readings of the sensors that are wired to the ECUs, in SI units and without noise.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Readings {
    /// Strokes, m.
    pub stroke_m: PerWheel<f64>,
    /// Bore chambers (A), Pa.
    pub pressure_a_pa: PerWheel<f64>,
    /// Rod chambers (B), Pa.
    pub pressure_b_pa: PerWheel<f64>,
    /// Wheel speeds, rad/s; forward > 0.
    pub wheel_speed_rad_s: PerWheel<f64>,
    /// Front and rear articulation joint, rad; left > 0.
    pub joint_rad: [f64; 2],
    /// Pumps 1A 1B 2A 2B, Pa.
    pub pump_pressure_pa: [f64; 4],
}

/// The sensors; exact in the nominal machine.
#[derive(Clone, Debug, Default)]
pub struct Sensors {
    wheels: PerWheel<WheelEffects>,
}

impl Sensors {
    /// Sensors with these effects.
    #[must_use]
    pub const fn new(effects: &Effects) -> Self {
        Self { wheels: effects.wheels }
    }

    /// What they read in this state.
    #[must_use]
    pub fn read(&self, state: &VehicleState) -> Readings {
        let each = |read: fn(&WheelEffects, f64) -> f64, of: &PerWheel<f64>| {
            PerWheel::from_fn(|wheel| read(&self.wheels[wheel], of[wheel]))
        };
        Readings {
            stroke_m: each(
                |e, m| e.stroke_scale.factor * m + e.stroke_bias.bias_m,
                &state.stroke_m,
            ),
            pressure_a_pa: each(
                |e, pa| e.pressure_scale.factor * pa + e.pressure_bias.bias_pa,
                &state.pressure_a_pa,
            ),
            pressure_b_pa: each(|e, pa| e.pressure_scale.rod_factor() * pa, &state.pressure_b_pa),
            wheel_speed_rad_s: each(
                |e, rad_s| e.wheel_speed_scale.factor * rad_s,
                &state.wheel_speed_rad_s,
            ),
            joint_rad: state.joint_rad,
            pump_pressure_pa: state.pump_pressure_pa,
        }
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::{Machine, Wheel};

    use super::*;
    use crate::effects::Overlay;

    fn state() -> VehicleState {
        VehicleState {
            stroke_m: PerWheel::splat(0.2),
            pressure_a_pa: PerWheel::splat(8.0e6),
            pressure_b_pa: PerWheel::splat(5.0e5),
            wheel_speed_rad_s: PerWheel::splat(0.7),
            joint_rad: [0.1, -0.05],
            pump_pressure_pa: [2.5e6, 9.0e6, 2.5e6, 8.0e6],
            ..VehicleState::default()
        }
    }

    fn with(effect: &str) -> (Readings, Readings) {
        let text = format!("[[effect]]\n{effect}");
        let overlay = Overlay::parse(&text, std::path::Path::new("test")).unwrap();
        let read = |effects: &Effects| Sensors::new(effects).read(&state());
        (read(&Effects::default()), read(&overlay.effects(&Machine::xt28()).unwrap()))
    }

    #[test]
    fn exact_sensors_read_the_state_to_the_bit() {
        let (exact, s) = (Sensors::default().read(&state()), state());
        assert_eq!(exact.stroke_m, s.stroke_m);
        assert_eq!(exact.pressure_a_pa, s.pressure_a_pa);
        assert_eq!(exact.wheel_speed_rad_s, s.wheel_speed_rad_s);
    }

    #[test]
    fn a_stroke_bias_shows_on_its_cylinders_stroke_alone() {
        let (exact, biased) = with("name = \"stroke-bias\"\nscope = \"rear\"\nbias_m = -0.01");
        assert!((biased.stroke_m[Wheel::Br] - 0.19).abs() < 1e-12);
        assert_eq!(biased.stroke_m[Wheel::Fr], exact.stroke_m[Wheel::Fr]);
        assert_eq!(Readings { stroke_m: exact.stroke_m, ..biased }, exact);
    }

    #[test]
    fn a_pressure_bias_shows_on_the_bore_chamber_alone() {
        let (exact, biased) = with("name = \"pressure-bias\"\nscope = \"FL\"\nbias_pa = -755e3");
        assert!((biased.pressure_a_pa[Wheel::Fl] - 7.245e6).abs() < 1e-6);
        assert_eq!(biased.pressure_a_pa[Wheel::Fr], exact.pressure_a_pa[Wheel::Fr]);
        assert_eq!(Readings { pressure_a_pa: exact.pressure_a_pa, ..biased }, exact);
    }

    #[test]
    fn a_pressure_scale_shows_on_both_chambers() {
        let (exact, scaled) = with("name = \"pressure-scale\"\nscope = \"left\"\nfactor = 1.1");
        assert!((scaled.pressure_a_pa[Wheel::Ml] - 8.8e6).abs() < 1e-6);
        assert!((scaled.pressure_b_pa[Wheel::Ml] - 5.5e5).abs() < 1e-6);
        assert_eq!(scaled.pressure_b_pa[Wheel::Mr], exact.pressure_b_pa[Wheel::Mr]);
        assert_eq!(scaled.stroke_m, exact.stroke_m);
    }

    #[test]
    fn a_bore_sensor_alone_shows_on_the_bore_alone() {
        let (exact, scaled) =
            with("name = \"pressure-scale\"\nscope = \"ML\"\nfactor = 1.1\nrod_share = 0.0");
        assert!((scaled.pressure_a_pa[Wheel::Ml] - 8.8e6).abs() < 1e-6);
        assert_eq!(Readings { pressure_a_pa: exact.pressure_a_pa, ..scaled }, exact);
    }

    #[test]
    fn scales_of_stroke_and_wheel_speed_show_where_they_are() {
        let (exact, scaled) = with("name = \"stroke-scale\"\nfactor = 0.95");
        assert!(scaled.stroke_m.0.iter().all(|m| (m - 0.19).abs() < 1e-12));
        assert_eq!(Readings { stroke_m: exact.stroke_m, ..scaled }, exact);
        let (exact, scaled) = with("name = \"wheel-speed-scale\"\nscope = \"BL\"\nfactor = 1.2");
        assert!((scaled.wheel_speed_rad_s[Wheel::Bl] - 0.84).abs() < 1e-12);
        for wheel in Wheel::ALL.into_iter().filter(|wheel| *wheel != Wheel::Bl) {
            assert_eq!(scaled.wheel_speed_rad_s[wheel], exact.wheel_speed_rad_s[wheel], "{wheel}");
        }
        assert_eq!(Readings { wheel_speed_rad_s: exact.wheel_speed_rad_s, ..scaled }, exact);
    }
}
