//! What came of a run, as a table for people and as JSON for scripts.

use serde_json::{Value, json};

use crate::finding::significant;
use crate::{Bound, Conditions, Driven, Finding};

/// Result of one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of all noise.
    pub seed: u64,
    /// `virtual`, or the CAN interface.
    pub bus: String,
    /// Under what it was driven.
    pub conditions: Conditions,
    /// What was found, in the scenario's order.
    pub findings: Vec<Finding>,
    /// What the gateway said of itself at its end, where it could.
    pub driven: Option<Driven>,
    /// Length of the run on its own clock, s.
    pub simulated_s: f64,
    /// What the run cost, if the caller measured it.
    pub cost: Option<Cost>,
    /// SHA-256 of the candump log, hexadecimal.
    pub log_sha256: String,
    /// Frames in the log.
    pub frames: u64,
    /// Share of the time the bus was taken, 0 to 1; unknown on a bus without bit rate.
    pub bus_load: Option<f64>,
}

/// What a run cost in wall time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// The whole run, s.
    pub wall_s: f64,
    /// One step of the plant with its share of the ECUs, µs; where the run was in one process.
    pub physics_step_us: Option<f64>,
    /// How far the latest tick was behind its time, ms; where the run was paced by wall time.
    pub lateness_max_ms: Option<f64>,
}

impl Report {
    /// True if every finding passed, and there was one.
    #[must_use]
    pub fn passed(&self) -> bool {
        !self.findings.is_empty() && self.findings.iter().all(Finding::passed)
    }

    /// Simulated time over wall time.
    #[must_use]
    pub fn real_time_factor(&self) -> Option<f64> {
        self.cost.map(|cost| self.simulated_s / cost.wall_s)
    }

    /// A table with one line a finding, and lines of figures and the gateway's own account below.
    #[must_use]
    pub fn table(&self) -> String {
        let rows: Vec<[String; 5]> = self.findings.iter().map(row).collect();
        let head = ["", "expectation", "measured", "wanted", "unit"].map(str::to_owned);
        let width = |column: usize| {
            let cells = rows.iter().chain([&head]).map(|row| row[column].chars().count());
            cells.max().unwrap_or(0)
        };
        let widths: [usize; 5] = std::array::from_fn(width);
        let line = |cells: &[String; 5], note: &str| {
            let [mark, what, measured, wanted, unit] = cells;
            let [w0, w1, w2, w3, w4] = widths;
            let line = format!(
                "{mark:<w0$}  {what:<w1$}  {measured:>w2$}  {wanted:<w3$}  {unit:<w4$}  {note}"
            );
            line.trim_end().to_owned() + "\n"
        };
        let mut table = line(&head, "");
        for (cells, finding) in rows.iter().zip(&self.findings) {
            table += &line(cells, &finding.note);
        }
        table + &self.figures()
    }

    fn figures(&self) -> String {
        let verdict = if self.passed() { "passed" } else { "FAILED" };
        let mut text = format!(
            "\n{} {verdict}: seed {}, {} bus, {} s simulated, {} frames",
            self.scenario,
            self.seed,
            self.bus,
            significant(self.simulated_s),
            self.frames
        );
        if let Some(load) = self.bus_load {
            text += &format!(", bus load {:.1} %", load * 100.0);
        }
        if let (Some(cost), Some(factor)) = (self.cost, self.real_time_factor()) {
            text += &format!("\n{:.2} s of wall time, {factor:.1} times real time", cost.wall_s);
            if let Some(step_us) = cost.physics_step_us {
                text += &format!(", {step_us:.0} µs a physics step");
            }
            if let Some(lateness_ms) = cost.lateness_max_ms {
                text += &format!(", ticks up to {lateness_ms:.1} ms late");
            }
        }
        text += &format!("\n{}", self.conditions.line());
        if let Some(driven) = &self.driven {
            text += &format!("\ngateway: {driven}");
        }
        text + &format!("\nlog sha256 {}\n", self.log_sha256)
    }

    /// The report as JSON. Absent figures are null.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({
            "scenario": self.scenario,
            "seed": self.seed,
            "bus": self.bus,
            "conditions": self.conditions.json(),
            "passed": self.passed(),
            "expectations": self.findings.iter().map(finding_json).collect::<Vec<_>>(),
            "gateway": self.driven,
            "simulated_s": self.simulated_s,
            "wall_s": self.cost.map(|cost| cost.wall_s),
            "real_time_factor": self.real_time_factor(),
            "physics_step_us": self.cost.and_then(|cost| cost.physics_step_us),
            "lateness_max_ms": self.cost.and_then(|cost| cost.lateness_max_ms),
            "log_sha256": self.log_sha256,
            "frames": self.frames,
            "bus_load": self.bus_load,
        })
    }
}

fn row(finding: &Finding) -> [String; 5] {
    let mark = if finding.passed() { "ok" } else { "FAIL" };
    let measured = finding.measured.map_or_else(|| "-".to_owned(), significant);
    let unit = finding.unit.to_owned();
    [mark.to_owned(), finding.what.clone(), measured, finding.wanted.to_string(), unit]
}

fn finding_json(finding: &Finding) -> Value {
    let wanted = match finding.wanted {
        Bound::Near { value, tolerance } => json!({ "value": value, "tolerance": tolerance }),
        Bound::AtMost(limit) => json!({ "at_most": limit }),
        Bound::Between(low, high) => json!({ "from": low, "to": high }),
    };
    json!({
        "what": finding.what,
        "passed": finding.passed(),
        "measured": finding.measured,
        "wanted": wanted,
        "unit": finding.unit,
        "note": finding.note,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(findings: Vec<Finding>) -> Report {
        Report {
            scenario: "s".to_owned(),
            seed: 7,
            conditions: Conditions {
                policy: "hold".to_owned(),
                solver: "rapier".to_owned(),
                effects: Vec::new(),
            },
            bus: "virtual".to_owned(),
            findings,
            driven: Some(Driven {
                armed_at_s: None,
                safety_stop: None,
                outcome: "running".to_owned(),
                reason: Some("roll".to_owned()),
            }),
            simulated_s: 30.0,
            cost: Some(Cost { wall_s: 0.5, physics_step_us: None, lateness_max_ms: None }),
            log_sha256: "ab".to_owned(),
            frames: 3,
            bus_load: Some(0.25),
        }
    }

    #[test]
    fn one_failure_fails_the_run_and_so_does_no_finding() {
        let good = Finding::of("near", 1.0, Bound::AtMost(2.0), "m");
        let bad = Finding::missing("far", Bound::AtMost(2.0), "m", "no fix");
        assert!(report(vec![good.clone()]).passed());
        assert!(!report(vec![good, bad]).passed());
        assert!(!report(vec![]).passed());
    }

    #[test]
    fn the_table_is_aligned_and_the_json_complete() {
        let near = Finding::of("near", 1.0, Bound::AtMost(2.0), "m").noting("here");
        let far = Finding::missing("far away", Bound::Between(1.0, 12.5), "deg", "no fix");
        let report = report(vec![near, far]);
        let table = report.table();
        let column = |line: usize, text: &str| table.lines().nth(line).unwrap().find(text);
        assert_eq!(column(0, "unit"), Some(table.lines().next().unwrap().len() - 4));
        assert_eq!(column(1, "here").map(|at| at - 2), column(2, "no fix"), "{table}"); // ≤ has 3 bytes
        assert!(table.contains("\ngateway: never armed, policy running: roll\n"), "{table}");
        let json = report.json();
        assert_eq!(json["gateway"]["reason"], "roll");
        assert_eq!(json["passed"], false);
        assert_eq!(json["real_time_factor"], 60.0);
        assert_eq!(json["expectations"][1]["wanted"]["to"], 12.5);
        assert_eq!(json["expectations"][1]["measured"], Value::Null);
    }
}
