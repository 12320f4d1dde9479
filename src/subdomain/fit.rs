//! Room for the neighbour lists that a run begins with.

use crate::gpu::{Device, GpuError, Recording};

use super::counters;
use super::device_gas::Subdomain;
use super::nearness;
use super::recall::{Backup, Remembered};
use super::registry::{COUNT_DROPPED, LIST_TAILS};
use super::step_slot::{Newborns, StepSlot, Tables};

impl Subdomain {
    /// Makes half as much room again as the first step of an interval wants for the tails of neighbour lists, by a search among
    /// the particles that are here, which are remembered as `before`: a run begins with gas of any density, and room that is
    /// found to be too small only afterwards costs the intervals under way. Changes nothing else but the order of the slots.
    ///
    /// # Errors
    /// If the device fails, or has no room for such lists.
    pub fn fit_lists(
        &mut self,
        device: &Device,
        dt: f64,
        tables: &Tables,
        before: &Remembered,
    ) -> Result<(), GpuError> {
        if !self.domain.features.rounds || self.count == 0 || matches!(before.backup, Backup::Nothing) {
            return Ok(());
        }
        device.write(&self.fixed.cross_section_shares, 0, &tables.cross_section_shares);
        let near2 = nearness::near2(&self.domain.plan, tables.halvings);
        let slot = StepSlot { dt: dt as f32, near2, ..self.at_rest(device) };
        self.write_parameters(device, &slot);
        let mut rec = Recording::new(device);
        self.reset(&mut rec);
        self.bin(&mut rec, &slot);
        self.scan(&mut rec, &slot);
        self.sort(&mut rec, &slot);
        self.neighbours(&mut rec, &slot);
        self.clear_cells(&mut rec, &slot);
        rec.submit();
        let words: Vec<u32> = device.read(&self.fixed.counters, counters::WORDS)?;
        let nobody = Newborns { of_step: &[0], list: &[], first_id: 0, stride: 1 };
        if let Backup::Stall = before.backup {
            self.recall(device, self.count - words[COUNT_DROPPED as usize], &nobody, 0);
        } else {
            self.restore(device, before, &nobody)?;
        }
        // Where particles lie outside of the own cells and the halo, `sorted` has gaps: then the intervals tell.
        if words[COUNT_DROPPED as usize] > 0 {
            return Ok(());
        }
        self.make_room_for_tails(device, words[LIST_TAILS as usize].into(), 0.5)
    }
}
