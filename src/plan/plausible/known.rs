//! Gases that everybody knows: whether what a scene gives of one, by its name or else by its molar mass, is that gas's.
//!
//! A constant heat capacity may be that of any temperature of the scene; of a monatomic gas whose name says nothing it is one of a
//! model, whatever its mass.

use super::range::{Kind, range_of};
use crate::plan::text::significant;
use crate::scene::{Dimension, GAS_CONSTANT, Gas, HeatCapacity, Scene};

struct Known {
    name: &'static str,
    /// Without spaces and in small letters.
    others: &'static [&'static str],
    /// kg/mol.
    molar_mass: f64,
    /// At constant pressure at each of [`AT`], J/(mol K) (NIST-JANAF tables).
    cp: [f64; 3],
}

/// K.
const AT: [f64; 3] = [300.0, 1000.0, 2000.0];
const MONATOMIC: [f64; 3] = [2.5 * GAS_CONSTANT; 3];

const fn known(name: &'static str, others: &'static [&'static str], molar_mass: f64, cp: [f64; 3]) -> Known {
    Known { name, others, molar_mass, cp }
}

const KNOWN: &[Known] = &[
    known("air", &[], 0.028965, [29.1, 33.1, 36.2]),
    known("nitrogen", &["n2"], 0.0280134, [29.1, 32.7, 36.0]),
    known("oxygen", &["o2"], 0.031999, [29.4, 34.9, 37.8]),
    known("carbon monoxide", &["co"], 0.02801, [29.1, 33.2, 36.2]),
    known("hydrogen", &["h2"], 0.002016, [28.8, 30.2, 34.3]),
    known("carbon dioxide", &["co2"], 0.04401, [37.2, 54.3, 60.3]),
    known("water vapour", &["h2o", "steam", "water", "watervapor"], 0.018015, [33.6, 41.3, 51.2]),
    known("ammonia", &["nh3"], 0.017031, [35.7, 56.5, 72.8]),
    known("methane", &["ch4"], 0.016043, [35.7, 71.8, 94.4]),
    known("sulphur hexafluoride", &["sf6", "sulfurhexafluoride"], 0.146055, [97.0, 148.0, 155.0]),
    known("helium", &["he"], 0.0040026, MONATOMIC),
    known("neon", &["ne"], 0.02018, MONATOMIC),
    known("argon", &["ar"], 0.039948, MONATOMIC),
    known("krypton", &["kr"], 0.083798, MONATOMIC),
    known("xenon", &["xe"], 0.131293, MONATOMIC),
    known("nitrous oxide", &["n2o"], 0.044013, [38.7, 55.1, 60.2]),
    known("ethylene", &["c2h4", "ethene"], 0.028054, [43.0, 94.0, 114.0]),
    known("propane", &["c3h8"], 0.044097, [73.9, 175.0, 215.0]),
    known("deuterium", &["d2"], 0.004028, [29.2, 31.6, 36.1]),
];

/// How far the molar mass of a gas by that name may be off, and that of one by its molar mass.
const MASS_BY_NAME: f64 = 0.03;
const MASS_ALONE: f64 = 3e-3;
/// How far a heat capacity may be off.
const HEAT: f64 = 0.12;
/// Within this it is the one that was confused with it.
const CONFUSED: f64 = 0.03;
/// Gas that is stopped or squeezed is hotter than all that the scene names.
const HOTTER: f64 = 1.3;

impl Known {
    fn cp_at(&self, kelvin: f64) -> f64 {
        let upper = if kelvin < AT[1] { 1 } else { 2 };
        let share = (kelvin.clamp(AT[0], AT[2]) - AT[upper - 1]) / (AT[upper] - AT[upper - 1]);
        self.cp[upper - 1] + share * (self.cp[upper] - self.cp[upper - 1])
    }

    fn is_called(&self, name: &str) -> bool {
        let plain = |name: &str| -> String {
            name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect()
        };
        let own = plain(name);
        plain(self.name) == own || self.others.contains(&own.as_str())
    }

    fn weighs(&self, molar_mass: f64, within: f64) -> bool {
        (molar_mass / self.molar_mass - 1.0).abs() <= within
    }
}

/// From the coldest to the hottest that the scene's gas may be, K.
fn temperatures(scene: &Scene) -> [f64; 2] {
    let chambers = scene.chambers.iter().map(|chamber| chamber.temperature);
    let orifices = scene.orifices.iter().flat_map(|orifice| orifice.temperature.points.iter().map(|point| point[1]));
    let all = chambers.chain(orifices).fold([f64::INFINITY, 0.0], |[low, high], t| [low.min(t), high.max(t)]);
    [all[0], HOTTER * all[1]]
}

/// Gases that are not what their names or their molar masses say.
pub fn notes(scene: &Scene) -> Vec<String> {
    let range = temperatures(scene);
    scene.gases.iter().flat_map(|gas| of_gas(scene, gas, range)).collect()
}

fn of_gas(scene: &Scene, gas: &Gas, range: [f64; 2]) -> Vec<String> {
    let cp = gas.heat.molar_cv(range[0]) + GAS_CONSTANT;
    // What no gas has is doubted otherwise.
    let is_gas = range_of(Kind::MolarMass).holds(gas.molar_mass) && range_of(Kind::MolarHeat).holds(cp);
    if !is_gas || cp < 2.4 * GAS_CONSTANT {
        return Vec::new();
    }
    if let Some(named) = KNOWN.iter().find(|known| known.is_called(&gas.name)) {
        let mass = (!named.weighs(gas.molar_mass, MASS_BY_NAME)).then(|| unlike_mass(scene, gas, named));
        let heat = (!fits(gas, named, range)).then(|| unlike_heat(scene, gas, named, range));
        return mass.into_iter().chain(heat).collect();
    }
    let of_model = gas.heat == HeatCapacity::Constant(1.5 * GAS_CONSTANT);
    let mut alike = KNOWN.iter().filter(|known| known.weighs(gas.molar_mass, MASS_ALONE)).peekable();
    let Some(first) = alike.peek().copied() else { return Vec::new() };
    if of_model || alike.any(|known| fits(gas, known, range)) {
        return Vec::new();
    }
    vec![unlike_heat(scene, gas, first, range)]
}

/// Whether a gas has the heat capacity of one that is known, at a temperature of the scene.
fn fits(gas: &Gas, known: &Known, [low, high]: [f64; 2]) -> bool {
    let cp = gas.heat.molar_cv(low) + GAS_CONSTANT;
    let hottest = match gas.heat {
        HeatCapacity::Constant(_) => high,
        HeatCapacity::Curve(_) => low,
    };
    cp >= (1.0 - HEAT) * known.cp_at(low) && cp <= (1.0 + HEAT) * known.cp_at(hottest)
}

fn unlike_mass(scene: &Scene, gas: &Gas, known: &Known) -> String {
    let [own, usual] = [gas.molar_mass, known.molar_mass].map(|si| si / scene.units.factor(Dimension::MolarMass));
    format!(
        "gas `{}`: molar_mass {} {}, where {} has {}: is it that of another gas?",
        gas.name,
        significant(own),
        scene.units.symbol(Dimension::MolarMass),
        known.name,
        significant(usual)
    )
}

fn unlike_heat(scene: &Scene, gas: &Gas, known: &Known, [low, high]: [f64; 2]) -> String {
    let shown = |si: f64| significant(si / scene.units.factor(Dimension::MolarHeat));
    let gamma = |cp: f64| format!("{:.2}", cp / (cp - GAS_CONSTANT));
    let cp = gas.heat.molar_cv(low) + GAS_CONSTANT;
    let usual = known.cp_at(low);
    let near = |other: f64| (cp / other - 1.0).abs() < CONFUSED;
    let question = if near(usual - GAS_CONSTANT) {
        format!(" (its cv is {}): is cv given for cp, or the gamma of another gas?", shown(usual - GAS_CONSTANT))
    } else if near(usual + GAS_CONSTANT) {
        ": is cp given for cv, or the gamma of another gas?".to_string()
    } else {
        ": is it that of another gas?".to_string()
    };
    let by = if known.is_called(&gas.name) { "" } else { ", of that molar mass," };
    let until = if known.cp_at(high) > 1.02 * usual {
        format!(" at {} K, up to {} when hot", significant(low), shown(known.cp_at(high)))
    } else {
        String::new()
    };
    format!(
        "gas `{}`: cp {} {}, gamma {}, where {}{by} has cp {}, gamma {}{until}{question}",
        gas.name,
        shown(cp),
        scene.units.symbol(Dimension::MolarHeat),
        gamma(cp),
        known.name,
        shown(usual),
        gamma(usual)
    )
}
