//! What two sensors of one thing say on different scales is refused before a cause is sought: logs of our own
//! machine, read with a wrong factor.

mod own_logs;

use xt28_gap::RunSet;
use xt28_gap::diagnosis::Signals;
use xt28_machine::Wheel;
use xt28_sim::Effects;

fn both() -> [Signals; 2] {
    ["arms", "drive"].map(|name| own_logs::run(name, &Effects::default(), true).signals)
}

fn scaled(mut runs: [Signals; 2], by: impl Fn(&mut Signals)) -> Result<(), String> {
    runs.iter_mut().for_each(by);
    RunSet::ensure_agreeing(&runs).map_err(|error| error.to_string())
}

fn times(samples: &mut [f64], factor: f64) {
    samples.iter_mut().for_each(|value| *value *= factor);
}

#[test]
fn a_factor_of_ten_is_told_by_the_channel_that_has_it() {
    let runs = both();
    assert_eq!(scaled(runs.clone(), |_| ()), Ok(()));
    for factor in [10.0, 0.1] {
        let roll = scaled(runs.clone(), |s| times(&mut s.roll_rad, factor)).unwrap_err();
        assert!(roll.contains("roll ") && !roll.contains("pitch "), "{roll}");
        let pitch = scaled(runs.clone(), |s| times(&mut s.pitch_rad, factor)).unwrap_err();
        assert!(pitch.contains("pitch ") && !pitch.contains("roll "), "{pitch}");
        let wheels = scaled(runs.clone(), |s| {
            s.wheel_speed_rad_s.0.iter_mut().for_each(|speed| times(speed, factor));
        });
        assert!(wheels.as_ref().is_err_and(|told| told.contains("wheel speeds")), "{wheels:?}");
    }
}

#[test]
fn an_attitude_of_the_wrong_sign_is_told_to_be_so() {
    let runs = both();
    let roll = scaled(runs.clone(), |s| times(&mut s.roll_rad, -1.0)).unwrap_err();
    assert!(roll.contains("roll -") && !roll.contains("pitch "), "{roll}");
    let pitch = scaled(runs.clone(), |s| times(&mut s.pitch_rad, -1.0)).unwrap_err();
    assert!(pitch.contains("pitch -") && !pitch.contains("roll "), "{pitch}");
}

#[test]
fn what_an_effect_can_do_is_left_to_the_diagnosis() {
    let runs = both();
    for factor in [0.6, 1.5] {
        assert_eq!(scaled(runs.clone(), |s| times(&mut s.roll_rad, factor)), Ok(()));
        assert_eq!(scaled(runs.clone(), |s| times(&mut s.pitch_rad, factor)), Ok(()));
    }
}

#[test]
fn one_wheel_of_another_sign_or_scale_is_told_by_its_name_and_so_are_all_six_turned_over() {
    let runs = both();
    for wheel in Wheel::ALL {
        for factor in [-1.0, 10.0, 0.1] {
            let one = scaled(runs.clone(), |s| {
                times(&mut s.wheel_speed_rad_s[wheel], factor);
                times(&mut s.smooth_wheel_speed_rad_s[wheel], factor);
            });
            assert!(one.unwrap_err().contains(&format!("wheel_speed.{wheel} ")), "{factor}");
        }
    }
    let all = scaled(runs, |s| {
        s.wheel_speed_rad_s.0.iter_mut().for_each(|speed| times(speed, -1.0));
    });
    assert!(all.unwrap_err().contains("sign of the wheel speeds"));
}
