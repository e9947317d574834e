//! `xt28 gap check`: the diagnosis examined on machines whose faults are known and sealed.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use xt28_gap_check::{
    Examination, Examined, Options, Report, Source, Withheld, curve, one_of_each, sweep,
};

use crate::files::{Form, Outputs, write};
use crate::say::{say, tell};
use crate::{Failure, Verdict};

/// Examine the diagnosis on machines whose faults are known, and print every score with its interval
///
/// Answers are sealed before the first diagnosis (a salted SHA-256) and opened after the last. Without
/// --set, cases are drawn from plants that share no effect code with the diagnosis: a fifth sound, half
/// with one effect, 15 % with two, 15 % with one that is in no catalogue. Beside the diagnosis stand
/// three plain rules on the same logs.
///
/// Exit status: 0 every case was examined, whatever the scores; 1 one could not be; 2 nothing could.
#[derive(Args)]
pub(crate) struct Check {
    /// Folder of other machines' cases: NAME/about.toml with logs and DBC each, and the answers as
    /// NAME.toml in `answers` beside the folder or within it
    #[arg(long, value_name = "DIR")]
    set: Option<PathBuf>,
    /// Instead of the cases of the folder, examine N that are made of them: a fault of reading is laid over the
    /// logs of a machine that is sound or has one effect; what, where and how large is drawn from --seed
    #[arg(long, value_name = "N", requires = "set", conflicts_with = "cases")]
    grafts: Option<NonZeroUsize>,
    /// How many cases to examine: 40 are drawn when left out; with --set the first N of the folder in the
    /// order of their names, all of them when left out
    #[arg(long, value_name = "N")]
    cases: Option<NonZeroUsize>,
    /// Seed of the cases drawn, and of the seal's salt
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Write every score and every diagnosis as JSON, and beside it the seal as soon as it is made.
    /// Without FILE the JSON goes to stdout, and the table to stderr
    #[arg(long, value_name = "FILE")]
    // The outer is whether it was asked for, the inner the file.
    #[allow(clippy::option_option)]
    json: Option<Option<PathBuf>>,
    /// Draw the reliability curve (SVG)
    #[arg(long, value_name = "FILE")]
    curve: Option<PathBuf>,
    /// Also withhold every effect from the catalogue in turn: a machine with it must come out as
    /// unknown, at the right place. With --set, what is wrong with each machine of the set
    #[arg(long)]
    sweep: bool,
    /// Leave the plain rules out: the scores of the diagnosis alone
    #[arg(long)]
    no_baselines: bool,
    /// Do not refit effects in the whole simulator: shrink is then not scored
    #[arg(long)]
    no_how_far: bool,
}

/// How many cases are drawn where nobody says.
const DRAWN: usize = 40;

impl Check {
    pub(crate) fn execute(&self) -> Result<Verdict, Failure> {
        let seal = self.json_file().map(|json| json.with_extension("seal"));
        let sources = self.sources(seal.as_ref())?;
        let withheld = match &self.set {
            _ if !self.sweep => Vec::new(),
            Some(_) => sources.clone(),
            None => one_of_each(self.seed),
        };
        let examination = Examination::sealed(sources, self.seed)?;
        tell!("answers sealed as {}", examination.seal());
        if let Some(seal) = &seal {
            write(seal, &format!("{}\n", examination.seal()))?;
        }
        let bar = ProgressBar::new(examination.len() as u64)
            .with_style(ProgressStyle::with_template("{bar:40} {pos}/{len} cases, {eta} left")?);
        let started = Instant::now();
        let clock = || started.elapsed().as_secs_f64();
        let told = |examined: &Examined| {
            bar.inc(1);
            bar.suspend(|| tell!("{}", line(examined)));
        };
        let options = Options { how_far: !self.no_how_far, baselines: !self.no_baselines };
        let (examined, refused) = examination.examine(options, &clock, &told);
        bar.finish_and_clear();
        let mut judged = examination.open(examined)?;
        if !self.no_how_far {
            tell!("fitting the true causes, for how far a gap can shrink at best");
            judged = examination.with_oracle(judged)?;
        }
        let all_read = refused.is_empty();
        let withheld: Vec<Source> = withheld
            .into_iter()
            .filter(|source| refused.iter().all(|refused| refused.case != source.name()))
            .collect();
        let mut report = Report::new(&examination, judged).with_refused(refused);
        if self.sweep {
            let told = |w: &Withheld| tell!("{}", withheld_line(w));
            report = report.with_sweep(sweep(&withheld, &told)?);
        }
        self.tell(&report)?;
        Ok(if all_read { Verdict::Positive } else { Verdict::Negative })
    }

    /// The cases to examine; refuses to write over any file of the set, also of cases that are left out.
    fn sources(&self, seal: Option<&PathBuf>) -> Result<Vec<Source>, Failure> {
        let wanted = self.cases.map(NonZeroUsize::get);
        let mut sources = match (&self.set, self.grafts) {
            (Some(folder), Some(count)) => Source::grafted(folder, count.get(), self.seed)?,
            (Some(folder), None) => Source::in_folder(folder)?,
            (None, _) => Source::drawn(wanted.unwrap_or(DRAWN), self.seed),
        };
        let outputs = Outputs::new([
            ("--json", Form::Json, self.json_file()),
            ("--json, for its seal,", Form::Any, seal),
            ("--curve", Form::Page, self.curve.as_ref()),
        ]);
        let read: Vec<PathBuf> = sources.iter().flat_map(Source::files).collect();
        outputs.ensure_apart(read.iter().map(PathBuf::as_path))?;
        sources.truncate(wanted.unwrap_or(usize::MAX));
        Ok(sources)
    }

    /// Where the JSON is to go, if into a file.
    fn json_file(&self) -> Option<&PathBuf> {
        self.json.as_ref()?.as_ref()
    }

    /// The report in every form that was asked for; stdout has one of them alone, for a script to read.
    fn tell(&self, report: &Report) -> Result<(), Failure> {
        let json = || format!("{:#}\n", report.json());
        match &self.json {
            Some(None) => {
                tell!("{}", report.text().trim_end());
                say!("{}", json());
            }
            Some(Some(file)) => {
                say!("{}", report.text());
                write(file, &json())?;
            }
            None => say!("{}", report.text()),
        }
        if let Some(picture) = &self.curve {
            write(picture, &curve(&report.reliability())?)?;
        }
        Ok(())
    }
}

/// What was said of a case, before anyone knows whether it is so.
fn line(examined: &Examined) -> String {
    let verdict = format!("{:?}", examined.diagnosis.verdict).to_lowercase();
    let first = examined.diagnosis.causes.first().map_or_else(String::new, |cause| {
        format!("; likeliest {} {} {:.2}", cause.effect.name, cause.scope, cause.probability)
    });
    format!("{} in {:.1} s: {verdict}{first}", examined.case, examined.seconds)
}

/// What was said of a machine by a diagnosis that does not know its effect.
fn withheld_line(w: &Withheld) -> String {
    let verdict = format!("{:?}", w.verdict).to_lowercase();
    let [named, place] = [&w.named, &w.place].map(|text| text.as_deref().unwrap_or("nothing"));
    let (case, truth) = (&w.case, w.truth.join(" + "));
    format!("{case} without {truth}: {verdict}; likeliest {named}; parts most {place}")
}
