//! `xt28 gap`: where a machine's logs part from the simulator. One file a task, in `gap/`.

mod check;
mod diagnose;
mod drive;
mod remarks;
mod r#where;

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};

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

/// What speaks of `logs`, where anything does: `given`, or about.toml beside the first.
fn about(logs: &[PathBuf], given: Option<&PathBuf>) -> Option<PathBuf> {
    let beside = logs[0].parent().unwrap_or(Path::new("")).join("about.toml");
    given.cloned().or_else(|| beside.exists().then_some(beside))
}
