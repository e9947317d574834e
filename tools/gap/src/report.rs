//! What a replay found, as a table for people and as JSON for scripts.

use serde_json::{Value, json};

use crate::log_fault::told;
use crate::{LogFault, SignalComparison};

/// Result of one replay.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The log.
    pub log: String,
    /// The DBC it was read with.
    pub dbc: String,
    /// Time compared, s.
    pub duration_s: f64,
    /// Frames in the log.
    pub frames: u64,
    /// What is wrong with the log.
    pub faults: Vec<LogFault>,
    /// What our ECUs did that the log cannot have asked for, such as a safe stop.
    pub notes: Vec<String>,
    /// Signals compared; those with a bound first.
    pub rows: Vec<SignalComparison>,
}

impl Report {
    /// True if every bound is kept, and there was one to keep.
    #[must_use]
    pub fn passed(&self) -> bool {
        let mut judged = self.rows.iter().filter_map(|row| row.passed).peekable();
        judged.peek().is_some() && judged.all(|passed| passed)
    }

    /// A table with one line a signal, a line for each fault of the log (one for what befell many
    /// messages alike) and each note, then the verdict.
    #[must_use]
    pub fn table(&self) -> String {
        const HEAD: [&str; 9] =
            ["", "signal", "unit", "RMSE", "bound", "max", "at s", "bias", "corr"];
        let rows: Vec<[String; 9]> = self.rows.iter().map(cells).collect();
        let widths: [usize; 9] = std::array::from_fn(|i| {
            rows.iter().map(|row| row[i].chars().count()).max().unwrap_or(0).max(HEAD[i].len())
        });
        let mut table = line(&HEAD.map(str::to_owned), &widths);
        for row in &rows {
            table += &line(row, &widths);
        }
        // A replay holds the value before, whoever lost the next.
        for fault in told(&self.faults, false) {
            table += &format!("{fault}\n");
        }
        for note in &self.notes {
            table += &format!("{}: {note}\n", self.log);
        }
        table + &self.verdict()
    }

    /// The same for scripts; numbers in the rows' units.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({
            "log": self.log,
            "dbc": self.dbc,
            "duration_s": self.duration_s,
            "frames": self.frames,
            "passed": self.passed(),
            "faults": self.faults.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "notes": self.notes,
            "signals": self.rows,
        })
    }

    fn verdict(&self) -> String {
        let judged = self.rows.iter().filter(|row| row.bound.is_some()).count();
        let out = self.rows.iter().filter(|row| row.passed == Some(false)).count();
        let time =
            format!("{:.1} s, {} frames, RMSE against the bound", self.duration_s, self.frames);
        if out == 0 {
            format!("{}: all {judged} judged signals in bounds ({time})\n", self.log)
        } else {
            format!("{}: {out} of {judged} judged signals out of bounds ({time})\n", self.log)
        }
    }
}

fn cells(row: &SignalComparison) -> [String; 9] {
    let e = &row.errors;
    let mark = match row.passed {
        Some(true) => "ok",
        Some(false) => "OUT",
        None => "",
    };
    [
        mark.to_owned(),
        row.signal.clone(),
        row.unit.to_owned(),
        number(e.rmse),
        row.bound.map_or_else(String::new, |bound| bound.to_string()),
        number(e.max),
        format!("{:.2}", e.max_at_s),
        number(e.bias),
        e.correlation.map_or_else(|| "-".to_owned(), |corr| format!("{corr:.4}")),
    ]
}

/// Three decimals: a micrometre where millimetres are shown.
fn number(value: f64) -> String {
    format!("{value:.3}")
}

/// Words to the left, numbers to the right.
fn line(cells: &[String; 9], widths: &[usize; 9]) -> String {
    let column = |i: usize| {
        let (cell, width) = (&cells[i], widths[i]);
        if i < 3 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
    };
    let columns: [String; 9] = std::array::from_fn(column);
    columns.join("  ").trim_end().to_owned() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Errors;

    fn report(rmse: f64) -> Report {
        let errors = Errors {
            samples: 10,
            rmse,
            max: 2.0 * rmse,
            max_at_s: 1.5,
            bias: -rmse,
            correlation: None,
        };
        let bound = Some(5.0);
        let signal = "stroke.FR".to_owned();
        let row = SignalComparison { signal, unit: "mm", errors, bound, passed: Some(rmse <= 5.0) };
        Report {
            log: "a.log".to_owned(),
            dbc: "a.dbc".to_owned(),
            duration_s: 3.0,
            frames: 20,
            faults: Vec::new(),
            notes: Vec::new(),
            rows: vec![row],
        }
    }

    #[test]
    fn the_verdict_is_that_of_the_rows() {
        assert!(report(4.9).passed());
        assert!(!report(5.1).passed());
        assert!(!Report { rows: Vec::new(), ..report(1.0) }.passed());
    }

    #[test]
    fn the_table_marks_what_is_out() {
        let table = report(5.1).table();
        let row = table.lines().nth(1).unwrap();
        assert!(row.starts_with("OUT  stroke.FR  mm"), "{table}");
        assert!(table.ends_with(
            "1 of 1 judged signals out of bounds (3.0 s, 20 frames, RMSE against the bound)\n"
        ));
        assert!(table.lines().all(|line| line == line.trim_end()), "{table}");
    }

    #[test]
    fn json_has_the_errors_flat_in_each_signal() {
        let json = report(4.0).json();
        assert_eq!(json["passed"], true);
        assert_eq!(json["signals"][0]["signal"], "stroke.FR");
        assert_eq!(json["signals"][0]["rmse"], 4.0);
        assert!(json["signals"][0]["correlation"].is_null());
    }
}
