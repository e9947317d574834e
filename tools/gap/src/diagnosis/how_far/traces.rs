//! What was measured and what was foretold as series, for pictures.

use xt28_machine::Wheel;

use super::course::{Quantity, Row, TICKS_PER_SAMPLE};
use super::twin::{Course, Stretch};
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
pub(super) fn traces(course: &Course, foretold: &[Stretch]) -> Vec<(Channel, Series, Series)> {
    let at_s = |k: usize| (k * TICKS_PER_SAMPLE) as f64 * DT_S;
    let series = |rows: &mut dyn Iterator<Item = (usize, &Row)>, column: usize| -> Series {
        let known = rows.filter(|(_, row)| row[column].is_finite());
        known.map(|(k, row)| (at_s(k), row[column])).collect()
    };
    let one = |(channel, column): (Channel, usize)| {
        let measured = series(&mut course.measured.iter().enumerate(), column);
        let ours = foretold.iter().flat_map(|stretch| {
            stretch.rows.iter().enumerate().map(|(k, row)| (stretch.from + k, row))
        });
        (channel, measured, series(&mut { ours }, column))
    };
    channels().map(one).collect()
}
