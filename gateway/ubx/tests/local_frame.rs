//! The local frame against known places and itself.

use proptest::prelude::*;
use xt28_ubx::{Enu, Geodetic, LocalFrame};

#[test]
fn a_degree_of_latitude_is_as_long_as_the_meridian_says() {
    // The meridian radius at 59.8 N is a(1-e²)/(1-e² sin²)^1.5 = 6 383 349.1 m.
    let frame = LocalFrame::new(Geodetic::from_degrees(59.8, 17.9, 0.0));
    let step_deg = 1e-4_f64;
    let north = frame.to_local(Geodetic::from_degrees(59.8 + step_deg, 17.9, 0.0));
    let e2 = 6.694_379_990_14e-3_f64;
    let s = 59.8_f64.to_radians().sin();
    let radius = 6_378_137.0 * (1.0 - e2) / (1.0 - e2 * s * s).powf(1.5);
    assert!((north.north_m - step_deg.to_radians() * radius).abs() < 1e-4, "{north:?}");
    assert!(north.east_m.abs() < 1e-9);
}

#[test]
fn east_is_east_and_up_is_up() {
    let frame = LocalFrame::default();
    let origin = frame.origin();
    let east = frame.to_local(Geodetic { longitude_rad: origin.longitude_rad + 1e-6, ..origin });
    assert!(east.east_m > 3.0 && east.north_m.abs() < 1e-3, "{east:?}");
    let up = frame.to_local(Geodetic { height_m: origin.height_m + 2.0, ..origin });
    assert!((up.up_m - 2.0).abs() < 1e-8, "{up:?}");
}

proptest! {
    #[test]
    fn a_round_trip_is_exact_to_micrometres(
        latitude in -89.0..89.0_f64, longitude in -180.0..180.0_f64,
        east_m in -1e5..1e5_f64, north_m in -1e5..1e5_f64, up_m in -100.0..1000.0_f64,
    ) {
        let frame = LocalFrame::new(Geodetic::from_degrees(latitude, longitude, 20.0));
        let there = Enu { east_m, north_m, up_m };
        let back = frame.to_local(frame.to_geodetic(there));
        prop_assert!((back.east_m - east_m).abs() < 1e-6);
        prop_assert!((back.north_m - north_m).abs() < 1e-6);
        prop_assert!((back.up_m - up_m).abs() < 1e-6);
    }
}
