//! What levelling by the firmware of 2016 does to the machine itself: the plant's own word, no bus.

use std::path::Path;

use ecu_emu::{Emulator, EmulatorConfig, Operator, Profile, TICK};
use xt28_dbc::Outbox;
use xt28_machine::{Machine, SimTime};
use xt28_sim::{Terrain, VehicleState};

/// The state after 25 s on a cross slope of 5 deg, levelling with a preset since 7 s.
fn levelled(preset: u8) -> VehicleState {
    let slope = "kind = \"slope\"\ngrade = 0.0875\nuphill_deg = 90.0\n";
    let slope = Terrain::parse(slope, Path::new("slope.toml")).unwrap();
    let script = format!(
        "[[action]]\nat_s = 6.0\nleft_button = {preset}\n\n[[action]]\nat_s = 7.0\nleft_button = 18\n"
    );
    let mut config = EmulatorConfig::new(Machine::xt28(), slope, None);
    config.profile = Profile::Firmware2016;
    config.operator = Operator::parse(&script, Path::new("preset")).unwrap();
    let mut emulator = Emulator::new(&config);
    let start_deg = emulator.truth().roll_rad.to_degrees();
    assert!((start_deg + 5.0).abs() < 0.3, "it leans as the ground does: {start_deg}");
    let mut out = Outbox::default();
    for tick in 0..2500 {
        out.clear();
        emulator.tick(SimTime::ZERO + TICK * tick, &mut out);
    }
    emulator.truth()
}

#[test]
fn every_preset_levels_the_machine_at_its_height() {
    for preset in [10, 11, 12] {
        let state = levelled(preset);
        let [roll_deg, pitch_deg] = [state.roll_rad, state.pitch_rad].map(f64::to_degrees);
        // The ECU's filter may stall 0.2 deg short.
        assert!(roll_deg.abs() < 0.4, "preset {preset}: roll {roll_deg}");
        assert!(pitch_deg.abs() < 0.4, "preset {preset}: pitch {pitch_deg}");
        // A valve opens from 1 mA on, 3 mm of error at the gentlest gain, and then moves 0.5 mm/s.
        let stroke_mm = state.stroke_m.mean() * 1e3;
        assert!((stroke_mm - 250.0).abs() < 8.0, "preset {preset}: mean stroke {stroke_mm}");
        let lightest_n = state.ground_force_n.0.into_iter().fold(f64::INFINITY, f64::min);
        assert!(lightest_n > 0.0, "preset {preset}: {:?}", state.ground_force_n);
    }
}
