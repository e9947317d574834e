//! Small changes make small differences: whatever number is nudged, every output moves in proportion.

mod smooth_rig;

use core::fmt;

use rayon::prelude::*;
use smooth_rig::QUANTITIES;
use smooth_rig::numbers::{Base, Knob};

/// Shares of a tolerance by which a number is nudged, ten times that beside it. The first is what is asked for.
///
/// Real kinks, none of them a jump: a machine that touches, slips or stops one step sooner answers with another
/// slope from there on; so does one that crosses the edge of a deadband or of a play a step sooner, whose pump or
/// engine begins to run short, whose delay comes to be one more of whole steps. One may lie within reach of the
/// larger nudge. The second is to be out of its reach: smaller nudges are further from a kink and see no
/// less of a jump. An effect that is not there has one side only, and is nudged to that.
const NUDGES: [f64; 2] = [1e-6, 1e-7];
/// Most cases, of a hundred, in which the first nudge may have met a kink.
const KINKED_PER_CENT: usize = 3;
/// How far the differences of both nudges may be from proportion, as a share of the larger one.
const OUT_OF_PROPORTION: f64 = 0.01;

/// What a nudge and ten times as much of it do to each quantity.
fn differences(base: &Base, knob: &Knob, share: f64) -> Vec<Difference> {
    let (one, ten) = (base.nudged(knob, share), base.nudged(knob, 10.0 * share));
    let mut from = 0;
    let of = |&(quantity, count, left_open): &(&'static str, usize, f64)| {
        let (mut apart, mut moved) = (0.0_f64, 0.0_f64);
        for ((one, ten), none) in one.iter().zip(&ten).zip(&base.trace) {
            for k in from..from + count {
                let (by_one, by_ten) = (one[k] - none[k], ten[k] - none[k]);
                apart = apart.max((by_ten - 10.0 * by_one).abs());
                moved = moved.max(by_ten.abs());
            }
        }
        from += count;
        Difference { quantity, left_open, moved, apart }
    };
    QUANTITIES.iter().map(of).collect()
}

fn answer(base: &Base, knob: &Knob) -> Answer {
    let mut answer = Answer { knob: knob.name(), shows: false, kinked: false, wrong: None };
    for share in NUDGES {
        let differences = differences(base, knob, share);
        answer.shows |= differences.iter().any(|difference| difference.moved > 0.0);
        let Some(wrong) = differences.iter().find(|difference| !difference.is_smooth()) else {
            return Answer { wrong: None, ..answer };
        };
        answer.kinked = true;
        answer.wrong = Some(format!("{}, {} by {share:e}: {wrong}", base.name, answer.knob));
    }
    answer
}

/// What a nudge does to a quantity.
struct Difference {
    quantity: &'static str,
    /// What the solver leaves open of it.
    left_open: f64,
    /// The most that the larger nudge moves it by.
    moved: f64,
    /// How far that is from ten times what the smaller one does.
    apart: f64,
}

impl Difference {
    fn is_smooth(&self) -> bool {
        self.apart <= OUT_OF_PROPORTION * self.moved + self.left_open
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {:e} out of {:e}", self.quantity, self.apart, self.moved)
    }
}

/// How a machine answers to a number.
struct Answer {
    knob: String,
    shows: bool,
    /// The first nudge was out of proportion.
    kinked: bool,
    /// What is so at the second as well.
    wrong: Option<String>,
}

/// The differences that a nudge and one ten times as large make are in proportion: there is neither a jump
/// nor noise. And every number shows somewhere.
#[test]
fn outputs_are_smooth_in_every_parameter() {
    let (bases, knobs) = (Base::all(), Knob::all());
    let cases: Vec<(&Base, &Knob)> =
        bases.iter().flat_map(|base| knobs.iter().map(move |knob| (base, knob))).collect();
    let answers: Vec<Answer> = cases.par_iter().map(|(base, knob)| answer(base, knob)).collect();
    let wrong: Vec<&String> = answers.iter().filter_map(|a| a.wrong.as_ref()).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    for knob in knobs.iter().map(Knob::name) {
        assert!(answers.iter().any(|a| a.shows && a.knob == knob), "{knob} shows nowhere");
    }
    let kinked: Vec<_> = answers.iter().filter(|a| a.kinked).map(|a| a.knob.as_str()).collect();
    assert!(100 * kinked.len() < KINKED_PER_CENT * answers.len(), "{kinked:?}");
}
