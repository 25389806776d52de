//! The passes of a frame in the order in which they are recorded.

use super::pass::Pass;

/// A pass at its place in the frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    pub pass: Pass,
    pub scope: Scope,
    /// Level of a hierarchy or layer of the map, for passes that make one at a time.
    pub level: u32,
}

/// What a step is done for; its shaders find the number, or the first, in `push.index`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Scope {
    Frame,
    Light(u32),
    /// Views side by side, each so many on from the one before.
    Views {
        first: u32,
        count: u32,
        stride: u32,
    },
}

impl Scope {
    pub fn view(view: u32) -> Self {
        Self::Views {
            first: view,
            count: 1,
            stride: 1,
        }
    }

    /// View by view, if it has views.
    pub fn each(self) -> impl Iterator<Item = Self> {
        let count = match self {
            Self::Frame | Self::Light(_) => 1,
            Self::Views { count, .. } => count,
        };
        (0..count).map(move |index| match self {
            Self::Frame | Self::Light(_) => self,
            Self::Views { first, stride, .. } => Self::view(first + index * stride),
        })
    }

    /// Whether it is done for a view, alone or beside others.
    pub fn has_view(self, view: u32) -> bool {
        match self {
            Self::Frame | Self::Light(_) => false,
            Self::Views { .. } => self.each().any(|scope| scope == Self::view(view)),
        }
    }
}

/// All steps of a frame that draws every map.
#[derive(Debug, Clone, Default)]
pub struct Graph {
    pub steps: Vec<Step>,
}

impl Graph {
    /// Adds passes of the same scope.
    pub fn add(&mut self, scope: Scope, passes: impl IntoIterator<Item = Pass>) {
        self.add_levels(scope, passes.into_iter().map(|pass| (pass, 0)));
    }

    /// Adds passes of the same scope with their levels.
    pub fn add_levels(&mut self, scope: Scope, passes: impl IntoIterator<Item = (Pass, u32)>) {
        let step = |(pass, level)| Step { pass, scope, level };
        self.steps.extend(passes.into_iter().map(step));
    }
}

/// The passes' names with how often each is there, in the order of their first step.
pub fn counts<'a>(steps: impl IntoIterator<Item = &'a Step>) -> Vec<(&'static str, u32)> {
    let mut counts: Vec<(&'static str, u32)> = Vec::new();
    for step in steps {
        match counts.iter_mut().find(|(name, _)| *name == step.pass.name) {
            Some((_, count)) => *count += 1,
            None => counts.push((step.pass.name, 1)),
        }
    }
    counts
}
