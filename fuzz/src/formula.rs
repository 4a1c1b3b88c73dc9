//! Formulas of a model.

use resistive::formula::Formula;

/// Names that a formula may use.
const VARIABLES: [&str; 4] = ["v", "z", "rho", "A"];

/// Values of them that are harmless, and that are not.
const POINTS: [[f64; 4]; 3] =
    [[0.0; 4], [1.5, -0.25, 2500.0, 1e-3], [-1e300, 1e-300, f64::MAX, 3.0]];

/// What comes of the formula `bytes`: one that is accepted gives the same bits twice, one that is refused
/// points into its text.
///
/// # Panics
/// Where that does not hold.
pub fn outcome(bytes: &[u8]) -> String {
    let Ok(text) = std::str::from_utf8(bytes) else { return "no text".to_owned() };
    match Formula::parse(text, &VARIABLES) {
        Ok(formula) => {
            let at = |name: &String| {
                let at = VARIABLES.iter().position(|known| known == name);
                at.expect("it uses what it may use, and nothing else")
            };
            let places: Vec<usize> = formula.variables().iter().map(at).collect();
            for point in POINTS {
                let values: Vec<f64> = places.iter().map(|place| point[*place]).collect();
                let [first, second] = [(); 2].map(|()| formula.value(&values).to_bits());
                assert_eq!(first, second, "the same formula, another value");
            }
            format!("a formula of {places:?}")
        }
        Err(error) => {
            assert!(text.get(error.at.clone()).is_some(), "{:?} is not in the text", error.at);
            error.to_string()
        }
    }
}
