//! The load that the engine of a machine of 2016 tells its drive ECU, and what that makes of it.

use std::path::Path;

use ecu_emu::{Emulator, EmulatorConfig, Operator, Profile, TICK, Wire};
use xt28_dbc::Outbox;
use xt28_dbc::messages::Eec2;
use xt28_machine::{Machine, SimTime};
use xt28_sim::Terrain;

/// Forward, and full pedal at 8 s; before that the speed limit is held up for so long.
fn full_pedal(limit_up_s: f64) -> Operator {
    let script = format!(
        "[[action]]\nat_s = 1.0\nright_button = 12\n\n\
         [[action]]\nat_s = 1.5\nright_button = 19\nhold_s = {limit_up_s}\n\n\
         [[action]]\nat_s = 8.0\ngas_percent = 100\n"
    );
    Operator::parse(&script, Path::new("full-pedal")).unwrap()
}

/// Load, percent, and speed of the wheels, m/s: means from 28 s to 38 s, up a grade (< 0: down).
fn up(grade: f64, limit_up_s: f64) -> [f64; 2] {
    let (rise, uphill_deg) = (grade.abs(), if grade < 0.0 { 180.0 } else { 0.0 });
    let slope = format!("kind = \"slope\"\ngrade = {rise}\nuphill_deg = {uphill_deg}\n");
    let slope = Terrain::parse(&slope, Path::new("slope.toml")).unwrap();
    let mut config = EmulatorConfig::new(Machine::xt28(), slope, None);
    config.profile = Profile::Firmware2016;
    config.operator = full_pedal(limit_up_s);
    let mut emulator = Emulator::new(&config);
    let mut out = Outbox::default();
    let (mut load_percent, mut sums, mut count) = (0.0, [0.0; 2], 0.0);
    for tick in 0..3_800 {
        out.clear();
        emulator.tick(SimTime::ZERO + TICK * tick, &mut out);
        let told = emulator.on_wire(Wire::Engine).iter().find(|frame| frame.id() == Eec2::ID);
        // Byte 2, in percent (facts 2.8).
        load_percent = told.map_or(load_percent, |frame| f64::from(frame.data()[2]));
        if tick >= 2_800 {
            // Wheels of 0.74 m.
            let speed_m_s = emulator.truth().wheel_speed_rad_s.mean() * 0.74;
            sums = [sums[0] + load_percent, sums[1] + speed_m_s];
            count += 1.0;
        }
    }
    sums.map(|sum| sum / count)
}

/// An idling engine of 800 rpm (83.8 rad/s) and 1300 Nm keeps a tenth for itself, and 70 % of the rest
/// reach the wheels (both assumed). 17 t at 0.5 m/s take 8.3 kW up a grade of 0.1 and 16.4 kW up one of 0.2:
/// 10.9 % and 21.4 % of the engine's torque, above what rolling takes on the flat.
#[test]
fn a_grade_costs_the_engine_what_it_lifts() {
    let [flat_percent, speed_m_s] = up(0.0, 0.1);
    assert!((10.5..=14.0).contains(&flat_percent), "{flat_percent} %");
    assert!((speed_m_s - 0.5).abs() < 0.02, "{speed_m_s} m/s");
    for (grade, percent) in [(0.1, 10.9), (0.2, 21.4)] {
        let [load_percent, speed_m_s] = up(grade, 0.1);
        let above = load_percent - flat_percent;
        assert!((above - percent).abs() < 1.2, "grade {grade}: {above} %, whole ones");
        assert!((speed_m_s - 0.5).abs() < 0.02, "grade {grade}: {speed_m_s} m/s");
    }
    assert_eq!(up(-0.2, 0.1)[0], 10.0, "downhill the wheels take nothing");
}

/// Facts 4.3: above 60 % of load the limit falls, so the load stays there. Of the 1300 Nm then 47 % are
/// left for the grade of 0.3, besides 10 % of idling and 3 % of rolling: 35.8 kW for 47.9 kN, 0.75 m/s.
#[test]
fn a_grade_that_asks_for_more_than_60_percent_slows_the_machine_down() {
    let [_, flat_m_s] = up(0.0, 6.0);
    assert!((flat_m_s - 1.0).abs() < 0.02, "{flat_m_s} m/s at the whole limit");
    let [load_percent, hill_m_s] = up(0.3, 6.0);
    assert!((load_percent - 60.0).abs() < 2.0, "{load_percent} %");
    assert!((hill_m_s - 0.75).abs() < 0.03, "{hill_m_s} m/s");
}
