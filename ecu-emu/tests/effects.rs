//! Effects on the emulated machine beside the table of `signatures`: what becomes of a run, and that nothing shows of
//! what is not there.

use std::path::Path;

use ecu_emu::{Emulator, EmulatorConfig, TICK};
use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::{
    ArmStatus, ArmStatusState, ArmTarget, ArmTargetMode, PosFront, WheelSpeedSigned,
};
use xt28_dbc::{Frame, Outbox};
use xt28_machine::{Machine, SimTime, Wheel};
use xt28_sim::effects::{CATALOGUE, Effect, Entry, Overlay, Scope};
use xt28_sim::{Effects, Terrain, VehicleState};

mod drive_off;

use drive_off::{LASTS_S, commands};

/// The frames of 14 s: arms go from 170 to 220 mm at 1 s, the machine drives from 3 s on and turns
/// left from 6 s on.
fn bus(effects: Effects) -> Vec<(SimTime, Frame)> {
    run(effects).0
}

/// The same, and what is true of the machine at the end.
fn run(effects: Effects) -> (Vec<(SimTime, Frame)>, VehicleState) {
    let config =
        EmulatorConfig { effects, ..EmulatorConfig::new(Machine::xt28(), Terrain::Flat, Some(5)) };
    let mut emulator = Emulator::new(&config);
    let mut counters = [AliveCounter::default(); 2];
    let (mut out, mut now, mut log) = (Outbox::with_capacity(64), SimTime::ZERO, Vec::new());
    while now.as_secs_f64() < LASTS_S {
        for frame in commands(now.as_secs_f64(), &mut counters) {
            emulator.on_frame(now, &frame);
        }
        emulator.tick(now, &mut out);
        log.extend(out.frames().iter().map(|frame| (now, *frame)));
        out.clear();
        now += TICK;
    }
    (log, emulator.truth())
}

fn with(effect: &str) -> Vec<(SimTime, Frame)> {
    bus(effects(effect))
}

fn effects(effect: &str) -> Effects {
    Overlay::parse(&format!("[[effect]]\n{effect}"), Path::new("test"))
        .unwrap()
        .effects(&Machine::xt28())
        .unwrap()
}

/// One signal over time, of the message that `decode` takes.
fn series<M, E>(
    log: &[(SimTime, Frame)],
    decode: fn(&Frame) -> Result<M, E>,
    signal: impl Fn(&M) -> f64,
) -> Vec<(f64, f64)> {
    let samples = log.iter().filter_map(|(at, frame)| {
        decode(frame).ok().map(|message| (at.as_secs_f64(), signal(&message)))
    });
    samples.collect()
}

/// Largest value after `from_s`.
fn most(series: &[(f64, f64)], from_s: f64) -> f64 {
    series.iter().filter(|(t, _)| *t >= from_s).map(|(_, v)| *v).fold(f64::MIN, f64::max)
}

/// The time at which a series first reaches `value`, s.
fn reaches(series: &[(f64, f64)], value: f64) -> f64 {
    series.iter().find(|(_, v)| *v >= value).expect("it comes to that").0
}

/// Every other effect in force, a tenth of the way, is the same with the rest of them listed at
/// severity zero as without; no frame differs.
#[test]
fn effects_at_severity_zero_leave_the_bus_as_the_others_have_it() {
    let entry = |(k, effect): (usize, &'static Effect), severity: f64| Entry {
        effect,
        scope: Scope::All,
        severity: if k.is_multiple_of(2) { severity } else { 0.1 - severity },
        values: effect.parameters.iter().map(|p| (p, p.range[1])).collect(),
    };
    let nominal = bus(Effects::default());
    for severity in [0.0, 0.1] {
        let all: Vec<Entry> =
            CATALOGUE.iter().enumerate().map(|effect| entry(effect, severity)).collect();
        let in_force = all.iter().filter(|entry| entry.severity > 0.0).cloned().collect();
        let alone = bus(Overlay { entries: in_force }.effects(&Machine::xt28()).unwrap());
        assert!(alone != nominal, "effects in force show");
        assert!(
            bus(Overlay { entries: all }.effects(&Machine::xt28()).unwrap()) == alone,
            "some frame differs"
        );
    }
}

/// A second number of an effect, given as the nominal machine has it, changes no frame.
#[test]
fn second_numbers_at_neutral_leave_the_bus_as_it_is() {
    let nominal = bus(Effects::default());
    for effect in [
        "name = \"arm-gain\"\nki_factor = 1.0",
        "name = \"steer-gain\"\nki_factor = 1.0",
        "name = \"rear-follower-lag\"\nratio_factor = 1.0",
        "name = \"drive-lag\"\ntime_constant_s = 0.0\nlead_s = 0.0",
        "name = \"unsupported-sag\"\nrate_m_s = 0.0\nbelow_n = 0.0",
    ] {
        assert!(with(effect) == nominal, "{effect}");
    }
}

#[test]
fn a_stroke_sensor_off_by_a_centimetre_moves_the_arm_and_not_its_reading() {
    let (biased, truth) = run(effects("name = \"stroke-bias\"\nscope = \"FR\"\nbias_m = 0.01"));
    let (fr, fl) = (
        series(&biased, PosFront::decode, |m| m.fr_mm),
        series(&biased, PosFront::decode, |m| m.fl_mm),
    );
    // Both arms stand alike at first, and one reads a centimetre more (to whole millimetres, with noise).
    let apart_mm = |at_s: f64| {
        let at = |s: &[(f64, f64)]| s.iter().find(|(t, _)| *t >= at_s).unwrap().1;
        at(&fr) - at(&fl)
    };
    assert!((apart_mm(0.0) - 10.0).abs() <= 2.0, "{}", apart_mm(0.0));
    // The controller sees the reading: it takes the centimetre back, and in the end both read the same.
    assert!(apart_mm(13.0).abs() <= 3.0, "{}", apart_mm(13.0));
    assert!((most(&fr, 5.0) - 220.0).abs() < 8.0, "{}", most(&fr, 5.0));
    // What the sensor reads too much, the arm is short of.
    let apart_m = truth.stroke_m[Wheel::Fl] - truth.stroke_m[Wheel::Fr];
    assert!((apart_m - 0.01).abs() < 0.003, "{apart_m} m");
}

#[test]
fn lost_frames_are_the_same_ones_every_time() {
    let lossy = || with("name = \"frame-loss\"\nshare = 0.3");
    assert!(lossy() == lossy(), "a seed is a run");
}

/// Chance that a stream of so many frames is lost at some time: four of them stay away on end. The third still has
/// its deadline, and a stream that has not begun cannot be lost.
fn lost_by_chance(share: f64, frames: usize) -> f64 {
    // Not begun, then by how many have stayed away since the last.
    let (mut idle, mut since) = (1.0, [0.0; LOST_ON_END]);
    for _ in 0..frames {
        let came = (1.0 - share) * (idle + since.iter().sum::<f64>());
        idle *= share;
        for k in (1..LOST_ON_END).rev() {
            since[k] = share * since[k - 1];
        }
        since[0] = came;
    }
    1.0 - idle - since.iter().sum::<f64>()
}

/// Frames on end without which a stream is lost.
const LOST_ON_END: usize = 4;

/// Of sixty machines at each share of loss as many come to a safe stop within 3 s as chance has it. Tolerance: three
/// deviations of so many draws.
#[test]
fn lost_frames_end_runs_as_often_as_their_share_has_it() {
    let (seeds, ticks) = (60_u64, 300);
    for share in [0.02, 0.2, 0.3] {
        let effects = effects(&format!("name = \"frame-loss\"\nshare = {share}"));
        let stops = |seed: u64| {
            let machine = EmulatorConfig::new(Machine::xt28(), Terrain::Flat, Some(seed));
            let config = EmulatorConfig { effects: effects.clone(), ..machine };
            let mut emulator = Emulator::set_down(&config);
            let (mut counter, mut now) = (AliveCounter::default(), SimTime::ZERO);
            let mut stopped = false;
            for _ in 0..ticks {
                let arms = ArmTarget {
                    fr_mm: 170.0,
                    fl_mm: 170.0,
                    mr_mm: 170.0,
                    ml_mm: 170.0,
                    br_mm: 170.0,
                    bl_mm: 170.0,
                    mode: ArmTargetMode::ManualPosition,
                    counter: counter.next_count(),
                };
                emulator.on_frame(now, &arms.encode().unwrap());
                let mut out = Outbox::with_capacity(64);
                emulator.tick(now, &mut out);
                let mut states = out.frames().iter().filter_map(|f| ArmStatus::decode(f).ok());
                stopped |= states.any(|status| status.state == ArmStatusState::SafeStop);
                now += TICK;
            }
            stopped
        };
        let stopped = (0..seeds).filter(|seed| stops(*seed)).count() as f64;
        let chance = lost_by_chance(share, ticks);
        let (wanted, deviation) =
            (chance * seeds as f64, (chance * (1.0 - chance) * seeds as f64).sqrt());
        assert!(
            (stopped - wanted).abs() <= 3.0 * deviation + 0.5,
            "{share}: {stopped} of {seeds}, not {wanted}"
        );
    }
}

#[test]
fn jitter_within_the_deadline_does_no_harm_and_beyond_it_stops_the_machine() {
    let speed = |log: &_| series(log, WheelSpeedSigned::decode, |m| m.fr_rpm);
    let nominal = speed(&bus(Effects::default()));
    let little = speed(&with("name = \"command-jitter\"\nlatest_s = 0.01"));
    assert!((reaches(&little, 3.0) - reaches(&nominal, 3.0)).abs() < 0.1);
    let much = speed(&with("name = \"command-jitter\"\nlatest_s = 1.0"));
    assert!(most(&much, 0.0) < 3.0, "silence of three periods is a safe stop");
}

/// However late, lame or leaky its valves: somebody set its arms by hand, and nothing told to a valve then is left to
/// work on. What sags or creeps by itself does so from the start on.
#[test]
fn a_machine_whose_valves_are_bad_begins_with_its_arms_as_they_were_set() {
    for (effect, creeps_m) in [
        ("name = \"arm-delay\"\ndelay_s = 1.0", 0.001),
        (
            "name = \"arm-delay\"\ndelay_s = 0.3\n[[effect]]\nname = \"valve-gain\"\nfactor = 3.0",
            0.001,
        ),
        ("name = \"valve-lag\"\ntime_constant_s = 2.0", 0.001),
        ("name = \"valve-deadband\"\ndeadband = 0.3", 0.001),
        ("name = \"valve-hysteresis\"\nwidth = 0.3", 0.001),
        ("name = \"accumulator-gas\"\nshare = 1.0", 0.004),
        ("name = \"seal-stiction\"\ncoulomb_n = 4000.0", 0.001),
        ("name = \"leakage-drift\"\nrate_m_s = 0.002", 0.008),
    ] {
        let effects = effects(effect);
        let nominal = EmulatorConfig::new(Machine::xt28(), Terrain::Flat, Some(5));
        let mut emulator = Emulator::new(&EmulatorConfig { effects, ..nominal });
        let (mut out, mut now) = (Outbox::with_capacity(64), SimTime::ZERO);
        while now.as_secs_f64() < 3.0 {
            let truth = emulator.truth();
            for (wheel, stroke_m) in truth.stroke_m.iter() {
                let off_m = (stroke_m - 0.17).abs();
                assert!(off_m < creeps_m + 0.001, "{effect}: {wheel} at {stroke_m} m, {now}");
            }
            let loads_n = truth.ground_force_n;
            let off_n = (loads_n.sum() - 166.8e3).abs();
            assert!(now < SimTime::from_millis(500) || off_n < 2e3, "{effect}: {loads_n:?}");
            emulator.tick(now, &mut out);
            out.clear();
            now += TICK;
        }
    }
}
