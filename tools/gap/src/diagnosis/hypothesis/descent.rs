//! The least cost near a start: parabolas along each parameter, and along where the last round went.

use xt28_sim::effects::Parameter;

use super::curvature::Curvature;

/// Rounds after which a search that still gains is given up.
const ROUNDS: usize = 30;
/// A round that gains less than this is the last; half of it is in nats.
const GAIN_MIN: f64 = 0.02;
/// New axes that gain less than this are the last.
const VALLEY_MIN: f64 = 2.0;
/// How often new axes are taken at most.
const VALLEYS: usize = 5;
/// How much dearer it is where the new axes are taken from; the drained cylinder of one sample more or less
/// costs one or two.
const RISE: f64 = 30.0;
/// Furthest that a parabola is believed, in steps.
const REACH: f64 = 4.0;

/// Where a search ended.
#[derive(Clone, Debug)]
pub(super) struct End {
    /// What it costs there.
    pub(super) cost: f64,
    /// One value a parameter.
    pub(super) at: Vec<f64>,
}

/// Goes down `cost` from `start`, inside the parameters' ranges.
pub(super) fn descend(
    cost: &dyn Fn(&[f64]) -> f64,
    start: Vec<f64>,
    parameters: &[Parameter],
) -> End {
    let directions = axes(parameters, &start);
    let start = End { cost: cost(&start), at: start };
    powell(cost, start, directions, parameters)
}

/// Goes on down from `end` along axes that do not lean on each other, until new ones gain nothing.
///
/// Powell's own come to lean on each other in a narrow valley, and then none goes along it: a gas
/// spring of four parameters stayed 50 nats above the floor of its valley.
pub(super) fn follow_valley(
    cost: &dyn Fn(&[f64]) -> f64,
    mut end: End,
    parameters: &[Parameter],
) -> End {
    for _ in 0..VALLEYS {
        let before = end.cost;
        let bent = Curvature::about(cost, &end.at, (before, RISE), parameters);
        let mut directions = bent.axes();
        directions.iter_mut().flatten().for_each(|by| *by *= RISE.sqrt());
        end = powell(cost, end, directions, parameters);
        if before - end.cost < VALLEY_MIN {
            break;
        }
    }
    end
}

/// Rounds of parabolas along `directions`, which turn to where the last round went.
fn powell(
    cost: &dyn Fn(&[f64]) -> f64,
    mut end: End,
    mut directions: Vec<Vec<f64>>,
    parameters: &[Parameter],
) -> End {
    for _ in 0..ROUNDS {
        let before = end.clone();
        let (mut most, mut steepest) = (0.0, 0);
        for (k, direction) in directions.iter_mut().enumerate() {
            let from = end.cost;
            let moved = line(cost, &mut end, direction, parameters);
            direction.iter_mut().for_each(|by| *by *= moved.abs().clamp(0.2, 3.0));
            if from - end.cost > most {
                (most, steepest) = (from - end.cost, k);
            }
        }
        let along: Vec<f64> = end.at.iter().zip(&before.at).map(|(a, b)| a - b).collect();
        if directions.len() > 1 && along.iter().any(|by| *by != 0.0) {
            let mut far = along.clone();
            while line(cost, &mut end, &far, parameters).abs() >= REACH {
                far.iter_mut().for_each(|by| *by *= REACH);
            }
            // Powell (1964): where a round went is a better axis than the one that gave it most.
            directions[steepest] = along;
        }
        let short = |direction: &Vec<f64>| {
            direction.iter().zip(parameters).all(|(by, p)| by.abs() < 0.02 * p.tolerance)
        };
        // A round that goes nowhere has only shown that its steps were too long.
        if before.cost - end.cost < GAIN_MIN && directions.iter().all(short) {
            break;
        }
    }
    end
}

/// One step along each parameter: its tolerance, or a fifth of how far it is from neutral; half way to
/// the end of its range where that is nearer.
fn axes(parameters: &[Parameter], start: &[f64]) -> Vec<Vec<f64>> {
    let axis = |(k, (p, v)): (usize, (&Parameter, &f64))| {
        let mut axis = vec![0.0; parameters.len()];
        let step = p.tolerance.max(0.2 * (v - p.neutral).abs());
        let room = p.range.map(|end| 0.5 * (v - end).abs());
        axis[k] = room.into_iter().filter(|room| *room > 0.0).fold(step, f64::min);
        axis
    };
    parameters.iter().zip(start).enumerate().map(axis).collect()
}

/// One parabola along `direction`; how many of it the end moved.
fn line(
    cost: &dyn Fn(&[f64]) -> f64,
    end: &mut End,
    direction: &[f64],
    parameters: &[Parameter],
) -> f64 {
    let from = end.clone();
    let probe = |by: f64| {
        let along = from.at.iter().zip(direction).zip(parameters);
        let at: Vec<f64> =
            along.map(|((v, d), p)| (v + by * d).clamp(p.range[0], p.range[1])).collect();
        let cost = if at == from.at { from.cost } else { cost(&at) };
        (by, End { cost, at })
    };
    let (up, down) = (probe(1.0), probe(-1.0));
    let curvature = up.1.cost + down.1.cost - 2.0 * from.cost;
    let vertex = if curvature > 0.0 {
        (0.5 * (down.1.cost - up.1.cost) / curvature).clamp(-REACH, REACH)
    } else if up.1.cost < down.1.cost {
        REACH
    } else {
        -REACH
    };
    let mut moved = 0.0;
    for (by, probed) in [probe(vertex), up, down] {
        if probed.cost < end.cost {
            (moved, *end) = (by, probed);
        }
    }
    moved
}

#[cfg(test)]
mod tests {
    use xt28_sim::effects::find;

    use super::*;

    /// Two parameters that pull on each other, in a narrow valley.
    #[test]
    fn it_goes_down_a_narrow_valley_to_a_twentieth_of_a_nat() {
        let p = find("speed-asymmetry").unwrap().parameters;
        let cost = |v: &[f64]| {
            let (a, b) = (v[0] - 0.7, v[1] - 1.3);
            1000.0 * (a - 0.9 * b).powi(2) + 10.0 * (a + b).powi(2)
        };
        let end = descend(&cost, vec![1.0, 1.0], p);
        assert!(end.cost < 0.1, "{end:?}");
    }

    /// Four that make up for one another but for a thousandth, jolted by a nat: a gas spring's.
    #[test]
    fn it_follows_a_valley_across_its_axes() {
        let p = find("accumulator-gas").unwrap().parameters;
        let best = [0.9, 2.4e6, 0.6e-3, 1.5];
        let cost = |v: &[f64]| {
            let u: Vec<f64> = (0..4).map(|k| (v[k] - best[k]) / p[k].tolerance).collect();
            let across = u[0] + u[1] - 0.8 * u[2] + 0.3 * u[3] * u[3] + 0.6 * u[3];
            let jolt = (1e4 * across).sin();
            3e4 * across.powi(2)
                + 40.0 * (u[0] - u[1]).powi(2)
                + 20.0 * u[2].powi(2)
                + 3.0 * u[3].powi(2)
                + jolt
        };
        let rough = descend(&cost, vec![1.0, 1.5e6, 1.0e-3, 1.3], p);
        let end = follow_valley(&cost, rough.clone(), p);
        assert!(end.cost < 2.0 && rough.cost > 10.0, "{rough:?} {end:?}");
    }

    #[test]
    fn it_stays_inside_the_range() {
        let p = find("arm-delay").unwrap().parameters;
        let end = descend(&|v| (v[0] + 1.0).powi(2), vec![0.2], p);
        assert_eq!(end.at[0], p[0].range[0]);
    }
}
