//! Of several events, faults and expectations, a refusal names the line of the bad one.

use std::io;
use std::path::Path;

use xt28_scenarios::Scenario;

/// Lines 1 to 3 of a scenario.
const HEAD: &str = "title = \"t\"\npolicy = \"hold\"\nduration_s = 30\n";

/// What is said of a scenario with `more` after its head.
fn refusal(more: &str) -> String {
    let none = |_: &Path| Err(io::ErrorKind::NotFound.into());
    let refused = Scenario::parse(&format!("{HEAD}{more}"), Path::new("a.toml"), none);
    refused.expect_err(more).to_string()
}

fn event(at_s: f64) -> String {
    format!("[[event]]\nat_s = {at_s}\norder = \"arm\"\n")
}

fn fault(from_s: f64) -> String {
    format!("[[fault]]\nsensor = \"stroke\"\nwheel = \"FR\"\nkind = \"stuck\"\nfrom_s = {from_s}\n")
}

fn standing(below: &str) -> String {
    format!("[[expect]]\nstands-still = {{ below_m_s = {below} }}\n")
}

#[test]
fn the_second_is_named_where_the_second_is_bad() {
    for (more, starts) in [
        (event(6.0) + &event(60.0), "a.toml:8: at_s = 60 lies outside the run, 0 to 30"),
        (fault(1.0) + &fault(-1.0), "a.toml:10: [[fault]]: from_s = -1"),
        (standing("1") + &standing("nan"), "a.toml:7: stands-still: below_m_s = NaN"),
    ] {
        let said = refusal(&more);
        assert!(said.starts_with(starts), "{said}");
    }
}

#[test]
fn however_the_entry_is_written() {
    let said = refusal("[[expect]]\n[expect.stands-still]\nbelow_m_s = -1\n");
    assert!(said.starts_with("a.toml:5: stands-still: below_m_s = -1"), "{said}");
    let said = refusal(
        "event = [\n  { at_s = 1, order = \"arm\" },\n  { at_s = 33, order = \"arm\" },\n]\n",
    );
    assert!(said.starts_with("a.toml:6: at_s = 33"), "{said}");
}

#[test]
fn a_fault_that_would_come_after_the_run_is_refused_as_an_event_is() {
    let said = refusal(&(fault(1.0) + &fault(31.0)));
    assert!(said.starts_with("a.toml:13: from_s = 31 lies outside the run, 0 to 30"), "{said}");
}

#[test]
fn what_would_come_behind_the_last_tick_is_refused() {
    // Ticks come every 10 ms, the last at 29.99 s.
    let said = refusal(&event(29.995));
    assert!(said.starts_with("a.toml:5: at_s = 29.995 is behind the run's last tick"), "{said}");
    assert!(said.ends_with("give at most 29.99"), "{said}");
    for from_s in [29.995, 30.0] {
        let said = refusal(&fault(from_s));
        assert!(said.starts_with(&format!("a.toml:8: from_s = {from_s} is behind")), "{said}");
    }
    let none = |_: &Path| Err(io::ErrorKind::NotFound.into());
    for sound in [event(29.99), fault(29.99), event(0.0)] {
        Scenario::parse(&format!("{HEAD}{sound}"), Path::new("a.toml"), none).expect(&sound);
    }
}

#[test]
fn a_fault_is_mended_within_the_run_or_stays() {
    let mended = |to_s: f64| format!("{}to_s = {to_s}\n", fault(1.0));
    let said = refusal(&(fault(2.0) + &mended(31.0)));
    assert!(said.starts_with("a.toml:14: to_s = 31 lies outside the run, 0 to 30"), "{said}");
    assert!(said.ends_with("leave it out if the fault stays"), "{said}");
    let none = |_: &Path| Err(io::ErrorKind::NotFound.into());
    Scenario::parse(&format!("{HEAD}{}", mended(30.0)), Path::new("a.toml"), none).unwrap();
}

#[test]
fn an_effect_of_no_severity_is_refused() {
    let late = |severity: &str| {
        format!("[[effect]]\nname = \"arm-delay\"\nseverity = {severity}\ndelay_s = 0.1\n")
    };
    for none in ["0", "0.0", "-0.0"] {
        let said = refusal(&(late("0.5") + &late(none)));
        assert!(
            said.starts_with("a.toml:10: arm-delay would do nothing at severity = 0"),
            "{said}"
        );
    }
}
