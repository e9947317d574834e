//! Logs in forms that nothing here reads: packed by other programs than gzip, or written by other loggers.

use std::path::Path;

use crate::GapError;

/// Programs by the bytes that their files begin with, as each one's format has it; no candump line begins so.
const PACKERS: [(&str, &[u8]); 5] = [
    ("bzip2", b"BZh"),
    ("xz", &[0xFD, b'7', b'z', b'X', b'Z', 0]),
    ("zstd", &[0x28, 0xB5, 0x2F, 0xFD]),
    ("zip", &[b'P', b'K', 3, 4]),
    ("7-Zip", &[b'7', b'z', 0xBC, 0xAF, 0x27, 0x1C]),
];

/// Logs of other loggers by the bytes that they begin with, each with the ending by which python-can knows it.
const LOGGERS: [(&str, &str, &[u8]); 5] = [
    ("a Vector BLF log", ".blf", b"LOGG"),
    ("an MF4 log (ASAM MDF)", ".mf4", b"MDF     "),
    ("a Vector ASC log", ".asc", b"date "),
    ("a PEAK TRC log", ".trc", b";$FILEVERSION"),
    ("a CSV log of python-can", ".csv", b"timestamp,arbitration_id"),
];

/// Refuses the file at `path` where it begins with `head` and is in one of those forms.
pub(super) fn ensure_readable(path: &Path, head: &[u8]) -> Result<(), GapError> {
    let problem = if let Some((packer, _)) =
        PACKERS.iter().find(|(_, magic)| head.starts_with(magic))
    {
        format!("packed by {packer}; unpack it first, or pack it with gzip, which is read as it is")
    } else if let Some((form, ending, _)) =
        LOGGERS.iter().find(|(.., magic)| head.starts_with(magic))
    {
        let file = path.display();
        format!(
            "{form}, and candump or MCAP is read; turn it into one with `python -m can.logconvert {file} \
             run.log` (of python-can, which knows the form by the ending {ending})"
        )
    } else {
        return Ok(());
    };
    Err(GapError::OtherForm { path: path.to_owned(), problem })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(head: &[u8]) -> Option<String> {
        ensure_readable(Path::new("a.log"), head).err().map(|error| error.to_string())
    }

    #[test]
    fn a_log_in_another_form_is_known_by_its_first_bytes() {
        let known: [(&[u8], &str); 7] = [
            (b"BZh91AY&SY", "packed by bzip2"),
            (&[0x28, 0xB5, 0x2F, 0xFD, 0], "packed by zstd"),
            (b"LOGG\x90\0\0\0", "a Vector BLF log"),
            (b"MDF     4.10    ", "an MF4 log (ASAM MDF)"),
            (b"date Sun Nov 29 12:59:17.850 2026\n", "a Vector ASC log"),
            (b";$FILEVERSION=2.1\r\n", "a PEAK TRC log"),
            (b"timestamp,arbitration_id,extended,remote", "a CSV log of python-can"),
        ];
        for (head, form) in known {
            let said = said(head).unwrap();
            assert!(said.starts_with(&format!("a.log: {form}")), "{said}");
        }
        let readable: [&[u8]; 4] = [&[0x1F, 0x8B, 8], b"(0.000000) can0 202B#00", b"date", b""];
        assert_eq!(readable.map(said), [None, None, None, None]);
    }
}
