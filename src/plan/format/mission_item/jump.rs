//! DO_JUMP: the order in which items are flown.

use std::collections::BTreeMap;

use super::mapping::Fault;
use super::{MissionItem, amount};
use crate::plan::format::bounds::MAX_ITEMS;
use crate::plan::format::loss::{Finding, Severity};

/// The command of a jump.
const JUMP: u16 = 177;
/// The most items that are flown or jump, one after another.
const MAX_STEPS: usize = 2 * MAX_ITEMS;

/// The order of the items.
#[derive(Debug, Default)]
pub(super) struct Order {
    /// The indices of the items without the jumps.
    pub(super) indices: Vec<usize>,
    /// The first jump back, if there is one.
    pub(super) jump: Option<usize>,
    pub(super) findings: Vec<Finding>,
}

/// Follows the jumps. A jump counts its repeats over the whole mission.
///
/// # Errors
///
/// Returns the first jump that has no end or no target.
pub(super) fn order(items: &[MissionItem]) -> Result<Order, Fault> {
    let mut order = Order::default();
    let mut left: Vec<Option<usize>> = vec![None; items.len()];
    // Of items with the same number the first one is the target.
    let targets: BTreeMap<usize, usize> =
        items.iter().enumerate().rev().map(|(at, item)| (item.number, at)).collect();
    let mut at = 0;
    let mut steps = 0;
    while let Some(item) = items.get(at) {
        steps += 1;
        if item.command != JUMP {
            order.indices.push(at);
            at += 1;
            continue;
        }
        let fault = |message: String| Fault { item: at, message, hint: "remove the jump".to_owned() };
        let repeats = item.param(2);
        if repeats < 0.0 {
            return Err(fault(format!("the jump of item {} repeats without an end", item.number)));
        }
        if steps > MAX_STEPS {
            return Err(fault(format!("the jumps give more than {MAX_ITEMS} items")));
        }
        let number = Some(item.param(1)).filter(|number| number.fract() == 0.0 && *number >= 0.0);
        // Saturates: no item has such a number.
        let target = number.and_then(|number| targets.get(&(number as usize)).copied());
        let target = target.ok_or_else(|| {
            fault(format!(
                "the jump of item {} goes to item {}, which is not there",
                item.number,
                item.param(1)
            ))
        })?;
        // Saturates: a larger count ends at the limit of the steps.
        let repeats_left = left[at].get_or_insert(repeats.round() as usize);
        if *repeats_left > 0 {
            *repeats_left -= 1;
            order.jump.get_or_insert(at);
            at = target;
        } else {
            at += 1;
        }
    }
    for (at, item) in items.iter().enumerate().filter(|(_, item)| item.command == JUMP) {
        let why = "a plan has no jumps: the items are there as often as they are flown";
        let mut finding = Finding::new(Severity::Changed, "jump", why).item(item.number);
        finding.place = item.place.clone();
        let from = format!(
            "to item {}, {}",
            item.param(1),
            amount(item.param(2), if item.param(2) == 1.0 { "time" } else { "times" })
        );
        order
            .findings
            .push(finding.values(from, if left[at].is_some() { "unrolled" } else { "never reached" }));
    }
    Ok(order)
}
