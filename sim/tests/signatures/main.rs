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
use xt28_sim::effects::{Block, CATALOGUE, Effect, Parameter};
use xt28_sim::{Bodies, RapierBodies, ReducedBodies};

/// Whether a number acts where the plant does not know of it; the bus has the row that shows it.
fn beside_the_plant(effect: &Effect, p: &Parameter) -> bool {
    matches!(effect.block, Block::Sensor | Block::Bus) || effect.is_law_of_an_ecu(p)
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
        for p in effect.parameters {
            let sets = |row: &&&Row| row.values.iter().any(|(name, _)| *name == p.name);
            assert!(own.iter().any(|row| sets(&row)), "no row sets {} of {}", p.name, effect.name);
            let shows = own.iter().filter(sets).all(|row| row.shows.is_some());
            let need_not = beside_the_plant(effect, p);
            assert!(shows || need_not, "{} of {} need not show", p.name, effect.name);
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
