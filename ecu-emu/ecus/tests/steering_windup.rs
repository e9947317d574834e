//! What the steering remembers of a long error: the law of the logged machine, integrated here anew.

mod rig;

use rig::Drive;
use xt28_ecus::pins;

/// One joint's law: opening = 0.025 / deg times (error + 0.2 / s times its integral), the integral
/// within 40 deg s, on 415 mA and 315 mA more for a full opening.
#[derive(Default)]
struct Joint {
    integral_deg_s: f64,
    /// Ticks at either end of the integral, right and left.
    at_end: [u32; 2],
}

impl Joint {
    /// Currents left and right, mA, after a tick of 10 ms with that error.
    fn step(&mut self, error_deg: f64) -> [f64; 2] {
        self.integral_deg_s = (self.integral_deg_s + error_deg * 0.01).clamp(-40.0, 40.0);
        self.at_end[0] += u32::from(self.integral_deg_s == -40.0);
        self.at_end[1] += u32::from(self.integral_deg_s == 40.0);
        let opening = 0.025 * (error_deg + 0.2 * self.integral_deg_s);
        match opening {
            o if o >= 0.004 => [415.0 + 315.0 * o.min(1.0), 0.0],
            o if o <= -0.004 => [0.0, 415.0 + 315.0 * (-o).min(1.0)],
            _ => [0.0; 2],
        }
    }
}

/// Front and rear joint of the ECU after one tick of driving: left and right, mA.
fn step(drive: &mut Drive, target_deg: f64, [front_deg, rear_deg]: [f64; 2]) -> [[f64; 2]; 2] {
    drive.pins.joint_front_mv = pins::joint_front_mv(front_deg.to_radians());
    drive.pins.joint_rear_mv = pins::joint_rear_mv(rear_deg.to_radians());
    drive.send(30.0, target_deg, true);
    drive.tick();
    let out = &drive.out;
    [[out.steer_front_a_ma, out.steer_front_b_ma], [out.steer_rear_a_ma, out.steer_rear_b_ma]]
}

/// The front joint stands at 10 deg, 10 deg short of its target for 6 s: 60 deg s without a limit. Both
/// joints have an opening of 0.025 (10 + 0.2 * 40) = 0.45 then, the rear one at 5.6 - 10 = -4.4 deg.
#[test]
fn six_seconds_of_ten_degrees_open_the_valves_by_45_percent() {
    let mut drive = Drive::new(1.0);
    let currents = (0..600).map(|_| step(&mut drive, 20.0, [10.0, -4.4])).last().unwrap();
    for [left_ma, right_ma] in currents {
        assert!((left_ma - 556.75).abs() < 1e-6 && right_ma == 0.0, "{left_ma} {right_ma}");
    }
}

/// Error of 10 deg for 6 s, then of -10 for 10 s, then of 4 for 15 s: into the limit on the left, after
/// 8 s back into that on the right, and out of it again.
#[test]
fn errors_that_last_and_turn_give_the_logged_machine_s_currents() {
    let mut drive = Drive::new(1.0);
    let mut joints = [Joint::default(), Joint::default()];
    let mut rear_deg = -4.4;
    for tick in 0..3100 {
        let wanted_deg: f64 = match tick {
            ..600 => 10.0,
            600..1600 => -10.0,
            _ => 4.0,
        };
        // The rear joint gets to 5.6 deg less that at 50 deg/s: no sensor leaps.
        rear_deg += (5.6 - wanted_deg - rear_deg).clamp(-0.5, 0.5);
        let got = step(&mut drive, 10.0 + wanted_deg, [10.0, rear_deg]);
        let errors_deg = [wanted_deg, 0.56 * 10.0 - rear_deg];
        for (k, joint) in joints.iter_mut().enumerate() {
            let wanted_ma = joint.step(errors_deg[k]);
            for (got_ma, wanted_ma) in got[k].into_iter().zip(wanted_ma) {
                assert!((got_ma - wanted_ma).abs() < 1e-6, "tick {tick}, joint {k}: {got_ma} mA");
            }
        }
    }
    for joint in joints {
        assert!(joint.at_end.iter().all(|ticks| *ticks > 100), "{:?} at an end", joint.at_end);
    }
}
