//! One impact with an effect of one's own, as a formula and as a Rust type:
//! `cargo run -p validation --example late_drag`.

mod effect;

use std::io::Write;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut stdout = std::io::stdout().lock();
    for (impact, how) in effect::impacts().iter().zip(["as a formula", "as a Rust type"]) {
        let depth = impact.run(1.0, &mut ())?.parts[0].depth;
        writeln!(stdout, "{how}: {:.9} mm deep", 1e3 * depth)?;
    }
    Ok(())
}
