//! What a log must be before it is asked anything: long enough, with all signals, on one clock, with
//! values that a machine can have.

use crate::diagnosis::needed;
use crate::{Channel, Decoder, FieldLog, GapError, Series};

/// The whole machine is set anew every five seconds; a shorter log has not one whole piece.
const LEAST_S: f64 = 5.0;
/// Share of values that may be odd: a sensor's spikes, not another scale.
const ODD_MAX: f64 = 0.01;

/// Refuses what cannot be diagnosed.
pub(super) fn check(log: &FieldLog, decoder: &Decoder) -> Result<(), GapError> {
    let missing: Vec<String> = needed()
        .filter(|channel| log.series(*channel).is_none_or(Series::is_empty))
        .map(|channel| format!("{channel} ({})", decoder.name_of(channel)))
        .collect();
    if !missing.is_empty() {
        let channels = missing.join(", ");
        return Err(GapError::Unmeasured { log: log.name().to_owned(), channels });
    }
    if log.duration_s() < LEAST_S {
        // A hair less than enough must not read as enough.
        let (log, duration_s) = (log.name().to_owned(), log.duration_s().min(LEAST_S - 0.01));
        return Err(GapError::TooShort { log, duration_s, least_s: LEAST_S });
    }
    for (channel, series) in log.all_series() {
        believable(log, decoder, *channel, series)?;
    }
    Ok(())
}

#[allow(clippy::cast_precision_loss)]
fn believable(
    log: &FieldLog,
    decoder: &Decoder,
    channel: Channel,
    series: &Series,
) -> Result<(), GapError> {
    let Some([low, high]) = possible(channel) else { return Ok(()) };
    let odd = series.iter().filter(|(_, value)| !(low..=high).contains(value)).count();
    if odd as f64 <= ODD_MAX * series.len() as f64 {
        return Ok(());
    }
    let found = series
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], (_, v)| [a.min(v), b.max(v)]);
    Err(GapError::Impossible {
        log: log.name().to_owned(),
        channel: channel.to_string(),
        signal: decoder.name_of(channel),
        found,
        possible: [low, high],
        unit: channel.dimension().si(),
    })
}

/// What such a machine can have at the very most, SI. Wide: this catches a wrong unit, scale or
/// layout, never a fault of the machine.
const fn possible(channel: Channel) -> Option<[f64; 2]> {
    Some(match channel {
        Channel::Stroke(_) | Channel::TargetStroke(_) => [-0.1, 0.65],
        Channel::CylinderLoad(_) | Channel::WheelLoad(_) => [-6.0e5, 1.0e6],
        Channel::BorePressure(_) | Channel::RodPressure(_) | Channel::PumpPressure(_) => {
            [-5.0e6, 1.0e8]
        }
        Channel::WheelSpeed(_) => [-20.0, 20.0],
        Channel::FrontJoint | Channel::RearJoint | Channel::TargetJoint => [-1.0, 1.0],
        Channel::Roll | Channel::Pitch => [-1.6, 1.6],
        // Anywhere on Earth, from any origin.
        Channel::East | Channel::North => [-2.0e7, 2.0e7],
        // Fifteen turns, where somebody counts them; one is 360 where degrees are taken for radians.
        Channel::Heading => [-100.0, 100.0],
        Channel::RetractCurrent(_)
        | Channel::ExtendCurrent(_)
        | Channel::PumpCurrent(_)
        | Channel::MotorCurrent(_)
        | Channel::SteerCurrent(_) => [-0.1, 5.0],
        Channel::Throttle | Channel::TargetOpening(_) => [-1.05, 1.05],
        _ => return None,
    })
}
