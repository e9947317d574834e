//! Databases of others: one odd message does not spoil the rest, and what would be misread is said.

use xt28_dbc_model::{Database, Harm, generate};

/// A message that is well, what `odd` adds, and the statements of `end`.
fn database(odd: &str, end: &str) -> Database {
    let text = format!(
        "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_: A B\n\nBO_ 5 Well: 4 A\n \
         SG_ X : 0|16@1+ (1,0) [0|0] \"mm\" B\n SG_ Y : 16|16@1+ (1,0) [0|0] \"mm\" B\n\n{odd}\n{end}\n"
    );
    Database::parse(&text, "f.dbc").unwrap()
}

#[test]
fn an_odd_message_or_signal_is_left_out_with_its_line_and_the_rest_is_read() {
    let cases = [
        ("BO_ 2566834709 Dm1: 1785 A", "Dm1", "X", 13, "Dm1 has 1785 bytes"),
        (
            "BO_ 6 R: 8 A\n SG_ P : 0|8@1+ (1,0) [0|0] \"\" B\n SG_ Q : 8|8@1+ (0,0) [0|0] \"\" B",
            "R",
            "Q",
            15,
            "factor",
        ),
        ("BO_ 6 L: 8 A\n SG_ P : 0|0@1+ (1,0) [0|0] \"\" B", "L", "P", 14, "0 bits cannot hold it"),
        (
            "BO_ 6 N: 8 A\n SG_ P M : 0|8@1+ (1,0) [0|0] \"\" B\n SG_ Q m1M : 8|8@1+ (1,0) [0|0] \"\" B\n \
             SG_ R m2 : 16|8@1+ (1,0) [0|0] \"\" B",
            "N",
            "R",
            16,
            "several switches",
        ),
        ("BO_ 5000 I: 8 A\n SG_ P : 0|8@1+ (1,0) [0|0] \"\" B", "I", "P", 13, "more than 11 bits"),
        (
            "BO_ 3221225472 VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX\n SG_ P : 0|8@1+ (1,0) [0|0] \"\" Vector__XXX",
            "VECTOR__INDEPENDENT_SIG_MSG",
            "P",
            13,
            "more than 29 bits",
        ),
    ];
    for (odd, message, signal, line, why) in cases {
        let database = database(odd, "");
        let well = database.message_named("Well").unwrap();
        assert_eq!(well.decode(&[1, 0, 2, 0]).unwrap().len(), 2, "{odd}");
        let refused = database.why_unusable(message, signal).unwrap();
        assert_eq!(refused.line, line, "{refused}");
        assert!(refused.problem.contains(why), "{refused}");
        assert_eq!(database.why_unusable("Well", "X"), None);
        let error = generate(&database).unwrap_err().to_string();
        assert!(error.lines().any(|line| line == refused.to_string()), "{error}");
    }
}

#[test]
fn a_message_keeps_its_signals_beside_one_that_cannot_be_used() {
    let odd =
        "BO_ 6 R: 8 A\n SG_ P : 0|8@1+ (1,0) [0|0] \"\" B\n SG_ Q : 8|8@1+ (0,0) [0|0] \"\" B";
    let database = database(odd, "");
    assert_eq!(database.why_unusable("R", "P"), None);
    let values = database.message_named("R").unwrap().decode(&[7; 8]).unwrap();
    assert_eq!(
        values.iter().map(|(s, value)| (s.name.as_str(), *value)).collect::<Vec<_>>(),
        [("P", 7.0)]
    );
}

#[test]
fn a_line_of_a_comment_is_no_message() {
    let database = database("", "CM_ BO_ 5 \"see also\nBO_ 5000 Well: 8 A\nfor \\\"more\\\"\";");
    assert_eq!(database.unusable(), []);
}

/// What makes `Well.X` be misread.
fn misread(odd: &str, end: &str) -> Option<String> {
    let database = database(odd, end);
    let well = database.message_named("Well").unwrap();
    database.misread(well, well.signal("X").unwrap()).map(|problem| problem.to_string())
}

#[test]
fn only_what_changes_the_numbers_of_a_signal_is_held_against_it() {
    let one = "SG_ P : 0|16@1+ (1,0) [0|0] \"\" B";
    assert_eq!(misread("", ""), None);
    assert_eq!(misread("", "VAL_ 5 Z 0 \"off\" ;\nCM_ BO_ 9 \"gone\";"), None);
    assert_eq!(misread("", "SIG_VALTYPE_ 9 X : 1;"), None);
    assert_eq!(misread(&format!("BO_ 6 Other: 1 A\n {one}"), ""), None);
    for (odd, end, why) in [
        ("", "SIG_VALTYPE_ 5 Xx : 1;", "SIG_VALTYPE_ 5 Xx: is about nothing declared"),
        ("", "SG_MUL_VAL_ 5 Xx Y 0-1;", "SG_MUL_VAL_ 5 Xx: is about nothing declared"),
        ("BO_ 5 Again: 2 A", "", "Well: has the identifier of Again"),
        ("BO_ 6 Well: 2 A", "", "Well: has the name of another message"),
    ] {
        let found = misread(odd, end).expect(why);
        assert!(found.starts_with(why), "{found}");
    }
}

#[test]
fn a_fault_of_a_switch_is_one_of_what_it_selects_and_of_nothing_else() {
    let signals = " SG_ S M : 24|16@1+ (1,0) [0|0] \"\" B\n SG_ V m1 : 0|8@1+ (1,0) [0|0] \"\" B\n \
                   SG_ W : 8|8@1+ (1,0) [0|0] \"\" B";
    let database = database(&format!("BO_ 6 Mux: 4 A\n{signals}"), "");
    let mux = database.message_named("Mux").unwrap();
    let found = |name| database.misread(mux, mux.signal(name).unwrap());
    assert_eq!(found("W"), None);
    let problem = found("V").unwrap();
    assert_eq!((problem.place.as_str(), problem.harm), ("Mux.S", Harm::Misread));
}
