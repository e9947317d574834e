//! Commands several at a time, what each of them says in one piece.

use std::io::{self, Read};
use std::process::{Command, ExitStatus};
use std::sync::{Mutex, mpsc};
use std::thread;

/// What a command said and how it ended.
#[derive(Debug)]
pub(crate) struct Done {
    /// Both of its streams, in the order in which they came.
    pub(crate) said: String,
    /// How it ended, or why it did not run.
    pub(crate) status: io::Result<ExitStatus>,
}

/// Runs all commands, as many at a time as there are `lanes`, and hands each to `done` with its index as it ends.
pub(crate) fn run(commands: Vec<Command>, lanes: usize, mut done: impl FnMut(usize, Done)) {
    let queue = Mutex::new(commands.into_iter().enumerate());
    let (sender, ended) = mpsc::channel();
    thread::scope(|scope| {
        for _ in 0..lanes.max(1) {
            let sender = sender.clone();
            let take = || queue.lock().ok()?.next();
            scope.spawn(move || {
                while let Some((index, command)) = take() {
                    // Whoever listened is gone only where `done` panicked, and that ends all.
                    let _ = sender.send((index, to_its_end(command)));
                }
            });
        }
        drop(sender);
        for (index, of) in ended {
            done(index, of);
        }
    });
}

fn to_its_end(mut command: Command) -> Done {
    let mut said = Vec::new();
    let mut read_and_wait = || {
        let (mut reader, writer) = io::pipe()?;
        command.stdout(writer.try_clone()?).stderr(writer);
        let mut child = command.spawn()?;
        // Holds ends of the pipe to write to; with them open its end would never be read.
        command.stdout(std::process::Stdio::null()).stderr(std::process::Stdio::null());
        reader.read_to_end(&mut said)?;
        child.wait()
    };
    let status = read_and_wait();
    Done { said: String::from_utf8_lossy(&said).into_owned(), status }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str) -> Command {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        command
    }

    #[test]
    fn every_command_is_run_once_and_said_in_one_piece() {
        for lanes in [0, 1, 2, 9] {
            let commands = (0..5).map(|n| shell(&format!("echo {n}; echo {n} >&2; exit {n}")));
            let mut all = Vec::new();
            run(commands.collect(), lanes, |index, done| {
                all.push((index, done.said, done.status.unwrap().code().unwrap()));
            });
            all.sort();
            let expected = (0..5_u8).map(|n| (n.into(), format!("{n}\n{n}\n"), n.into()));
            assert_eq!(all, expected.collect::<Vec<_>>());
        }
    }

    #[test]
    fn two_that_wait_for_each_other_run_together() {
        let folder = tempfile::tempdir().unwrap();
        let meet = |own: &str, other: &str| {
            let at = folder.path().display();
            shell(&format!("touch {at}/{own}; until test -e {at}/{other}; do sleep 0.01; done"))
        };
        let mut ended = 0;
        run(vec![meet("a", "b"), meet("b", "a")], 2, |_, done| {
            assert!(done.status.unwrap().success());
            ended += 1;
        });
        assert_eq!(ended, 2);
    }

    #[test]
    fn what_cannot_run_says_so() {
        let mut why = None;
        run(vec![Command::new("/no/such/program")], 1, |_, done| why = done.status.err());
        assert_eq!(why.unwrap().kind(), io::ErrorKind::NotFound);
    }
}
