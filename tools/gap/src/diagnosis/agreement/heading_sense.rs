//! Whether a receiver's heading is the way in which its fixes go: a compass counts clockwise from north, and
//! some receivers in quarter turns or from the stern, and degrees taken for radians turn with no machine.

use core::f64::consts::PI;
use core::fmt;

use xt28_machine::Machine;

use crate::diagnosis::signals::Signals;

/// Two fixes this far apart tell a course, m: some times what a receiver is off by.
const APART_M: f64 = 2.0;
/// Slower than this nothing tells whether the machine goes ahead, m/s.
const AHEAD_M_S: f64 = 0.2;
/// Courses without which nothing is said.
const COURSES_MIN: usize = 8;
/// Courses agree where their pointers, laid together, are this share of their number long.
const AGREE: f64 = 0.9;
/// No antenna beside its place and no machine in a bend goes this far beside its heading, rad.
const BESIDE_RAD: f64 = 0.35;

/// Courses that turn by less say nothing of a unit: what their pointers lack of their number's length, 0.1 rad as
/// a root mean square.
const TURNS: f64 = 0.005;
/// What is off by this share of what headings as they are told are off by is explained.
const EXPLAINED: f64 = 0.25;
/// What makes a heading look odd that is not.
const UNLESS: &str = "unless east and north of the fixes are exchanged in DBC or mapping";

/// A heading that is not the way in which the machine goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OddHeading {
    /// Whether it counts the other way round.
    pub is_mirrored: bool,
    /// What is to be added to it then, rad, within half a turn.
    pub offset_rad: f64,
    /// How many times as much it should tell: more than once where degrees were taken for radians on the way.
    pub scale: f64,
}

/// What is wrong with the heading of all `runs`, if the fixes say so.
pub(super) fn odd_heading(runs: &[Signals], machine: &Machine) -> Option<OddHeading> {
    let courses: Vec<[f64; 2]> = runs.iter().flat_map(|s| courses(s, machine)).collect();
    if courses.len() < COURSES_MIN {
        return None;
    }
    let lies = |is_mirrored: bool, scale: f64| {
        let times = if is_mirrored { -scale } else { scale };
        let angles = courses.iter().map(|[course, heading]| course - times * heading);
        let Pointer { angle_rad, length } = pointer(angles);
        (length > AGREE)
            .then_some((OddHeading { is_mirrored, offset_rad: angle_rad, scale }, length))
    };
    let full = 180.0 / PI;
    let others = [(true, 1.0), (false, full), (true, full)];
    let others = others.into_iter().filter_map(|(is_mirrored, scale)| lies(is_mirrored, scale));
    let best = others.max_by(|(_, a), (_, b)| a.total_cmp(b));
    let Some((as_told, length)) = lies(false, 1.0) else { return best.map(|(odd, _)| odd) };
    let lacks = 1.0 - length;
    let explains = |other: &(OddHeading, f64)| lacks > TURNS && 1.0 - other.1 < EXPLAINED * lacks;
    match best.filter(explains) {
        Some((odd, _)) => Some(odd),
        None => (as_told.offset_rad.abs() > BESIDE_RAD).then_some(as_told),
    }
}

/// Where angles point that are laid together as pointers of one length.
struct Pointer {
    /// Within half a turn.
    angle_rad: f64,
    /// Share of their number that is left: 1 where they are all alike.
    length: f64,
}

/// Where `angles` point.
#[allow(clippy::cast_precision_loss)]
fn pointer(angles: impl Iterator<Item = f64>) -> Pointer {
    let (mut east, mut north, mut count) = (0.0, 0.0, 0_usize);
    for angle in angles {
        (east, north, count) = (east + angle.cos(), north + angle.sin(), count + 1);
    }
    Pointer { angle_rad: north.atan2(east), length: f64::hypot(east, north) / count.max(1) as f64 }
}

/// Course over ground and heading in the middle, rad, wherever the machine went ahead for some metres.
fn courses(s: &Signals, machine: &Machine) -> Vec<[f64; 2]> {
    let mut all = Vec::new();
    let Some(mut from) = s.fixes.first() else { return all };
    for to in &s.fixes {
        let [east_m, north_m] = [to[1] - from[1], to[2] - from[2]];
        if east_m.hypot(north_m) < APART_M {
            continue;
        }
        let ahead_m_s = |at_s: f64| machine.wheels.radius_m * wheel_speed_rad_s(s, at_s);
        let goes_ahead = [from[0], to[0]].iter().all(|at_s| ahead_m_s(*at_s) > AHEAD_M_S);
        if let (true, Some(heading)) = (goes_ahead, heading_told(s, 0.5 * (from[0] + to[0]))) {
            all.push([north_m.atan2(east_m), heading]);
        }
        from = to;
    }
    all
}

/// The heading told nearest to `at_s`, rad; none where the receiver is silent. A mean of the two around it would say
/// nothing where one of the wrong unit jumps between them, as the machine turns past its zero.
fn heading_told(s: &Signals, at_s: f64) -> Option<f64> {
    s.heading_at(at_s)?;
    let k = s.headings.partition_point(|heading| heading[0] < at_s);
    let around = s.headings.get(k.checked_sub(1)?..=k)?;
    let away_s = |told: &&[f64; 3]| (told[0] - at_s).abs();
    around.iter().min_by(|a, b| away_s(a).total_cmp(&away_s(b))).map(|told| told[1])
}

/// How fast the wheels turn ahead, rad/s.
fn wheel_speed_rad_s(s: &Signals, at_s: f64) -> f64 {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let i = (at_s / crate::diagnosis::signals::DT_S) as usize;
    if i < s.len { s.mean_wheel_speed_rad_s(i) } else { 0.0 }
}

impl fmt::Display for OddHeading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let offset_deg = self.offset_rad.to_degrees();
        if self.scale > 1.0 {
            let sense = if self.is_mirrored { "-" } else { "" };
            return write!(
                f,
                "changes by {:.4} times as much as they do, as degrees do that are taken for radians; check unit \
                 and factor in DBC and mapping, where scale = {sense}{:.1} would do",
                1.0 / self.scale,
                self.scale
            );
        }
        if self.is_mirrored {
            return write!(
                f,
                "counts clockwise; in a mapping: scale = -1.0, offset = {offset_deg:.0}, {UNLESS}"
            );
        }
        let (turn, half) = (offset_deg, PI.to_degrees());
        let beside = if (turn.abs() - half).abs() < 1.0 { half } else { turn };
        write!(
            f,
            "is {beside:.0} deg beside it; in a mapping: offset = {beside:.0}, or, where it counts clockwise from north, \
             scale = -1.0, offset = 90, {UNLESS}"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Channel, Series, Terrain};

    /// A machine that goes ahead at 1.48 m/s for 60 s, turning left as `turns` says, rad/s, with a heading made
    /// of the true one.
    fn driven(turns: f64, said: impl Fn(f64) -> f64) -> [Signals; 1] {
        let at = |k: i32| 0.1 * f64::from(k);
        let [mut east, mut north, mut heading] = [const { Vec::new() }; 3];
        let (mut x, mut y) = (0.0, 0.0);
        for k in 0..600 {
            let psi = turns * at(k);
            east.push((at(k), x));
            north.push((at(k), y));
            heading.push((at(k), said(psi)));
            (x, y) = (x + 0.148 * psi.cos(), y + 0.148 * psi.sin());
        }
        let still = |value: f64| (0..600).map(|k| (at(k), value)).collect::<Series>();
        let reads = |channel: Channel| match channel {
            Channel::WheelSpeed(_) => still(2.0),
            Channel::East => east.iter().copied().collect(),
            Channel::North => north.iter().copied().collect(),
            Channel::Heading => heading.iter().copied().collect(),
            _ => still(0.0),
        };
        let all = Channel::all().into_iter().map(|channel| (channel, reads(channel)));
        [Signals::of_series("made up", &all.collect(), 60.0, Terrain::Flat).unwrap()]
    }

    #[test]
    fn a_heading_as_the_machine_goes_is_not_complained_of() {
        for turns in [0.0, 0.05, -0.1] {
            assert_eq!(odd_heading(&driven(turns, |psi| psi), &Machine::xt28()), None);
            assert_eq!(
                odd_heading(&driven(turns, |psi| psi + 0.1), &Machine::xt28()),
                None,
                "an antenna beside"
            );
        }
    }

    #[test]
    fn a_compass_is_told_with_the_way_to_mend_it() {
        let compass = |psi: f64| PI / 2.0 - psi;
        let odd = odd_heading(&driven(0.05, compass), &Machine::xt28()).expect("it turned");
        assert!(odd.is_mirrored && (odd.offset_rad - PI / 2.0).abs() < 0.05, "{odd:?}");
        assert!(odd.to_string().contains("scale = -1.0, offset = 90, unless"), "{odd}");
        let straight =
            odd_heading(&driven(0.0, compass), &Machine::xt28()).expect("a quarter turn beside");
        assert!(straight.to_string().starts_with("is -90 deg beside it"), "{straight}");
    }

    #[test]
    fn a_heading_of_the_wrong_unit_is_told_where_the_machine_turns() {
        for turns in [0.05, -0.1] {
            let within = |psi: f64| psi.rem_euclid(2.0 * PI);
            let odd = odd_heading(&driven(turns, |psi| within(psi).to_radians()), &Machine::xt28())
                .expect("it turned");
            assert!(!odd.is_mirrored && odd.offset_rad.abs() < 0.05, "{odd:?}");
            assert!(odd.to_string().starts_with("changes by 0.0175 times"), "{odd}");
            let compass = |psi: f64| within(PI / 2.0 - psi).to_radians();
            let odd = odd_heading(&driven(turns, compass), &Machine::xt28()).expect("it turned");
            assert!(odd.to_string().ends_with("scale = -57.3 would do"), "{odd}");
        }
        assert_eq!(
            odd_heading(&driven(0.0, f64::to_radians), &Machine::xt28()),
            None,
            "nothing tells"
        );
    }

    #[test]
    fn a_heading_that_wanders_says_nothing_of_its_sense() {
        assert_eq!(odd_heading(&driven(0.05, |psi| 40.0 * psi), &Machine::xt28()), None);
    }
}
