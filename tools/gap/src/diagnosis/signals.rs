//! A log on one clock: every channel that diagnosis reads, sampled a hundred times a second.

mod command_period;
mod made;
mod motors;
mod receiver;
mod settling;
mod smoothed;
mod uncut;

use std::collections::BTreeMap;

use xt28_ecus::pins;
use xt28_machine::{PerWheel, Wheel};
use xt28_sim::Terrain;

use super::floors::Floors;
use crate::{Channel, FieldLog, GapError, PumpSide, Series, SteerSide};
pub(in crate::diagnosis) use command_period::{PERIOD_S, command_periods_s};
use made::Made;
pub(in crate::diagnosis) use made::Make;
pub(in crate::diagnosis) use receiver::unwound;
pub use smoothed::StrokeJump;
pub(in crate::diagnosis) use smoothed::slope_over;
pub(in crate::diagnosis) use smoothed::{SMOOTHED, moving_mean, smooth};
use smoothed::{Swing, slope};
use uncut::uncut;

/// Time series by channel, as logs and replays have them.
type AllSeries = BTreeMap<Channel, Series>;

/// Time between two samples, s: the ECUs' own period.
pub const DT_S: f64 = 0.01;

/// Samples of one channel on the common clock; SI.
pub type Samples = Vec<f64>;

/// One run, ready for diagnosis. Where a channel is missing its samples are empty.
#[derive(Clone, Debug)]
pub struct Signals {
    /// Name of the log, or what its run is called.
    pub name: String,
    /// The ground it was driven on, as far as one knows.
    pub terrain: Terrain,
    /// When it began on the day that all runs were driven on, s of recording; 0 where nobody knows which was first.
    pub began_s: f64,
    /// Number of samples.
    pub len: usize,
    /// Stroke commanded; where the arm stood, while it is to be held.
    pub target_stroke_m: PerWheel<Samples>,
    /// Whether the arm itself is to be held, its valve shut.
    pub is_arm_held: PerWheel<Vec<bool>>,
    /// Mode of the arms commanded, 0 to 3.
    pub arm_mode: Samples,
    /// Opening that the ECU's currents ask of each arm valve, -1 to 1.
    pub opening: PerWheel<Samples>,
    /// Strokes as read: whole millimetres, cut off.
    pub stroke_reading_m: PerWheel<Samples>,
    /// Strokes as they were between two readings.
    pub stroke_m: PerWheel<Samples>,
    /// Stroke rates: slope of the reading over 0.2 s.
    pub stroke_rate_m_s: PerWheel<Samples>,
    /// Strokes and wheel speeds through one and the same filter, so that they can be held against one
    /// another: two means of 0.3 s each, of strokes as read.
    pub smooth_stroke_m: PerWheel<Samples>,
    /// Slope of the smooth strokes.
    pub smooth_stroke_rate_m_s: PerWheel<Samples>,
    /// Where the readings of strokes jump.
    pub stroke_jumps: PerWheel<Vec<StrokeJump>>,
    /// Smooth wheel speeds, forward > 0.
    pub smooth_wheel_speed_rad_s: PerWheel<Samples>,
    /// Loads of the cylinders, from their pressures.
    pub cylinder_load_n: PerWheel<Samples>,
    /// Pressures of chambers A and B, Pa, as the ECU's filter shows them; empty where not logged.
    pub chamber_pa: PerWheel<[Samples; 2]>,
    /// Whether the load (pressures where logged) is a reading of this very sample.
    pub load_is_new: PerWheel<Vec<bool>>,
    /// Wheel speeds, forward > 0.
    pub wheel_speed_rad_s: PerWheel<Samples>,
    /// Opening that the ECU's currents ask of the front and the rear steering valve.
    pub steer_opening: [Samples; 2],
    /// Front and rear joint, left > 0.
    pub joint_rad: [Samples; 2],
    /// Joint rates: slope of the angle over 0.1 s.
    pub joint_rate_rad_s: [Samples; 2],
    /// Whether the currents of the drive's ECU came in this very sample.
    pub is_fresh_drive_current: Vec<bool>,
    /// The same of the pumps' pressures.
    pub is_fresh_pump_pressure: Vec<bool>,
    /// Instants at which commands to the arms and to the drive came, s.
    pub command_times_s: [Vec<f64>; 2],
    /// Front joint commanded.
    pub target_joint_rad: Samples,
    /// Throttle commanded, -1 to 1.
    pub throttle: Samples,
    /// Parking brake commanded, 0 or 1; empty where not logged.
    pub brake: Samples,
    /// Pump pressures 1A 1B 2A 2B.
    pub pump_pressure_pa: [Samples; 4],
    /// Displacement of each motor as a share of the largest of the six, 0 to 1; empty where their currents are
    /// not logged.
    pub motor_share: PerWheel<Samples>,
    /// Roll of the front frame, right side high > 0.
    pub roll_rad: Samples,
    /// Pitch of the front frame, nose up > 0.
    pub pitch_rad: Samples,
    /// Antenna, east and north, with the instants of its fixes: s, m, m.
    pub fixes: Vec<[f64; 3]>,
    /// Heading with its rate, with the instants at which they were told, which need not be those of fixes:
    /// s, rad, unwound, counter-clockwise from east, rad/s.
    pub headings: Vec<[f64; 3]>,
    /// What separates two models of one machine with readings as noisy as these.
    pub floors: Floors,
    /// Torque with which wheels resist their rolling beyond what is ordinary, Nm: what all runs of a machine
    /// say together, none before they were asked ([`super::share_resistance`]).
    pub resists_nm: f64,
    made: Made,
}

impl Signals {
    /// The channels of `log`, sampled from its start to its end.
    ///
    /// # Errors
    /// [`GapError::Unmeasured`] names the channels that the log has not.
    pub fn new(log: &FieldLog, terrain: Terrain) -> Result<Self, GapError> {
        Self::of_series(log.name(), log.all_series(), log.duration_s(), terrain)
    }

    /// `series` sampled for `duration_s` s, under the name of `name`.
    ///
    /// # Errors
    /// [`GapError::Unmeasured`] names the channels that are not there.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub fn of_series(
        name: &str,
        series: &AllSeries,
        duration_s: f64,
        terrain: Terrain,
    ) -> Result<Self, GapError> {
        complete(name, series)?;
        let len = (duration_s / DT_S) as usize;
        let sample = |channel| held(series.get(&channel), len);
        let fresh = |channel| is_new(series.get(&channel), len);
        let wheels = |make: fn(Wheel) -> Channel| PerWheel::from_fn(|wheel| sample(make(wheel)));
        let (a, b) = (wheels(Channel::RetractCurrent), wheels(Channel::ExtendCurrent));
        let both = |a: &Samples, b: &Samples, opening: fn(f64, f64) -> f64| {
            a.iter().zip(b).map(|(a, b)| opening(a * 1e3, b * 1e3)).collect()
        };
        let steer = |a, b| {
            let (a, b) = (sample(Channel::SteerCurrent(a)), sample(Channel::SteerCurrent(b)));
            both(&a, &b, pins::steer_opening)
        };
        let stroke_reading_m = wheels(Channel::Stroke);
        let mut target_stroke_m = wheels(Channel::TargetStroke);
        let is_arm_held =
            PerWheel::from_fn(|w| hold(&mut target_stroke_m[w], &stroke_reading_m[w]));
        let swing =
            PerWheel::from_fn(|w| Swing::new(&stroke_reading_m[w], &fresh(Channel::Stroke(w))));
        let wheel_speed_rad_s = wheels(Channel::WheelSpeed);
        let stroke_m = stroke_reading_m.clone().map(|reading| uncut(&reading));
        Ok(Self {
            name: name.to_owned(),
            terrain,
            began_s: 0.0,
            len,
            target_stroke_m,
            is_arm_held,
            arm_mode: sample(Channel::ArmMode),
            opening: PerWheel::from_fn(|w| both(&a[w], &b[w], pins::valve_opening)),
            stroke_rate_m_s: PerWheel::from_fn(|w| slope(&stroke_m[w])),
            stroke_m,
            stroke_reading_m,
            stroke_jumps: PerWheel::from_fn(|w| swing[w].jumps().collect()),
            smooth_stroke_rate_m_s: PerWheel::from_fn(|w| swing[w].rate_m_s()),
            smooth_stroke_m: PerWheel::from_fn(|w| swing[w].stroke_m()),
            smooth_wheel_speed_rad_s: PerWheel::from_fn(|w| smooth(&wheel_speed_rad_s[w])),
            wheel_speed_rad_s,
            cylinder_load_n: wheels(Channel::CylinderLoad),
            chamber_pa: PerWheel::from_fn(|w| {
                [sample(Channel::BorePressure(w)), sample(Channel::RodPressure(w))]
            }),
            load_is_new: PerWheel::from_fn(|w| fresh(load_channel(series, w))),
            steer_opening: [
                steer(SteerSide::FrontA, SteerSide::FrontB),
                steer(SteerSide::RearA, SteerSide::RearB),
            ],
            joint_rate_rad_s: [Channel::FrontJoint, Channel::RearJoint]
                .map(|channel| slope_over(&sample(channel), 5)),
            joint_rad: [sample(Channel::FrontJoint), sample(Channel::RearJoint)],
            is_fresh_drive_current: fresh(Channel::SteerCurrent(SteerSide::FrontA)),
            is_fresh_pump_pressure: fresh(Channel::PumpPressure(PumpSide::OneA)),
            command_times_s: [Channel::ArmMode, Channel::Throttle].map(|channel| {
                series.get(&channel).map_or_else(Vec::new, |s| s.iter().map(|(at, _)| at).collect())
            }),
            target_joint_rad: sample(Channel::TargetJoint),
            throttle: sample(Channel::Throttle),
            brake: sample(Channel::Brake),
            pump_pressure_pa: PumpSide::ALL.map(|side| sample(Channel::PumpPressure(side))),
            motor_share: motors::shares(&wheels(Channel::MotorCurrent)),
            roll_rad: sample(Channel::Roll),
            pitch_rad: sample(Channel::Pitch),
            fixes: receiver::fixes(series),
            headings: receiver::headings(series),
            floors: Floors::default(),
            resists_nm: 0.0,
            made: Made::default(),
        })
    }

    /// Length of the run, s.
    #[must_use]
    #[allow(clippy::cast_precision_loss)]
    pub fn duration_s(&self) -> f64 {
        self.len as f64 * DT_S
    }

    /// Mean of the six wheel speeds at sample `i`, rad/s.
    #[must_use]
    pub fn mean_wheel_speed_rad_s(&self, i: usize) -> f64 {
        self.wheel_speed_rad_s.iter().map(|(_, s)| s[i]).sum::<f64>() / 6.0
    }

    /// Whether the parking brake is to hold the machine at sample `i`; no, where nobody logged it.
    pub(in crate::diagnosis) fn is_braked(&self, i: usize) -> bool {
        self.brake.get(i).is_some_and(|on| *on != 0.0)
    }
}

/// The channels without which the blocks cannot be driven; a receiver may be missing.
pub(crate) fn needed() -> impl Iterator<Item = Channel> {
    sampled().filter(|channel| !is_extra(*channel))
}

/// The channels that are held from one sample to the next, where they are logged: what is needed, and more.
pub(crate) fn sampled() -> impl Iterator<Item = Channel> {
    let receiver = [Channel::East, Channel::North, Channel::Heading];
    let unused = |channel: &Channel| {
        matches!(
            channel,
            Channel::WheelLoad(_)
                | Channel::PumpCurrent(_)
                | Channel::TargetOpening(_)
                | Channel::TargetEngineSpeed
                | Channel::Enable
        )
    };
    Channel::all().into_iter().filter(move |c| !receiver.contains(c) && !unused(c))
}

/// Whether blocks are judged by it where it is logged, and do without it where it is not.
const fn is_extra(channel: Channel) -> bool {
    matches!(
        channel,
        Channel::BorePressure(_)
            | Channel::RodPressure(_)
            | Channel::Brake
            | Channel::MotorCurrent(_)
    )
}

/// What the load of a cylinder is read from: its pressures where they are logged.
fn load_channel(series: &AllSeries, wheel: Wheel) -> Channel {
    let pressures = [Channel::BorePressure(wheel), Channel::RodPressure(wheel)];
    let logged = pressures.iter().all(|channel| series.contains_key(channel));
    if logged { pressures[0] } else { Channel::CylinderLoad(wheel) }
}

/// Mode of the arms in which targets count and the PI is at work (the wire contract: manual position).
pub(super) const MANUAL_POSITION: f64 = 2.0;
/// Target from which on it is none: it says to hold the arm (the wire contract: 510 mm).
const HOLDS_M: f64 = 0.5095;

/// Where `target_m` says to hold the arm; the target there becomes the stroke at which it was told so.
fn hold(target_m: &mut Samples, reading_m: &Samples) -> Vec<bool> {
    let mut stands_m = None;
    let told = target_m.iter_mut().zip(reading_m).map(|(target_m, reading_m)| {
        let holds = *target_m > HOLDS_M;
        stands_m = holds.then(|| stands_m.unwrap_or(*reading_m));
        *target_m = stands_m.unwrap_or(*target_m);
        holds
    });
    told.collect()
}

/// Refuses `series` that lack what diagnosis needs.
fn complete(name: &str, series: &AllSeries) -> Result<(), GapError> {
    let missing: Vec<String> = needed()
        .filter(|channel| series.get(channel).is_none_or(Series::is_empty))
        .map(|channel| channel.to_string())
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    Err(GapError::Unmeasured { log: name.to_owned(), channels: missing.join(", ") })
}

/// The value in force at each instant of the clock; before the first sample, the first.
#[allow(clippy::cast_precision_loss)]
fn held(series: Option<&Series>, len: usize) -> Samples {
    let Some(series) = series else { return Samples::new() };
    let mut ahead = series.iter().peekable();
    let Some((_, mut value)) = ahead.peek().copied() else { return Samples::new() };
    let sample = |i: usize| {
        let at_s = i as f64 * DT_S + 0.5 * DT_S;
        while let Some((_, next)) = ahead.next_if(|(sample_s, _)| *sample_s <= at_s) {
            value = next;
        }
        value
    };
    (0..len).map(sample).collect()
}

/// Whether a sample came since the instant before.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn is_new(series: Option<&Series>, len: usize) -> Vec<bool> {
    let mut new = vec![false; len];
    for (at_s, _) in series.into_iter().flat_map(Series::iter) {
        // The first instant of the clock that is not before it.
        if let Some(new) = new.get_mut((at_s / DT_S + 0.5).floor().max(0.0) as usize) {
            *new = true;
        }
    }
    new
}

/// The value in the middle of all, the greater of the two in the middle; none of nothing.
#[must_use]
pub(super) fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Samples = values.collect();
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arm_that_is_to_be_held_has_no_target_but_where_it_stands() {
        let mut target_m = vec![0.1, 0.51, 0.51, 0.2, 0.51];
        let held = hold(&mut target_m, &vec![0.12, 0.13, 0.14, 0.15, 0.16]);
        assert_eq!(held, [false, true, true, false, true]);
        assert_eq!(target_m, [0.1, 0.13, 0.13, 0.2, 0.16]);
    }
}
