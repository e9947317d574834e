//! Grey PNG of 8 or 16 bits: black and white stand for two heights, pixels for a distance.

use std::io::Cursor;

use ::png::{BitDepth, ColorType, Decoder, Limits};

use super::{Raster, check_size};

/// What a picture does not say of itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale {
    /// From pixel to pixel, m.
    pub(crate) spacing_m: f64,
    /// Height of black, m.
    pub(crate) black_m: f64,
    /// Height of white, m.
    pub(crate) white_m: f64,
}

/// Reads a picture whose upper edge is north. Its lower left pixel is the origin.
///
/// # Errors
/// What is wrong, and what would be right.
pub(crate) fn read(bytes: &[u8], scale: Scale) -> Result<Raster, String> {
    let say = |error: ::png::DecodingError| format!("no PNG that can be read: {error}");
    let limits = Limits { bytes: 64 << 20 };
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), limits);
    let info = decoder.read_header_info().map_err(say)?;
    let size = check_size(u64::from(info.width), u64::from(info.height), bytes.len())?;
    let (colour, depth) = (info.color_type, info.bit_depth);
    if colour != ColorType::Grayscale || !matches!(depth, BitDepth::Eight | BitDepth::Sixteen) {
        return Err(format!(
            "{colour:?} of {} bits; convert it to grey of 8 or 16 bits",
            depth as u8
        ));
    }
    let mut reader = decoder.read_info().map_err(say)?;
    let length = reader.output_buffer_size().ok_or("its size overflows")?;
    let mut pixels = vec![0; length];
    reader.next_frame(&mut pixels).map_err(say)?;
    #[allow(clippy::cast_possible_truncation)]
    let height = |share: f64| (scale.black_m + (scale.white_m - scale.black_m) * share) as f32;
    let height_m = match depth {
        BitDepth::Sixteen => pixels
            .chunks_exact(2)
            .map(|pair| f64::from(u16::from_be_bytes([pair[0], pair[1]])) / f64::from(u16::MAX))
            .map(height)
            .collect(),
        _ => pixels.iter().map(|&grey| height(f64::from(grey) / f64::from(u8::MAX))).collect(),
    };
    Raster::from_north(size, [0.0; 2], [scale.spacing_m; 2], height_m)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const SCALE: Scale = Scale { spacing_m: 0.25, black_m: -1.0, white_m: 2.0 };

    fn write(width: u32, colour: ColorType, depth: BitDepth, pixels: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let rows = pixels.len() as u32 / width / (depth as u32 / 8) / colour.samples() as u32;
        let mut encoder = ::png::Encoder::new(&mut bytes, width, rows);
        encoder.set_color(colour);
        encoder.set_depth(depth);
        encoder.write_header().unwrap().write_image_data(pixels).unwrap();
        bytes
    }

    #[test]
    fn black_and_white_are_the_heights_they_are_said_to_be() {
        let bytes = write(2, ColorType::Grayscale, BitDepth::Eight, &[0, 255, 51, 102]);
        let raster = read(&bytes, SCALE).unwrap();
        // The picture's lower row comes first.
        for (found, height) in raster.height_m.iter().zip([-0.4, 0.2, -1.0, 2.0]) {
            assert!((found - height).abs() < 1e-6);
        }
        assert_eq!(raster.covers_m(), [[0.0, 0.25], [0.0, 0.25]]);
    }

    #[test]
    fn colour_and_lies_are_refused() {
        let colour = write(2, ColorType::Rgb, BitDepth::Eight, &[0; 12]);
        assert!(read(&colour, SCALE).unwrap_err().contains("convert it to grey"));
        let mut good = write(2, ColorType::Grayscale, BitDepth::Eight, &[0; 4]);
        assert!(read(&good[..40], SCALE).unwrap_err().starts_with("no PNG that can be read"));
        // A width of a million, with its checksum set right.
        good[16..20].copy_from_slice(&1_000_000_u32.to_be_bytes());
        let sum = crc32(&good[12..29]);
        good[29..33].copy_from_slice(&sum.to_be_bytes());
        let error = read(&good, SCALE).unwrap_err();
        assert!(error.contains("cut short"), "{error}");
    }

    /// The checksum of a PNG chunk (ISO 3309).
    fn crc32(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(u32::MAX, |sum, &byte| {
            (0..8).fold(sum ^ u32::from(byte), |sum, _| {
                (sum >> 1) ^ (0xedb8_8320 & 0_u32.wrapping_sub(sum & 1))
            })
        })
    }

    proptest! {
        #[test]
        fn a_picture_of_16_bits_survives_being_written(levels in prop::collection::vec(any::<u16>(), 12)) {
            let pixels: Vec<u8> = levels.iter().flat_map(|level| level.to_be_bytes()).collect();
            let raster =
                read(&write(4, ColorType::Grayscale, BitDepth::Sixteen, &pixels), SCALE).unwrap();
            let back = |h: &f32| ((f64::from(*h) + 1.0) / 3.0 * 65535.0).round() as u16;
            let found: Vec<u16> =
                raster.height_m.chunks(4).rev().flatten().map(back).collect();
            prop_assert_eq!(found, levels);
        }

        #[test]
        fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..100)) {
            let _ = read(&bytes, SCALE);
        }

        #[test]
        fn no_slip_in_a_good_file_panics(at in 0..60_usize, byte in any::<u8>(), cut in 0..60_usize) {
            let mut bytes = write(4, ColorType::Grayscale, BitDepth::Eight, &[7; 16]);
            let last = bytes.len() - 1;
            bytes[at.min(last)] = byte;
            let _ = read(&bytes, SCALE);
            let _ = read(&bytes[..cut.min(last)], SCALE);
        }
    }
}
