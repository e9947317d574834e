//! Wheels that creep slip sideways as well: by how far bends, slopes and pushes shift and turn the machine on them.
//!
//! Tyres without creep go where joints and axles say. On ones that creep, the machine's own inertia carries it to the
//! outside of a bend, its weight down a cross slope, and motors of one side that push more than the other's turn it;
//! three axles give way to all that until they hold it in balance. That takes it half a second where they creep by
//! 0.2 mm/s/N. The frames are taken as straight behind one another.

use core::f64::consts::FRAC_PI_2;

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Side, Wheel};
use xt28_sim::{Effects, Part, Parts};

use super::axles::Axles;
use super::grade::Grade;
use super::lifted::rolls_rad_s;
use super::press::{normals_n, own_n};
use super::rolling::{SAMPLES_PER_LOOK, wheel_kinematics};
use super::traction::Traction;
use crate::diagnosis::signals::{DT_S, Samples, Signals};

/// Creep on firm ground of a wheel that bears a sixth of the machine, m/s/N (assumed); of one that bears less it is
/// the more. It decides whose axle leads where nothing else creeps, and is no slip of its own.
const FIRM_M_S_N: f64 = 2.0e-6;
/// Share of a sixth of the machine that a wheel in the air is taken to bear: it holds next to nothing.
const BEARS_LEAST: f64 = 4.0e-4;
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
    /// How hard it is to slip each axle sideways, N s/m, as it creeps and on firm ground.
    holds_n_s_m: [[f64; 3]; 2],
    /// What the wheels' pushes turn the machine with, to the left, Nm.
    pushes_nm: f64,
    /// Speed ahead, m/s.
    ahead_m_s: f64,
    /// Rate of turn that the joints say, rad/s, and how fast it changes, rad/s^2.
    turns: [f64; 2],
    /// Sine of the angle by which the left side is up.
    left_up: f64,
}

impl SideSlip {
    /// The slips of a run; nothing where no wheel is believed to creep.
    pub(super) fn new(s: &Signals, machine: &Machine, effects: &Effects) -> Option<Self> {
        let creep_m_s_n = |w: Wheel| effects.wheels[w].slippery_ground.creep_m_s_n;
        Wheel::ALL.into_iter().any(|w| creep_m_s_n(w) > 0.0).then(|| {
            let (body, axle_x_m) = (whole(machine, effects), machine.wheels.axle_x_m);
            let (mut slips, mut all) = ([[0.0; 2]; 2], Self::default());
            for look in looks(s, machine, effects) {
                let of = |k: usize| next(slips[k], &look, look.holds_n_s_m[k], &body, axle_x_m);
                slips = [of(0), of(1)];
                // As little creep as one likes slips as little.
                let [creeping, firm] = slips;
                all.front_m_s.push(creeping[0] - firm[0]);
                all.turn_rad_s.push(creeping[1] - firm[1]);
                all.holds_n_s_m.push(look.holds_n_s_m[0]);
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

    /// How hard each axle is to slip sideways at `at_s`, N s/m: without creep as its load is, and all alike on ground
    /// that creeps much.
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
    let ground = Grade::believed(s, effects);
    let mut before = None;
    (0..s.len).step_by(SAMPLES_PER_LOOK).zip(kinematics).map(move |(i, moves)| {
        let normal_n = normals_n(&own_n, |w| s.cylinder_load_n[w][i], &moves.pose);
        let traction = Traction::new(s, machine, effects, &normal_n, i, (None, 0.0));
        let pushes = traction.carried_n();
        let of_side = |(w, push_n): (Wheel, &f64)| {
            if w.side() == Side::Left { -push_n } else { *push_n }
        };
        let holds_n_s_m = [1.0, 0.0].map(|share| holds_n_s_m(effects, &normal_n, share));
        let [angle, rate] =
            [&s.joint_rad, &s.joint_rate_rad_s].map(|of| [0, 1].map(|joint: usize| of[joint][i]));
        let ahead_m_s = rolls_rad_s(s, i) * parts.radius_m;
        let turn = axles.rolling_under(holds_n_s_m[0], angle, rate, ahead_m_s).turn_rad_s[0];
        let gains = (turn - before.replace(turn).unwrap_or(turn)) / STEP_S;
        let heading_rad = s.heading_near(i as f64 * DT_S).unwrap_or_default();
        Look {
            holds_n_s_m,
            pushes_nm: pushes.iter().map(of_side).sum::<f64>() * half_track_m,
            ahead_m_s,
            turns: [turn, gains],
            left_up: ground.map_or(0.0, |ground| ground.climb(heading_rad + FRAC_PI_2)),
        }
    })
}

/// How hard it is to slip each axle sideways, N s/m, of wheels that creep by that `share` of what they are believed to.
fn holds_n_s_m(effects: &Effects, normal_n: &PerWheel<f64>, share: f64) -> [f64; 3] {
    let mean_n = (normal_n.sum() / 6.0).max(1.0);
    let mut holds_n_s_m = [0.0; 3];
    for (w, normal_n) in normal_n.iter() {
        let firm_m_s_n = FIRM_M_S_N / (normal_n / mean_n).max(BEARS_LEAST);
        let creep_m_s_n = share * effects.wheels[w].slippery_ground.creep_m_s_n;
        holds_n_s_m[w.axle() as usize] += 1.0 / (firm_m_s_n + creep_m_s_n);
    }
    holds_n_s_m
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

/// Slips of the front axle, m/s, and about it, rad/s, a look after they were `before`, on axles at `axle_x_m` that
/// hold by `holds_n_s_m`: what changes the momentum and the spin of `body`, by the Euler method that looks ahead.
fn next(
    [side, turn]: [f64; 2],
    look: &Look,
    holds_n_s_m: [f64; 3],
    body: &Part,
    axle_x_m: [f64; 3],
) -> [f64; 2] {
    let (kg, ahead_m) = (body.mass_kg, body.com_m[0]);
    let about_front = body.inertia_kg_m2[2] + kg * ahead_m * ahead_m;
    let moment = |power: i32| (0..3).map(|k| holds_n_s_m[k] * axle_x_m[k].powi(power)).sum::<f64>();
    let [turns, gains] = look.turns;
    let aside_n = kg * (look.ahead_m_s * turns + GRAVITY_M_S2 * look.left_up);
    let bends_n = kg * ahead_m * gains + aside_n;
    let bends_nm = about_front * gains + ahead_m * aside_n;
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
    fn inertia_carries_the_front_axle_to_the_outside_of_a_bend() {
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
        assert!(SideSlip::new(&s, &machine, &creeping(&[])).is_none());
        assert!(slips_m_s(&s, &[Wheel::Br, Wheel::Bl]) < 0.1 * all);
        for w in [Wheel::Br, Wheel::Bl] {
            s.cylinder_load_n[w].fill(-1.0e6);
        }
        // The middle axle has the weight behind it alone now, so that the front one bears less of it.
        assert!(slips_m_s(&s, &Wheel::ALL) < 0.9 * all);
    }

    #[test]
    fn a_cross_slope_has_it_slip_down() {
        let (machine, mut slippery) = (Machine::xt28(), creeping(&Wheel::ALL));
        // Heading east, the left side is up where the ground rises to the north.
        slippery.slope.grade_y_rad = 0.05;
        let s = bend(&machine, 0.0);
        let slip = SideSlip::new(&s, &machine, &slippery).unwrap();
        let body = whole(&machine, &slippery);
        let (mean, square) = spread(machine.wheels.axle_x_m);
        let share = 1.0 / 3.0 + (body.com_m[0] - mean) * (0.0 - mean) / square;
        let wanted = -0.5 * CREEP_M_S_N * share * body.mass_kg * GRAVITY_M_S2 * 0.05_f64.sin();
        let front_m_s = slip.front_m_s(SETTLED_S);
        assert!((front_m_s / wanted - 1.0).abs() < 0.02, "{front_m_s}, not {wanted}");
    }

    /// Tolerances are told by their slopes: a jump at no creep would look like a steep one.
    #[test]
    fn as_little_creep_as_one_likes_changes_as_little() {
        let (machine, mut effects) = (Machine::xt28(), Effects::default());
        let mut s = bend(&machine, 1.0);
        s.cylinder_load_n[Wheel::Ml].fill(20.0e3);
        effects.wheels[Wheel::Ml].slippery_ground.creep_m_s_n = 1.0e-12;
        let slip = SideSlip::new(&s, &machine, &effects).unwrap();
        assert!(slip.front_m_s(SETTLED_S).abs() < 1e-8 && slip.turn_rad_s(SETTLED_S).abs() < 1e-8);
        // Weighted as by their loads.
        let parts = Parts::new(&machine, &effects);
        let own_n = PerWheel::from_fn(|w| own_n(&machine, &parts, w));
        let pose = &s.kinematics(|| wheel_kinematics(&s, &machine))[10].pose;
        let presses_n = normals_n(&own_n, |w| s.cylinder_load_n[w][50], pose);
        let axle_n = |a: [Wheel; 2]| a.iter().map(|w| presses_n[*w]).sum::<f64>();
        let wanted = axle_n([Wheel::Mr, Wheel::Ml]) / axle_n([Wheel::Fr, Wheel::Fl]);
        let holds = slip.holds_n_s_m(SETTLED_S);
        assert!((holds[1] / holds[0] - wanted).abs() < 1e-3, "{holds:?}");
    }

    #[test]
    fn it_takes_a_while_to_slip() {
        let machine = Machine::xt28();
        let slip = SideSlip::new(&bend(&machine, 1.0), &machine, &creeping(&Wheel::ALL)).unwrap();
        let share = slip.front_m_s(0.2) / slip.front_m_s(SETTLED_S);
        assert!((0.1..0.7).contains(&share), "{share}");
    }
}
