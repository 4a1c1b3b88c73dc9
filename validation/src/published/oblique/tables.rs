//! Tables 1 to 3 of Wang, Ye & Zheng, Eur. Phys. J. E 35, 7 (2012), and the curves that they stand for.

/// A straight line over the impact speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Per m/s.
    pub slope: f64,
    /// At rest.
    pub intercept: f64,
}

/// The stopping time over the impact speed (equation 7).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StoppingTime {
    /// `η₁ exp(−η₂ v) + η₃` above 30°: s, s/m, s.
    Exponential([f64; 3]),
    /// `χ₁ v + χ₂` below 30°: s²/m, s.
    Linear(Line),
}

/// The force law of equations 8 and 9; its units are not printed, and kg/m and N/m make its stopping times
/// come out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceLaw {
    /// α (kg/m).
    pub drag: f64,
    /// f (N/m).
    pub friction: f64,
}

/// What the three tables say of an impact angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Published {
    /// Above the horizontal (deg).
    pub angle_deg: f64,
    /// Range d_x (s, m).
    pub range: Option<Line>,
    /// Depth d_y (s, m).
    pub depth: Line,
    /// None is given at 30°.
    pub stopping_time: Option<StoppingTime>,
    /// Horizontal force law.
    pub horizontal: Option<ForceLaw>,
    /// Vertical force law, of 30° and more.
    pub vertical: Option<ForceLaw>,
}

impl Line {
    /// Its value at the impact speed `v` (m/s).
    pub fn at(&self, v: f64) -> f64 {
        self.slope * v + self.intercept
    }
}

impl StoppingTime {
    /// The stopping time (s) at the impact speed `v` (m/s).
    pub fn at(&self, v: f64) -> f64 {
        match self {
            Self::Exponential([eta_1, eta_2, eta_3]) => eta_1 * libm::exp(-eta_2 * v) + eta_3,
            Self::Linear(line) => line.at(v),
        }
    }
}

/// What is published of `angle_deg`; `None` for an angle that is not in the tables.
pub fn published(angle_deg: f64) -> Option<&'static Published> {
    PUBLISHED.iter().find(|one| (one.angle_deg - angle_deg).abs() < 1e-9)
}

const fn line(slope: f64, intercept: f64) -> Line {
    Line { slope, intercept }
}

const fn law(drag: f64, friction: f64) -> Option<ForceLaw> {
    Some(ForceLaw { drag, friction })
}

/// Every angle of the tables, flattest first.
pub static PUBLISHED: [Published; 7] = [
    Published {
        angle_deg: 5.0,
        range: Some(line(0.13553, -0.01677)),
        depth: line(0.0064, 0.08188),
        stopping_time: Some(StoppingTime::Linear(line(0.06193, 0.31617))),
        horizontal: None,
        vertical: None,
    },
    Published {
        angle_deg: 15.0,
        range: Some(line(0.09257, 0.00876)),
        depth: line(0.01193, 0.07595),
        stopping_time: Some(StoppingTime::Linear(line(0.0217, 0.27803))),
        horizontal: law(0.07803, 2.02849),
        vertical: None,
    },
    Published {
        angle_deg: 30.0,
        range: Some(line(0.05877, 0.01848)),
        depth: line(0.01802, 0.07257),
        stopping_time: None,
        horizontal: law(0.10083, 2.00946),
        vertical: law(0.18763, 3.29346),
    },
    Published {
        angle_deg: 45.0,
        range: Some(line(0.04042, 0.01734)),
        depth: line(0.02309, 0.07007),
        stopping_time: Some(StoppingTime::Exponential([0.17352, 1.16011, 0.19274])),
        horizontal: law(0.16064, 1.66344),
        vertical: law(0.18768, 3.87968),
    },
    Published {
        angle_deg: 60.0,
        range: Some(line(0.02581, 0.01289)),
        depth: line(0.02892, 0.06528),
        stopping_time: Some(StoppingTime::Exponential([0.17091, 1.17882, 0.1865])),
        horizontal: law(0.29973, 1.5175),
        vertical: law(0.2184, 4.02227),
    },
    Published {
        angle_deg: 75.0,
        range: Some(line(0.01339, 0.00486)),
        depth: line(0.03112, 0.06472),
        stopping_time: Some(StoppingTime::Exponential([0.17046, 1.18021, 0.17066])),
        horizontal: law(0.41568, 1.17189),
        vertical: law(0.23059, 4.25032),
    },
    Published {
        angle_deg: 90.0,
        range: None,
        depth: line(0.03079, 0.06613),
        stopping_time: Some(StoppingTime::Exponential([0.16083, 1.42537, 0.1591])),
        horizontal: None,
        vertical: law(0.2706, 4.50602),
    },
];
