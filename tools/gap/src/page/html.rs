//! The file around the two pages.

use xt28_machine::Machine;

use super::headline::clause;
use super::svg::escape;
use super::{brief, engineer};
use crate::diagnosis::{Details, Diagnosis};

const STYLE: &str = "\
@page { size: A4; margin: 14mm }
* { box-sizing: border-box }
body { margin: 0; background: #ffffff; color: #333333; font: 14px/1.45 system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif }
.page { max-width: 790px; margin: 0 auto; padding: 24px 20px }
.page + .page { border-top: 1px solid #c9c9c4; break-before: page }
header { display: flex; justify-content: space-between; color: #66665f; font-size: 12px; border-bottom: 1px solid #c9c9c4; padding-bottom: 6px }
h1 { font-size: 27px; line-height: 1.25; margin: 22px 0 8px }
h2 { font-size: 15px; margin: 22px 0 6px; break-after: avoid }
p { margin: 6px 0 }
.meaning { font-size: 16px }
.small, small { color: #66665f; font-size: 11.5px }
.columns { display: grid; grid-template-columns: 1fr 1fr; gap: 26px; margin-top: 14px }
table { border-collapse: collapse; width: 100%; font-size: 12px; break-inside: avoid }
th { text-align: left; font-weight: 600; border-bottom: 1.5px solid #8a8a84; padding: 3px 8px 3px 0; vertical-align: bottom }
td { border-bottom: 1px solid #e4e4e0; padding: 4px 8px 4px 0; vertical-align: top }
.number { white-space: nowrap; font-variant-numeric: tabular-nums }
ul { margin: 4px 0; padding-left: 18px; font-size: 12.5px }
li { overflow-wrap: anywhere; margin: 2px 0 }
figure { margin: 8px 0; break-inside: avoid }
svg { max-width: 100%; height: auto; display: block; font-family: inherit }
@media print { .page { padding: 0; max-width: none } body { -webkit-print-color-adjust: exact; print-color-adjust: exact } }
";

/// What a report is about.
#[derive(Clone, Debug, Default)]
pub struct Subject {
    /// Name of the machine or the case.
    pub name: String,
    /// Day of the drives, as written.
    pub date: String,
}

/// The report: one file to open, print or send.
#[must_use]
pub fn html(
    subject: &Subject,
    machine: &Machine,
    diagnosis: &Diagnosis,
    details: &Details,
) -> String {
    let header = |page: &str| {
        let (name, date) = (escape(&subject.name), escape(&subject.date));
        let parts: Vec<&str> =
            [name.as_str(), date.as_str()].into_iter().filter(|part| !part.is_empty()).collect();
        format!(
            "<header><span>Simulator against machine · {}</span><span>{page}</span></header>",
            parts.join(" · ")
        )
    };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\"><title>{}</title><style>\n{STYLE}</style></head><body>\n<section class=\"page\">{}{}</section>\n<section class=\"page\">{}{}</section>\n</body></html>\n",
        escape(&clause(diagnosis)),
        header("verdict"),
        brief::page(machine, diagnosis, details),
        header("evidence"),
        engineer::page(diagnosis, details)
    )
}
