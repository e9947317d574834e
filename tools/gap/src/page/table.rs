//! Tables of the engineer's page.

use core::fmt::Write as _;

use super::caption::{gap_over_noise, how_to_read_shares, share_of, small_gaps};
use super::rows::Rows;
use super::size::each;
use super::svg::escape;
use super::words::{
    by_share, capitalised, elsewhere, is_elsewhere, judged_on, on, percent, short, shrinks,
    without_a_name,
};
use crate::diagnosis::{Cause, Details, Diagnosis, Place, Shrink};

/// Causes listed.
const CAUSES: usize = 6;

/// The gaps that say most, with what each has to do with that of the whole machine.
pub(super) fn places(diagnosis: &Diagnosis) -> String {
    let row = |place: &Place| {
        format!(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td></tr>",
            place.spot.part,
            place.spot.scope,
            escape(&place.spot.residual),
            short(place.gap_over_noise),
            percent(place.share)
        )
    };
    let rows = Rows::of(diagnosis);
    let rest = rows.rest().map_or_else(String::new, |[count, gap, share]| {
        format!(
            "<tr><td colspan=\"3\">{count}</td><td class=\"number\">{gap}</td><td class=\"number\">{share}</td></tr>"
        )
    });
    let rows: String = rows.shown.into_iter().map(row).chain([rest]).collect();
    format!(
        "<table><thead><tr><th>block</th><th>wheels</th><th>signal</th><th>gap over noise</th><th>share</th></tr></thead><tbody>{rows}</tbody></table>\
         {}",
        places_caption(diagnosis)
    )
}

/// What the columns of that table are.
fn places_caption(diagnosis: &Diagnosis) -> String {
    let told = format!(
        "Gap over noise: {}. {}.",
        gap_over_noise(diagnosis),
        capitalised(share_of(diagnosis.share_of))
    );
    let more = [how_to_read_shares(diagnosis.share_of), small_gaps(diagnosis)];
    let all: Vec<&str> = core::iter::once(&*told).chain(more.into_iter().flatten()).collect();
    format!("<p class=\"small\">{}</p>", escape(&all.join(" ")))
}

/// The likeliest causes.
pub(super) fn causes(diagnosis: &Diagnosis) -> String {
    let mut rows = String::new();
    for cause in diagnosis.causes.iter().take(CAUSES) {
        let _ = write!(
            rows,
            "<tr><td class=\"number\">{}</td><td><b>{}</b><br><small>{}</small></td><td>{}</td><td>{}</td><td>{}</td><td class=\"number\">{}</td></tr>",
            percent(cause.probability),
            escape(cause.effect.name),
            escape(cause.effect.meaning),
            wheels(cause),
            parameters(cause),
            escape(&others(cause)),
            cause.shrink.as_ref().map_or_else(|| "–".to_owned(), shrink),
        );
    }
    for (probability, answer) in without_a_name(diagnosis) {
        let sure = percent(probability);
        let _ = write!(
            rows,
            "<tr><td class=\"number\">{sure}</td><td colspan=\"5\">{answer}</td></tr>"
        );
    }
    let is_told = diagnosis.causes.iter().take(CAUSES).any(|cause| cause.shrink.is_some());
    let fitted = is_told && diagnosis.held_out_runs.is_empty();
    let on = if fitted { ", on the runs that were fitted" } else { "" };
    format!(
        "<table><thead><tr><th>probability</th><th>cause</th><th>where</th><th>size (90 % interval)</th><th>not to be told from</th><th>shrinks the gap by{on}</th></tr></thead><tbody>{rows}</tbody></table>"
    )
}

fn wheels(cause: &Cause) -> String {
    if !cause.effect.has_scope() {
        "–".to_owned()
    } else if is_elsewhere(cause) {
        elsewhere(cause)
    } else {
        on(cause.scope)
    }
}

fn parameters(cause: &Cause) -> String {
    let mut out: Vec<String> = each(cause).iter().map(|size| escape(size)).collect();
    if by_share(cause).first().is_some_and(|(scope, _)| *scope != cause.scope) {
        out.push(format!("<small>at {}</small>", on(cause.scope)));
    }
    if let Some(begins) = &cause.begins {
        out.push(format!("begins {}", escape(&begins.to_string())));
    }
    out.join("<br>")
}

fn others(cause: &Cause) -> String {
    let others = cause.alike();
    if others.is_empty() { "–".to_owned() } else { others.join(", ") }
}

fn shrink(by: &Shrink) -> String {
    format!(
        "{} one step<br>{} over 5 s<br>{} over runs",
        shrinks(by.one_step),
        shrinks(by.five_s),
        shrinks(by.run)
    )
}

/// All causes beside no effect and a free model, at every horizon.
pub(super) fn together(diagnosis: &Diagnosis) -> String {
    let Some(together) = &diagnosis.together else { return String::new() };
    let row = |name: &str, by: &Shrink| {
        let cell = |share: f64, [low, high]: [f64; 2]| {
            format!(
                "<td class=\"number\">{} <small>({} to {})</small></td>",
                shrinks(share),
                shrinks(low),
                shrinks(high)
            )
        };
        format!(
            "<tr><td>{}</td>{}{}{}</tr>",
            escape(name),
            cell(by.one_step, by.interval[0]),
            cell(by.five_s, by.interval[1]),
            cell(by.run, by.interval[2])
        )
    };
    let held = match &together.held_out_runs[..] {
        [] => String::new(),
        runs => format!(" Held out: {}.", escape(&runs.join(", "))),
    };
    format!(
        "<h2>How far the gap shrinks on {}</h2>\
         <table><thead><tr><th>in the simulator</th><th>one step ahead</th><th>5 s ahead</th><th>whole runs</th></tr></thead><tbody>\
         <tr><td>no effect</td><td class=\"number\">0 %</td><td class=\"number\">0 %</td><td class=\"number\">0 %</td></tr>{}{}</tbody></table>\
         <p class=\"small\">Shrink is 1 - after / before, of the gap; 90 % intervals by bootstrap.{held}</p>",
        judged_on(&together.held_out_runs),
        row(&together.effects.join(" + "), &together.shrink),
        row("a free model of the errors, without physics", &together.black_box)
    )
}

/// The runs.
pub(super) fn runs(details: &Details) -> String {
    let rows: String = details
        .runs
        .iter()
        .map(|run| {
            format!(
                "<tr><td>{}</td><td class=\"number\">{:.1} s</td><td class=\"number\">{}</td><td>{}</td></tr>",
                escape(&run.name),
                run.seconds,
                run.frames,
                if run.fit { "fitted on" } else { "held out" }
            )
        })
        .collect();
    format!(
        "<table><thead><tr><th>run</th><th>length</th><th>frames</th><th>use</th></tr></thead><tbody>{rows}</tbody></table>"
    )
}
