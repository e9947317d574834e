//! A case as a whole: the same bytes from the same seed, files that the tools read, draws that vary.

use std::collections::BTreeSet;

use xt28_gap::About;
use xt28_gap_plants::{Answer, Case, Kind, Manoeuvre, Seal};

const SECONDS: f64 = 2.0;

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_does_not() {
    let logs = |seed| Case::draw(seed, Kind::Pair).only(Manoeuvre::Mixed, SECONDS).logs().unwrap();
    assert_eq!(logs(5), logs(5));
    assert_ne!(logs(5)[0].1, logs(6)[0].1);
}

#[test]
fn a_folder_holds_what_is_needed_and_not_the_answer() {
    let folder = tempfile::tempdir().unwrap();
    let case = Case::draw(8, Kind::Single).only(Manoeuvre::Ramp, SECONDS);
    case.write(folder.path()).unwrap();
    let about = About::load(&folder.path().join("about.toml")).unwrap();
    assert_eq!(about.case, case.name());
    assert_eq!(about.dbc.as_deref(), Some("xt28-field.dbc"));
    assert_eq!(about.run.len(), 1);
    about.run[0].terrain().unwrap();
    let names: BTreeSet<String> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let wanted = ["about.toml", "run-1-ramp.log.gz", "xt28-field.dbc"];
    assert_eq!(names, wanted.map(str::to_owned).into());
}

#[test]
fn draws_cover_many_causes_and_scopes_and_say_them_in_the_answer() {
    let mut effects = BTreeSet::new();
    let mut scopes = BTreeSet::new();
    let (mut late, mut sealed) = (0, Vec::new());
    for seed in 0..300 {
        for (kind, count) in
            [(Kind::Null, 0), (Kind::Single, 1), (Kind::Pair, 2), (Kind::Unknown, 1)]
        {
            let answer = Case::draw(seed, kind).answer();
            assert_eq!(answer.truth.len(), count);
            assert_eq!(Answer::parse(&answer.text()).unwrap(), answer);
            if let [one, other] = answer.truth.as_slice() {
                assert_ne!(one.group, other.group);
            }
            for fact in &answer.truth {
                late += usize::from(fact.start_s > 0.0);
                effects.insert(fact.effect.clone());
                scopes.insert(fact.scope.clone());
            }
            sealed.push(answer.text());
        }
    }
    assert_eq!((effects.len(), scopes.len()), (48, 12));
    assert!((20..200).contains(&late), "{late}");
    let seal = Seal::on(&[1; 32], sealed.iter().map(String::as_str));
    assert!(seal.holds(&[1; 32], sealed.iter().map(String::as_str)));
    sealed.swap(0, 1);
    assert!(!seal.holds(&[1; 32], sealed.iter().map(String::as_str)));
}
