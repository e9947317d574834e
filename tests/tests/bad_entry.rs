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
