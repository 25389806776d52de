//! Microrects [Schwarz08 §5.2]: twin of `microrects.comp`, in the two passes of the paper, each of which marks what it has joined.

use super::contour::ShadowMap;

/// An occluder: a rectangle of the map's texels, first and last, at the depth of the nearest to the light in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    pub depth: f32,
    pub first: [i32; 2],
    pub last: [i32; 2],
}

/// A level: side × side microrects, row by row; None where there is nothing.
pub struct Level {
    pub side: i32,
    pub rects: Vec<Option<Rect>>,
}

/// The neighbours that the first pass may join a microrect with.
const AFTER: [[i32; 2]; 3] = [[1, 0], [0, 1], [1, 1]];

impl Level {
    /// Level 0: the map's texels.
    pub fn of_map(map: &ShadowMap) -> Self {
        let rect = |(i, &depth): (usize, &f32)| {
            let at = [i as i32 % map.size, i as i32 / map.size];
            (depth > 0.0).then_some(Rect {
                depth,
                first: at,
                last: at,
            })
        };
        Self {
            side: map.size,
            rects: map.depths.iter().enumerate().map(rect).collect(),
        }
    }

    fn at(&self, [x, y]: [i32; 2]) -> Option<Rect> {
        let inside = (0..self.side).contains(&x) && (0..self.side).contains(&y);
        let index = inside.then_some((y * self.side + x) as usize)?;
        self.rects[index]
    }

    fn depth(&self, at: [i32; 2]) -> f32 {
        self.at(at).map_or(0.0, |rect| rect.depth)
    }

    /// The next coarser level.
    pub fn coarser(&self) -> Self {
        let side = (self.side + 1) / 2;
        let places = || (0..side * side).map(|i| [i % side, i / side]);
        let (mut rects, mut joined) = (Vec::new(), vec![false; self.rects.len()]);
        let mut mark = |[x, y]: [i32; 2]| {
            if x < self.side && y < self.side {
                joined[(y * self.side + x) as usize] = true;
            }
        };
        for at in places() {
            let own = at.map(|i| 2 * i);
            let mut rect = self.at(own);
            let place = |step: [i32; 2]| [own[0] + step[0], own[1] + step[1]];
            for axis in 0..2 {
                let next = self.depth(place(AFTER[axis]));
                let to_own = (next - self.depth(own)).abs();
                let to_other = (next - self.depth(place(AFTER[axis].map(|i| 2 * i)))).abs();
                if at[axis] + 1 == side || to_own <= to_other {
                    rect = union(rect, self.at(place(AFTER[axis])));
                    mark(place(AFTER[axis]));
                }
            }
            let between = self.at(place(AFTER[2]));
            if at.iter().any(|i| i + 1 == side) || holds(rect, between) {
                rect = union(rect, between);
                mark(place(AFTER[2]));
            }
            rects.push(rect);
        }
        for (at, rect) in places().zip(&mut rects) {
            for step in AFTER {
                let before = [0, 1].map(|axis| 2 * at[axis] - step[axis]);
                let is_joined = |[x, y]: [i32; 2]| joined[(y * self.side + x) as usize];
                if before.iter().all(|i| *i >= 0 && *i < self.side) && !is_joined(before) {
                    *rect = union(*rect, self.at(before));
                }
            }
        }
        Self { side, rects }
    }
}

fn union(a: Option<Rect>, b: Option<Rect>) -> Option<Rect> {
    let (Some(a), Some(b)) = (a, b) else {
        return a.or(b);
    };
    Some(Rect {
        depth: a.depth.max(b.depth),
        first: [0, 1].map(|axis| a.first[axis].min(b.first[axis])),
        last: [0, 1].map(|axis| a.last[axis].max(b.last[axis])),
    })
}

fn holds(outer: Option<Rect>, inner: Option<Rect>) -> bool {
    let inside = |outer: Rect, inner: Rect| {
        (0..2).all(|axis| {
            outer.first[axis] <= inner.first[axis] && outer.last[axis] >= inner.last[axis]
        })
    };
    inner.is_none_or(|inner| outer.is_some_and(|outer| inside(outer, inner)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: i32 = 45;

    /// Two planes of different depths, and holes.
    fn depths() -> Vec<f32> {
        let depth = |i: i32| {
            let hash = (i as u32).wrapping_mul(2_654_435_761) >> 20;
            match (i % SIZE + i / SIZE * 2 < 70, hash % 7) {
                (_, 0) => 0.0,
                (true, _) => 0.3 + 1e-3 * (i % SIZE) as f32,
                (false, _) => 0.8 - 1e-3 * (i / SIZE) as f32,
            }
        };
        (0..SIZE * SIZE).map(depth).collect()
    }

    /// [Schwarz08 §5.2] No occluder is missed, none has become farther, and none reaches another's reference point.
    #[test]
    fn all_occluders_are_inside_and_extents_end_before_the_next_reference_points() {
        let depths = depths();
        let mut level = Level::of_map(&ShadowMap {
            size: SIZE,
            depths: &depths,
        });
        for number in 1..=6 {
            level = level.coarser();
            assert_eq!(level.side, (SIZE + (1 << number) - 1) >> number);
            let mut nearest = vec![0.0f32; depths.len()];
            for (i, rect) in level.rects.iter().enumerate() {
                let Some(rect) = rect else { continue };
                for axis in 0..2 {
                    let index = [i as i32 % level.side, i as i32 / level.side][axis];
                    let reference = index << number;
                    assert!(rect.first[axis] > reference - (1 << number));
                    assert!(rect.last[axis] < reference + (1 << number));
                }
                for y in rect.first[1]..=rect.last[1] {
                    for x in rect.first[0]..=rect.last[0] {
                        let texel = &mut nearest[(y * SIZE + x) as usize];
                        *texel = texel.max(rect.depth);
                    }
                }
            }
            assert!(
                nearest
                    .iter()
                    .zip(&depths)
                    .all(|(found, depth)| found >= depth)
            );
        }
    }

    /// [Schwarz08, fig. 5] A neighbour goes to the one whose depth is nearest to its own: surfaces stay apart.
    #[test]
    fn texels_join_the_surface_that_they_are_of() {
        // Two surfaces that meet beside a pair's border.
        let size = 8;
        let depths: Vec<f32> = (0..64)
            .map(|i| if i % size < 3 { 0.2 } else { 0.6 })
            .collect();
        let level = Level::of_map(&ShadowMap {
            size,
            depths: &depths,
        })
        .coarser();
        let row: Vec<_> = (level.rects[4..8].iter())
            .map(|rect| rect.map(|rect| (rect.first[0], rect.last[0], rect.depth)))
            .collect();
        assert_eq!(
            row,
            [
                Some((0, 1, 0.2)),
                // Not with its right neighbour, as a micropatch would be.
                Some((2, 2, 0.2)),
                Some((3, 5, 0.6)),
                Some((6, 7, 0.6)),
            ]
        );
    }
}
