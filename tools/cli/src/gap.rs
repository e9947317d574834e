//! `xt28 gap`: where a machine's logs part from the simulator. One file a task, in `gap/`.

mod check;
mod diagnose;
mod r#where;

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
    Check(check::Check),
}

impl Gap {
    pub(crate) fn execute(&self) -> Result<Verdict, Failure> {
        match &self.task {
            Task::Diagnose(task) => task.execute(),
            Task::Where(task) => task.execute(),
            Task::Check(task) => task.execute(),
        }
    }
}
