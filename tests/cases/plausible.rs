//! Inputs that can be read but cannot be meant: each is told with quantity, value and the likely unit.
