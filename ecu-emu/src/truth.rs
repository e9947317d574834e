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
