//! `xt28 scenarios`: the built-in scenarios, or the text of one.

use clap::Args;
use serde_json::json;
use xt28_scenarios::{BUILTIN, Scenario};

use crate::say::say;
use crate::{Failure, Verdict};

/// List the built-in scenarios, or show one as a start for your own
#[derive(Args)]
pub(crate) struct Scenarios {
    /// Print the TOML of this one
    name: Option<String>,
    /// Print JSON
    #[arg(long, conflicts_with = "name")]
    json: bool,
}

impl Scenarios {
    pub(crate) fn execute(&self) -> Result<Verdict, Failure> {
        if let Some(name) = &self.name {
            Scenario::find(name)?;
            let text = BUILTIN.iter().find(|(builtin, _)| builtin == name);
            let (_, text) = text.ok_or_else(|| format!("`{name}` is a file; print it with cat"))?;
            say!("{text}");
            return Ok(Verdict::Positive);
        }
        let scenarios: Result<Vec<_>, _> =
            BUILTIN.iter().map(|(name, _)| Scenario::find(name)).collect();
        let scenarios = scenarios?;
        if self.json {
            let list: Vec<_> = scenarios
                .iter()
                .map(|s| json!({ "name": s.name, "title": s.title, "duration_s": s.duration_s }))
                .collect();
            say!("{}\n", json!(list));
        } else {
            for s in scenarios {
                say!("{:<14} {:>5} s  {}\n", s.name, s.duration_s, s.title);
            }
        }
        Ok(Verdict::Positive)
    }
}
