//! The shared part of several completions.

/// Returns the longest prefix that all candidates share, ignoring case, spelled as in the first one.
pub(super) fn common_prefix<'a>(mut candidates: impl Iterator<Item = &'a str>) -> &'a str {
    let Some(mut common) = candidates.next() else { return "" };
    for candidate in candidates {
        let shared = common
            .char_indices()
            .zip(candidate.chars())
            .find(|((_, a), b)| !a.eq_ignore_ascii_case(b))
            .map_or(common.len().min(candidate.len()), |((at, _), _)| at);
        common = common.get(..shared).unwrap_or(common);
    }
    common
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_one_says_how_it_is_written() {
        assert_eq!(common_prefix(["Set a", "set b"].into_iter()), "Set ");
        assert_eq!(common_prefix(["end"].into_iter()), "end");
        assert_eq!(common_prefix(["end", "endless"].into_iter()), "end");
        assert_eq!(common_prefix(std::iter::empty()), "");
    }
}
