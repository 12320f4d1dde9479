//! When vents open: the first time at which the pressure of the chamber before one reaches that at which it opens, and the highest
//! that was seen; and for how long one that is open had less pressure before it than behind it, so that it would have drawn gas in. Tells, and changes nothing: what a vent passes follows from the same pressures in `surface_states` and in the control
//! volume.

use serde::{Deserialize, Serialize};

use crate::plan::significant;
use crate::scene::{Dimension, Scene, Vent};

/// The pressure before a vent may fall short of that behind it by this part: that much is noise.
const SAME: f64 = 0.01;

/// What was seen of a vent so far.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct VentWatch {
    /// s, and the pressure then, Pa.
    pub opened: Option<[f64; 2]>,
    /// Pa.
    pub highest: f64,
    /// s and Pa, what was seen last.
    pub last: [f64; 2],
    /// s, how long it would have drawn gas in, and by how much less the pressure before it was at most, Pa.
    pub drawn_in: [f64; 2],
}

impl VentWatch {
    /// Takes the pressure at a later time, s, Pa; true if that opens the vent. With `between` it opened where the line from what
    /// was seen before reaches its pressure, else at that time.
    pub fn see(&mut self, vent: &Vent, [time, pressure]: [f64; 2], between: bool) -> bool {
        let [earlier, before] = std::mem::replace(&mut self.last, [time, pressure]);
        self.highest = self.highest.max(pressure);
        let missing = vent.external_pressure - pressure;
        if self.opened.is_some() && missing > SAME * vent.external_pressure {
            self.drawn_in = [self.drawn_in[0] + (time - earlier).max(0.0), self.drawn_in[1].max(missing)];
        }
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

    /// That gas would have flowed in through the vent, by its index; nothing of one before which the pressure was high enough.
    pub fn drew(&self, scene: &Scene, index: usize) -> Option<String> {
        let [time, missing] = self.drawn_in;
        let (unit, symbol) = (scene.units.factor(Dimension::Pressure), scene.units.symbol(Dimension::Pressure));
        (time > 0.0).then(|| {
            format!(
                "vent `{}` would have let gas in for {:.4} ms: before it were up to {} {symbol} less than behind it. Vents let nothing in",
                scene.vents[index].name,
                1e3 * time,
                significant(missing / unit),
            )
        })
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

    /// Time counts while it is open and the pressure less than behind it by more than noise.
    #[test]
    fn what_would_have_flowed_in_is_counted() {
        let scene = parse(include_str!("../../../scenes/vent.toml"), "vent.toml", std::path::Path::new("")).unwrap();
        let vent = Vent { opening_pressure: 1e5, external_pressure: 1e5, ..scene.vents[0].clone() };
        let mut seen = VentWatch::default();
        for (time, pressure) in
            [(0.0, 5e4), (1e-3, 2.5e5), (2e-3, 1.5e5), (3e-3, 9.95e4), (4e-3, 9e4), (6e-3, 8e4), (7e-3, 1e5)]
        {
            seen.see(&vent, [time, pressure], false);
        }
        assert!((seen.drawn_in[0] - 3e-3).abs() < 1e-15 && seen.drawn_in[1] == 2e4, "{:?}", seen.drawn_in);
        let told = seen.drew(&scene, 0).unwrap();
        assert!(told.contains("would have let gas in for 3.0000 ms: before it were up to 20000 Pa less"), "{told}");
        assert_eq!(VentWatch::default().drew(&scene, 0), None);
    }
}
