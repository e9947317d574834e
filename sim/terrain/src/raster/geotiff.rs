//! GeoTIFF: one band of heights, placed by its tags (OGC 19-008r4), in metres.

mod units;

use std::io::Cursor;

use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

use super::{Raster, SAMPLES_MAX, check_size};

/// A geo key, and a value of it.
const RASTER_TYPE: u16 = 1025;
const RASTER_POINT: u16 = 2;
/// Photometric interpretation of samples that count down from white (TIFF 6.0, page 37).
const WHITE_IS_ZERO: u32 = 0;
/// GDAL's own tag for what no other tag holds, in XML.
const GDAL_METADATA: u16 = 42112;

type Tiff<'a> = Decoder<Cursor<&'a [u8]>>;

/// Reads the first image of a file.
///
/// # Errors
/// What is wrong, and what would be right.
pub(crate) fn read(bytes: &[u8]) -> Result<Raster, String> {
    let say = |error: TiffError| {
        format!(
            "no TIFF that can be read: {error}; `gdal_translate -co COMPRESS=DEFLATE` makes one of most files"
        )
    };
    let mut limits = Limits::default();
    // As many samples as we take, in the widest type there is.
    limits.decoding_buffer_size = usize::try_from(8 * SAMPLES_MAX).unwrap_or(usize::MAX);
    limits.intermediate_buffer_size = limits.decoding_buffer_size;
    let mut tiff = Decoder::new(Cursor::new(bytes)).map_err(say)?.with_limits(limits);
    let (width, height) = tiff.dimensions().map_err(say)?;
    let size = check_size(u64::from(width), u64::from(height), bytes.len())?;
    let colour = tiff.colortype().map_err(say)?;
    if !matches!(colour, ColorType::Gray(_)) {
        return Err(format!(
            "{colour:?} where one band of heights is wanted; `gdal_translate -b 1`"
        ));
    }
    if tiff.get_tag_u32(Tag::PhotometricInterpretation).is_ok_and(|means| means == WHITE_IS_ZERO) {
        return Err("its samples count down from white, and heights do not; \
            `gdal_translate -co PHOTOMETRIC=MINISBLACK`"
            .to_owned());
    }
    let keys = geo_keys(&mut tiff).map_err(say)?;
    units::check(&keys)?;
    let metadata = text(&mut tiff, Tag::Unknown(GDAL_METADATA)).unwrap_or_default();
    if metadata.contains("role=\"scale\"") || metadata.contains("role=\"offset\"") {
        return Err(
            "its heights are scaled or shifted numbers; `gdal_translate -unscale`".to_owned()
        );
    }
    let nodata = match text(&mut tiff, Tag::GdalNodata) {
        Some(text) => Some(nodata(&text)?),
        None => None,
    };
    let place = Place::of(&mut tiff)?;
    let half = if keys.contains(&(RASTER_TYPE, RASTER_POINT)) { 0.0 } else { 0.5 };
    let first_m = [
        place.corner[0] + half * place.step[0],
        place.corner[1] - (f64::from(height) - 1.0 + half) * place.step[1],
    ];
    let height_m = samples(tiff.read_image().map_err(say)?, nodata)?;
    Raster::from_north(size, first_m, place.step, height_m)
}

/// Where the grid of samples lies.
struct Place {
    /// The outer corner in the north-west, or the first sample where samples are points; m.
    corner: [f64; 2],
    /// From sample to sample east and south, m.
    step: [f64; 2],
}

impl Place {
    fn of(tiff: &mut Tiff<'_>) -> Result<Self, String> {
        let mut numbers = |tag| tiff.get_tag_f64_vec(tag).unwrap_or_default();
        if let [sx, sy, ..] = numbers(Tag::ModelPixelScaleTag)[..]
            && let [column, row, _, x, y, ..] = numbers(Tag::ModelTiepointTag)[..]
        {
            return Ok(Self { corner: [x - column * sx, y + row * sy], step: [sx, sy] });
        }
        match numbers(Tag::ModelTransformationTag)[..] {
            [a, b, _, x, d, e, _, y, ..] if b == 0.0 && d == 0.0 => {
                Ok(Self { corner: [x, y], step: [a, -e] })
            }
            [_, _, _, _, _, _, _, _, ..] => {
                Err("its grid is turned against north; `gdalwarp` makes it upright".to_owned())
            }
            _ => Err("no tags say where it lies (ModelPixelScale and ModelTiepoint); \
                is it a GeoTIFF? `gdal_translate -a_ullr` places a plain one"
                .to_owned()),
        }
    }
}

/// The keys with a short value of their own (OGC 19-008r4, 7.1.2): key, value.
fn geo_keys(tiff: &mut Tiff<'_>) -> Result<Vec<(u16, u16)>, TiffError> {
    let Some(directory) = tiff.find_tag(Tag::GeoKeyDirectoryTag)? else {
        return Ok(Vec::new());
    };
    let directory = directory.into_u16_vec()?;
    let entries = directory.chunks_exact(4).skip(1);
    Ok(entries.filter(|entry| entry[1] == 0).map(|entry| (entry[0], entry[3])).collect())
}

fn text(tiff: &mut Tiff<'_>, tag: Tag) -> Option<String> {
    tiff.get_tag_ascii_string(tag).ok()
}

fn nodata(text: &str) -> Result<f64, String> {
    let text = text.trim_matches(['\0', ' ']);
    text.parse().map_err(|_| {
        let shown = text.escape_debug();
        format!("its no-data value `{shown}` is no number; `gdal_edit.py -a_nodata -9999`")
    })
}

/// Heights from samples of any type; NaN for the no-data value, as that type holds it.
#[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss)]
fn samples(image: DecodingResult, nodata: Option<f64>) -> Result<Vec<f32>, String> {
    let exact = |height: f64| {
        if nodata == Some(height) || !height.is_finite() { f32::NAN } else { height as f32 }
    };
    // GDAL writes the no-data value of 32 bits in more digits than they hold.
    let single = nodata.map(|value| value as f32);
    Ok(match image {
        DecodingResult::U8(heights) => heights.into_iter().map(|h| exact(h.into())).collect(),
        DecodingResult::I8(heights) => heights.into_iter().map(|h| exact(h.into())).collect(),
        DecodingResult::U16(heights) => heights.into_iter().map(|h| exact(h.into())).collect(),
        DecodingResult::I16(heights) => heights.into_iter().map(|h| exact(h.into())).collect(),
        DecodingResult::U32(heights) => heights.into_iter().map(|h| exact(h.into())).collect(),
        DecodingResult::I32(heights) => heights.into_iter().map(|h| exact(h.into())).collect(),
        DecodingResult::F64(heights) => heights.into_iter().map(exact).collect(),
        DecodingResult::F32(heights) => heights
            .into_iter()
            .map(|h| if single == Some(h) || !h.is_finite() { f32::NAN } else { h })
            .collect(),
        _ => {
            return Err(
                "samples of 64-bit integers or 16-bit floats; `gdal_translate -ot Float32`"
                    .to_owned(),
            );
        }
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use tiff::encoder::colortype::{self, Gray32Float};
    use tiff::encoder::{TiffEncoder, TiffValue};

    use super::*;

    /// A file of 3 by 2 samples of 0.5 m, its outer corner at 1000 m east, 2000 m north.
    fn write<C: colortype::ColorType>(
        data: &[C::Inner],
        keys: &[u16],
        nodata: Option<&str>,
    ) -> Vec<u8>
    where
        [C::Inner]: TiffValue,
    {
        let mut bytes = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
        let mut image = encoder.new_image::<C>(3, 2).unwrap();
        let tags = image.encoder();
        tags.write_tag(Tag::ModelPixelScaleTag, &[0.5, 0.5, 0.0][..]).unwrap();
        let tie = [0.0, 0.0, 0.0, 1000.0, 2000.0, 0.0];
        tags.write_tag(Tag::ModelTiepointTag, &tie[..]).unwrap();
        let directory: Vec<u16> =
            [1, 1, 0, keys.len() as u16 / 4].iter().chain(keys).copied().collect();
        tags.write_tag(Tag::GeoKeyDirectoryTag, &directory[..]).unwrap();
        if let Some(nodata) = nodata {
            tags.write_tag(Tag::GdalNodata, nodata).unwrap();
        }
        image.write_data(data).unwrap();
        bytes.into_inner()
    }

    fn floats(keys: &[u16], nodata: Option<&str>) -> Vec<u8> {
        write::<Gray32Float>(&[5.0, 6.0, 7.0, 1.0, 2.0, -9999.0], keys, nodata)
    }

    #[test]
    fn samples_are_areas_unless_they_are_said_to_be_points() {
        let raster = read(&floats(&[], Some("-9999"))).unwrap();
        assert_eq!(raster.covers_m(), [[1000.25, 1001.25], [1999.25, 1999.75]]);
        assert_eq!(raster.height_m[..2], [1.0, 2.0]);
        assert!(raster.height_m[2].is_nan());
        assert_eq!(raster.height_m[3..], [5.0, 6.0, 7.0]);
        let points = read(&floats(&[RASTER_TYPE, 0, 1, RASTER_POINT], None)).unwrap();
        assert_eq!(points.covers_m(), [[1000.0, 1001.0], [1999.5, 2000.0]]);
        assert_eq!(points.height_m[2], -9999.0);
    }

    #[test]
    fn integers_of_either_sign_are_heights_too() {
        let heights = write::<colortype::GrayI16>(&[-5, 6, 7, 1, 2, -32768], &[], Some("-32768"));
        let raster = read(&heights).unwrap();
        assert_eq!(raster.height_m[3..], [-5.0, 6.0, 7.0]);
        assert!(raster.height_m[2].is_nan());
        let bytes = read(&write::<colortype::Gray8>(&[5, 6, 7, 1, 2, 255], &[], None)).unwrap();
        assert_eq!(bytes.height_m, [1.0, 2.0, 255.0, 5.0, 6.0, 7.0]);
    }

    #[test]
    fn samples_that_count_down_from_white_are_refused() {
        let mut bytes = write::<colortype::Gray8>(&[5, 6, 7, 1, 2, 255], &[], None);
        // Tag 262, one short, and its value.
        let photometric = [0x06, 0x01, 3, 0, 1, 0, 0, 0, 1];
        let at = bytes.windows(9).position(|window| window == photometric).unwrap();
        bytes[at + 8] = 0;
        let error = read(&bytes).unwrap_err();
        assert!(error.contains("PHOTOMETRIC=MINISBLACK"), "{error}");
    }

    #[test]
    fn scaled_numbers_are_not_taken_for_heights() {
        let mut bytes = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
        let mut image = encoder.new_image::<Gray32Float>(3, 2).unwrap();
        let xml = "<GDALMetadata><Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.01</Item></GDALMetadata>";
        image.encoder().write_tag(Tag::Unknown(GDAL_METADATA), xml).unwrap();
        image.write_data(&[0.0; 6]).unwrap();
        let error = read(bytes.get_ref()).unwrap_err();
        assert!(error.contains("-unscale"), "{error}");
    }

    #[test]
    fn what_is_not_in_metres_or_not_placed_is_refused_with_the_remedy() {
        let cases = [
            (floats(&[1024, 0, 1, 2], None), "in degrees", "gdalwarp"),
            (floats(&[3076, 0, 1, 9003], None), "plan are in EPSG unit 9003", "gdalwarp"),
            (floats(&[4099, 0, 1, 9002], None), "heights are in", "gdalwarp"),
            (floats(&[3072, 0, 1, 2272], None), "in EPSG system 2272", "gdal_translate"),
            (floats(&[], Some("none")), "no-data value `none`", "-a_nodata"),
            (floats(&[], Some("\n9")), "no-data value `\\n9`", "-a_nodata"),
            (write::<colortype::RGB8>(&[0; 18], &[], None), "RGB(8)", "-b 1"),
            (write::<colortype::Gray64>(&[0; 6], &[], None), "64-bit", "-ot Float32"),
            (b"II*\0".to_vec(), "no TIFF that can be read", "gdal_translate"),
        ];
        for (bytes, says, remedy) in cases {
            let error = read(&bytes).unwrap_err();
            assert!(error.contains(says) && error.contains(remedy), "{error}");
        }
        let mut plain = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut plain).unwrap();
        encoder.write_image::<Gray32Float>(3, 2, &[0.0; 6]).unwrap();
        assert!(read(plain.get_ref()).unwrap_err().contains("is it a GeoTIFF?"));
    }

    proptest! {
        #[test]
        fn heights_survive_being_written(heights in prop::collection::vec(-1e4..1e4_f32, 6)) {
            let raster = read(&write::<Gray32Float>(&heights, &[], None)).unwrap();
            prop_assert_eq!(&raster.height_m[..3], &heights[3..]);
            prop_assert_eq!(&raster.height_m[3..], &heights[..3]);
        }

        #[test]
        fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            let _ = read(&bytes);
            let _ = read(&[b"II*\0\x08\0\0\0", bytes.as_slice()].concat());
        }

        #[test]
        fn no_slip_in_a_good_file_panics(
            slips in prop::collection::vec((0..400_usize, any::<u8>()), 1..4), cut in 0..400_usize,
        ) {
            let mut bytes = floats(&[RASTER_TYPE, 0, 1, 1], Some("-9999"));
            let length = bytes.len();
            for (at, byte) in slips {
                bytes[at % length] = byte;
            }
            let _ = read(&bytes);
            let _ = read(&bytes[..cut % length]);
        }
    }
}
