//! When vents open: the first time at which the pressure of the chamber before one reaches that at which it opens, and the highest
//! that was seen. Tells, and changes nothing: what a vent passes follows from the same pressures in `surface_states` and in the control
//! volume.

use serde::{Deserialize, Serialize};

use crate::plan::significant;
use crate::scene::{Dimension, Scene, Vent};

/// What was seen of a vent so far.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct VentWatch {
    /// s, and the pressure then, Pa.
    pub opened: Option<[f64; 2]>,
    /// Pa.
    pub highest: f64,
    /// s and Pa, what was seen last.
    pub last: [f64; 2],
}

impl VentWatch {
    /// Takes the pressure at a later time, s, Pa; true if that opens the vent. With `between` it opened where the line from what
    /// was seen before reaches its pressure, else at that time.
    pub fn see(&mut self, vent: &Vent, [time, pressure]: [f64; 2], between: bool) -> bool {
        let [earlier, before] = std::mem::replace(&mut self.last, [time, pressure]);
        self.highest = self.highest.max(pressure);
        let opens_at = vent.external_pressure + vent.opening_pressure;
        if self.opened.is_some() || pressure < opens_at {
            return false;
        }
        let crossed = between && before < opens_at && time > earlier && before > 0.0;
        self.opened = Some(if crossed {
            [earlier + (time - earlier) * (opens_at - before) / (pressure - before), opens_at]
        } else {
            [time, pressure]
        });
        true
    }

    /// What became of the vent, by its index; nothing of one that was open from the start, or has no pressure to open at and did.
    pub fn told(&self, scene: &Scene, index: usize) -> Option<String> {
        let vent = &scene.vents[index];
        let (unit, symbol) = (scene.units.factor(Dimension::Pressure), scene.units.symbol(Dimension::Pressure));
        let absolute =
            |pa: f64| format!("{} {symbol} ({} bar) absolute", significant(pa / unit), significant(1e-5 * pa));
        let opens_at = absolute(vent.external_pressure + vent.opening_pressure);
        match self.opened {
            Some([time, _]) if time <= 0.0 || vent.opening_pressure <= 0.0 => None,
            Some([time, pressure]) => {
                Some(format!("vent `{}` opened at {:.4} ms, at {}", vent.name, 1e3 * time, absolute(pressure)))
            }
            None => Some(format!(
                "vent `{}` did not open: it opens at {opens_at}, and its chamber had {} at most",
                vent.name,
                absolute(self.highest)
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::parse;

    #[test]
    fn a_vent_opens_once_and_where_a_line_crosses_its_pressure() {
        let scene = parse(include_str!("../../../scenes/vent.toml"), "vent.toml", std::path::Path::new("")).unwrap();
        let vent = Vent { opening_pressure: 1e5, external_pressure: 1e5, ..scene.vents[0].clone() };
        let mut seen = VentWatch::default();
        assert!(!seen.see(&vent, [0.0, 1e5], true) && !seen.see(&vent, [1e-3, 1.8e5], true));
        assert!(seen.see(&vent, [2e-3, 2.2e5], true));
        assert_eq!(seen.opened.map(|[time, pressure]| [(1e7 * time).round(), pressure]), Some([15000.0, 2e5]));
        assert!(!seen.see(&vent, [3e-3, 3e5], true) && seen.highest == 3e5);
        let mut stepped = VentWatch::default();
        assert!(!stepped.see(&vent, [1e-3, 1.8e5], false) && stepped.see(&vent, [2e-3, 2.2e5], false));
        assert_eq!(stepped.opened, Some([2e-3, 2.2e5]));
        // GuardWarning with its pressure, or that it stayed shut; silent where it was open from the start.
        let mut of_scene = scene.clone();
        of_scene.vents[0] = vent.clone();
        assert!(stepped.told(&of_scene, 0).unwrap().contains("opened at 2.0000 ms, at 220000 Pa (2.2 bar) absolute"));
        let mut shut = VentWatch::default();
        shut.see(&vent, [1e-3, 1.5e5], false);
        let told = shut.told(&of_scene, 0).unwrap();
        assert!(
            told.contains("did not open: it opens at 200000 Pa (2 bar) absolute, and its chamber had 150000 Pa"),
            "{told}"
        );
        let open = VentWatch { opened: Some([0.0, 3e5]), ..VentWatch::default() };
        assert_eq!(open.told(&of_scene, 0), None);
    }
}
