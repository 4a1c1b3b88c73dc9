//! Arguments of `plunge import`.

use std::path::PathBuf;

/// Arguments of `plunge import`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// Tables of tracking programs, spreadsheets, patterns or a folder of them; an import.toml; or the folder
    /// that `plunge export MODEL --to lammps` wrote, and in which LAMMPS has run.
    #[arg(required_unless_present = "from")]
    pub(crate) files: Vec<PathBuf>,
    /// The folder of the measurement set to write. Of LAMMPS: the log, or a folder for it; without it, into
    /// its own folder.
    #[arg(short, long, value_name = "SET|RUN.mcap")]
    pub(crate) out: Option<PathBuf>,
    /// Replace what is there.
    #[arg(long)]
    pub(crate) force: bool,
    /// Print one JSON object to stdout.
    #[arg(long)]
    pub(crate) json: bool,
    /// Print nothing on success.
    #[arg(long)]
    pub(crate) quiet: bool,
    #[command(flatten)]
    pub(crate) tables: Tables,
}

/// What no table holds.
#[derive(clap::Args, Debug)]
#[command(next_help_heading = "Tables of tracked drops")]
pub(crate) struct Tables {
    /// Repeat the import that this import.toml holds.
    #[arg(long, value_name = "import.toml", conflicts_with = "files")]
    pub(crate) from: Option<PathBuf>,
    /// Diameter of the body, such as 25.4mm; {field} stands for a field of --condition, here and below.
    #[arg(long)]
    pub(crate) diameter: Option<String>,
    /// Mass of the body, such as "67 g".
    #[arg(long)]
    pub(crate) mass: Option<String>,
    /// Shape of the body; sphere unless said.
    #[arg(long)]
    pub(crate) shape: Option<String>,
    /// Height of a cylinder or cone.
    #[arg(long)]
    pub(crate) height: Option<String>,
    /// Full apex angle of a cone, such as 60deg.
    #[arg(long)]
    pub(crate) apex: Option<String>,
    /// Diameter of a shaft behind a cylinder, hemisphere or cone; the mass is that of both.
    #[arg(long)]
    pub(crate) shaft_diameter: Option<String>,
    /// A table of bodies: body, diameter (mm), mass (g), shape.
    #[arg(long, value_name = "TABLE")]
    pub(crate) bodies: Option<PathBuf>,
    /// Level of the undisturbed surface on the axis of the table, such as 18.4cm or 812px; without it, from the contacts.
    #[arg(long, value_name = "LEVEL", allow_hyphen_values = true)]
    pub(crate) surface: Option<String>,
    /// The point of the body that was tracked: lowest or centre. It matters where --surface is given, and for bodies of several sizes.
    #[arg(long, value_name = "POINT")]
    pub(crate) tracked: Option<String>,
    /// The axis counts upward. Without it and --down, the fall tells.
    #[arg(long, conflicts_with = "down")]
    pub(crate) up: bool,
    /// The axis counts downward.
    #[arg(long)]
    pub(crate) down: bool,
    /// Length of a pixel, such as 0.21mm/px.
    #[arg(long)]
    pub(crate) scale: Option<String>,
    /// Frames per second, such as 650Hz: times are counted by frames.
    #[arg(long)]
    pub(crate) rate: Option<String>,
    /// Unit of positions where the table does not say it, or says another.
    #[arg(long, value_name = "UNIT")]
    pub(crate) length_unit: Option<String>,
    /// Unit of times, likewise.
    #[arg(long, value_name = "UNIT")]
    pub(crate) time_unit: Option<String>,
    /// Accept a fall whose acceleration differs from gravity.
    #[arg(long)]
    pub(crate) trust_units: bool,
    /// Gravity; 9.81 m/s^2 unless said.
    #[arg(long)]
    pub(crate) gravity: Option<String>,
    /// Height of release of the lowest point above the surface: the speed is that of a free fall from it.
    #[arg(long, value_name = "HEIGHT")]
    pub(crate) drop_height: Option<String>,
    /// How names of files or runs are made, such as "{body}_h{height}_r{repeat}", with {date} or {session} where days or
    /// pourings differ, and folders before `/`; without it, words and heights in names tell conditions, else speeds.
    #[arg(long, value_name = "PATTERN")]
    pub(crate) condition: Option<String>,
    /// Runs to go on without, separated by commas.
    #[arg(long, value_name = "RUNS")]
    pub(crate) leave_out: Option<String>,
    /// Name of a column: t=NAME, z=NAME (vertical), x=NAME or run=NAME. Repeatable.
    #[arg(long, value_name = "t=NAME")]
    pub(crate) column: Vec<String>,
    /// Depth of the bed from its surface to the bottom, such as 14cm.
    #[arg(long)]
    pub(crate) bed_depth: Option<String>,
    /// Bulk density of the bed, such as "1.52 g/cc".
    #[arg(long)]
    pub(crate) bulk_density: Option<String>,
    /// Mean diameter of the grains.
    #[arg(long)]
    pub(crate) grain_diameter: Option<String>,
    /// Name of the set; that of its folder unless said.
    #[arg(long)]
    pub(crate) id: Option<String>,
}
