//! The command line.

use std::path::PathBuf;

use clap::Parser;
use gateway::{Fix, Geodetic};

/// Drive an Xt28 over CAN: a policy's actions become frames, under the safety kernel.
///
/// Arms by itself once both ECUs and all sensors are alive, and the GNSS receiver and the controller where the
/// policy needs one. Ends when the policy is done or the safety kernel has stopped it; with --duration only after
/// that time. SIGUSR1 is the order to arm: again after a safety stop, and at all where controllers beyond this
/// machine may connect. SIGINT and SIGTERM stop the machine, go silent, then exit; a second one exits at once,
/// and leaves the stop to the ECUs. SIGUSR2 is the emergency stop: no
/// order arms after it, only a new run does.
///
/// Exit code: 0 done (or interrupted where there was nothing to be done, as in hold), 1 not done
/// (goal missed, safety stop, interrupted on the way), 2 usage or I/O.
#[derive(Debug, Parser)]
#[command(name = "gateway", version)]
pub(crate) struct Args {
    /// CAN interface that the ECUs are on
    #[arg(long, value_name = "INTERFACE")]
    pub(crate) bus: String,

    /// What drives: goto:X,Y,HEADING_DEG (metres east and north of the origin, degrees
    /// counter-clockwise from east), network:FILE[@X,Y,HEADING_DEG] (a learnt policy by its policy file, TOML, with a
    /// goal where it sees one), script:FILE (timed commands, TOML), rosbridge:[ADDRESS:]PORT (a controller that
    /// connects there, asked at each fix; with `,tick` behind it at 100 Hz) or hold
    #[arg(long, value_name = "POLICY")]
    pub(crate) policy: String,

    /// Serial port of the u-blox receiver (NAV-PVT, NAV-RELPOSNED and, better, NAV-HPPOSLLH): the rover of a moving
    /// base, its antenna ahead of the base's on the machine's axis
    #[arg(long, value_name = "DEVICE")]
    pub(crate) gnss: Option<PathBuf>,

    /// Terrain file (TOML) that the local height map of a network or a controller is cut from; without it there is
    /// no such map
    #[arg(long, value_name = "FILE")]
    pub(crate) map: Option<PathBuf>,

    /// Machine file; the built-in Xt28 when left out
    #[arg(long, value_name = "FILE")]
    pub(crate) machine: Option<PathBuf>,

    /// The worst fix that the machine is driven by
    #[arg(long, value_name = "FIX", value_enum, default_value_t = LeastFix::Float)]
    pub(crate) least_fix: LeastFix,

    /// The worst horizontal accuracy, as the receiver estimates it, that the machine is driven by
    #[arg(long, value_name = "M", value_parser = metres, default_value = "0.5", allow_negative_numbers = true)]
    pub(crate) least_accuracy: f64,

    /// Origin of the local frame: degrees, degrees, metres above the ellipsoid
    #[arg(long, value_name = "LAT,LON,H", value_parser = origin, default_value = "59.8,17.9,20",
          allow_hyphen_values = true)]
    pub(crate) origin: Geodetic,

    /// Order the stop after this many seconds, done or not; it takes another second and a half
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) duration: Option<f64>,

    /// Give up when not armed after this many seconds
    #[arg(long, value_name = "S", value_parser = seconds, default_value = "30", allow_negative_numbers = true)]
    pub(crate) arm_within: f64,

    /// Write every frame sent and received to a candump log; a file that holds something is not written over
    #[arg(long, value_name = "FILE")]
    pub(crate) record: Option<PathBuf>,

    /// Print the result on stdout as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Kinds of fix, worst first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum LeastFix {
    /// Satellites alone, metres
    Single,
    /// With corrections to the code, some decimetres
    Differential,
    /// Carrier phase, decimetres
    Float,
    /// Carrier phase with fixed ambiguities, centimetres
    Fixed,
}

impl From<LeastFix> for Fix {
    fn from(fix: LeastFix) -> Self {
        match fix {
            LeastFix::Single => Self::Single,
            LeastFix::Differential => Self::Differential,
            LeastFix::Float => Self::RtkFloat,
            LeastFix::Fixed => Self::RtkFixed,
        }
    }
}

fn metres(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(m) if m > 0.0 && m.is_finite() => Ok(m),
        _ => Err("give metres above 0, as 0.5".to_owned()),
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(s) if s > 0.0 && s <= 1e7 => Ok(s),
        _ => Err("give seconds above 0, and no more than 10000000".to_owned()),
    }
}

fn origin(text: &str) -> Result<Geodetic, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[latitude, longitude, height])
            if latitude.abs() <= 90.0 && longitude.abs() <= 180.0 && height.abs() < 1e5 =>
        {
            Ok(Geodetic::from_degrees(latitude, longitude, height))
        }
        _ => {
            Err("give latitude, longitude in degrees and height in metres, as 59.8,17.9,20"
                .to_owned())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_sound_and_its_default_origin_the_benchs() {
        let args = Args::try_parse_from(["gateway", "--bus", "can0", "--policy", "hold"]).unwrap();
        assert_eq!(args.origin, Geodetic::BENCH_ORIGIN);
        assert!(origin("-33.9,18.4,100").is_ok());
        for bad in ["", "59.8,17.9", "91,0,0", "0,181,0", "nan,0,0"] {
            assert!(origin(bad).unwrap_err().contains("59.8,17.9,20"), "{bad}");
        }
        assert!(metres("0").is_err() && metres("inf").is_err() && metres("0.3").is_ok());
        assert!(seconds("1e9").unwrap_err().contains("no more than"));
        assert!(seconds("nan").is_err() && seconds("-1").is_err() && seconds("0.5").is_ok());
    }
}
