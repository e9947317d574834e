//! A clone of the emulator is a snapshot; one led along another says on the bus what that one says.

use ecu_emu::{Emulator, EmulatorConfig, TICK};
use xt28_dbc::messages::{ArmTarget, ArmTargetMode};
use xt28_dbc::{Frame, Outbox};
use xt28_machine::{Machine, SimTime};
use xt28_sim::{Effects, Solver, Terrain};

fn config() -> EmulatorConfig {
    let mut effects = Effects::default();
    effects.arms = effects.arms.map(|mut arm| {
        arm.delay.delay_s = 0.2;
        arm
    });
    EmulatorConfig {
        effects,
        solver: Solver::Reduced,
        ..EmulatorConfig::new(Machine::xt28(), Terrain::Flat, Some(3))
    }
}

fn now(tick: u64) -> SimTime {
    SimTime::from_nanos(tick * TICK.as_nanos() as u64)
}

/// Arms to 0.17 m, and 40 mm further from the hundredth tick on.
fn told(tick: u64) -> Frame {
    let [fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm] = [if tick < 100 { 170.0 } else { 210.0 }; 6];
    let (mode, counter) = (ArmTargetMode::ManualPosition, (tick % 15) as u8);
    let target = ArmTarget { fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm, mode, counter };
    target.encode().unwrap()
}

/// Frames of one tick.
fn tick(emulator: &mut Emulator, at: u64) -> Vec<Frame> {
    let mut outbox = Outbox::with_capacity(64);
    emulator.on_frame(now(at), &told(at));
    emulator.tick(now(at), &mut outbox);
    outbox.frames().to_vec()
}

#[test]
fn a_clone_goes_on_bit_for_bit() {
    let mut one = Emulator::new(&config());
    (0..120).for_each(|at| drop(tick(&mut one, at)));
    let mut other = one.clone();
    for at in 120..300 {
        assert_eq!(tick(&mut one, at), tick(&mut other, at), "tick {at}");
    }
    assert_eq!(one.truth(), other.truth());
}

/// Let go in the middle of the arms' step, with 0.2 s of openings on their way to the valves.
#[test]
fn one_led_along_another_goes_on_with_it() {
    let mut real = Emulator::new(&config());
    let mut led = Emulator::set_down(&config());
    led.place(&real.truth());
    let mut outbox = Outbox::with_capacity(64);
    for at in 0..110 {
        tick(&mut real, at);
        led.on_frame(now(at), &told(at));
        led.track(now(at), &real.truth(), &mut outbox);
        outbox.clear();
    }
    for at in 110..300 {
        tick(&mut real, at);
        tick(&mut led, at);
        for (wheel, stroke_m) in real.truth().stroke_m.iter() {
            let off_m = (led.truth().stroke_m[wheel] - stroke_m).abs();
            assert!(off_m < 2.0e-3, "tick {at} {wheel}: {off_m}");
        }
    }
}
