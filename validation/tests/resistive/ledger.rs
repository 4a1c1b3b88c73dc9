//! The energy ledger of a resistive medium.

use contact_laws::{RESISTANCE_LAWS, Role};

use super::rig::{law, sphere, with_ledger};

/// Work integrals are exact to the order of the solution, whose errors are near 1e-10.
const CLOSURE: f64 = 1e-8;

#[test]
fn every_effect_closes_its_ledger_on_vertical_and_oblique_impacts() {
    for baseline in ["two-term-vector", "two-term-components"] {
        let values: &[(&'static str, f64)] = match baseline {
            "two-term-vector" => &[("drag", 1.0), ("friction", 15.0)],
            _ => &[("drag_x", 0.4), ("friction_x", 40.0), ("drag_z", 0.5), ("friction_z", 70.0)],
        };
        for entry in RESISTANCE_LAWS {
            let Role::Effect(_) = entry.role else { continue };
            for angle in [90.0, 40.0] {
                let laws = vec![law(baseline, values), law(entry.name, &[("q", 0.3)])];
                let impact = sphere(laws, 2.0, angle);
                let (ending, closure) = with_ledger(&impact);
                let name = entry.name;
                assert!(ending.stopped, "{baseline} + {name} at {angle} deg did not stop");
                assert!(closure < CLOSURE, "{baseline} + {name} at {angle} deg: {closure:e}");
            }
        }
    }
}
