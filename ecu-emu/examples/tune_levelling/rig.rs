//! The arm ECU on the plant, with its valve openings in reach: what the emulator keeps closed.

use std::collections::VecDeque;

use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::{ArmTarget, ArmTargetMode};
use xt28_ecus::{ArmEcu, ArmOutputs, ArmPins, Port, pins};
use xt28_machine::{Machine, PerWheel, SimTime, Wheel};
use xt28_sim::{Actuation, Imu, Plant, STEP, Terrain, Vehicle, VehicleState};

/// Raw 255: the arm is not spoken of, so the ECU takes the machine's own height.
const HOLD_MM: f64 = 510.0;

/// The machine standing on level ground in mode automatic.
pub(crate) struct Rig {
    ecu: ArmEcu,
    out: ArmOutputs,
    counter: AliveCounter,
    plant: Vehicle,
    now: SimTime,
    delayed: VecDeque<PerWheel<f64>>,
    idle: Actuation,
}

impl Rig {
    /// Arms at `stroke_m`, settled for a second, valves `delay_ticks` late.
    pub(crate) fn new(machine: &Machine, stroke_m: PerWheel<f64>, delay_ticks: usize) -> Self {
        let idle = Actuation::idle(machine.drive.engine_speed_rpm);
        let mut plant = Vehicle::new(machine, &Terrain::Flat, stroke_m);
        for _ in 0..200 {
            plant.step(&idle);
        }
        Self {
            ecu: ArmEcu::new(machine),
            out: ArmOutputs::default(),
            counter: AliveCounter::default(),
            plant,
            now: SimTime::ZERO,
            delayed: VecDeque::from(vec![PerWheel::splat(0.0); delay_ticks]),
            idle,
        }
    }

    /// One tick of 10 ms with `disturbance` added to the openings on their way to the plant; gives
    /// what the ECU's currents open, + extends.
    pub(crate) fn tick(&mut self, disturbance: PerWheel<f64>) -> PerWheel<f64> {
        let s = *self.plant.state();
        let pins = ArmPins {
            stroke_mv: s.stroke_m.map(pins::stroke_mv),
            pressure_a_mv: s.pressure_a_pa.map(pins::pressure_mv),
            pressure_b_mv: s.pressure_b_pa.map(pins::pressure_mv),
            supply_mv: 24_000.0,
        };
        let [fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm] = [HOLD_MM; 6];
        let (mode, counter) = (ArmTargetMode::Automatic, self.counter.next_count());
        let target = ArmTarget { fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm, mode, counter };
        self.ecu.on_frame(self.now, Port::Can1, &target.encode().expect("in range"));
        let imu = Imu::default().step(&s);
        for frame in pins::imu_frames(imu.rate_rad_s, imu.specific_force_m_s2) {
            self.ecu.on_frame(self.now, Port::Can2, &frame);
        }
        self.ecu.tick(self.now, &pins, &mut self.out);
        self.now += ArmTarget::PERIOD;

        let (a, b) = (&self.out.solenoid_a_ma, &self.out.solenoid_b_ma);
        let ecu = PerWheel::from_fn(|w: Wheel| pins::valve_opening(a[w], b[w]));
        self.delayed.push_back(PerWheel::from_fn(|w| ecu[w] + disturbance[w]));
        let plant = self.delayed.pop_front().expect("one was just pushed");
        for _ in 0..ArmTarget::PERIOD.as_nanos() / STEP.as_nanos() {
            self.plant.step(&Actuation { arm_opening: plant, ..self.idle });
        }
        ecu
    }

    /// What is true of the plant.
    pub(crate) fn state(&self) -> &VehicleState {
        self.plant.state()
    }
}
