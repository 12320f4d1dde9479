//! Control volumes: a run without particles, the end of one with, and the reference beside one.

pub(super) mod reference;
pub(super) mod rows;
pub(super) mod switch;
pub(super) mod uniform;
