use std::time::{Duration, Instant};

/// A part of the work that is timed on its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Phase {
    /// Reading the scene file.
    Load,
    /// Reading meshes and textures, building the BVHs and the light tables.
    Compile,
    /// Tracing photons.
    Photons,
    /// Building the photon maps.
    MapBuild,
    /// Camera paths.
    EyePasses,
    /// Encoding and writing pictures.
    Write,
}

impl Phase {
    /// All phases, in the order of a render.
    pub const ALL: [Self; 6] =
        [Self::Load, Self::Compile, Self::Photons, Self::MapBuild, Self::EyePasses, Self::Write];

    /// A name for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Load => "load scene",
            Self::Compile => "compile scene",
            Self::Photons => "trace photons",
            Self::MapBuild => "build photon maps",
            Self::EyePasses => "eye passes",
            Self::Write => "write pictures",
        }
    }
}

/// Wall-clock time that each phase took, added up over passes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Timings {
    spent: [Duration; Phase::ALL.len()],
}

impl Timings {
    /// Adds to a phase.
    pub fn add(&mut self, phase: Phase, elapsed: Duration) {
        self.spent[phase as usize] += elapsed;
    }

    /// Runs `f` on a phase's account.
    pub fn time<R>(&mut self, phase: Phase, f: impl FnOnce() -> R) -> R {
        let start = Instant::now();
        let result = f();
        self.add(phase, start.elapsed());
        result
    }

    /// Adds all that another account holds.
    pub fn merge(&mut self, other: &Self) {
        for (phase, elapsed) in other.iter() {
            self.add(phase, elapsed);
        }
    }

    /// What a phase took so far.
    pub fn get(&self, phase: Phase) -> Duration {
        self.spent[phase as usize]
    }

    /// All phases with what they took, in the order of a render.
    pub fn iter(&self) -> impl Iterator<Item = (Phase, Duration)> {
        Phase::ALL.into_iter().map(|phase| (phase, self.get(phase)))
    }

    /// The sum of all phases.
    pub fn total(&self) -> Duration {
        self.spent.iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_add_up() {
        let mut timings = Timings::default();
        timings.add(Phase::EyePasses, Duration::from_millis(3));
        timings.add(Phase::EyePasses, Duration::from_millis(4));
        timings.add(Phase::Write, Duration::from_millis(5));
        assert_eq!(timings.time(Phase::Load, || 7), 7);
        assert_eq!(timings.get(Phase::EyePasses), Duration::from_millis(7));
        assert_eq!(timings.total(), Duration::from_millis(12) + timings.get(Phase::Load));
        let mut sum = timings.clone();
        sum.merge(&timings);
        assert_eq!(sum.get(Phase::Write), Duration::from_millis(10));
        let order: Vec<_> = timings.iter().map(|(phase, _)| phase as usize).collect();
        assert_eq!(order, [0, 1, 2, 3, 4, 5]);
    }
}
