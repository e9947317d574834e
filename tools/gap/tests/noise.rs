//! Readings that are noisier than floors have it: what is not told of them.

mod made_up;

use std::collections::BTreeMap;

use made_up::{series, signals, swinging};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use xt28_gap::diagnosis::{Floors, Generator, Residual, Signal, Signals, with_noise_of};
use xt28_gap::{Channel, Series};
use xt28_machine::Machine;
use xt28_sim::Effects;

/// The swinging machine with pump pressures that are off by up to this at every reading.
fn noisy(off_pa: f64) -> BTreeMap<Channel, Series> {
    let mut all = swinging();
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for channel in Channel::all() {
        if matches!(channel, Channel::PumpPressure(_)) {
            let random = std::cell::RefCell::new(&mut random);
            let read = |_| 2.0e6 + off_pa * random.borrow_mut().random_range(-1.0..1.0);
            all.insert(channel, series(read));
        }
    }
    all
}

/// Root mean square of the difference of the circuits' pressures, floors.
fn difference(signals: &Signals) -> f64 {
    let residuals = Generator::Drive.residuals(signals, &Machine::xt28(), &Effects::default());
    let is = |residual: &&Residual| residual.signal == Signal::DriveDifference;
    let values = &residuals.iter().find(is).expect("the drive has it").values;
    let finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    assert!(finite.len() > 100);
    (finite.iter().map(|v| v * v).sum::<f64>() / finite.len() as f64).sqrt()
}

#[test]
fn noise_of_a_reading_lifts_the_floor_of_what_is_made_of_it_and_no_other() {
    let machine = Machine::xt28();
    let all = noisy(2.0e6);
    let [plain] = signals(&all);
    let heard = with_noise_of(plain.clone(), &all, &machine);
    assert!(difference(&plain) > 4.0, "{}", difference(&plain));
    assert!((0.5..1.5).contains(&difference(&heard)), "{}", difference(&heard));
    assert!(heard.floors.lifted().all(|((part, _), ..)| part == "drive"));
    let remark = Floors::remark([&heard.floors].into_iter()).expect("there is something to say");
    assert!(remark.contains("difference of the circuits' pressures of drive"), "{remark}");
}

#[test]
fn ordinary_readings_leave_every_floor_as_it_is() {
    let machine = Machine::xt28();
    let all = noisy(1.0e4);
    let [plain] = signals(&all);
    let heard = with_noise_of(plain, &all, &machine);
    assert_eq!(heard.floors.lifted().count(), 0);
    assert_eq!(Floors::remark([&heard.floors].into_iter()), None);
}
