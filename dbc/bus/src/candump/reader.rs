//! Reads a log line by line, and says which line is wrong.

use std::io::{self, BufRead, Read};
use std::sync::Arc;

use super::Record;
use super::line::{BadLine, Line, parse};

/// Longer than any line: time 31, interface 16, CAN FD frame 140, direction.
const LINE_BYTES: u64 = 512;

/// Why a log could not be read on. Name and line are in the message.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// A line in the log is not candump's.
    #[error("{log}:{line}: {what}; {}", what.remedy())]
    Bad {
        /// The log's name.
        log: Arc<str>,
        /// Counted from 1.
        line: u64,
        /// What is wrong with it.
        what: BadLine,
    },
    /// The log ends in the middle of a line: it was cut, or is still being written.
    #[error(
        "{log}:{line}: log is cut in the middle of this line; remove the line or copy the log again"
    )]
    Cut {
        /// The log's name.
        log: Arc<str>,
        /// Counted from 1.
        line: u64,
    },
    /// The reader below failed.
    #[error("{log}:{line}: cannot read: {source}")]
    Io {
        /// The log's name.
        log: Arc<str>,
        /// The line being read, counted from 1.
        line: u64,
        /// What the reader below said.
        source: io::Error,
    },
}

/// Frames that a log holds and that are of no kind that is read, and those that it says it lacks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Skipped {
    /// Remote frames.
    pub remote: u64,
    /// Error frames of SocketCAN.
    pub error: u64,
    /// CAN FD frames.
    pub fd: u64,
    /// Frames that came faster than candump took them, as its option -d says.
    pub dropped: u64,
}

impl Skipped {
    /// All of them.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.remote + self.error + self.fd + self.dropped
    }
}

/// Reads the data frames of a log in order. An iterator that ends after its first error.
///
/// ```
/// use xt28_bus::candump::Reader;
///
/// let log = "(1.500000) can0 0CFF4027#55\n(1.510000) can0 0CFF40";
/// let mut reader = Reader::new(log.as_bytes(), "drive.log");
/// assert_eq!(reader.next().unwrap().unwrap().frame.data(), [0x55]);
/// assert_eq!(
///     reader.next().unwrap().unwrap_err().to_string(),
///     "drive.log:2: log is cut in the middle of this line; remove the line or copy the log again",
/// );
/// ```
#[derive(Debug)]
pub struct Reader<R> {
    input: R,
    log: Arc<str>,
    line: u64,
    bytes: Vec<u8>,
    interface: Arc<str>,
    skipped: Skipped,
    skipped_line: Option<u64>,
    dropped_line: Option<u64>,
    accepts_cut: bool,
    cut_line: Option<u64>,
    done: bool,
}

impl<R: BufRead> Reader<R> {
    /// Reads from `input`; `log` is its name in errors.
    pub fn new(input: R, log: &str) -> Self {
        Self {
            input,
            log: log.into(),
            line: 0,
            bytes: Vec::with_capacity(128),
            interface: "".into(),
            skipped: Skipped::default(),
            skipped_line: None,
            dropped_line: None,
            accepts_cut: false,
            cut_line: None,
            done: false,
        }
    }

    /// Takes a log that ends in the middle of a line as ending before it; [`Reader::cut_line`]
    /// then says where. For logs of a machine that was switched off.
    #[must_use]
    pub fn accepting_cut(mut self) -> Self {
        self.accepts_cut = true;
        self
    }

    /// The last line, if it was cut and left out.
    #[must_use]
    pub fn cut_line(&self) -> Option<u64> {
        self.cut_line
    }

    /// The line last read, counted from 1.
    #[must_use]
    pub fn line(&self) -> u64 {
        self.line
    }

    /// What was passed over so far.
    #[must_use]
    pub fn skipped(&self) -> Skipped {
        self.skipped
    }

    /// Line of the first frame that was passed over, counted from 1.
    #[must_use]
    pub fn skipped_line(&self) -> Option<u64> {
        self.skipped_line
    }

    /// The first line that says that frames were dropped, counted from 1.
    #[must_use]
    pub fn dropped_line(&self) -> Option<u64> {
        self.dropped_line
    }

    /// The next data frame, `None` at the end.
    ///
    /// # Errors
    /// See [`ReadError`]. After an error there is nothing more.
    pub fn read(&mut self) -> Result<Option<Record>, ReadError> {
        let record = self.read_on();
        self.done = !matches!(record, Ok(Some(_)));
        record
    }

    fn read_on(&mut self) -> Result<Option<Record>, ReadError> {
        while !self.done && self.read_line()? {
            // Some editors put it before a text that they have saved.
            if self.line == 1 && self.bytes.starts_with("\u{FEFF}".as_bytes()) {
                self.bytes.drain(..'\u{FEFF}'.len_utf8());
            }
            let line = parse(&self.bytes).map_err(|what| self.bad(what))?;
            match line {
                Line::Data { at, interface, frame, direction } => {
                    if *self.interface != *interface {
                        self.interface = interface.into();
                    }
                    let interface = Arc::clone(&self.interface);
                    return Ok(Some(Record { at, interface, frame, direction }));
                }
                Line::Remote => self.skipped.remote += 1,
                Line::Error => self.skipped.error += 1,
                Line::Fd => self.skipped.fd += 1,
                Line::Dropped(frames) => {
                    self.skipped.dropped = self.skipped.dropped.saturating_add(frames);
                    self.dropped_line.get_or_insert(self.line);
                    continue;
                }
                Line::Blank => continue,
            }
            self.skipped_line.get_or_insert(self.line);
        }
        Ok(None)
    }

    /// Reads one whole line, without its line feed; false at the end of the log.
    ///
    /// A line without line feed is a cut one even where it makes sense: the data may go on.
    fn read_line(&mut self) -> Result<bool, ReadError> {
        self.bytes.clear();
        self.line += 1;
        let read = self.input.by_ref().take(LINE_BYTES).read_until(b'\n', &mut self.bytes);
        let cut = match read {
            Ok(_) if self.bytes.pop_if(|last| *last == b'\n').is_some() => return Ok(true),
            Ok(0) => false,
            Ok(_) if self.bytes.len() as u64 == LINE_BYTES => {
                if !self.is_zeros_to_the_end()? {
                    return Err(self.bad(BadLine::TooLong));
                }
                true
            }
            Ok(_) => true,
            // How a decompressor says that its input was cut.
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => true,
            Err(source) => return Err(self.unreadable(source)),
        };
        if cut && !self.accepts_cut {
            return Err(ReadError::Cut { log: Arc::clone(&self.log), line: self.line });
        }
        self.cut_line = cut.then_some(self.line);
        self.line -= 1;
        Ok(false)
    }

    /// Whether nothing but zeros follows, as file systems leave behind a log whose machine lost power while it was
    /// written. Nothing is a log that begins with them.
    fn is_zeros_to_the_end(&mut self) -> Result<bool, ReadError> {
        if self.line == 1 || self.bytes.last() != Some(&0) {
            return Ok(false);
        }
        loop {
            let zeros = match self.input.fill_buf() {
                Ok(rest) if rest.iter().any(|byte| *byte != 0) => return Ok(false),
                Ok(rest) => rest.len(),
                Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => 0,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(source) => return Err(self.unreadable(source)),
            };
            if zeros == 0 {
                return Ok(true);
            }
            self.input.consume(zeros);
        }
    }

    fn unreadable(&self, source: io::Error) -> ReadError {
        ReadError::Io { log: Arc::clone(&self.log), line: self.line, source }
    }

    fn bad(&self, what: BadLine) -> ReadError {
        ReadError::Bad { log: Arc::clone(&self.log), line: self.line, what }
    }
}

impl<R: BufRead> Iterator for Reader<R> {
    type Item = Result<Record, ReadError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.read().transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOG: &str = "(1.500000) can0 123#55\n\n(1.600000) can0 123#R\n(1.7) can1 124#\n";

    #[test]
    fn reads_all_and_counts_what_it_passes_over() {
        let mut reader = Reader::new(LOG.as_bytes(), "a.log");
        let records: Vec<_> = reader.by_ref().map(Result::unwrap).collect();
        assert_eq!(records.len(), 2);
        assert_eq!((&*records[0].interface, &*records[1].interface), ("can0", "can1"));
        assert_eq!(reader.skipped(), Skipped { remote: 1, ..Skipped::default() });
        assert_eq!(reader.skipped_line(), Some(3));
        assert_eq!((reader.line(), reader.cut_line()), (4, None));
        assert!(reader.next().is_none());
    }

    #[test]
    fn of_what_it_passes_over_the_first_line_is_told() {
        let log =
            "(1.5) can0 123#55\n(1.6) can0 20000004#00\n(1.7) can0 123##1\n(1.8) can0 123#R\n";
        let mut reader = Reader::new(log.as_bytes(), "a.log");
        assert_eq!(reader.by_ref().count(), 1);
        assert_eq!(reader.skipped(), Skipped { remote: 1, error: 1, fd: 1, dropped: 0 });
        assert_eq!((reader.skipped().total(), reader.skipped_line()), (3, Some(2)));
    }

    #[test]
    fn what_candump_dropped_is_counted_and_read_on_from() {
        let drops = |frames: u64, total: u64| {
            format!(
                "DROPCOUNT: dropped {frames} CAN frames on 'can0' socket (total drops {total})\n"
            )
        };
        let frame = "(1.5) can0 123#\n";
        let log = [frame, &drops(3, 3), frame, &drops(2, 5), frame].concat();
        let mut reader = Reader::new(log.as_bytes(), "a.log");
        assert_eq!(reader.by_ref().filter_map(Result::ok).count(), 3);
        assert_eq!(reader.skipped(), Skipped { dropped: 5, ..Skipped::default() });
        assert_eq!((reader.skipped_line(), reader.dropped_line()), (None, Some(2)));
    }

    #[test]
    fn a_mark_before_the_first_line_is_no_part_of_it() {
        let log = format!("\u{FEFF}{LOG}");
        assert_eq!(Reader::new(log.as_bytes(), "a.log").filter(Result::is_ok).count(), 2);
        let late = format!("{LOG}\u{FEFF}{LOG}");
        let error = Reader::new(late.as_bytes(), "a.log").last().unwrap().unwrap_err();
        assert!(matches!(error, ReadError::Bad { line: 5, .. }), "{error}");
    }

    #[test]
    fn a_bad_line_is_named_and_ends_the_reading() {
        let log = LOG.replace("123#R", "12#R");
        let mut reader = Reader::new(log.as_bytes(), "a.log");
        assert!(reader.next().unwrap().is_ok());
        let error = reader.next().unwrap().unwrap_err().to_string();
        assert!(error.starts_with("a.log:3: no identifier"), "{error}");
        assert!(reader.next().is_none());
    }

    #[test]
    fn a_cut_line_is_an_error_unless_accepted() {
        // Cut within the data: it still reads as a frame, but not as the one that was sent.
        let cut = "(1.5) can0 123#5555\n(1.6) can0 123#55";
        let error = Reader::new(cut.as_bytes(), "a.log").nth(1).unwrap().unwrap_err();
        assert!(matches!(error, ReadError::Cut { line: 2, .. }), "{error}");

        let mut reader = Reader::new(cut.as_bytes(), "a.log").accepting_cut();
        assert_eq!(reader.by_ref().filter_map(Result::ok).count(), 1);
        assert_eq!((reader.cut_line(), reader.line()), (Some(2), 1));
    }

    #[test]
    fn zeros_after_the_last_line_are_a_cut_however_many() {
        for zeros in [1, 511, 512, 513, 100_000] {
            let log = format!("{LOG}(1.8{}", "\0".repeat(zeros));
            let read = || Reader::new(log.as_bytes(), "a.log");
            let error = read().last().unwrap().unwrap_err();
            assert!(matches!(error, ReadError::Cut { line: 5, .. }), "{zeros}: {error}");
            let mut reader = read().accepting_cut();
            assert_eq!(reader.by_ref().filter_map(Result::ok).count(), 2);
            assert_eq!(reader.cut_line(), Some(5));
            let more = format!("{log}({}", "x".repeat(600));
            let reader = Reader::new(more.as_bytes(), "a.log").accepting_cut();
            let error = reader.last().unwrap().unwrap_err();
            assert!(matches!(error, ReadError::Bad { line: 5, .. }), "{zeros}: {error}");
        }
        let error = Reader::new(io::BufReader::new(io::repeat(0)), "zero").next().unwrap();
        assert!(matches!(error, Err(ReadError::Bad { what: BadLine::TooLong, .. })), "no log");
    }

    #[test]
    fn a_cut_stream_is_a_cut_log() {
        struct CutStream;
        impl Read for CutStream {
            fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
                Err(io::ErrorKind::UnexpectedEof.into())
            }
        }
        let input = || io::BufReader::new("(1.5) can0 123#\n(1.".as_bytes().chain(CutStream));
        let error = Reader::new(input(), "a.log.gz").nth(1).unwrap().unwrap_err();
        assert!(matches!(error, ReadError::Cut { line: 2, .. }), "{error}");
        let mut reader = Reader::new(input(), "a.log.gz").accepting_cut();
        assert_eq!(reader.by_ref().filter_map(Result::ok).count(), 1);
        assert_eq!(reader.cut_line(), Some(2));
    }

    #[test]
    fn a_file_without_lines_is_not_read_into_memory() {
        let error = Reader::new(io::BufReader::new(io::repeat(b'x')), "x").next();
        let error = error.unwrap().unwrap_err();
        assert!(matches!(error, ReadError::Bad { what: BadLine::TooLong, .. }), "{error}");
    }
}
