//! Every effect of the catalogue on the whole vehicle, one row each: the size with which it must show on the
//! signal that it is about, from its law, and what it must leave alone.

mod arms;
mod drive;
mod masses;
mod nothing;
mod row;
mod scene;
mod steering;
mod tyres;

use row::{Row, Runs};
use xt28_sim::effects::{Block, CATALOGUE, Effect};
use xt28_sim::{Bodies, RapierBodies, ReducedBodies};

/// Gains of the ECUs, which no plant has.
const OF_ECUS: [&str; 3] = ["arm-gain", "steer-gain", "rear-follower-lag"];

/// Where an effect acts that the plant does not know of; the bus has the row that shows it.
fn beside_the_plant(effect: &Effect) -> bool {
    matches!(effect.block, Block::Sensor | Block::Bus) || OF_ECUS.contains(&effect.name)
}

fn rows() -> Vec<Row> {
    [arms::rows(), steering::rows(), drive::rows(), tyres::rows(), masses::rows(), nothing::rows()]
        .concat()
}

#[test]
fn every_effect_has_a_row_and_those_of_the_plant_show() {
    let rows = rows();
    for effect in CATALOGUE {
        let own: Vec<&Row> = rows.iter().filter(|row| row.effect == effect.name).collect();
        assert!(!own.is_empty(), "{} has no row", effect.name);
        assert!(own.iter().all(|row| !row.stays.is_empty()), "{} leaves nothing", effect.name);
        let shows = own.iter().all(|row| row.shows.is_some());
        assert!(shows || beside_the_plant(effect), "{} need not show", effect.name);
        for p in effect.parameters {
            let set = own.iter().flat_map(|row| row.values).any(|(name, _)| *name == p.name);
            assert!(set, "no row sets {} of {}", p.name, effect.name);
        }
    }
    for row in &rows {
        assert!(CATALOGUE.iter().any(|effect| effect.name == row.effect), "{}", row.effect);
    }
}

#[test]
fn effects_show_by_their_laws_on_the_reference() {
    assert_all_show::<RapierBodies>();
}

#[test]
fn effects_show_by_their_laws_on_the_fast_core() {
    assert_all_show::<ReducedBodies>();
}

fn assert_all_show<B: Bodies>() {
    let mut runs = Runs::default();
    let off: Vec<String> = rows().iter().flat_map(|row| row.off::<B>(&mut runs)).collect();
    assert!(off.is_empty(), "\n{}", off.join("\n"));
}
