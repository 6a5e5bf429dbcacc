use crate::MaterialId;

/// The dielectrics that a point is inside of, outermost first: nested dielectrics by priority (Schmidt & Budge
/// 2002, "Simple nested dielectrics in ray traced images"). A higher priority wins; among equals the last entered.
///
/// Holds up to eight; a ninth is not entered.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MediumStack {
    entries: [Medium; 8],
    len: u8,
}

/// A dielectric that fills a solid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Medium {
    /// Material of its boundary.
    pub material: MaterialId,
    /// Refractive index.
    pub ior: f32,
    /// The index before its boundary, where the boundary by itself decides how light is refracted; 0: nesting does.
    pub outside: f32,
    /// Which of two overlapping dielectrics is there: the higher.
    pub priority: i32,
}

/// What a dielectric boundary separates, once nesting is resolved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Boundary {
    /// Nothing: the boundary lies inside a dielectric that outranks it, or between equal ones.
    Invisible,
    /// `eta` = index behind the front side of the surface over the index before it.
    Interface {
        /// Relative index, inside over outside.
        eta: f32,
    },
}

impl MediumStack {
    /// The dielectric that rules here; `None` in vacuum.
    pub fn current(&self) -> Option<Medium> {
        let mut best: Option<Medium> = None;
        for m in &self.entries[..self.len as usize] {
            if best.is_none_or(|b| m.priority >= b.priority) {
                best = Some(*m);
            }
        }
        best
    }

    /// Refractive index here.
    pub fn ior(&self) -> f32 {
        self.current().map_or(1.0, |m| m.ior)
    }

    /// This stack after crossing the boundary of `medium` inward (`entering`) or outward.
    pub fn crossed(mut self, medium: Medium, entering: bool) -> Self {
        let len = self.len as usize;
        if entering {
            if len < self.entries.len() {
                self.entries[len] = medium;
                self.len += 1;
            }
        } else if let Some(i) = self.left(medium) {
            self.entries.copy_within(i + 1..len, i);
            self.entries[len - 1] = Medium::default();
            self.len -= 1;
        }
        self
    }

    /// Which entry a ray leaves through the boundary of `medium`: the last of its material. Boundaries that decide by themselves
    /// may be several materials around one solid, so that there it is the last such one at least.
    fn left(&self, medium: Medium) -> Option<usize> {
        let entered = &self.entries[..self.len as usize];
        let own = entered.iter().rposition(|m| m.material == medium.material);
        own.or_else(|| entered.iter().rposition(|m| m.outside > 0.0 && medium.outside > 0.0))
    }

    /// What the boundary of `medium` separates for a ray that is in this stack and would enter or leave.
    pub fn boundary(&self, medium: Medium, entering: bool) -> Boundary {
        if medium.outside > 0.0 {
            return Boundary::Interface { eta: medium.ior / medium.outside };
        }
        let after = self.crossed(medium, entering);
        let (here, there) = (self.current(), after.current());
        let key = |m: Option<Medium>| m.map(|m| m.material);
        if key(here) == key(there) {
            // Also the exit from a solid that was never entered (an open or flipped mesh): the ray was inside
            // all along, as far as can be told.
            if !entering && self == &after {
                return Boundary::Interface { eta: medium.ior / self.ior() };
            }
            return Boundary::Invisible;
        }
        let (here, there) = (self.ior(), after.ior());
        Boundary::Interface { eta: if entering { there / here } else { here / there } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn medium(id: u32, ior: f32, priority: i32) -> Medium {
        Medium { material: MaterialId(id), ior, outside: 0.0, priority }
    }

    #[test]
    fn water_in_glass_meets_glass_not_air() {
        let (glass, water) = (medium(1, 1.5, 1), medium(2, 1.33, 0));
        let outside = MediumStack::default();
        let in_glass = outside.crossed(glass, true);
        // The water's boundary lies inside the glass wall: invisible there.
        assert_eq!(in_glass.boundary(water, true), Boundary::Invisible);
        let in_both = in_glass.crossed(water, true);
        // Leaving the wall inward, water is what follows.
        let Boundary::Interface { eta } = in_both.boundary(glass, false) else { panic!("an interface") };
        assert!((eta - 1.5 / 1.33).abs() < 1e-6);
        assert_eq!(in_both.crossed(glass, false).current(), Some(water));
    }

    #[test]
    fn a_hollow_globe_is_vacuum_inside() {
        let (glass, hollow) = (medium(1, 1.5, 0), medium(2, 1.0, 0));
        let inside = MediumStack::default().crossed(glass, true).crossed(hollow, true);
        assert_eq!(inside.ior(), 1.0, "last entered wins");
        let Boundary::Interface { eta } = inside.boundary(hollow, false) else { panic!("an interface") };
        assert!((eta - 1.0 / 1.5).abs() < 1e-6);
    }

    #[test]
    fn overlapping_shells_of_one_material_are_one_solid() {
        let glass = medium(1, 1.5, 0);
        let once = MediumStack::default().crossed(glass, true);
        let twice = once.crossed(glass, true);
        assert_eq!(once.boundary(glass, true), Boundary::Invisible);
        assert_eq!(twice.boundary(glass, false), Boundary::Invisible);
        assert_eq!(twice.crossed(glass, false).crossed(glass, false), MediumStack::default());
    }

    #[test]
    fn interfaces_decide_by_themselves() {
        // Milk in a glass: its side meets glass, its top air; both bound the one solid.
        let glass = Medium { outside: 1.0, ..medium(1, 1.5, 0) };
        let side = Medium { outside: 1.5, ..medium(2, 1.33, 0) };
        let top = Medium { outside: 1.0, ..medium(3, 1.33, 0) };
        let eta = |stack: MediumStack, m, entering| match stack.boundary(m, entering) {
            Boundary::Interface { eta } => eta,
            Boundary::Invisible => panic!("an interface"),
        };
        let outside = MediumStack::default();
        assert_eq!(eta(outside, glass, true), 1.5);
        let wall = outside.crossed(glass, true);
        assert_eq!(eta(wall, side, true), 1.33 / 1.5);
        let milk = wall.crossed(side, true);
        assert_eq!(eta(milk, top, false), 1.33);
        // Through the top it is the milk that is left, although its side was entered.
        assert_eq!(milk.crossed(top, false), wall);
        assert_eq!(eta(outside, top, true), 1.33);
        assert_eq!(outside.crossed(top, true).crossed(side, false), outside);
    }

    #[test]
    fn leaving_what_was_never_entered_is_an_exit() {
        let glass = medium(1, 1.5, 0);
        let Boundary::Interface { eta } = MediumStack::default().boundary(glass, false) else {
            panic!("an interface")
        };
        assert!((eta - 1.5).abs() < 1e-6);
    }
}
