//! Effects where a service tool would see them, one row each: the size with which an effect must show in frames or in the
//! receiver's messages, from its law, and which of them it must leave alone. Every effect that the plant does not know of
//! has a row here; the others have theirs on the vehicle.

#[path = "../drive_off/mod.rs"]
mod drive_off;
mod drives;
mod ecus;
mod recording;
mod row;
mod sensors;
mod way;

use recording::Recording;
use row::Row;
use xt28_sim::effects::{Block, CATALOGUE, Effect, Parameter};

fn beside_the_plant(effect: &Effect, p: &Parameter) -> bool {
    matches!(effect.block, Block::Sensor | Block::Bus) || effect.is_law_of_an_ecu(p)
}

fn rows() -> Vec<Row> {
    [ecus::rows(), sensors::rows(), drives::rows(), way::rows()].concat()
}

#[test]
fn every_effect_beside_the_plant_has_a_row() {
    let rows = rows();
    for effect in CATALOGUE {
        let own: Vec<&Row> = rows.iter().filter(|row| row.effect == effect.name).collect();
        assert!(own.iter().all(|row| !row.stays.is_empty()), "{} leaves nothing", effect.name);
        for p in effect.parameters.iter().filter(|p| beside_the_plant(effect, p)) {
            let set = own.iter().any(|row| row.values.contains(p.name));
            assert!(set, "no row sets {} of {}", p.name, effect.name);
        }
    }
    for row in &rows {
        assert!(CATALOGUE.iter().any(|effect| effect.name == row.effect), "{}", row.effect);
    }
}

#[test]
fn effects_show_by_their_laws_on_the_bus() {
    let nominal = Recording::of(&xt28_sim::Effects::default());
    let off: Vec<String> = rows().iter().flat_map(|row| row.off(&nominal)).collect();
    assert!(off.is_empty(), "\n{}", off.join("\n"));
}
