//! Operations by the stretch of a kernel in which they stand.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Mul};

/// Operations of floating point, and of integers and truth values.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Operations {
    pub floating: f64,
    pub integer: f64,
}

impl Operations {
    pub fn all(self) -> f64 {
        self.floating + self.integer
    }
}

impl Add for Operations {
    type Output = Operations;

    fn add(self, other: Operations) -> Operations {
        Operations { floating: self.floating + other.floating, integer: self.integer + other.integer }
    }
}

impl AddAssign for Operations {
    fn add_assign(&mut self, other: Operations) {
        *self = *self + other;
    }
}

impl Sum for Operations {
    fn sum<I: Iterator<Item = Operations>>(all: I) -> Operations {
        all.fold(Operations::default(), Add::add)
    }
}

impl Mul<f64> for Operations {
    type Output = Operations;

    fn mul(self, times: f64) -> Operations {
        Operations { floating: self.floating * times, integer: self.integer * times }
    }
}

/// Begins the line before a branch or a loop that has a name.
pub const MARK: &str = "// bench: ";

/// What runs from its beginning to its end, with the branches and loops in it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stretch(pub(super) Vec<Item>);

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Item {
    Counted(Operations),
    /// A branch or a loop, by its name, if it has one.
    Inner(String, Stretch),
}

impl Stretch {
    /// What runs whichever way it takes.
    pub fn straight(&self) -> Operations {
        Stretch::sum(&self.0)
    }

    /// The first branch or loop in it, at any depth, of this name ([`MARK`]).
    pub fn inner(&self, name: &str) -> Option<&Stretch> {
        self.found(name).into_iter().next()
    }

    /// What runs in a turn of each of them, summed.
    pub fn every(&self, name: &str) -> Operations {
        self.found(name).into_iter().map(Stretch::straight).sum()
    }

    /// What runs before a branch or a loop of this name, and after it.
    pub fn around(&self, name: &str) -> Option<[Operations; 2]> {
        let at = self.0.iter().position(|item| matches!(item, Item::Inner(own, _) if own == name))?;
        Some([&self.0[..at], &self.0[at..]].map(Stretch::sum))
    }

    fn found(&self, wanted: &str) -> Vec<&Stretch> {
        let mut found = Vec::new();
        for item in &self.0 {
            if let Item::Inner(name, inner) = item {
                if name == wanted {
                    found.push(inner);
                }
                found.extend(inner.found(wanted));
            }
        }
        found
    }

    fn sum(items: &[Item]) -> Operations {
        let counted = items.iter().map(|item| match item {
            Item::Counted(operations) => *operations,
            Item::Inner(..) => Operations::default(),
        });
        counted.sum()
    }

    pub(super) fn count(&mut self, more: Operations) {
        match self.0.last_mut() {
            Some(Item::Counted(operations)) => *operations += more,
            _ => self.0.push(Item::Counted(more)),
        }
    }

    pub(super) fn append(&mut self, other: Stretch) {
        for item in other.0 {
            match item {
                Item::Counted(operations) => self.count(operations),
                inner @ Item::Inner(..) => self.0.push(inner),
            }
        }
    }
}
