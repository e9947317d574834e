//! Faults of sensors and their wires, put between what a sensor says and the ECU's pin.

use std::fmt;
use std::str::FromStr;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use xt28_machine::{SimTime, Wheel};

use crate::ecus::Pins;

/// What an input reads whose wire is broken, mV: pulled up to the sensors' supply (assumed).
const OPEN_MV: f64 = 5_000.0;
/// What an input on the battery reads, mV: its converter's end (assumed).
const BATTERY_MV: f64 = 5_500.0;

/// One fault of one sensor, for a while.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct SensorFault {
    /// Which kind of sensor.
    pub sensor: Sensor,
    /// Of which wheel; for strokes, pressures and wheel speeds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wheel: Option<WheelName>,
    /// What is wrong.
    pub kind: FaultKind,
    /// How much, mV at the pin: of an offset, or one standard deviation of noise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by_mv: Option<f64>,
    /// The same for a wheel speed, Hz.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by_hz: Option<f64>,
    /// When it begins, s from the start.
    pub from_s: f64,
    /// When it is mended, s from the start; never when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to_s: Option<f64>,
}

/// A kind of sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sensor {
    /// Position of a cylinder.
    Stroke,
    /// Pressure in a cylinder's bore chamber.
    PressureA,
    /// Pressure in its rod chamber.
    PressureB,
    /// Speed of a wheel's motor.
    WheelSpeed,
    /// Angle of the front joint.
    JointFront,
    /// Angle of the rear joint.
    JointRear,
    /// Pressure of pump 1, side A.
    Pump1A,
    /// Pressure of pump 1, side B.
    Pump1B,
    /// Pressure of pump 2, side A.
    Pump2A,
    /// Pressure of pump 2, side B.
    Pump2B,
    /// The inertial unit: on a bus of its own, so it can only fall silent (`open-circuit`).
    Imu,
}

/// What can be wrong with a sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FaultKind {
    /// The wire is broken.
    OpenCircuit,
    /// The wire touches ground.
    ShortToGround,
    /// The wire touches the battery.
    ShortToBattery,
    /// It says what it said when the fault began.
    Stuck,
    /// It says too much, or too little.
    Offset,
    /// White noise comes on top.
    Noise,
}

/// A wheel by its name on the wire, `FR` to `BL`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(try_from = "String", into = "String")]
pub struct WheelName(pub Wheel);

impl TryFrom<String> for WheelName {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        let wheel = Wheel::from_name(&name);
        wheel.map(Self).ok_or_else(|| format!("no wheel `{name}`; give FR, FL, MR, ML, BR or BL"))
    }
}

impl From<WheelName> for String {
    fn from(name: WheelName) -> Self {
        name.0.name().to_owned()
    }
}

impl SensorFault {
    /// What is wrong with the fault itself, if anything.
    ///
    /// # Errors
    /// One line that says what and what would be right.
    pub fn check(&self) -> Result<(), String> {
        use Sensor::{Imu, PressureA, PressureB, Stroke, WheelSpeed};
        let per_wheel = matches!(self.sensor, Stroke | PressureA | PressureB | WheelSpeed);
        if per_wheel != self.wheel.is_some() {
            let (is, remedy) = if per_wheel { ("needs", "add") } else { ("has no", "leave out") };
            return Err(format!("sensor {} {is} wheel; {remedy} `wheel`", self.sensor));
        }
        let sized = matches!(self.kind, FaultKind::Offset | FaultKind::Noise);
        let in_hz = self.sensor == WheelSpeed;
        let wanted = match (sized, in_hz) {
            (true, true) => [false, true],
            (true, false) => [true, false],
            (false, _) => [false, false],
        };
        if [self.by_mv.is_some(), self.by_hz.is_some()] != wanted {
            let key = match wanted {
                [true, _] => "give `by_mv`",
                [_, true] => "give `by_hz`",
                _ => "give neither `by_mv` nor `by_hz`",
            };
            return Err(format!("kind {} of sensor {}: {key}", self.kind, self.sensor));
        }
        let by = self.by_mv.or(self.by_hz).unwrap_or(0.0);
        if !by.is_finite() || (self.kind == FaultKind::Noise && by < 0.0) {
            return Err(format!("by {by}: give a finite number, and of noise none below 0"));
        }
        if self.sensor == Imu && self.kind != FaultKind::OpenCircuit {
            return Err("sensor imu can only be `open-circuit`: it falls silent".to_owned());
        }
        let to_s = self.to_s.unwrap_or(f64::INFINITY);
        if !(self.from_s >= 0.0 && self.from_s < to_s) {
            return Err(format!("from_s = {}: give 0 or more, and less than to_s", self.from_s));
        }
        Ok(())
    }

    fn is_on(&self, now_s: f64) -> bool {
        now_s >= self.from_s && self.to_s.is_none_or(|to_s| now_s < to_s)
    }
}

macro_rules! kebab_names {
    ($($type:ident),*) => {
        $(impl fmt::Display for $type {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.serialize(f)
            }
        })*
    };
}

kebab_names!(Sensor, FaultKind);

/// All faults of a run, at work.
#[derive(Clone, Debug)]
pub(crate) struct SensorFaults {
    faults: Vec<(SensorFault, Option<f64>)>,
    random: ChaCha8Rng,
}

impl SensorFaults {
    pub(crate) fn new(faults: &[SensorFault], seed: Option<u64>) -> Self {
        // A stream of its own: others draw from the same seed.
        let mut random = ChaCha8Rng::seed_from_u64(seed.unwrap_or(0));
        random.set_stream(3);
        Self { faults: faults.iter().map(|fault| (*fault, None)).collect(), random }
    }

    /// Changes what is on the pins at `now`.
    pub(crate) fn apply(&mut self, now: SimTime, pins: &mut Pins) {
        let now_s = now.as_secs_f64();
        for (fault, held) in &mut self.faults {
            if !fault.is_on(now_s) {
                *held = None;
                continue;
            }
            let Some(pin) = pin(pins, fault) else { continue };
            let by = fault.by_mv.or(fault.by_hz).unwrap_or(0.0);
            // A frequency input without pulses reads none, however its wire is broken.
            let hz = fault.sensor == Sensor::WheelSpeed;
            *pin = match fault.kind {
                FaultKind::OpenCircuit | FaultKind::ShortToBattery if hz => 0.0,
                FaultKind::OpenCircuit => OPEN_MV,
                FaultKind::ShortToGround => 0.0,
                FaultKind::ShortToBattery => BATTERY_MV,
                FaultKind::Stuck => *held.get_or_insert(*pin),
                FaultKind::Offset => *pin + by,
                FaultKind::Noise => *pin + by * gaussian(&mut self.random),
            };
            if hz {
                *pin = pin.max(0.0);
            }
        }
    }

    /// Whether the inertial unit is silent.
    pub(crate) fn imu_is_silent(&self, now: SimTime) -> bool {
        let now_s = now.as_secs_f64();
        self.faults.iter().any(|(fault, _)| fault.sensor == Sensor::Imu && fault.is_on(now_s))
    }
}

/// Where a fault works; nowhere on the pins for the inertial unit.
fn pin<'a>(pins: &'a mut Pins, fault: &SensorFault) -> Option<&'a mut f64> {
    let Pins { arm, drive, .. } = pins;
    Some(match (fault.sensor, fault.wheel) {
        (Sensor::Stroke, Some(WheelName(wheel))) => &mut arm.stroke_mv[wheel],
        (Sensor::PressureA, Some(WheelName(wheel))) => &mut arm.pressure_a_mv[wheel],
        (Sensor::PressureB, Some(WheelName(wheel))) => &mut arm.pressure_b_mv[wheel],
        (Sensor::WheelSpeed, Some(WheelName(wheel))) => &mut drive.wheel_hz[wheel],
        (Sensor::JointFront, _) => &mut drive.joint_front_mv,
        (Sensor::JointRear, _) => &mut drive.joint_rear_mv,
        (Sensor::Pump1A, _) => &mut drive.pump_mv[0],
        (Sensor::Pump1B, _) => &mut drive.pump_mv[1],
        (Sensor::Pump2A, _) => &mut drive.pump_mv[2],
        (Sensor::Pump2B, _) => &mut drive.pump_mv[3],
        _ => return None,
    })
}

/// A normally distributed number, by Box and Muller.
pub(crate) fn gaussian(random: &mut ChaCha8Rng) -> f64 {
    let radius = (-2.0 * (1.0 - random.random::<f64>()).ln()).sqrt();
    radius * (std::f64::consts::TAU * random.random::<f64>()).cos()
}

impl FromStr for SensorFault {
    type Err = String;

    /// `SENSOR[:WHEEL]:KIND[=BY]@FROM[-TO]`, seconds: `stroke:FR:offset=100@5-8`.
    fn from_str(text: &str) -> Result<Self, String> {
        let form = "write SENSOR[:WHEEL]:KIND[=BY]@FROM_S[-TO_S], as stroke:FR:offset=100@5-8";
        let refuse = |what: &str| format!("{what} in `{text}`; {form}");
        let number = |text: &str| text.parse::<f64>().map_err(|_| refuse("not a number"));
        let (what, when) = text.split_once('@').ok_or_else(|| refuse("no time"))?;
        let (from, to) = when.split_once('-').map_or((when, None), |(from, to)| (from, Some(to)));
        let (what, by) = what.split_once('=').map_or((what, None), |(what, by)| (what, Some(by)));
        let parts: Vec<&str> = what.split(':').collect();
        let (sensor, wheel, kind) = match *parts {
            [sensor, kind] => (sensor, None, kind),
            [sensor, wheel, kind] => (sensor, Some(wheel), kind),
            _ => return Err(refuse("too few or too many parts")),
        };
        let sensor: Sensor = named(sensor).map_err(|why| refuse(&why))?;
        let by = by.map(number).transpose()?;
        let in_hz = sensor == Sensor::WheelSpeed;
        let fault = Self {
            sensor,
            wheel: wheel.map(|name| WheelName::try_from(name.to_owned())).transpose()?,
            kind: named(kind).map_err(|why| refuse(&why))?,
            by_mv: by.filter(|_| !in_hz),
            by_hz: by.filter(|_| in_hz),
            from_s: number(from)?,
            to_s: to.map(number).transpose()?,
        };
        fault.check().map_err(|why| refuse(&why)).map(|()| fault)
    }
}

/// The variant that a file would name so.
fn named<T: serde::de::DeserializeOwned>(name: &str) -> Result<T, String> {
    let name = serde::de::value::StrDeserializer::<serde::de::value::Error>::new(name);
    T::deserialize(name).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use xt28_ecus::pins::{self, Calibration};
    use xt28_machine::PerWheel;

    use super::*;
    use crate::Cab;
    use crate::wiring;

    fn pins() -> Pins {
        let readings = xt28_sim::Readings {
            stroke_m: PerWheel::splat(0.2),
            wheel_speed_rad_s: PerWheel::splat(1.0),
            ..xt28_sim::Readings::default()
        };
        Pins {
            arm: wiring::arm_pins(&readings, &Calibration::default()),
            drive: wiring::drive_pins(&readings, &Calibration::default()),
            cab: Cab::default().pins(),
        }
    }

    fn faulty(text: &str, at_s: f64) -> Pins {
        let fault: SensorFault = text.parse().unwrap();
        let mut pins = pins();
        let now = SimTime::ZERO + std::time::Duration::from_secs_f64(at_s);
        SensorFaults::new(&[fault], Some(1)).apply(now, &mut pins);
        pins
    }

    #[test]
    fn each_fault_changes_its_own_pin_in_its_own_time() {
        let healthy = pins().arm.stroke_mv[Wheel::Fl];
        let stroke_mv = |text: &str, at_s| faulty(text, at_s).arm.stroke_mv;
        assert_eq!(stroke_mv("stroke:FL:open-circuit@5-8", 4.99)[Wheel::Fl], healthy);
        let open = stroke_mv("stroke:FL:open-circuit@5-8", 5.0);
        assert_eq!((open[Wheel::Fl], open[Wheel::Fr]), (5_000.0, healthy));
        assert_eq!(stroke_mv("stroke:FL:open-circuit@5-8", 8.0)[Wheel::Fl], healthy);
        assert_eq!(stroke_mv("stroke:FL:short-to-ground@0", 99.0)[Wheel::Fl], 0.0);
        assert_eq!(stroke_mv("stroke:FL:short-to-battery@0", 0.0)[Wheel::Fl], 5_500.0);
        assert_eq!(stroke_mv("stroke:FL:offset=-40@0", 0.0)[Wheel::Fl], healthy - 40.0);
        assert_eq!(faulty("wheel-speed:BR:open-circuit@0", 0.0).drive.wheel_hz[Wheel::Br], 0.0);
        let slow = faulty("wheel-speed:BR:offset=-1e6@0", 0.0).drive.wheel_hz[Wheel::Br];
        assert_eq!(slow, 0.0, "no fewer pulses than none");
        let joint_mv = faulty("joint-rear:offset=10@0", 0.0).drive.joint_rear_mv;
        assert!((joint_mv - pins::joint_rear_mv(0.0) - 10.0).abs() < 1e-9);
    }

    #[test]
    fn a_stuck_sensor_says_what_it_said_when_it_stuck() {
        let mut faults = SensorFaults::new(&["stroke:FR:stuck@1".parse().unwrap()], None);
        let mut at = |ms: u64, mv: f64| {
            let mut pins = pins();
            pins.arm.stroke_mv[Wheel::Fr] = mv;
            faults.apply(SimTime::from_millis(ms), &mut pins);
            pins.arm.stroke_mv[Wheel::Fr]
        };
        assert_eq!([at(0, 700.0), at(1000, 800.0), at(2000, 900.0)], [700.0, 800.0, 800.0]);
    }

    #[test]
    fn noise_has_the_deviation_asked_for() {
        let mut faults = SensorFaults::new(&["stroke:FR:noise=50@0".parse().unwrap()], Some(7));
        let healthy = pins().arm.stroke_mv[Wheel::Fr];
        let sum: f64 = (0..4000)
            .map(|_| {
                let mut pins = pins();
                faults.apply(SimTime::ZERO, &mut pins);
                (pins.arm.stroke_mv[Wheel::Fr] - healthy).powi(2)
            })
            .sum();
        let deviation_mv = (sum / 4000.0).sqrt();
        assert!((47.0..53.0).contains(&deviation_mv), "{deviation_mv}");
    }

    #[test]
    fn what_makes_no_sense_is_refused_with_the_remedy() {
        let cases = [
            ("stroke:offset=1@0", "add `wheel`"),
            ("joint-front:FR:stuck@0", "leave out `wheel`"),
            ("stroke:FR:offset@0", "give `by_mv`"),
            ("wheel-speed:FR:stuck=3@0", "give neither"),
            ("imu:stuck@0", "open-circuit"),
            ("stroke:XX:stuck@0", "FR, FL, MR"),
            ("brake:stuck@0", "expected one of `stroke`"),
            ("stroke:FR:stuck", "no time"),
            ("stroke:FR:stuck@8-5", "less than to_s"),
            ("stroke:FR:noise=-1@0", "none below 0"),
        ];
        for (text, remedy) in cases {
            let error = text.parse::<SensorFault>().unwrap_err();
            assert!(error.contains(remedy) && !error.contains('\n'), "{text}: {error}");
        }
    }
}
