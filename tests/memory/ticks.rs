//! A step of the vehicle allocates nothing.

mod firmware;
mod logs;
mod sim;

use crate::meter::allocations;

#[test]
fn the_counter_counts() {
    let before = allocations();
    drop(std::hint::black_box(Box::new(1)));
    assert_eq!(allocations(), before + 1);
}
