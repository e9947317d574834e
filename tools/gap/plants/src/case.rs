//! A case: one foreign machine, what is wrong with it, and the logs of its test drives.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

use flate2::{Compression, GzBuilder};
use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use xt28_bus::candump::Writer;
use xt28_dbc::EncodeError;
use xt28_sim::ReducedBodies;

use crate::about;
use crate::answer::{Answer, Fact};
use crate::causes::{Block, CAUSES, Cause, Scopes};
use crate::database;
use crate::manoeuvre::{Manoeuvre, Script};
use crate::run::{Timeline, run};
use crate::scope::Scope;
use crate::truth::Truth;

/// The first log's first frame, s since 1970; each run a quarter of an hour after the last.
const EPOCH_S: u64 = 1_760_000_000;
const BETWEEN_S: u64 = 900;
/// How many of the causes that may, begin in the middle of the runs, and when, s.
const LATE_SHARE: f64 = 0.2;
const LATE_S: std::ops::Range<f64> = 8.0..14.0;
/// Streams of a case's seed: drawing it, then one pair for each run.
const RUN_STREAM: u64 = 16;

/// How much is wrong with a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Nothing.
    Null,
    /// One thing that the catalogue has.
    Single,
    /// Two of them, in different blocks.
    Pair,
    /// One thing that no catalogue has.
    Unknown,
}

/// One log: file name and bytes, gzipped candump.
pub type Log = (String, Vec<u8>);

/// Why a case has no logs.
#[derive(Debug, thiserror::Error)]
pub enum CaseError {
    /// A reading left the range of its signal.
    #[error("{case}, {run}: the machine has gone astray: {source}; report the seed")]
    Astray {
        /// The case.
        case: String,
        /// The manoeuvre.
        run: &'static str,
        /// The signal.
        source: EncodeError,
    },
    /// A file could not be written.
    #[error("{path}: cannot write: {source}; give a folder that exists or can be made")]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

/// One thing that is wrong with a case's machine.
#[derive(Clone, Debug)]
struct Fault {
    cause: &'static Cause,
    scope: Scope,
    values: Vec<f64>,
    start_s: f64,
}

/// One foreign machine and its test drives. The same seed and kind give the same bytes.
#[derive(Clone, Debug)]
pub struct Case {
    name: String,
    seed: u64,
    kind: Kind,
    sound: Truth,
    faults: Vec<Fault>,
    runs: Vec<(Manoeuvre, Script)>,
}

impl Kind {
    /// Its name in an answer.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Null => "null",
            Self::Single => "single",
            Self::Pair => "pair",
            Self::Unknown => "unknown",
        }
    }
}

impl Case {
    /// A machine with tolerances and with as much wrong as `kind` says, drawn from `seed`.
    #[must_use]
    pub fn draw(seed: u64, kind: Kind) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut case = Self::sound(seed, Truth::toleranced(&mut random), &mut random);
        case.kind = kind;
        let count = match kind {
            Kind::Null => 0,
            Kind::Single | Kind::Unknown => 1,
            Kind::Pair => 2,
        };
        let mut taken: Vec<Block> = Vec::new();
        for _ in 0..count {
            let open: Vec<&'static Cause> = CAUSES
                .iter()
                .filter(|cause| cause.is_known == (kind != Kind::Unknown))
                .filter(|cause| !taken.contains(&cause.block))
                .collect();
            if let Some(&cause) = open.choose(&mut random) {
                taken.push(cause.block);
                let scope = scope(cause.scopes, &mut random);
                case.faults.push(Fault::draw(cause, scope, &mut random));
            }
        }
        case
    }

    /// A machine with tolerances and with `cause` on `scope`, its size drawn from `seed`.
    ///
    /// The rest is as in every other case of this seed, so cases differ by their causes alone.
    #[must_use]
    pub fn of(seed: u64, cause: &'static Cause, scope: Scope) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut case = Self::sound(seed, Truth::toleranced(&mut random), &mut random);
        case.kind = if cause.is_known { Kind::Single } else { Kind::Unknown };
        let scope = if cause.scopes == Scopes::Whole { Scope::All } else { scope };
        case.faults.push(Fault::draw(cause, scope, &mut random));
        case
    }

    /// The machine as everyone believes it is: no tolerance, no noise, nothing wrong. How far two
    /// models of it lie apart is in every other case too.
    #[must_use]
    pub fn nominal(seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        Self::sound(seed, Truth::nominal(), &mut random)
    }

    fn sound(seed: u64, sound: Truth, random: &mut ChaCha8Rng) -> Self {
        let arms =
            if random.random_bool(0.5) { Manoeuvre::Multisine } else { Manoeuvre::SingleArm };
        let order = [
            Manoeuvre::ArmStep,
            arms,
            Manoeuvre::STurn,
            Manoeuvre::Straight,
            Manoeuvre::Ramp,
            Manoeuvre::Mixed,
        ];
        let runs = order.map(|manoeuvre| (manoeuvre, manoeuvre.script(&sound.machine, random)));
        let name = format!("plant-{seed}");
        Self { name, seed, kind: Kind::Null, sound, faults: Vec::new(), runs: runs.to_vec() }
    }

    /// The same machine, scripts and noise with nothing wrong.
    #[must_use]
    pub fn without_faults(&self) -> Self {
        Self { kind: Kind::Null, faults: Vec::new(), ..self.clone() }
    }

    /// The same case with its faults as strong as they are ever drawn, from the start.
    #[must_use]
    pub fn at_its_strongest(&self) -> Self {
        let mut case = self.clone();
        for fault in &mut case.faults {
            fault.values = fault.cause.strongest();
            fault.start_s = 0.0;
        }
        case
    }

    /// The same case with its faults setting in at `start_s` of every run, where they can.
    #[must_use]
    pub fn beginning_at(&self, start_s: f64) -> Self {
        let mut case = self.clone();
        for fault in case.faults.iter_mut().filter(|fault| fault.cause.may_begin_late) {
            fault.start_s = start_s;
        }
        case
    }

    /// The same case with the run of `manoeuvre` alone, cut off after `seconds`; drawn anew from the
    /// seed if the case does not have it.
    #[must_use]
    pub fn only(&self, manoeuvre: Manoeuvre, seconds: f64) -> Self {
        let found = self.runs.iter().find(|(has, _)| *has == manoeuvre).cloned();
        let (_, mut script) = found.unwrap_or_else(|| {
            let mut random = ChaCha8Rng::seed_from_u64(self.seed);
            (manoeuvre, manoeuvre.script(&self.sound.machine, &mut random))
        });
        script.seconds = script.seconds.min(seconds);
        Self { runs: vec![(manoeuvre, script)], ..self.clone() }
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// How much is wrong with it.
    #[must_use]
    pub const fn kind(&self) -> Kind {
        self.kind
    }

    /// What is wrong with it. Not for a diagnosis to see.
    #[must_use]
    pub fn answer(&self) -> Answer {
        Answer {
            case: self.name.clone(),
            seed: self.seed,
            kind: self.kind.name().to_owned(),
            truth: self.faults.iter().map(Fault::fact).collect(),
        }
    }

    /// What one may know of it: the text of `about.toml`.
    #[must_use]
    pub fn about(&self) -> String {
        about::text(&self.name, &self.runs)
    }

    /// Text of the database that the logs were sent with.
    #[must_use]
    pub fn dbc() -> String {
        database::text()
    }

    /// The logs of all runs.
    ///
    /// # Errors
    /// [`CaseError::Astray`].
    pub fn logs(&self) -> Result<Vec<Log>, CaseError> {
        let timeline = self.timeline();
        let log = |(i, (manoeuvre, script)): (usize, &(Manoeuvre, Script))| {
            let mut random = ChaCha8Rng::seed_from_u64(self.seed);
            random.set_stream(RUN_STREAM + 2 * *manoeuvre as u64);
            let frames = run::<ReducedBodies>(&timeline, script, &mut random);
            let frames = frames.map_err(|source| CaseError::Astray {
                case: self.name.clone(),
                run: manoeuvre.name(),
                source,
            })?;
            let start = Duration::from_secs(EPOCH_S + BETWEEN_S * i as u64);
            let gzip = GzBuilder::new().write(Vec::new(), Compression::default());
            let mut writer = Writer::new(gzip, "can0").starting_at(start);
            for (at, frame) in &frames {
                writer.write(*at, frame).expect("memory takes every line");
            }
            let bytes = writer.into_inner().finish().expect("memory takes every byte");
            Ok((about::log_name(i + 1, *manoeuvre), bytes))
        };
        self.runs.iter().enumerate().map(log).collect()
    }

    /// Writes logs, database and `about.toml` into `folder`, which is made if it is not there. The
    /// answer is not among them.
    ///
    /// # Errors
    /// [`CaseError`].
    pub fn write(&self, folder: &Path) -> Result<(), CaseError> {
        let refuse = |path: &Path| {
            let path = path.to_owned();
            move |source| CaseError::Write { path, source }
        };
        std::fs::create_dir_all(folder).map_err(refuse(folder))?;
        let put = |name: &str, bytes: &[u8]| {
            let path = folder.join(name);
            let mut file = std::fs::File::create(&path).map_err(refuse(&path))?;
            file.write_all(bytes).map_err(refuse(&path))
        };
        for (name, bytes) in self.logs()? {
            put(&name, &bytes)?;
        }
        put(about::DBC_FILE, database::text().as_bytes())?;
        put("about.toml", self.about().as_bytes())
    }

    /// The truth over time: without what has not begun.
    fn timeline(&self) -> Timeline {
        let mut starts: Vec<f64> = self.faults.iter().map(|fault| fault.start_s).collect();
        starts.push(0.0);
        starts.sort_by(f64::total_cmp);
        starts.dedup();
        let at = |start_s: f64| {
            let mut truth = self.sound.clone();
            for fault in self.faults.iter().filter(|fault| fault.start_s <= start_s) {
                (fault.cause.apply)(&mut truth, fault.scope, &fault.values);
            }
            (start_s, truth)
        };
        starts.into_iter().map(at).collect()
    }
}

impl Fault {
    fn draw(cause: &'static Cause, scope: Scope, random: &mut ChaCha8Rng) -> Self {
        let values = cause.draw(random);
        let late = cause.may_begin_late && random.random_bool(LATE_SHARE);
        let start_s = if late { (random.random_range(LATE_S) * 10.0).round() / 10.0 } else { 0.0 };
        Self { cause, scope, values, start_s }
    }

    fn fact(&self) -> Fact {
        let names = self.cause.parameters.iter().map(|parameter| parameter.name.to_owned());
        Fact {
            effect: self.cause.name.to_owned(),
            group: self.cause.block.name().to_owned(),
            scope: self.scope.name().to_owned(),
            target_signal: self.cause.signal.to_owned(),
            start_s: self.start_s,
            parameters: names.zip(self.values.iter().copied()).collect(),
        }
    }
}

/// All wheels, an axle, a side or one wheel: two, one, one and one times in five.
fn scope(scopes: Scopes, random: &mut ChaCha8Rng) -> Scope {
    let groups: [&[Scope]; 5] = [
        &Scope::EVERY[..1],
        &Scope::EVERY[..1],
        &Scope::EVERY[1..4],
        &Scope::EVERY[4..6],
        &Scope::EVERY[6..],
    ];
    let groups = match scopes {
        Scopes::Whole => return Scope::All,
        Scopes::Any => &groups[..],
        Scopes::Part => &groups[2..],
    };
    let group = groups[random.random_range(0..groups.len())];
    group[random.random_range(0..group.len())]
}
