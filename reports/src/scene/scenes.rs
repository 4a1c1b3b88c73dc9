//! What is seen of an impact, frame by frame.

use std::ops::ControlFlow;

use exchange::frames::{Frame, each_frame};

use super::{Extent, Force, Impact, Scene, SceneError, View};

impl Impact {
    /// Hands the scene of each of these `frames`, which rise, to `visit`, until it breaks off.
    pub fn scenes(
        &self,
        view: &View,
        window: &Extent,
        frames: &[usize],
        mut visit: impl FnMut(Scene) -> ControlFlow<()>,
    ) -> Result<(), SceneError> {
        let mut wanted = frames.iter().copied().peekable();
        each_frame(&self.log, |frame| {
            if wanted.next_if_eq(&frame.number).is_some() {
                visit(self.scene(view, window, frame))?;
            }
            match wanted.peek() {
                Some(_) => ControlFlow::Continue(()),
                None => ControlFlow::Break(()),
            }
        })?;
        Ok(())
    }

    /// What is seen of `frame`.
    fn scene(&self, view: &View, window: &Extent, frame: &Frame) -> Scene {
        let flat = |place: [f64; 3]| {
            let [u, v, _] = view.place(place);
            [u, v]
        };
        let until = |path: &[[f64; 3]]| {
            path.iter().take(frame.number + 1).map(|place| flat(*place)).collect()
        };
        let forces = frame.bodies.iter().filter_map(|body| {
            let newton = self.forces.on(&body.name, frame.time)?;
            Some(Force { at: flat(body.centre), newton: flat(newton) })
        });
        Scene {
            frame: frame.number,
            time: frame.time,
            window: *window,
            discs: view.discs(frame, window, self),
            bodies: frame.bodies.iter().map(|body| view.outline(body)).collect(),
            paths: self.paths.iter().map(|(_, path)| until(path)).collect(),
            forces: forces.collect(),
        }
    }
}
