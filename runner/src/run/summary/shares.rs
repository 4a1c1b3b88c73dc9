//! The energies of a summary as shares of what was supplied.

use super::EnergySummary;

/// Where energy came from and where it is: the uses add up to what was supplied, but for what is unaccounted for.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyShares {
    /// All that was supplied (J).
    pub supplied: f64,
    /// What supplied it: names and energies (J), none of them negative.
    pub sources: Vec<(String, f64)>,
    /// Where it is in the end; likewise.
    pub uses: Vec<(String, f64)>,
    /// What no account holds (J), if it is known.
    pub unaccounted: Option<f64>,
}

impl EnergySummary {
    /// Of this summary. An account that is negative is a source: a bed that has sunk, or a law that gives more than it
    /// takes.
    pub fn shares(&self) -> EnergyShares {
        let mut shares = EnergyShares {
            supplied: 0.0,
            sources: Vec::new(),
            uses: Vec::new(),
            unaccounted: self.unaccounted.map(|energy| -energy),
        };
        // An intruder that ends higher than it was has put energy into its height.
        let released = self.released.unwrap_or(0.0);
        shares.book("motion at impact".to_owned(), -self.initial);
        shares.book("height of the intruder".to_owned(), -released);
        for (name, energy) in &self.input {
            shares.book(name.replace('_', "-"), -energy);
        }
        for (name, energy) in &self.dissipated {
            shares.book(name.replace('_', "-"), *energy);
        }
        if let Some(elastic) = self.at_end.elastic {
            shares.book("springs".to_owned(), elastic);
        }
        shares.book("grains, motion and height".to_owned(), self.at_end.grains);
        shares.book("intruder in motion".to_owned(), self.at_end.intruder + released);
        shares.supplied = shares.sources.iter().map(|(_, energy)| energy).sum();
        shares
    }
}

impl EnergyShares {
    /// The share (%) of what was supplied; none where nothing was.
    pub fn percent(&self, energy: f64) -> Option<f64> {
        (self.supplied > 0.0).then(|| 100.0 * energy / self.supplied)
    }

    fn book(&mut self, name: String, energy: f64) {
        match energy {
            energy if energy > 0.0 => self.uses.push((name, energy)),
            energy if energy < 0.0 => self.sources.push((name, -energy)),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::super::FinalEnergy;
    use super::*;

    #[test]
    fn uses_and_what_is_unaccounted_for_add_up_to_what_was_supplied() {
        let by = |entries: &[(&str, f64)]| -> BTreeMap<String, f64> {
            entries.iter().map(|(name, energy)| ((*name).to_owned(), *energy)).collect()
        };
        // 1 J of motion and 0.7 J of height, 0.1 J put in, and a law that gives 0.02 J.
        let energy = EnergySummary {
            initial: 1.0,
            at_end: FinalEnergy { intruder: -0.6, grains: -0.03, elastic: Some(0.05) },
            dissipated: by(&[("sliding", 1.69), ("stiffness_change", -0.02)]),
            input: by(&[("wall", 0.1)]),
            released: Some(0.7),
            unaccounted: Some(-0.01),
            closure: Some(0.01),
        };
        let shares = energy.shares();
        assert!((shares.supplied - 1.85).abs() < 1e-12, "{shares:?}");
        let spent: f64 = shares.uses.iter().map(|(_, energy)| energy).sum();
        let all = spent + shares.unaccounted.expect("known");
        assert!((all - shares.supplied).abs() < 1e-12, "{shares:?}");
        assert!(shares.uses.iter().chain(&shares.sources).all(|(_, energy)| *energy > 0.0));
        assert_eq!(shares.percent(shares.supplied), Some(100.0));
    }
}
