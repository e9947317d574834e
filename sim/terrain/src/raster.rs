//! A height map as its file has it: its own spacing, its own origin, and samples without data.

pub(crate) mod ascii_grid;
pub(crate) mod geotiff;
pub(crate) mod png;

/// Most samples of a height map: 64 MiB of heights.
pub(crate) const SAMPLES_MAX: u64 = 1 << 24;
/// No compression we read packs more samples than this into a byte (LZW, the densest: 12 bits for
/// 4095 bytes). A file that claims more lies, and is refused before anything is allocated.
const SAMPLES_PER_BYTE_MAX: u64 = 4096;

/// Heights on a regular grid.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Raster {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// The south-western sample, m east and north in the file's own system.
    pub(crate) first_m: [f64; 2],
    /// From sample to sample along x and y, m, above zero.
    pub(crate) spacing_m: [f64; 2],
    /// Row by row from south to north; NaN where the file has no data.
    pub(crate) height_m: Vec<f32>,
}

/// Refuses a size that we will not hold, or that `bytes` of a file cannot.
pub(crate) fn check_size(columns: u64, rows: u64, bytes: usize) -> Result<[usize; 2], String> {
    let samples = columns.saturating_mul(rows);
    if columns < 2 || rows < 2 {
        return Err(format!("{columns} by {rows} samples are no map; two by two are the least"));
    }
    if samples > SAMPLES_MAX {
        return Err(format!(
            "{columns} by {rows} samples are more than {SAMPLES_MAX}; cut the map to the area driven on"
        ));
    }
    if samples > SAMPLES_PER_BYTE_MAX.saturating_mul(bytes as u64) {
        return Err(format!(
            "its header claims {columns} by {rows} samples, which its {bytes} bytes cannot hold; is it cut short?"
        ));
    }
    let size = |count| usize::try_from(count).map_err(|_| "too large for this machine".to_owned());
    Ok([size(columns)?, size(rows)?])
}

impl Raster {
    /// From rows as files have them, from north to south.
    pub(crate) fn from_north(
        [columns, rows]: [usize; 2],
        first_m: [f64; 2],
        spacing_m: [f64; 2],
        mut height_m: Vec<f32>,
    ) -> Result<Self, String> {
        if height_m.len() != columns * rows {
            let found = height_m.len();
            return Err(format!("{found} heights where {columns} by {rows} are promised"));
        }
        let sane = |m: f64| m.is_finite() && m.abs() < 1e9;
        if !first_m.into_iter().all(sane) {
            return Err(format!("its corner {first_m:?} is no place"));
        }
        if !spacing_m.into_iter().all(|m| sane(m) && m >= 1e-3) {
            return Err(format!("its spacing {spacing_m:?} m is none; at least 1 mm"));
        }
        for row in 0..rows / 2 {
            let (south, north) = height_m.split_at_mut((rows - 1 - row) * columns);
            south[row * columns..][..columns].swap_with_slice(&mut north[..columns]);
        }
        Ok(Self { columns, rows, first_m, spacing_m, height_m })
    }

    /// Where its samples begin and end along x and along y, m.
    #[allow(clippy::cast_precision_loss)]
    pub(crate) fn covers_m(&self) -> [[f64; 2]; 2] {
        let count = [self.columns, self.rows];
        std::array::from_fn(|axis| {
            let from = self.first_m[axis];
            [from, from + (count[axis] - 1) as f64 * self.spacing_m[axis]]
        })
    }

    /// Height by bilinear interpolation, m; beyond the samples that of the nearest edge. NaN where a
    /// sample that would count has no data.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
    pub(crate) fn height_m(&self, x_m: f64, y_m: f64) -> f64 {
        let place = |m: f64, axis: usize, count: usize| {
            let at = (m - self.first_m[axis]) / self.spacing_m[axis];
            let at = at.max(0.0).min((count - 1) as f64);
            let index = (at as usize).min(count - 2);
            (index, at - index as f64)
        };
        let (column, u) = place(x_m, 0, self.columns);
        let (row, v) = place(y_m, 1, self.rows);
        let sample = |over: usize, up: usize, weight: f64| {
            let height = f64::from(self.height_m[(row + up) * self.columns + column + over]);
            // A hole beside a sample that is hit exactly is none.
            if weight == 0.0 { 0.0 } else { weight * height }
        };
        sample(0, 0, (1.0 - u) * (1.0 - v))
            + sample(1, 0, u * (1.0 - v))
            + sample(0, 1, (1.0 - u) * v)
            + sample(1, 1, u * v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map() -> Raster {
        // From north: 5 6 7 over 1 2 NaN.
        let heights = vec![5.0, 6.0, 7.0, 1.0, 2.0, f32::NAN];
        Raster::from_north([3, 2], [100.0, 200.0], [2.0, 4.0], heights).unwrap()
    }

    #[test]
    fn heights_between_samples_are_bilinear_and_beyond_them_those_of_the_edge() {
        let map = map();
        assert_eq!(map.covers_m(), [[100.0, 104.0], [200.0, 204.0]]);
        for (x, y, height) in [
            (100.0, 200.0, 1.0),
            (101.0, 200.0, 1.5),
            (100.0, 201.0, 2.0),
            (101.0, 202.0, 3.5),
            (104.0, 204.0, 7.0),
            (-1e9, 1e9, 5.0),
            (102.0, 200.0, 2.0),
        ] {
            assert_eq!(map.height_m(x, y), height, "{x} {y}");
        }
        assert!(map.height_m(102.1, 200.0).is_nan());
        assert!(map.height_m(104.0, 203.9).is_nan());
    }

    #[test]
    fn sizes_are_bounded_before_anything_is_allocated() {
        assert_eq!(check_size(4096, 4096, 1 << 20), Ok([4096, 4096]));
        assert!(check_size(4097, 4096, 1 << 20).unwrap_err().contains("cut the map"));
        assert!(check_size(u64::MAX, u64::MAX, 1 << 20).is_err());
        assert!(check_size(1000, 1000, 100).unwrap_err().contains("cut short"));
        assert!(check_size(1, 5, 100).is_err());
    }
}
