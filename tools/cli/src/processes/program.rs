//! One program of a run: started, watched, stopped; never left behind.

use std::ffi::OsStr;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};

use crate::Failure;

/// A running program.
pub(super) struct Program {
    name: String,
    child: Child,
    /// It was ended on purpose.
    ended: bool,
}

/// Where a program's output goes. Its talk goes where ours goes.
pub(super) enum Output {
    /// Into a file.
    To(File),
    /// To [`Program::first_line`].
    Read,
}

/// How long a program may take to end once asked to.
const END: Duration = Duration::from_secs(2);
/// How often it is asked whether it has.
const ASK: Duration = Duration::from_millis(10);

impl Program {
    /// Starts `name` from the search path.
    pub(super) fn start(
        name: &str,
        arguments: &[impl AsRef<OsStr>],
        output: Output,
    ) -> Result<Self, Failure> {
        Self::spawn(name, Command::new(name), arguments, output).map_err(|error| {
            format!("cannot start {name}: {error}; it is part of can-utils, install that").into()
        })
    }

    /// Starts `name` from the folder that this program is in.
    pub(super) fn start_beside(
        name: &str,
        arguments: &[impl AsRef<OsStr>],
        output: Output,
    ) -> Result<Self, Failure> {
        let path = beside(name)?;
        Self::spawn(name, Command::new(&path), arguments, output).map_err(|error| {
            let path = path.display();
            format!("cannot start {path}: {error}; build it with `cargo build --release -p {name}`")
                .into()
        })
    }

    fn spawn(
        name: &str,
        mut command: Command,
        arguments: &[impl AsRef<OsStr>],
        output: Output,
    ) -> std::io::Result<Self> {
        let output = match output {
            Output::To(file) => Stdio::from(file),
            Output::Read => Stdio::piped(),
        };
        let child = command.args(arguments).stdin(Stdio::null()).stdout(output).spawn()?;
        Ok(Self { name: name.to_owned(), child, ended: false })
    }

    /// The first line of its output. Waits for it; a program that ends without one is an error.
    pub(super) fn first_line(&mut self) -> Result<String, Failure> {
        let Some(output) = self.child.stdout.take() else {
            return Err(format!("the output of {} goes elsewhere", self.name).into());
        };
        let mut output = BufReader::new(output);
        let mut line = String::new();
        output.read_line(&mut line)?;
        // Held open: a program whose output is closed dies of its next line.
        self.child.stdout = Some(output.into_inner());
        if line.is_empty() {
            let status = self.child.wait()?;
            return Err(format!("{} ended at its start: {status}", self.name).into());
        }
        Ok(line)
    }

    /// An error if it has ended without having been asked to.
    pub(super) fn must_run(&mut self) -> Result<(), Failure> {
        match self.child.try_wait()? {
            Some(status) if !self.ended => {
                Err(format!("{} ended during the run: {status}", self.name).into())
            }
            _ => Ok(()),
        }
    }

    /// Ends it at once, without a chance to say goodbye on the bus.
    pub(super) fn kill(&mut self) -> Result<(), Failure> {
        self.ended = true;
        self.child.kill()?;
        self.child.wait()?;
        Ok(())
    }

    /// Sends it a signal; none once it was ended, when its process number may be somebody else's.
    pub(super) fn signal(&self, signal: Signal) -> Result<(), Failure> {
        if self.ended {
            return Ok(());
        }
        let pid = i32::try_from(self.child.id()).ok().and_then(Pid::from_raw);
        let pid = pid.ok_or_else(|| format!("{} has no process number", self.name))?;
        Ok(kill_process(pid, signal)?)
    }

    /// Asks it to end, and ends it if it does not.
    pub(super) fn stop(&mut self) -> Result<(), Failure> {
        if self.ended {
            return Ok(());
        }
        self.ended = true;
        let pid = i32::try_from(self.child.id()).ok().and_then(Pid::from_raw);
        // A program that has just ended can't be asked: that is no failure.
        let _ = pid.map(|pid| kill_process(pid, Signal::TERM));
        let deadline = Instant::now() + END;
        while self.child.try_wait()?.is_none() {
            if Instant::now() >= deadline {
                return self.kill();
            }
            thread::sleep(ASK);
        }
        Ok(())
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        if !self.ended {
            // On the way out of an error; there is nobody left to tell.
            let _ = self.kill();
        }
    }
}

fn beside(name: &str) -> Result<PathBuf, Failure> {
    let own = std::env::current_exe()?;
    let path = own.with_file_name(name);
    if path.is_file() {
        return Ok(path);
    }
    let remedy = format!("build it with `cargo build --release -p {name}`");
    Err(format!("no {} beside xt28; {remedy}", path.display()).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_hears_an_order_to_a_program_that_was_killed() {
        let mut program = Program::start("sleep", &["60"], Output::Read).unwrap();
        program.must_run().unwrap();
        program.kill().unwrap();
        program.signal(Signal::USR2).unwrap();
        program.must_run().unwrap();
    }
}
