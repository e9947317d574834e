//! What an examination comes to: a text to read and JSON for scripts.

use std::fmt::Write;

use serde_json::{Value, json};
use xt28_gap::diagnosis::{Shrink, Verdict};

use crate::baselines::BASELINES;
use crate::coverage::covered;
use crate::examination::{Examination, Judged, Refused};
use crate::reply::Reply;
use crate::score::{
    Bin, Score, Scores, Statement, Suited, error_by_chance, reliability, scores, statements, suited,
};
use crate::sweep::{Withheld, sweep_scores};
use crate::truth::{Kind, Truth};

/// Scores of one who replied.
struct Column {
    name: &'static str,
    scores: Scores,
}

/// An examination judged.
pub struct Report {
    seal: String,
    salt: String,
    cases: Vec<Judged>,
    columns: Vec<Column>,
    /// Rows that only the diagnosis has.
    own: Scores,
    statements: Vec<Statement>,
    /// The scales that would suit these cases best, beside those in use.
    scales: Vec<Suited>,
    sweep: Vec<Withheld>,
    refused: Vec<Refused>,
}

impl Report {
    /// Judges `cases`, which `examination` was about.
    #[must_use]
    pub fn new(examination: &Examination, cases: Vec<Judged>) -> Self {
        let replies = cases.iter().map(|case| case.examined.replies.len()).min().unwrap_or(0);
        let names = std::iter::once("diagnosis").chain(BASELINES.iter().map(|b| b.name));
        let column = |(i, name): (usize, &'static str)| {
            let pairs: Vec<_> = cases.iter().map(|c| (&c.truth, &c.examined.replies[i])).collect();
            Column { name, scores: scores(&pairs) }
        };
        let columns = names.take(replies).enumerate().map(column).collect();
        let said = cases.iter().flat_map(|c| statements(&c.truth, &c.examined.replies[0]));
        let statements = said.collect();
        let own = own_scores(&cases);
        let (seal, salt) = (examination.seal().to_string(), examination.salt());
        let outcome = |case: &Judged| (case.examined.diagnosis.grounds, case.truth.kind);
        let scales = suited(&cases.iter().map(outcome).collect::<Vec<_>>());
        let (sweep, refused) = (Vec::new(), Vec::new());
        Self { seal, salt, cases, columns, own, statements, scales, sweep, refused }
    }

    /// The same with what came of withholding each effect.
    #[must_use]
    pub fn with_sweep(self, sweep: Vec<Withheld>) -> Self {
        Self { sweep, ..self }
    }

    /// The same with the cases that could not be diagnosed.
    #[must_use]
    pub fn with_refused(self, refused: Vec<Refused>) -> Self {
        Self { refused, ..self }
    }

    /// The scores of the diagnosis by name, as in the table.
    #[must_use]
    pub fn score(&self, name: &str) -> Option<Score> {
        let all = self.columns.first()?.scores.iter().chain(&self.own);
        all.clone().find(|(other, _)| *other == name).map(|(_, score)| *score)
    }

    /// The reliability curve of the diagnosis.
    #[must_use]
    pub fn reliability(&self) -> Vec<Bin> {
        reliability(&self.statements)
    }

    /// The table of scores, the reliability curve, and the cases that came out wrong.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a string never fails.
        let _ = self.write(&mut text);
        text
    }

    fn write(&self, to: &mut String) -> std::fmt::Result {
        let kinds = [Kind::Null, Kind::Single, Kind::Pair, Kind::Unknown].map(|kind| {
            let count = self.cases.iter().filter(|case| case.truth.kind == kind).count();
            format!("{count} {kind}")
        });
        writeln!(to, "{} cases: {}", self.cases.len(), kinds.join(", "))?;
        writeln!(to, "seal {}\nopened with salt {}\n", self.seal, self.salt)?;
        write!(to, "{:<32}", "score")?;
        for column in &self.columns {
            write!(to, " {:<23}", column.name)?;
        }
        writeln!(to)?;
        // Without a case that could be read there is none.
        let scored = self.columns.first().map_or(&[][..], |own| &own.scores);
        for (row, (name, _)) in scored.iter().enumerate() {
            write!(to, "{name:<32}")?;
            for column in &self.columns {
                write!(to, " {:<23}", cell(&column.scores[row].1))?;
            }
            writeln!(to)?;
        }
        for (name, score) in &self.own {
            writeln!(to, "{name:<32} {}", cell(score))?;
        }
        writeln!(
            to,
            "value [95 % interval] cases (of calibration: statements; of intervals: numbers); intervals are Wilson's \
             for shares, a bootstrap over cases for the rest\n"
        )?;
        if !self.refused.is_empty() {
            writeln!(to, "{} more could not be read and are in no score", self.refused.len())?;
            for Refused { case, why } in &self.refused {
                writeln!(to, "  {case}: {why}")?;
            }
            writeln!(to)?;
        }
        self.write_reliability(to)?;
        self.write_scales(to)?;
        self.write_wrong(to)?;
        if self.sweep.is_empty() { Ok(()) } else { self.write_sweep(to) }
    }

    fn write_sweep(&self, to: &mut String) -> std::fmt::Result {
        writeln!(to, "\nwhat is wrong withheld from the catalogue")?;
        let rows = [
            "unknown, or its class",
            "at the right place",
            "unknown, of those that show",
            "placed, of those that show",
        ];
        for (row, score) in rows.iter().zip(sweep_scores(&self.sweep)) {
            writeln!(to, "{row:<32} {}", cell(&score))?;
        }
        let head = ["without", "said", "left over", "likeliest"];
        writeln!(to, "{:<36} {:<8} {:<9} {:<30} parts most", head[0], head[1], head[2], head[3])?;
        for w in &self.sweep {
            let verdict = format!("{:?}", w.verdict).to_lowercase();
            let [named, place] = [&w.named, &w.place].map(|t| t.as_deref().unwrap_or("-"));
            let missed =
                if w.is_shown { "  <- named falsely or missed" } else { "  <- shows in nothing" };
            let marks = [(w.is_told, missed), (w.is_placed, "  <- wrong place")];
            let marks = marks.map(|(fine, mark)| if fine { "" } else { mark }).concat();
            let (truth, left) = (w.truth.join(" + "), w.left_over);
            writeln!(to, "{truth:<36} {verdict:<8} {left:<9.2} {named:<30} {place}{marks}")?;
        }
        Ok(())
    }

    fn write_reliability(&self, to: &mut String) -> std::fmt::Result {
        writeln!(
            to,
            "{:>10} {:>10}   {:<15} {:>10}",
            "stated", "true", "95 % interval", "statements"
        )?;
        for bin in self.reliability() {
            let [low, high] = bin.interval;
            writeln!(
                to,
                "{:>10.2} {:>10.2}   [{low:.2} {high:.2}]     {:>10}",
                bin.stated, bin.true_share, bin.count
            )?;
        }
        let chance = error_by_chance(&self.statements);
        writeln!(
            to,
            "so few statements show an error of {chance:.3} even if all are as true as stated\n"
        )
    }

    fn write_scales(&self, to: &mut String) -> std::fmt::Result {
        if self.scales.is_empty() {
            return Ok(());
        }
        writeln!(to, "{:<36} {:<10} suits these best", "scale of probabilities", "in use")?;
        for Suited { name, in_use, best } in &self.scales {
            writeln!(to, "{name:<36} {in_use:<10} {}", cell(best))?;
        }
        writeln!(to)
    }

    fn write_wrong(&self, to: &mut String) -> std::fmt::Result {
        let wrong: Vec<_> = self.cases.iter().filter(|case| !is_right(case)).collect();
        writeln!(to, "{} of {} cases came out wrong", wrong.len(), self.cases.len())?;
        for case in wrong {
            writeln!(to, "{}", line(&case.truth, &case.examined.replies[0]))?;
        }
        Ok(())
    }

    /// All of it, with every diagnosis in full. `seconds` are the only values that differ between two
    /// examinations of the same cases.
    #[must_use]
    pub fn json(&self) -> Value {
        let table = |scores: &Scores| -> Value {
            scores.iter().map(|(name, score)| ((*name).to_owned(), json!(score))).collect()
        };
        let columns: serde_json::Map<String, Value> =
            self.columns.iter().map(|c| (c.name.to_owned(), table(&c.scores))).collect();
        let cases = self.cases.iter().map(|case| {
            json!({
                "case": case.truth.case,
                "kind": case.truth.kind,
                "truth": case.truth.facts.iter().map(ToString::to_string).collect::<Vec<_>>(),
                "right": is_right(case),
                "seconds": case.examined.seconds,
                "oracle": case.oracle,
                "diagnosis": case.examined.diagnosis,
                "baselines": case.examined.replies[1..].iter().zip(&BASELINES)
                    .map(|(reply, baseline)| (baseline.name.to_owned(), json!(reply)))
                    .collect::<serde_json::Map<_, _>>(),
            })
        });
        json!({
            "seal": self.seal,
            "salt": self.salt,
            "scores": columns,
            "own": table(&self.own),
            "reliability": self.reliability(),
            "calibration_error_by_chance": error_by_chance(&self.statements),
            "scales": self.scales,
            "cases": cases.collect::<Vec<_>>(),
            "withheld": self.sweep,
            "refused": self.refused,
        })
    }
}

/// What only the diagnosis states: intervals, how far, how long.
fn own_scores(cases: &[Judged]) -> Scores {
    vec![
        ("90 % interval holds the truth", Score::share(cases.iter().flat_map(covered))),
        ("shrink over oracle, one step", over_oracle(cases, |shrink| shrink.one_step)),
        ("shrink over oracle, 5 s", over_oracle(cases, |shrink| shrink.five_s)),
        ("shrink over oracle, whole run", over_oracle(cases, |shrink| shrink.run)),
        ("seconds", Score::mean(cases.iter().map(|case| case.examined.seconds))),
    ]
}

/// How far the gap shrinks by what was said, over how far it does for who knows the truth: mean over
/// mean. Where no cause was stood by, nothing shrinks.
fn over_oracle(cases: &[Judged], horizon: fn(&Shrink) -> f64) -> Score {
    let pair = |case: &Judged| {
        let said = case.examined.diagnosis.together.as_ref().map(|t| horizon(&t.shrink));
        Some((said.unwrap_or(0.0), horizon(case.oracle.as_ref()?)))
    };
    let pairs: Vec<(f64, f64)> = cases.iter().filter_map(pair).collect();
    if pairs.is_empty() {
        return Score::unsaid();
    }
    Score::of(&pairs, |pairs| {
        let [said, known] = pairs.iter().fold([0.0; 2], |[s, k], (a, b)| [s + a, k + b]);
        said / known
    })
}

/// Whether the verdict is all of the truth and nothing else.
fn is_right(case: &Judged) -> bool {
    let (truth, reply) = (&case.truth, &case.examined.replies[0]);
    let stood: Vec<_> = reply.causes.iter().filter(|cause| cause.stands).collect();
    match truth.kind {
        Kind::Null => reply.verdict == Verdict::None,
        Kind::Unknown => reply.verdict == Verdict::Unknown,
        Kind::Single | Kind::Pair => {
            reply.verdict == Verdict::Effect
                && stood.len() == truth.facts.len()
                && stood.iter().all(|cause| truth.has_at(cause.effect, cause.scope))
        }
    }
}

fn cell(score: &Score) -> String {
    // Sums of rounding errors would print as -0.00.
    let shown = |figure: f64| if figure.abs() < 5e-3 { 0.0 } else { figure };
    let ([low, high], value) = (score.interval.map(shown), shown(score.value));
    if score.count == 0 {
        "-".to_owned()
    } else if value >= 10.0 {
        format!("{value:.1} [{low:.1} {high:.1}] {}", score.count)
    } else {
        format!("{value:.2} [{low:.2} {high:.2}] {}", score.count)
    }
}

/// A case in one line: what is so, what was said, the likeliest causes.
fn line(truth: &Truth, reply: &Reply) -> String {
    let verdict = format!("{:?}", reply.verdict).to_lowercase();
    let probability = |p: Option<f64>| p.map_or_else(|| "-".to_owned(), |p| format!("{p:.2}"));
    let mut line = format!("  {}: {truth} ({}); said {verdict}:", truth.case, truth.kind);
    for cause in reply.causes.iter().take(3) {
        let scope =
            if cause.effect.has_scope() { format!(" {}", cause.scope) } else { String::new() };
        let _ = write!(line, " {}{scope} {},", cause.effect.name, probability(cause.probability));
    }
    let _ =
        write!(line, " none {}, unknown {}", probability(reply.none), probability(reply.unknown));
    line
}
