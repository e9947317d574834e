//! The result of a run: for people and for scripts.

use gateway::policy::Account;
use gateway::{EcuReport, Outcome, Reason, SimTime, Status};
use serde_json::{Value, json};

use crate::realtime::Finished;

/// Why the run did not do what it was for; `None` when it did.
pub(crate) fn shortfall(finished: &Finished) -> Option<String> {
    let status = &finished.status;
    if let Some(problem) = &finished.broke {
        return Some(problem.to_string());
    }
    if status.stops.count > 0 {
        return Some(status.stops.to_string());
    }
    if let Some(reason) = finished.never_armed {
        return Some(format!("never armed: {}", status.told(reason)));
    }
    match &status.outcome {
        Outcome::Failed(why) => Some(why.clone()),
        Outcome::Running if finished.interrupted => Some("interrupted".to_owned()),
        Outcome::Running => Some("the time was over before the task was".to_owned()),
        Outcome::Reached | Outcome::Endless => None,
    }
}

/// A few lines for people.
pub(crate) fn lines(finished: &Finished) -> Vec<String> {
    let Finished { status, lateness, frames_lost, frames_discarded, seconds, .. } = finished;
    let mut lines = vec![match shortfall(finished) {
        None => format!("done in {seconds:.1} s"),
        Some(why) => format!("not done after {seconds:.1} s: {why}"),
    }];
    if let Some(located) = &status.located {
        let p = located.pose;
        let heading_deg = p.heading_rad.to_degrees();
        lines.push(format!(
            "front axle at {:.2} m east, {:.2} m north, {heading_deg:.1} deg",
            p.east_m, p.north_m
        ));
    }
    let (p99_ms, worst_ms) = (lateness.p99_ms(), lateness.worst_ms());
    let (ticks, missed) = (lateness.ticks(), lateness.missed);
    lines.push(format!(
        "{ticks} ticks, {missed} missed; late below {p99_ms:.3} ms in 99 %, {worst_ms:.3} ms at worst"
    ));
    if let Some(frames @ 1..) = frames_lost {
        lines.push(format!("{frames} frames came and were lost: nobody read them in time"));
    }
    if let frames @ 1.. = *frames_discarded {
        lines.push(format!(
            "{frames} frames of ours never left: the bus took none, or they were too old by then"
        ));
    }
    lines.extend(finished.controller.as_ref().map(controller_line));
    if finished.receiver {
        fix_lines(status, &mut lines);
    }
    lines
}

/// How the controller kept up.
fn controller_line(account: &Account) -> String {
    let Account { shown, answers, delay_max, .. } = account;
    match mean_ms(account) {
        None => format!("the controller was shown {shown} observations and answered none"),
        Some(mean_ms) => format!(
            "the controller answered {answers} times to {shown} observations, after {mean_ms:.0} ms on average \
             and {} ms at worst",
            delay_max.as_millis()
        ),
    }
}

/// How long an answer took on average, ms; none where there was none.
fn mean_ms(account: &Account) -> Option<f64> {
    let answers = u32::try_from(account.answers).unwrap_or(u32::MAX);
    let mean = account.delay_sum.checked_div(answers)?;
    Some(mean.as_secs_f64() * 1e3)
}

/// What stood against the receiver's fixes, as far as something did.
fn fix_lines(status: &Status, lines: &mut Vec<String>) {
    let counts = &status.counts;
    match (counts.gnss_bytes, counts.gnss_messages) {
        (0, _) => lines.push(
            "nothing came from the receiver; is it powered, and is that its port and speed?".to_owned(),
        ),
        (bytes, 0) => lines.push(format!(
            "{bytes} bytes came from the receiver, and no UBX message among them; let it send UBX on this port, at \
             the port's speed"
        )),
        _ => {}
    }
    if let fixes @ 1.. = counts.fixes_without_heading {
        lines.push(format!(
            "{fixes} fixes came without a heading good to 3 degrees; does the receiver see its second antenna, and \
             is it the rover of a moving base?"
        ));
    }
    if let (None, epochs @ 1..) = (status.located, counts.fixes_incomplete) {
        lines.push(format!(
            "{epochs} epochs were incomplete; let the receiver send NAV-PVT and NAV-RELPOSNED"
        ));
    }
    if let (fixes @ 1.., Some(quality)) = (counts.fixes_refused, status.quality) {
        let (fix, accuracy_m) = (quality.fix, quality.accuracy_horizontal_m);
        lines.push(format!(
            "{fixes} fixes were not good enough to drive by; the last one: {fix}, {accuracy_m:.2} m"
        ));
    }
}

/// The same as JSON.
pub(crate) fn json(finished: &Finished) -> Value {
    let Finished { status, lateness, interrupted, seconds, .. } = finished;
    let Status { counts, .. } = status;
    json!({
        "pass": shortfall(finished).is_none(),
        "reason": shortfall(finished),
        "outcome": status.outcome.name(),
        "interrupted": interrupted,
        "seconds": seconds,
        "armed_at_s": status.armed_at.map(|at| at.as_secs_f64()),
        "safety_stop": status.stops.first.map(stop),
        "last_safety_stop": status.stops.last.map(stop),
        "safety_stops": status.stops.count,
        "front_axle": status.located.map(|located| json!({
            "east_m": located.pose.east_m, "north_m": located.pose.north_m,
            "heading_rad": located.pose.heading_rad,
        })),
        "ecus": { "arm": ecu(&status.arm_ecu), "drive": ecu(&status.drive_ecu) },
        "lateness_ms": { "p99_below": lateness.p99_ms(), "worst": lateness.worst_ms() },
        "ticks": { "run": lateness.ticks(), "missed": lateness.missed,
                   "allowed": counts.allowed, "clamped": counts.clamped },
        "fixes": { "used": counts.fixes, "refused": counts.fixes_refused,
                   "without_heading": counts.fixes_without_heading,
                   "overtaken": counts.fixes_overtaken, "incomplete": counts.fixes_incomplete },
        "controller": finished.controller.as_ref().map(|account| json!({
            "shown": account.shown, "answers": account.answers,
            "delay_ms": { "mean": mean_ms(account), "worst": account.delay_max.as_secs_f64() * 1e3 },
        })),
        "faults": { "gnss_stream": counts.gnss_faults, "frames_refused": counts.frames_refused,
                    "frames_unsent": counts.frames_unsent,
                    "frames_discarded": finished.frames_discarded,
                    "frames_lost": finished.frames_lost },
    })
}

/// A safety stop.
fn stop((at, reason): (SimTime, Reason)) -> Value {
    json!({ "at_s": at.as_secs_f64(), "reason": reason.to_string() })
}

/// What an ECU said of itself last.
fn ecu(report: &EcuReport) -> Value {
    let faults: Vec<String> = report.faults().collect();
    json!({ "state": report.state.name(), "faults": faults, "refused_for": report.refusal })
}
