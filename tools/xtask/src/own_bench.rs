//! `cargo xtask own-bench`: every effect put into our own bench, driven, logged, and diagnosed.
//!
//! The examination with foreign machines (`xt28 gap check`) says how right a diagnosis is. This says whether the
//! circle closes that a control engineer has before her: an overlay into the emulator, the test drives over the
//! bus, their logs into the diagnosis, and out of it the name that went in.

mod verdict;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use clap::Args;
use toml::{Table, Value};

use crate::workspace::{Outcome, Workspace};
use verdict::Verdict;

/// What is wrong with the machines: an overlay, each effect of which makes a machine of its own.
const MACHINES: &str = "tools/xtask/own_bench.toml";
/// The machine that has nothing wrong, by this name.
const SOUND: &str = "sound";

/// Put every effect into the bench, drive it, and say what a diagnosis of the logs makes of it
///
/// A machine takes about half a minute on two cores. 1 if one was given a wrong name, or a sound one any.
#[derive(Args)]
pub(crate) struct OwnBench {
    /// Effects, or `sound`; every one, and `sound`, when left out
    effects: Vec<String>,
    /// Where to keep overlays, logs and verdicts
    #[arg(long, value_name = "DIR")]
    keep: Option<PathBuf>,
}

/// One machine: nothing wrong, or one effect as an overlay has it.
struct Machine {
    name: String,
    effect: Option<Table>,
}

impl OwnBench {
    /// Drives and prints.
    ///
    /// # Errors
    /// When the command cannot be built, or does not do what it is asked.
    pub(crate) fn execute(&self, workspace: &Workspace) -> Outcome<u8> {
        workspace.build_release(&["--package=xt28"])?;
        let temporary = tempfile::tempdir()?;
        let folder = self.keep.as_deref().unwrap_or(temporary.path());
        fs::create_dir_all(folder)?;
        let bench = Bench { workspace, folder, drives: drives(workspace, folder)? };
        let (mut named, mut wrong, mut of) = (0, 0, 0);
        println!("{}", Verdict::HEADING);
        for machine in self.machines(&workspace.root)? {
            let verdict = bench.examine(&machine)?;
            println!("{}", verdict.row(&machine.label(), machine.effect.as_ref()));
            let name = machine.effect.is_some().then_some(machine.name.as_str());
            of += u32::from(name.is_some());
            named += u32::from(name.is_some_and(|name| verdict.names(name)));
            wrong += u32::from(verdict.is_wrong(name));
        }
        println!("\n{named} of {of} named; {wrong} given a wrong name");
        Ok(u8::from(wrong > 0))
    }

    /// The machines asked for.
    fn machines(&self, root: &Path) -> Outcome<Vec<Machine>> {
        let path = root.join(MACHINES);
        let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let file: Table = toml::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?;
        let mut all = vec![Machine { name: SOUND.to_owned(), effect: None }];
        for effect in file.get("effect").and_then(Value::as_array).into_iter().flatten() {
            let effect = effect.as_table().ok_or("an effect is a table")?.clone();
            let name = effect.get("name").and_then(Value::as_str).ok_or("an effect has a name")?;
            all.push(Machine { name: name.to_owned(), effect: Some(effect) });
        }
        if let Some(unknown) = self.effects.iter().find(|name| all.iter().all(|m| m.name != **name))
        {
            return Err(format!("{MACHINES} has no `{unknown}`").into());
        }
        all.retain(|m| self.effects.is_empty() || self.effects.contains(&m.name));
        Ok(all)
    }
}

impl Machine {
    /// Name and wheels.
    fn label(&self) -> String {
        let scope = self.effect.as_ref().and_then(|e| e.get("scope")).and_then(Value::as_str);
        scope.map_or_else(|| self.name.clone(), |scope| format!("{} {scope}", self.name))
    }
}

/// Where machines are driven.
struct Bench<'a> {
    workspace: &'a Workspace,
    folder: &'a Path,
    /// Scenarios of the test drives.
    drives: Vec<PathBuf>,
}

impl Bench<'_> {
    /// Drives a machine and diagnoses its logs.
    fn examine(&self, machine: &Machine) -> Outcome<Verdict> {
        let folder = self.folder.join(machine.label().replace(' ', "-"));
        fs::create_dir_all(&folder)?;
        let overlay = folder.join("effects.toml");
        if let Some(effect) = &machine.effect {
            let all = Value::Array(vec![Value::Table(effect.clone())]);
            fs::write(&overlay, Table::from_iter([("effect".to_owned(), all)]).to_string())?;
        }
        let mut logs = Vec::new();
        for (k, drive) in self.drives.iter().enumerate() {
            let name = drive.file_stem().unwrap_or_default().to_string_lossy();
            let log = folder.join(format!("run-{}-{name}.log", k + 1));
            let mut run = xt28(self.workspace);
            // Noise is another in every run.
            run.arg("run").arg(drive).arg("--record").arg(&log).arg(format!("--seed={}", k + 1));
            if machine.effect.is_some() {
                run.arg("--effects").arg(&overlay);
            }
            told(&mut run)?;
            logs.push(log);
        }
        let json = folder.join("verdict.json");
        let mut diagnose = xt28(self.workspace);
        diagnose.args(["gap", "diagnose"]).args(&logs).arg("--dbc");
        diagnose.arg(self.workspace.root.join("dbc/xt28.dbc")).arg("--no-how-far");
        told(diagnose.arg("--json").arg(&json))?;
        Verdict::read(&json)
    }
}

/// The scenarios of all test drives, written into `folder`.
fn drives(workspace: &Workspace, folder: &Path) -> Outcome<Vec<PathBuf>> {
    let listing = told(xt28(workspace).args(["gap", "drive"]))?;
    let listing = String::from_utf8(listing.stdout)?;
    let mut drives = Vec::new();
    for name in listing.lines().filter_map(|line| line.split_whitespace().next()) {
        let path = folder.join(format!("{name}.toml"));
        told(xt28(workspace).args(["gap", "drive", name, "--out"]).arg(&path))?;
        drives.push(path);
    }
    Ok(drives)
}

fn xt28(workspace: &Workspace) -> Command {
    Command::new(workspace.release().join("xt28"))
}

/// Runs a command that may say that a machine is not as wanted (1), and nothing worse.
fn told(command: &mut Command) -> Outcome<Output> {
    let output = command.output()?;
    if matches!(output.status.code(), Some(0 | 1)) {
        return Ok(output);
    }
    Err(String::from_utf8_lossy(&output.stderr).trim().to_owned().into())
}
