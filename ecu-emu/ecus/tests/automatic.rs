//! Mode automatic through the pins and frames alone: what the cascade answers, and when it refuses.

use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::{ActCurrentFront, ArmStatus, ArmStatusMode, ArmStatusState, ArmTarget};
use xt28_dbc::messages::{ArmTargetMode, RefCurrentFront};
use xt28_dbc::{CanId, Frame};
use xt28_ecus::{ArmEcu, ArmOutputs, ArmPins, Port, PositionGains, pins};
use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, SimTime, Wheel};

/// Raw 255: the arm is not spoken of.
const HOLD_MM: f64 = 510.0;

struct Rig {
    ecu: ArmEcu,
    now: SimTime,
    pins: ArmPins,
    roll_rad: f64,
    pitch_rad: f64,
    imu: bool,
    out: ArmOutputs,
    counter: AliveCounter,
}

impl Rig {
    /// Level at the nominal height, every cylinder with the same load.
    fn new() -> Self {
        Self::of(&Machine::xt28())
    }

    fn of(machine: &Machine) -> Self {
        let pins = ArmPins {
            stroke_mv: PerWheel::splat(pins::stroke_mv(0.2505)),
            pressure_a_mv: PerWheel::splat(pins::pressure_mv(7e6)),
            pressure_b_mv: PerWheel::splat(pins::pressure_mv(5e5)),
            supply_mv: 24_000.0,
        };
        Self {
            ecu: ArmEcu::new(machine),
            now: SimTime::ZERO,
            pins,
            roll_rad: 0.0,
            pitch_rad: 0.0,
            imu: true,
            out: ArmOutputs::default(),
            counter: AliveCounter::default(),
        }
    }

    fn tick(&mut self, mode: ArmTargetMode, mm: f64) -> ArmStatus {
        let counter = self.counter.next_count();
        let [fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm] = [mm; 6];
        let target = ArmTarget { fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm, mode, counter };
        self.ecu.on_frame(self.now, Port::Can1, &target.encode().unwrap());
        if self.imu {
            let (pitch, roll) = (self.pitch_rad.sin(), self.roll_rad.sin());
            let force = [pitch, -roll, 1.0].map(|f| f * GRAVITY_M_S2);
            for frame in pins::imu_frames([0.0; 3], force) {
                self.ecu.on_frame(self.now, Port::Can2, &frame);
            }
        }
        self.ecu.tick(self.now, &self.pins, &mut self.out);
        self.now += ArmTarget::PERIOD;
        ArmStatus::decode(&self.frame(ArmStatus::ID)).unwrap()
    }

    fn automatic(&mut self, mm: f64) -> ArmStatus {
        (0..20).map(|_| self.tick(ArmTargetMode::Automatic, mm)).last().unwrap()
    }

    fn frame(&self, id: CanId) -> Frame {
        *self.out.can1.frames().iter().find(|frame| frame.id() == id).expect("sent every tick")
    }

    /// Valve opening at the solenoids, + extends.
    fn opening(&self) -> PerWheel<f64> {
        let (a, b) = (&self.out.solenoid_a_ma, &self.out.solenoid_b_ma);
        PerWheel::from_fn(|w: Wheel| pins::valve_opening(a[w], b[w]))
    }
}

#[test]
fn a_level_machine_at_its_height_is_left_alone() {
    let mut rig = Rig::new();
    let status = rig.automatic(HOLD_MM);
    assert_eq!((status.mode, status.state), (ArmStatusMode::Automatic, ArmStatusState::Active));
    assert_eq!(rig.opening(), PerWheel::splat(0.0));
}

#[test]
fn height_comes_from_the_targets_and_from_the_machine_without_them() {
    // 20 mm at 760 kN/m and 13e-6 per N; the integral has added a fiftieth in its 0.2 s.
    let opens = 0.2 * 0.988 * 1.02;
    let mut higher = Machine::xt28();
    higher.levelling.height_m = 0.27;
    for (machine, mm, opening) in [
        (Machine::xt28(), 270.0, opens),
        (Machine::xt28(), 230.0, -opens),
        (higher.clone(), HOLD_MM, opens),
        (higher, 250.0, 0.0),
    ] {
        let mut rig = Rig::of(&machine);
        rig.automatic(mm);
        let close = |o: &f64| (o - opening).abs() < 0.005;
        assert!(rig.opening().0.iter().all(close), "{mm} mm: {:?}", rig.opening());
    }
}

#[test]
fn the_right_arms_give_way_when_the_right_side_is_high() {
    let mut rig = Rig::new();
    rig.roll_rad = 3_f64.to_radians();
    rig.automatic(HOLD_MM);
    let opening = rig.opening();
    for (right, left) in [(Wheel::Fr, Wheel::Fl), (Wheel::Mr, Wheel::Ml), (Wheel::Br, Wheel::Bl)] {
        assert!(opening[right] < -0.1 && opening[left] > 0.1, "{opening:?}");
    }
}

#[test]
fn nose_up_lowers_the_front_and_leaves_the_middle() {
    let mut rig = Rig::new();
    rig.pitch_rad = 2_f64.to_radians();
    rig.automatic(HOLD_MM);
    let opening = rig.opening();
    assert!(opening[Wheel::Fr] < -0.1 && opening[Wheel::Bl] > 0.1, "{opening:?}");
    assert_eq!(opening[Wheel::Mr], 0.0);
}

#[test]
fn a_wheel_that_carries_too_much_gives_way_and_the_sum_of_all_stays() {
    let mut rig = Rig::new();
    rig.pins.pressure_a_mv[Wheel::Mr] = pins::pressure_mv(11e6);
    rig.automatic(HOLD_MM);
    let opening = rig.opening();
    assert!(opening[Wheel::Mr] < -0.05, "{opening:?}");
    // Its neighbours take over; neither the sum nor the balance of the sides is touched.
    assert!(opening[Wheel::Fr] > 0.02 && opening[Wheel::Br] > 0.02, "{opening:?}");
    assert!(opening.mean().abs() < 0.005, "{opening:?}");
}

/// What is not as it should be, and how far it opens one valve.
type Disturbance = (fn(&mut Rig), Wheel, f64);

#[test]
fn each_weight_is_that_of_its_own_controller() {
    // Forces in the gains of the machine file, then 13e-6 of opening per N.
    let disturbances: [Disturbance; 4] = [
        // 20 mm too low at 760 kN/m: 15.2 kN.
        (|rig| rig.pins.stroke_mv = PerWheel::splat(pins::stroke_mv(0.2305)), Wheel::Mr, 0.198),
        // 0.035 rad at 340 kN/rad: 11.9 kN.
        (|rig| rig.roll_rad = 0.035, Wheel::Ml, 0.155),
        // 0.02 rad at 1160 kN/rad: 23.2 kN.
        (|rig| rig.pitch_rad = 0.02, Wheel::Br, 0.302),
        // 40 bar on 78.5 cm2 are 15.7 kN at the wheel (facts 1.4). With axles at 0, -3.7 and -6.05 m
        // the evenest split leaves 1/3 + 0.45^2 / 37.21 of it on its own middle wheel: 10.4 kN less.
        (|rig| rig.pins.pressure_a_mv[Wheel::Mr] = pins::pressure_mv(11e6), Wheel::Mr, -0.135),
    ];
    for (own, (disturb, wheel, opening)) in disturbances.into_iter().enumerate() {
        for weight in 0..4 {
            for value in [0.0, 0.5] {
                let mut machine = Machine::xt28();
                machine.levelling.weights[weight] = value;
                let mut rig = Rig::of(&machine);
                disturb(&mut rig);
                rig.automatic(HOLD_MM);
                let share = if weight == own { value } else { 1.0 };
                // The integral adds a fiftieth in 0.2 s; the inertial unit has 0.001 g a count.
                let error = rig.opening()[wheel] - 1.02 * share * opening;
                assert!(error.abs() < 0.008, "{own}, weight {weight}: {:?}", rig.opening());
            }
        }
    }
}

/// All arms at an end, and a roll that asks one side to go on.
#[test]
fn no_valve_opens_towards_a_stroke_end() {
    for (stroke_mm, target_mm) in [(0.0, 0.0), (501.0, 500.0)] {
        let mut rig = Rig::new();
        rig.pins.stroke_mv = PerWheel::splat(pins::stroke_mv(stroke_mm * 1e-3));
        rig.roll_rad = 0.035;
        rig.automatic(target_mm);
        let opening = rig.opening();
        for (right, left) in
            [(Wheel::Fr, Wheel::Fl), (Wheel::Mr, Wheel::Ml), (Wheel::Br, Wheel::Bl)]
        {
            if stroke_mm == 0.0 {
                assert!(opening[right] == 0.0 && opening[left] > 0.1, "{opening:?}");
            } else {
                assert!(opening[right] < -0.1 && opening[left] == 0.0, "{opening:?}");
            }
        }
    }
}

#[test]
fn the_bus_says_what_is_asked_of_the_solenoids_and_what_flows() {
    let mut rig = Rig::new();
    rig.automatic(HOLD_MM);
    rig.roll_rad = 5_f64.to_radians();
    // The attitude filter follows an acceleration alone slowly: wait for the valve to open.
    let opened = (0..200).find(|_| {
        rig.tick(ArmTargetMode::Automatic, HOLD_MM);
        RefCurrentFront::decode(&rig.frame(RefCurrentFront::ID)).unwrap().fl_b_ma > 0.0
    });
    assert!(opened.is_some());
    let wanted = RefCurrentFront::decode(&rig.frame(RefCurrentFront::ID)).unwrap();
    let actual = ActCurrentFront::decode(&rig.frame(ActCurrentFront::ID)).unwrap();
    assert!(wanted.fl_b_ma > 400.0, "{wanted:?}");
    let share = actual.fl_b_ma / wanted.fl_b_ma;
    // 1 - exp(-10 ms / 8 ms) after the first tick.
    assert!((share - 0.7135).abs() < 0.01, "{share}");
}

#[test]
fn any_input_in_the_loop_that_breaks_stops_the_arms() {
    let breaks: [fn(&mut Rig); 3] = [
        |rig| rig.imu = false,
        |rig| rig.pins.pressure_b_mv[Wheel::Ml] = 0.0,
        |rig| rig.pins.stroke_mv[Wheel::Br] = 4900.0,
    ];
    for broken in breaks {
        let mut rig = Rig::new();
        rig.roll_rad = 0.1;
        assert_eq!(rig.automatic(HOLD_MM).state, ArmStatusState::Active);
        broken(&mut rig);
        rig.automatic(HOLD_MM);
        let status = rig.automatic(HOLD_MM);
        assert_eq!((status.state, status.mode), (ArmStatusState::Fault, ArmStatusMode::Off));
        assert_eq!(rig.out.solenoid_a_ma.sum() + rig.out.solenoid_b_ma.sum(), 0.0);
    }
}

/// A wire that breaks is known for broken after 200 ms; a loose one never. Neither moves an arm.
#[test]
fn an_input_in_doubt_opens_no_valve_then_or_later() {
    let breaks: [fn(&mut ArmPins); 4] = [
        |pins| pins.pressure_a_mv[Wheel::Fl] = 5_000.0,
        |pins| pins.pressure_b_mv[Wheel::Mr] = 5_500.0,
        |pins| pins.pressure_a_mv[Wheel::Bl] = 0.0,
        |pins| pins.stroke_mv[Wheel::Fr] = 0.0,
    ];
    for broken in breaks {
        // Level, nothing is to be done; leaning, all six arms would be at work.
        for roll_rad in [0.0, 0.035] {
            let mut rig = Rig::new();
            rig.roll_rad = roll_rad;
            rig.automatic(HOLD_MM);
            let (sound, level) = (rig.pins, roll_rad == 0.0);
            let waits = |rig: &Rig| rig.opening() == PerWheel::splat(0.0);
            assert_eq!(waits(&rig), level);
            broken(&mut rig.pins);
            for tick in 0..60 {
                if tick == 19 {
                    rig.pins = sound;
                }
                let status = rig.tick(ArmTargetMode::Automatic, HOLD_MM);
                assert_eq!(status.state, ArmStatusState::Active, "tick {tick}");
                assert!(waits(&rig) || !level && tick >= 19, "tick {tick}: {:?}", rig.opening());
            }
            assert_eq!(waits(&rig), level);
        }
    }
}

#[test]
fn position_control_needs_neither_pressures_nor_attitude() {
    let mut rig = Rig::new();
    rig.imu = false;
    rig.pins.pressure_a_mv = PerWheel::splat(0.0);
    let status = (0..40).map(|_| rig.tick(ArmTargetMode::ManualPosition, 300.0)).last().unwrap();
    assert_eq!(status.state, ArmStatusState::Active);
}

#[test]
fn a_mode_that_comes_back_begins_anew() {
    let mut rig = Rig::new();
    rig.automatic(300.0);
    rig.tick(ArmTargetMode::Off, HOLD_MM);
    assert_eq!(rig.opening(), PerWheel::splat(0.0));
    rig.automatic(HOLD_MM);
    assert_eq!(rig.opening(), PerWheel::splat(0.0), "nothing was left of the integral");
}

#[test]
fn gains_may_differ_by_arm() {
    let machine = Machine::xt28();
    let mut rig = Rig::new();
    let own = PositionGains::new(&machine.hydraulics);
    let mut gains = PerWheel::splat(own);
    gains[Wheel::Bl].kp_per_mm = own.kp_per_mm / 2.0;
    rig.ecu.set_position_gains(gains);
    rig.tick(ArmTargetMode::ManualPosition, 290.0);
    let opening = rig.opening();
    assert!((opening[Wheel::Fr] - 0.16).abs() < 0.003, "{opening:?}");
    assert!((opening[Wheel::Bl] - 0.08).abs() < 0.003, "{opening:?}");
}
