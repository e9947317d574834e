//! `xt28 effects`: what a machine may have beyond the nominal one, and how an overlay says it.

use clap::Args;
use serde_json::json;
use xt28_sim::effects::{CATALOGUE, Effect, find};

use crate::say::say;
use crate::{Failure, Verdict};

/// List the effects that an overlay can add to the plant, or show one as a start for your own
#[derive(Args)]
pub(crate) struct Effects {
    /// Print an overlay (TOML) with this effect, each number one tolerance off
    name: Option<String>,
    /// Print JSON
    #[arg(long, conflicts_with = "name")]
    json: bool,
}

impl Effects {
    pub(crate) fn execute(&self) -> Result<Verdict, Failure> {
        if let Some(name) = &self.name {
            let effect = find(name)
                .ok_or_else(|| format!("`{name}` is no effect; `xt28 effects` lists them"))?;
            say!("{}", overlay(effect));
        } else if self.json {
            say!("{:#}\n", json!(CATALOGUE.iter().map(as_json).collect::<Vec<_>>()));
        } else {
            for effect in CATALOGUE {
                say!("{:<22} {}\n", effect.name, effect.meaning);
            }
        }
        Ok(Verdict::Positive)
    }
}

fn overlay(effect: &Effect) -> String {
    let mut text = format!("# {}\n# {}\n", effect.meaning, effect.source);
    text += &format!("[[effect]]\nname = \"{}\"\n", effect.name);
    if effect.has_scope() {
        text += "scope = \"all\"            # all front middle rear left right FR FL MR ML BR BL\n";
    }
    for p in effect.parameters {
        let value = (p.neutral + p.tolerance).min(p.range[1]);
        let setting = format!("{} = {value:?}", p.name);
        let [low, high] = p.range;
        text += &format!("{setting:<24} # {low} to {high}; {} is none\n", p.neutral);
    }
    text
}

fn as_json(effect: &Effect) -> serde_json::Value {
    let parameters: Vec<_> = effect
        .parameters
        .iter()
        .map(|p| {
            json!({ "name": p.name, "neutral": p.neutral, "tolerance": p.tolerance, "range": p.range })
        })
        .collect();
    json!({
        "name": effect.name,
        "block": effect.block.to_string(),
        "meaning": effect.meaning,
        "source": effect.source,
        "scoped": effect.has_scope(),
        "parameters": parameters,
    })
}
