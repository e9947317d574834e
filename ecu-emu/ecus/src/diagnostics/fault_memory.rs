//! What has failed, when, and how often: the part of an ECU that outlives its resets.

use core::time::Duration;

use xt28_machine::SimTime;

use super::trouble_code::{Fmi, Lamp, Part, TroubleCode};

/// Codes that a memory can hold.
const CODES_MAX: usize = 96;
/// Occurrences are counted up to this; one more would say "not available" (J1939-73).
const OCCURRENCES_MAX: u8 = 126;
/// A code that comes and goes is announced at most this often (J1939-73, 5.7.1).
const NEWS_MIN: Duration = Duration::from_secs(1);

/// Bits of a code's status (ISO 14229-1, D.2).
pub mod status {
    /// Fails now.
    pub const FAILED: u8 = 1 << 0;
    /// Failed since the ECU started.
    pub const FAILED_THIS_CYCLE: u8 = 1 << 1;
    /// Failed in this cycle or the one before.
    pub const PENDING: u8 = 1 << 2;
    /// Failed for long enough to be kept.
    pub const CONFIRMED: u8 = 1 << 3;
    /// Not tested since the memory was cleared.
    pub const UNTESTED_SINCE_CLEAR: u8 = 1 << 4;
    /// Failed since the memory was cleared.
    pub const FAILED_SINCE_CLEAR: u8 = 1 << 5;
    /// Not tested since the ECU started.
    pub const UNTESTED_THIS_CYCLE: u8 = 1 << 6;
    /// Lights a lamp now.
    pub const WARNING: u8 = 1 << 7;
    /// Every bit has a meaning here.
    pub const AVAILABLE: u8 = 0xFF;
}

const UNTESTED: u8 = status::UNTESTED_SINCE_CLEAR | status::UNTESTED_THIS_CYCLE;

/// What is known of one code.
#[derive(Clone, Copy, Debug)]
struct Record {
    status: u8,
    occurrences: u8,
    announced: Option<SimTime>,
    is_news: bool,
}

const CLEAN: Record = Record { status: UNTESTED, occurrences: 0, announced: None, is_news: false };

/// A code with what is known of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The code.
    pub code: TroubleCode,
    /// What it lights while it fails.
    pub lamp: Lamp,
    /// Bits of [`status`].
    pub status: u8,
    /// How often it began to fail, up to 126.
    pub occurrences: u8,
}

impl Entry {
    /// Fails now (DM1).
    #[must_use]
    pub const fn is_active(&self) -> bool {
        self.status & status::FAILED != 0
    }

    /// Failed before, and does not now (DM2).
    #[must_use]
    pub const fn was_active(&self) -> bool {
        self.status & (status::FAILED | status::CONFIRMED) == status::CONFIRMED
    }
}

/// The codes of one ECU.
#[derive(Clone, Debug)]
pub struct FaultMemory {
    parts: &'static [Part],
    records: [Record; CODES_MAX],
}

impl FaultMemory {
    /// A memory in which nothing was tested yet.
    ///
    /// # Panics
    /// If `parts` have more than 96 codes together: a table of ours that outgrew the memory.
    #[must_use]
    pub fn new(parts: &'static [Part]) -> Self {
        let codes: usize = parts.iter().map(|part| part.modes.len()).sum();
        assert!(codes <= CODES_MAX, "{codes} codes in a memory for {CODES_MAX}");
        Self { parts, records: [CLEAN; CODES_MAX] }
    }

    /// The result of a test of the part at `part` in the table: the way it fails, or none.
    pub fn report(&mut self, part: usize, failing: Option<Fmi>) {
        let first = self.first_of(part);
        for (mode, record) in self.parts[part].modes.iter().zip(&mut self.records[first..]) {
            record.test(failing == Some(mode.fmi));
        }
    }

    /// All codes in the order of the table.
    pub fn entries(&self) -> impl Iterator<Item = Entry> {
        codes(self.parts).zip(&self.records).map(|(code, record)| record.entry(code))
    }

    /// Forgets the codes that `which` holds of. What fails on is found again at the next test.
    pub fn clear(&mut self, which: impl Fn(&Entry) -> bool) {
        for (code, record) in codes(self.parts).zip(&mut self.records) {
            if which(&record.entry(code)) {
                *record = Record { announced: record.announced, is_news: true, ..CLEAN };
            }
        }
    }

    /// A new operation cycle begins: the ECU has started.
    pub fn begin_cycle(&mut self) {
        for record in &mut self.records {
            if record.status & status::FAILED_THIS_CYCLE == 0 {
                record.status &= !status::PENDING;
            }
            record.status &= !(status::FAILED | status::FAILED_THIS_CYCLE | status::WARNING);
            record.status |= status::UNTESTED_THIS_CYCLE;
            record.announced = None;
        }
    }

    /// True once for codes that came or went and have not been announced within the last second.
    pub fn take_news(&mut self, now: SimTime) -> bool {
        let mut any = false;
        for record in &mut self.records {
            let quiet = record.announced.is_none_or(|at| now.since(at) >= NEWS_MIN);
            if record.is_news && quiet {
                (record.is_news, record.announced, any) = (false, Some(now), true);
            }
        }
        any
    }

    /// Index of the first record of a part.
    fn first_of(&self, part: usize) -> usize {
        self.parts[..part].iter().map(|part| part.modes.len()).sum()
    }
}

/// Every code of a table with its lamp, in order.
fn codes(parts: &'static [Part]) -> impl Iterator<Item = (TroubleCode, Lamp)> {
    let of = |part: &'static Part| {
        part.modes.iter().map(|mode| (TroubleCode { spn: part.spn, fmi: mode.fmi }, mode.lamp))
    };
    parts.iter().flat_map(of)
}

impl Record {
    const fn entry(&self, (code, lamp): (TroubleCode, Lamp)) -> Entry {
        Entry { code, lamp, status: self.status, occurrences: self.occurrences }
    }

    fn test(&mut self, fails: bool) {
        let failed = self.status & status::FAILED != 0;
        self.status &= !UNTESTED;
        if fails {
            self.status |= status::FAILED
                | status::FAILED_THIS_CYCLE
                | status::PENDING
                | status::CONFIRMED
                | status::FAILED_SINCE_CLEAR
                | status::WARNING;
        } else {
            self.status &= !(status::FAILED | status::WARNING);
        }
        if fails != failed {
            self.is_news = true;
            self.occurrences = (self.occurrences + u8::from(fails)).min(OCCURRENCES_MAX);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::parts;
    use super::*;

    fn at(ms: u64) -> SimTime {
        SimTime::from_millis(ms)
    }

    fn memory() -> FaultMemory {
        FaultMemory::new(parts::ARM)
    }

    fn entry(memory: &FaultMemory, spn: u32, fmi: Fmi) -> Entry {
        memory.entries().find(|e| e.code == TroubleCode { spn, fmi }).unwrap()
    }

    #[test]
    fn a_code_comes_goes_and_is_kept() {
        let mut memory = memory();
        let stroke_fl = parts::arm::STROKE + 1;
        assert_eq!(entry(&memory, 520_193, Fmi::Open).status, 0x50);
        memory.report(stroke_fl, None);
        assert_eq!(entry(&memory, 520_193, Fmi::Open).status, 0);
        memory.report(stroke_fl, Some(Fmi::Open));
        assert_eq!(entry(&memory, 520_193, Fmi::Open).status, 0xAF);
        assert_eq!(entry(&memory, 520_193, Fmi::High).status, 0, "the other ways passed");
        memory.report(stroke_fl, None);
        let left = entry(&memory, 520_193, Fmi::Open);
        assert_eq!((left.status, left.occurrences, left.was_active()), (0x2E, 1, true));
    }

    #[test]
    fn a_cycle_later_it_is_pending_and_two_later_confirmed_only() {
        let mut memory = memory();
        memory.report(parts::arm::IMU, Some(Fmi::UpdateRate));
        memory.report(parts::arm::IMU, None);
        memory.begin_cycle();
        assert_eq!(entry(&memory, 520_220, Fmi::UpdateRate).status, 0x6C);
        memory.report(parts::arm::IMU, None);
        memory.begin_cycle();
        assert_eq!(entry(&memory, 520_220, Fmi::UpdateRate).status, 0x68);
    }

    #[test]
    fn clearing_forgets_until_the_next_failed_test() {
        let mut memory = memory();
        memory.report(parts::arm::IMU, Some(Fmi::UpdateRate));
        memory.clear(Entry::was_active);
        assert!(entry(&memory, 520_220, Fmi::UpdateRate).is_active(), "it is not of those");
        memory.clear(|_| true);
        assert_eq!(entry(&memory, 520_220, Fmi::UpdateRate).status, 0x50);
        memory.report(parts::arm::IMU, Some(Fmi::UpdateRate));
        assert!(entry(&memory, 520_220, Fmi::UpdateRate).is_active());
    }

    #[test]
    fn a_flickering_code_is_news_once_a_second() {
        let mut memory = memory();
        let mut news = 0;
        for tick in 0..300 {
            let failing = (tick % 2 == 0).then_some(Fmi::UpdateRate);
            memory.report(parts::arm::IMU, failing);
            news += u32::from(memory.take_news(at(tick * 10)));
        }
        assert_eq!(news, 3);
        assert_eq!(entry(&memory, 520_220, Fmi::UpdateRate).occurrences, 126);
    }
}
