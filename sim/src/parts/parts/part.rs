//! One rigid body's mass, and bodies joined to one.

/// A rigid body's mass; axes and origin as its owner says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Part {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Centre of mass, m.
    pub com_m: [f64; 3],
    /// Moments of inertia about the centre of mass, along the part's axes, kg m².
    pub inertia_kg_m2: [f64; 3],
    /// Products of inertia about the centre of mass, off the diagonal of the tensor: xy, xz, yz,
    /// kg m². Zero for every part of the nominal machine; a load off the middle has some.
    pub products_kg_m2: [f64; 3],
}

impl Part {
    /// A solid box of `size_m` about its centre of mass.
    #[must_use]
    pub fn solid_box(mass_kg: f64, com_m: [f64; 3], size_m: [f64; 3]) -> Self {
        let (m, [x, y, z]) = (mass_kg / 12.0, size_m);
        let inertia_kg_m2 = [m * (y * y + z * z), m * (x * x + z * z), m * (x * x + y * y)];
        Self { mass_kg, com_m, inertia_kg_m2, products_kg_m2: [0.0; 3] }
    }

    /// This part and another, rigidly joined (parallel axis theorem).
    ///
    /// Joining nothing gives this part, bit for bit.
    #[must_use]
    pub fn joined(self, other: Self) -> Self {
        if other.mass_kg == 0.0 {
            return self;
        }
        let mass_kg = self.mass_kg + other.mass_kg;
        let share = other.mass_kg / mass_kg;
        let apart: [f64; 3] = core::array::from_fn(|i| other.com_m[i] - self.com_m[i]);
        let [x, y, z] = apart;
        let reduced_kg = self.mass_kg * share;
        let squares = [y * y + z * z, x * x + z * z, x * x + y * y];
        let cross = [x * y, x * z, y * z];
        let sum = |own: [f64; 3], others: [f64; 3], apart: [f64; 3]| {
            core::array::from_fn(|i| own[i] + others[i] + reduced_kg * apart[i])
        };
        Self {
            mass_kg,
            com_m: core::array::from_fn(|i| self.com_m[i] + share * apart[i]),
            inertia_kg_m2: sum(self.inertia_kg_m2, other.inertia_kg_m2, squares),
            products_kg_m2: sum(self.products_kg_m2, other.products_kg_m2, cross.map(|c| -c)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_halves_of_a_box_make_the_box() {
        let whole = Part::solid_box(12.0, [1.0, 2.0, 3.0], [4.0, 1.0, 2.0]);
        let half = |x: f64| Part::solid_box(6.0, [x, 2.0, 3.0], [2.0, 1.0, 2.0]);
        let joined = half(0.0).joined(half(2.0));
        assert!((joined.mass_kg - 12.0).abs() < 1e-12 && joined.com_m == whole.com_m);
        for i in 0..3 {
            assert!((joined.inertia_kg_m2[i] - whole.inertia_kg_m2[i]).abs() < 1e-12);
            assert!(joined.products_kg_m2[i].abs() < 1e-12);
        }
    }

    /// Two point masses, 2 and 1 kg, 3 m apart along (1, 1, 0)/sqrt 2: reduced mass 2/3 kg.
    #[test]
    fn points_off_the_axes_have_a_product_of_inertia() {
        let d = 3.0 / 2.0_f64.sqrt();
        let point = |mass_kg, com_m| Part { mass_kg, com_m, ..Part::default() };
        let joined = point(2.0, [0.0; 3]).joined(point(1.0, [d, d, 0.0]));
        assert!((joined.inertia_kg_m2[2] - 6.0).abs() < 1e-12);
        assert!((joined.products_kg_m2[0] + 3.0).abs() < 1e-12);
        assert!((joined.com_m[0] - d / 3.0).abs() < 1e-12);
    }
}
