//! Faults of reading that the catalogue has; their laws are written anew here.

use std::f64::consts::TAU;

use xt28_gap::{Channel, Series};
use xt28_machine::Machine;
use xt28_sim::effects::Scope;

use super::fault::{Fault, On, Readings, Size, between, change};

/// All of them. A stroke's scale and what the bus does are not among them: a controller answers to either.
pub(super) const FAULTS: &[Fault] = &[
    Fault {
        name: "stroke-bias",
        on: On::Wheels,
        parameters: &[Size { name: "bias_m", within: &[[-0.012, -0.006], [0.006, 0.012]] }],
        lay: stroke_bias,
    },
    Fault {
        name: "pressure-bias",
        on: On::Wheels,
        parameters: &[Size { name: "bias_pa", within: &[[-1.0e6, -5.0e5], [5.0e5, 1.0e6]] }],
        lay: pressure_bias,
    },
    Fault {
        name: "pressure-scale",
        on: On::Wheels,
        parameters: &[Size { name: "factor", within: &[[0.8, 0.9], [1.1, 1.2]] }],
        lay: pressure_scale,
    },
    Fault {
        name: "imu-offset",
        on: On::Machine,
        parameters: &[
            Size { name: "roll_rad", within: &[[-0.025, -0.012], [0.012, 0.025]] },
            Size { name: "pitch_rad", within: &[[-0.025, -0.012], [0.012, 0.025]] },
        ],
        lay: imu_offset,
    },
    Fault {
        name: "wheel-speed-scale",
        on: On::SomeWheels,
        parameters: &[Size { name: "factor", within: &[[0.9, 0.95], [1.05, 1.1]] }],
        lay: wheel_speed_scale,
    },
    Fault {
        name: "gnss-latency",
        on: On::Machine,
        parameters: &[Size { name: "delay_s", within: &[[0.2, 0.5]] }],
        lay: gnss_latency,
    },
    Fault {
        name: "gnss-lever-arm",
        on: On::Machine,
        parameters: &[
            Size { name: "x_m", within: &[[-1.2, -0.6], [0.6, 1.2]] },
            Size { name: "y_m", within: &[[-0.8, -0.4], [0.4, 0.8]] },
        ],
        lay: gnss_lever_arm,
    },
];

/// An arm stands where its sensor says; one that says too much stands as well where it was told to, if it was
/// told as much too far.
fn stroke_bias(readings: &mut Readings, scope: Scope, values: &[f64]) {
    for wheel in scope.wheels() {
        for channel in [Channel::Stroke(wheel), Channel::TargetStroke(wheel)] {
            change(readings, channel, |_, stroke_m| stroke_m + values[0]);
        }
    }
}

fn pressure_bias(readings: &mut Readings, scope: Scope, values: &[f64]) {
    misread(readings, scope, |[bore_pa, rod_pa]| [bore_pa + values[0], rod_pa]);
}

fn pressure_scale(readings: &mut Readings, scope: Scope, values: &[f64]) {
    misread(readings, scope, |pressures_pa| pressures_pa.map(|pa| values[0] * pa));
}

/// Chambers' pressures as `read`, and the cylinder's load that the ECU makes of them. The wheel's load, which it
/// makes of that, stays: no diagnosis looks at it.
fn misread(readings: &mut Readings, scope: Scope, read: impl Fn([f64; 2]) -> [f64; 2]) {
    let arms = Machine::xt28().arms;
    let load_n =
        |[bore_pa, rod_pa]: [f64; 2]| arms.area_bore_m2 * bore_pa - arms.area_rod_m2 * rod_pa;
    for wheel in scope.wheels() {
        let [bore, rod] = [Channel::BorePressure(wheel), Channel::RodPressure(wheel)];
        let (Some(bore_pa), Some(rod_pa)) = (readings.get(&bore), readings.get(&rod)) else {
            continue;
        };
        let (bore_pa, rod_pa) = (bore_pa.clone(), rod_pa.clone());
        let both = |at_s: f64| {
            let held = |series: &Series| series.at(at_s).unwrap_or_default();
            [held(&bore_pa), held(&rod_pa)]
        };
        change(readings, bore, |at_s, _| read(both(at_s))[0]);
        change(readings, rod, |at_s, _| read(both(at_s))[1]);
        change(readings, Channel::CylinderLoad(wheel), |at_s, n| {
            n + load_n(read(both(at_s))) - load_n(both(at_s))
        });
    }
}

fn imu_offset(readings: &mut Readings, _: Scope, values: &[f64]) {
    change(readings, Channel::Roll, |_, roll_rad| roll_rad + values[0]);
    change(readings, Channel::Pitch, |_, pitch_rad| pitch_rad + values[1]);
}

fn wheel_speed_scale(readings: &mut Readings, scope: Scope, values: &[f64]) {
    for wheel in scope.wheels() {
        change(readings, Channel::WheelSpeed(wheel), |_, rad_s| values[0] * rad_s);
    }
}

/// What a receiver says is of `delay_s` ago.
fn gnss_latency(readings: &mut Readings, _: Scope, values: &[f64]) {
    unwind(readings);
    for channel in [Channel::East, Channel::North, Channel::Heading] {
        let Some(series) = readings.get(&channel).cloned() else { continue };
        change(readings, channel, |at_s, now| between(&series, at_s - values[0]).unwrap_or(now));
    }
    wind(readings);
}

/// The antenna is ahead and to the left of where it should be.
fn gnss_lever_arm(readings: &mut Readings, _: Scope, values: &[f64]) {
    unwind(readings);
    if let Some(heading) = readings.get(&Channel::Heading).cloned() {
        let turned = |at_s: f64| between(&heading, at_s).unwrap_or_default().sin_cos();
        let [ahead_m, left_m] = [values[0], values[1]];
        change(readings, Channel::East, |at_s, east_m| {
            let (sin, cos) = turned(at_s);
            east_m + ahead_m * cos - left_m * sin
        });
        change(readings, Channel::North, |at_s, north_m| {
            let (sin, cos) = turned(at_s);
            north_m + ahead_m * sin + left_m * cos
        });
    }
    wind(readings);
}

/// Headings without the step at a full turn.
fn unwind(readings: &mut Readings) {
    let mut last: Option<(f64, f64)> = None;
    change(readings, Channel::Heading, |_, heading_rad| {
        let unwound = last.map_or(heading_rad, |(said, unwound)| {
            let step = heading_rad - said;
            unwound + step - TAU * (step / TAU).round()
        });
        last = Some((heading_rad, unwound));
        unwound
    });
}

/// Headings within one turn.
fn wind(readings: &mut Readings) {
    change(readings, Channel::Heading, |_, heading_rad| heading_rad.rem_euclid(TAU));
}

#[cfg(test)]
mod tests {
    use xt28_machine::Wheel;

    use super::*;

    fn held(value: f64) -> Series {
        (0..100).map(|k| (0.1 * f64::from(k), value)).collect()
    }

    fn first(readings: &Readings, channel: Channel) -> f64 {
        readings[&channel].iter().next().unwrap().1
    }

    #[test]
    fn a_load_is_what_the_pressures_say() {
        let arms = Machine::xt28().arms;
        for wheel in Wheel::ALL {
            let mut readings: Readings = [
                (Channel::BorePressure(wheel), held(1.0e7)),
                (Channel::RodPressure(wheel), held(5.0e5)),
                (Channel::CylinderLoad(wheel), held(75.0e3)),
            ]
            .into();
            pressure_bias(&mut readings, Scope::Wheel(wheel), &[1.0e6]);
            assert!((first(&readings, Channel::BorePressure(wheel)) - 1.1e7).abs() < 1e-3);
            let more_n = first(&readings, Channel::CylinderLoad(wheel)) - 75.0e3;
            assert!((more_n - 1.0e6 * arms.area_bore_m2).abs() < 1e-6);
        }
    }

    #[test]
    fn a_receiver_behind_says_what_was_across_a_full_turn() {
        let turning = (0..100).map(|k| {
            let at_s = 0.1 * f64::from(k);
            (at_s, (0.3 * at_s - 1.0).rem_euclid(TAU))
        });
        let mut readings: Readings = [(Channel::Heading, turning.collect())].into();
        gnss_latency(&mut readings, Scope::All, &[0.35]);
        let said = readings[&Channel::Heading].at(5.0).unwrap();
        assert!((said - (0.3 * 4.65 - 1.0_f64).rem_euclid(TAU)).abs() < 1e-9, "{said}");
    }

    #[test]
    fn an_antenna_ahead_is_ahead_whichever_way_the_machine_looks() {
        let north = std::f64::consts::FRAC_PI_2;
        let mut readings: Readings = [
            (Channel::East, held(3.0)),
            (Channel::North, held(4.0)),
            (Channel::Heading, held(north)),
        ]
        .into();
        gnss_lever_arm(&mut readings, Scope::All, &[1.0, 0.5]);
        let at = [Channel::East, Channel::North].map(|channel| first(&readings, channel));
        assert!((at[0] - 2.5).abs() < 1e-9 && (at[1] - 5.0).abs() < 1e-9, "{at:?}");
    }
}
