//! Databases with one thing wrong each: refused, with the place and the remedy.

use proptest::prelude::*;
use xt28_dbc_model::{Database, generate};

const GOOD: &str = r#"VERSION ""

NS_ :

BS_:

BU_: A B

BO_ 2147483905 Target: 8 A
 SG_ Stroke : 0|8@1+ (2,0) [0|510] "mm" B
 SG_ Throttle : 8|16@1- (0.1,0) [-100|100] "%" B
 SG_ Counter : 52|4@1+ (1,0) [0|15] "" B
 SG_ Crc : 56|8@1+ (1,0) [0|255] "" B

BA_DEF_ BO_ "GenMsgCycleTime" INT 0 65535;
BA_DEF_ BO_ "E2eDataId" INT 0 65535;
BA_DEF_ BO_ "AliveCounter" INT 0 1;
BA_DEF_DEF_ "GenMsgCycleTime" 0;
BA_DEF_DEF_ "E2eDataId" 0;
BA_DEF_DEF_ "AliveCounter" 0;
BA_ "GenMsgCycleTime" BO_ 2147483905 10;
BA_ "E2eDataId" BO_ 2147483905 16423;
BA_ "AliveCounter" BO_ 2147483905 1;
"#;

fn refusal(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    let database = Database::parse(&GOOD.replacen(from, to, 1), "bad.dbc").unwrap();
    generate(&database).unwrap_err().to_string()
}

#[test]
fn the_good_one_is_good() {
    let database = Database::parse(GOOD, "good.dbc").unwrap();
    assert_eq!(database.problems(), []);
    let source = generate(&database).unwrap();
    assert!(source.contains("pub stroke_mm: f64"), "{source}");
    assert!(source.contains("pub throttle_percent: f64"), "{source}");
    assert!(source.contains("pub counter: u8"), "{source}");
}

#[test]
fn each_fault_is_named_with_its_remedy() {
    let cases = [
        ("8|16@1-", "4|16@1-", "Target.Throttle: shares bits with Stroke; move one"),
        ("52|4@1+", "60|8@1+", "Target.Counter: reaches beyond the 8 bytes of the frame"),
        ("[0|510]", "[0|512]", "Target.Stroke: has range 0 to 512, but its bits hold 0 to 510"),
        (
            "[-100|100]",
            "[100|-100]",
            "Target.Throttle: has its least value 100 above its greatest -100",
        ),
        (
            "BO_ 2147483905 10;",
            "BO_ 2147483905 0;",
            "Target: has no cycle time; set GenMsgCycleTime",
        ),
        (
            "SG_ Counter",
            "SG_ Count",
            "Target: is to have an alive counter; add a 4-bit signal Counter",
        ),
        (
            "SG_ Crc : 56|8",
            "SG_ Crc : 48|4",
            "Target: has a data ID but no CRC; add an 8-bit signal Crc in byte 7",
        ),
        ("SG_ Throttle", "SG_ Stroke", "Target.Stroke: has the name of another signal; rename one"),
    ];
    for (from, to, expected) in cases {
        let error = refusal(from, to);
        assert!(error.lines().any(|line| line == expected), "{from} -> {to}: {error}");
    }
}

/// What becomes of a database of one message `M` with these signals and statements.
fn outcome(signals: &str, statements: &str) -> Result<String, String> {
    let text = format!(
        "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_: A B\n\nBO_ 5 M: 8 A\n{signals}\n\n\
         BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;\nBA_DEF_ BO_ \"E2eDataId\" INT 0 65535;\n\
         BA_DEF_DEF_ \"GenMsgCycleTime\" 10;\nBA_DEF_DEF_ \"E2eDataId\" 0;\n{statements}\n"
    );
    let database = Database::parse(&text, "m.dbc").map_err(|error| error.to_string())?;
    generate(&database).map_err(|error| error.to_string())
}

#[test]
fn what_would_pass_in_silence_is_refused() {
    let x = " SG_ X : 0|8@1+ (1,0) [0|255] \"\" B";
    let crc = format!("{x}\n SG_ Crc : 56|8@1+ (1,0) [0|255] \"\" B");
    let float = " SG_ X : 0|32@1- (1,0) [-9|9] \"V\" B";
    let ring = " SG_ P m0M : 0|8@1+ (1,0) [0|255] \"\" B\n SG_ Q m0M : 8|8@1+ (1,0) [0|255] \"\" B";
    let nested = " SG_ P M : 0|8@1+ (1,0) [0|255] \"\" B\n SG_ Q m1M : 8|8@1+ (1,0) [0|255] \"\" B\n \
                  SG_ R m2 : 16|8@1+ (1,0) [0|255] \"\" B";
    let cases = [
        (float, "SIG_VALTYPE_ 5 Xx : 1;", "SIG_VALTYPE_ 5 Xx: is about nothing declared"),
        (x, "VAL_ 6 X 0 \"off\" ;", "VAL_ 6 X: is about nothing declared"),
        (x, "CM_ BO_ 6 \"gone\";", "CM_ 6: is about nothing declared"),
        (x, "VAL_ 5 X 0 \"off\" 256 \"far\" ;", "M.X: names 256 \"far\", which is out of"),
        (x, "VAL_ 5 X 0 \"off\" 0 \"on\" ;", "M.X: names 0 twice"),
        (x, "VAL_ 5 X 0 \"2D fix\" ;", "M.X: \"2DFix\": cannot be a name in Rust"),
        (x, "VAL_ 5 X 0 \"safe stop\" 1 \"safe-Stop\" ;", "M.X: \"SafeStop\": comes twice"),
        (&crc, "", "M: has a CRC that nothing checks"),
        (&crc, "BA_ \"E2eDataId\" BO_ 5 65536;", "M: has a CRC that nothing checks"),
        (ring, "SG_MUL_VAL_ 5 P Q 0-0;\nSG_MUL_VAL_ 5 Q P 0-0;", "M.P: is multiplexed by itself"),
        (nested, "", "m.dbc:11: M.Q has several switches to go by"),
        (&x.replace("0|8", "0|54"), "", "M.X: has 54 bits, and numbers are exact to 53"),
        (&x.replace("SG_ X", "SG_ Type"), "", "M: \"type\": cannot be a name in Rust"),
        (&x.replace("\"\"", "\"l/min\""), "", "M: \"x_l/min\": cannot be a name in Rust"),
        (&x.replace("0|8", "-3|8"), "", "m.dbc:10: Invalid Uint value: '-3'"),
    ];
    for (signals, statements, expected) in cases {
        let error = outcome(signals, statements).expect_err(expected);
        assert!(error.lines().any(|line| line.starts_with(expected)), "{expected}: {error}");
    }
}

#[test]
fn a_named_value_that_no_byte_holds_is_refused() {
    let error =
        outcome(" SG_ X : 0|16@1+ (1,0) [0|999] \"\" B", "VAL_ 5 X 0 \"off\" 300 \"far\" ;");
    assert!(error.unwrap_err().starts_with("M.X: a named value outside 0 to 255"));
}

#[test]
fn an_identifier_or_length_without_a_frame_is_refused() {
    let plain = |from: &str, to: &str| Database::parse(&GOOD.replace(from, to), "bad.dbc");
    for id in ["4096", "70000"] {
        let error = generate(&plain("2147483905", id).unwrap()).unwrap_err().to_string();
        assert!(error.starts_with(&format!("bad.dbc:9: Target: {id} has more than 11")), "{error}");
    }
    let error = generate(&plain("2147483905", "2684354561").unwrap()).unwrap_err().to_string();
    assert!(error.contains("2684354561 has more than 29 bits"), "{error}");
    let error = plain("BO_ 2147483905 Target", "BO_ 4294967296 Target").unwrap_err();
    assert_eq!(error.line, 9, "{error}");
    let long = plain("Target: 8 A", "Target: 64 A").unwrap();
    let error = generate(&long).unwrap_err().to_string();
    assert!(error.contains("Target: has 64 bytes; a classic CAN frame has up to 8"), "{error}");
}

#[test]
fn a_comment_of_several_lines_becomes_one() {
    let x = " SG_ X : 0|8@1+ (1,0) [0|255] \"\" B";
    let source = outcome(x, "CM_ SG_ 5 X \"one\ntwo\";").unwrap();
    assert!(source.contains("/// one two"), "{source}");
}

#[test]
fn two_messages_may_not_share_an_identifier() {
    let twice = GOOD.replacen(
        "BA_DEF_ BO_ \"Gen",
        "BO_ 2147483905 Again: 8 A\n SG_ X : 0|8@1+ (1,0) [0|255] \"\" B\n\nBA_DEF_ BO_ \"Gen",
        1,
    );
    let database = Database::parse(&twice, "bad.dbc").unwrap();
    let error = generate(&database).unwrap_err().to_string();
    assert!(error.contains("Again: has the identifier of Target"), "{error}");
}

#[test]
fn multiplexing_is_refused_loudly_by_the_generator_and_read_at_run_time() {
    let text = GOOD.replacen("SG_ Stroke :", "SG_ Stroke M :", 1).replacen(
        "SG_ Throttle :",
        "SG_ Throttle m3 :",
        1,
    );
    let database = Database::parse(&text, "mux.dbc").unwrap();
    let error = generate(&database).unwrap_err().to_string();
    assert!(error.starts_with("Target.Throttle: a multiplexed signal; read"), "{error}");
    let message = database.message_named("Target").unwrap();
    assert_eq!(message.decode(&[3, 0, 0, 0, 0, 0, 0, 0]).unwrap().len(), 4);
    assert_eq!(message.decode(&[4, 0, 0, 0, 0, 0, 0, 0]).unwrap().len(), 3);
}

#[test]
fn a_syntax_error_is_named_with_file_and_line() {
    let line = GOOD.lines().position(|l| l.contains("Throttle")).unwrap() + 1;
    let error = Database::parse(&GOOD.replacen("8|16@1-", "8|16@", 1), "bad.dbc").unwrap_err();
    assert_eq!((error.file.as_str(), error.line), ("bad.dbc", line), "{error}");
    assert!(!error.to_string().contains('\n'), "{error}");
}

#[test]
fn a_factor_of_zero_is_refused_with_its_line() {
    let error = refusal("(2,0)", "(0,0)");
    assert!(error.starts_with("bad.dbc:10: Target.Stroke: factor"), "{error}");
}

proptest! {
    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,200}") {
        let _ = Database::parse(&text, "any.dbc");
    }

    #[test]
    fn a_damaged_database_never_panics(at in 0_usize..600, by in "\\PC{0,4}", cut in 0_usize..8) {
        let at = at.min(GOOD.len());
        let end = (at + cut).min(GOOD.len());
        let text = format!("{}{}{}", &GOOD[..at], by, &GOOD[end..]);
        if let Ok(database) = Database::parse(&text, "any.dbc") {
            let _ = generate(&database);
            for message in database.messages() {
                let _ = message.decode(&[0xA5; 8]);
            }
        }
    }

    #[test]
    fn any_frame_is_decoded_or_refused(data in prop::collection::vec(any::<u8>(), 0..12)) {
        let database = Database::parse(GOOD, "good.dbc").unwrap();
        let message = database.message_named("Target").unwrap();
        if let Ok(values) = message.decode(&data) {
            let named: Vec<(&str, f64)> = values.iter().map(|(s, v)| (s.name.as_str(), *v)).collect();
            prop_assert_eq!(message.decode(&message.encode(&named).unwrap()).unwrap(), values);
        }
    }
}
