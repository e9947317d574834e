//! The guest's kernel: Debian's Linux source, our configuration, kept once built.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;
use std::time::Instant;

use super::packages::{self, BUILD, Need, SOURCE, SOURCE_PACKAGE};
use crate::workspace::Outcome;

const CONFIG: &str = include_str!("../../guest/kernel.config");

/// Finds the kernel in `cache`, or builds it into it (minutes).
///
/// A kept kernel is good if it was built with today's configuration, from the installed source
/// package or, where that is not installed, from any: so a CI machine with a warm cache installs
/// nothing.
///
/// # Errors
/// When packages are missing and cannot be installed, or the build fails; names the build's log.
pub(super) fn find_or_build(cache: &Path) -> Outcome<PathBuf> {
    if let Some(kept) = kept(cache) {
        return Ok(kept);
    }
    packages::require(BUILD)?;
    let version = packages::version(SOURCE_PACKAGE).ok_or("dpkg does not know its source")?;
    let kernel = cache.join(format!("linux-{version}{}", ending()));
    fs::create_dir_all(cache)?;
    build(cache, &kernel)?;
    Ok(kernel)
}

/// What building a kernel would need; nothing if one is kept.
pub(super) fn needs(cache: &Path) -> &'static [Need] {
    if kept(cache).is_some() { &[] } else { BUILD }
}

/// The kept kernel that is good, if there is one.
fn kept(cache: &Path) -> Option<PathBuf> {
    match packages::version(SOURCE_PACKAGE) {
        Some(version) => Some(cache.join(format!("linux-{version}{}", ending())))
            .filter(|kernel| kernel.is_file()),
        None => any_kept(cache, &ending()),
    }
}

/// The end of a kernel's name: its configuration.
fn ending() -> String {
    format!("-{:016x}", fingerprint(CONFIG.as_bytes()))
}

/// A kernel of any version with this configuration; the last by name if there are several.
fn any_kept(cache: &Path, ending: &str) -> Option<PathBuf> {
    let mut kept: Vec<PathBuf> = fs::read_dir(cache)
        .ok()?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            name.starts_with("linux-") && name.ends_with(ending)
        })
        .collect();
    kept.sort();
    kept.pop()
}

fn build(cache: &Path, kernel: &Path) -> Outcome<()> {
    let log = cache.join("build.log");
    let begun = Instant::now();
    eprintln!(
        "building the guest's kernel once, some 4 minutes on two cores; log in {}",
        log.display()
    );
    let folder = tempfile::tempdir_in(cache)?;
    let objects = folder.path().join("objects");
    fs::create_dir(&objects)?;
    let config = folder.path().join("kernel.config");
    fs::write(&config, CONFIG)?;
    let steps = Steps { folder: folder.path(), log: &log };

    steps.run("nice", &["tar", "xJf", SOURCE])?;
    let source = format!("--directory={}", SOURCE_PACKAGE);
    let output = format!("O={}", objects.display());
    let wanted = format!("KCONFIG_ALLCONFIG={}", config.display());
    let jobs = format!("--jobs={}", thread::available_parallelism().map_or(1, usize::from));
    let make = ["make", "--silent", &source, "ARCH=um", &output];
    steps.run("nice", &[&make[..], &[&wanted, "allnoconfig"]].concat())?;
    in_force(CONFIG, &fs::read_to_string(objects.join(".config"))?)?;
    steps.run("nice", &[&make[..], &[&jobs, "linux"]].concat())?;
    let built = objects.join("linux");
    steps.run("strip", &[&built.to_string_lossy()])?;
    // Renamed when whole, so that a second xtask never starts half a kernel.
    fs::rename(&built, kernel)?;
    eprintln!("built {} in {:.0} s", kernel.display(), begun.elapsed().as_secs_f64());
    Ok(())
}

/// Runs the build's steps in its folder, their output into its log.
struct Steps<'a> {
    folder: &'a Path,
    log: &'a Path,
}

impl Steps<'_> {
    fn run(&self, program: &str, arguments: &[&str]) -> Outcome<()> {
        let log = File::options().create(true).append(true).open(self.log)?;
        let status = Command::new(program)
            .args(arguments)
            .current_dir(self.folder)
            .stdout(log.try_clone()?)
            .stderr(log)
            .status()
            .map_err(|error| format!("cannot run {program}: {error}"))?;
        if status.success() {
            return Ok(());
        }
        let step = arguments.join(" ");
        let log = self.log.display();
        Err(format!("building the guest's kernel: `{step}` failed ({status}); see {log}").into())
    }
}

/// Every line of `wanted` stands in `got`: the kernel's own rules drop a line without a word.
fn in_force(wanted: &str, got: &str) -> Outcome<()> {
    let settings = wanted.lines().filter(|line| line.starts_with("CONFIG_"));
    let dropped: Vec<&str> = settings.filter(|line| !got.lines().any(|set| set == *line)).collect();
    if dropped.is_empty() {
        return Ok(());
    }
    let list = dropped.join(", ");
    Err(format!("tools/xtask/guest/kernel.config: this kernel does not take {list}").into())
}

/// FNV-1a, 64 bits: names a file by its content, the same on every machine and toolchain.
pub(super) fn fingerprint(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dropped_setting_is_named() {
        let wanted = "# CAN\nCONFIG_CAN=y\nCONFIG_CAN_VCAN=y\n";
        assert!(in_force(wanted, "CONFIG_CAN=y\nCONFIG_CAN_VCAN=y\nCONFIG_X=y\n").is_ok());
        let error = in_force(wanted, "CONFIG_CAN=y\n# CONFIG_CAN_VCAN is not set\n").unwrap_err();
        assert!(error.to_string().ends_with("does not take CONFIG_CAN_VCAN=y"), "{error}");
    }

    /// Values of the FNV authors' own test suite.
    #[test]
    fn the_fingerprint_is_fnv_1a() {
        assert_eq!(fingerprint(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fingerprint(b"foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn a_kept_kernel_of_another_configuration_is_not_taken() {
        let cache = tempfile::tempdir().unwrap();
        fs::write(cache.path().join("linux-6.1.9-aa"), "").unwrap();
        fs::write(cache.path().join("linux-6.1.1-bb"), "").unwrap();
        fs::write(cache.path().join("linux-6.1.2-bb"), "").unwrap();
        assert_eq!(any_kept(cache.path(), "-bb"), Some(cache.path().join("linux-6.1.2-bb")));
        assert_eq!(any_kept(cache.path(), "-cc"), None);
    }
}
