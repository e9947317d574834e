//! The ground-pressure controller: of all ways to carry the same weight, the evenest.
//!
//! Weight and centre of mass fix three sums over the wheel forces: their total and their moments
//! about two axes. Three more degrees of freedom only shift load between wheels. Among all forces
//! with the measured sums, the one with the least spread is linear in the wheel's place,
//! F = a + b x + c y: the orthogonal projection of the measured forces on 1, x and y. A machine with
//! its weight in front thus keeps more on its front wheels, as it must.

use xt28_machine::{Axle, Linkage, Machine, PerWheel, Pointing};

/// Where the wheels stand, for any strokes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GroundPressure {
    linkage: Linkage,
    pivot_x_m: [f64; 3],
    forward: [f64; 3],
    half_track_m: f64,
}

/// Stroke at which the machine file gives the axles' places, m.
const REFERENCE_STROKE_M: f64 = 0.25;

impl GroundPressure {
    pub(crate) fn new(machine: &Machine) -> Self {
        let linkage = machine.linkage();
        let reach_m = linkage.at_stroke(REFERENCE_STROKE_M).reach_m;
        let front = match machine.arms.front_arms_point {
            Pointing::Forward => 1.0,
            Pointing::Backward => -1.0,
        };
        let forward = [front, -front, -front];
        let axle_x_m = machine.wheels.axle_x_m;
        Self {
            linkage,
            pivot_x_m: [0, 1, 2].map(|axle| axle_x_m[axle] - forward[axle] * reach_m),
            forward,
            half_track_m: machine.wheels.track_m / 2.0,
        }
    }

    /// Each wheel's place `[x, y]` in the straight machine, m. Articulation is not on this ECU's
    /// pins; at 25 degrees it moves a wheel by a seventh of the wheelbase.
    pub(crate) fn places(&self, stroke_m: &PerWheel<f64>) -> PerWheel<[f64; 2]> {
        PerWheel::from_fn(|wheel| {
            let axle = match wheel.axle() {
                Axle::Front => 0,
                Axle::Middle => 1,
                Axle::Rear => 2,
            };
            let reach_m = self.linkage.at_stroke(stroke_m[wheel]).reach_m;
            let x_m = self.pivot_x_m[axle] + self.forward[axle] * reach_m;
            [x_m, self.half_track_m * wheel.side().sign()]
        })
    }
}

/// The evenest forces with the total and the moments of `force_n`, wheels at `places`.
///
/// Wheels that all stand on one line leave a moment open: then `force_n` itself is returned.
pub(crate) fn even(places: &PerWheel<[f64; 2]>, force_n: &PerWheel<f64>) -> PerWheel<f64> {
    let mean = |axis: usize| places.map(|place| place[axis]).mean();
    let centre = [mean(0), mean(1)];
    let from_centre = places.map(|[x, y]| [x - centre[0], y - centre[1]]);
    let moment = |axis: usize| PerWheel::from_fn(|w| from_centre[w][axis] * force_n[w]).sum();
    let second = |a: usize, b: usize| from_centre.map(|place| place[a] * place[b]).sum();
    let (xx, xy, yy) = (second(0, 0), second(0, 1), second(1, 1));
    let determinant = xx * yy - xy * xy;
    if determinant <= f64::EPSILON * xx * yy || !determinant.is_finite() {
        return *force_n;
    }
    let (mx, my) = (moment(0), moment(1));
    let slope_x = (mx * yy - my * xy) / determinant;
    let slope_y = (my * xx - mx * xy) / determinant;
    let mean_n = force_n.mean();
    from_centre.map(|[x, y]| mean_n + slope_x * x + slope_y * y)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use xt28_machine::Wheel;

    use super::*;

    fn level() -> PerWheel<[f64; 2]> {
        GroundPressure::new(&Machine::xt28()).places(&PerWheel::splat(0.25))
    }

    fn moments(places: &PerWheel<[f64; 2]>, force_n: &PerWheel<f64>) -> [f64; 3] {
        let moment = |axis: usize| PerWheel::from_fn(|w| places[w][axis] * force_n[w]).sum();
        [force_n.sum(), moment(0), moment(1)]
    }

    fn spread(force_n: &PerWheel<f64>) -> f64 {
        let mean_n = force_n.mean();
        force_n.map(|f| (f - mean_n).powi(2)).sum()
    }

    #[test]
    fn the_wheels_stand_where_the_machine_file_has_them() {
        let places = level();
        for (wheel, x_m) in [(Wheel::Fr, 0.0), (Wheel::Ml, -3.7), (Wheel::Br, -6.05)] {
            assert!((places[wheel][0] - x_m).abs() < 1e-12, "{wheel}");
            assert!((places[wheel][1] - 1.175 * wheel.side().sign()).abs() < 1e-12);
        }
        // Extended arms swing down and in: the front wheels back, the others ahead.
        let high = GroundPressure::new(&Machine::xt28()).places(&PerWheel::splat(0.5));
        assert!(high[Wheel::Fr][0] < -0.2 && high[Wheel::Mr][0] > -3.5);
    }

    /// 34 % of the wheelbase (facts 1.2), worked out by hand: F = W/6 - 0.03206 W/m (x - 3.25 m).
    #[test]
    fn a_front_heavy_machine_keeps_its_weight_in_front() {
        let weight_n = 166.8e3;
        // On the front and rear axle alone, as a see-saw.
        let rear_n = weight_n * 0.34 / 2.0;
        let front_n = weight_n / 2.0 - rear_n;
        let force_n = PerWheel([front_n, front_n, 0.0, 0.0, rear_n, rear_n]);
        let even_n = even(&level(), &force_n);
        for (wheel, share) in [(Wheel::Fr, 0.2709), (Wheel::Ml, 0.1522), (Wheel::Br, 0.0769)] {
            assert!((even_n[wheel] / weight_n - share).abs() < 1e-4, "{wheel}: {even_n:?}");
        }
    }

    #[test]
    fn wheels_on_a_line_change_nothing() {
        let places = PerWheel::from_fn(|w| [w.index() as f64, 0.0]);
        let force_n = PerWheel([1.0, 5.0, 2.0, 8.0, 3.0, 1.0]);
        assert_eq!(even(&places, &force_n), force_n);
    }

    proptest! {
        #[test]
        fn nothing_carries_the_same_weight_more_evenly(
            stroke_m in prop::array::uniform6(0.0..0.5_f64),
            force_n in prop::array::uniform6(-10e3..120e3_f64),
            shift_n in prop::array::uniform6(-20e3..20e3_f64),
        ) {
            let places = GroundPressure::new(&Machine::xt28()).places(&PerWheel(stroke_m));
            let force_n = PerWheel(force_n);
            let even_n = even(&places, &force_n);
            for (a, b) in moments(&places, &even_n).into_iter().zip(moments(&places, &force_n)) {
                prop_assert!((a - b).abs() < 1e-6 * 700e3, "{a} {b}");
            }
            prop_assert!(spread(&even_n) <= spread(&force_n) + 1e-3);
            // Any other force with the same sums: this one plus what `even` takes off a shift.
            let shift_n = PerWheel(shift_n);
            let without = even(&places, &shift_n);
            let other = PerWheel::from_fn(|w| even_n[w] + shift_n[w] - without[w]);
            prop_assert!(spread(&even_n) <= spread(&other) + 1e-3);
            // What is even stays as it is.
            let again = even(&places, &even_n);
            prop_assert!(Wheel::ALL.into_iter().all(|w| (again[w] - even_n[w]).abs() < 1e-6));
        }
    }
}
