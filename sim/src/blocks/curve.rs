//! A rising curve that is known where it is explicit, read at any place and either way.

/// A place of a curve that is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Knot {
    pub(super) x: f64,
    pub(super) y: f64,
    /// dy/dx, positive.
    pub(super) slope: f64,
    /// d²y/dx².
    pub(super) bend: f64,
}

/// A curve through knots with their slopes and bends; beyond the last it goes on straight.
///
/// Between two knots it is the polynomial of fifth degree with what both have (Hermite's), which errs by the sixth
/// derivative times the sixth power of their distance over 46 080: where a law can only be solved for what it
/// makes, that is next to rounding, and costs a tenth of solving it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    along: Pieces,
    back: Pieces,
}

/// A function in pieces.
#[derive(Clone, Debug, PartialEq)]
struct Pieces {
    /// In their order, the last without an end.
    all: Box<[Piece]>,
    /// The first piece to look at where the way from the first to the last is cut evenly.
    begins: Box<[u16]>,
    cuts_per_x: f64,
}

/// A polynomial from somewhere on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    from: f64,
    /// Of the powers of the distance from there.
    terms: [f64; 6],
}

impl Curve {
    /// The curve through `knots`, of which there is one at least, each further on than the one before or in its place.
    pub(super) fn new(knots: &[Knot]) -> Self {
        let turned = |k: &Knot| Knot {
            x: k.y,
            y: k.x,
            slope: k.slope.recip(),
            bend: -k.bend / k.slope.powi(3),
        };
        let back: Vec<Knot> = knots.iter().map(turned).collect();
        Self { along: Pieces::new(knots), back: Pieces::new(&back) }
    }

    /// What it is at `x`, which is not before its first knot, and its slope there.
    pub(super) fn at(&self, x: f64) -> [f64; 2] {
        self.along.at(x)
    }

    /// Where it is `y`, which is not less than at its first knot.
    pub(super) fn reaches(&self, y: f64) -> f64 {
        let [x, _] = self.back.at(y);
        x
    }
}

impl Pieces {
    #[allow(clippy::cast_possible_truncation)]
    fn new(knots: &[Knot]) -> Self {
        let apart = knots.iter().zip(&knots[1..]).filter(|(from, to)| to.x > from.x);
        let straight = knots[knots.len() - 1];
        let last =
            Piece { from: straight.x, terms: [straight.y, straight.slope, 0.0, 0.0, 0.0, 0.0] };
        let all: Box<[Piece]> =
            apart.map(|(from, to)| Piece::between(from, to)).chain([last]).collect();
        let (begin, way) = (all[0].from, last.from - all[0].from);
        let cuts = all.len() as f64;
        let begins = (0..=all.len()).map(|cut| {
            let x = begin + way * (cut as f64 / cuts);
            all.partition_point(|piece| piece.from <= x).saturating_sub(1) as u16
        });
        let cuts_per_x = if way > 0.0 { cuts / way } else { 0.0 };
        Self { begins: begins.collect(), cuts_per_x, all }
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn at(&self, x: f64) -> [f64; 2] {
        let cut = ((x - self.all[0].from) * self.cuts_per_x) as usize;
        let mut piece = usize::from(self.begins[cut.min(self.begins.len() - 1)]);
        while self.all.get(piece + 1).is_some_and(|next| next.from <= x) {
            piece += 1;
        }
        self.all[piece].at(x)
    }
}

impl Piece {
    fn between(from: &Knot, to: &Knot) -> Self {
        let step = to.x - from.x;
        let (rise, half) = (from.slope * step, 0.5 * from.bend * step * step);
        // What the parabola of the first knot misses at the second: value, slope and half the bend.
        let value = to.y - from.y - rise - half;
        let tilt = to.slope * step - rise - 2.0 * half;
        let curl = 0.5 * to.bend * step * step - half;
        let third = 10.0 * value - 4.0 * tilt + curl;
        let fourth = -15.0 * value + 7.0 * tilt - 2.0 * curl;
        let fifth = 6.0 * value - 3.0 * tilt + curl;
        let cube = step.powi(3);
        let terms = [
            from.y,
            from.slope,
            0.5 * from.bend,
            third / cube,
            fourth / (cube * step),
            fifth / (cube * step * step),
        ];
        Self { from: from.x, terms }
    }

    /// Value and slope at `x`.
    fn at(&self, x: f64) -> [f64; 2] {
        let by = x - self.from;
        let [rest @ .., last] = self.terms;
        rest.iter()
            .rev()
            .fold([last, 0.0], |[value, slope], term| [value * by + term, slope * by + value])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exponential(step: f64) -> Curve {
        let knots = (0..=40).map(|k| {
            let x = step * f64::from(k);
            Knot { x, y: x.exp(), slope: x.exp(), bend: x.exp() }
        });
        Curve::new(&knots.collect::<Vec<_>>())
    }

    #[test]
    fn between_knots_it_is_the_law_either_way_and_so_is_its_slope() {
        let curve = exponential(0.05);
        for k in 0..1000 {
            let x = 2e-3 * f64::from(k);
            let [y, slope] = curve.at(x);
            assert!((y / x.exp() - 1.0).abs() < 1e-12, "{x}: {y}");
            assert!((slope / x.exp() - 1.0).abs() < 1e-9, "{x}: {slope}");
            assert!((curve.reaches(x.exp()) - x).abs() < 1e-10, "{x}");
        }
    }

    #[test]
    fn the_error_falls_with_the_sixth_power_of_the_distance_of_knots() {
        let error = |step: f64| {
            let curve = exponential(step);
            let off = |k: i32| {
                let x = 20.0 * step + step * f64::from(k) / 64.0;
                (curve.at(x)[0] / x.exp() - 1.0).abs()
            };
            (0..64).map(off).fold(0.0, f64::max)
        };
        let ratio = error(0.2) / error(0.1);
        assert!((50.0..80.0).contains(&ratio), "{ratio}");
    }

    #[test]
    fn beyond_its_last_knot_it_is_straight_and_knots_in_one_place_are_one() {
        let curve = exponential(0.05);
        let end = 2.0_f64;
        let [y, slope] = curve.at(end + 0.5);
        assert!((y - 1.5 * end.exp()).abs() < 1e-12 && (slope - end.exp()).abs() < 1e-12);
        assert!((curve.reaches(y) - end - 0.5).abs() < 1e-12);
        let one = Curve::new(&[Knot { x: 1.0, y: 2.0, slope: 3.0, bend: 4.0 }; 3]);
        assert_eq!((one.at(2.0), one.reaches(5.0)), ([5.0, 3.0], 2.0));
    }
}
