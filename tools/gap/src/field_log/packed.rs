//! Logs packed by other programs than gzip, which nothing here unpacks.

/// Programs by the bytes that their files begin with, as each one's format has it; no candump line begins so.
const PACKERS: [(&str, &[u8]); 5] = [
    ("bzip2", b"BZh"),
    ("xz", &[0xFD, b'7', b'z', b'X', b'Z', 0]),
    ("zstd", &[0x28, 0xB5, 0x2F, 0xFD]),
    ("zip", &[b'P', b'K', 3, 4]),
    ("7-Zip", &[b'7', b'z', 0xBC, 0xAF, 0x27, 0x1C]),
];

/// What packed a file that begins with `head`; none where nothing did, or gzip.
pub(super) fn packer(head: &[u8]) -> Option<&'static str> {
    PACKERS.iter().find(|(_, magic)| head.starts_with(magic)).map(|(name, _)| *name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_packed_log_is_known_by_its_first_bytes() {
        assert_eq!(packer(b"BZh91AY&SY"), Some("bzip2"));
        assert_eq!(packer(&[0x28, 0xB5, 0x2F, 0xFD, 0]), Some("zstd"));
        assert_eq!(packer(&[0x1F, 0x8B, 8]), None);
        assert_eq!(packer(b"(0.000000) can0 202B#00"), None);
        assert_eq!(packer(b""), None);
    }
}
