//! The ground leaning as a whole: between axes that lie along the ground and the level world.

/// A turn of the ground about the origin.
///
/// Solvers know only the ground's axes, in which terrain and map are level; there gravity leans.
/// What sensors measure against the real world is turned back by this.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tilt {
    /// The ground's axes x, y, z, each in the level world.
    axes: [[f64; 3]; 3],
}

impl Tilt {
    /// Ground that rises by these angles forward and to the left, rad; `None` where it is level.
    ///
    /// Its x axis keeps its heading, so a machine that faces east faces east.
    #[must_use]
    pub fn new(grade_x_rad: f64, grade_y_rad: f64) -> Option<Self> {
        if grade_x_rad == 0.0 && grade_y_rad == 0.0 {
            return None;
        }
        let normal = unit([-grade_x_rad.tan(), -grade_y_rad.tan(), 1.0]);
        let x = [grade_x_rad.cos(), 0.0, grade_x_rad.sin()];
        let y = [
            normal[1] * x[2] - normal[2] * x[1],
            normal[2] * x[0] - normal[0] * x[2],
            normal[0] * x[1] - normal[1] * x[0],
        ];
        Some(Self { axes: [x, y, normal] })
    }

    /// A vector along the ground's axes, in the level world.
    #[must_use]
    pub fn to_world(&self, v: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = self.axes;
        core::array::from_fn(|i| v[0] * x[i] + v[1] * y[i] + v[2] * z[i])
    }

    /// A vector in the level world, along the ground's axes.
    #[must_use]
    pub fn to_ground(&self, v: [f64; 3]) -> [f64; 3] {
        self.axes.map(|axis| axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2])
    }
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
    v.map(|c| c / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn level_ground_has_no_tilt() {
        assert_eq!(Tilt::new(0.0, 0.0), None);
    }

    #[test]
    fn the_ground_rises_where_it_is_said_to() {
        let tilt = Tilt::new(0.1, -0.2).unwrap();
        let forward = tilt.to_world([1.0, 0.0, 0.0]);
        assert!((forward[2].asin() - 0.1).abs() < 1e-12 && forward[1] == 0.0);
        // Straight to the left in plan, on the ground.
        let left = [0.0, 1.0, (-0.2_f64).tan()];
        assert!(tilt.to_ground(left)[2].abs() < 1e-12);
        let back = tilt.to_ground(tilt.to_world([1.0, 2.0, 3.0]));
        assert!(back.iter().zip([1.0, 2.0, 3.0]).all(|(a, b)| (a - b).abs() < 1e-12));
    }
}
