//! What the attitude reads beside how the frames stand on their wheels: the ground's slope and the unit's mount.

use xt28_sim::Effects;

use super::filter::KEEP;
use super::followed::{Followed, remains_behind};
use super::instants::PRESSURE_FILTER_S;
use crate::diagnosis::belief::EffectSchedule;
use crate::diagnosis::generator::grade::Grade;
use crate::diagnosis::signals::{DT_S, Signals};

/// Ground and mount as believed over a run.
pub(super) struct Beside {
    /// The ground; none where nothing can be said of it.
    ground: Option<Followed<Grade>>,
    /// What roll and pitch are off by, rad.
    mount_rad: [Followed<f64>; 2],
    /// Whether gyroscopes feel what jumps.
    is_felt: bool,
}

impl Beside {
    /// Ground and mount over a schedule of effects. A unit that comes loose, and ground that begins to climb, show at
    /// once where gyroscopes feel that, else as the attitude's filter follows its accelerometer: no log says which, so
    /// it is each of the two.
    pub(super) fn each(s: &Signals, schedule: EffectSchedule<'_>) -> Vec<Self> {
        let followed = |angle_rad: fn(&Effects) -> f64| {
            Followed::new(schedule, angle_rad, |was, is| angle_rad(was) != angle_rad(is))
        };
        let mount_rad = [
            followed(|effects| effects.sensors.imu_offset.roll_rad),
            followed(|effects| effects.sensors.imu_offset.pitch_rad),
        ];
        let ground = Grade::known(s).map(|known| {
            let of = |effects: &Effects| known.with(effects);
            Followed::new(schedule, of, |was, is| was.slope != is.slope)
        });
        let jumps =
            mount_rad.iter().any(Followed::jumps) || ground.as_ref().is_some_and(Followed::jumps);
        let ways: &[bool] = if jumps { &[true, false] } else { &[true] };
        ways.iter().map(|&is_felt| Self { ground, mount_rad, is_felt }).collect()
    }

    /// By how much the unit's mount has the roll and the pitch of a sample off, rad.
    pub(super) fn mount_rad(&self, sample: usize) -> [f64; 2] {
        [0, 1].map(|axis| self.mount_rad[axis].at(sample, |time_s| self.remains(axis, time_s)))
    }

    /// How far the ground has the nose and the left side up by the attitude of a sample, rad; `heading` has cosine and
    /// sine for roll and for pitch. `None` where nothing can be said.
    pub(super) fn ground_rad(&self, sample: usize, heading: [[f64; 2]; 2]) -> Option<[f64; 2]> {
        let ground = self.ground.as_ref()?;
        let [by_roll, by_pitch] = [0, 1].map(|axis| {
            ground.at(sample, |time_s| self.remains(axis, time_s)).attitude_rad(heading)
        });
        Some([by_pitch[0], by_roll[1]])
    }

    /// Share of a jump that the roll (0) or the pitch (1) has yet to show after `time_s`.
    fn remains(&self, axis: usize, time_s: f64) -> f64 {
        if self.is_felt {
            return (-time_s / PRESSURE_FILTER_S).exp();
        }
        remains_behind([DT_S / (1.0 - KEEP[axis]), PRESSURE_FILTER_S], time_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::generator::still::still;

    #[test]
    fn what_jumps_shows_at_once_or_by_and_by() {
        let (s, sound, mut off) = (still(10), Effects::default(), Effects::default());
        off.sensors.imu_offset.roll_rad = 0.02;
        off.slope.grade_y_rad = -0.02;
        assert_eq!(Beside::each(&s, (&off).into()).len(), 1, "what always was is what it is");
        let late = EffectSchedule::late(&sound, 3.0, &off);
        let east = [[1.0, 0.0]; 2];
        let [felt, followed] = [0, 1].map(|way| {
            let beside = &Beside::each(&s, late)[way];
            [beside.mount_rad(400)[0], -beside.ground_rad(400, east).unwrap()[1]]
        });
        for way in 0..2 {
            assert!((felt[way] - 0.02).abs() < 1e-4, "{felt:?}");
            assert!((0.006..0.009).contains(&followed[way]), "{followed:?}");
        }
    }
}
