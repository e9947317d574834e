//! The files a run leaves: its log, its picture, its report.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use xt28_scenarios::{Picture, Recording, Report, Setup};

use crate::Failure;

/// Where a run's files go.
#[derive(Debug)]
pub(crate) struct Artefacts {
    log: Option<PathBuf>,
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
            Some(path) => Ok(Box::new(BufWriter::new(create(path)?))),
            None => Ok(Box::new(io::sink())),
        }
    }

    /// Writes picture and report, and names all files.
    pub(crate) fn write(
        &self,
        setup: &Setup,
        recording: &Recording,
        report: &Report,
    ) -> Result<Vec<PathBuf>, Failure> {
        let mut files: Vec<PathBuf> = self.log.iter().cloned().collect();
        let Some(folder) = &self.folder else {
            return Ok(files);
        };
        let picture = Picture {
            scenario: &setup.scenario,
            seed: setup.seed,
            machine: &setup.machine,
            trace: &recording.trace,
            findings: &report.findings,
        };
        let texts = [("svg", picture.svg()), ("json", format!("{:#}\n", report.json()))];
        for (ending, text) in texts {
            let path = folder.join(format!("{}.{ending}", self.name));
            create(&path)?.write_all(text.as_bytes())?;
            files.push(path);
        }
        Ok(files)
    }
}

fn create(path: &Path) -> Result<File, Failure> {
    File::create(path).map_err(|error| {
        format!("{}: cannot write: {error}; give another path", path.display()).into()
    })
}
