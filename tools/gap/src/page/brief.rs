//! Page one, for who decides: what it is, how sure, where, how much it matters, what to do.

use core::fmt::Write as _;

use xt28_machine::Machine;

use super::ahead::purpose;
use super::caption::{small_gaps, unshrunk};
use super::colour::{AFTER, BEFORE, INK};
use super::headline::{clause, headline, is_open, spot};
use super::machine_view;
use super::size::at_wheels;
use super::sureness::sureness;
use super::svg::{Anchor, Svg, escape};
use super::words::{judged_on, shrinks};
use crate::diagnosis::{Details, Diagnosis, ShareOf, Verdict};

/// Words that one reads at a glance.
const AT_A_GLANCE: usize = 15;

/// The page's body.
pub(super) fn page(machine: &Machine, diagnosis: &Diagnosis, details: &Details) -> String {
    let mut meanings = String::new();
    for cause in diagnosis.stood_by() {
        let _ = write!(
            meanings,
            "<p class=\"meaning\"><b>{}</b>: {}.<br><small>{}</small></p>",
            escape(cause.effect.name),
            escape(cause.effect.meaning),
            escape(&at_wheels(cause))
        );
    }
    let small = small_gaps(diagnosis);
    let small = small.map_or_else(String::new, |why| format!("<p class=\"small\">{why}</p>"));
    format!(
        "{}{meanings}<div class=\"columns\"><div>{}{small}</div><div><h2>How sure</h2>{}<h2>How far the gap shrinks</h2>{}<h2>What to do next</h2>{}</div></div>{}",
        head(diagnosis),
        machine_view::draw(machine, diagnosis),
        sureness(diagnosis),
        shrinking(diagnosis),
        next(diagnosis),
        basis(details)
    )
}

/// The verdict: in a sentence where that is short, else in a clause with the sentence below.
fn head(diagnosis: &Diagnosis) -> String {
    let sentence = headline(diagnosis);
    if sentence.split_whitespace().count() <= AT_A_GLANCE {
        return format!("<h1>{}</h1>", escape(&sentence));
    }
    format!("<h1>{}.</h1><p>{}</p>", escape(&clause(diagnosis)), escape(&sentence))
}

/// What is left of the gap at each horizon.
fn shrinking(diagnosis: &Diagnosis) -> String {
    let single = diagnosis.stood_by().find_map(|cause| cause.shrink);
    let by = diagnosis.together.as_ref().map(|together| together.shrink).or(single);
    let Some(by) = by else {
        return format!("<p>{}</p>", no_shrink(diagnosis));
    };
    let mut svg = Svg::new(350.0, 84.0);
    let rows = [("a tenth of a second", by.one_step), ("5 s", by.five_s), ("whole runs", by.run)];
    for ((name, share), y) in rows.into_iter().zip([0.0, 26.0, 52.0]) {
        let left = (1.0 - share).clamp(0.0, 1.5);
        svg.text([0.0, y + 14.0], name, Anchor::Start, 12.0, INK);
        svg.rect([120.0, y + 2.0], [140.0, 16.0], "#fbe3d2", "none");
        svg.rect(
            [120.0, y + 2.0],
            [140.0 * left, 16.0],
            if left > 1.0 { BEFORE } else { AFTER },
            "none",
        );
        svg.text([350.0, y + 14.0], &format!("{} less", shrinks(share)), Anchor::End, 12.0, INK);
    }
    format!(
        "{}<p class=\"small\">Blue is what is left of the gap between simulator and machine, on {}.</p>{}",
        svg.finish("What is left of the gap at three horizons"),
        judged_on(&diagnosis.held_out_runs),
        unshrunk(diagnosis)
    )
}

/// Why no shrink is drawn.
fn no_shrink(diagnosis: &Diagnosis) -> &'static str {
    let each_is_told = diagnosis.causes.iter().any(|cause| cause.shrink.is_some());
    match diagnosis.verdict {
        _ if diagnosis.share_of == ShareOf::Squares => {
            "Not asked for, or not to be told of these logs."
        }
        Verdict::None if each_is_told => {
            "Nothing is put into the simulator, as no cause stands out of ordinary tolerances. What the \
             likeliest would do is on the next page."
        }
        Verdict::None => {
            "Nothing is put into the simulator, as no cause stands out of ordinary tolerances."
        }
        Verdict::Effect => {
            "No one cause is put into the simulator, as none is likelier than not. What the likeliest \
             would do is on the next page."
        }
        Verdict::Unknown => {
            "Nothing is put into the simulator, as no known effect is believed. What the likeliest would \
             do is on the next page."
        }
    }
}

fn next(diagnosis: &Diagnosis) -> String {
    let mut out = String::new();
    let stood: Vec<&str> = diagnosis.stood_by().map(|cause| cause.effect.name).collect();
    match diagnosis.verdict {
        Verdict::Effect if stood.is_empty() => out.push_str(
            "<p>Drive more: these drives do not tell which cause it is.</p>",
        ),
        Verdict::Effect => {
            let _ = write!(
                out,
                "<p>Put {} into the simulator (the overlay file of this diagnosis does), or mend it on the machine.</p>",
                escape(&stood.join(" and "))
            );
        }
        Verdict::None | Verdict::Unknown if is_open(diagnosis) => {
            out.push_str("<p>Drive more: these drives do not tell which it is.</p>");
        }
        Verdict::None if diagnosis.not_testable.is_empty() => {
            out.push_str("<p>Nothing: simulator and machine agree.</p>");
        }
        Verdict::None => out.push_str(
            "<p>Nothing as far as these drives go; what they cannot show is on the next page, with the drive that would.</p>",
        ),
        Verdict::Unknown => {
            let spot = spot(diagnosis).unwrap_or_else(|| "the gap".to_owned());
            let _ = write!(
                out,
                "<p>Look at what on the machine makes its {}: no known effect explains that.</p>",
                escape(&spot)
            );
        }
    }
    if let Some(next) = &diagnosis.next {
        let _ = write!(
            out,
            "<p>To be surer, drive <b>{}</b>: it {}.</p>",
            escape(&next.manoeuvre),
            escape(&purpose(next, " and "))
        );
    }
    out
}

/// What the answer rests on.
fn basis(details: &Details) -> String {
    let seconds: f64 = details.runs.iter().map(|run| run.seconds).sum();
    let fitted = details.runs.iter().filter(|run| run.fit).count();
    format!(
        "<p class=\"small\">Test drives: {}, {seconds:.0} s in all; fitted: {fitted}, held out to check what was found: {}. What was assumed is on the next page.</p>",
        details.runs.len(),
        details.runs.len() - fitted
    )
}
