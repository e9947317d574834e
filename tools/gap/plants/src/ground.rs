//! The yard of a foreign machine: a plane that leans, with a ramp on it where the script has one.

use std::sync::Arc;

use xt28_sim::terrain::{Extent, Grid, Plane};
use xt28_sim::{Ramp, Terrain};

/// Ground that rises by `slope_rad` ahead and to the left of where the machine starts.
pub(crate) fn ground(slope_rad: [f64; 2], ramp: Option<&Ramp>) -> Terrain {
    let plane = Plane { height_m: 0.0, rise: slope_rad.map(f64::tan) };
    let Some(ramp) = ramp else { return Terrain::Plane(plane) };
    let height_m = |x_m: f64, y_m: f64| plane.at_m(x_m, y_m) + ramp.height_m(x_m, y_m);
    Terrain::Grid(Arc::new(Grid::on_slope(Extent::default(), plane.rise, height_m)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_stands_on_the_slope_that_it_is_on() {
        let ramp = Ramp { x_m: [4.0, 7.0, 8.5, 11.5], height_m: 0.3, y_min_m: -1.9, y_max_m: -0.5 };
        let slope_rad = [0.03, -0.02];
        let with = ground(slope_rad, Some(&ramp));
        let without = ground(slope_rad, None);
        let rises_m = |x_m: f64, y_m: f64| with.height_m(x_m, y_m) - without.height_m(x_m, y_m);
        assert!((rises_m(7.7, -1.2) - 0.3).abs() < 1e-6);
        assert!(rises_m(7.7, 1.2).abs() < 1e-6);
        assert!(
            (without.height_m(10.0, 5.0) - 10.0 * 0.03_f64.tan() + 5.0 * 0.02_f64.tan()).abs()
                < 1e-12
        );
    }
}
