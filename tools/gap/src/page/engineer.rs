//! Page two, for who mends: where in the machine's doings the gap lies, what explains it, and why one
//! should believe that.

use core::fmt::Write as _;

use super::colour::{AFTER, BEFORE, INK};
use super::{assumptions, caption, heat, horizon, strip, table, trace};
use crate::diagnosis::details::Trace;
use crate::diagnosis::{Details, Diagnosis};

/// The page's body.
pub(super) fn page(diagnosis: &Diagnosis, details: &Details) -> String {
    let mut out = String::new();
    let lines = key(details.has_after);
    let _ = write!(
        out,
        "<h2>Where: gap of each block by what the machine did</h2>{}\
         <p class=\"small\">Each block of the simulator driven with measured inputs; root mean square of its error in noise floors (1 is what two models of a sound machine differ), before tolerances are taken out. Blank: did not happen.</p>",
        heat::draw(details)
    );
    let _ = write!(
        out,
        "<h2>Where: gap of each block over the time of each run</h2>{}<p class=\"small\">The same colours, every two seconds{}.</p>",
        strip::draw(details),
        if details.runs.iter().any(|run| run.since_s > 0.0) {
            "; the line is where the causes begin"
        } else {
            ""
        }
    );
    if !diagnosis.places.is_empty() {
        let _ = write!(out, "<h2>Where: the gaps that say most</h2>{}", table::places(diagnosis));
    }
    let _ = write!(
        out,
        "<h2>What: causes</h2>{}{}{}",
        table::causes(diagnosis),
        caption::unshrunk(diagnosis),
        table::together(diagnosis)
    );
    let _ = write!(
        out,
        "<h2>How fast it parts: error against horizon</h2>{}<p class=\"small\">{lines} How far a block's error moves within that time. First the places that the verdict is about, then what moves most.</p>",
        horizon::draw(details)
    );
    let held = if details.traces.iter().any(|trace| trace.fit) {
        "no run was held out, so these were fitted"
    } else {
        "runs that were not fitted"
    };
    let _ = write!(
        out,
        "<h2>Traces: {held}</h2><p class=\"small\">{lines} Measured: <span style=\"color:{INK}\">▬ grey</span>.</p>"
    );
    let figures = |out: &mut String, traces: &[Trace]| {
        for one in traces {
            let _ = write!(out, "<figure>{}</figure>", trace::draw(one, details.has_after));
        }
    };
    figures(&mut out, &details.traces);
    if !details.whole.is_empty() {
        out.push_str(
            "<h2>The whole machine, foretold over a run</h2><p class=\"small\">From its first measured \
             state on its own commands alone, as the shrink over a run is judged: errors add up.</p>",
        );
        figures(&mut out, &details.whole);
    }
    let _ = write!(
        out,
        "<div class=\"columns\"><div><h2>What was assumed</h2>{}</div><div><h2>What would settle it</h2>{}</div></div><h2>Runs</h2>{}<h2>Faults of the logs</h2>{}<p class=\"small\">Diagnosed in {:.1} s.</p>",
        assumptions::assumed(diagnosis, details),
        assumptions::settles(diagnosis),
        table::runs(details),
        assumptions::faults(details),
        diagnosis.seconds
    );
    out
}

fn key(has_after: bool) -> String {
    let before = format!("<span style=\"color:{BEFORE}\">▬ before</span>");
    if has_after {
        format!("{before}, <span style=\"color:{AFTER}\">╍ with the causes put in</span>.")
    } else {
        format!("{before}; there are no causes to put in.")
    }
}
