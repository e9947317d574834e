//! Databases and mappings with one thing wrong each, where a log would be misread: refused, with the
//! place. What is wrong elsewhere in them is of no matter.

mod field;

use std::path::Path;

use field::{DBC, POS_FRONT, decode, log, read, refused};
use xt28_gap::{Channel, Decoder, FieldLog, Mapping};
use xt28_machine::Wheel;

fn odd(from: &str, to: &str) -> String {
    assert!(DBC.contains(from), "{from}");
    DBC.replacen(from, to, 1)
}

#[test]
fn a_signal_that_would_be_misread_is_refused_by_name() {
    let fl = "SG_ FL : 16|16@1+ (1,0) [0|0] \"mm\" gateway\n\nBO_ 2566791200";
    let attribute = "BA_DEF_ BO_";
    for (from, to, wanted) in [
        (
            fl,
            fl.replace("16|16", "24|16"),
            "PosFront.FL: reaches beyond the 4 bytes of the frame; ",
        ),
        (
            fl,
            fl.replace("[0|0]", "[9|1]"),
            "PosFront.FL: has its least value 9 above its greatest 1; ",
        ),
        (fl, fl.replace("16|16", "0|54"), "PosFront.FL: reaches beyond the 4 bytes of the frame; "),
        (
            "PosMidRear: 8 SMS\n SG_ MR : 0|16@1+",
            "PosMidRear: 8 SMS\n SG_ MR : 0|54@1+".to_owned(),
            "PosMidRear.MR: has 54 bits, and numbers are exact to 53; ",
        ),
        (
            "BO_ 2566787110 PosFront",
            "BO_ 2566787109 PosFront".to_owned(),
            "PosFront: has the identifier of PosMidRear; ",
        ),
        (
            attribute,
            format!("SIG_VALTYPE_ 2566787110 Fr : 1;\n{attribute}"),
            "SIG_VALTYPE_ 2566787110 Fr: is about nothing declared; ",
        ),
    ] {
        let error = refused(&odd(from, &to));
        assert!(error.contains(wanted), "{error}");
        assert!(error.starts_with("field.dbc: ") && error.contains("; so "), "{error}");
    }
}

#[test]
fn a_multiplexed_signal_whose_switch_lies_beyond_the_frame_is_refused() {
    let muxed = "BO_ 2566787110 PosFront: 4 SMS
 SG_ S M : 32|8@1+ (1,0) [0|0] \"\" gateway
 SG_ FR m0 : 0|16@1+ (1,0) [0|0] \"mm\" gateway
 SG_ FL m0 : 16|16@1+ (1,0) [0|0] \"mm\" gateway
";
    let error = refused(&odd(POS_FRONT, muxed));
    assert!(error.contains("PosFront.S: reaches beyond the 4 bytes"), "{error}");
}

#[test]
fn a_signal_that_is_unusable_is_refused_only_where_it_is_mapped() {
    let zero = " SG_ FR : 0|16@1+ (1,0) [0|0] \"mm\" gateway\n SG_ FL";
    let error = refused(&odd(zero, &zero.replace("(1,0)", "(0,0)")));
    assert!(error.starts_with("field.dbc:30: PosFront.FR: factor and offset"), "{error}");
    let error = refused(&odd("PosFront: 4 SMS", "PosFront: 1785 SMS"));
    assert!(error.starts_with("field.dbc:29: PosFront has 1785 bytes"), "{error}");
}

#[test]
fn what_is_wrong_with_messages_that_carry_no_channel_is_of_no_matter() {
    let rest = "BO_ 2566834709 Dm1: 1785 SMS\n SG_ Spn : 0|19@1+ (1,0) [0|0] \"\" gateway\n\n\
                BO_ 6 Odd: 1 SMS\n SG_ Far : 8|8@1+ (1,0) [0|0] \"\" gateway\n \
                SG_ None : 0|8@1+ (0,0) [0|0] \"\" gateway\n\n\
                BO_ 5000 Wide: 8 SMS\n SG_ Time : 0|64@1+ (1,0) [9|1] \"\" gateway\n\n\
                BA_DEF_ BO_";
    let dbc = odd("BA_DEF_ BO_", rest) + "CM_ BO_ 6 \"see\nBO_ 5000 PosFront: 4 SMS\";\n";
    let log_of = |dbc: &str| {
        let decoder = decode(dbc).unwrap();
        FieldLog::read(log().as_bytes(), "a.log", &decoder, false).unwrap()
    };
    assert_eq!(log_of(&dbc).all_series(), read(&log()).unwrap().all_series());
}

#[test]
fn a_database_in_windows_1252_or_with_a_mark_before_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("field.dbc");
    let text = DBC.replace("\"deg\"", "\"°\"") + "CM_ \"Prüfstand\";\n";
    let latin: Vec<u8> = text.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect();
    for bytes in [latin, text.clone().into_bytes(), format!("\u{FEFF}{text}").into_bytes()] {
        std::fs::write(&path, bytes).unwrap();
        let decoder = Decoder::load(&path, &Mapping::default()).unwrap();
        let log = FieldLog::read(log().as_bytes(), "a.log", &decoder, false).unwrap();
        let pitch = log.series(Channel::Pitch).unwrap().at(0.5).unwrap();
        assert!((pitch - (-0.06_f64).to_radians()).abs() < 1e-12);
    }
}

#[test]
fn a_signal_that_counts_from_another_zero_and_the_other_way_is_read_by_a_mapping() {
    let source = "{ signal = \"Attitude.Pitch\", unit = \"deg\", scale = -1, offset = 2.5 }";
    let mapping = format!("[signals]\n\"attitude.pitch\" = {source}\n");
    let mapping = Mapping::parse(&mapping, Path::new("m.toml")).unwrap();
    let decoder = Decoder::parse(DBC, Path::new("field.dbc"), &mapping).unwrap();
    let log = FieldLog::read(log().as_bytes(), "a.log", &decoder, false).unwrap();
    let pitch = log.series(Channel::Pitch).unwrap().at(0.5).unwrap();
    assert!((pitch - 2.56_f64.to_radians()).abs() < 1e-12, "{pitch}");
}

#[test]
fn a_name_in_a_mapping_file_that_the_database_has_not_is_refused_with_its_line() {
    let decode = |mapping: &str| {
        let mapping = Mapping::parse(mapping, Path::new("m.toml")).unwrap();
        Decoder::parse(DBC, Path::new("field.dbc"), &mapping)
    };
    // Nobody needs these two, and nobody asked for them.
    let decoder = decode("[signals]\n").unwrap();
    assert!(decoder.message_of(Channel::East).is_none());
    for (source, wanted) in [
        ("PosFront.Fr", "signal `Fr` in message `PosFront`"),
        ("FrontPos.FR", "message `FrontPos`"),
    ] {
        for channel in ["position.east", "stroke.FR"] {
            let error =
                decode(&format!("[signals]\n\n\"{channel}\" = \"{source}\"\n")).unwrap_err();
            let error = error.to_string();
            let wanted = format!(
                "m.toml:3: {channel} should come from {wanted}, and there is none in field.dbc; "
            );
            assert!(error.starts_with(&wanted), "{error}");
        }
    }
    // The same bits under another name.
    let front = " SG_ FL : 16|16@1+ (1,0) [0|0] \"mm\" gateway\n";
    let dbc = DBC.replace(front, &format!("{front}{}", front.replace("FL : 16", "East : 0")));
    let mapping = "[signals]\n\"position.east\" = \"PosFront.East\"\n";
    let mapping = Mapping::parse(mapping, Path::new("m.toml")).unwrap();
    let decoder = Decoder::parse(&dbc, Path::new("field.dbc"), &mapping).unwrap();
    let log = FieldLog::read(log().as_bytes(), "a.log", &decoder, false).unwrap();
    assert_eq!(log.series(Channel::East), log.series(Channel::Stroke(Wheel::Fr)));
}
