//! What the user probably meant by a key which the format does not know.

use super::error::listed;

/// Every table of the format with its keys.
const TABLES: [(&str, &[&str]); 8] = [
    ("", super::ROOT_KEYS),
    ("beam", super::sections::BEAM_KEYS),
    ("foundation", super::sections::FOUNDATION_KEYS),
    ("conduction", super::sections::CONDUCTION_KEYS),
    ("load", super::sections::LOAD_KEYS),
    ("load.points", super::sections::POINT_KEYS),
    ("potential", super::sections::POTENTIAL_KEYS),
    ("mesh", super::sections::MESH_KEYS),
];

/// The hint for the unknown `key` of the table at `path`.
pub(super) fn for_key(key: &str, path: &str, allowed: &[&str]) -> String {
    if let Some(name) = nearest(key, allowed.iter().copied()) {
        return format!("did you mean \"{name}\"?");
    }
    if super::ROOT_KEYS.contains(&key) {
        return format!("{key} belongs at the top of the file, before the first [table]");
    }
    let home = TABLES.iter().find(|(_, keys)| keys.contains(&key));
    match home {
        Some(("load.points", _)) => format!("{key} belongs in [[load.points]]"),
        Some((table, _)) => format!("{key} belongs in [{table}]"),
        None if path.is_empty() => format!("a scene has {}", listed(allowed)),
        None => format!("the keys here are {}", listed(allowed)),
    }
}

/// Whether the format knows a field of this dotted path.
pub(super) fn is_key(path: &str) -> bool {
    let (table, key) = path.rsplit_once('.').unwrap_or(("", path));
    let table = table.split('[').next().unwrap_or_default();
    TABLES.iter().any(|(name, keys)| *name == table && keys.contains(&key))
}

/// The candidate which `word` most resembles, when it resembles one at all.
pub(super) fn nearest<'a>(word: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    if word.chars().count() > 40 {
        return None;
    }
    let word = word.to_lowercase();
    candidates
        .filter_map(|candidate| {
            let distance = strsim::damerau_levenshtein(&word, &candidate.to_lowercase());
            let length = candidate.chars().count();
            (distance <= length.div_ceil(3) && distance < length).then_some((distance, candidate))
        })
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::super::sections::{BEAM_KEYS, FOUNDATION_KEYS};
    use super::*;

    #[test]
    fn misspellings_are_recognised() {
        for (word, meant) in
            [("stifness", "stiffness"), ("Stiffness", "stiffness"), ("exponant", "exponent"), ("gpa", "gap")]
        {
            let hint = for_key(word, "foundation", FOUNDATION_KEYS);
            assert_eq!(hint, format!("did you mean \"{meant}\"?"));
        }
    }

    #[test]
    fn keys_of_other_tables_are_sent_home() {
        assert_eq!(for_key("stiffness", "beam", BEAM_KEYS), "stiffness belongs in [foundation]");
        assert_eq!(
            for_key("mesh", "beam", BEAM_KEYS),
            "mesh belongs at the top of the file, before the first [table]"
        );
        assert_eq!(for_key("moment", "", super::super::ROOT_KEYS), "moment belongs in [[load.points]]");
    }

    #[test]
    fn strange_keys_get_the_list() {
        assert_eq!(
            for_key("colour", "foundation", FOUNDATION_KEYS),
            "the keys here are stiffness, exponent and gap"
        );
        assert_eq!(nearest("x".repeat(100_000).as_str(), ["x"].into_iter()), None);
    }
}
