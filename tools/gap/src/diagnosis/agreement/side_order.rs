//! Whether left and right are in their places: in a bend the wheels outside turn faster, and the joints tell which
//! those are, also where both sides are commanded alike.

use core::fmt;

use xt28_machine::{PerWheel, Side};

use super::COMPARED_EVERY;
use crate::diagnosis::signals::{Signals, moving_mean};

/// Standard deviation of both joints together that is too little of a bend, rad.
const BENDS_RAD: f64 = 0.05;
/// Slower wheels tell little by their speeds' steps, rad/s.
const TURNS_RAD_S: f64 = 0.4;
/// The sides go against the joints where they correlate like this. With left and right in their places most runs do
/// by more than 0.8, and none by less than -0.17: of a machine whose front arms sink, and whose wheels slip.
const AGAINST: f64 = -0.6;
/// Samples that are too few, one in [`COMPARED_EVERY`].
const SAMPLES_MIN: usize = 50;
/// Time over which a speed's steps are evened out, s.
const SMOOTHED_S: f64 = 0.7;

/// Wheels that turn faster inside a bend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideOrder {
    /// Correlation of the lead of the right wheels with the angle of the joints to the left.
    pub along: f64,
}

/// Whether wheels of all `runs` that bend turn faster inside the bend, which those of no machine do.
pub(super) fn side_order(runs: &[Signals]) -> Option<SideOrder> {
    let bends = runs.iter().filter_map(Bends::of);
    let all = bends.reduce(|a, b| Bends {
        angle: a.angle + b.angle,
        both: a.both + b.both,
        lead: a.lead + b.lead,
    })?;
    let along = all.both / (all.angle * all.lead).sqrt();
    (along < AGAINST).then_some(SideOrder { along })
}

/// How the wheels' sides go along with the joints, each about its mean: a side that slips or whose speeds are on
/// another scale leads all along, and no more in a bend.
struct Bends {
    angle: f64,
    both: f64,
    lead: f64,
}

impl Bends {
    /// Of one run; nothing where it hardly bends.
    #[allow(clippy::cast_precision_loss)]
    fn of(s: &Signals) -> Option<Self> {
        let pairs = pairs(s);
        let count = pairs.len();
        let mean = |k: usize| pairs.iter().map(|pair| pair[k]).sum::<f64>() / count as f64;
        let means = [mean(0), mean(1)];
        let product = |i: usize, j: usize| {
            pairs.iter().map(|pair| (pair[i] - means[i]) * (pair[j] - means[j])).sum::<f64>()
        };
        let bends = Self { angle: product(0, 0), both: product(0, 1), lead: product(1, 1) };
        let is_bent = (bends.angle / count as f64).sqrt() > BENDS_RAD && bends.lead > 0.0;
        (count >= SAMPLES_MIN && is_bent).then_some(bends)
    }
}

/// Angle of both joints to the left, rad, and the lead of the right wheels as a share of the mean speed, wherever
/// the machine drives.
fn pairs(s: &Signals) -> Vec<[f64; 2]> {
    let smooth = |samples: &[f64]| moving_mean(samples, SMOOTHED_S);
    let speeds = PerWheel::from_fn(|wheel| smooth(&s.wheel_speed_rad_s[wheel]));
    let joints = s.joint_rad.each_ref().map(|joint| smooth(joint));
    let pair = |i: usize| {
        let of = |side: Side| {
            let own = speeds.iter().filter(|(wheel, _)| wheel.side() == side);
            own.map(|(_, speed)| speed[i]).sum::<f64>() / 3.0
        };
        let [right, left] = [of(Side::Right), of(Side::Left)];
        let mean = 0.5 * (right + left);
        let pair = [joints[0][i] + joints[1][i], (right - left) / mean];
        (mean.abs() > TURNS_RAD_S).then_some(pair)
    };
    (0..s.len).step_by(COMPARED_EVERY).filter_map(pair).collect()
}

impl fmt::Display for SideOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "correlation {:.2}", self.along)
    }
}
