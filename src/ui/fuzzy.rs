//! Scores a few typed letters against a name. They must occur in it in this order, best at the beginning of words.

/// The score of a letter that occurs.
const HIT: u32 = 1;
/// The score of a letter at the beginning of a word.
const WORD_START: u32 = 8;
/// The score of a letter right after the one before it.
const RUN: u32 = 5;

/// Scores `letters` against `text`; `None` if they do not occur in this order. Case does not matter.
pub(super) fn score(letters: &str, text: &str) -> Option<u32> {
    let text: Vec<char> = text.chars().flat_map(char::to_lowercase).collect();
    // For each position of the text: the best score of the letters so far, with the last of them at that position.
    let mut ending: Vec<Option<u32>> = Vec::new();
    for letter in letters.chars().flat_map(char::to_lowercase) {
        let is_first = ending.is_empty();
        let mut next = vec![None; text.len()];
        let mut best_before: Option<u32> = None;
        for (at, &c) in text.iter().enumerate() {
            if c == letter {
                let starts_word = at == 0 || !text[at - 1].is_alphanumeric();
                let here = HIT + if starts_word { WORD_START } else { 0 };
                let behind =
                    at.checked_sub(1).and_then(|before| *ending.get(before)?).map(|score| score + RUN);
                let before = if is_first { Some(0) } else { best_before.max(behind) };
                next[at] = before.map(|score| score + here);
            }
            best_before = best_before.max(ending.get(at).copied().flatten());
        }
        ending = next;
    }
    if letters.is_empty() { Some(0) } else { ending.into_iter().flatten().max() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_occur_in_their_order() {
        assert!(score("fa", "flight.arm").is_some() && score("FLARM", "flight.arm").is_some());
        assert_eq!(score("af", "flight.arm"), None);
        assert_eq!(score("", "flight.arm"), Some(0));
        assert_eq!(score("x", ""), None);
    }

    #[test]
    fn beginnings_of_words_and_runs_come_first() {
        assert!(score("arm", "flight.arm") > score("arm", "alarm"));
        assert!(score("cr", "craft.reset") > score("cr", "across"));
        assert!(score("cut", "rc.cut") > score("cut", "cancel out"));
    }
}
