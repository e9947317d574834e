//! Commands that are asked for at another level than theirs: `xt28 diagnose` for `xt28 gap diagnose`.

use clap::error::{ContextKind, ContextValue};
use clap::{Command, Error};

/// `error` with the command of `all` that was meant, where there is one.
pub(crate) fn with_meant(mut error: Error, all: &Command) -> Error {
    let asked = match error.get(ContextKind::InvalidSubcommand) {
        Some(ContextValue::String(asked)) => asked.clone(),
        _ => return error,
    };
    if let Some(meant) = meant(&asked, all) {
        let tip = format!("did you mean {meant}?").into();
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip]));
    }
    error
}

/// The whole command that ends with the word `asked`.
fn meant(asked: &str, all: &Command) -> Option<String> {
    let is_one = |command: &&Command| command.find_subcommand(asked).is_some();
    let name = all.get_name();
    if is_one(&all) {
        return Some(format!("{name} {asked}"));
    }
    let above = all.get_subcommands().find(is_one)?;
    Some(format!("{name} {} {asked}", above.get_name()))
}
