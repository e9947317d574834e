//! A log while it is read: frames in order of time become samples, and what is wrong is counted.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Duration;

use xt28_bus::candump::Record;
use xt28_dbc::{CanId, Frame};
use xt28_dbc_model::ValueError;
use xt28_machine::SimTime;

use super::FieldLog;
use super::attendance::Attendance;
use super::in_turn::alternates;
use super::interfaces::{Interfaces, MESSAGES_MIN, TwoVoiced};
use super::order::{Order, Place};
use super::stillness::Stillness;
use super::thinned::is_thinned;
use crate::decoder::Tap;
use crate::{Channel, Decoder, FaultKind, GapError, LogFault, Need, Series, Voices};

/// No frame of any message for longer: twenty periods of the fastest are more than a bus ever loses.
const PAUSE_S: f64 = 0.2;
/// Merged sources lie a few ms apart; frames that come later than this may be of a clock that stepped.
const LATE_TOLD: Duration = Duration::from_millis(10);
/// Identifiers that an error names, of those that a DBC has not.
const STRANGE_SHOWN: usize = 5;

/// A log while it is read.
#[derive(Default)]
pub(super) struct Intake {
    order: Order,
    series: BTreeMap<Channel, Series>,
    first: Option<SimTime>,
    latest: SimTime,
    frames: u64,
    known_frames: u64,
    strange: BTreeSet<CanId>,
    late: Option<LongestSpan>,
    back: Option<LongestSpan>,
    ahead: Option<LongestSpan>,
    pauses_s: Vec<[f64; 2]>,
    messages: BTreeMap<CanId, Attendance>,
    interfaces: Interfaces,
    /// Frames of a message that say nothing, and the line of the first.
    unavailable: BTreeMap<CanId, (u64, u64)>,
    stillness: Stillness,
    refused: BTreeMap<Channel, (u64, ValueError, u64)>,
    line: u64,
    faults: Vec<(u64, FaultKind)>,
}

/// The longest of several spans of one kind, the line it is at, and how many there are.
struct LongestSpan {
    line: u64,
    span: Duration,
    times: u64,
}

/// Whether all bits of a whole frame are one, which is how J1939 says of each signal that it is not available. Where
/// all signals have a sign, that is a little less than nothing; and a frame of a byte or two may mean it.
fn says_nothing(tap: &Tap, frame: &Frame) -> bool {
    let is_whole = frame.data().len() >= tap.bytes().max(4);
    is_whole && tap.has_unsigned() && frame.data().iter().all(|byte| *byte == 0xFF)
}

impl LongestSpan {
    fn note(kept: &mut Option<Self>, line: u64, span: Duration) {
        let kept = kept.get_or_insert(Self { line, span, times: 0 });
        if span > kept.span {
            (kept.line, kept.span) = (line, span);
        }
        kept.times += 1;
    }
}

impl Intake {
    pub(super) fn take(&mut self, decoder: &Decoder, record: &Record, line: u64) {
        self.frames += 1;
        self.line = line;
        self.interfaces.note(record, line);
        match self.order.put(record.at, line, record.frame) {
            Place::Next => {}
            Place::Late(by) => LongestSpan::note(&mut self.late, line, by),
            Place::Past(by) => return LongestSpan::note(&mut self.back, line, by),
        }
        while let Some((at, line, frame)) = self.order.due() {
            self.hear(decoder, at, line, &frame);
        }
    }

    /// Takes a fault of the log itself, not of its frames.
    pub(super) fn fault(&mut self, line: u64, kind: FaultKind) {
        self.faults.push((line, kind));
    }

    /// Takes a fault of what comes behind the last frame.
    pub(super) fn fault_at_end(&mut self, kind: FaultKind) {
        self.fault(self.line, kind);
    }

    /// Takes the next frame in order of time.
    fn hear(&mut self, decoder: &Decoder, at: SimTime, line: u64, frame: &Frame) {
        let first = *self.first.get_or_insert(at);
        let silence = at - self.latest.max(first);
        if silence.as_secs_f64() > PAUSE_S {
            LongestSpan::note(&mut self.ahead, line, silence);
            let to_s = (at - first).as_secs_f64();
            self.pauses_s.push([to_s - silence.as_secs_f64(), to_s]);
        }
        self.latest = at;
        let Some(tap) = decoder.tap(frame.id()) else {
            if self.strange.len() < STRANGE_SHOWN {
                self.strange.insert(frame.id());
            }
            return;
        };
        self.known_frames += 1;
        if says_nothing(tap, frame) {
            self.unavailable.entry(frame.id()).or_insert((line, 0)).1 += 1;
            return;
        }
        let at_s = (at - first).as_secs_f64();
        let attendance = self.messages.entry(frame.id()).or_default();
        if attendance.is_repeat(tap, at, line, frame) {
            return;
        }
        attendance.note(tap, at, at_s, line, frame);
        for (channel, value) in tap.values(frame) {
            match value {
                Ok(value) => {
                    self.stillness.note(channel, line, at_s, value);
                    self.series.entry(channel).or_default().push(at_s, value);
                }
                Err(error) => self.refused.entry(channel).or_insert((line, error, 0)).2 += 1,
            }
        }
    }

    /// The log, whose name in errors is `name`.
    pub(super) fn finish(mut self, name: &str, decoder: &Decoder) -> Result<FieldLog, GapError> {
        let name: Arc<str> = name.into();
        while let Some((at, line, frame)) = self.order.rest() {
            self.hear(decoder, at, line, &frame);
        }
        if let Some(LongestSpan { line, span, times }) = self.back
            && times > self.frames / 2
        {
            // Not what came after is out of time, but what came before.
            let by_s = -span.as_secs_f64();
            return Err(GapError::ClockSteps { log: name.to_string(), line, by_s });
        }
        let mut kinds = std::mem::take(&mut self.faults);
        let twice = self.two_voiced(decoder);
        let are_machines = twice.len() >= MESSAGES_MIN;
        for (line, message, voices) in twice {
            if are_machines {
                return Err(GapError::TwoMachines { log: name.to_string(), line, message, voices });
            }
            kinds.push((line, FaultKind::TwoVoiced { message, voices }));
        }
        kinds.extend(self.faults_of_frames(decoder));
        kinds.sort_by_key(|(line, _)| *line);
        let fault = |(line, kind)| LogFault { log: name.clone(), line, kind };
        let faults: Vec<LogFault> = kinds.into_iter().map(fault).collect();
        self.check(&name, decoder, &faults)?;
        let messages: Vec<[u64; 2]> = self
            .messages
            .iter()
            .filter_map(|(id, attendance)| Some(attendance.lost(decoder.tap(*id)?)))
            .collect();
        Ok(FieldLog {
            is_thinned: is_thinned(&messages),
            faults,
            series: self.series,
            frames: self.frames,
            duration_s: (self.latest - self.first.unwrap_or_default()).as_secs_f64(),
            begun_s: self.first.map(|first| (first - SimTime::default()).as_secs_f64()),
            name,
        })
    }

    /// Messages with two senders that say different things, each with a line, those on two interfaces first.
    fn two_voiced(&self, decoder: &Decoder) -> Vec<(u64, String, Voices)> {
        let on_two = self.interfaces.two_voiced(|id| decoder.tap(id).is_some());
        let ids: BTreeSet<CanId> = on_two.iter().map(|two| two.id).collect();
        let in_turn = self.messages.iter().filter_map(|(id, attendance)| {
            let (tap, line) = (decoder.tap(*id)?, attendance.crowded_from()?);
            let alternates = |channel| {
                let (series, step) = (self.series.get(&channel)?, tap.step_of(channel));
                Some(alternates(series, step.unwrap_or(0.0)))
            };
            let is_one = !ids.contains(id) && tap.channels().any(|c| alternates(c) == Some(true));
            is_one.then(|| (line, tap.name().to_owned(), Voices::InTurn))
        });
        let mut in_turn: Vec<_> = in_turn.collect();
        in_turn.sort_by_key(|(line, ..)| *line);
        let on_two = on_two.into_iter().map(|TwoVoiced { id, interfaces, line }| {
            let names = interfaces.map(|name| name.to_string());
            (line, decoder.name_of_message(id), Voices::Interfaces(names))
        });
        on_two.chain(in_turn).collect()
    }

    /// Refuses a log that lacks what a replay needs, with the first fault that explains it.
    fn check(&self, log: &str, decoder: &Decoder, faults: &[LogFault]) -> Result<(), GapError> {
        let lost = faults.iter().find(|fault| fault.kind.leaves_out_any());
        let why = lost.map(|fault| format!("; {fault}")).unwrap_or_default();
        let log = log.to_owned();
        if self.frames == 0 {
            return Err(GapError::Empty { log, why });
        }
        if self.known_frames == 0 {
            let ids: Vec<String> = self.strange.iter().map(ToString::to_string).collect();
            let (frames, ids) = (self.frames, ids.join(", "));
            return Err(GapError::Stranger { log, frames, ids, why });
        }
        let silent = |channel: &Channel| {
            channel.need() == Need::Required && !self.series.contains_key(channel)
        };
        let Some(channel) = Channel::all().into_iter().find(silent) else { return Ok(()) };
        let message = decoder.message_of(channel).unwrap_or_default().to_owned();
        let channel = channel.to_string();
        if let Some(fault) = faults.iter().find(|f| f.kind.leaves_out(&message, &channel)) {
            return Err(GapError::AllLeftOut { fault: fault.to_string(), channel });
        }
        let (known, frames) = (self.known_frames, self.frames);
        Err(GapError::Silent { log, message, channel, known, frames, why })
    }

    /// What was wrong with the frames, each with its line.
    fn faults_of_frames(&self, decoder: &Decoder) -> Vec<(u64, FaultKind)> {
        let mut kinds = Vec::new();
        if let Some(LongestSpan { line, span, times: frames }) = self.late
            && span > LATE_TOLD
        {
            kinds.push((line, FaultKind::OutOfOrder { by_s: span.as_secs_f64(), frames }));
        }
        if let Some(LongestSpan { line, span, times: frames }) = self.back {
            kinds.push((line, FaultKind::ClockBack { by_s: span.as_secs_f64(), frames }));
        }
        if let Some(LongestSpan { line, span, times }) = self.ahead {
            let (by_s, pauses_s) = (span.as_secs_f64(), self.pauses_s.clone());
            kinds.push((line, FaultKind::ClockAhead { by_s, times, pauses_s }));
        }
        for (id, attendance) in &self.messages {
            if let Some(tap) = decoder.tap(*id) {
                kinds.extend(attendance.faults(tap));
            }
        }
        for (id, (line, frames)) in &self.unavailable {
            let (message, frames) = (decoder.name_of_message(*id), *frames);
            kinds.push((*line, FaultKind::Unavailable { message, frames }));
        }
        for (channel, (line, error, values)) in &self.refused {
            let (channel, problem) = (channel.to_string(), error.to_string());
            kinds.push((*line, FaultKind::Unbelievable { channel, problem, values: *values }));
        }
        kinds.extend(self.stillness.faults(&self.series));
        kinds
    }
}
