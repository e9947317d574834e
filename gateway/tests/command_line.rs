//! The binary refuses what it cannot do in one line and with exit code 2.

use std::process::{Command, Output};

fn gateway(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gateway")).args(args).output().unwrap()
}

fn refusal(args: &[&str]) -> String {
    let output = gateway(args);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {stderr}");
    assert!(output.stdout.is_empty());
    assert_eq!(stderr.lines().count(), 1, "{args:?}: {stderr}");
    stderr
}

#[test]
fn an_interface_that_does_not_exist() {
    let error = refusal(&["--bus", "can99", "--policy", "hold"]);
    assert!(error.starts_with("gateway: cannot open CAN interface \"can99\""), "{error}");
}

#[test]
fn a_policy_that_does_not_exist_or_lacks_its_receiver() {
    let error = refusal(&["--bus", "can99", "--policy", "dance"]);
    assert!(error.contains("goto:X,Y,HEADING_DEG"), "{error}");
    let error = refusal(&["--bus", "can99", "--policy", "goto:25,0,0"]);
    assert!(error.contains("--gnss"), "{error}");
    let port = ["--bus", "can99", "--policy", "goto:25,0,0", "--gnss", "/no/such/port"];
    let error = refusal(&port);
    assert!(error.contains("/no/such/port"), "{error}");
}

#[test]
fn a_network_that_sees_its_goal_needs_a_receiver_at_any_rate() {
    let folder = tempfile::tempdir().unwrap();
    let example = |name: &str| format!("{}/examples/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::copy(example("imitated.safetensors"), folder.path().join("imitated.safetensors"))
        .unwrap();
    let text = std::fs::read_to_string(example("imitated.toml")).unwrap();
    let file = folder.path().join("ticked.toml");
    std::fs::write(&file, text.replace("rate = \"fix\"", "rate = 50")).unwrap();
    let policy = format!("network:{}@25,0,0", file.display());
    let error = refusal(&["--bus", "can99", "--policy", &policy]);
    assert!(error.contains("--gnss"), "{error}");
}

#[test]
fn a_machine_file_with_an_unknown_key() {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), "[masses]\narm_lb = 441.0\n").unwrap();
    let path = file.path().to_str().unwrap();
    let error = refusal(&["--bus", "can99", "--policy", "hold", "--machine", path]);
    assert!(error.contains(":2:") && error.contains("arm_lb"), "{error}");
}

/// That of a documentation's network is nobody's.
#[test]
fn an_address_of_another_machine_is_told_from_a_port_that_is_taken() {
    let error = refusal(&["--bus", "can99", "--policy", "rosbridge:192.0.2.9:9090"]);
    assert!(error.ends_with("see --policy, this machine has no such address\n"), "{error}");
    let holder = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let policy = format!("rosbridge:{}", holder.local_addr().unwrap().port());
    let error = refusal(&["--bus", "can99", "--policy", &policy]);
    assert!(error.ends_with("see --policy, is the port taken?\n"), "{error}");
}

/// Who ran it goes by the status.
#[cfg(target_os = "linux")]
#[test]
fn a_refusal_that_nobody_can_read_is_one_all_the_same() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let status = Command::new(env!("CARGO_BIN_EXE_gateway"))
        .args(["--bus", "can99", "--policy", "hold"])
        .stderr(full)
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(2));
}

#[test]
fn help_names_the_policies_and_the_exit_codes() {
    let output = gateway(&["--help"]);
    let help = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0));
    for word in ["goto:", "script:", "hold", "Exit code", "--gnss"] {
        assert!(help.contains(word), "{word}: {help}");
    }
}
