//! `xt28 gap`: where a machine's logs part from the simulator. One file a task, in `gap/`.

mod asked;
mod check;
mod diagnose;
mod drive;
mod remarks;
mod r#where;

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use xt28_gap::GapError;

use crate::{Failure, Verdict};

/// Find what parts a machine from its simulator
#[derive(Args)]
pub(crate) struct Gap {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    Diagnose(diagnose::Diagnose),
    Where(r#where::Where),
    Drive(drive::Drive),
    Check(check::Check),
}

impl Gap {
    pub(crate) fn execute(&self) -> Result<Verdict, Failure> {
        match &self.task {
            Task::Diagnose(task) => task.execute(),
            Task::Where(task) => task.execute(),
            Task::Drive(task) => task.execute(),
            Task::Check(task) => task.execute(),
        }
    }
}

/// What speaks of `logs`, where anything does: `given`, or about.toml beside them.
///
/// # Errors
/// [`GapError::OtherFolder`] where about.toml lies beside the first and others lie elsewhere: it knows files by
/// their names alone, and each day's run-1 has the same.
fn about(logs: &[PathBuf], given: Option<&PathBuf>) -> Result<Option<PathBuf>, GapError> {
    if given.is_some() {
        return Ok(given.cloned());
    }
    let beside = logs[0].with_file_name("about.toml");
    if !beside.exists() {
        return Ok(None);
    }
    let folder_of = |log: &Path| {
        let folder = log.with_file_name(".");
        folder.canonicalize().unwrap_or(folder)
    };
    let folder = folder_of(&beside);
    match logs.iter().find(|log| folder_of(log) != folder) {
        Some(log) => Err(GapError::OtherFolder { about: beside, log: log.clone() }),
        None => Ok(Some(beside)),
    }
}
