//! A transmission taken up from what was measured: what no sensor shows is made to explain what they do.

use xt28_machine::PerWheel;

use super::{Drive, DriveInput, DriveState};
use crate::effects::{DelayLine, Lag};

/// How much harder than by the circuit's own gain a held drive draws the wheels to their speed: within
/// some 30 ms, and stable at steps of 10 ms.
const HOLDING_GAIN: f64 = 4.0;

impl Drive {
    /// A transmission taken up in the middle of what was measured: the throttle has stood for long, and
    /// what holds the mean speed is what the speeds do not explain of the torques.
    #[must_use]
    pub fn resumed(&self, input: &DriveInput, torque_nm: &PerWheel<f64>, dt_s: f64) -> DriveState {
        let delay_s = self.effects.throttle_delay.delay_s;
        let power_w = torque_nm.iter().map(|(w, nm)| nm * input.wheel_speed_rad_s[w]).sum();
        let share = self.effects.engine_droop.speed_share(power_w);
        let ratios = [0, 1].map(|c| self.ratio(c, input));
        let targets = [0, 1].map(|c| self.target_rad_s(c, input));
        let held_nm = [0, 1].map(|c| {
            let circuit_nm = self.circuits[c].iter().map(|&w| torque_nm[w]).sum::<f64>() / 3.0;
            circuit_nm - self.circuit_gain_nms * (share * targets[c] - self.mean_rad_s(c, input))
        });
        DriveState {
            asked_ratio: ratios.map(|ratio| DelayLine::new(delay_s, dt_s, ratio)),
            lagging_ratio: ratios.map(Lag::new),
            target_rad_s: targets,
            felt_power_w: Lag::new(power_w),
            power_w,
            mean_torque_nm: (held_nm[0] + held_nm[1]) / 2.0,
        }
    }

    /// Lets the integral explain the torques measured at the speeds measured, as if they had just come
    /// about, and draw the wheels to those speeds; throttle and engine stay as they are.
    pub(crate) fn reload(
        &self,
        state: &mut DriveState,
        input: &DriveInput,
        speed_rad_s: &PerWheel<f64>,
        torque_nm: &PerWheel<f64>,
    ) {
        let share = self.effects.engine_droop.speed_share(state.felt_power_w.value());
        let measured = DriveInput { wheel_speed_rad_s: *speed_rad_s, ..*input };
        let held_nm = [0, 1].map(|c| {
            let circuit_nm = self.circuits[c].iter().map(|&w| torque_nm[w]).sum::<f64>() / 3.0;
            let target = share * state.target_rad_s[c];
            let (wanted, is) = (self.mean_rad_s(c, &measured), self.mean_rad_s(c, input));
            circuit_nm - self.circuit_gain_nms * (target - wanted)
                + HOLDING_GAIN * self.circuit_gain_nms * (wanted - is)
        });
        let max = self.wheel_torque_max_nm;
        state.mean_torque_nm = (0.5 * (held_nm[0] + held_nm[1])).clamp(-max, max);
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::Machine;

    use super::*;
    use crate::effects::{DriveEffects, DriveLag, Effects};

    const DT_S: f64 = 0.005;

    /// Amid a rise of the throttle, with a servo of its own or behind the nominal one.
    #[test]
    fn a_held_drive_goes_on_with_the_torque_that_was_measured() {
        let input = DriveInput {
            pump_displacement: [0.1; 2],
            motor_displacement: PerWheel::splat(1.0),
            engine_speed_rpm: 1200.0,
            wheel_speed_rad_s: PerWheel::splat(0.02),
        };
        for lead_s in [0.0, 0.2] {
            let lag = DriveLag { time_constant_s: 0.4, lead_s };
            let drive = DriveEffects { lag, ..DriveEffects::default() };
            let drive = Drive::new(&Machine::xt28(), &Effects { drive, ..Effects::default() });
            let mut state = drive.at_rest(DT_S);
            for _ in 0..20 {
                drive.step(&mut state, &input, DT_S);
            }
            let measured_nm = PerWheel::splat(1500.0);
            drive.reload(&mut state, &input, &input.wheel_speed_rad_s, &measured_nm);
            let next_nm = drive.step(&mut state, &input, DT_S).wheel_torque_nm;
            // In a step the lag comes nearer to what is asked by some ten newton metres.
            let off_nm = (next_nm.sum() - measured_nm.sum()) / 6.0;
            assert!(off_nm.abs() < 15.0, "lead of {lead_s} s: {off_nm} Nm off");
        }
    }
}
