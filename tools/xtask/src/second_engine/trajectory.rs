//! A trajectory as both sides write it (CSV), and how far two of them are apart.

use crate::workspace::Outcome;

/// Rows over time, a column each signal.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Trajectory {
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
}

/// How far two trajectories are apart.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(crate) struct Distance {
    /// Largest, over all rows.
    pub(crate) max: f64,
    /// Root of the mean square over rows.
    pub(crate) rmse: f64,
}

/// A kind of signal: the columns that are one, and the unit it is told in.
pub(crate) struct Kind {
    /// Name with unit.
    pub(crate) name: &'static str,
    /// Columns that begin so are of the kind.
    prefixes: &'static [&'static str],
    /// From the column's SI unit to the told one.
    scale: f64,
    /// The columns are the coordinates of one point, not signals side by side.
    vector: bool,
}

const DEGREE: f64 = 180.0 / std::f64::consts::PI;

/// What is compared.
pub(crate) const KINDS: [Kind; 7] = [
    Kind { name: "position, m", prefixes: &["x_m", "y_m", "z_m"], scale: 1.0, vector: true },
    Kind { name: "heading, deg", prefixes: &["yaw_"], scale: DEGREE, vector: false },
    Kind { name: "roll, pitch, deg", prefixes: &["roll_", "pitch_"], scale: DEGREE, vector: false },
    Kind { name: "joints, deg", prefixes: &["joint_"], scale: DEGREE, vector: false },
    Kind { name: "strokes, mm", prefixes: &["stroke_"], scale: 1000.0, vector: false },
    // At the rim of a wheel of 0.74 m.
    Kind { name: "wheel speed, m/s", prefixes: &["wheel_speed_"], scale: 0.74, vector: false },
    Kind { name: "ground force, kN", prefixes: &["ground_force_"], scale: 1e-3, vector: false },
];

impl Trajectory {
    /// Reads what a side wrote.
    ///
    /// # Errors
    /// For a line that is not as many numbers as the first has names.
    pub(crate) fn parse(text: &str) -> Outcome<Self> {
        let mut lines = text.lines();
        let columns: Vec<String> =
            lines.next().ok_or("an empty trajectory")?.split(',').map(str::to_owned).collect();
        let mut rows = Vec::new();
        for (line, number) in lines.zip(2..) {
            let row: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
            match row {
                Ok(row) if row.len() == columns.len() => rows.push(row),
                _ => return Err(format!("line {number} of a trajectory: `{line}`").into()),
            }
        }
        Ok(Self { columns, rows })
    }

    /// Distance in one kind of signal: the worst of its columns, or the length of its vector.
    ///
    /// # Errors
    /// When the two have other columns or other times.
    pub(crate) fn distance(&self, other: &Self, kind: &Kind) -> Outcome<Distance> {
        let times = |t: &Self| t.rows.iter().map(|row| row[0]).collect::<Vec<_>>();
        let apart = times(self).iter().zip(times(other)).any(|(a, b)| (a - b).abs() > 1e-6);
        if self.columns != other.columns || self.rows.len() != other.rows.len() || apart {
            return Err("the two sides wrote different columns or times".into());
        }
        let of_kind = |name: &str| kind.prefixes.iter().any(|prefix| name.starts_with(prefix));
        let columns: Vec<usize> =
            (0..self.columns.len()).filter(|&c| of_kind(&self.columns[c])).collect();
        let squares = |columns: &[usize]| -> Vec<f64> {
            let rows = self.rows.iter().zip(&other.rows);
            rows.map(|(a, b)| columns.iter().map(|&c| (a[c] - b[c]).powi(2)).sum()).collect()
        };
        let groups: Vec<&[usize]> =
            if kind.vector { vec![&columns] } else { columns.chunks(1).collect() };
        let mut worst = Distance::default();
        for group in groups {
            let squares = squares(group);
            let max = squares.iter().copied().fold(0.0, f64::max).sqrt() * kind.scale;
            let mean = squares.iter().sum::<f64>() / squares.len().max(1) as f64;
            worst.max = worst.max.max(max);
            worst.rmse = worst.rmse.max(mean.sqrt() * kind.scale);
        }
        Ok(worst)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kind(name: &str) -> &'static Kind {
        KINDS.iter().find(|kind| kind.name.starts_with(name)).unwrap()
    }

    #[test]
    fn a_vector_is_measured_by_its_length_and_signals_by_their_worst() {
        let a = Trajectory::parse(
            "t_s,x_m,y_m,z_m,stroke_FR_m,stroke_FL_m\n0,0,0,0,0,0\n1,3,4,0,0,0.002\n",
        );
        let b = Trajectory::parse(
            "t_s,x_m,y_m,z_m,stroke_FR_m,stroke_FL_m\n0,0,0,0,0,0\n1,0,0,0,0.001,0\n",
        );
        let (a, b) = (a.unwrap(), b.unwrap());
        let position = a.distance(&b, kind("position")).unwrap();
        assert_eq!(position, Distance { max: 5.0, rmse: 12.5_f64.sqrt() });
        let strokes = a.distance(&b, kind("strokes")).unwrap();
        assert!((strokes.max - 2.0).abs() < 1e-12 && (strokes.rmse - 2.0_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn other_times_or_a_torn_line_are_refused() {
        let a = Trajectory::parse("t_s,x_m\n0,0\n").unwrap();
        let b = Trajectory::parse("t_s,x_m\n0.05,0\n").unwrap();
        assert!(a.distance(&b, kind("position")).is_err());
        let torn = Trajectory::parse("t_s,x_m\n0,0\n0.05\n").unwrap_err().to_string();
        assert!(torn.starts_with("line 3"), "{torn}");
    }
}
