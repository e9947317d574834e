//! Wheels that creep slip sideways as well: by how far bends and pushes shift and turn the machine on them.
//!
//! Tyres without creep go where joints and axles say. On ones that creep, the machine's own weight carries it to the
//! outside of a bend, and motors of one side that push more than the other's turn it; three axles give way to both
//! until they hold it in balance. That takes it half a second where they creep by 0.2 mm/s/N.

use xt28_machine::{Machine, PerWheel, Side, Wheel};
use xt28_sim::{Effects, Part, Parts};

use super::axles::Axles;
use super::press::{normals_n, own_n};
use super::rolling::{SAMPLES_PER_LOOK, wheel_kinematics};
use super::traction::Traction;
use crate::diagnosis::signals::{DT_S, Samples, Signals};

/// Creep of a wheel on ground that has none of its own, m/s/N (assumed).
const FIRM_M_S_N: f64 = 1.0e-6;
/// A wheel that is pressed by less does not quite hold sideways, N, and one in the air by this share (assumed).
const HOLDS_FROM_N: f64 = 1.0e3;
const HOLDS_LEAST: f64 = 0.02;
/// From one look to the next, s.
const STEP_S: f64 = SAMPLES_PER_LOOK as f64 * DT_S;

/// Slips of a run beside what joints and axles say, at each look.
#[derive(Clone, Debug, Default)]
pub(super) struct SideSlip {
    /// Of the front axle, to the left, m/s.
    front_m_s: Samples,
    /// Of the whole machine about the vertical, to the left, rad/s.
    turn_rad_s: Samples,
    /// How hard it is to slip each axle sideways, N s/m.
    holds_n_s_m: Vec<[f64; 3]>,
}

/// What of the ground and the machine one look needs.
#[derive(Clone, Copy)]
struct Look {
    /// How hard it is to slip each axle sideways, N s/m.
    holds_n_s_m: [f64; 3],
    /// What the wheels' pushes turn the machine with, to the left, Nm.
    pushes_nm: f64,
    /// Speed ahead, m/s.
    ahead_m_s: f64,
    /// Rate of turn that the joints say, rad/s, and how fast it changes, rad/s^2.
    turns: [f64; 2],
}

impl SideSlip {
    /// The slips of a run; nothing where no wheel is believed to creep.
    pub(super) fn new(s: &Signals, machine: &Machine, effects: &Effects) -> Option<Self> {
        let creep_m_s_n = |w: Wheel| effects.wheels[w].slippery_ground.creep_m_s_n;
        Wheel::ALL.into_iter().any(|w| creep_m_s_n(w) > 0.0).then(|| {
            let (body, axle_x_m) = (whole(machine, effects), machine.wheels.axle_x_m);
            let (mut slips, mut all) = ([0.0; 2], Self::default());
            for look in looks(s, machine, effects) {
                slips = next(slips, &look, &body, axle_x_m);
                all.front_m_s.push(slips[0]);
                all.turn_rad_s.push(slips[1]);
                all.holds_n_s_m.push(look.holds_n_s_m);
            }
            all
        })
    }

    /// Slip of the front axle at `at_s`, to the left, m/s.
    pub(super) fn front_m_s(&self, at_s: f64) -> f64 {
        near(&self.front_m_s, at_s).unwrap_or_default()
    }

    /// Slip about the vertical at `at_s`, to the left, rad/s.
    pub(super) fn turn_rad_s(&self, at_s: f64) -> f64 {
        near(&self.turn_rad_s, at_s).unwrap_or_default()
    }

    /// How hard each axle is to slip sideways at `at_s`, N s/m.
    pub(super) fn holds_n_s_m(&self, at_s: f64) -> [f64; 3] {
        near(&self.holds_n_s_m, at_s).unwrap_or([1.0; 3])
    }
}

/// The look nearest to `at_s`.
fn near<T: Copy>(looks: &[T], at_s: f64) -> Option<T> {
    let nearest = (at_s / STEP_S).round().max(0.0) as usize;
    looks.get(nearest.min(looks.len().saturating_sub(1))).copied()
}

/// All looks of a run.
fn looks<'a>(
    s: &'a Signals,
    machine: &'a Machine,
    effects: &'a Effects,
) -> impl Iterator<Item = Look> + 'a {
    let (axles, parts) = (Axles::new(machine), Parts::new(machine, effects));
    let own_n = PerWheel::from_fn(|w| own_n(machine, &parts, w));
    let kinematics = s.kinematics(|| wheel_kinematics(s, machine));
    let half_track_m = machine.wheels.track_m / 2.0;
    let mut before = None;
    (0..s.len).step_by(SAMPLES_PER_LOOK).zip(kinematics).map(move |(i, moves)| {
        let normal_n = normals_n(&own_n, |w| s.cylinder_load_n[w][i], &moves.pose);
        let traction = Traction::new(s, machine, effects, &normal_n, i, (None, 0.0));
        let (mut holds_n_s_m, mut pushes_nm) = ([0.0; 3], 0.0);
        for (w, push_n) in traction.carried_n().iter() {
            let creep_m_s_n = FIRM_M_S_N + effects.wheels[w].slippery_ground.creep_m_s_n;
            let presses = (normal_n[w] / HOLDS_FROM_N).clamp(HOLDS_LEAST, 1.0);
            holds_n_s_m[w.axle() as usize] += presses / creep_m_s_n;
            pushes_nm += if w.side() == Side::Left { -push_n } else { *push_n } * half_track_m;
        }
        let [angle, rate] =
            [&s.joint_rad, &s.joint_rate_rad_s].map(|of| [0, 1].map(|joint: usize| of[joint][i]));
        let ahead_m_s = s.mean_wheel_speed_rad_s(i) * parts.radius_m;
        let turn = axles.rolling_under(holds_n_s_m, angle, rate, ahead_m_s).turn_rad_s[0];
        let gains = (turn - before.replace(turn).unwrap_or(turn)) / STEP_S;
        Look { holds_n_s_m, pushes_nm, ahead_m_s, turns: [turn, gains] }
    })
}

/// The machine as one body, straight.
fn whole(machine: &Machine, effects: &Effects) -> Part {
    let parts = Parts::new(machine, effects);
    let [front, middle, rear] = parts.frames;
    let frames = front.joined(middle).joined(rear);
    Wheel::ALL.into_iter().fold(frames, |body, w| {
        let half_track_m = machine.wheels.track_m / 2.0;
        let y = if w.side() == Side::Left { half_track_m } else { -half_track_m };
        body.joined(Part {
            mass_kg: parts.wheel.mass_kg + parts.arms[w].body.mass_kg,
            com_m: [machine.wheels.axle_x_m[w.axle() as usize], y, 0.0],
            ..Part::default()
        })
    })
}

/// Slips of the front axle, m/s, and about it, rad/s, a look after they were `before`: momentum and spin of `body`
/// that the axles at `axle_x_m` and the pushes change, by the Euler method that looks ahead.
fn next([side, turn]: [f64; 2], look: &Look, body: &Part, axle_x_m: [f64; 3]) -> [f64; 2] {
    let (kg, ahead_m) = (body.mass_kg, body.com_m[0]);
    let about_front = body.inertia_kg_m2[2] + kg * ahead_m * ahead_m;
    let moment =
        |power: i32| (0..3).map(|k| look.holds_n_s_m[k] * axle_x_m[k].powi(power)).sum::<f64>();
    let [turns, gains] = look.turns;
    let bends_n = kg * (ahead_m * gains + look.ahead_m_s * turns);
    let bends_nm = about_front * gains + kg * ahead_m * look.ahead_m_s * turns;
    // Rows: the sum of all forces, and their moment about the front axle.
    let row = |mass: [f64; 2], holds: [f64; 2], outside: f64, spin: f64| {
        let [a, b] = [0, 1].map(|k: usize| mass[k] / STEP_S + holds[k]);
        [a, b + spin, (mass[0] * side + mass[1] * turn) / STEP_S + outside]
    };
    let spin = kg * look.ahead_m_s;
    let [a, b, e] = row([kg, kg * ahead_m], [moment(0), moment(1)], -bends_n, spin);
    let [c, d, f] = row(
        [kg * ahead_m, about_front],
        [moment(1), moment(2)],
        look.pushes_nm - bends_nm,
        spin * ahead_m,
    );
    let determinant = a * d - b * c;
    [(e * d - b * f) / determinant, (a * f - e * c) / determinant]
}

#[cfg(test)]
mod tests {
    use super::super::circuits::PRESSURE_AT_TORQUE_MAX_PA;
    use super::super::still::still;
    use super::*;

    const CREEP_M_S_N: f64 = 1.0e-4;
    const SETTLED_S: f64 = 19.0;

    fn creeping(wheels: &[Wheel]) -> Effects {
        let mut effects = Effects::default();
        for w in wheels {
            effects.wheels[*w].slippery_ground.creep_m_s_n = CREEP_M_S_N;
        }
        effects
    }

    /// On the ground with all wheels, at `ahead_m_s` round a circle of 20 m to the left.
    fn bend(machine: &Machine, ahead_m_s: f64) -> Signals {
        let mut s = still(20);
        for w in Wheel::ALL {
            s.cylinder_load_n[w].fill(60.0e3);
            for speed in [&mut s.smooth_wheel_speed_rad_s[w], &mut s.wheel_speed_rad_s[w]] {
                speed.fill(ahead_m_s / machine.wheels.radius_m);
            }
        }
        for (joint, from_axle_m) in [1.85_f64, 1.175].into_iter().enumerate() {
            s.joint_rad[joint].fill(2.0 * (from_axle_m / 20.0).atan());
        }
        s
    }

    /// Mean of the axles' places, m, and the sum of their squares about it.
    fn spread(axle_x_m: [f64; 3]) -> (f64, f64) {
        let mean = axle_x_m.iter().sum::<f64>() / 3.0;
        (mean, axle_x_m.iter().map(|x| (x - mean) * (x - mean)).sum())
    }

    #[test]
    fn weight_carries_the_front_axle_to_the_outside_of_a_bend() {
        let machine = Machine::xt28();
        let (s, slippery) = (bend(&machine, 1.0), creeping(&Wheel::ALL));
        let slip = SideSlip::new(&s, &machine, &slippery).unwrap();
        // A plank on three equal springs: each takes a third, and what its distance from their middle makes of the
        // distance of the weight.
        let (body, (mean, square)) = (whole(&machine, &slippery), spread(machine.wheels.axle_x_m));
        let share = 1.0 / 3.0 + (body.com_m[0] - mean) * (0.0 - mean) / square;
        let wanted = -0.5 * CREEP_M_S_N * share * body.mass_kg / 20.0;
        let front_m_s = slip.front_m_s(SETTLED_S);
        assert!((front_m_s / wanted - 1.0).abs() < 0.1, "{front_m_s}, not {wanted}");
        // It turns in the less, as the front bears more than its share.
        assert!(slip.turn_rad_s(SETTLED_S) < 0.0);
    }

    #[test]
    fn motors_that_push_one_side_more_turn_the_machine() {
        let (machine, push_nm) = (Machine::xt28(), 1.0e3);
        let mut s = bend(&machine, 0.0);
        // The second circuit has one wheel at the left and two at the right.
        s.pump_pressure_pa[3]
            .fill(push_nm / machine.wheels.torque_max_nm * PRESSURE_AT_TORQUE_MAX_PA);
        let slip = SideSlip::new(&s, &machine, &creeping(&Wheel::ALL)).unwrap();
        let moment_nm = push_nm / machine.wheels.radius_m * machine.wheels.track_m / 2.0;
        let (mean, square) = spread(machine.wheels.axle_x_m);
        let wanted = 0.5 * CREEP_M_S_N * moment_nm / square;
        let turn_rad_s = slip.turn_rad_s(SETTLED_S);
        assert!((turn_rad_s / wanted - 1.0).abs() < 0.02, "{turn_rad_s}, not {wanted}");
        let front_m_s = slip.front_m_s(SETTLED_S);
        assert!((front_m_s / (wanted * -mean) - 1.0).abs() < 0.02, "{front_m_s}");
    }

    #[test]
    fn an_axle_on_firm_ground_holds_and_one_in_the_air_does_not() {
        let machine = Machine::xt28();
        let mut s = bend(&machine, 1.0);
        let slips_m_s = |s: &Signals, wheels: &[Wheel]| {
            let slip = SideSlip::new(s, &machine, &creeping(wheels));
            slip.map_or(0.0, |slip| slip.front_m_s(SETTLED_S).abs())
        };
        let all = slips_m_s(&s, &Wheel::ALL);
        assert_eq!(slips_m_s(&s, &[]), 0.0);
        assert!(slips_m_s(&s, &[Wheel::Br, Wheel::Bl]) < 0.1 * all);
        for w in [Wheel::Br, Wheel::Bl] {
            s.cylinder_load_n[w].fill(-1.0e6);
        }
        // The middle axle has the weight behind it alone now, so that the front one bears less of it.
        assert!(slips_m_s(&s, &Wheel::ALL) < 0.9 * all);
    }

    #[test]
    fn it_takes_a_while_to_slip() {
        let machine = Machine::xt28();
        let slip = SideSlip::new(&bend(&machine, 1.0), &machine, &creeping(&Wheel::ALL)).unwrap();
        let share = slip.front_m_s(0.2) / slip.front_m_s(SETTLED_S);
        assert!((0.1..0.7).contains(&share), "{share}");
    }
}
