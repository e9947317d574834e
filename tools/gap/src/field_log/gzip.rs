//! A gzip file as what it holds, member after member, and whether anything else stands behind them.

use std::cell::Cell;
use std::io::{self, BufRead, Read};
use std::rc::Rc;

use flate2::bufread::GzDecoder;

/// First two bytes of gzip (RFC 1952); no candump line begins so.
pub(super) const MAGIC: [u8; 2] = [0x1F, 0x8B];

/// Reads what a gzip file holds.
pub(super) struct Gzip<R> {
    member: Option<GzDecoder<R>>,
    trailing: Rc<Cell<bool>>,
}

impl<R: BufRead> Gzip<R> {
    /// Reads from `input`, and raises `trailing` where bytes follow the last member that begin none:
    /// that all of a log is there is then for the members' own checksums to say, which they do.
    pub(super) fn new(input: R, trailing: Rc<Cell<bool>>) -> Self {
        Self { member: Some(GzDecoder::new(input)), trailing }
    }
}

impl<R: BufRead> Read for Gzip<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        while let Some(mut member) = self.member.take() {
            let read = member.read(into);
            if into.is_empty() || !matches!(read, Ok(0)) {
                self.member = Some(member);
                return read;
            }
            let mut input = member.into_inner();
            match input.fill_buf()?.first() {
                Some(first) if *first == MAGIC[0] => self.member = Some(GzDecoder::new(input)),
                Some(_) => self.trailing.set(true),
                None => {}
            }
        }
        Ok(0)
    }
}

/// An input that failed before a byte of it was read.
pub(super) struct Failed(pub(super) Option<io::Error>);

impl Read for Failed {
    fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
        self.0.take().map_or(Ok(0), Err)
    }
}
