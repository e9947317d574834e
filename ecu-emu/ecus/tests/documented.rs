//! `docs/diagnostics.md` says what the code does: every table of it is made again from the code.

use std::time::Duration;

use xt28_ecus::diagnostics::trouble_code::{Fmi, Lamp, Part};
use xt28_ecus::diagnostics::{isotp, j1939, parts, uds};
use xt28_ecus::{diagnostics, power};

const PAGE: &str = include_str!("../../../docs/diagnostics.md");

/// The rows of the table under a heading, without its own head.
fn rows(heading: &str) -> Vec<String> {
    let section = PAGE.split("\n## ").find(|section| section.starts_with(heading));
    let section = section.unwrap_or_else(|| panic!("no section `{heading}`"));
    let rows = section.lines().filter(|line| line.starts_with("| "));
    rows.skip(1).map(str::to_owned).collect()
}

fn trouble_rows(parts: &[Part]) -> Vec<String> {
    let row = |part: &Part| {
        let fmis: Vec<String> = part.modes.iter().map(|m| m.fmi.number().to_string()).collect();
        let lamp = match part.modes[0].lamp {
            Lamp::Stop => "red",
            Lamp::Warning => "amber",
        };
        format!("| {} | {} | {} | {lamp} |", part.spn, part.name, fmis.join(" "))
    };
    parts.iter().map(row).collect()
}

fn identifier_rows(of: &[uds::identifier::Identifier]) -> Vec<String> {
    let row = |known: &uds::identifier::Identifier| {
        let session = match known.access {
            uds::identifier::Access::Any => "any",
            uds::identifier::Access::Extended => "extended",
        };
        format!("| {:04X} | {} | {} | {session} |", known.did, known.name, known.layout)
    };
    of.iter().map(row).collect()
}

#[test]
fn trouble_codes_are_as_the_page_says() {
    assert_eq!(rows("Trouble codes of the arm ECU"), trouble_rows(parts::ARM));
    assert_eq!(rows("Trouble codes of the drive ECU"), trouble_rows(parts::DRIVE));
}

#[test]
fn each_part_lights_one_lamp_and_each_failure_mode_is_explained() {
    let used = parts::ARM.iter().chain(parts::DRIVE);
    let mut fmis: Vec<Fmi> = Vec::new();
    for part in used {
        let lamp = part.modes[0].lamp;
        assert!(part.modes.iter().all(|mode| mode.lamp == lamp), "{}", part.name);
        fmis.extend(part.modes.iter().map(|mode| mode.fmi));
    }
    fmis.sort();
    fmis.dedup();
    let said: Vec<String> = rows("Failure modes")
        .iter()
        .map(|row| row.split('|').take(3).collect::<Vec<_>>().join("|"))
        .collect();
    let expected: Vec<String> =
        fmis.iter().map(|fmi| format!("| {} | {} ", fmi.number(), fmi.meaning())).collect();
    assert_eq!(said, expected);
}

#[test]
fn identifiers_are_as_the_page_says() {
    assert_eq!(rows("Data of both ECUs"), identifier_rows(uds::identifier::COMMON));
    assert_eq!(rows("Data of the arm ECU"), identifier_rows(uds::identifier::ARM));
    assert_eq!(rows("Data of the drive ECU"), identifier_rows(uds::identifier::DRIVE));
}

#[test]
fn timings_are_as_the_page_says() {
    let ms = |what: &str, span: Duration| format!("| {what} | {} ms |", span.as_millis());
    let expected = [
        ms("UDS: a response comes within (P2)", uds::RESPONSE_MAX),
        ms("UDS: a session ends without requests after (S3)", uds::SESSION_TIMEOUT),
        ms("ISO-TP: flow control comes within (N_Bs)", isotp::FLOW_CONTROL_TIMEOUT),
        ms("ISO-TP: a consecutive frame follows within (N_Cr)", isotp::CONSECUTIVE_TIMEOUT),
        ms(
            "ISO-TP: separation that our flow control asks for",
            diagnostics::FLOW_LIMITS.separation,
        ),
        ms("J1939: DM1 comes every", j1939::DM1_PERIOD),
        ms("ECU: from the end of a reset to the first task period", power::BOOT),
    ];
    assert_eq!(rows("Timings"), expected);
}

#[test]
fn addresses_and_limits_are_as_the_page_says() {
    for fact in [
        format!("`{:02X}` for the arm ECU", diagnostics::ARM_ADDRESS),
        format!("`{:02X}` for the drive ECU", diagnostics::DRIVE_ADDRESS),
        format!("`18DB{:02X}F1`", diagnostics::FUNCTIONAL_ADDRESS),
        format!("`{:016X}`", j1939::name::ARM.bits()),
        format!("`{:016X}`", j1939::name::DRIVE.bits()),
        format!("block size of {}", diagnostics::FLOW_LIMITS.block_size),
        format!("up to {} identifiers", uds::IDENTIFIERS_MAX),
        format!("padded with `{:02X}`", isotp::PADDING),
        format!("below {} V", power::RESET_BELOW_MV / 1000.0),
        format!("above {} V", power::START_ABOVE_MV / 1000.0),
    ] {
        assert!(PAGE.contains(&fact), "the page does not say: {fact}");
    }
}
