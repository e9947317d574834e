//! `xt28 gap diagnose`: what makes a machine part from its simulator, as far as its logs say.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use xt28_gap::diagnosis::{
    Details, Diagnosis, FieldRun, Inquiry, Progress, Verdict as Answer, next_drive, untested_drive,
};
use xt28_gap::page::Subject;
use xt28_gap::{About, Choice, Decoder, Known, Mapping, RunSet, Use, page};
use xt28_machine::Machine;
use xt28_sim::effects::Overlay;

use super::about;
use super::asked::{Answered, Asked, Input};
use super::drive::{ensure_a_drives, not_written, script_beside, write_drive};
use super::remarks::{Given, remarks};
use crate::files::{Form, Outputs, write};
use crate::ground::Ground;
use crate::say::{say, tell};
use crate::{Failure, Verdict};

/// Say which unmodelled effect parts a machine from its simulator, with what probability
///
/// Prints where simulator and machine part, the causes with their probabilities and sizes, how far the
/// gap shrinks on runs that were not fitted, and what to drive next. The answer may be "none" or
/// "unknown". Exit status: 0 nothing beyond ordinary tolerances; 1 an effect, or something unknown;
/// 2 it could not be done.
///
/// RUN is a file name with or without its ending, its beginning up to its number (run-3), a scenario of about.toml,
/// or a number: of a log in the order given, or that in run-3-mixed.log; one that may be either is refused. --fit alone holds out all
/// other runs, --held alone fits on all others; with both, runs that neither names are left out. Without
/// --fit and --held, about.toml says what is fitted on; without it at most a third is held out, the last
/// runs that show no effect the others do not.
#[derive(Args)]
pub(crate) struct Diagnose {
    /// Logs of one machine: candump, plain or gzipped, or MCAP with `can_msgs` frames
    #[arg(required = true)]
    logs: Vec<PathBuf>,
    /// DBC that the logs were sent with
    #[arg(long, value_name = "FILE")]
    dbc: PathBuf,
    /// Which signal of that DBC is which channel (TOML), where names differ from ours
    #[arg(long, value_name = "FILE")]
    mapping: Option<PathBuf>,
    /// Machine file (TOML); the built-in machine when left out
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,
    /// Effects that one knows the machine to have (TOML; see `xt28 effects`)
    #[arg(long, value_name = "FILE")]
    effects: Option<PathBuf>,
    /// Terrain file (TOML) of all runs, or the scenario that they are of, instead of what about.toml says
    #[arg(long, value_name = "FILE")]
    terrain: Option<PathBuf>,
    /// What is known of the logs (TOML); about.toml beside the first log, if there
    #[arg(long, value_name = "FILE")]
    about: Option<PathBuf>,
    /// Runs to fit causes on; without --held, the others are held out
    #[arg(long, value_name = "RUN", value_delimiter = ',')]
    fit: Vec<String>,
    /// Runs to hold out, to judge causes on; without --fit, the others are fitted
    #[arg(long, value_name = "RUN", value_delimiter = ',')]
    held: Vec<String>,
    /// Take a log that ends in the middle of a line as ending before it
    #[arg(long)]
    accept_cut: bool,
    /// Go on where commands and readings of the arms look like those of different wheels
    #[arg(long)]
    accept_wheel_order: bool,
    /// Do not say how far the gap shrinks, nor (without --next) what to drive next: the longest part
    #[arg(long)]
    no_how_far: bool,
    /// Write the test drive that would tell most into this file (TOML), for `xt28 run`, and its script
    /// beside it
    #[arg(long, value_name = "OUT")]
    next: Option<PathBuf>,
    /// Write the answer as JSON into this file
    #[arg(long, value_name = "OUT")]
    json: Option<PathBuf>,
    /// Write a report of two pages into this file (HTML), one for who decides, one for who mends
    #[arg(long, value_name = "OUT")]
    report: Option<PathBuf>,
    /// Write the causes found into this file (TOML), for `--effects` of other commands
    #[arg(long, value_name = "OUT")]
    overlay: Option<PathBuf>,
}

/// The option that names where the drive to make next is written.
const NEXT: &str = "--next";
/// What is noted where the drive to make next, if any, is for something else.
const NOTHING_APART: &str =
    "No scripted drive would tell the likely causes apart better than these logs do";

impl Diagnose {
    pub(crate) fn execute(&self) -> Result<Verdict, Failure> {
        self.ensure_outputs_apart()?;
        self.next.as_deref().map_or(Ok(()), |path| ensure_a_drives(path, NEXT))?;
        let start = Instant::now();
        let bar = progress_bar();
        bar.set_message("reading logs");
        let (inquiry, notes) = self.inquiry(&bar)?;
        let show = |progress: Progress| {
            bar.set_message(progress.stage);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 0 to 1000
            bar.set_position((progress.done.clamp(0.0, 1.0) * 1e3) as u64);
        };
        let mut diagnosis = inquiry.diagnose(&show);
        let mut unwritten = None;
        if !self.no_how_far || self.next.is_some() {
            bar.set_message("looking for the next test drive");
            // What was found must not be lost for a drive that cannot be scripted or written.
            if let Err(why) = self.look_ahead(&inquiry, &mut diagnosis) {
                diagnosis.notes.push(format!("The drive to make next could not be told: {why}."));
                unwritten = self.next.is_some().then_some(why);
            }
        }
        bar.finish_and_clear();
        diagnosis.notes.splice(0..0, notes);
        diagnosis.seconds = start.elapsed().as_secs_f64();
        say!("{}", page::text(&diagnosis));
        self.write(&inquiry, &diagnosis)?;
        if let Some(why) = unwritten {
            return Err(why);
        }
        Ok(if diagnosis.verdict == Answer::None { Verdict::Positive } else { Verdict::Negative })
    }

    /// Refuses files to write that this reads, that are one, or that hold something else: an answer must not cost a log.
    fn ensure_outputs_apart(&self) -> Result<(), Failure> {
        let script = self.next.as_deref().map(script_beside);
        let outputs = Outputs::new([
            // That both are a drive's is looked at where drives are written.
            (NEXT, Form::Any, self.next.as_ref()),
            ("--next, for its script,", Form::Any, script.as_ref()),
            ("--json", Form::Json, self.json.as_ref()),
            ("--report", Form::Page, self.report.as_ref()),
            ("--overlay", Form::Overlay, self.overlay.as_ref()),
        ]);
        let files = [&self.mapping, &self.machine, &self.effects, &self.terrain];
        let about = about(&self.logs, self.about.as_ref())?;
        let known = files.into_iter().flatten().chain([&self.dbc]).chain(&about);
        outputs.ensure_apart(self.logs.iter().chain(known).map(PathBuf::as_path))
    }

    /// The question, and what was taken for granted in asking it.
    fn inquiry(&self, bar: &ProgressBar) -> Result<(Inquiry, Vec<String>), Failure> {
        let mapping =
            self.mapping.as_deref().map_or_else(|| Ok(Mapping::default()), Mapping::load)?;
        let decoder = Decoder::load(&self.dbc, &mapping)?;
        let machine = self.machine.as_deref().map_or_else(|| Ok(Machine::xt28()), Machine::load)?;
        let believed =
            self.effects.as_deref().map_or_else(|| Ok(Overlay::default()), Overlay::load)?;
        let about = about(&self.logs, self.about.as_ref())?;
        let ground = Ground::find(self.terrain.as_deref())?;
        let (is_asked, terrain) = (self.about.is_some(), ground.as_ref().map(Ground::file));
        let known = Known { about: about.as_deref(), is_asked, terrain };
        let set = RunSet::load(&self.logs, &decoder, known, self.accept_cut)?;
        bar.suspend(|| set.warnings().iter().for_each(|warning| tell!("{warning}")));
        let choice = set.choose(&self.fit, &self.held)?;
        let (about, machine_file) = (about.as_deref(), self.machine.as_deref());
        let given = Given { decoder: &decoder, about, dbc: &self.dbc, machine: machine_file };
        let remarks = remarks(&set, &given)?;
        let left: Vec<String> = left_out(&set, &choice);
        let mut inquiry = set.into_inquiry(machine, &choice, self.accept_wheel_order)?;
        let mut notes = vec![split(&inquiry, &left, &choice)];
        notes.extend(remarks);
        inquiry.believed = believed.effects(&inquiry.machine)?;
        inquiry.how_far = !self.no_how_far;
        Ok((inquiry, notes))
    }

    /// Says what to drive next, and writes it: what tells likely causes apart or, where nothing does,
    /// what shows most that the runs fitted do not.
    fn look_ahead(&self, inquiry: &Inquiry, diagnosis: &mut Diagnosis) -> Result<(), Failure> {
        diagnosis.looked_ahead = true;
        let apart = next_drive(inquiry, diagnosis)?;
        let is_apart = apart.is_some();
        let Some((next, manoeuvre)) = apart.or_else(|| untested_drive(inquiry, diagnosis)) else {
            let unwritten = self.next.as_ref().map(|path| format!(" {}.", not_written(path)));
            diagnosis.notes.push(format!(
                "{NOTHING_APART}, and none would test more effects.{}",
                unwritten.unwrap_or_default()
            ));
            return Ok(());
        };
        let good_for = if is_apart {
            format!("tells apart {}", next.separates.join(", "))
        } else {
            diagnosis.notes.push(format!("{NOTHING_APART}."));
            "tests what no run that was fitted did".to_owned()
        };
        diagnosis.next = Some(next);
        let Some(path) = &self.next else { return Ok(()) };
        write_drive((path, NEXT), &manoeuvre, &good_for)
    }

    /// What the report is about.
    fn subject(&self) -> Result<Subject, Failure> {
        let name = self.logs[0].file_name().unwrap_or_default().to_string_lossy().into_owned();
        let unnamed = Subject { name, date: String::new() };
        let Some(path) = about(&self.logs, self.about.as_ref())? else { return Ok(unnamed) };
        let about = About::load(&path)?;
        if self.logs.iter().all(|log| about.run_of(log).is_none()) {
            return Ok(unnamed);
        }
        let name = if about.case.is_empty() { unnamed.name } else { about.case };
        Ok(Subject { name, date: about.date.unwrap_or_default() })
    }

    /// What the answer rests on.
    fn asked(&self, inquiry: &Inquiry) -> Result<Asked, Failure> {
        let input = |path: &PathBuf| Input::of(path);
        let given = |path: &Option<PathBuf>| path.as_ref().map(input).transpose();
        let fitted = inquiry.runs.iter().filter(|run| run.fit);
        Ok(Asked {
            program: concat!("xt28 ", env!("CARGO_PKG_VERSION")).to_owned(),
            logs: self.logs.iter().map(input).collect::<Result<_, _>>()?,
            fitted_runs: fitted.map(FieldRun::file).collect(),
            dbc: input(&self.dbc)?,
            mapping: given(&self.mapping)?,
            machine: given(&self.machine)?,
            effects: given(&self.effects)?,
            about: given(&about(&self.logs, self.about.as_ref())?)?,
            terrain: self.terrain.as_ref().map(|ground| ground.display().to_string()),
        })
    }

    fn write(&self, inquiry: &Inquiry, diagnosis: &Diagnosis) -> Result<(), Failure> {
        let json = self.json.as_ref().map(|path| -> Result<_, Failure> {
            let answered = Answered { answer: diagnosis, asked: self.asked(inquiry)? };
            Ok((path, format!("{}\n", serde_json::to_string_pretty(&answered)?)))
        });
        let overlay = self.overlay.as_ref().map(|path| Ok((path, page::overlay(diagnosis))));
        let report = self.report.as_ref().map(|path| -> Result<_, Failure> {
            let details = Details::new(inquiry, diagnosis)?;
            Ok((path, page::html(&self.subject()?, &inquiry.machine, diagnosis, &details)))
        });
        for file in [json, report, overlay].into_iter().flatten() {
            let (path, text) = file?;
            write(path, &text)?;
        }
        Ok(())
    }
}

/// Files of the runs that are neither fitted nor held out.
fn left_out(set: &RunSet, choice: &Choice) -> Vec<String> {
    let runs = set.runs().iter().zip(&choice.uses).filter(|(_, used)| **used == Use::Left);
    runs.map(|(run, _)| run.file.clone()).collect()
}

/// Which runs were fitted on, and who chose so.
fn split(inquiry: &Inquiry, left: &[String], choice: &Choice) -> String {
    let of = |fit: bool| {
        let runs = inquiry.runs.iter().filter(|run| run.fit == fit);
        let files: Vec<String> = runs.map(FieldRun::file).collect();
        files.join(", ")
    };
    let left =
        if left.is_empty() { String::new() } else { format!("; left out: {}", left.join(", ")) };
    let none_spared =
        !choice.is_advised && inquiry.runs.len() > 1 && inquiry.runs.iter().all(|run| run.fit);
    let why = if none_spared {
        "nobody said which, and each run shows an effect that no other does"
    } else {
        choice.why.as_str()
    };
    let held = match of(false) {
        none if none.is_empty() => "none, so nothing was foretold".to_owned(),
        runs => runs,
    };
    format!("Fitted on {}; held out: {held}{left} ({why}).", of(true))
}

/// A bar over the whole diagnosis; indicatif draws it on a terminal only.
fn progress_bar() -> ProgressBar {
    let bar = ProgressBar::new(1000);
    if let Ok(style) = ProgressStyle::with_template("[{bar:40}] {percent:>3} %  {elapsed}  {msg}") {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}
