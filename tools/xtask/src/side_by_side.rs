//! Commands several at a time, what each of them says in one piece.

use std::io::{self, Read, Seek};
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
                    // Nobody listens any more where `done` panicked.
                    if sender.send((index, to_its_end(command))).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        for (index, of) in ended {
            done(index, of);
        }
    });
}

/// Runs a command to its own end. It talks into a file: a pipe would stay open for as long as anything that it
/// left behind.
fn to_its_end(mut command: Command) -> Done {
    let mut said = Vec::new();
    let mut run = || {
        let mut file = tempfile::tempfile()?;
        let status = command.stdout(file.try_clone()?).stderr(file.try_clone()?).status()?;
        file.rewind()?;
        file.read_to_end(&mut said)?;
        Ok(status)
    };
    let status = run();
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
            let wait = format!(
                "for _ in $(seq 1000); do test -e {at}/{other} && exit 0; sleep 0.01; done"
            );
            shell(&format!("touch {at}/{own}; {wait}; exit 1"))
        };
        let mut ended = 0;
        run(vec![meet("a", "b"), meet("b", "a")], 2, |_, done| {
            assert!(done.status.unwrap().success());
            ended += 1;
        });
        assert_eq!(ended, 2);
    }

    #[test]
    fn what_a_command_leaves_behind_is_not_waited_for() {
        let begun = std::time::Instant::now();
        run(vec![shell("sleep 60 & echo gone")], 1, |_, done| assert_eq!(done.said, "gone\n"));
        assert!(begun.elapsed().as_secs() < 30);
    }

    #[test]
    fn what_cannot_run_says_so() {
        let mut why = None;
        run(vec![Command::new("/no/such/program")], 1, |_, done| why = done.status.err());
        assert_eq!(why.unwrap().kind(), io::ErrorKind::NotFound);
    }
}
