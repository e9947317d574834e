//! The two pages: nothing in a log breaks out of its text, nothing is fetched, every number is one.

mod answer;
mod frames;
mod made_up;

use answer::{diagnosis, inquiry, page, page_of};
use xt28_gap::diagnosis::details::REGIMES;
use xt28_gap::diagnosis::{Details, Diagnosis, Estimate, Spot, Verdict};
use xt28_gap::page::{headline, text};
use xt28_sim::effects::{Block, find};

#[test]
fn who_decides_reads_how_large_it_is_and_who_mends_which_gap_has_which_share() {
    let page = page(Verdict::Effect);
    let [decides, mends] = page.split("<section class=\"page\">").skip(1).collect::<Vec<_>>()[..]
    else {
        panic!("two pages")
    };
    assert!(decides.contains("delay 210 ms (190 to 230), the front axle"), "{decides}");
    assert!(
        mends.contains("<td class=\"number\">84.0</td><td class=\"number\">50 %</td>"),
        "{mends}"
    );
    assert!(mends.contains("next best: "), "{mends}");
}

#[test]
fn a_gap_is_shown_in_the_regimes_that_there_were_and_in_no_other() {
    let details = Details::new(&inquiry(), &diagnosis(Verdict::None)).unwrap();
    let row = |name: &str| details.map.iter().find(|row| row.name == name).expect("a row");
    let cell = |name: &str, regime: &str| {
        let at = REGIMES.iter().position(|other| *other == regime).expect("a column");
        row(name).cells[at]
    };
    for regime in ["extends", "retracts", "several arms", "stands"] {
        assert!(cell("arm controller FR", regime).is_some(), "{regime}");
    }
    for regime in ["hangs free", "near an end", "in a bend"] {
        assert_eq!(cell("arm controller FR", regime), None, "{regime}");
    }
    assert_eq!(cell("joint front", "extends"), None, "a joint is no arm");
}

/// Every tag of a page is closed, in order.
fn assert_balanced(page: &str) {
    let mut open: Vec<&str> = Vec::new();
    for piece in page.split('<').skip(1) {
        let tag = piece.split('>').next().unwrap();
        let name = tag.split([' ', '/']).find(|part| !part.is_empty()).unwrap_or_default();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "near <{tag}>");
        } else if !tag.ends_with('/') && !["!DOCTYPE", "meta", "br"].contains(&name) {
            open.push(name);
        }
    }
    assert_eq!(open, Vec::<&str>::new());
}

#[test]
fn a_page_is_whole_and_of_itself() {
    for verdict in [Verdict::Effect, Verdict::None, Verdict::Unknown] {
        let page = page(verdict);
        assert_balanced(&page);
        for foreign in ["<script", "http:", "https:", "url(", "@import", " src=", "NaN", "inf"] {
            assert!(!page.contains(foreign), "{foreign} in {verdict:?}");
        }
        assert!(page.contains("&lt;script&gt;"), "the name is still there to read");
    }
}

#[test]
fn a_page_says_the_verdict_and_both_causes() {
    let page = page(Verdict::Effect);
    let words = "arm-delay at the front axle or wheel FR (probability 93 %), and leakage-drift at the \
                 front axle or wheel FR (probability 71 %).";
    assert!(page.contains(words));
    assert_eq!(headline(&diagnosis(Verdict::Effect)), words);
    for part in ["noise floors", "horizon, s", "time, s", "with the causes put in"] {
        assert!(page.contains(part), "{part}");
    }
    let traces = Details::new(&inquiry(), &diagnosis(Verdict::Effect)).unwrap().traces;
    assert!(traces.iter().any(|trace| page.contains(trace.unit)), "units are on the axes");
}

#[test]
fn the_same_answer_gives_the_same_bytes() {
    assert_eq!(page(Verdict::Effect), page(Verdict::Effect));
}

#[test]
fn words_for_a_terminal_say_what_the_page_says() {
    let words = text(&diagnosis(Verdict::Effect));
    for part in [
        "arm-delay at the front axle or wheel FR (probability 93 %)",
        "wheels not told apart: the front axle (70 %), wheel FR (30 %)",
        "delay 210 ms (190 to 230)",
        "not to be told from valve-lag",
        "-20 % (60 % to 85 %) over whole runs",
        "tells arm-delay, valve-lag apart, 3.1 nats expected (odds of 22 to 1)",
        "share: of the whole machine's gap 5 s ahead",
        "steer-lag",
    ] {
        assert!(words.contains(part), "{part}: {words}");
    }
    let without = |verdict| Diagnosis { causes: Vec::new(), ..diagnosis(verdict) };
    let none = text(&without(Verdict::None));
    let nothing = "Nothing beyond ordinary tolerances in what these logs can show (probability 1 %); \
                   effects that they cannot: 1.";
    assert!(none.starts_with(nothing), "{none}");
    let all = text(&Diagnosis { not_testable: Vec::new(), ..without(Verdict::None) });
    assert!(all.starts_with("Nothing beyond ordinary tolerances (probability 1 %)."), "{all}");
    let unknown = text(&without(Verdict::Unknown));
    assert!(unknown.contains("no effect of the catalogue explains"), "{unknown}");
}

#[test]
fn where_nothing_is_likelier_than_not_the_likeliest_are_told() {
    let mut open = diagnosis(Verdict::Effect);
    open.causes.iter_mut().for_each(|cause| cause.probability *= 0.4);
    let headline = headline(&open);
    for part in ["do not tell what", "arm-delay", "(probability 37 %)", "leakage-drift"] {
        assert!(headline.contains(part), "{part}: {headline}");
    }
    let page = page_of(&open);
    assert!(page.contains("these drives do not tell which cause it is"));
}

#[test]
fn a_shrink_on_fitted_runs_is_not_said_to_be_on_others() {
    let mut fitted = diagnosis(Verdict::Effect);
    fitted.together.iter_mut().for_each(|together| together.held_out_runs.clear());
    fitted.held_out_runs.clear();
    let words = text(&fitted);
    assert!(
        words.contains("shrinks on the runs that were fitted, as none was held out"),
        "{words}"
    );
    assert!(!words.contains("not fitted") && !words.contains("held out:"), "{words}");
    let page = page_of(&fitted);
    assert!(page.contains("on the runs that were fitted, as none was held out."));
    assert!(page.contains("shrinks the gap by, on the runs that were fitted"));
    assert!(words.contains("over whole runs (on the runs that were fitted)"), "{words}");
}

#[test]
fn arms_that_all_part_colour_every_wheel() {
    let mut all = diagnosis(Verdict::Unknown);
    all.places.iter_mut().for_each(|place| place.spot.scope = "all".parse().unwrap());
    all.places[0].gap_over_noise = 200.0;
    let page = page_of(&all);
    let darkest = page.matches("#7f0000").count();
    assert!(darkest >= 7, "six wheels and the legend: {darkest}");
    assert!(headline(&all).contains("(all wheels)"), "{}", headline(&all));
}

#[test]
fn wheels_that_cannot_be_told_apart_are_not_all_listed_in_the_headline() {
    let mut open = diagnosis(Verdict::Effect);
    open.causes[0].scopes =
        ["all", "left", "FR"].map(|scope| (scope.parse().unwrap(), 0.3)).to_vec();
    open.causes[0].scope = "all".parse().unwrap();
    let words = "arm-delay at wheels that these logs do not tell apart, all wheels foremost";
    assert!(headline(&open).starts_with(words), "{}", headline(&open));
    assert!(text(&open).contains("all wheels (30 %), the left side (30 %), wheel FR (30 %)"));
}

#[test]
fn the_likeliest_wheels_are_foremost_whichever_fit_best() {
    let mut open = diagnosis(Verdict::Effect);
    let scopes = [("front", 0.24), ("left", 0.39), ("all", 0.37)];
    open.causes[0].scopes = scopes.map(|(scope, share)| (scope.parse().unwrap(), share)).to_vec();
    assert!(headline(&open).contains("the left side foremost"), "{}", headline(&open));
    let words = text(&open);
    assert!(
        words.contains("the left side (39 %), all wheels (37 %), the front axle (24 %)"),
        "{words}"
    );
    assert!(page_of(&open).contains("at the front axle</small>"), "whose size that is");
}

#[test]
fn what_is_unknown_is_sought_where_the_objection_is() {
    let mut unknown = diagnosis(Verdict::Unknown);
    unknown.causes.clear();
    unknown.unexplained = Some(Spot {
        block: Block::Payload,
        part: "stance",
        scope: "all".parse().unwrap(),
        residual: "roll".to_owned(),
    });
    assert!(headline(&unknown).contains("foremost in roll (prob"), "{}", headline(&unknown));
    assert!(page_of(&unknown).contains("Look at what on the machine makes its roll:"));
    unknown.causes = diagnosis(Verdict::Unknown).causes;
    unknown.places[0].gap_over_noise = 62.0;
    let words = headline(&unknown);
    assert!(words.contains("the largest gap, 62 floors, is in "), "{words}");
    assert!(words.ends_with("; arm-delay fits best."), "{words}");
    unknown.places[0].gap_over_noise = 2.0;
    assert!(!headline(&unknown).contains("the largest gap"));
}

#[test]
fn a_verdict_that_is_hardly_likelier_than_another_is_hedged() {
    let mut open = diagnosis(Verdict::Unknown);
    open.causes.clear();
    (open.probability_unknown, open.probability_none) = (0.52, 0.48);
    let words = headline(&open);
    assert!(words.starts_with("Something may be the matter"), "{words}");
    let rest = "(probability 52 %), or nothing beyond ordinary tolerances (probability 48 %): these logs \
                do not tell which.";
    assert!(words.ends_with(rest), "{words}");
    (open.verdict, open.probability_unknown, open.probability_none) = (Verdict::None, 0.44, 0.56);
    open.not_testable.clear();
    let words = headline(&open);
    assert!(
        words.starts_with("Nothing beyond ordinary tolerances (probability 56 %), or some"),
        "{words}"
    );
    assert!(page_of(&open).contains("these drives do not tell which it is"));
}

#[test]
fn what_is_all_but_ruled_out_is_told_from_nothing() {
    let mut sure = diagnosis(Verdict::Effect);
    sure.causes.iter_mut().for_each(|cause| cause.probability = 0.004);
    let words = text(&sure);
    assert!(!words.contains("not to be told from"), "{words}");
    let json = serde_json::to_value(&sure).unwrap();
    assert_eq!(json["causes"][0]["class"], serde_json::json!(["arm-delay"]));
    let likely = serde_json::to_value(diagnosis(Verdict::Effect)).unwrap();
    assert_eq!(likely["causes"][0]["class"], serde_json::json!(["arm-delay", "valve-lag"]));
    assert_eq!(likely["share_of"], "machine");
}

#[test]
fn json_has_every_key_whatever_there_is_to_say() {
    let mut sound = diagnosis(Verdict::None);
    (sound.next, sound.together) = (None, None);
    let json = serde_json::to_value(&sound).unwrap();
    for key in ["next", "together"] {
        assert_eq!(json.get(key), Some(&serde_json::Value::Null), "{key}");
    }
    sound.causes[1].shrink = None;
    let json = serde_json::to_value(&sound).unwrap();
    assert!(json["causes"][0]["shrink"]["interval"].is_array(), "it was worked out");
    assert_eq!(json["causes"][1].get("shrink"), Some(&serde_json::Value::Null));
}

#[test]
fn what_was_not_asked_is_not_said_to_be_settled() {
    let mut unasked = diagnosis(Verdict::None);
    unasked.causes.clear();
    (unasked.next, unasked.looked_ahead) = (None, false);
    unasked.not_testable.clear();
    let page = page_of(&unasked);
    assert!(page.contains("Which drive would tell causes apart was not asked."));
    assert!(!page.contains("There is no gap"));
    assert!(page.contains("lock-stiffness of each arm ±2 %"), "tolerances of the arms count too");
    assert!(page.contains("or from one instant of the day on, for good"));
}

#[test]
fn a_cause_that_shrinks_nothing_is_said_to_once_on_each_page_and_in_the_notes() {
    let mut idle = diagnosis(Verdict::Effect);
    assert_eq!(idle.unshrunk(), Vec::<String>::new());
    let shrink = idle.causes[1].shrink.as_mut().unwrap();
    shrink.interval = [[0.1, 0.2], [-0.1, 0.2], [0.1, 0.3]];
    assert_eq!(idle.unshrunk(), Vec::<String>::new(), "over whole runs it does");
    idle.causes[1].shrink.as_mut().unwrap().interval[2] = [-0.2, 0.1];
    let [said] = &idle.unshrunk()[..] else { panic!("one of the two") };
    let words = "leakage-drift is named by its evidence, but putting it in by itself does not shrink the gap \
                 on the held-out runs";
    assert!(said.starts_with(words), "{said}");
    idle.notes.push(said.clone());
    assert_eq!(page_of(&idle).matches(words).count(), 2);
    assert!(text(&idle).contains(words));
    idle.verdict = Verdict::Unknown;
    assert_eq!(idle.unshrunk(), Vec::<String>::new(), "it is not stood by");
}

#[test]
fn what_reads_too_little_is_said_to_wherever_it_is_named() {
    let mut bias = diagnosis(Verdict::Effect);
    let name = find("pressure-bias").unwrap().parameters[0].name;
    bias.causes.truncate(1);
    bias.causes[0].effect = find("pressure-bias").unwrap();
    bias.causes[0].parameters = vec![Estimate { name, value: [-7.34e5, -11.4e5, -3.28e5] }];
    let size = "reads 7.3 bar too little (3.3 to 11.4)";
    let (words, page) = (text(&bias), page_of(&bias));
    assert!(words.contains(&format!("off by a constant; {size}, the front axle")), "{words}");
    assert_eq!((words.matches(size).count(), page.matches(size).count()), (2, 2));
    for said in [words, page] {
        assert!(!said.contains("too much") && !said.contains("bias_pa"), "{said}");
    }
    let json = serde_json::to_value(&bias).unwrap();
    assert_eq!(json["causes"][0]["parameters"]["bias_pa"][0], -7.34e5, "SI, for programs");
}
