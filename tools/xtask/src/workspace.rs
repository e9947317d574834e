//! The checkout that the chores work on: where it is, what cargo and git know of it.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;

use cargo_metadata::{Metadata, MetadataCommand};

/// What every chore returns: a value, or a one-line message that says what failed and the remedy.
pub(crate) type Outcome<T> = Result<T, Box<dyn Error>>;

/// The checkout and what cargo says of it.
pub(crate) struct Workspace {
    /// Folder of the root `Cargo.toml`.
    pub(crate) root: PathBuf,
    /// Where cargo builds (`target`, unless the caller moved it).
    pub(crate) target: PathBuf,
    /// The resolved packages, all platforms and all features in use.
    pub(crate) metadata: Metadata,
}

impl Workspace {
    /// Reads the workspace this xtask was built from.
    ///
    /// # Errors
    /// When `cargo metadata --locked` fails, among other reasons because `Cargo.lock` is stale.
    pub(crate) fn load() -> Outcome<Self> {
        let metadata = MetadataCommand::new()
            .manifest_path(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml"))
            .other_options(vec!["--locked".into()])
            .exec()
            .map_err(|error| format!("cargo metadata --locked: {error}"))?;
        Ok(Self {
            root: metadata.workspace_root.clone().into_std_path_buf(),
            target: metadata.target_directory.clone().into_std_path_buf(),
            metadata,
        })
    }

    /// Folder of what [`Self::build_release`] builds.
    pub(crate) fn release(&self) -> PathBuf {
        self.target.join("release")
    }

    /// Builds with optimisation what `arguments` of `cargo build` select.
    ///
    /// # Errors
    /// When cargo cannot.
    pub(crate) fn build_release(&self, arguments: &[&str]) -> Outcome<()> {
        let mut build = Command::new(env!("CARGO"));
        build.current_dir(&self.root).args(["build", "--release", "--locked"]).args(arguments);
        if build.status()?.success() {
            return Ok(());
        }
        Err(format!("cargo could not build {}", arguments.join(" ")).into())
    }

    /// Paths below the root that git tracks, or that it would if asked to add everything.
    ///
    /// # Errors
    /// When the checkout is not a git work tree or git is not installed.
    pub(crate) fn files(&self) -> Outcome<Vec<String>> {
        self.git_ls_files(&["--cached", "--others", "--exclude-standard"])
    }

    /// Paths below the root that git tracks now.
    ///
    /// # Errors
    /// As [`Workspace::files`].
    pub(crate) fn tracked(&self) -> Outcome<Vec<String>> {
        self.git_ls_files(&["--cached"])
    }

    fn git_ls_files(&self, which: &[&str]) -> Outcome<Vec<String>> {
        let listing = Command::new("git")
            .current_dir(&self.root)
            .args(["ls-files", "-z"])
            .args(which)
            .output()
            .map_err(|error| format!("git ls-files: {error}; tidy needs git"))?;
        if !listing.status.success() {
            let why = String::from_utf8_lossy(&listing.stderr);
            return Err(format!("git ls-files: {}", why.trim()).into());
        }
        let names = String::from_utf8(listing.stdout)?;
        let present = |name: &&str| !name.is_empty() && self.root.join(name).is_file();
        let mut files: Vec<String> = names.split('\0').filter(present).map(String::from).collect();
        files.sort();
        files.dedup();
        Ok(files)
    }
}
