//! `xt28 effects`: what a machine may have beyond the nominal one, and how an overlay says it.

use std::path::Path;

use clap::Args;
use serde_json::json;
use xt28_sim::effects::{CATALOGUE, Effect, Overlay, Parameter, Scope, find};

use crate::say::say;
use crate::{Failure, Verdict};

/// List the effects that an overlay can add to the plant, or show one as a start for your own
#[derive(Args)]
pub(crate) struct Effects {
    /// Print an overlay (TOML) with this effect, each number one tolerance off
    name: Option<String>,
    /// Its numbers, as `delay_s=0.2`; those not named are then neutral
    #[arg(requires = "name", value_name = "KEY=VALUE", value_parser = setting)]
    settings: Vec<(String, f64)>,
    /// Wheels that it is on
    #[arg(long, requires = "name", value_name = "WHEELS", default_value = "all")]
    scope: Scope,
    /// Print JSON
    #[arg(long, conflicts_with = "name")]
    json: bool,
}

impl Effects {
    pub(crate) fn execute(&self) -> Result<Verdict, Failure> {
        if let Some(name) = &self.name {
            let effect = find(name)
                .ok_or_else(|| format!("`{name}` is no effect; `xt28 effects` lists them"))?;
            say!("{}", self.overlay(effect)?);
        } else if self.json {
            say!("{:#}\n", json!(CATALOGUE.iter().map(as_json).collect::<Vec<_>>()));
        } else {
            for effect in CATALOGUE {
                say!("{:<22} {}\n", effect.name, effect.meaning);
            }
        }
        Ok(Verdict::Positive)
    }

    /// `effect` as an overlay that is accepted, with a note on each number.
    fn overlay(&self, effect: &Effect) -> Result<String, Failure> {
        let known = |key: &str| effect.parameters.iter().any(|p| p.name == key);
        if let Some((key, _)) = self.settings.iter().find(|(key, _)| !known(key)) {
            let names: Vec<_> = effect.parameters.iter().map(|p| p.name).collect();
            return Err(format!("{} has no `{key}`, but {}", effect.name, names.join(", ")).into());
        }
        for (at, (key, _)) in self.settings.iter().enumerate() {
            if self.settings[..at].iter().any(|(other, _)| other == key) {
                return Err(format!("{key} is given twice; leave one out").into());
            }
        }
        let mut text = format!("# {}\n# {}\n", effect.meaning, effect.source);
        text += &format!("[[effect]]\nname = \"{}\"\n", effect.name);
        if effect.has_scope() {
            let scope = format!("scope = \"{}\"", self.scope);
            text += &format!("{scope:<24} # all front middle rear left right FR FL MR ML BR BL\n");
        } else if self.scope != Scope::All {
            return Err(format!("{} is of the whole machine, not of wheels", effect.name).into());
        }
        for p in effect.parameters {
            let setting = format!("{} = {:?}", p.name, self.value(p));
            let [low, high] = p.range;
            text += &format!("{setting:<24} # {low} to {high}; {} is none\n", p.neutral);
        }
        Overlay::parse(&text, Path::new(effect.name))?;
        Ok(text)
    }

    fn value(&self, parameter: &Parameter) -> f64 {
        match self.settings.iter().find(|(key, _)| key == parameter.name) {
            Some((_, value)) => *value,
            None if self.settings.is_empty() => {
                (parameter.neutral + parameter.tolerance).min(parameter.range[1])
            }
            None => parameter.neutral,
        }
    }
}

/// A setting on the command line: `KEY=VALUE`.
fn setting(text: &str) -> Result<(String, f64), String> {
    let (key, value) = text.split_once('=').ok_or("expected KEY=VALUE, as delay_s=0.2")?;
    let number = value.trim().parse().ok().filter(|number: &f64| !number.is_nan());
    let number = number.ok_or_else(|| format!("`{value}` is no number"))?;
    Ok((key.trim().to_owned(), number))
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
