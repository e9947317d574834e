//! What a controller had summed up before a log began, which is in no log.

/// The sum between `-most` and `most` that makes the fewest `squares`: nothing, tenths of the most, then
/// halves of halves about the best, `halvings` times.
pub(super) fn best_sum(most: f64, halvings: usize, squares: impl Fn(f64) -> f64) -> f64 {
    let mut best = (squares(0.0), 0.0);
    let consider = |best: &mut (f64, f64), sum: f64| {
        let squares = squares(sum);
        if squares < best.0 {
            *best = (squares, sum);
        }
    };
    let mut step = 0.1 * most;
    for tenth in (-10..=10).map(f64::from) {
        consider(&mut best, tenth * step);
    }
    for _ in 0..halvings {
        step *= 0.5;
        let middle = best.1;
        consider(&mut best, middle - step);
        consider(&mut best, middle + step);
    }
    best.1
}
