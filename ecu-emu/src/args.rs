//! The command line of `ecu-emu`.

use std::path::PathBuf;

use clap::Parser;
use ecu_emu::{Profile, Quirks, SensorFault, UnknownWire, Wire};
use xt28_sim::Solver;

/// The Xt28's two ECUs on a CAN interface, with a simulated machine behind them.
///
/// Sends every frame that the pendulum-arm ECU (SMS), the transmission ECU (DMS) and the engine
/// send, takes the remote command frames, and plays the machine's GNSS receiver on a
/// pseudo-terminal. The first line on stdout is a JSON object that names that terminal; say
/// `gateway --gnss` its path. Runs until it is stopped (Ctrl-C) or `--duration` is over.
///
/// Exit status: 0 stopped as asked, 2 usage or I/O.
#[derive(Debug, Parser)]
#[command(name = "ecu-emu", version, about, long_about)]
pub(crate) struct Args {
    /// CAN interface: `vcan0`, `can0`
    #[arg(long, value_name = "INTERFACE")]
    pub(crate) bus: String,

    /// Machine file (TOML); the nominal Xt28 without it
    #[arg(long, value_name = "FILE")]
    pub(crate) machine: Option<PathBuf>,

    /// Terrain file (TOML); level ground without it
    #[arg(long, value_name = "FILE")]
    pub(crate) terrain: Option<PathBuf>,

    /// Effects that the machine has beyond the nominal one (TOML; `xt28 effects` lists them)
    #[arg(long, value_name = "FILE")]
    pub(crate) effects: Option<PathBuf>,

    /// What solves the rigid bodies: `rapier`, the reference, or `reduced`, the fast core
    #[arg(long, value_name = "NAME", default_value_t)]
    pub(crate) solver: Solver,

    /// Whose control runs: `paper`, or the firmware of `2016`, which an operator drives
    #[arg(long, value_name = "NAME", default_value_t)]
    pub(crate) profile: Profile,

    /// What the operator does in the cab (TOML); profile 2016 only
    #[arg(long, value_name = "FILE")]
    pub(crate) operator: Option<PathBuf>,

    /// Put another of the machine's wires on an interface, not that of `--bus`, both ways: `inertial`,
    /// `left-armrest`, `right-armrest`, `engine` or `display`. Where an armrest's is named and no
    /// operator, the armrests are somebody else's
    #[arg(long = "wire", value_name = "WIRE=INTERFACE", value_parser = wire)]
    pub(crate) wires: Vec<(Wire, String)>,

    /// Switch an oddity of the firmware on or off (docs/firmware-2016.md); profile 2016 only
    #[arg(long = "quirk", value_name = "NAME=on|off", value_parser = quirk)]
    pub(crate) quirks: Vec<(String, bool)>,

    /// Seed of the sensor noise; exact sensors without it
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,

    /// What goes wrong with sensors and supply (TOML: `[[fault]]`, `[[event]]`)
    #[arg(long, value_name = "FILE")]
    pub(crate) mishaps: Option<PathBuf>,

    /// A sensor that fails: `SENSOR[:WHEEL]:KIND[=BY]@FROM_S[-TO_S]`, BY in mV, of a wheel speed in
    /// Hz; `stroke:FR:offset=100@5-8`. May be given more than once
    #[arg(long, value_name = "FAULT")]
    pub(crate) sensor_fault: Vec<SensorFault>,

    /// Stroke of all six cylinders at the start
    #[arg(long, value_name = "MM", default_value_t = 170.0, value_parser = stroke_mm)]
    pub(crate) stroke_mm: f64,

    /// Stop after this long
    #[arg(long, value_name = "S", value_parser = duration_s, allow_negative_numbers = true)]
    pub(crate) duration: Option<f64>,

    /// Link the receiver's pseudo-terminal to this path
    #[arg(long, value_name = "PATH")]
    pub(crate) gnss_link: Option<PathBuf>,

    /// Write what is true of the machine, tick by tick (CSV)
    #[arg(long, value_name = "FILE")]
    pub(crate) truth: Option<PathBuf>,
}

fn wire(text: &str) -> Result<(Wire, String), String> {
    let (wire, interface) = text.split_once('=').ok_or("give WIRE=INTERFACE")?;
    let wire = wire.parse().map_err(|error: UnknownWire| error.to_string())?;
    Ok((wire, interface.to_owned()))
}

fn quirk(text: &str) -> Result<(String, bool), String> {
    let (name, on) = match text.split_once('=') {
        Some((name, "on")) => (name, true),
        Some((name, "off")) => (name, false),
        _ => return Err("give NAME=on or NAME=off".to_owned()),
    };
    // Only to refuse a name that there is not.
    Quirks::none().set(name, on).map_err(|error| error.to_string())?;
    Ok((name.to_owned(), on))
}

fn stroke_mm(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        // How far a cylinder goes, the machine file says.
        Ok(mm) if mm.is_finite() && mm >= 0.0 => Ok(mm),
        _ => Err("a stroke is a number of mm, no less than zero".to_owned()),
    }
}

fn duration_s(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(s) if s > 0.0 && s <= 1e7 => Ok(s),
        _ => Err("a duration is a number of seconds above zero, at most 1e7".to_owned()),
    }
}
