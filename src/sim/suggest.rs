//! "did you mean …?" for names in parse errors.

use crate::nearest::nearest;

/// `; did you mean NAME?` with the nearest of `names`, or nothing when none is near.
pub(crate) fn did_you_mean<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    nearest(word, names).map_or_else(String::new, |name| format!("; did you mean {name}?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_within_reach_is_suggested() {
        let names = ["gps-loss", "gps-glitch", "wind"];
        assert_eq!(did_you_mean("gps-los", names), "; did you mean gps-loss?");
        assert_eq!(did_you_mean("GPS-LSOS", names), "; did you mean gps-loss?");
        assert_eq!(did_you_mean("banana", names), "");
    }
}
