//! Names of effects as others spell them: `ArmDelay` is `arm-delay`.

/// The name in the spelling of the catalogue: lower case, words joined by hyphens.
pub(super) fn kebab(name: &str) -> String {
    let mut kebab = String::with_capacity(name.len() + 4);
    for (i, letter) in name.chars().enumerate() {
        if letter.is_uppercase() && i > 0 && !kebab.ends_with('-') {
            kebab.push('-');
        }
        kebab.extend(letter.to_lowercase().map(|c| if c == '_' || c == ' ' { '-' } else { c }));
    }
    kebab
}

/// The one of `names` that is nearest to `name`, if one is near.
pub(super) fn nearest<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let near = |other: &'a str| (distance(name, other), other);
    names.map(near).min().filter(|(d, _)| *d <= 3).map(|(_, other)| other)
}

/// Letters to insert, remove or replace (Levenshtein).
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use xt28_sim::effects::CATALOGUE;

    use super::*;

    #[test]
    fn every_effect_is_found_by_its_other_spelling() {
        for effect in CATALOGUE {
            let words = effect.name.split('-');
            let camel: String = words.map(|w| w[..1].to_uppercase() + &w[1..]).collect();
            assert_eq!(kebab(&camel), effect.name);
            assert_eq!(kebab(effect.name), effect.name);
        }
    }

    #[test]
    fn a_slip_of_the_pen_is_recognised_and_nonsense_is_not() {
        let nearest = |name: &str| nearest(name, CATALOGUE.iter().map(|effect| effect.name));
        assert_eq!(nearest("arm-dealy"), Some("arm-delay"));
        assert_eq!(nearest("rolling-resistence"), Some("rolling-resistance"));
        assert_eq!(nearest("haunted-gearbox"), None);
        assert_eq!(distance("kitten", "sitting"), 3);
    }
}
