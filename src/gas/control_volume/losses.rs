//! What the chambers lose through their walls: heat to those that keep a temperature, gas through vents, out of all or into another.
//!
//! dU/dt = -A h (T - T_w), by the same rule as the particles' walls (`wall_heat`); dn/dt = -A G / M, dU/dt = -A G h of a
//! vent that is open (`vent`).

use std::borrow::Cow;

use super::{ControlVolume, OpenVent, VENTED};
use crate::gas::vent::{LocalGas, flux, opens};
use crate::gas::wall_heat::heat_flux;
use crate::scene::Vent;

impl ControlVolume {
    /// A vent against the gas that is behind it.
    fn against<'a>(&self, open: &'a OpenVent, contents: &[f64], time: f64) -> Cow<'a, Vent> {
        match open.behind {
            None => Cow::Borrowed(&open.vent),
            Some(chamber) => {
                let external_pressure = self.side(contents, chamber, time).pressure();
                Cow::Owned(Vent { external_pressure, ..open.vent.clone() })
            }
        }
    }

    /// Opens the vents whose chambers have reached their opening pressure.
    pub(super) fn open_vents(&self, time: f64, contents: &[f64], open: &mut [bool]) {
        for (vent, open) in self.vents.iter().zip(open) {
            *open =
                opens(&self.against(vent, contents, time), *open, self.side(contents, vent.chamber, time).pressure());
        }
    }

    /// Whether a vent that is not open would be opened.
    pub(super) fn opens_any(&self, time: f64, contents: &[f64], open: &[bool]) -> bool {
        self.vents.iter().zip(open).any(|(vent, open)| {
            let pressure = self.side(contents, vent.chamber, time).pressure();
            !open && opens(&self.against(vent, contents, time), false, pressure)
        })
    }

    /// Takes the losses at a time (s) from the time derivative of the unknowns of the chambers, and adds them to that of what
    /// has left.
    pub(super) fn lose(&self, time: f64, contents: &[f64], open: &[bool], rate: &mut [f64]) {
        let stride = self.stride();
        let mut lost = self.lost_at();
        for wall in &self.walls {
            let side = self.side(contents, wall.chamber, time);
            let concentrations: Vec<f64> = side.moles.iter().map(|moles| moles / side.volume).collect();
            let flux = heat_flux(&wall.heat, &self.gases, &concentrations, side.temperature);
            rate[(wall.chamber + 1) * stride - 1] -= wall.area * flux;
            rate[lost] += wall.area * flux;
            lost += 1;
        }
        for (index, (open, is_open)) in self.vents.iter().zip(open).enumerate() {
            let side = self.side(contents, open.chamber, time);
            let concentrations: Vec<f64> = side.moles.iter().map(|moles| moles / side.volume).collect();
            let Some(gas) = LocalGas::new(&self.gases, &concentrations, side.temperature) else { continue };
            let [mass, enthalpy, isentropic] = [0, 1, 2].map(|k| lost + VENTED * index + k);
            let vent = self.against(open, contents, time);
            rate[isentropic] += open.area * gas.isentropic_flux(vent.external_pressure);
            if !is_open {
                continue;
            }
            let moles = open.area * flux(&vent, &gas, time) / gas.molar_mass;
            let total: f64 = side.moles.iter().sum();
            for (index, own) in side.moles.iter().enumerate() {
                let flow = moles * own / total;
                let carried = flow * self.gases[index].enthalpy(1.0, side.temperature);
                rate[open.chamber * stride + index] -= flow;
                rate[(open.chamber + 1) * stride - 1] -= carried;
                if let Some(behind) = open.behind {
                    rate[behind * stride + index] += flow;
                    rate[(behind + 1) * stride - 1] += carried;
                }
                rate[mass] += flow * self.gases[index].molar_mass;
                rate[enthalpy] += carried;
            }
        }
    }
}
