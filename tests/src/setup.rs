//! A scenario made ready to run: its machine loaded, its ground built, its seed settled.

use std::path::{Path, PathBuf};

use ecu_emu::UnheardEffect;
use gateway::policy::{self, Policy, SpecError};
use gateway::{GatewayConfig, Listen};
use xt28_machine::Machine;
use xt28_sim::Solver;
use xt28_sim::Terrain;
use xt28_sim::effects::Overlay;

use crate::trace::Trace;
use crate::{Evidence, Finding, RunError, Scenario, Script, SetupError, Truth};

/// All that a run is made of, on either kind of bus.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The scenario.
    pub scenario: Scenario,
    /// The machine it names.
    pub machine: Machine,
    /// What it has beyond the nominal one.
    pub overlay: Overlay,
    /// What solves its rigid bodies.
    pub solver: Solver,
    /// The ground.
    pub terrain: Terrain,
    /// The map of it that a policy is given, which need not be true.
    pub map: Terrain,
    /// Seed of all noise.
    pub seed: u64,
}

impl Setup {
    /// Loads what `scenario` names; `seed` overrides its own.
    ///
    /// # Errors
    /// The machine file is refused, a height map that the terrain names, or more load than the machine
    /// carries.
    pub fn new(scenario: Scenario, seed: Option<u64>) -> Result<Self, SetupError> {
        let machine = match &scenario.machine {
            Some(path) => Machine::load(path)?,
            None => Machine::xt28(),
        };
        let seed = seed.unwrap_or(scenario.seed);
        let overlay = Overlay { entries: scenario.effects.clone() };
        overlay.effects(&machine)?;
        let terrain = scenario.terrain.spec.build()?;
        let map = scenario.terrain.spec.build_map(&terrain)?;
        Ok(Self { scenario, machine, overlay, solver: Solver::default(), terrain, map, seed })
    }

    /// Adds the effects in the overlay at `path` to the scenario's own.
    ///
    /// # Errors
    /// The file is refused, or the scenario's profile does not hear of one of them.
    pub fn add_effects(&mut self, path: &Path) -> Result<(), SetupError> {
        let entries = Overlay::load(path)?.entries;
        UnheardEffect::check(self.scenario.profile, &entries)
            .map_err(|source| SetupError::Unheard { path: path.to_owned(), source })?;
        self.overlay.entries.extend(entries);
        Ok(())
    }

    /// The policy that drives.
    ///
    /// # Errors
    /// The policy is none, or its script is refused.
    pub fn policy(&self) -> Result<Box<dyn Policy>, SpecError> {
        match &self.scenario.script {
            Some(Script { path, text }) => {
                let limits = GatewayConfig::new(&self.machine).limits;
                let run_s = self.scenario.duration_s;
                let script = policy::Script::parse_for(run_s, text, path, &limits);
                Ok(Box::new(script.map_err(SpecError::from)?))
            }
            None => policy::from_spec(&self.scenario.policy, &self.machine, Some(&self.map)),
        }
    }

    /// Where a controller elsewhere is listened for, if one drives.
    ///
    /// # Errors
    /// The address is none.
    pub fn listen(&self) -> Result<Option<Listen>, SpecError> {
        Listen::parse(&self.scenario.policy)
    }

    /// Whether what drives may look at the map.
    #[must_use]
    pub fn takes_map(&self) -> bool {
        policy::takes_map(&self.scenario.policy)
    }

    /// Refuses what would be refused at the start of a run, before a file is opened for it.
    ///
    /// # Errors
    /// [`RunError::Policy`], [`RunError::Effects`].
    pub fn ensure_startable(&self) -> Result<(), RunError> {
        let checked = match self.listen() {
            Ok(None) => self.policy().map(drop),
            listen => listen.map(drop),
        };
        let policy_at = || self.scenario.policy_at.clone();
        checked.map_err(|source| RunError::Policy { policy_at: policy_at(), source })?;
        self.overlay.effects(&self.machine)?;
        Ok(())
    }

    /// The files beside the scenario's own that a run of it reads.
    pub fn files(&self) -> impl Iterator<Item = PathBuf> {
        let scenario = &self.scenario;
        let script = scenario.script.as_ref().map(|script| &script.path);
        let named = [&scenario.machine, &scenario.operator, &scenario.terrain.file];
        let maps = scenario.terrain.spec.height_map.iter().map(|map| &map.file);
        let named = named.into_iter().flatten().chain(script).chain(maps).cloned();
        named.chain(policy::network_files(&scenario.policy))
    }

    /// The machine file, where one is named; otherwise the built-in machine runs.
    #[must_use]
    pub fn machine_file(&self) -> Option<&PathBuf> {
        self.scenario.machine.as_ref()
    }

    /// What the scenario's expectations find in a recorded run.
    #[must_use]
    pub fn judge(&self, trace: &Trace, truth: Option<&Truth>) -> Vec<Finding> {
        let effects = self.overlay.effects(&self.machine);
        crate::expect::judge(&Evidence {
            scenario: &self.scenario,
            machine: &self.machine,
            payload_kg: effects.map_or(0.0, |effects| effects.masses.payload.mass_kg),
            trace,
            truth,
        })
    }
}
