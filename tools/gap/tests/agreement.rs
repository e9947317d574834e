//! What two sensors of one thing say on different scales is refused before a cause is sought: logs of our own
//! machine, read with a wrong factor.

mod own_logs;

use xt28_gap::diagnosis::{Generator, Signals, ensure_agreeing};
use xt28_machine::{Machine, Wheel};
use xt28_sim::Effects;

fn both() -> [Signals; 2] {
    ["arms", "drive"].map(|name| own_logs::run(name, &Effects::default(), true).signals)
}

fn scaled(mut runs: [Signals; 2], by: impl Fn(&mut Signals)) -> Result<(), String> {
    runs.iter_mut().for_each(by);
    ensure_agreeing(&runs, &Machine::xt28()).map_err(|error| error.to_string())
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
    let sensors = "of it and of the strokes in DBC and mapping, or left and right are exchanged";
    assert!(roll.contains(sensors), "{roll}");
    let pitch = scaled(runs.clone(), |s| times(&mut s.pitch_rad, -1.0)).unwrap_err();
    assert!(pitch.contains("pitch -") && !pitch.contains("roll "), "{pitch}");
    assert!(pitch.ends_with("or front and rear are exchanged"), "{pitch}");
    // Nor does it help that something was made of the readings before.
    let machine = Machine::xt28();
    let mut driven = runs;
    for s in &mut driven {
        times(&mut s.roll_rad, -1.0);
        let effects = Effects::default();
        let made = Generator::all().into_iter().flat_map(|g| g.residuals(s, &machine, &effects));
        assert!(made.count() > 30);
    }
    assert!(ensure_agreeing(&driven, &machine).is_err());
}

#[test]
fn strokes_of_another_unit_are_told_by_their_names_and_not_as_an_attitude() {
    let runs = both();
    for factor in [10.0, 0.1] {
        let all = scaled(runs.clone(), |s| {
            s.stroke_m.0.iter_mut().for_each(|stroke| times(stroke, factor));
        });
        let told = all.unwrap_err();
        assert!(told.contains("the strokes are not what their targets"), "{told}");
        assert!(Wheel::ALL.iter().all(|w| told.contains(&format!("stroke.{w} "))), "{told}");
        let one = scaled(runs.clone(), |s| times(&mut s.stroke_m[Wheel::Ml], factor)).unwrap_err();
        assert!(one.contains("stroke.ML ") && !one.contains("stroke.MR "), "{one}");
    }
}

/// As far as effects reach, and an arm that does not move at all.
#[test]
fn slow_and_stuck_arms_and_sensors_that_are_off_are_left_to_the_diagnosis() {
    let of = |change: &dyn Fn(&mut Effects)| {
        let mut effects = Effects::default();
        change(&mut effects);
        scaled(["arms", "drive"].map(|name| own_logs::run(name, &effects, true).signals), |_| ())
    };
    let every = |change: fn(&mut Effects, Wheel)| {
        move |effects: &mut Effects| Wheel::ALL.into_iter().for_each(|w| change(effects, w))
    };
    assert_eq!(of(&every(|e, w| e.arms[w].valve_gain.factor = 0.1)), Ok(()));
    assert_eq!(of(&every(|e, w| e.arms[w].valve_gain.factor = 3.0)), Ok(()));
    assert_eq!(of(&every(|e, w| e.arms[w].delay.delay_s = 1.0)), Ok(()));
    assert_eq!(of(&every(|e, w| e.wheels[w].stroke_scale.factor = 0.5)), Ok(()));
    let stuck = scaled(both(), |s| s.stroke_m[Wheel::Fr].fill(0.02));
    assert!(stuck.as_ref().is_err_and(|told| !told.contains("strokes are not")) || stuck.is_ok());
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
fn a_joint_of_another_sign_or_unit_is_told_and_a_command_too() {
    let runs = both();
    for factor in [-1.0, 10.0, 0.1, 1.0_f64.to_radians()] {
        for (k, joint) in ["front", "rear"].into_iter().enumerate() {
            let one = scaled(runs.clone(), |s| times(&mut s.joint_rad[k], factor)).unwrap_err();
            assert!(one.contains(&format!("sign of joint.{joint}")), "{factor}: {one}");
        }
    }
    let command = scaled(runs, |s| times(&mut s.target_joint_rad, -1.0)).unwrap_err();
    assert!(command.contains("sign of target.front_joint"), "{command}");
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

/// All that is read of wheels and told to them, in drives that tell both sides alike.
#[test]
fn left_and_right_exchanged_are_told_where_the_machine_bends() {
    let exchange = |s: &mut Signals| {
        for [right, left] in
            [[Wheel::Fr, Wheel::Fl], [Wheel::Mr, Wheel::Ml], [Wheel::Br, Wheel::Bl]]
        {
            let (right, left) = (right.index(), left.index());
            s.wheel_speed_rad_s.0.swap(right, left);
            s.smooth_wheel_speed_rad_s.0.swap(right, left);
            s.stroke_m.0.swap(right, left);
            s.stroke_rate_m_s.0.swap(right, left);
            s.target_stroke_m.0.swap(right, left);
            s.cylinder_load_n.0.swap(right, left);
            s.opening.0.swap(right, left);
        }
    };
    let drive = || own_logs::run("drive", &Effects::default(), true).signals;
    let told = |mut s: Signals, change: &dyn Fn(&mut Signals)| {
        change(&mut s);
        ensure_agreeing(&[s], &Machine::xt28()).map_err(|error| error.to_string())
    };
    assert_eq!(told(drive(), &|_| ()), Ok(()));
    let error = told(drive(), &exchange).unwrap_err();
    assert!(
        error.contains("left and right are exchanged in the wheel speeds, or in all"),
        "{error}"
    );
    // A side of which all speeds read too little leads no more in a bend, be it one way alone.
    for factor in [0.6, 1.6] {
        let side = |s: &mut Signals| {
            for w in [Wheel::Fl, Wheel::Ml, Wheel::Bl] {
                times(&mut s.wheel_speed_rad_s[w], factor);
                times(&mut s.smooth_wheel_speed_rad_s[w], factor);
            }
        };
        assert_eq!(told(drive(), &side), Ok(()), "{factor}");
    }
}

/// As far as effects reach, and farther than a machine would be driven with.
#[test]
fn steering_and_wheels_with_a_fault_are_left_to_the_diagnosis() {
    let of = |change: &dyn Fn(&mut Effects)| {
        let mut effects = Effects::default();
        change(&mut effects);
        let runs = ["arms", "drive"].map(|name| own_logs::run(name, &effects, true).signals);
        scaled(runs, |_| ())
    };
    assert_eq!(of(&|e| e.steering.rate.factor = 0.25), Ok(()));
    assert_eq!(of(&|e| e.steering.rate.factor = 3.0), Ok(()));
    assert_eq!(of(&|e| e.steering.gain.kp_factor = 0.2), Ok(()));
    assert_eq!(of(&|e| e.steering.delay.delay_s = 1.0), Ok(()));
    assert_eq!(of(&|e| e.steering.lag.time_constant_s = 2.0), Ok(()));
    assert_eq!(of(&|e| e.steering.backlash.width_rad = 0.1), Ok(()));
    assert_eq!(of(&|e| e.steering.rear_follower.ratio_factor = 0.3), Ok(()));
    assert_eq!(of(&|e| e.wheels[Wheel::Ml].wheel_speed_scale.factor = 1.5), Ok(()));
}
