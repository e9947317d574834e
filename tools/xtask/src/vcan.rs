//! `cargo xtask vcan`: a command where a real vcan0 and vcan1 exist, on the host or in a guest.

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Duration;

use clap::Args;

use crate::guest::{Ending, Guest, Job};
use crate::workspace::Outcome;

/// Where kernel and shim are kept.
#[derive(Args, Clone)]
pub(crate) struct Cache {
    /// Folder that keeps the guest's kernel [default: $XT28_GUEST_CACHE, or target/guest-kernel]
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
}

impl Cache {
    /// The folder in force.
    ///
    /// # Errors
    /// When the current folder is gone.
    pub(crate) fn folder(&self, target: &std::path::Path) -> Outcome<PathBuf> {
        let given = self.cache.clone();
        let given = given.or_else(|| std::env::var_os("XT28_GUEST_CACHE").map(PathBuf::from));
        Ok(std::path::absolute(given.unwrap_or_else(|| target.join("guest-kernel")))?)
    }
}

/// Run a command where a real vcan0 and vcan1 exist
///
/// On the host's kernel where that can make them, else in a User Mode Linux guest whose root is
/// the host's file tree. Exits with the command's code; 124 if its time ran out, 125 if the guest
/// died or could not be had.
#[derive(Args)]
pub(crate) struct Vcan {
    /// Let the guest's clock move only while all processes sleep; always in a guest
    #[arg(long)]
    virtual_time: bool,
    /// Use a guest even where the host has vcan
    #[arg(long)]
    guest: bool,
    /// Wall time after which a guest is ended, s
    #[arg(long, value_name = "SECONDS", default_value_t = 1800)]
    timeout: u64,
    /// Memory of a guest, MiB
    #[arg(long, value_name = "MIB", default_value_t = 2048)]
    memory: u32,
    #[command(flatten)]
    cache: Cache,
    /// The command
    #[arg(last = true, required = true, value_name = "CMD")]
    command: Vec<OsString>,
}

impl Vcan {
    /// Runs the command and gives its exit code.
    ///
    /// # Errors
    /// When there is neither vcan on the host nor a guest to be had.
    pub(crate) fn execute(&self, target: &std::path::Path) -> Outcome<u8> {
        if !self.virtual_time && !self.guest && host_has_vcan() {
            return self.on_the_host();
        }
        let guest = Guest::prepare(&self.cache.folder(target)?)?;
        let job = Job {
            command: self.command.clone(),
            folder: std::env::current_dir()?,
            environment: Vec::new(),
            virtual_time: self.virtual_time,
            timeout: Duration::from_secs(self.timeout),
            memory_mib: self.memory,
        };
        Ok(match guest.run(&job)? {
            Ending::Exit(code) => code,
            Ending::TimedOut => {
                eprintln!("xtask: the guest was ended after {} s", self.timeout);
                124
            }
            Ending::Died(last) => {
                eprintln!("xtask: the guest died; its kernel's last lines:\n{last}");
                125
            }
        })
    }

    fn on_the_host(&self) -> Outcome<u8> {
        let (program, arguments) = self.command.split_first().ok_or("no command given")?;
        let status = Command::new(program)
            .args(arguments)
            .status()
            .map_err(|error| format!("cannot run {}: {error}", program.display()))?;
        // Ended by a signal: what a shell would say is out of reach, so say what `timeout` does.
        Ok(status.code().map_or(137, |code| u8::try_from(code).unwrap_or(u8::MAX)))
    }
}

/// True if both interfaces are up on the host, made now if need be and if we may.
fn host_has_vcan() -> bool {
    ["vcan0", "vcan1"].iter().all(|bus| {
        let made =
            ip(&["link", "show", "dev", bus]) || ip(&["link", "add", "dev", bus, "type", "vcan"]);
        made && (is_up(bus) || ip(&["link", "set", "dev", bus, "mtu", "72", "up"]))
    })
}

fn is_up(bus: &str) -> bool {
    let flags = std::fs::read_to_string(format!("/sys/class/net/{bus}/flags"));
    let flags = flags
        .ok()
        .and_then(|text| u32::from_str_radix(text.trim().trim_start_matches("0x"), 16).ok());
    // IFF_UP of netdevice(7).
    flags.is_some_and(|flags| flags & 1 != 0)
}

fn ip(arguments: &[&str]) -> bool {
    let mut command = Command::new("ip");
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}
