//! The files that a command writes: whether it can is asked before the work, not after it.

use std::fs::{self, OpenOptions};
use std::path::{Path, PathBuf};

use crate::Failure;

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
    let Some(own) = place(path) else { return Ok(()) };
    if read.into_iter().any(|one| place(one).is_some_and(|one| one == own)) {
        let path = path.display();
        return Err(format!("{path}: this command reads that file; give {option} another").into());
    }
    Ok(())
}

/// What a command is to write: each file with the option that names it.
pub(crate) struct Outputs<'a> {
    files: Vec<(&'static str, &'a Path)>,
}

impl<'a> Outputs<'a> {
    /// Those of `options` that were given.
    pub(crate) fn new(
        options: impl IntoIterator<Item = (&'static str, Option<&'a PathBuf>)>,
    ) -> Self {
        let given = |(option, path): (_, Option<&'a PathBuf>)| Some((option, path?.as_path()));
        Self { files: options.into_iter().filter_map(given).collect() }
    }

    /// Refuses those that the command reads as well, those that are one file under two options, and
    /// those that could not be written.
    pub(crate) fn ensure_apart<'b>(
        &self,
        read: impl IntoIterator<Item = &'b Path> + Clone,
    ) -> Result<(), Failure> {
        for (i, (option, path)) in self.files.iter().enumerate() {
            no_input(path, option, read.clone())?;
            let own = place(path);
            let same = self.files[..i].iter().find(|(_, one)| own.is_some() && place(one) == own);
            if let Some((other, _)) = same {
                let path = path.display();
                return Err(format!(
                    "{path}: {other} and {option} would write the same file; give one of them another"
                )
                .into());
            }
        }
        writable(self.files.iter().map(|(_, path)| *path))
    }
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
    eprintln!("wrote {}", path.display());
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
        let outputs = Outputs::new([("--json", Some(&one)), ("--report", Some(&other))]);
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
