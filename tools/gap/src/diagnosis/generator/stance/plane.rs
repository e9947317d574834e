//! The plane that the wheels stand on, and how each of them disagrees with it.

use xt28_machine::{PerWheel, Wheel};

/// One wheel above or on the ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    /// Place in the front frame, m.
    pub(super) at_m: [f64; 2],
    /// Height of the ground under it if it stands, in the front frame, m.
    pub(super) ground_m: f64,
    /// What it presses on the ground, N.
    pub(super) normal_n: f64,
}

/// The ground in the front frame: height = z + x slope_x + y slope_y.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Plane {
    pub(super) z_m: f64,
    pub(super) slope_x: f64,
    pub(super) slope_y: f64,
}

/// A foot that presses more than this is first taken to stand, N.
const STANDING_N: f64 = 3_000.0;
/// Gap that is as wrong as one newton on a wheel in the air, m/N: half a millimetre of stroke and
/// half a kilonewton of load are known alike.
const GAP_PER_FORCE_M_N: f64 = 1.0e-6;
/// Rounds in which feet may change between standing and hanging.
const ROUNDS: usize = 5;

impl Plane {
    /// The plane through the feet that stand; none where fewer than three do, or all in a line.
    ///
    /// A foot that carries nothing may be anywhere above the plane, but not below it.
    pub(super) fn through(feet: &PerWheel<Foot>) -> Option<Self> {
        let mut standing = PerWheel::from_fn(|w| feet[w].normal_n > STANDING_N);
        let mut plane = Self::fit(feet, &standing)?;
        for _ in 0..ROUNDS {
            let next =
                PerWheel::from_fn(|w| plane.gap_m(&feet[w]) < feet[w].normal_n * GAP_PER_FORCE_M_N);
            if next == standing {
                break;
            }
            standing = next;
            plane = Self::fit(feet, &standing)?;
        }
        Some(plane)
    }

    /// Height of the plane at a place, m.
    pub(super) fn height_m(&self, [x, y]: [f64; 2]) -> f64 {
        self.z_m + x * self.slope_x + y * self.slope_y
    }

    /// How far a foot stands over the plane, m.
    fn gap_m(&self, foot: &Foot) -> f64 {
        foot.ground_m - self.height_m(foot.at_m)
    }

    /// How a foot breaks the rule that it either touches or carries nothing, m: its gap if it
    /// stands, its load (as a length) if it hangs. The lesser of the two is zero on a sound machine.
    pub(super) fn error_m(&self, foot: &Foot) -> f64 {
        self.gap_m(foot).min(foot.normal_n * GAP_PER_FORCE_M_N)
    }

    /// Least squares over the feet that stand.
    fn fit(feet: &PerWheel<Foot>, standing: &PerWheel<bool>) -> Option<Self> {
        let (mut a, mut b) = ([[0.0; 3]; 3], [0.0; 3]);
        for w in Wheel::ALL.into_iter().filter(|w| standing[*w]) {
            let Foot { at_m: [x, y], ground_m, .. } = feet[w];
            let row = [1.0, x, y];
            for r in 0..3 {
                b[r] += row[r] * ground_m;
                for c in 0..3 {
                    a[r][c] += row[r] * row[c];
                }
            }
        }
        let [z_m, slope_x, slope_y] = solve3(a, b)?;
        Some(Self { z_m, slope_x, slope_y })
    }
}

/// Cramer's rule; none where the feet stand in a line.
fn solve3(a: [[f64; 3]; 3], b: [f64; 3]) -> Option<[f64; 3]> {
    let det = |m: [[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let d = det(a);
    if d.abs() < 1e-3 {
        return None;
    }
    Some([0, 1, 2].map(|c| {
        let mut m = a;
        for r in 0..3 {
            m[r][c] = b[r];
        }
        det(m) / d
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn feet() -> PerWheel<Foot> {
        PerWheel::from_fn(|w| {
            let (x, y) = ([0.0, -3.7, -6.05][w.axle() as usize], w.side().sign());
            let ground_m = 0.1 + 0.02 * x - 0.03 * y;
            Foot { at_m: [x, y], ground_m, normal_n: 25_000.0 }
        })
    }

    #[test]
    fn six_sound_feet_give_their_plane() {
        let feet = feet();
        let plane = Plane::through(&feet).unwrap();
        assert!((plane.slope_x - 0.02).abs() < 1e-12 && (plane.slope_y + 0.03).abs() < 1e-12);
        assert!(feet.iter().all(|(_, foot)| plane.error_m(foot).abs() < 1e-12));
    }

    #[test]
    fn a_wheel_in_the_air_says_nothing_of_the_ground_but_must_not_press() {
        let mut feet = feet();
        (feet[Wheel::Mr].ground_m, feet[Wheel::Mr].normal_n) = (0.3, 50.0);
        let plane = Plane::through(&feet).unwrap();
        assert!((plane.slope_x - 0.02).abs() < 1e-9);
        assert!((plane.error_m(&feet[Wheel::Mr]) - 50.0e-6).abs() < 1e-9);
        // Its sensor says that it presses: that is what is wrong then.
        feet[Wheel::Mr].normal_n = 4_000.0;
        let plane = Plane::through(&feet).unwrap();
        assert!((plane.error_m(&feet[Wheel::Mr]) - 4.0e-3).abs() < 1e-9);
    }

    #[test]
    fn a_wheel_under_the_ground_that_carries_nothing_is_wrong() {
        let mut feet = feet();
        for w in [Wheel::Mr, Wheel::Ml] {
            (feet[w].ground_m, feet[w].normal_n) = (feet[w].ground_m - 0.010, 0.0);
        }
        let plane = Plane::through(&feet).unwrap();
        assert!(plane.error_m(&feet[Wheel::Mr]) < -5.0e-3);
    }

    #[test]
    fn feet_in_a_line_give_no_plane() {
        let mut feet = feet();
        for w in [Wheel::Fr, Wheel::Mr, Wheel::Br, Wheel::Bl] {
            (feet[w].ground_m, feet[w].normal_n) = (5.0, 0.0);
        }
        assert!(Plane::through(&feet).is_none());
    }
}
