//! Why a quantity of a plan has its value.

use serde::Serialize;

/// Why a quantity has its value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reason {
    pub quantity: String,
    pub value: String,
    pub why: String,
}
