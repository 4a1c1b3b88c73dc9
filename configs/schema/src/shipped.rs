//! The models that come with the program.

/// A model that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shipped {
    /// Its name on the command line.
    pub name: &'static str,
    /// One line about it.
    pub summary: &'static str,
    /// The file itself.
    pub text: &'static str,
}

/// All of them.
pub static SHIPPED: &[Shipped] = &[
    Shipped {
        name: "vertical-2d",
        summary: "A disc straight down into 15 000 discs, 2 m/s.",
        text: include_str!("../../vertical-2d.toml"),
    },
    Shipped {
        name: "oblique-2d",
        summary: "The same at 45° from the horizontal.",
        text: include_str!("../../oblique-2d.toml"),
    },
    Shipped {
        name: "grazing-2d",
        summary: "The same at 15° from the horizontal: long range, shallow.",
        text: include_str!("../../grazing-2d.toml"),
    },
    Shipped {
        name: "rolling-2d",
        summary: "The vertical impact with rolling resistance between the grains.",
        text: include_str!("../../rolling-2d.toml"),
    },
    Shipped {
        name: "wet-2d",
        summary: "The vertical impact into wet Hertz–Mindlin grains.",
        text: include_str!("../../wet-2d.toml"),
    },
    Shipped {
        name: "cohesive-2d",
        summary: "The vertical impact into viscoelastic grains that stick (JKR).",
        text: include_str!("../../cohesive-2d.toml"),
    },
    Shipped {
        name: "fine-2d",
        summary: "The vertical impact with restitution by speed and weak cohesion (DMT).",
        text: include_str!("../../fine-2d.toml"),
    },
    Shipped {
        name: "sphere-3d",
        summary: "A steel ball straight down into 20 000 spheres, 2 m/s: the usual drop test.",
        text: include_str!("../../sphere-3d.toml"),
    },
    Shipped {
        name: "hemisphere-3d",
        summary: "A hemisphere, dome first, into 20 000 spheres, 2 m/s.",
        text: include_str!("../../hemisphere-3d.toml"),
    },
    Shipped {
        name: "cylinder-3d",
        summary: "The same with a cylinder, flat face first.",
        text: include_str!("../../cylinder-3d.toml"),
    },
    Shipped {
        name: "cone-3d",
        summary: "The same with a cone, tip first.",
        text: include_str!("../../cone-3d.toml"),
    },
    Shipped {
        name: "plate-3d",
        summary: "A round plate pushed slowly into 18 000 spheres.",
        text: include_str!("../../plate-3d.toml"),
    },
    Shipped {
        name: "two-link-2d",
        summary: "A chain of two links, tips first, into 20 000 discs.",
        text: include_str!("../../two-link-2d.toml"),
    },
    Shipped {
        name: "two-link-3d",
        summary: "A chain of two links, tips first, into 20 000 spheres.",
        text: include_str!("../../two-link-3d.toml"),
    },
    Shipped {
        name: "two-term-vector",
        summary: "A steel sphere into glass beads by a force law, along the velocity.",
        text: include_str!("../../two-term-vector.toml"),
    },
    Shipped {
        name: "two-term-components",
        summary: "The disc at 45° by a force law, component by component.",
        text: include_str!("../../two-term-components.toml"),
    },
    Shipped {
        name: "poncelet",
        summary: "A hemisphere by Poncelet's law, with example values.",
        text: include_str!("../../poncelet.toml"),
    },
    Shipped {
        name: "bekker",
        summary: "A plate pushed slowly into soil by Bekker's law, with example values.",
        text: include_str!("../../bekker.toml"),
    },
    Shipped {
        name: "link",
        summary: "A free link into sand by the resistive force on slender rods.",
        text: include_str!("../../link.toml"),
    },
];

/// The one called `name`, with or without `.toml`.
pub fn find(name: &str) -> Option<&'static Shipped> {
    let name = name.strip_suffix(".toml").unwrap_or(name);
    SHIPPED.iter().find(|shipped| shipped.name == name)
}
