//! How the machine stands on its six wheels: attitude from strokes, weight and its middle from loads.

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Wheel};
use xt28_sim::{Effects, Parts};

use super::signals::{Samples, Signals};

/// Standing errors over a run; `NaN` where nothing can be said.
#[derive(Clone, Debug, Default)]
pub(super) struct StanceErrors {
    /// Roll that the strokes say less the roll measured, rad.
    pub(super) roll_rad: Samples,
    /// Pitch that the strokes say less the pitch measured, rad.
    pub(super) pitch_rad: Samples,
    /// Weight of the machine less what the cylinders carry, N.
    pub(super) weight_n: Samples,
    /// Where the weight should act, forward, less where the cylinders say, m.
    pub(super) weight_x_m: Samples,
    /// The same, left.
    pub(super) weight_y_m: Samples,
}

/// Least load of a wheel that stands, N.
const STANDING_N: f64 = 3_000.0;
/// Above this the accelerometer feels the driving, m/s².
const CALM_M_S2: f64 = 0.02;

/// Samples after which the attitude filter has forgotten an acceleration: 2 s.
const CALM_STEPS: usize = 200;
/// Bend beyond which a moving machine leans, rad.
const BENT_RAD: f64 = 0.035;

/// Places of the wheels and of the frames' masses at one bend of the machine, in the front frame.
struct Layout {
    /// Position of each arm's pivot and direction of its frame's x axis.
    pivot: PerWheel<([f64; 2], [f64; 2])>,
    /// Middle of all sprung and unsprung mass, less the swing of the arms.
    com: [f64; 2],
}

/// Turns the frames behind about their joints.
fn layout(parts: &Parts, joint_rad: [f64; 2]) -> Layout {
    let mut origin = [[0.0; 2]; 3];
    let mut heading: [f64; 3] = [0.0; 3];
    for k in 0..2 {
        // A bend to the left turns the frame behind to the right.
        heading[k + 1] = heading[k] - joint_rad[k];
        let anchor = parts.joint_m[k][0];
        let at = |f: usize, x: f64| {
            let (sin, cos) = heading[f].sin_cos();
            [origin[f][0] + cos * x, origin[f][1] + sin * x]
        };
        let (joint, (sin, cos)) = (at(k, anchor), heading[k + 1].sin_cos());
        origin[k + 1] = [joint[0] - cos * anchor, joint[1] - sin * anchor];
    }
    let place = |f: usize, p: [f64; 3]| {
        let (sin, cos) = heading[f].sin_cos();
        [origin[f][0] + cos * p[0] - sin * p[1], origin[f][1] + sin * p[0] + cos * p[1]]
    };
    let (mut moment, mut mass) = ([0.0; 2], 0.0);
    let mut add = |at: [f64; 2], kg: f64| {
        moment = [moment[0] + kg * at[0], moment[1] + kg * at[1]];
        mass += kg;
    };
    for (f, frame) in parts.frames.iter().enumerate() {
        add(place(f, frame.com_m), frame.mass_kg);
    }
    let pivot = PerWheel::from_fn(|w| {
        let f = w.axle() as usize;
        let (sin, cos) = heading[f].sin_cos();
        (place(f, parts.arms[w].pivot_m), [cos, sin])
    });
    for w in Wheel::ALL {
        let ([x, y], [cos, sin]) = pivot[w];
        let to = parts.arms[w].to_wheel_m;
        let outboard = [x - sin * to[1] + cos * to[0], y + cos * to[1] + sin * to[0]];
        add(outboard, parts.wheel.mass_kg + parts.arms[w].body.mass_kg);
    }
    Layout { pivot, com: [moment[0] / mass, moment[1] / mass] }
}

/// Stance over a run.
#[must_use]
pub(super) fn stance_errors(
    signals: &Signals,
    machine: &Machine,
    effects: &Effects,
) -> StanceErrors {
    let parts = Parts::new(machine, effects);
    let total_kg = parts.frames.iter().map(|f| f.mass_kg).sum::<f64>()
        + 6.0 * parts.wheel.mass_kg
        + parts.arms.iter().map(|(_, a)| a.body.mass_kg).sum::<f64>();
    let share = machine.vehicle.arm_com_share;
    let mut errors = StanceErrors::default();
    for i in 0..signals.len {
        let joint = [signals.joint_rad[0][i], signals.joint_rad[1][i]];
        let layout = layout(&parts, joint);
        let p = [0, 1, 2, 3].map(|side| signals.pump_pressure_pa[side][i]);
        let torque_nm = (p[1] - p[0] + p[3] - p[2]) / 2.0 / 350.0e5 * machine.wheels.torque_max_nm;
        let wheel = PerWheel::from_fn(|w| {
            let e = &effects.wheels[w];
            let stroke = (signals.stroke_m[w][i] - e.stroke_bias.bias_m) / e.stroke_scale.factor;
            let pose = parts.linkage.at_stroke(stroke);
            let area = machine.arms.area_bore_m2;
            let load = (signals.cylinder_load_n[w][i] - e.pressure_bias.bias_pa * area)
                / e.pressure_scale.factor;
            let arm = &parts.arms[w];
            let unsprung_n = (parts.wheel.mass_kg + arm.body.mass_kg * share) * GRAVITY_M_S2;
            let normal_n =
                unsprung_n + (load * pose.lever_m - arm.extends * torque_nm) / pose.reach_m;
            let ([x, y], [cos, sin]) = layout.pivot[w];
            let reach = arm.extends * pose.reach_m;
            let out = arm.to_wheel_m[1];
            let at = [x + cos * reach - sin * out, y + sin * reach + cos * out];
            (normal_n, at, pose.drop_m)
        });
        weigh(&mut errors, &wheel, total_kg, layout.com);
        attitude(&mut errors, signals, i, &wheel, &parts, effects);
    }
    errors.gate(signals, machine);
    errors
}

/// Weight and its middle against what the wheels carry.
fn weigh(
    errors: &mut StanceErrors,
    wheel: &PerWheel<(f64, [f64; 2], f64)>,
    total_kg: f64,
    com: [f64; 2],
) {
    let weight_n = total_kg * GRAVITY_M_S2;
    let (mut sum, mut moment) = (0.0, [0.0; 2]);
    for (_, (n, at, _)) in wheel.iter() {
        sum += n;
        moment = [moment[0] + n * at[0], moment[1] + n * at[1]];
    }
    errors.weight_n.push(weight_n - sum);
    errors.weight_x_m.push(com[0] - moment[0] / weight_n);
    errors.weight_y_m.push(com[1] - moment[1] / weight_n);
}

/// Plane through the contacts of the wheels that stand.
fn attitude(
    errors: &mut StanceErrors,
    signals: &Signals,
    i: usize,
    wheel: &PerWheel<(f64, [f64; 2], f64)>,
    parts: &Parts,
    effects: &Effects,
) {
    // Normal equations of hub height = z + pitch x - roll y for the wheels that stand.
    let mut a = [[0.0; 3]; 3];
    let mut b = [0.0; 3];
    let mut standing = 0;
    for (w, &(n, [x, y], drop)) in wheel.iter() {
        if n < STANDING_N {
            continue;
        }
        standing += 1;
        let sag = n / parts.tyres[w].stiffness_n_m;
        let row = [1.0, x, -y];
        let value = drop - sag;
        for r in 0..3 {
            b[r] += row[r] * value;
            for c in 0..3 {
                a[r][c] += row[r] * row[c];
            }
        }
    }
    let flat = matches!(signals.terrain, xt28_sim::Terrain::Flat);
    let solved = (standing >= 3 && flat).then(|| solve3(a, b)).flatten();
    let (roll, pitch) = solved.map_or((f64::NAN, f64::NAN), |[_, pitch, roll]| (roll, pitch));
    let (imu, slope) = (effects.sensors.imu_offset, &effects.slope);
    errors.roll_rad.push(roll + imu.roll_rad - slope.grade_y_rad - signals.roll_rad[i]);
    errors.pitch_rad.push(pitch + imu.pitch_rad + slope.grade_x_rad - signals.pitch_rad[i]);
}

/// Cramer's rule; none where the wheels stand in a line.
fn solve3(a: [[f64; 3]; 3], b: [f64; 3]) -> Option<[f64; 3]> {
    let det = |m: [[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let d = det(a);
    if d.abs() < 1e-6 {
        return None;
    }
    Some([0, 1, 2].map(|c| {
        let mut m = a;
        for r in 0..3 {
            m[r][c] = b[r];
        }
        det(m) / d
    }))
}

impl StanceErrors {
    /// Says nothing within two seconds after the machine changed its speed, or on a ramp.
    fn gate(&mut self, signals: &Signals, machine: &Machine) {
        let mut calm_since = CALM_STEPS;
        let flat = matches!(signals.terrain, xt28_sim::Terrain::Flat);
        for i in 0..signals.len {
            let back = i.saturating_sub(20);
            let change = signals.mean_wheel_speed_rad_s(i) - signals.mean_wheel_speed_rad_s(back);
            let acceleration = change * machine.wheels.radius_m / 0.2;
            calm_since = if acceleration.abs() > CALM_M_S2 { 0 } else { calm_since + 1 };
            let bent = signals.joint_rad[0][i].abs() > BENT_RAD;
            if calm_since < CALM_STEPS || !flat {
                self.pitch_rad[i] = f64::NAN;
                self.weight_x_m[i] = f64::NAN;
            }
            // The accelerometer takes a bend for a lean, and the scrub of the tyres leans on the arms.
            if calm_since < CALM_STEPS || !flat || (bent && calm_since > 0) {
                self.roll_rad[i] = f64::NAN;
                self.weight_y_m[i] = f64::NAN;
            }
        }
    }
}
