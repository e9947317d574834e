//! The machines of `cargo xtask own-bench`: every effect there is has one.

use std::path::Path;

use xt28_machine::Machine;
use xt28_sim::effects::{CATALOGUE, Overlay};

#[test]
fn every_effect_has_a_machine_on_the_bench_that_reads_as_an_overlay() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../xtask/own_bench.toml");
    let file = std::fs::read_to_string(&path).unwrap();
    let machines: Vec<String> =
        file.split("[[effect]]").skip(1).map(|effect| format!("[[effect]]{effect}")).collect();
    for machine in &machines {
        let overlay = Overlay::parse(machine, &path).unwrap();
        overlay.effects(&Machine::xt28()).unwrap();
    }
    for effect in CATALOGUE {
        let name = format!("name = \"{}\"\n", effect.name);
        assert!(machines.iter().any(|machine| machine.contains(&name)), "no {}", effect.name);
    }
}
