//! The laws of `corpuscle::partition`: boxes, trees and cuts; quality beside crate coupe; cost model; trigger.

mod bisection;
mod clouds;
mod cost;
mod quality;
mod trigger;
