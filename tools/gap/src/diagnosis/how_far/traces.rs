//! What was measured and what was foretold as series, for pictures.

use xt28_machine::Wheel;

use super::machine_sample::{MachineSample, Quantity, TICKS_PER_SAMPLE};
use super::twin::{Forecast, PreparedRun};
use crate::diagnosis::signals::DT_S;
use crate::{Channel, PumpSide, Series};

/// Channels of the numbers of a sample that have one.
fn channels() -> impl Iterator<Item = (Channel, usize)> {
    let wheels: [fn(Wheel) -> Channel; 3] =
        [Channel::Stroke, Channel::CylinderLoad, Channel::WheelSpeed];
    let wheels = wheels.into_iter().flat_map(|make| Wheel::ALL.map(make));
    let rest = [Channel::FrontJoint, Channel::RearJoint, Channel::Roll, Channel::Pitch];
    let pumps = PumpSide::ALL.map(Channel::PumpPressure);
    let place = Quantity::Position.columns();
    wheels
        .chain(rest)
        .chain(pumps)
        .filter_map(|channel| Some((channel, Quantity::of(channel)?)))
        .chain([(Channel::East, place.start), (Channel::North, place.start + 1)])
}

/// Channel, measured, foretold.
#[allow(clippy::cast_precision_loss)]
pub(super) fn traces(
    prepared: &PreparedRun,
    foretold: &[Forecast],
) -> Vec<(Channel, Series, Series)> {
    let at_s = |k: usize| (k * TICKS_PER_SAMPLE) as f64 * DT_S;
    let series =
        |samples: &mut dyn Iterator<Item = (usize, &MachineSample)>, column: usize| -> Series {
            let known = samples.filter(|(_, sample)| sample[column].is_finite());
            known.map(|(k, sample)| (at_s(k), sample[column])).collect()
        };
    let one = |(channel, column): (Channel, usize)| {
        let measured = series(&mut prepared.measured.iter().enumerate(), column);
        let ours = foretold.iter().flat_map(|forecast| {
            forecast.samples.iter().enumerate().map(|(k, sample)| (forecast.from + k, sample))
        });
        (channel, measured, series(&mut { ours }, column))
    };
    channels().map(one).collect()
}
