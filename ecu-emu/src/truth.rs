//! What the bus does not carry, as CSV: one row a tick, for checks that need the plant's own word.

use std::io::{self, Write};

use xt28_machine::{SimTime, Wheel};
use xt28_sim::VehicleState;

/// Column names, units in the name. `chassis_n` is the greatest force on the frames since the row before, the
/// others are what is at its time.
pub const TRUTH_HEADER: &str = "time_s,x_m,y_m,z_m,yaw_rad,roll_rad,pitch_rad,\
ground_fr_n,ground_fl_n,ground_mr_n,ground_ml_n,ground_br_n,ground_bl_n,chassis_n";

/// Writes one row, newline included.
///
/// # Errors
/// What the writer says.
pub fn write_truth_row(out: &mut impl Write, now: SimTime, s: &VehicleState) -> io::Result<()> {
    let [x, y, z] = s.position_m;
    write!(
        out,
        "{:.3},{x:.4},{y:.4},{z:.4},{:.5},{:.5},{:.5}",
        now.as_secs_f64(),
        s.yaw_rad,
        s.roll_rad,
        s.pitch_rad
    )?;
    for wheel in Wheel::ALL {
        write!(out, ",{:.0}", s.ground_force_n[wheel])?;
    }
    writeln!(out, ",{:.0}", s.chassis_force_n)
}

#[cfg(test)]
mod tests {
    use xt28_machine::PerWheel;

    use super::*;

    #[test]
    fn every_column_has_what_its_name_says() {
        let state = VehicleState {
            position_m: [1.0, 2.0, 3.0],
            yaw_rad: 0.1,
            roll_rad: 0.2,
            pitch_rad: 0.3,
            ground_force_n: PerWheel([11.0, 12.0, 13.0, 14.0, 15.0, 16.0]),
            chassis_force_n: 17.0,
            ..VehicleState::default()
        };
        let mut row = Vec::new();
        write_truth_row(&mut row, SimTime::from_millis(1_250), &state).unwrap();
        let row = String::from_utf8(row).unwrap();
        assert!(row.ends_with('\n'));
        let named: Vec<(&str, f64)> = TRUTH_HEADER
            .split(',')
            .zip(row.trim().split(',').map(|x| x.parse().unwrap()))
            .collect();
        assert_eq!(row.split(',').count(), TRUTH_HEADER.split(',').count());
        let wanted = [
            ("time_s", 1.25),
            ("x_m", 1.0),
            ("y_m", 2.0),
            ("z_m", 3.0),
            ("yaw_rad", 0.1),
            ("roll_rad", 0.2),
            ("pitch_rad", 0.3),
            ("ground_fr_n", 11.0),
            ("ground_fl_n", 12.0),
            ("ground_mr_n", 13.0),
            ("ground_ml_n", 14.0),
            ("ground_br_n", 15.0),
            ("ground_bl_n", 16.0),
            ("chassis_n", 17.0),
        ];
        assert_eq!(named, wanted);
    }
}
