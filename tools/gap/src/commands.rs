//! The commands of a log in order of time, said again as our own frames.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::{ArmTarget, ArmTargetMode, ArmValve, DriveTarget};
use xt28_dbc::{EncodeError, Frame};
use xt28_machine::{PerWheel, Wheel};

use crate::{Channel, FieldLog, GapError, Series};

/// One command, in SI. What a log does not say is what a gateway of ours would.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Command {
    /// Strokes for the position controller, m, and the arms' mode.
    Arm { stroke_m: PerWheel<f64>, mode: ArmTargetMode },
    /// Valve openings, -1 to 1, positive extends.
    Valve { opening: PerWheel<f64> },
    /// Throttle -1 to 1, front joint rad, engine rad/s.
    Drive { throttle: f64, joint_rad: f64, engine_rad_s: f64, brake: bool, enable: bool },
}

/// The commands of a log, oldest first, with the instant of each in s from the first frame.
pub(crate) fn commands(log: &FieldLog, idle_rpm: f64) -> Result<Vec<(f64, Command)>, GapError> {
    let arm: Vec<Channel> =
        Wheel::ALL.map(Channel::TargetStroke).into_iter().chain([Channel::ArmMode]).collect();
    let valve = Wheel::ALL.map(Channel::TargetOpening);
    let drive = [Channel::Throttle, Channel::TargetJoint, Channel::Enable];

    let mut commands = Vec::new();
    for (at_s, v) in joined(log, &arm) {
        let refuse = |problem| GapError::Command { log: log.name().to_owned(), at_s, problem };
        let mode = mode(v[6]).map_err(refuse)?;
        let stroke_m = PerWheel([v[0], v[1], v[2], v[3], v[4], v[5]]);
        commands.push((at_s, Command::Arm { stroke_m, mode }));
    }
    for (at_s, v) in joined(log, &valve) {
        let opening = PerWheel([v[0], v[1], v[2], v[3], v[4], v[5]]);
        commands.push((at_s, Command::Valve { opening }));
    }
    for (at_s, v) in joined(log, &drive) {
        let also = |channel, idle| log.series(channel).and_then(|s| s.at(at_s)).unwrap_or(idle);
        commands.push((
            at_s,
            Command::Drive {
                throttle: v[0],
                joint_rad: v[1],
                engine_rad_s: also(Channel::TargetEngineSpeed, idle_rpm * TAU / 60.0),
                brake: also(Channel::Brake, 0.0) != 0.0,
                enable: v[2] != 0.0,
            },
        ));
    }
    commands.sort_by(|(a_s, _), (b_s, _)| a_s.total_cmp(b_s));
    Ok(commands)
}

/// Values of `channels` at every instant at which one of them came, once all are known.
///
/// Where all sit in one message, as on our own bus, that is once a frame.
fn joined(log: &FieldLog, channels: &[Channel]) -> Vec<(f64, Vec<f64>)> {
    let series: Option<Vec<&Series>> = channels.iter().map(|&c| log.series(c)).collect();
    let Some(series) = series else { return Vec::new() };
    // Non-negative floats order as their bits do.
    let instants: BTreeSet<u64> =
        series.iter().flat_map(|s| s.iter()).map(|(at_s, _)| at_s.to_bits()).collect();
    let known = |bits: u64| {
        let at_s = f64::from_bits(bits);
        let values = series.iter().map(|s| s.at(at_s)).collect::<Option<Vec<f64>>>()?;
        Some((at_s, values))
    };
    instants.into_iter().filter_map(known).collect()
}

fn mode(value: f64) -> Result<ArmTargetMode, String> {
    let is = |mode: &ArmTargetMode| (value - f64::from(*mode as u8)).abs() < 0.5;
    let found = ArmTargetMode::ALL.into_iter().find(is);
    found.ok_or_else(|| {
        format!("arm mode {value} is none of 0 off, 1 automatic, 2 manual position, 3 manual valve")
    })
}

/// Says commands as frames, with counters of its own: those of the log need not be ours.
#[derive(Debug, Default)]
pub(crate) struct Speaker {
    arm: AliveCounter,
    valve: AliveCounter,
    drive: AliveCounter,
}

impl Speaker {
    pub(crate) fn frame(&mut self, command: &Command) -> Result<Frame, EncodeError> {
        match *command {
            Command::Arm { stroke_m, mode } => {
                let [fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm] = stroke_m.map(|m| m * 1e3).0;
                let counter = self.arm.next_count();
                ArmTarget { fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm, mode, counter }.encode()
            }
            Command::Valve { opening } => {
                let [fr, fl, mr, ml, br, bl] = opening.map(|share| share * 100.0).0;
                let counter = self.valve.next_count();
                ArmValve {
                    fr_percent: fr,
                    fl_percent: fl,
                    mr_percent: mr,
                    ml_percent: ml,
                    br_percent: br,
                    bl_percent: bl,
                    counter,
                }
                .encode()
            }
            Command::Drive { throttle, joint_rad, engine_rad_s, brake, enable } => DriveTarget {
                throttle_percent: throttle * 100.0,
                front_angle_deg: joint_rad.to_degrees(),
                engine_speed_rpm: engine_rad_s * 60.0 / TAU,
                brake,
                enable,
                counter: self.drive.next_count(),
            }
            .encode(),
        }
    }
}
