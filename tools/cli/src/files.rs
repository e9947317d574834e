//! The files that a command writes: whether it can is asked before the work, not after it.

use std::fs::{self, OpenOptions};
use std::path::{Path, PathBuf};

use same_file::is_same_file;
use serde::de::IgnoredAny;
use xt28_sim::effects::Overlay;

use crate::Failure;
use crate::say::tell;

/// What a file holds once it is written, and all that one there may hold to be replaced by it: an answer given the
/// name of a log must not cost the log.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Form {
    /// JSON.
    Json,
    /// A page or a picture: HTML, SVG.
    Page,
    /// An overlay: TOML of effects alone, where a scenario or a machine file has more.
    Overlay,
    /// Whatever: who writes it looks for itself.
    Any,
}

impl Form {
    /// Whether `bytes` are text of this form, or none.
    fn reads(self, bytes: &[u8]) -> bool {
        let Ok(text) = str::from_utf8(bytes) else { return false };
        text.trim().is_empty()
            || match self {
                Self::Json => serde_json::from_str::<IgnoredAny>(text).is_ok(),
                Self::Page => text.trim_start().starts_with('<'),
                Self::Overlay => Overlay::parse(text, Path::new("")).is_ok(),
                Self::Any => true,
            }
    }

    /// Its name.
    const fn name(self) -> &'static str {
        match self {
            Self::Json => "JSON",
            Self::Page => "page or picture",
            Self::Overlay => "overlay of effects",
            Self::Any => "file",
        }
    }
}

/// Refuses to replace what is there and is no such file as is to be written for `option`.
pub(crate) fn replaceable(path: &Path, option: &str, form: Form) -> Result<(), Failure> {
    // What is no file keeps nothing.
    if matches!(form, Form::Any) || !path.is_file() || form.reads(&fs::read(path)?) {
        return Ok(());
    }
    let (path, name) = (path.display(), form.name());
    Err(format!("{path}: it is there, and is no {name} to be replaced; give {option} another")
        .into())
}

/// Refuses files that could not be written. One that is there keeps what it holds, and none is left.
pub(crate) fn writable<'a>(paths: impl IntoIterator<Item = &'a Path>) -> Result<(), Failure> {
    for path in paths {
        let there = path.exists();
        let opened = OpenOptions::new().write(true).create(!there).truncate(false).open(path);
        opened.map_err(|error| refusal(path, &error))?;
        if !there {
            // A link to what is not there yet stays.
            fs::remove_file(path.canonicalize()?)?;
        }
    }
    Ok(())
}

/// Refuses to write over one of the files that a command reads; `option` names what is to be written.
pub(crate) fn no_input<'a>(
    path: &Path,
    option: &str,
    read: impl IntoIterator<Item = &'a Path>,
) -> Result<(), Failure> {
    if read.into_iter().any(|one| is_one(path, one)) {
        let path = path.display();
        return Err(format!("{path}: this command reads that file; give {option} another").into());
    }
    Ok(())
}

/// What a command is to write: each file with the option that names it.
pub(crate) struct Outputs<'a> {
    files: Vec<(&'static str, Form, &'a Path)>,
}

impl<'a> Outputs<'a> {
    /// Those of `options` that were given.
    pub(crate) fn new(
        options: impl IntoIterator<Item = (&'static str, Form, Option<&'a PathBuf>)>,
    ) -> Self {
        let given = |(option, form, path): (_, _, Option<&'a PathBuf>)| {
            Some((option, form, path?.as_path()))
        };
        Self { files: options.into_iter().filter_map(given).collect() }
    }

    /// Refuses those that the command reads as well, those that are one file under two options, those that
    /// would replace something else than they are, and those that could not be written.
    pub(crate) fn ensure_apart<'b>(
        &self,
        read: impl IntoIterator<Item = &'b Path> + Clone,
    ) -> Result<(), Failure> {
        for (i, (option, form, path)) in self.files.iter().enumerate() {
            no_input(path, option, read.clone())?;
            let same = self.files[..i].iter().find(|(.., one)| is_one(path, one));
            if let Some((other, ..)) = same {
                let path = path.display();
                return Err(format!(
                    "{path}: {other} and {option} would write the same file; give one of them another"
                )
                .into());
            }
            replaceable(path, option, *form)?;
        }
        writable(self.files.iter().map(|(.., path)| *path))
    }
}

/// Whether two names are of one file, whatever they are: links of both kinds, and one that is not there yet.
fn is_one(path: &Path, other: &Path) -> bool {
    let own = place(path);
    let is_there_twice = || path.is_file() && is_same_file(path, other).unwrap_or(false);
    own.is_some() && (place(other) == own || is_there_twice())
}

/// Where a file lies, whatever it is called, also one that is not there yet; none for what keeps
/// nothing, as a terminal or `/dev/null`, and where there is no such folder.
fn place(path: &Path) -> Option<PathBuf> {
    match path.canonicalize() {
        Ok(there) => there.is_file().then_some(there),
        Err(_) => {
            let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
            let folder = parent.unwrap_or(Path::new(".")).canonicalize().ok()?;
            Some(folder.join(path.file_name()?))
        }
    }
}

/// Writes `text` into `path`, and says so.
pub(crate) fn write(path: &Path, text: &str) -> Result<(), Failure> {
    fs::write(path, text).map_err(|error| refusal(path, &error))?;
    tell!("wrote {}", path.display());
    Ok(())
}

/// What is said of a file that could not be written.
pub(crate) fn refusal(path: &Path, error: &std::io::Error) -> Failure {
    let path = path.display();
    format!("{path}: cannot write: {error}; give a folder that exists and has room").into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is said of writing `outputs` beside reading `a.log`.
    fn refused(folder: &Path, outputs: [&str; 2]) -> Option<String> {
        let [one, other] = outputs.map(|name| folder.join(name));
        let outputs = [("--json", Form::Json, Some(&one)), ("--report", Form::Page, Some(&other))];
        let outputs = Outputs::new(outputs);
        let read = folder.join("a.log");
        outputs.ensure_apart([read.as_path()]).err().map(|failure| failure.to_string())
    }

    #[test]
    fn no_output_is_an_input_nor_another_output() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.log"), "kept").unwrap();
        fs::create_dir(folder.path().join("b")).unwrap();
        let of = |outputs| refused(folder.path(), outputs);
        assert!(of(["a.json", "a.html"]).is_none());
        let input = of(["a.json", "b/../a.log"]).unwrap();
        assert!(input.ends_with("this command reads that file; give --report another"), "{input}");
        let both = of(["a.json", "b/../a.json"]).unwrap();
        assert!(both.contains("--json and --report would write the same file"), "{both}");
        assert_eq!(fs::read_to_string(folder.path().join("a.log")).unwrap(), "kept");
    }

    #[test]
    fn only_an_earlier_answer_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.log"), "kept").unwrap();
        let refused_over = |holds: &[u8], outputs| {
            fs::write(folder.path().join("there"), holds).unwrap();
            refused(folder.path(), outputs)
        };
        let as_json = ["there", "a.html"];
        for kept in [&b"(1.0) can0 0CFF0027#00"[..], &[0x1f, 0x8b, 0xff], b"my notes", b"<html>"] {
            let why = refused_over(kept, as_json).unwrap();
            assert!(why.ends_with("is no JSON to be replaced; give --json another"), "{why}");
        }
        assert!(refused_over(b"{ \"verdict\": \"none\" }\n", as_json).is_none());
        assert!(refused_over(b"", as_json).is_none());
        assert!(refused_over(b"<!doctype html>", ["a.json", "there"]).is_none());
        assert!(refused_over(b"{}", ["a.json", "there"]).is_some());
        let effect = "[[effect]]\nname = \"arm-delay\"\ndelay_s = 0.1\n";
        let scenario = format!("title = \"t\"\n{effect}");
        assert!(
            ["effect = []\n", effect, ""].iter().all(|text| Form::Overlay.reads(text.as_bytes()))
        );
        for kept in ["my notes", "[masses]\n", "end_s = 1\n", scenario.as_str()] {
            assert!(!Form::Overlay.reads(kept.as_bytes()), "{kept}");
        }
    }

    #[test]
    fn a_second_name_of_a_file_is_that_file() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.log"), "{}").unwrap();
        fs::hard_link(folder.path().join("a.log"), folder.path().join("b.json")).unwrap();
        let why = refused(folder.path(), ["b.json", "a.html"]).unwrap();
        assert!(why.ends_with("this command reads that file; give --json another"), "{why}");
    }

    #[cfg(unix)]
    #[test]
    fn what_keeps_nothing_may_be_given_twice_and_a_link_is_what_it_points_at() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.log"), "kept").unwrap();
        std::os::unix::fs::symlink("a.log", folder.path().join("link")).unwrap();
        assert!(refused(folder.path(), ["/dev/null", "/dev/null"]).is_none());
        assert!(refused(folder.path(), ["link", "a.html"]).is_some());
        let link = folder.path().join("to-be");
        std::os::unix::fs::symlink("new.json", &link).unwrap();
        assert!(refused(folder.path(), ["to-be", "a.html"]).is_none());
        assert!(
            link.is_symlink() && !link.exists(),
            "the link stays, and nothing is left where it points"
        );
    }
}
