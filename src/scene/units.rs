//! The three unit systems of a scene file, and the border between the file and SI.
//!
//! Each system is a mass, a length and a time; everything else follows: pressure is M/(L T^2), energy
//! M L^2/T^2. Kelvin and mole are the same in all three. In SI every factor is exactly 1, so that a
//! scene written in SI parses back bit by bit.

use super::types::UnitSystem;

/// What a number of the file measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// A ratio or a direction.
    Pure,
    Length,
    Area,
    Volume,
    Mass,
    Density,
    /// Mass per area.
    SurfaceDensity,
    Time,
    Velocity,
    /// Radians per time.
    AngularVelocity,
    Acceleration,
    Temperature,
    Pressure,
    MassFlow,
    MolarMass,
    /// Heat capacity per mole; of a polynomial each coefficient, since all systems have K.
    MolarHeat,
    /// Heat per area, time and temperature.
    HeatTransfer,
}

impl UnitSystem {
    pub const ALL: [UnitSystem; 3] = [UnitSystem::Si, UnitSystem::KgMmMs, UnitSystem::TMmS];

    /// The value of `units` in a scene file.
    pub fn name(self) -> &'static str {
        match self {
            UnitSystem::Si => "SI",
            UnitSystem::KgMmMs => "kg-mm-ms",
            UnitSystem::TMmS => "t-mm-s",
        }
    }

    /// Metres per unit of length, and what messages call it.
    pub fn length(self) -> (f64, &'static str) {
        (self.factor(Quantity::Length), self.symbol(Quantity::Length))
    }

    /// SI units per unit of this system.
    pub fn factor(self, quantity: Quantity) -> f64 {
        use Quantity::*;
        use UnitSystem::*;
        match (self, quantity) {
            (Si, _) | (_, Pure | Temperature) => 1.0,
            (KgMmMs | TMmS, Length) => 1e-3,
            (KgMmMs | TMmS, Area) => 1e-6,
            (KgMmMs | TMmS, Volume) => 1e-9,
            (KgMmMs, Mass) => 1.0,
            (TMmS, Mass) => 1e3,
            (KgMmMs, Density) => 1e9,
            (TMmS, Density) => 1e12,
            (KgMmMs, SurfaceDensity) => 1e6,
            (TMmS, SurfaceDensity) => 1e9,
            (KgMmMs, Time) => 1e-3,
            (KgMmMs, Velocity) => 1.0,
            (KgMmMs, AngularVelocity) => 1e3,
            (TMmS, AngularVelocity) => 1.0,
            (TMmS, Velocity) => 1e-3,
            (KgMmMs, Acceleration) => 1e3,
            (TMmS, Acceleration) => 1e-3,
            (KgMmMs, Pressure) => 1e9,
            (KgMmMs, MassFlow) => 1e3,
            (KgMmMs, MolarMass | MolarHeat) => 1.0,
            (TMmS, Time) => 1.0,
            (TMmS, Pressure) => 1e6,
            (TMmS, MassFlow | MolarMass) => 1e3,
            (TMmS, MolarHeat) => 1e-3,
            (KgMmMs, HeatTransfer) => 1e9,
            (TMmS, HeatTransfer) => 1e3,
        }
    }

    /// What messages call the unit.
    pub fn symbol(self, quantity: Quantity) -> &'static str {
        use Quantity::*;
        use UnitSystem::*;
        match (self, quantity) {
            (_, Pure) => "",
            (_, Temperature) => "K",
            (Si, Length) => "m",
            (Si, Area) => "m2",
            (Si, Volume) => "m3",
            (KgMmMs | TMmS, Volume) => "mm3",
            (Si | KgMmMs, Mass) => "kg",
            (TMmS, Mass) => "t",
            (Si, Density) => "kg/m3",
            (KgMmMs, Density) => "kg/mm3",
            (TMmS, Density) => "t/mm3",
            (Si, SurfaceDensity) => "kg/m2",
            (KgMmMs, SurfaceDensity) => "kg/mm2",
            (TMmS, SurfaceDensity) => "t/mm2",
            (Si | TMmS, Time) => "s",
            (Si, Velocity) => "m/s",
            (KgMmMs, Velocity) => "mm/ms",
            (TMmS, Velocity) => "mm/s",
            (Si | TMmS, AngularVelocity) => "rad/s",
            (KgMmMs, AngularVelocity) => "rad/ms",
            (Si, Acceleration) => "m/s2",
            (KgMmMs, Acceleration) => "mm/ms2",
            (TMmS, Acceleration) => "mm/s2",
            (Si, Pressure) => "Pa",
            (Si, MassFlow) => "kg/s",
            (Si | KgMmMs, MolarMass) => "kg/mol",
            (Si | KgMmMs, MolarHeat) => "J/(mol K)",
            (KgMmMs | TMmS, Length) => "mm",
            (KgMmMs | TMmS, Area) => "mm2",
            (KgMmMs, Time) => "ms",
            (KgMmMs, Pressure) => "GPa",
            (KgMmMs, MassFlow) => "kg/ms",
            (TMmS, Pressure) => "MPa",
            (TMmS, MassFlow) => "t/s",
            (TMmS, MolarMass) => "t/mol",
            (TMmS, MolarHeat) => "mJ/(mol K)",
            (Si, HeatTransfer) => "W/(m2 K)",
            (KgMmMs, HeatTransfer) => "J/(ms mm2 K)",
            (TMmS, HeatTransfer) => "mJ/(s mm2 K)",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every derived factor is the product of powers of the system's mass, length and time.
    #[test]
    fn derived_units_follow_from_mass_length_and_time() {
        for (system, mass, length, time) in
            [(UnitSystem::Si, 1.0, 1.0, 1.0), (UnitSystem::KgMmMs, 1.0, 1e-3, 1e-3), (UnitSystem::TMmS, 1e3, 1e-3, 1.0)]
        {
            let near = |quantity, expected: f64| {
                let factor = system.factor(quantity);
                assert!((factor / expected - 1.0).abs() < 1e-14, "{system:?} {quantity:?}: {factor} != {expected}");
            };
            near(Quantity::Length, length);
            near(Quantity::Area, length * length);
            near(Quantity::Volume, length.powi(3));
            near(Quantity::Mass, mass);
            near(Quantity::SurfaceDensity, mass / (length * length));
            near(Quantity::Time, time);
            near(Quantity::Pressure, mass / (length * time * time));
            near(Quantity::MassFlow, mass / time);
            near(Quantity::Velocity, length / time);
            near(Quantity::Acceleration, length / (time * time));
            near(Quantity::Density, mass / length.powi(3));
            near(Quantity::HeatTransfer, mass / time.powi(3));
            near(Quantity::MolarMass, mass);
            near(Quantity::MolarHeat, mass * length * length / (time * time));
        }
        assert_ne!(UnitSystem::TMmS.factor(Quantity::Pressure), UnitSystem::KgMmMs.factor(Quantity::Pressure));
    }
}
