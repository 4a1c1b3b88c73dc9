//! One force error per part of what was varied.

use super::normal::{NODES, Normal, solve};
use super::part::{ForceCell, ForceError};
use crate::misfit::covariate::{Covariate, DEPTH};

/// Most groups that the values of a covariate are cut into.
pub(super) const GROUPS: usize = 5;

/// Around each depth of a condition; one cell for all of the path where the depths are not told apart.
pub(super) fn cells(normal: &Normal) -> Vec<ForceCell> {
    if !normal.resolved {
        return mean(normal).into_iter().collect();
    }
    let half = 0.5 * normal.reach / (NODES - 1) as f64;
    let own = std::slice::from_ref(normal);
    let Some(solved) = solve(own, NODES, |_, node, at| f64::from(u8::from(node == at))) else {
        return Vec::new();
    };
    let cell = |at: usize| {
        let (force_error, se) = solved.get(at)?;
        let from = (normal.depth(at) - half).max(0.0);
        let to = (normal.depth(at) + half).min(normal.reach);
        let condition = normal.condition;
        Some(ForceCell { condition, from, to, force_error, se, significant: false })
    };
    (0..NODES).filter_map(cell).collect()
}

/// Over the whole path of a condition.
pub(super) fn mean(normal: &Normal) -> Option<ForceCell> {
    let (force_error, se) = solve(std::slice::from_ref(normal), 1, |_, _, _| 1.0)?.get(0)?;
    let Normal { condition, reach: to, .. } = *normal;
    Some(ForceCell { condition, from: 0.0, to, force_error, se, significant: false })
}

/// By depth, if every condition tells its depths apart.
pub(super) fn over_depth(normals: &[Normal]) -> Vec<ForceError> {
    if normals.is_empty() || normals.iter().any(|normal| !normal.resolved) {
        return Vec::new();
    }
    let deepest = normals.iter().fold(0.0_f64, |deepest, normal| deepest.max(normal.reach));
    let width = deepest / GROUPS as f64;
    let group = |normal: &Normal, node: usize| {
        Some(((normal.depth(node) / width).floor() as usize).min(GROUPS - 1))
    };
    let range = |at: usize| (at as f64 * width, (at + 1) as f64 * width);
    grouped(normals, DEPTH, GROUPS, group, range)
}

/// By a covariate of the conditions that has `value` in each, if it was varied.
pub(super) fn over_conditions(
    normals: &[Normal],
    over: Covariate,
    value: impl Fn(usize) -> Option<f64>,
) -> Vec<ForceError> {
    let mut values: Vec<f64> = normals.iter().filter_map(|n| value(n.condition)).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    if values.len() < 2 {
        return Vec::new();
    }
    let groups = values.len().min(GROUPS);
    let group_of = |place: usize| place * groups / values.len();
    let group = |normal: &Normal, _: usize| {
        let value = value(normal.condition)?;
        values.iter().position(|other| *other >= value).map(group_of)
    };
    let range = |at: usize| {
        let inside = || (0..values.len()).filter(|&place| group_of(place) == at);
        let ends = (inside().next(), inside().next_back());
        let end = |place: Option<usize>| place.map_or(0.0, |place| values[place]);
        (end(ends.0), end(ends.1))
    };
    grouped(normals, over, groups, group, range)
}

fn grouped(
    normals: &[Normal],
    over: Covariate,
    groups: usize,
    group: impl Fn(&Normal, usize) -> Option<usize>,
    range: impl Fn(usize) -> (f64, f64),
) -> Vec<ForceError> {
    let member = |normal: &Normal, node: usize, at: usize| {
        f64::from(u8::from(group(normal, node) == Some(at)))
    };
    let Some(solved) = solve(normals, groups, member) else { return Vec::new() };
    let part = |at: usize| {
        let (force_error, se) = solved.get(at)?;
        let (from, to) = range(at);
        Some(ForceError { over: over.name, from, to, force_error, se })
    };
    (0..groups).filter_map(part).collect()
}
