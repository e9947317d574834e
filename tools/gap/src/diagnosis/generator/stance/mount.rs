//! How the inertial unit is mounted, as the attitude shows it.

use xt28_sim::Effects;

use super::filter::KEEP;
use super::followed::{Followed, remains_behind};
use super::instants::PRESSURE_FILTER_S;
use crate::diagnosis::belief::EffectSchedule;
use crate::diagnosis::signals::DT_S;

/// The unit as believed: what its roll and its pitch are off by.
pub(super) struct Mount {
    /// Roll and pitch, rad.
    angle_rad: [Followed<f64>; 2],
    /// Whether its gyroscopes feel it turn on its mount.
    is_felt: bool,
}

impl Mount {
    /// The unit over a schedule of effects. One that comes loose shows at once where its gyroscopes feel that, else
    /// as the attitude's filter follows its accelerometer: no log says which, so it is each of the two.
    pub(super) fn each(schedule: EffectSchedule<'_>) -> Vec<Self> {
        let roll_rad = |effects: &Effects| effects.sensors.imu_offset.roll_rad;
        let pitch_rad = |effects: &Effects| effects.sensors.imu_offset.pitch_rad;
        let followed = |angle_rad: fn(&Effects) -> f64| {
            Followed::new(schedule, angle_rad, |was, is| angle_rad(was) != angle_rad(is))
        };
        let angle_rad = [followed(roll_rad), followed(pitch_rad)];
        let ways: &[bool] =
            if angle_rad.iter().any(Followed::jumps) { &[true, false] } else { &[true] };
        ways.iter().map(|&is_felt| Self { angle_rad, is_felt }).collect()
    }

    /// What the roll and the pitch of a sample are off by, rad.
    pub(super) fn at_rad(&self, sample: usize) -> [f64; 2] {
        [0, 1].map(|k| {
            let filter_s = DT_S / (1.0 - KEEP[k]);
            self.angle_rad[k].at(sample, |time_s| {
                if self.is_felt {
                    (-time_s / PRESSURE_FILTER_S).exp()
                } else {
                    remains_behind([filter_s, PRESSURE_FILTER_S], time_s)
                }
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_that_comes_loose_shows_at_once_or_by_and_by() {
        let mut off = Effects::default();
        off.sensors.imu_offset.roll_rad = 0.02;
        assert_eq!(Mount::each((&off).into()).len(), 1, "one that always was is what it is");
        let sound = Effects::default();
        let late = EffectSchedule { before: &sound, from_s: 3.0, effects: &off, since_s: 0.0 };
        let [felt, followed] = [0, 1].map(|way| Mount::each(late)[way].at_rad(400)[0]);
        assert!((felt - 0.02).abs() < 1e-4, "{felt}");
        assert!((0.006..0.009).contains(&followed), "{followed}");
    }
}
