//! Effects of the arms in the corners of their laws, beside the table of `signatures`: turning back within a play, loads
//! that lift off, a pump that others share; on a rig with a single arm where a known load has to be put on.

mod arm_rig;

use arm_rig::{ArmRig, DT_S};
use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::effects::find;
use xt28_sim::{Actuation, Effects, Plant, RapierBodies, STEP, Terrain, Vehicle, VehicleState};

const FULL_M_S: f64 = 0.212;
const FRONT: [Wheel; 2] = [Wheel::Fr, Wheel::Fl];

fn with(name: &str, scope: &str, values: &[(&str, f64)]) -> Effects {
    let mut effects = Effects::default();
    let effect = find(name).expect("the effect is in the catalogue");
    for (key, value) in values {
        let parameter = effect.parameter(key).expect("the effect has the parameter");
        parameter.set(&mut effects, scope.parse().expect("a scope"), *value);
    }
    effects
}

/// Two seconds of standing still, then the states of `seconds` under these arm openings.
fn record(
    effects: &Effects,
    seconds: f64,
    opening: impl Fn(f64, Wheel) -> f64,
) -> Vec<VehicleState> {
    let strokes = PerWheel::splat(0.17);
    let mut vehicle: Vehicle<RapierBodies> =
        Vehicle::with(&Machine::xt28(), effects, &Terrain::Flat, strokes, STEP);
    (0..400).for_each(|_| vehicle.step(&Actuation::idle(1200.0)));
    let steps = (seconds / DT_S).round() as u32;
    let states = (0..steps).map(|step| {
        let t = f64::from(step) * DT_S;
        let arm_opening = PerWheel::from_fn(|wheel| opening(t, wheel));
        vehicle.step(&Actuation { arm_opening, ..Actuation::idle(1200.0) });
        *vehicle.state()
    });
    states.collect()
}

/// Mean speed of an arm's oil between two times: of the stroke, and of what the lock gives way.
fn oil_speed_m_s(states: &[VehicleState], wheel: Wheel, from_s: f64, to_s: f64) -> f64 {
    let at = |t: f64| {
        let s = &states[(t / DT_S).round() as usize];
        let stiffness_n_m = Machine::xt28().hydraulics.lock_stiffness_n_m;
        let damping_n_s_m = Machine::xt28().hydraulics.lock_damping_n_s_m;
        let spring_n = s.cylinder_force_n[wheel] + damping_n_s_m * s.stroke_rate_m_s[wheel];
        s.stroke_m[wheel] + spring_n / stiffness_n_m
    };
    (at(to_s) - at(from_s)) / (to_s - from_s)
}

fn pulse(t: f64, on_s: f64, off_s: f64, opening: f64) -> f64 {
    if (on_s..off_s).contains(&t) { opening } else { 0.0 }
}

#[test]
fn a_play_keeps_the_speed_when_the_command_turns() {
    // Up to 0.2, then back by less than the play, then by more.
    let command = |t: f64, _: Wheel| {
        if t < 1.0 {
            0.2
        } else if t < 2.0 {
            0.17
        } else {
            0.1
        }
    };
    let play = record(&with("valve-hysteresis", "all", &[("width", 0.04)]), 3.0, command);
    for wheel in Wheel::ALL {
        for (from_s, opening) in [(0.4, 0.18), (1.4, 0.18), (2.4, 0.12)] {
            let speed_m_s = oil_speed_m_s(&play, wheel, from_s, from_s + 0.5);
            assert!((speed_m_s - opening * FULL_M_S).abs() < 1e-4, "{wheel}: {speed_m_s}");
        }
    }
}

#[test]
fn below_the_deadband_nothing_moves_and_beyond_it_is_missing() {
    let command = |t: f64, _: Wheel| if t < 2.0 { 0.035 } else { -0.1 };
    let band = record(&with("valve-deadband", "all", &[("deadband", 0.04)]), 3.0, command);
    for wheel in Wheel::ALL {
        let still_m_s = oil_speed_m_s(&band, wheel, 0.0, 1.9);
        assert!(still_m_s.abs() < 1e-8, "{wheel}: {still_m_s}");
        let speed_m_s = oil_speed_m_s(&band, wheel, 2.4, 2.9);
        assert!((speed_m_s + 0.06 * FULL_M_S).abs() < 1e-5, "{wheel}: {speed_m_s}");
    }
}

#[test]
fn a_short_pump_slows_all_who_ask_and_nobody_who_asks_alone() {
    let effects = with("pump-flow-limit", "all", &[("flow_m3_s", 0.002)]);
    let all = record(&effects, 1.0, |_, wheel| if wheel == Wheel::Br { 0.1 } else { 0.3 });
    let area_m2 = Machine::xt28().arms.area_bore_m2;
    let share = 0.002 / (1.6 * FULL_M_S * area_m2);
    for wheel in Wheel::ALL {
        let asked = if wheel == Wheel::Br { 0.1 } else { 0.3 };
        let speed_m_s = oil_speed_m_s(&all, wheel, 0.4, 0.9);
        assert!((speed_m_s - share * asked * FULL_M_S).abs() < 1e-5, "{wheel}: {speed_m_s}");
    }
    let alone = |_: f64, wheel: Wheel| if wheel == Wheel::Br { 0.3 } else { 0.0 };
    assert_eq!(record(&effects, 1.0, alone), record(&Effects::default(), 1.0, alone));
}

#[test]
fn a_short_pump_slows_the_steering_with_the_arms() {
    let turned = |effects: &Effects, arms: f64| {
        let strokes = PerWheel::splat(0.17);
        let mut vehicle: Vehicle<RapierBodies> =
            Vehicle::with(&Machine::xt28(), effects, &Terrain::Flat, strokes, STEP);
        let mut drive = Actuation::idle(1200.0);
        drive.pump_displacement = [1.0; 2];
        (0..800).for_each(|_| vehicle.step(&drive));
        (drive.steer_opening, drive.arm_opening) = ([0.3, 0.0], PerWheel::splat(arms));
        (0..300).for_each(|_| vehicle.step(&drive));
        vehicle.state().joint_rad[0]
    };
    let short = with("pump-flow-limit", "all", &[("flow_m3_s", 0.001)]);
    let nominal_rad = turned(&Effects::default(), 0.2);
    // The arms ask for twice what there is: joint and arms get a little less than half.
    let slowed = turned(&short, 0.2) / nominal_rad;
    assert!((0.4..0.6).contains(&slowed), "{slowed}");
    assert_eq!(turned(&short, 0.0), turned(&Effects::default(), 0.0));
}

/// One wheel drawn up off the ground, then left alone: it hangs, and its arm alone drifts out.
#[test]
fn a_hanging_arm_drifts_out_and_standing_ones_stay() {
    let effects = with("unsupported-sag", "all", &[("rate_m_s", 0.01)]);
    let lift =
        |t: f64, wheel: Wheel| if wheel == Wheel::Mr { pulse(t, 0.0, 2.0, -0.3) } else { 0.0 };
    let states = record(&effects, 4.0, lift);
    let hanging = &states[799];
    assert!(hanging.ground_force_n[Wheel::Mr] < 1.0 && hanging.cylinder_force_n[Wheel::Mr] < -1e4);
    let drift_m_s = oil_speed_m_s(&states, Wheel::Mr, 3.0, 3.99);
    assert!((drift_m_s / 0.01 - 1.0).abs() < 0.1, "{drift_m_s}");
    for wheel in Wheel::ALL.into_iter().filter(|&wheel| wheel != Wheel::Mr) {
        assert!(oil_speed_m_s(&states, wheel, 0.0, 3.99).abs() < 1e-8, "{wheel}");
    }
}

/// With a threshold it sets in under load: the rear arms, which carry less than 40 kN, drift out, and the front
/// ones, which carry twice that, stay. Without a rate no threshold shows, to the bit.
#[test]
fn a_threshold_lets_loaded_arms_drift_and_heavier_ones_stay() {
    let closed = |_: f64, _: Wheel| 0.0;
    let sag = |values: &[(&str, f64)]| with("unsupported-sag", "all", values);
    let states = record(&sag(&[("rate_m_s", 0.01), ("below_n", 40e3)]), 0.5, closed);
    assert!(states.iter().all(|s| s.cylinder_force_n[Wheel::Br] > 5e3), "they are loaded");
    for wheel in [Wheel::Br, Wheel::Bl] {
        let drift_m_s = oil_speed_m_s(&states, wheel, 0.0, 0.4);
        assert!((drift_m_s / 0.01 - 1.0).abs() < 1e-6, "{wheel}: {drift_m_s}");
    }
    for wheel in FRONT {
        assert!(oil_speed_m_s(&states, wheel, 0.0, 0.4).abs() < 1e-8, "{wheel}");
    }
    // Under a load between, in proportion to what is missing of the threshold.
    let drift_m_s = |below_n: f64| {
        let effects = sag(&[("rate_m_s", 0.01), ("below_n", below_n)]);
        let mut rig = ArmRig::new(&effects, 5e3, 0.17, 2e4);
        (0..400).for_each(|_| rig.step(0.0, 2e4));
        (rig.motion.stroke_m - 0.17) / (400.0 * DT_S)
    };
    let (some_m_s, more_m_s) = (drift_m_s(23e3), drift_m_s(26e3));
    assert!(some_m_s > 1e-3 && (more_m_s / some_m_s - 2.0).abs() < 0.02, "{some_m_s} {more_m_s}");
    assert_eq!(
        record(&sag(&[("below_n", 40e3)]), 0.5, closed),
        record(&Effects::default(), 0.5, closed)
    );
}

#[test]
fn seals_hold_below_breakaway_and_slide_beyond() {
    let seals = with("seal-stiction", "all", &[("coulomb_n", 3000.0), ("stribeck_n", 2000.0)]);
    // Sinking 5 and 20 s after more load came on within a second.
    let sunk_m = |effects: &Effects, more_n: f64| {
        let mut rig = ArmRig::new(effects, 6e3, 0.17, 5e4);
        let strokes: Vec<f64> = (0..4000)
            .map(|step| {
                rig.step(0.0, 5e4 + more_n * (f64::from(step) * DT_S).min(1.0));
                rig.motion.stroke_m
            })
            .collect();
        [0.17 - strokes[1000], 0.17 - strokes[3999]]
    };
    // The closed oil gives way by 1 mm for 2 kN where nothing holds the rod.
    let [_, free_m] = sunk_m(&Effects::default(), 4800.0);
    assert!((free_m - 2.4e-3).abs() < 1e-6, "{free_m}");
    // Held, it sinks by what the seals yield and not a micrometre more.
    let [soon_m, held_m] = sunk_m(&seals, 4800.0);
    assert!(held_m < 6e-4 && (held_m - soon_m).abs() < 1e-6, "{soon_m} {held_m}");
    // Beyond breakaway it slides until the oil has what Coulomb's friction leaves, or a bit more.
    let [_, slid_m] = sunk_m(&seals, 12e3);
    assert!((12e3 - slid_m * 2.0e6 - 4000.0).abs() < 1001.0, "{slid_m}");
}

/// Ringing of a mass on the arm, Hz: from the crossings of its rest stroke.
fn ringing_hz(effects: &Effects, load_n: f64) -> f64 {
    let mut rig = ArmRig::new(effects, load_n / 9.81, 0.17, load_n);
    rig.motion.stroke_rate_m_s = 1e-3;
    let mut crossings = Vec::new();
    let mut before_m = 0.0;
    for step in 0..200 {
        rig.step(0.0, load_n);
        let now_m = rig.motion.stroke_m - 0.17;
        if before_m * now_m < 0.0 {
            crossings.push(f64::from(step) * DT_S - DT_S * now_m / (now_m - before_m));
        }
        before_m = now_m;
    }
    let (first, last) = (crossings[0], crossings[crossings.len() - 1]);
    (crossings.len() - 1) as f64 / (2.0 * (last - first))
}

/// On a linear lock a heavier mass rings slower; on gas k = n p A² / V grows with p^(1 + 1/n), and some
/// 30 MN/m of oil give way with it.
#[test]
fn gas_rings_as_the_polytropic_law_says() {
    let soft = |share: f64| {
        let mut effects = with("lock-damping", "all", &[("factor", 0.1)]);
        effects.arms = effects.arms.map(|mut arm| {
            arm.gas.share = share;
            arm
        });
        effects
    };
    let [light_n, heavy_n] = [40e3, 100e3];
    let ratio = |share: f64| ringing_hz(&soft(share), heavy_n) / ringing_hz(&soft(share), light_n);
    let linear = (light_n / heavy_n).sqrt();
    assert!((ratio(0.0) / linear - 1.0).abs() < 0.03, "{}", ratio(0.0));
    let absolute_pa = |load_n: f64| (load_n + 5e5 * 0.00589) / 0.00785 + 1.013e5;
    let stiffness_n_m = |load_n: f64| {
        let pressure_pa = absolute_pa(load_n);
        let volume_m3 = 1.0e-3 * ((1.5e6 + 1.013e5) / pressure_pa).powf(1.0 / 1.3);
        let gas_n_m = 1.3 * pressure_pa * 0.00785_f64.powi(2) / volume_m3;
        (1.0 / gas_n_m + 1.0 / 3.0e7).recip()
    };
    let stiffer = stiffness_n_m(heavy_n) / stiffness_n_m(light_n);
    assert!((ratio(1.0) / (linear * stiffer.sqrt()) - 1.0).abs() < 0.03, "{}", ratio(1.0));
}

/// What is left of a swing after a period goes with exp(-pi c / (m omega)).
#[test]
fn damping_scales_the_decay() {
    let left = |factor: f64| {
        let effects = with("lock-damping", "all", &[("factor", factor)]);
        let mut rig = ArmRig::new(&effects, 2e5, 0.17, 5e4);
        rig.motion.stroke_rate_m_s = 0.01;
        // omega = sqrt(2e6 / 2e5): a period is 1.987 s.
        let rates: Vec<f64> = (0..400)
            .map(|_| {
                rig.step(0.0, 5e4);
                rig.rate_m_s()
            })
            .collect();
        rates[397] / 0.01
    };
    // The implicit step adds a little damping of its own, the same to both.
    let wanted = (-core::f64::consts::PI * 8.5e4 / (2e5 * 10.0_f64.sqrt())).exp();
    assert!(
        (left(2.0) / left(1.0) / wanted - 1.0).abs() < 0.02,
        "{} {wanted}",
        left(2.0) / left(1.0)
    );
}
