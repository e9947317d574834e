//! The files a run leaves: its log, its picture, its report.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

use xt28_bus::candump::{Reader, Record};
use xt28_machine::SimTime;
use xt28_scenarios::{INTERFACE, Picture, Recording, Report, RunError, Setup};

use crate::Failure;
use crate::files::{Form, Outputs, refusal, write};
use crate::say::tell;

/// Where a run's files go.
#[derive(Debug)]
pub(crate) struct Artefacts {
    log: Option<PathBuf>,
    /// The option that the log is written for.
    log_option: &'static str,
    folder: Option<PathBuf>,
    name: String,
}

impl Artefacts {
    /// The log goes to `record`, or into the folder `out` with all the rest.
    pub(crate) fn new(
        name: &str,
        record: Option<&Path>,
        out: Option<&Path>,
    ) -> Result<Self, Failure> {
        if let Some(out) = out {
            let why = |error| {
                format!("{}: cannot make this folder: {error}; give --out another", out.display())
            };
            fs::create_dir_all(out).map_err(why)?;
        }
        let beside = out.map(|out| out.join(format!("{name}.log")));
        Ok(Self {
            log: record.map(Path::to_owned).or(beside),
            log_option: if record.is_some() { "--record" } else { OUT },
            folder: out.map(Path::to_owned),
            name: name.to_owned(),
        })
    }

    /// The log's path, if it is kept.
    pub(crate) fn log(&self) -> Option<&Path> {
        self.log.as_deref()
    }

    /// A writer to the log; to nowhere if it is not kept.
    pub(crate) fn log_writer(&self) -> Result<Box<dyn Write>, Failure> {
        match &self.log {
            Some(path) => {
                let file = File::create(path).map_err(|error| refusal(path, &error))?;
                Ok(Box::new(BufWriter::new(file)))
            }
            None => Ok(Box::new(io::sink())),
        }
    }

    /// The files by the option that each is written for.
    fn files(&self) -> Vec<(&'static str, Form, PathBuf)> {
        let log = self.log.iter().cloned().map(|log| (self.log_option, Form::Any, log));
        let beside = self.folder.iter().flat_map(|folder| {
            let file = |(ending, form)| (OUT, form, folder.join(format!("{}.{ending}", self.name)));
            ENDINGS.map(file)
        });
        log.chain(beside).collect()
    }

    /// Refuses files that are among those that the run reads, or one for two things, and those that could not
    /// be written.
    pub(crate) fn ensure_apart<'a>(
        &self,
        read: impl IntoIterator<Item = &'a Path>,
    ) -> Result<(), Failure> {
        let files = self.files();
        let read: Vec<&Path> = read.into_iter().collect();
        let outputs = files.iter().map(|(option, form, path)| (*option, *form, Some(path)));
        Outputs::new(outputs).ensure_apart(read)?;
        match &self.log {
            // In its own folder, under its scenario's name, a log is the bench's.
            Some(log) if self.log_option != OUT && !may_be_replaced(log)? => {
                let log = log.display();
                Err(format!(
                    "{log}: it is there, and is no log of the bench in simulated time (those begin at zero, on {INTERFACE}); give --record another"
                )
                .into())
            }
            _ => Ok(()),
        }
    }

    /// What went wrong with a run, with the log's name where that is what went wrong.
    pub(crate) fn told(&self, error: RunError) -> Failure {
        match (error, &self.log) {
            (RunError::Log(error), Some(log)) => refusal(log, &error),
            (error, _) => error.into(),
        }
    }

    /// Writes picture and report, and names all files.
    pub(crate) fn write(
        &self,
        setup: &Setup,
        recording: &Recording,
        report: &Report,
    ) -> Result<(), Failure> {
        if let Some(log) = &self.log {
            tell!("wrote {}", log.display());
        }
        let Some(folder) = &self.folder else {
            return Ok(());
        };
        let picture = Picture {
            scenario: &setup.scenario,
            seed: setup.seed,
            machine: &setup.machine,
            trace: &recording.trace,
            findings: &report.findings,
        };
        let texts = [picture.svg(), format!("{:#}\n", report.json())];
        for ((ending, _), text) in ENDINGS.into_iter().zip(texts) {
            write(&folder.join(format!("{}.{ending}", self.name)), &text)?;
        }
        Ok(())
    }
}

/// Whether a log may be written over: one of the bench in simulated time is made again in a moment, one of a machine is
/// not. The first begins at zero on the bench's own interface; others have the time of day, but for a machine whose
/// clock was never set or a recorder that counts from its start.
fn may_be_replaced(path: &Path) -> Result<bool, Failure> {
    // What is no file keeps nothing, and a pipe would wait for somebody to write.
    if !fs::metadata(path).is_ok_and(|there| there.is_file()) {
        return Ok(true);
    }
    let mut line = Vec::new();
    BufReader::new(File::open(path)?.take(LINE_BYTES)).read_until(b'\n', &mut line)?;
    Ok(line.is_empty() || is_of_the_bench(&line))
}

/// Whether a log that begins with this line is one of the bench's in simulated time.
fn is_of_the_bench(line: &[u8]) -> bool {
    let first = Reader::new(line, "").next();
    let Some(Ok(Record { at, interface, .. })) = first else { return false };
    at < SECOND && &*interface == INTERFACE
}

/// Longer than the first line of any log.
const LINE_BYTES: u64 = 512;
/// The bench sends from its first tick on.
const SECOND: SimTime = SimTime::from_nanos(1_000_000_000);
/// What is written beside the log, in this order.
const ENDINGS: [(&str, Form); 2] = [("svg", Form::Page), ("json", Form::Json)];
const OUT: &str = "--out";
