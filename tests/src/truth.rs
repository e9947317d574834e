//! What was true of the plant during a run: what no bus carries, and only a simulator knows.

use std::io::{self, BufRead};

use xt28_machine::{PerWheel, Wheel};
use xt28_sim::VehicleState;

use crate::Series;

/// True quantities over time, s from the start of the run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Truth {
    /// Vertical force of the ground on each wheel, N.
    pub ground_force_n: Series<PerWheel<f64>>,
    /// Force of the ground on anything but the wheels, the greatest since the sample before, N. Empty where a file has no such column: older
    /// emulators did not write it.
    pub chassis_force_n: Series<f64>,
}

/// Why a truth file was refused.
#[derive(Debug, thiserror::Error)]
pub enum TruthError {
    /// The file could not be read.
    #[error("{name}:{line}: cannot read: {source}")]
    Read {
        /// The file.
        name: String,
        /// Line, from 1.
        line: usize,
        /// What the system said.
        source: io::Error,
    },
    /// A column is missing or a field is no number.
    #[error("{name}:{line}: no number in column {column}; the emulator's --truth writes this file")]
    Column {
        /// The file.
        name: String,
        /// Line, from 1.
        line: usize,
        /// The column.
        column: String,
    },
}

impl Truth {
    /// Adds the plant's state at `at_s`.
    pub fn push(&mut self, at_s: f64, state: &VehicleState) {
        self.ground_force_n.push(at_s, state.ground_force_n);
        self.chassis_force_n.push(at_s, state.chassis_force_n);
    }

    /// From the CSV that the emulator writes; its time zero is `start_s` on the run's clock. A last
    /// line that was cut is left out: the emulator may have died.
    ///
    /// # Errors
    /// [`TruthError`], with file and line.
    pub fn read(mut csv: impl BufRead, name: &str, start_s: f64) -> Result<Self, TruthError> {
        let mut truth = Self::default();
        let mut columns: Vec<String> = Vec::new();
        let mut text = String::new();
        for line in 1.. {
            text.clear();
            csv.read_line(&mut text).map_err(|source| TruthError::Read {
                name: name.to_owned(),
                line,
                source,
            })?;
            // Without its line feed a line was cut, even where its last digits make sense: there may be more.
            let Some(text) = text.strip_suffix('\n') else { break };
            if columns.is_empty() {
                columns = text.split(',').map(str::to_owned).collect();
                continue;
            }
            let fields: Vec<&str> = text.split(',').collect();
            let number = |column: &str| {
                let at = columns.iter().position(|c| c == column);
                at.and_then(|at| fields.get(at)?.parse::<f64>().ok()).ok_or_else(|| {
                    let (name, column) = (name.to_owned(), column.to_owned());
                    TruthError::Column { name, line, column }
                })
            };
            let mut force_n = PerWheel::splat(0.0);
            for wheel in Wheel::ALL {
                force_n[wheel] = number(&format!("ground_{}_n", wheel.name().to_lowercase()))?;
            }
            let at_s = number("time_s")? + start_s;
            truth.ground_force_n.push(at_s, force_n);
            if columns.iter().any(|column| column == "chassis_n") {
                truth.chassis_force_n.push(at_s, number("chassis_n")?);
            }
        }
        Ok(truth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ecu_emu::{TRUTH_HEADER, write_truth_row};
    use xt28_machine::SimTime;

    fn csv() -> String {
        let ground_force_n = PerWheel([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let state =
            VehicleState { ground_force_n, chassis_force_n: 700.0, ..VehicleState::default() };
        let mut csv = format!("{TRUTH_HEADER}\n").into_bytes();
        for tick in 0..3 {
            write_truth_row(&mut csv, SimTime::from_millis(tick * 10), &state).unwrap();
        }
        String::from_utf8(csv).unwrap()
    }

    #[test]
    fn reads_what_the_emulator_writes() {
        let truth = Truth::read(csv().as_bytes(), "t.csv", -2.0).unwrap();
        let samples = truth.ground_force_n.samples();
        assert_eq!(samples.len(), 3);
        assert_eq!(samples[0].at_s, -2.0);
        assert_eq!(samples[0].value, PerWheel([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        assert_eq!(truth.chassis_force_n.samples()[2].value, 700.0);
    }

    #[test]
    fn a_file_from_before_the_frames_were_written_is_read_without_them() {
        let older = csv().replace(",chassis_n", "").replace(",700\n", "\n");
        let truth = Truth::read(older.as_bytes(), "t.csv", 0.0).unwrap();
        assert_eq!(truth.ground_force_n.samples().len(), 3);
        assert!(truth.chassis_force_n.samples().is_empty());
    }

    #[test]
    fn a_cut_last_line_is_left_out_and_a_bad_one_is_named() {
        let csv = csv();
        // Cut within the last number, before it, and within an earlier one.
        for cut in [1, 2, 4, 12] {
            let cut = Truth::read(&csv.as_bytes()[..csv.len() - cut], "t.csv", 0.0).unwrap();
            assert_eq!(cut.ground_force_n.samples().len(), 2);
        }
        let short = csv.replacen(",700\n", "\n", 1);
        let error = Truth::read(short.as_bytes(), "t.csv", 0.0).unwrap_err().to_string();
        assert!(error.starts_with("t.csv:2: no number in column chassis_n"), "{error}");
        let bad = csv.replacen("\n0.010", "\nten", 1);
        let error = Truth::read(bad.as_bytes(), "t.csv", 0.0).unwrap_err().to_string();
        assert!(error.starts_with("t.csv:3: no number in column time_s"), "{error}");
    }
}
