//! What the verdict names is what one sees at a glance: in the heading, the picture, the bar and the table.

mod answer;
mod frames;
mod made_up;

use answer::{diagnosis, page, page_of};
use xt28_gap::diagnosis::{Diagnosis, Place, Spot, Verdict};
use xt28_gap::page::text;
use xt28_sim::effects::{Block, find};

/// The heading of a page.
fn heading(page: &str) -> &str {
    page.split_once("<h1>").unwrap().1.split_once("</h1>").unwrap().0
}

/// Rings around parts of the picture, without that of its key.
fn rings(diagnosis: &Diagnosis) -> usize {
    let all = page_of(diagnosis).matches("stroke-width=\"3\"/>").count();
    let axles = 6;
    (all - axles).saturating_sub(1)
}

fn place(part: &'static str, block: Block, scope: &str, residual: &str, gap: f64) -> Place {
    let (scope, residual) = (scope.parse().unwrap(), residual.to_owned());
    Place { spot: Spot { block, part, scope, residual }, gap_over_noise: gap, share: 0.1 }
}

#[test]
fn the_heading_is_one_clause_and_the_rest_stands_below() {
    for verdict in [Verdict::Effect, Verdict::None, Verdict::Unknown] {
        let page = page(verdict);
        let words = heading(&page).split_whitespace().count();
        assert!(words <= 15, "{}", heading(&page));
    }
    let page = page(Verdict::Effect);
    assert_eq!(heading(&page), "arm-delay and leakage-drift, wheels not told apart.");
    assert!(
        page.contains("</h1><p>arm-delay at the front axle or wheel FR (probability 93 %), and")
    );
    let mut one = diagnosis(Verdict::Effect);
    one.causes.truncate(1);
    one.causes[0].scopes.truncate(1);
    let page = page_of(&one);
    assert_eq!(heading(&page), "arm-delay at the front axle (probability 93 %).");
    assert!(!page.contains("</h1><p>arm-delay at"), "it says all");
    one.probability_unknown = 0.4;
    assert_eq!(heading(&page_of(&one)), "Perhaps arm-delay at the front axle.");
}

#[test]
fn what_the_verdict_names_has_a_ring_in_the_picture_however_small_its_gap() {
    let mut named = diagnosis(Verdict::Effect);
    named.causes.truncate(1);
    named.places.iter_mut().for_each(|place| place.gap_over_noise = 0.1);
    assert_eq!(rings(&named), 2, "both wheels of the front axle");
    assert!(page_of(&named).contains("named above"));
    named.causes[0].effect = find("steer-lag").unwrap();
    assert_eq!(rings(&named), 2, "both joints");
    named.causes[0].effect = find("frame-loss").unwrap();
    assert_eq!(rings(&named), 1, "the bus");
    let sound = Diagnosis { causes: Vec::new(), ..diagnosis(Verdict::None) };
    assert!(!page_of(&sound).contains("named above"));
}

#[test]
fn what_nothing_known_explains_is_in_the_picture() {
    let mut unknown = diagnosis(Verdict::Unknown);
    unknown.causes.clear();
    let hangs = place("stance", Block::Payload, "ML", "touch of the ground", 60.0);
    unknown.places = vec![place("arm", Block::Arms, "all", "stroke", 0.3), hangs.clone()];
    let darkest = |unknown: &Diagnosis| page_of(unknown).matches("#7f0000").count();
    let elsewhere = darkest(&unknown);
    unknown.unexplained = Some(hangs.spot);
    assert_eq!(darkest(&unknown), elsewhere + 1, "its wheel, beside the frames");
    assert_eq!(rings(&unknown), 1);
    let page = page_of(&unknown);
    assert!(heading(&page).ends_with("foremost in touch of the ground (wheel ML)."), "{page}");
}

#[test]
fn the_bar_names_the_runner_up_where_that_is_all_there_is_beside() {
    let mut two = diagnosis(Verdict::Effect);
    (two.causes[0].probability, two.causes[1].probability) = (0.65, 0.32);
    assert!(page_of(&two).contains("32 % leakage-drift</text>"));
    (two.causes[0].probability, two.causes[1].probability) = (0.65, 0.20);
    assert!(page_of(&two).contains("32 % other causes</text>"));
}

#[test]
fn gaps_are_listed_from_half_a_floor_on_with_the_one_named_and_the_rest_in_a_line() {
    let mut unknown = diagnosis(Verdict::Unknown);
    unknown.places =
        (0..12).map(|k| place("arm", Block::Arms, "FR", &format!("s{k}"), 2.0)).collect();
    unknown.places.push(place("bus", Block::Bus, "all", "named", 0.2));
    unknown.places.push(place("bus", Block::Bus, "all", "quiet", 0.4));
    unknown.unexplained = Some(unknown.places[12].spot.clone());
    let (words, page) = (text(&unknown), page_of(&unknown));
    for (signal, is_there) in [("s0", true), ("s7", true), ("s8", false), ("named", true)] {
        assert_eq!(words.contains(&format!(" {signal} ")), is_there, "{signal}: {words}");
        assert_eq!(page.contains(&format!("<td>{signal}</td>")), is_there, "{signal}");
    }
    let row = words.lines().find(|line| line.starts_with("all else: 5 signals")).unwrap();
    assert!(row.ends_with("up to 2.00       50 %"), "{row}");
    assert!(page.contains("all else: 5 signals"));
    let head = words.lines().find(|line| line.starts_with("where")).unwrap();
    assert_eq!(row.chars().count(), head.chars().count(), "the columns are one below the other");
}
