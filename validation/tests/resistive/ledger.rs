//! The energy ledger of a resistive medium.

use resistive::{RESISTANCE_LAWS, Role};

use super::rig::{law, spinning_sphere, with_ledger};

/// Work integrals are exact to the order of the solution, whose errors are near 1e-10.
const CLOSURE: f64 = 1e-8;

/// Forward (rad/s): some ten times slower at the surface than the impact.
const SPIN: f64 = 15.0;

#[test]
fn every_effect_closes_its_ledger_on_vertical_and_oblique_impacts() {
    for baseline in ["two-term-vector", "two-term-components", "poncelet"] {
        let values: &[(&'static str, f64)] = match baseline {
            "two-term-vector" => &[("drag", 1.0), ("friction", 15.0)],
            "two-term-components" => {
                &[("drag_x", 0.4), ("friction_x", 40.0), ("drag_z", 0.5), ("friction_z", 70.0)]
            }
            _ => &[("inertial", 0.5), ("resistance", 3.0)],
        };
        for entry in RESISTANCE_LAWS {
            let Role::Effect(_) = entry.role else { continue };
            for angle in [90.0, 40.0] {
                let laws = vec![law(baseline, values), law(entry.name, &[("q", 0.3)])];
                let impact = spinning_sphere(laws, 2.0, angle, SPIN);
                let (ending, closure) = with_ledger(&impact);
                let name = entry.name;
                assert!(ending.stopped, "{baseline} + {name} at {angle} deg did not stop");
                assert!(closure < CLOSURE, "{baseline} + {name} at {angle} deg: {closure:e}");
            }
        }
    }
}
