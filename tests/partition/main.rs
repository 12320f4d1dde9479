//! The laws of `corpuscle::partition`: boxes, trees and cuts; how even the parts are; cost model; trigger.

mod bisection;
mod clouds;
mod cost;
mod quality;
mod trigger;
