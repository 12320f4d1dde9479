//! The material of a membrane: which keys it takes together, and what its numbers may be.

use super::errors::Problem;
use super::fabric::{Elasticity, FabricMaterial};
use super::numbers::{bounded, direction, positive};
use super::raw_fabric::RawMaterial;
use super::raw_values::{At, NumberOr};
use super::types::UnitSystem;
use super::units::Quantity;

const DAMPING: f64 = 0.05;

pub(super) fn material(raw: &At<RawMaterial>, units: UnitSystem) -> Result<FabricMaterial, Problem> {
    let material = &raw.value;
    Ok(FabricMaterial {
        thickness: positive(&material.thickness, Quantity::Length, units)?,
        density: positive(&material.density, Quantity::Density, units)?,
        elasticity: elasticity(raw, units)?,
        damping: material.damping.as_ref().map_or(Ok(DAMPING), |at| {
            bounded(at, Quantity::Pure, units, "a number from 0 to 1", |share| (0.0..=1.0).contains(&share))
        })?,
    })
}

fn elasticity(raw: &At<RawMaterial>, units: UnitSystem) -> Result<Elasticity, Problem> {
    let young = &raw.value.young;
    match &young.value {
        NumberOr::Number(value) => isotropic(raw, At { value: *value, span: young.span.clone() }, units),
        NumberOr::Array(moduli) => match moduli.as_slice() {
            [warp, weft] => woven(raw, [warp, weft], units),
            others => {
                let found = format!("an array of {} numbers", others.len());
                Err(Problem::value(&young.span, found, "one number, or two: along the warp, along the weft"))
            }
        },
    }
}

fn isotropic(raw: &At<RawMaterial>, young: At<f64>, units: UnitSystem) -> Result<Elasticity, Problem> {
    let material = &raw.value;
    let given =
        [("shear", material.shear.as_ref().map(|at| &at.span)), ("fibre", material.fibre.as_ref().map(|at| &at.span))];
    if let Some((key, span)) = given.into_iter().find_map(|(key, span)| Some((key, span?))) {
        let found = format!("`{key}` beside one `young`");
        let allowed = "with two moduli, `young = [WARP, WEFT]`: of one the material is the same in all directions";
        return Err(Problem::value(span, found, allowed));
    }
    let Some(poisson) = &material.poisson else {
        return Err(Problem::missing(&raw.span, "poisson", "a number from 0 to 0.5, with one `young`"));
    };
    Ok(Elasticity::Isotropic {
        young: positive(&young, Quantity::Pressure, units)?,
        poisson: bounded(poisson, Quantity::Pure, units, "a number from 0 to 0.5", |ratio| {
            (0.0..=0.5).contains(&ratio)
        })?,
    })
}

fn woven(raw: &At<RawMaterial>, [warp, weft]: [&At<f64>; 2], units: UnitSystem) -> Result<Elasticity, Problem> {
    let material = &raw.value;
    let Some(shear) = &material.shear else {
        return Err(Problem::missing(&raw.span, "shear", "a positive number, with two moduli in `young`"));
    };
    let Some(fibre) = &material.fibre else {
        return Err(Problem::missing(&raw.span, "fibre", "the direction of the warp, with two moduli in `young`"));
    };
    let young = [positive(warp, Quantity::Pressure, units)?, positive(weft, Quantity::Pressure, units)?];
    let shear = positive(shear, Quantity::Pressure, units)?;
    let fibre = direction(fibre)?;
    let Some(poisson) = &material.poisson else { return Ok(Elasticity::Woven { young, shear, fibre }) };
    // The energy of a strain is positive where nu12 nu21 < 1, and nu21 = nu12 E2/E1.
    let most = (young[0] / young[1]).sqrt();
    let allowed = format!("a number from 0 to below {most:.4}, the root of the ratio of the moduli");
    let poisson =
        bounded(poisson, Quantity::Pure, units, &allowed, |ratio| ratio >= 0.0 && ratio < most * (1.0 - 1e-6))?;
    Ok(Elasticity::Orthotropic { young, poisson, shear, fibre })
}
