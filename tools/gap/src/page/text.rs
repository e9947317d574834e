//! The verdict in words, for a terminal.

use core::fmt::Write as _;

use super::ahead::{after_that, how_well, purpose};
use super::caption::{how_to_read_shares, share_of, small_gaps};
use super::headline;
use super::rows::Rows;
use super::size::{at_wheels, sizes};
use super::words::{elsewhere, is_elsewhere, judged_on, percent, short, shrink, without_a_name};
use crate::diagnosis::{Cause, Diagnosis, WORTH_TELLING};

/// Causes that are listed in any case.
const LISTED_ANYWAY: usize = 3;

/// Verdict, place, causes, shrink, next test and reservations, a paragraph each.
#[must_use]
pub fn text(diagnosis: &Diagnosis) -> String {
    let mut out = headline(diagnosis) + "\n";
    for cause in diagnosis.stood_by() {
        let (name, meaning) = (cause.effect.name, cause.effect.meaning);
        let _ = writeln!(out, "  {name}: {meaning}; {}", at_wheels(cause));
    }
    places(&mut out, diagnosis);
    causes(&mut out, diagnosis);
    if let Some(together) = &diagnosis.together {
        let _ =
            writeln!(out, "\nhow far the gap shrinks on {}", judged_on(&together.held_out_runs));
        let _ =
            writeln!(out, "  with {}: {}", together.effects.join(" + "), shrink(&together.shrink));
        let _ =
            writeln!(out, "  with a free model without physics: {}", shrink(&together.black_box));
        if !together.held_out_runs.is_empty() {
            let _ = writeln!(out, "  held out: {}", together.held_out_runs.join(", "));
        }
    }
    if let Some(next) = &diagnosis.next {
        let _ = writeln!(
            out,
            "\nwhat to drive next\n  {}: {}{}",
            next.manoeuvre,
            purpose(next, ", "),
            how_well(next)
        );
        if !next.others.is_empty() {
            let _ = writeln!(out, "  {}", after_that(next));
        }
    }
    if !diagnosis.not_testable.is_empty() {
        let _ = writeln!(
            out,
            "\nnot testable with these logs, or not at every wheel (`xt28 gap drive` writes each drive)"
        );
        for one in &diagnosis.not_testable {
            let part = if one.in_part { "not at every wheel: " } else { "" };
            let (lacks, remedy) = (&one.lacks, one.remedy());
            let _ = writeln!(out, "  {:<22} {part}{lacks}; {remedy}", one.effect.name);
        }
    }
    if !diagnosis.notes.is_empty() {
        let _ = writeln!(out, "\nnotes");
        for note in &diagnosis.notes {
            let _ = writeln!(out, "  {note}");
        }
    }
    let _ = writeln!(out, "\n{:.1} s", diagnosis.seconds);
    out
}

fn places(out: &mut String, diagnosis: &Diagnosis) {
    if diagnosis.places.is_empty() {
        return;
    }
    let _ = writeln!(
        out,
        "\n{:<19} {:<6} {:<41} {:>14} {:>10}",
        "where", "wheels", "signal", "gap over noise", "share"
    );
    let rows = Rows::of(diagnosis);
    for place in &rows.shown {
        let _ = writeln!(
            out,
            "{:<19} {:<6} {:<41} {:>14} {:>10}",
            place.spot.part,
            place.spot.scope,
            place.spot.residual,
            short(place.gap_over_noise),
            percent(place.share)
        );
    }
    if let Some([count, gap, share]) = rows.rest() {
        let _ = writeln!(out, "{count:<68} {gap:>14} {share:>10}");
    }
    let _ = writeln!(out, "  {}", share_of(diagnosis.share_of));
    for sentence in
        [how_to_read_shares(diagnosis.share_of), small_gaps(diagnosis)].into_iter().flatten()
    {
        let _ = writeln!(out, "  {sentence}");
    }
}

fn causes(out: &mut String, diagnosis: &Diagnosis) {
    let _ = writeln!(out, "\n{:>11}  cause", "probability");
    let listed =
        |(i, cause): &(usize, &Cause)| *i < LISTED_ANYWAY || cause.probability > WORTH_TELLING;
    for (_, cause) in diagnosis.causes.iter().enumerate().filter(listed) {
        let wheels = if cause.effect.has_scope() { cause.scope.to_string() } else { String::new() };
        let _ = writeln!(
            out,
            "{:>11}  {:<22} {wheels:<6} {}",
            percent(cause.probability),
            cause.effect.name,
            sizes(cause)
        );
        if !cause.alike().is_empty() {
            let _ = writeln!(out, "{:>11}  not to be told from {}", "", cause.alike().join(", "));
        }
        if is_elsewhere(cause) {
            let _ = writeln!(out, "{:>11}  wheels not told apart: {}", "", elsewhere(cause));
        }
        if let Some(begins) = &cause.begins {
            let _ = writeln!(out, "{:>11}  begins {begins}", "");
        }
        if let Some(by) = &cause.shrink {
            let fitted = diagnosis.held_out_runs.is_empty();
            let on = if fitted { " (on the runs that were fitted)" } else { "" };
            let _ = writeln!(out, "{:>11}  shrinks the gap by {}{on}", "", shrink(by));
        }
    }
    for (probability, answer) in without_a_name(diagnosis) {
        let _ = writeln!(out, "{:>11}  {answer}", percent(probability));
    }
}
