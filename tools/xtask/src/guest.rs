//! A real vcan0 where the host's kernel has none: a User Mode Linux guest over the host's files.
//!
//! User Mode Linux is a Linux kernel that runs as an ordinary process. The guest's root is the
//! host's own tree, so a binary built outside runs inside as it is, at native speed between
//! system calls. With virtual time its clock moves only while all processes sleep: a run is then
//! exact, whatever else the machine does.

mod job;
mod kernel;
mod packages;
mod shim;

use std::path::{Path, PathBuf};

pub(crate) use job::{Ending, Job};

use crate::workspace::Outcome;

/// What it takes to start a guest.
pub(crate) struct Guest {
    kernel: PathBuf,
    shim: PathBuf,
}

impl Guest {
    /// Why no guest can be had here without somebody's help, and what they would have to do.
    pub(crate) fn out_of_reach(cache: &Path) -> Option<String> {
        if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
            return Some("a guest runs on Linux on x86-64 only".to_owned());
        }
        packages::out_of_reach(packages::RUN)
            .or_else(|| packages::out_of_reach(kernel::needs(cache)))
    }

    /// Finds kernel and shim in the folder `cache`, or builds them into it.
    ///
    /// # Errors
    /// When something is missing that only the administrator can install, or a build fails.
    pub(crate) fn prepare(cache: &Path) -> Outcome<Self> {
        packages::require(packages::RUN)?;
        Ok(Self { kernel: kernel::find_or_build(cache)?, shim: shim::find_or_build(cache)? })
    }

    /// The kernel's file.
    pub(crate) fn kernel(&self) -> &Path {
        &self.kernel
    }
}
