//! Nothing jumps: a search goes where outputs change most as a number moves, and closer there.

mod smooth_rig;

use rayon::prelude::*;
use smooth_rig::numbers::{Base, Knob};
use smooth_rig::{QUANTITIES, Trace};

/// How far the number goes, as a share of its tolerance.
const FAR: f64 = 0.1;
/// Into how many parts the stretch in question is cut each time, and how many times.
const CUTS: (u32, u32) = (4, 6);
/// The most that the last of 4096 parts may keep of what changes over the whole way. A real kink (a wheel that
/// lands, slips or stops one step sooner, a play that is crossed, a pump that begins to run short) leaves up to
/// 0.005, where proportion leaves 0.0003; jumps that were found left 0.1 and more.
const LEFT: f64 = 0.02;

/// What changes from one drive to another, the most of each quantity.
fn changes(one: &Trace, other: &Trace) -> [f64; QUANTITIES.len()] {
    let mut from = 0;
    QUANTITIES.map(|(_, count, _)| {
        let numbers = from..from + count;
        from += count;
        let pairs = one.iter().zip(other);
        let apart =
            pairs.flat_map(|(one, other)| numbers.clone().map(|k| (one[k] - other[k]).abs()));
        apart.fold(0.0, f64::max)
    })
}

/// A stretch of a number's way: where it begins and how long it is, in tolerances, and the drives at its ends.
struct Stretch {
    from: f64,
    width: f64,
    ends: [Trace; 2],
}

impl Stretch {
    /// Its parts, in order, each with what changes over it.
    fn parts(self, base: &Base, knob: &Knob) -> Vec<(Self, [f64; QUANTITIES.len()])> {
        let Self { from, width, ends: [first, last] } = self;
        let width = width / f64::from(CUTS.0);
        let at = |i: u32| from + f64::from(i) * width;
        let mut parts = Vec::new();
        let mut before = first;
        for i in 0..CUTS.0 {
            let ends_here = i + 1 == CUTS.0;
            let after = if ends_here { last.clone() } else { base.nudged(knob, at(i + 1)) };
            let changes = changes(&before, &after);
            let ends = [core::mem::replace(&mut before, after.clone()), after];
            parts.push((Self { from: at(i), width, ends }, changes));
        }
        parts
    }
}

/// Looks ever closer where outputs change most; what is left of the change there, as a share of that over
/// the whole way, and of which quantity.
fn jump(base: &Base, knob: &Knob) -> (f64, &'static str) {
    let ends = [base.trace.clone(), base.nudged(knob, FAR)];
    let mut stretch = Stretch { from: 0.0, width: FAR, ends };
    let mut whole = QUANTITIES.map(|(.., left_open)| left_open / LEFT);
    let mut most = (0.0, "");
    for cut in 0..CUTS.1 {
        let parts = stretch.parts(base, knob);
        if cut == 0 {
            let all = parts.iter().flat_map(|(_, changes)| changes.iter().enumerate());
            all.for_each(|(q, change)| whole[q] += change);
        }
        let share = |changes: &[f64; QUANTITIES.len()]| {
            let shares = changes.iter().zip(&whole).zip(QUANTITIES);
            let shares = shares.map(|((change, whole), (quantity, ..))| (change / whole, quantity));
            shares.max_by(|a, b| a.0.total_cmp(&b.0)).expect("there are quantities")
        };
        let parts = parts.into_iter().map(|(part, changes)| (share(&changes), part));
        (most, stretch) = parts.max_by(|a, b| a.0.0.total_cmp(&b.0.0)).expect("there are parts");
    }
    most
}

/// On the way to a tenth of a tolerance no output jumps. A tiny nudge is seldom just where one does; this search
/// goes there. Each number on another three of the machines and grounds: a jump of its own law is on every one,
/// and one of the solver is there whatever is nudged.
#[test]
fn outputs_jump_nowhere_on_the_way() {
    let (bases, knobs) = (Base::all(), Knob::all());
    let cases: Vec<(&Base, &Knob)> = knobs
        .iter()
        .enumerate()
        .flat_map(|(i, knob)| (0..3).map(move |k| (5 * k + i, knob)))
        .map(|(i, knob)| (&bases[i % bases.len()], knob))
        .collect();
    let found = cases.par_iter().map(|(base, knob)| {
        let (left, quantity) = jump(base, knob);
        (left, format!("{}, {}: {quantity}, {left} left", base.name, knob.name()))
    });
    let mut found: Vec<(f64, String)> = found.collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let jumps: Vec<&String> =
        found.iter().filter(|(left, _)| *left > LEFT).map(|(_, what)| what).collect();
    assert!(jumps.is_empty(), "{jumps:#?}");
}
