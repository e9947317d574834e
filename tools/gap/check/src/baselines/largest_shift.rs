//! Fit every parameter at once; the one that moved by most tolerances is to blame.

use std::collections::BTreeMap;

use xt28_gap::diagnosis::{Evidence, Inquiry, Knob, Verdict};
use xt28_machine::{PerWheel, Wheel};
use xt28_sim::effects::{Effect, Scope};

use super::{fitted, nearest_scope};
use crate::reply::{Named, Reply};

/// Shift from which on it is called an effect, tolerances: the common three sigma.
const SHIFT_MIN: f64 = 3.0;

pub(super) fn reply(inquiry: &Inquiry) -> Reply {
    let runs = fitted(inquiry);
    let known = |knob: &Knob| match knob {
        Knob::Effect(effect, ..) => inquiry.catalogue.contains(effect),
        Knob::Machine(_) => true,
    };
    let knobs: Vec<Knob> = Knob::all().into_iter().filter(known).collect();
    let evidence = Evidence::new(&runs, &inquiry.machine, inquiry.believed.clone(), &knobs);
    let mut shifts: BTreeMap<&str, (&'static Effect, PerWheel<f64>)> = BTreeMap::new();
    for (knob, shift) in evidence.shifts(&inquiry.believed) {
        if let Knob::Effect(effect, _, scope) = knob {
            let (_, wheels) = shifts.entry(effect.name).or_insert((effect, PerWheel::splat(0.0)));
            for wheel in scope.wheels() {
                wheels[wheel] = wheels[wheel].max(shift.abs());
            }
        }
    }
    let mut found: Vec<(f64, Named)> = shifts.into_values().map(named).collect();
    found.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    let alarm = found.first().is_some_and(|(shift, _)| *shift > SHIFT_MIN);
    let mut causes: Vec<Named> = found.into_iter().take(10).map(|(_, named)| named).collect();
    if let Some(first) = causes.first_mut() {
        first.stands = alarm;
    }
    let verdict = if alarm { Verdict::Effect } else { Verdict::None };
    Reply { verdict, causes, none: None, unknown: None }
}

/// The effect on the wheels that moved at least half as far as the one that moved most.
fn named((effect, shifts): (&'static Effect, PerWheel<f64>)) -> (f64, Named) {
    let most = Wheel::ALL.iter().map(|&wheel| shifts[wheel]).fold(0.0, f64::max);
    let scope = if effect.has_scope() {
        nearest_scope(|wheel| shifts[wheel] > 0.5 * most)
    } else {
        Scope::All
    };
    (most, Named::without_probability(effect, scope))
}
