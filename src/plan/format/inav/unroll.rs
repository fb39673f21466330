//! The order in which the items of a mission are flown: its jumps are carried out.

use super::super::bounds::MAX_ITEMS;
use super::{Action, Found};

/// A jump that cannot be carried out.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct BadJump {
    /// The index of the item.
    pub(super) index: usize,
    pub(super) message: String,
}

/// Returns the indices of the items in flight order, up to an RTH; at most `most` of them are places.
///
/// # Errors
///
/// Returns the first jump that has no target or no end, or that gives more places.
pub(super) fn flight_order(items: &[Found], most: usize) -> Result<Vec<usize>, BadJump> {
    // The repeats that are left of each jump that was reached.
    let mut left: Vec<Option<i32>> = vec![None; items.len()];
    let mut order = Vec::new();
    let mut last_jump = None;
    let (mut at, mut steps, mut places) = (0, 0, 0);
    while let Some(found) = items.get(at) {
        steps += 1;
        let mut next = at + 1;
        if found.item.action == Action::Jump {
            let jump = check(items, at)?;
            let repeats = left[at].unwrap_or(jump.repeats);
            // INAV counts a jump inside another one from its beginning each time.
            left[at] = (repeats > 0).then_some(repeats - 1);
            if repeats > 0 {
                last_jump = Some(at);
                next = jump.target;
            }
        }
        if next == at + 1 {
            places += usize::from(found.item.action.has_place());
            order.push(at);
        }
        if found.item.action == Action::Rth {
            break;
        }
        at = next;
        if let Some(index) = last_jump.filter(|_| places > most || steps > 2 * MAX_ITEMS) {
            let message = format!("the repeats of this JUMP give more than {most} waypoints");
            return Err(BadJump { index, message });
        }
    }
    Ok(order)
}

/// A jump that can be carried out.
struct Jump {
    target: usize,
    repeats: i32,
}

/// Returns the jump at an index.
fn check(items: &[Found], index: usize) -> Result<Jump, BadJump> {
    let item = &items[index].item;
    let fault = |message: String| Err(BadJump { index, message });
    match target(items, index) {
        None => fault(format!("the JUMP has no item {} as its target", item.p1)),
        Some(target) if target == index => fault("the JUMP is its own target".to_owned()),
        Some(_) if item.p2 < 0 => fault("the JUMP repeats without end, a plan has an end".to_owned()),
        Some(target) => Ok(Jump { target, repeats: item.p2 }),
    }
}

/// Returns the index of the target of a jump. If the items of a file are numbered through, the first number of the
/// mission is not the first of the file, and the target counts like the items.
fn target(items: &[Found], index: usize) -> Option<usize> {
    let first = items.first()?;
    let wanted = usize::try_from(items.get(index)?.item.p1).ok()?;
    let begin = if wanted >= first.label { first.label } else { first.number };
    wanted.checked_sub(begin).filter(|&target| target < items.len())
}

#[cfg(test)]
mod tests {
    use super::super::Item;
    use super::*;
    use crate::geo::LatLon;

    /// Creates a mission: `(target, repeats)` is a JUMP, `None` a WAYPOINT.
    fn items(jumps: &[Option<(i32, i32)>], label: usize) -> Vec<Found> {
        let item = |(at, jump): (usize, &Option<(i32, i32)>)| {
            let (action, (p1, p2)) = jump.map_or((Action::Waypoint, (0, 0)), |jump| (Action::Jump, jump));
            let item = Item { action, position: LatLon::new(1, 1), alt_cm: 0, p1, p2, p3: 0, flag: 0 };
            Found { item, number: at + 1, label: at + label, span: 0..0 }
        };
        jumps.iter().enumerate().map(item).collect()
    }

    fn places(jumps: &[Option<(i32, i32)>], label: usize) -> Result<Vec<usize>, String> {
        let items = items(jumps, label);
        let order =
            flight_order(&items, 30).map_err(|fault| format!("{}: {}", fault.index, fault.message))?;
        Ok(order.into_iter().filter(|&at| jumps[at].is_none()).map(|at| at + 1).collect())
    }

    #[test]
    fn jumps_are_carried_out() {
        assert_eq!(places(&[None, None, Some((1, 2)), None], 1), Ok(vec![1, 2, 1, 2, 1, 2, 4]));
        assert_eq!(places(&[None, Some((1, 0)), None], 1), Ok(vec![1, 3]));
        assert_eq!(places(&[Some((3, 1)), None, None], 1), Ok(vec![3]));
        let nested = [None, Some((1, 1)), None, Some((1, 1))];
        assert_eq!(places(&nested, 1), Ok(vec![1, 1, 3, 1, 1, 3]));
    }

    #[test]
    fn targets_count_like_the_items() {
        assert_eq!(places(&[None, None, Some((9, 1))], 8), Ok(vec![1, 2, 2]));
        assert_eq!(places(&[None, None, Some((1, 1))], 8), Ok(vec![1, 2, 1, 2]));
    }

    #[test]
    fn jumps_without_end_or_target_are_refused() {
        let say = |jump| places(&[None, None, Some(jump)], 1).unwrap_err();
        assert_eq!(say((1, -1)), "2: the JUMP repeats without end, a plan has an end");
        assert_eq!(say((4, 1)), "2: the JUMP has no item 4 as its target");
        assert_eq!(say((-1, 1)), "2: the JUMP has no item -1 as its target");
        assert_eq!(say((3, 1)), "2: the JUMP is its own target");
        assert_eq!(say((1, 15)), "2: the repeats of this JUMP give more than 30 waypoints");
        let idle = places(&[Some((2, 3)), Some((1, 30_000)), Some((1, 30_000))], 1).unwrap_err();
        assert!(idle.contains("more than 30 waypoints"), "{idle}");
    }
}
