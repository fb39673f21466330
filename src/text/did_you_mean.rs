//! Finds the word that a user probably meant.

/// Returns the word of `candidates` that `typed` most likely means, if one is close. Close means at most one
/// slip (a wrong, missing, extra or swapped character) per three characters, ignoring case.
pub fn closest<'a>(typed: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let typed: Vec<char> = typed.chars().take(64).flat_map(char::to_lowercase).collect();
    let allowed = (typed.len() / 3).max(1);
    // The number of slips is at least the difference of the lengths.
    let is_near = |word: &&str| word.chars().count().abs_diff(typed.len()) <= allowed;
    candidates
        .into_iter()
        .filter(is_near)
        .map(|word| (slips(&typed, &word.chars().flat_map(char::to_lowercase).collect::<Vec<_>>()), word))
        .filter(|&(distance, word)| distance <= allowed && distance < word.chars().count())
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, word)| word)
}

/// Returns `; did you mean WORD?` with the closest of `candidates`, or an empty string if none is close.
pub fn suffix<'a>(typed: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    closest(typed, candidates).map_or_else(String::new, |word| format!("; did you mean {word}?"))
}

/// Returns `did you mean FLYOVER? allowed: FLYOVER, FLYBY, …` with the allowed words.
pub fn hint<'a>(typed: &str, words: impl IntoIterator<Item = &'a str>) -> String {
    let words: Vec<&str> = words.into_iter().collect();
    let guess = closest(typed, words.iter().copied());
    let guess = guess.map_or_else(String::new, |word| format!("did you mean {word}? "));
    format!("{guess}allowed: {}", words.join(", "))
}

/// Returns the optimal string alignment distance: insertions, deletions, substitutions and swaps of
/// neighbours.
fn slips(a: &[char], b: &[char]) -> usize {
    let mut before_previous = vec![0; b.len() + 1];
    let mut previous: Vec<usize> = (0..=b.len()).collect();
    for (i, &ca) in a.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, &cb) in b.iter().enumerate() {
            let substituted = previous[j] + usize::from(ca != cb);
            let mut best = substituted.min(previous[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && ca == b[j - 1] && a[i - 1] == cb {
                best = best.min(before_previous[j - 1] + 1);
            }
            row.push(best);
        }
        before_previous = std::mem::replace(&mut previous, row);
    }
    previous[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_slip_in_three_characters_is_close() {
        let types = ["FLYOVER", "FLYBY", "HOLD", "LAND"];
        assert_eq!(closest("FLYOVR", types), Some("FLYOVER"));
        assert_eq!(closest("flyvoer", types), Some("FLYOVER"));
        assert_eq!(closest("HODL", types), Some("HOLD"));
        assert_eq!(closest("LOITER", types), None);
        assert_eq!(closest("", types), None);
    }

    #[test]
    fn a_swap_is_one_slip() {
        assert_eq!(slips(&['a', 'b'], &['b', 'a']), 1);
        assert_eq!(slips(&['a', 'b', 'c'], &['a', 'c']), 1);
        assert_eq!(slips(&[], &['a']), 1);
    }
}
