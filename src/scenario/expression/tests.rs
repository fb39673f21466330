//! What pilots write, and what is wrong with it.
