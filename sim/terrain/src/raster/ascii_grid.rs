//! ESRI ASCII grid: a header of keys and numbers, then heights from the north-west corner on.

use super::{Raster, SAMPLES_MAX, check_size};

/// The numbers of a header; `None` until they are met.
#[derive(Debug, Default)]
struct Header {
    columns: Option<f64>,
    rows: Option<f64>,
    x: Option<f64>,
    y: Option<f64>,
    /// Whether `x` and `y` are each the middle of the first cell rather than its corner.
    centre: [bool; 2],
    dx: Option<f64>,
    dy: Option<f64>,
    nodata: Option<f64>,
}

impl Header {
    /// Takes a key.
    ///
    /// # Errors
    /// It is none, or it was there before: what is wrong, and what would be right.
    fn take(&mut self, key: &str, value: f64) -> Result<(), String> {
        let twice =
            |before: f64| Err(format!("{key} {value}, which was {before}; keep one of the two"));
        let place = match key.to_ascii_lowercase().as_str() {
            "ncols" => &mut self.columns,
            "nrows" => &mut self.rows,
            key @ ("xllcorner" | "xllcenter" | "xllcentre") => {
                self.centre[0] = key != "xllcorner";
                &mut self.x
            }
            key @ ("yllcorner" | "yllcenter" | "yllcentre") => {
                self.centre[1] = key != "yllcorner";
                &mut self.y
            }
            "cellsize" => {
                if let Some(before) = self.dy.replace(value) {
                    return twice(before);
                }
                &mut self.dx
            }
            "dx" => &mut self.dx,
            "dy" => &mut self.dy,
            "nodata_value" => &mut self.nodata,
            _ => {
                return Err(format!(
                    "unknown key {key}; a header has ncols, nrows, xllcorner, yllcorner, cellsize, nodata_value"
                ));
            }
        };
        place.replace(value).map_or(Ok(()), twice)
    }
}

/// What is no height where a header does not say (Esri ASCII raster format).
const NODATA: f64 = -9999.0;

/// Reads a grid.
///
/// # Errors
/// What is wrong, with its line, and what would be right.
pub(crate) fn read(bytes: &[u8]) -> Result<Raster, String> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        format!("byte {} is no text; an ASCII grid is plain text", error.valid_up_to())
    })?;
    // Some editors mark a text as UTF-8 with a character that is none of it.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut header = Header::default();
    let mut lines = text.lines().zip(1_usize..).peekable();
    while let Some((line, number)) = lines.peek() {
        let mut words = line.split_ascii_whitespace();
        let Some(key) = words.next() else {
            lines.next();
            continue;
        };
        if !key.starts_with(|c: char| c.is_ascii_alphabetic()) || key.parse::<f64>().is_ok() {
            break;
        }
        let value = words.next().and_then(|word| word.parse().ok());
        let Some(value) = value else {
            return Err(format!("line {number}: {key} without a number; write `{key} 1.5`"));
        };
        if let Some(more) = words.next() {
            return Err(format!("line {number}: {key} has one number; `{more}` is one too many"));
        }
        header.take(key, value).map_err(|problem| format!("line {number}: {problem}"))?;
        lines.next();
    }
    heights(&header, lines, bytes.len())
}

fn heights<'a>(
    header: &Header,
    lines: impl Iterator<Item = (&'a str, usize)>,
    bytes: usize,
) -> Result<Raster, String> {
    let need = |value: Option<f64>, key: &str| {
        value.ok_or_else(|| format!("the header has no {key}; add a line `{key} NUMBER`"))
    };
    let columns = count(need(header.columns, "ncols")?, "ncols")?;
    let rows = count(need(header.rows, "nrows")?, "nrows")?;
    let size = check_size(columns, rows, bytes)?;
    let spacing_m = [need(header.dx, "cellsize")?, need(header.dy, "cellsize")?];
    let shift = header.centre.map(|centre| if centre { 0.0 } else { 0.5 });
    let first_m = [
        need(header.x, "xllcorner")? + shift[0] * spacing_m[0],
        need(header.y, "yllcorner")? + shift[1] * spacing_m[1],
    ];
    let promised = size[0] * size[1];
    let mut height_m = Vec::new();
    let mut last = 0;
    for (line, number) in lines {
        last = number;
        for word in line.split_ascii_whitespace() {
            let height: f64 = word.parse().map_err(|_| {
                format!("line {number}: `{word}` is no height; numbers have a decimal point")
            })?;
            if height_m.len() == promised {
                return Err(format!("line {number}: more than the {promised} heights promised"));
            }
            height_m.push(sample(height, Some(header.nodata.unwrap_or(NODATA))));
        }
    }
    if height_m.len() < promised {
        let found = height_m.len();
        return Err(format!("ends at line {last} after {found} of {promised} heights"));
    }
    Raster::from_north(size, first_m, spacing_m, height_m)
}

#[allow(clippy::cast_possible_truncation)]
fn sample(height: f64, nodata: Option<f64>) -> f32 {
    if nodata == Some(height) || !height.is_finite() { f32::NAN } else { height as f32 }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
fn count(number: f64, key: &str) -> Result<u64, String> {
    if number.fract() == 0.0 && (0.0..=SAMPLES_MAX as f64).contains(&number) {
        Ok(number as u64)
    } else {
        Err(format!("{key} {number} is no count up to {SAMPLES_MAX}"))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const SMALL: &str = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 2\n\
        NODATA_value -9999\n5 6 7\n1 2 -9999\n";

    #[test]
    fn rows_come_from_the_north_and_corners_are_half_a_cell_off() {
        let raster = read(SMALL.as_bytes()).unwrap();
        assert_eq!(raster.covers_m(), [[101.0, 105.0], [201.0, 203.0]]);
        assert_eq!(raster.height_m[..2], [1.0, 2.0]);
        assert!(raster.height_m[2].is_nan());
        assert_eq!(raster.height_m[3..], [5.0, 6.0, 7.0]);
        let centre = SMALL.replace("xllcorner", "XLLCENTER").replace("yllcorner", "yllcenter");
        assert_eq!(read(centre.as_bytes()).unwrap().first_m, [100.0, 200.0]);
        let silent = SMALL.replace("NODATA_value -9999\n", "");
        assert!(read(silent.as_bytes()).unwrap().height_m[2].is_nan(), "as the format has it");
        // Heights may be broken into lines at will.
        let broken = SMALL.replace("5 6 7\n1 2", "5\n6 7 1\n\n2");
        assert_eq!(read(broken.as_bytes()).unwrap().height_m[3..], [5.0, 6.0, 7.0]);
    }

    #[test]
    fn each_axis_says_for_itself_where_its_first_cell_is() {
        for (from, to, first_m) in
            [("xllcorner", "xllcenter", [100.0, 201.0]), ("yllcorner", "yllcentre", [101.0, 200.0])]
        {
            assert_eq!(read(SMALL.replace(from, to).as_bytes()).unwrap().first_m, first_m, "{to}");
        }
    }

    #[test]
    fn a_byte_order_mark_is_no_part_of_the_header() {
        let marked = format!("\u{feff}{SMALL}");
        let (marked, plain) = (read(marked.as_bytes()).unwrap(), read(SMALL.as_bytes()).unwrap());
        assert_eq!((marked.first_m, marked.height_m.len()), (plain.first_m, 6));
        assert_eq!(marked.height_m[3..], plain.height_m[3..]);
    }

    #[test]
    fn each_refusal_has_its_line_and_a_remedy() {
        let cases = [
            ("5 6 7", "5 6,5 7", "line 7: `6,5` is no height", "decimal point"),
            ("5 6 7", "5 6", "ends at line 8 after 5 of 6", ""),
            ("5 6 7", "5 6 7 8", "line 8: more than the 6", ""),
            ("ncols 3", "ncols three", "line 1: ncols without a number", "`ncols 1.5`"),
            ("ncols 3", "ncols 3 7", "line 1: ncols has one number; `7`", ""),
            ("nrows 2", "nrows 2\nncols 4", "line 3: ncols 4, which was 3", "keep one"),
            ("cellsize 2", "cellsize 2\ndy 3", "line 6: dy 3, which was 2", "keep one"),
            ("ncols 3\n", "", "the header has no ncols", "ncols NUMBER"),
            ("cellsize 2", "cellsize -2", "its spacing", "1 mm"),
            ("cellsize 2", "cellsise 2", "line 5: unknown key cellsise", "cellsize"),
            ("ncols 3", "ncols 1e7", "10000000 by 2 samples are more", "cut the map"),
            ("ncols 3", "ncols 3000000", "its header claims 3000000", "cut short"),
            ("ncols 3", "ncols 2.5", "ncols 2.5 is no count", ""),
            ("xllcorner 100", "xllcorner nan", "its corner", "no place"),
        ];
        for (from, to, starts, contains) in cases {
            let error = read(SMALL.replace(from, to).as_bytes()).unwrap_err();
            assert!(error.starts_with(starts) && error.contains(contains), "{error}");
        }
        assert!(read(b"\xff\xfe").unwrap_err().contains("byte 0"));
    }

    proptest! {
        #[test]
        fn a_grid_survives_being_written(
            heights in prop::collection::vec(-1e3..1e3_f32, 12), x in -1e6..1e6_f64,
        ) {
            let mut text = format!("ncols 4\nnrows 3\nxllcenter {x}\nyllcenter -7.5\ncellsize 0.25\n");
            for row in heights.chunks(4).rev() {
                text.extend(row.iter().map(|h| format!("{h} ")));
                text.push('\n');
            }
            let raster = read(text.as_bytes()).unwrap();
            prop_assert_eq!(raster.height_m, heights);
            prop_assert_eq!(raster.first_m, [x, -7.5]);
        }

        #[test]
        fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            let _ = read(&bytes);
        }

        #[test]
        fn no_slip_in_a_good_file_panics(at in 0..SMALL.len(), byte in any::<u8>()) {
            let mut bytes = SMALL.as_bytes().to_vec();
            bytes[at] = byte;
            if let Ok(raster) = read(&bytes) {
                prop_assert_eq!(raster.height_m.len(), raster.columns * raster.rows);
            }
        }
    }
}
