//! One command in one guest: started, streamed, timed out, its exit code handed through.

use std::ffi::OsString;
use std::fs;
use std::io::{self, Read, Write};
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process_group};

use super::Guest;
use crate::workspace::Outcome;

const INIT: &str = include_str!("../../guest/init.sh");

/// Starts the kernel (`$1`, its arguments behind) with the guest's stderr on descriptor 3 and what
/// the kernel itself says in `kernel.log`. Beside it waits a watch on our end of its stdin: it
/// reads nothing, sees the end when this process is gone for whatever reason, and then ends all.
const LAUNCH: &str = r#"exec 3>&2 2>kernel.log 4<&0
{ read -r _ <&4; kill -KILL 0; } >/dev/null 2>&1 3>&- &
LD_PRELOAD="$SHIM" exec "$@" 4<&- </dev/null"#;

/// What the clock of a guest with virtual time says when it starts: 2026-01-01 00:00 UTC, ns.
const EPOCH_NS: u64 = 1_767_225_600_000_000_000;

/// How often a running guest is looked after.
const WATCH: Duration = Duration::from_millis(20);

/// A command to run in a guest.
pub(crate) struct Job {
    /// Program and arguments.
    pub(crate) command: Vec<OsString>,
    /// Folder to run it in.
    pub(crate) folder: PathBuf,
    /// Environment it gets beside this process's own.
    pub(crate) environment: Vec<(String, String)>,
    /// Whether the guest's clock moves only while all its processes sleep.
    pub(crate) virtual_time: bool,
    /// Longest wall time before the guest is ended.
    pub(crate) timeout: Duration,
    /// Memory of the guest, MiB.
    pub(crate) memory_mib: u32,
}

/// How a guest ended.
#[derive(Debug)]
pub(crate) enum Ending {
    /// The command ended with this exit code.
    Exit(u8),
    /// The wall time ran out.
    TimedOut,
    /// The guest died before the command was done; the last lines its kernel said.
    Died(String),
}

impl Guest {
    /// Runs the job; its output goes to ours as it comes.
    ///
    /// # Errors
    /// When the guest cannot be started; what happens to it later is an [`Ending`].
    pub(crate) fn run(&self, job: &Job) -> Outcome<Ending> {
        let folder = tempfile::Builder::new().prefix("xt28-guest-").tempdir()?;
        let at = folder.path();
        if at.to_string_lossy().contains(char::is_whitespace) {
            let at = at.display();
            return Err(format!("{at}: a guest takes no path with a space; set TMPDIR").into());
        }
        let temporary = at.join("tmp");
        fs::create_dir(&temporary)?;
        fs::write(at.join("job.sh"), script(job, &temporary)?)?;
        fs::write(at.join("init.sh"), INIT)?;
        fs::set_permissions(at.join("init.sh"), fs::Permissions::from_mode(0o755))?;
        let mut guest = self
            .launch(at, job)
            .spawn()
            .map_err(|error| format!("cannot start the guest: {error}"))?;
        let streams = [
            guest.stdout.take().map(|stream| pump(stream, io::stdout())),
            guest.stderr.take().map(|stream| pump(stream, io::stderr())),
        ];
        let in_time = wait(&mut guest, job.timeout)?;
        for stream in streams.into_iter().flatten() {
            // A stream that broke has nothing more to give; the ending tells what happened.
            let _ = stream.join();
        }
        let status = fs::read_to_string(at.join("status")).unwrap_or_default();
        Ok(match status.trim().parse() {
            Ok(code) => Ending::Exit(code),
            Err(_) if !in_time => Ending::TimedOut,
            Err(_) => Ending::Died(last_lines(&at.join("kernel.log"))),
        })
    }

    fn launch(&self, at: &Path, job: &Job) -> Command {
        let mut command = Command::new("sh");
        command.args(["-c", LAUNCH, "sh"]).arg(&self.kernel);
        command.arg(format!("mem={}M", job.memory_mib));
        // No block device behind the root: the host's tree, writable.
        command.args(["root=none", "rootfstype=hostfs", "rw"]);
        command.arg(format!("init={}/init.sh", at.display()));
        command.arg(format!("XT28_JOB={}", at.display()));
        command.arg(format!("uml_dir={}/", at.display()));
        command.args(["con=null", "con0=null,fd:1", "con1=null,fd:3", "console=stderr0"]);
        if job.virtual_time {
            command.arg("time-travel=inf-cpu");
            command.arg(format!("time-travel-start={EPOCH_NS}"));
        }
        command.current_dir(at).env("SHIM", &self.shim);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        // Of its own, so that all of the guest's host processes can be ended with one signal.
        command.process_group(0);
        command
    }
}

/// The shell script that init runs: this process's environment, the folder, the command.
///
/// Temporary files go to `temporary`, which no other guest has: all begin with the same process
/// numbers, in virtual time with the same chance as well, and they share the host's files.
fn script(job: &Job, temporary: &Path) -> Outcome<String> {
    let temporary = temporary.to_str().ok_or("the temporary folder's name is not UTF-8")?;
    let mut script = String::new();
    let inherited = std::env::vars_os()
        .filter_map(|(name, value)| Some((name.into_string().ok()?, value.into_string().ok()?)));
    let own = [("TMPDIR".to_owned(), temporary.to_owned())];
    for (name, value) in inherited.chain(own).chain(job.environment.iter().cloned()) {
        if is_name(&name) {
            script += &format!("export {name}={}\n", quoted(&value));
        }
    }
    let folder = job.folder.to_str().ok_or("the working folder's name is not UTF-8")?;
    script += &format!("cd {} || exit 125\nexec", quoted(folder));
    for word in &job.command {
        let word = word.to_str().ok_or("a word of the command is not UTF-8")?;
        script += &format!(" {}", quoted(word));
    }
    Ok(script + "\n")
}

/// Whether a shell can set the variable, and the guest should have it.
fn is_name(name: &str) -> bool {
    let mut bytes = name.bytes();
    let first = bytes.next().is_some_and(|b| b.is_ascii_alphabetic() || b == b'_');
    let own = ["BASHOPTS", "BASH_ENV", "EUID", "LD_PRELOAD", "PPID", "SHELLOPTS", "UID"];
    first && bytes.all(|b| b.is_ascii_alphanumeric() || b == b'_') && !own.contains(&name)
}

/// One shell word that means exactly `text`.
fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', r"'\''"))
}

/// Copies a stream as it comes, not line by line: a command may talk in half lines.
fn pump(
    mut from: impl Read + Send + 'static,
    mut to: impl Write + Send + 'static,
) -> JoinHandle<io::Result<()>> {
    thread::spawn(move || {
        let mut buffer = [0; 8192];
        loop {
            let read = from.read(&mut buffer)?;
            if read == 0 {
                return Ok(());
            }
            to.write_all(&buffer[..read])?;
            to.flush()?;
        }
    })
}

/// Waits for the guest, `timeout` at most; true if it ended by itself. None of it is left.
fn wait(guest: &mut Child, timeout: Duration) -> Outcome<bool> {
    let deadline = Instant::now() + timeout;
    let mut in_time = true;
    while guest.try_wait()?.is_none() {
        if Instant::now() >= deadline {
            in_time = false;
            break;
        }
        thread::sleep(WATCH);
    }
    let group = i32::try_from(guest.id()).ok().and_then(Pid::from_raw);
    // After a clean end there is usually nobody left to signal: no failure.
    let _ = group.map(|group| kill_process_group(group, Signal::KILL));
    guest.wait()?;
    Ok(in_time)
}

fn last_lines(log: &Path) -> String {
    let text = fs::read(log).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(20)..].join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job(command: &[&str]) -> Job {
        Job {
            command: command.iter().map(OsString::from).collect(),
            folder: PathBuf::from("/"),
            environment: vec![("XT28_WORD".into(), "it's $HOME".into())],
            virtual_time: false,
            timeout: Duration::from_secs(1),
            memory_mib: 1,
        }
    }

    #[test]
    fn a_word_comes_through_the_shell_as_it_is() {
        let words = ["a b", "it's", "$HOME `x` \"y\"", "", "*", "two\nlines"];
        let command: Vec<&str> = ["printf", "%s|"].into_iter().chain(words).collect();
        let script = script(&job(&command), Path::new("/")).unwrap();
        let output = Command::new("sh").args(["-c", &script]).output().unwrap();
        let expected: String = words.iter().map(|word| format!("{word}|")).collect();
        assert_eq!(String::from_utf8(output.stdout).unwrap(), expected);
    }

    /// What the variable is where the job runs.
    fn variable(name: &str) -> String {
        let print = format!("printf %s \"${name}\"");
        let script = script(&job(&["sh", "-c", &print]), Path::new("/a guest")).unwrap();
        let output = Command::new("sh").args(["-c", &script]).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    }

    #[test]
    fn the_job_s_environment_wins_over_ours() {
        assert_eq!(variable("XT28_WORD"), "it's $HOME");
    }

    #[test]
    fn temporary_files_are_the_guest_s_own() {
        assert_eq!(variable("TMPDIR"), "/a guest");
    }

    #[test]
    fn what_a_shell_cannot_or_must_not_set_stays_out() {
        for name in ["", "1A", "A-B", "BASH_FUNC_x%%", "LD_PRELOAD", "SHELLOPTS"] {
            assert!(!is_name(name), "{name}");
        }
        assert!(is_name("XT28_VCAN") && is_name("_x"));
    }

    #[test]
    fn a_process_that_outlives_its_time_is_ended() {
        let mut child = Command::new("sleep").arg("60").process_group(0).spawn().unwrap();
        let begun = Instant::now();
        assert!(!wait(&mut child, Duration::from_millis(50)).unwrap());
        assert!(begun.elapsed() < Duration::from_secs(10));
    }

    #[test]
    fn init_does_nothing_outside_a_guest() {
        let output = Command::new("bash").args(["-c", INIT]).output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(said.contains("nothing done"), "{said}");
    }
}
