//! The exact solution of the one-dimensional Riemann problem of an ideal gas: two states side by side, parted at
//! x = 0 until t = 0. (Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics, chapter 4.)
//!
//! The solution is a function of x/t alone: a wave to each side (a shock where the pressure between them is above the
//! side's own, else a rarefaction), and a contact between. Next to a vacuum there is a rarefaction only, into it.

/// A state of the gas. Density 0 is a vacuum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fluid {
    /// kg/m3.
    pub density: f64,
    /// m/s.
    pub velocity: f64,
    /// Pa.
    pub pressure: f64,
}

/// Two states and what is between their waves.
#[derive(Debug, Clone, Copy)]
pub struct Riemann {
    left: Fluid,
    right: Fluid,
    gamma: f64,
    /// Pressure and velocity between the waves; `None` where a vacuum is, or comes about, between them.
    star: Option<(f64, f64)>,
}

const VACUUM: Fluid = Fluid { density: 0.0, velocity: 0.0, pressure: 0.0 };

impl Riemann {
    /// `None` for a gamma of 1 or less, a negative or infinite density or pressure, or two vacuums.
    pub fn new(left: Fluid, right: Fluid, gamma: f64) -> Option<Riemann> {
        let sound = |of: &Fluid| {
            let fine = of.density >= 0.0 && of.pressure >= 0.0 && (of.density == 0.0) == (of.pressure == 0.0);
            (fine && of.density.is_finite() && of.pressure.is_finite() && of.velocity.is_finite())
                .then(|| sound_speed(of, gamma))
        };
        let (left_sound, right_sound) = (sound(&left)?, sound(&right)?);
        if !(gamma > 1.0 && gamma.is_finite()) || left.density + right.density == 0.0 {
            return None;
        }
        let apart = right.velocity - left.velocity >= 2.0 / (gamma - 1.0) * (left_sound + right_sound);
        let mut solution = Riemann { left, right, gamma, star: None };
        if left.density > 0.0 && right.density > 0.0 && !apart {
            let pressure = solution.between();
            let (f_left, f_right) = (solution.jump(&left, pressure), solution.jump(&right, pressure));
            let velocity = 0.5 * (left.velocity + right.velocity) + 0.5 * (f_right - f_left);
            solution.star = Some((pressure, velocity));
        }
        Some(solution)
    }

    /// The state where x/t is this, m/s.
    pub fn at(&self, speed: f64) -> Fluid {
        let middle = self.star.map(|(_, velocity)| velocity);
        let on_left = match middle {
            Some(velocity) => speed <= velocity,
            // The vacuum is on the one side, or between the fronts of both.
            None if self.left.density == 0.0 => false,
            None if self.right.density == 0.0 => true,
            None => speed <= self.front(&self.left),
        };
        if on_left {
            return self.beside(&self.left, speed);
        }
        let mirrored = Fluid { velocity: -self.right.velocity, ..self.right };
        let solution = self.mirrored().beside(&mirrored, -speed);
        Fluid { velocity: -solution.velocity, ..solution }
    }

    /// Pressure and velocity between the waves; `None` where a vacuum is there.
    pub fn between_waves(&self) -> Option<(f64, f64)> {
        self.star
    }

    /// Speed of the front of the right wave, m/s: of its shock, or of the head of its rarefaction; `None` beside a vacuum.
    pub fn right_front(&self) -> Option<f64> {
        let (pressure, _) = self.star?;
        let mach = self.shock_mach((pressure / self.right.pressure).max(1.0));
        Some(self.right.velocity + mach * sound_speed(&self.right, self.gamma))
    }

    /// Of a shock to so many times the pressure.
    fn shock_mach(&self, ratio: f64) -> f64 {
        let g = self.gamma;
        ((g + 1.0) / (2.0 * g) * ratio + (g - 1.0) / (2.0 * g)).sqrt()
    }

    /// Where the gas of the left meets the vacuum.
    fn front(&self, left: &Fluid) -> f64 {
        left.velocity + 2.0 / (self.gamma - 1.0) * sound_speed(left, self.gamma)
    }

    fn mirrored(&self) -> Riemann {
        let mirror = |of: Fluid| Fluid { velocity: -of.velocity, ..of };
        let star = self.star.map(|(pressure, velocity)| (pressure, -velocity));
        Riemann { left: mirror(self.right), right: mirror(self.left), gamma: self.gamma, star }
    }

    /// The left wave and what is on either side of it, up to the contact.
    fn beside(&self, left: &Fluid, speed: f64) -> Fluid {
        let g = self.gamma;
        let sound = sound_speed(left, g);
        let fan = || {
            let local = 2.0 / (g + 1.0) * (sound + 0.5 * (g - 1.0) * (left.velocity - speed));
            if local <= 0.0 {
                return VACUUM;
            }
            Fluid {
                density: left.density * libm::pow(local / sound, 2.0 / (g - 1.0)),
                velocity: speed + local,
                pressure: left.pressure * libm::pow(local / sound, 2.0 * g / (g - 1.0)),
            }
        };
        let Some((pressure, velocity)) = self.star else {
            let in_fan = speed > left.velocity - sound;
            return match (in_fan, speed < self.front(left)) {
                (false, _) => *left,
                (true, true) => fan(),
                (true, false) => VACUUM,
            };
        };
        let ratio = pressure / left.pressure;
        if ratio > 1.0 {
            let shock = left.velocity - sound * self.shock_mach(ratio);
            if speed < shock {
                return *left;
            }
            let part = (g - 1.0) / (g + 1.0);
            return Fluid { density: left.density * (ratio + part) / (part * ratio + 1.0), velocity, pressure };
        }
        let star_sound = sound * libm::pow(ratio, (g - 1.0) / (2.0 * g));
        if speed < left.velocity - sound {
            *left
        } else if speed < velocity - star_sound {
            fan()
        } else {
            Fluid { density: left.density * libm::pow(ratio, 1.0 / g), velocity, pressure }
        }
    }

    /// What a wave that leads to a pressure changes of the velocity.
    fn jump(&self, of: &Fluid, pressure: f64) -> f64 {
        let g = self.gamma;
        if pressure > of.pressure {
            let a = 2.0 / ((g + 1.0) * of.density);
            let b = (g - 1.0) / (g + 1.0) * of.pressure;
            (pressure - of.pressure) * (a / (pressure + b)).sqrt()
        } else {
            let power = libm::pow(pressure / of.pressure, (g - 1.0) / (2.0 * g));
            2.0 * sound_speed(of, g) / (g - 1.0) * (power - 1.0)
        }
    }

    /// The pressure between the waves: both jumps and the difference of the velocities add up to nothing. The sum
    /// rises with the pressure, so halving finds its zero.
    fn between(&self) -> f64 {
        let sum =
            |p: f64| self.jump(&self.left, p) + self.jump(&self.right, p) + self.right.velocity - self.left.velocity;
        let (mut low, mut high) = (0.0, self.left.pressure.max(self.right.pressure));
        while sum(high) < 0.0 {
            high *= 2.0;
        }
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if sum(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }
}

fn sound_speed(of: &Fluid, gamma: f64) -> f64 {
    if of.density > 0.0 { (gamma * of.pressure / of.density).sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fluid(density: f64, velocity: f64, pressure: f64) -> Fluid {
        Fluid { density, velocity, pressure }
    }

    fn close(found: f64, expected: f64, tolerance: f64) {
        assert!((found - expected).abs() < tolerance * expected.abs().max(1e-3), "{found} for {expected}");
    }

    /// Sod's problem: the published values between the waves (Toro, table 4.3, test 1: p .30313, u .92745, densities
    /// .42632 and .26557).
    #[test]
    fn sods_problem_has_its_published_solution() {
        let sod = Riemann::new(fluid(1.0, 0.0, 1.0), fluid(0.125, 0.0, 0.1), 1.4).unwrap();
        let (pressure, velocity) = sod.star.unwrap();
        close(pressure, 0.30313, 2e-5);
        close(velocity, 0.92745, 2e-5);
        close(sod.at(0.9).density, 0.42632, 2e-5);
        close(sod.at(0.95).density, 0.26557, 2e-5);
        assert_eq!(sod.at(-2.0), fluid(1.0, 0.0, 1.0));
        assert_eq!(sod.at(2.0), fluid(0.125, 0.0, 0.1));
        let front = sod.right_front().unwrap();
        close(front, 1.75216, 2e-5);
        assert_eq!(sod.at(front + 1e-9).density, 0.125);
        close(sod.at(front - 1e-9).density, 0.26557, 2e-5);
        // Towards lower pressure the wave is sound.
        let fan = Riemann::new(fluid(0.125, 0.0, 0.1), fluid(1.0, 0.0, 1.0), 1.4).unwrap();
        close(fan.right_front().unwrap(), 1.4f64.sqrt(), 1e-12);
    }

    /// Mirrored states have the mirrored solution.
    #[test]
    fn left_and_right_are_alike() {
        let (a, b) = (fluid(1.0, 0.3, 2.0), fluid(0.4, -0.2, 0.7));
        let one = Riemann::new(a, b, 5.0 / 3.0).unwrap();
        let other = Riemann::new(Fluid { velocity: -b.velocity, ..b }, Fluid { velocity: -a.velocity, ..a }, 5.0 / 3.0);
        for k in -40..40 {
            let speed = 0.1 * f64::from(k) + 0.013;
            let (x, y) = (one.at(speed), other.unwrap().at(-speed));
            close(x.density, y.density, 1e-9);
            close(x.velocity, -y.velocity, 1e-9);
            close(x.pressure, y.pressure, 1e-9);
        }
    }

    /// Mass and momentum that cross x = 0 from the left are what the region lost: the integral form of the equations.
    #[test]
    fn mass_momentum_and_energy_are_conserved() {
        for right in [fluid(0.125, 0.0, 0.1), fluid(1.0, -1.5, 1.0), VACUUM] {
            let left = fluid(1.0, 0.1, 1.0);
            let gamma = 1.4;
            let riemann = Riemann::new(left, right, gamma).unwrap();
            // At t = 1 within |x| < 8, by the midpoint rule.
            let cells = 400_000;
            let width = 16.0 / f64::from(cells);
            let energy = |f: Fluid| f.pressure / (gamma - 1.0) + 0.5 * f.density * f.velocity * f.velocity;
            let mut found = [0.0; 3];
            for k in 0..cells {
                let f = riemann.at(-8.0 + (f64::from(k) + 0.5) * width);
                found[0] += width * f.density;
                found[1] += width * f.density * f.velocity;
                found[2] += width * energy(f);
            }
            let flux = |f: Fluid| {
                let momentum = f.density * f.velocity;
                [momentum, momentum * f.velocity + f.pressure, f.velocity * (energy(f) + f.pressure)]
            };
            let content = |f: Fluid| [f.density, f.density * f.velocity, energy(f)];
            let (contents, fluxes) = ([content(left), content(right)], [flux(left), flux(right)]);
            for (k, found) in found.into_iter().enumerate() {
                close(found, 8.0 * (contents[0][k] + contents[1][k]) + fluxes[0][k] - fluxes[1][k], 1e-4);
            }
        }
    }

    /// Into a vacuum the front runs at 2 c/(gamma - 1), and behind it nothing is negative.
    #[test]
    fn gas_next_to_a_vacuum_expands_at_its_front_speed() {
        let riemann = Riemann::new(fluid(1.0, 0.0, 1.0), VACUUM, 1.4).unwrap();
        let front = 5.0 * 1.4f64.sqrt();
        assert_eq!(riemann.at(front + 1e-9), VACUUM);
        let before = riemann.at(front - 1e-3);
        assert!(before.density > 0.0 && before.density < 1e-12, "{before:?}");
        // Two gases that fly apart leave a vacuum between them.
        let apart = Riemann::new(fluid(1.0, -20.0, 1.0), fluid(1.0, 20.0, 1.0), 1.4).unwrap();
        assert_eq!(apart.at(0.0), VACUUM);
        assert!(apart.at(-16.0).density > 0.0 && apart.at(16.0).density > 0.0);
    }

    #[test]
    fn what_is_no_gas_has_no_solution() {
        let gas = fluid(1.0, 0.0, 1.0);
        assert!(Riemann::new(VACUUM, VACUUM, 1.4).is_none());
        assert!(Riemann::new(gas, gas, 1.0).is_none());
        assert!(Riemann::new(gas, fluid(-1.0, 0.0, 1.0), 1.4).is_none());
        assert!(Riemann::new(gas, fluid(1.0, 0.0, f64::NAN), 1.4).is_none());
    }
}
