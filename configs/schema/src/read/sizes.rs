//! The sizes of one entry of `[[bed.grains]]`.

use engine::bed::SizeDistribution;
use engine::grains::Space;
use engine::params::ParamSpec;

use super::{disc_area, mass, sphere_volume};
use crate::diagnostics::Diagnostic;
use crate::model::Material;
use crate::reader::{Answer, Found, TableReader};
use crate::specs;

/// The sizes, and what the grains are made of.
pub(super) fn sizes(table: &TableReader<'_>, space: Space) -> Option<(SizeDistribution, Material)> {
    let density = match space {
        Space::Planar => &specs::AREA_DENSITY,
        Space::Spatial => &specs::DENSITY,
    };
    if !table.has("distribution") {
        let diameter = table.number(&specs::GRAIN_DIAMETER);
        let content: fn(f64) -> f64 = match space {
            Space::Planar => disc_area,
            Space::Spatial => sphere_volume,
        };
        let content = diameter.map(|found| content(found.value));
        let mass = mass(table, &specs::GRAIN_MASS, density, content);
        return Some((SizeDistribution::Equal(diameter?.value), Material::Mass(mass?)));
    }
    let distribution = table.choice(
        "distribution",
        &["uniform", "lognormal", "list"],
        &[],
        "how the diameters are spread",
    );
    let density = match table.has("mass") {
        false => table.number(density),
        true => {
            table.reader.report(
                Diagnostic::error("grains of many sizes have no common `mass`")
                    .at(table.span_of("mass"), "of which grain?")
                    .with(table.span_of("distribution"), "many sizes")
                    .help(format!("write {}", density_example(space))),
            );
            None
        }
    };
    let sizes = match distribution? {
        "uniform" => uniform(table),
        "lognormal" => lognormal(table),
        _ => list(table),
    };
    Some((sizes?, Material::Density(density?.value)))
}

fn density_example(space: Space) -> &'static str {
    match space {
        Space::Planar => "density = \"2.5 kg/m^2\" in its place",
        Space::Spatial => "density = \"2500 kg/m^3\" in its place",
    }
}

fn uniform(table: &TableReader<'_>) -> Option<SizeDistribution> {
    let (min, max) =
        (table.number(&specs::GRAIN_DIAMETER_MIN), table.number(&specs::GRAIN_DIAMETER_MAX));
    let (min, max) = in_order(table, min?, max?)?;
    Some(SizeDistribution::Uniform { min, max })
}

fn lognormal(table: &TableReader<'_>) -> Option<SizeDistribution> {
    let median = table.number(&specs::GRAIN_DIAMETER_MEDIAN);
    let sigma = table.number(&specs::GRAIN_DIAMETER_SIGMA);
    let limit = |spec: &ParamSpec, reach: f64| match table.has(spec.key) {
        true => table.number(spec),
        false => {
            table.asks(spec.key, spec.meaning, || Answer::Number(*spec));
            let value = median?.value * libm::exp(reach * sigma?.value);
            table.note(spec, value);
            Some(Found { value, span: None })
        }
    };
    let min = limit(&specs::GRAIN_DIAMETER_MIN, -SizeDistribution::LOGNORMAL_REACH);
    let max = limit(&specs::GRAIN_DIAMETER_MAX, SizeDistribution::LOGNORMAL_REACH);
    let (min, max) = in_order(table, min?, max?)?;
    Some(SizeDistribution::Lognormal { median: median?.value, sigma: sigma?.value, min, max })
}

fn in_order(table: &TableReader<'_>, min: Found<f64>, max: Found<f64>) -> Option<(f64, f64)> {
    if min.value <= max.value {
        return Some((min.value, max.value));
    }
    table.reader.report(
        Diagnostic::error("the smallest diameter is larger than the largest")
            .at(min.span.or(table.header()), "the smallest")
            .with(max.span, "the largest"),
    );
    None
}

fn list(table: &TableReader<'_>) -> Option<SizeDistribution> {
    let read = |spec: &ParamSpec, example: &str| match table.has(spec.key) {
        true => table.numbers(spec)?,
        false => {
            table.missing_list(spec, example);
            None
        }
    };
    let diameters = read(&specs::GRAIN_DIAMETERS, "[\"2 mm\", \"3 mm\"]");
    let weights = read(&specs::GRAIN_WEIGHTS, "[3, 1]");
    let (diameters, weights) = (diameters?, weights?);
    let values = |list: Vec<Found<f64>>| list.into_iter().map(|found| found.value).collect();
    let (diameters, weights): (Vec<f64>, Vec<f64>) = (values(diameters), values(weights));
    if diameters.len() != weights.len() {
        table.reader.report(
            Diagnostic::error(format!(
                "{} diameters and {} weights",
                diameters.len(),
                weights.len()
            ))
            .at(table.span_of("weights"), "expected one for each diameter")
            .with(table.span_of("diameters"), "the diameters"),
        );
        return None;
    }
    if weights.iter().all(|weight| *weight == 0.0) {
        table.reader.report(
            Diagnostic::error("every weight is 0")
                .at(table.span_of("weights"), "expected at least one share above 0"),
        );
        return None;
    }
    Some(SizeDistribution::List { diameters, weights })
}
