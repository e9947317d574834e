//! The Debian packages that the guest is built from and run with.

use std::path::Path;
use std::process::Command;

use crate::workspace::Outcome;

/// One thing to have: how to see that it is there, and which package brings it.
pub(super) struct Need {
    /// A file of the package.
    file: &'static str,
    package: &'static str,
}

const fn need(package: &'static str, file: &'static str) -> Need {
    Need { file, package }
}

/// What a guest needs to run. Its init is a bash script with `ip`; a shim is compiled for it.
pub(super) const RUN: &[Need] = &[
    need("iproute2", "/bin/ip"),
    need("can-utils", "/usr/bin/candump"),
    need("gcc", "/usr/bin/cc"),
    need("libc6-dev", "/usr/include/elf.h"),
];

/// The archive that the kernel is built from.
pub(super) const SOURCE: &str = "/usr/src/linux-source-6.1.tar.xz";
/// The package that brings it.
pub(super) const SOURCE_PACKAGE: &str = "linux-source-6.1";

/// What the kernel's build needs beyond [`RUN`].
pub(super) const BUILD: &[Need] = &[
    need(SOURCE_PACKAGE, SOURCE),
    need("bc", "/usr/bin/bc"),
    need("bison", "/usr/bin/bison"),
    need("flex", "/usr/bin/flex"),
    need("make", "/usr/bin/make"),
    need("xz-utils", "/usr/bin/xz"),
];

fn missing(needs: &[Need]) -> Vec<&'static str> {
    let absent = |need: &&Need| !Path::new(need.file).exists();
    needs.iter().filter(absent).map(|need| need.package).collect()
}

/// What somebody would have to do first to have everything of `needs`. Nothing is installed on anybody's
/// machine unasked.
pub(super) fn out_of_reach(needs: &[Need]) -> Option<String> {
    let missing = missing(needs);
    let list = missing.join(" ");
    (!missing.is_empty())
        .then(|| format!("as root: apt-get install --no-install-recommends {list}"))
}

/// Refuses to go on without everything of `needs`.
///
/// # Errors
/// Names the missing packages and the command that installs them.
pub(super) fn require(needs: &[Need]) -> Outcome<()> {
    out_of_reach(needs)
        .map_or(Ok(()), |remedy| Err(format!("the guest needs Debian packages; {remedy}").into()))
}

/// The installed version of a package; `None` where there is none, or no dpkg.
pub(super) fn version(package: &str) -> Option<String> {
    let query = Command::new("dpkg-query")
        .args(["--show", "--showformat=${db:Status-Status} ${Version}", package])
        .output()
        .ok()?;
    let said = String::from_utf8(query.stdout).ok()?;
    said.strip_prefix("installed ").map(str::to_owned)
}
