//! The contour of what occludes, by marching squares on the dual grid (algorithm.md §2), derived from its
//! definition: twin of `lib/contour.glsl`.

use glam::DVec2;

use super::receiver::Limit;

/// A map of `size` × `size` depths, row by row.
#[derive(Debug, Clone, Copy)]
pub struct ShadowMap<'a> {
    pub size: i32,
    pub depths: &'a [f32],
}

/// A directed piece of the contour, with the occluders on its left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// [texel] The ends.
    pub ends: [DVec2; 2],
    /// Their depths: those of the occluding samples beside them.
    pub depths: [f32; 2],
}

/// The corners of a cell, counter-clockwise; edge e runs from corner e to the next.
const CORNERS: [[i32; 2]; 4] = [[0, 0], [1, 0], [1, 1], [0, 1]];

impl ShadowMap<'_> {
    fn corners(&self, cell: [i32; 2]) -> [f32; 4] {
        CORNERS.map(|[x, y]| self.depths[((cell[1] + y) * self.size + cell[0] + x) as usize])
    }

    /// The contour's segments in a cell round the samples that pass `limit`.
    pub fn segments(&self, cell: [i32; 2], limit: &Limit) -> impl Iterator<Item = Segment> + use<> {
        let depths = self.corners(cell);
        segments_of(depths, cell, occluding(depths, cell, limit))
    }

    /// The contour's segments in the cells first … last, inclusive, one after the other.
    pub fn for_each_segment(
        &self,
        first: [i32; 2],
        last: [i32; 2],
        limit: &Limit,
        mut with: impl FnMut(Segment),
    ) {
        for y in first[1]..=last[1] {
            let row = |y: i32| {
                let start = y * self.size;
                &self.depths[(start + first[0]) as usize..=(start + last[0] + 1) as usize]
            };
            let cells = row(y).windows(2).zip(row(y + 1).windows(2));
            for (x, (below, above)) in (first[0]..).zip(cells) {
                let depths = [below[0], below[1], above[1], above[0]];
                // Most cells have nothing that could occlude.
                if depths.iter().all(|&depth| depth <= limit.least) {
                    continue;
                }
                let occludes = occluding(depths, [x, y], limit);
                if occludes.iter().all(|&occludes| occludes) {
                    continue;
                }
                segments_of(depths, [x, y], occludes).for_each(&mut with);
            }
        }
    }

    /// Whether the light's centre is hidden: the point `t` lies inside the contour (trap 1).
    pub fn hides(&self, t: DVec2, limit: &Limit) -> bool {
        let cell = [t.x.floor() as i32, t.y.floor() as i32];
        if cell.iter().any(|&i| i < 0 || i > self.size - 2) {
            return false;
        }
        occluding(self.corners(cell), cell, limit) == [true; 4]
            || self
                .segments(cell, limit)
                .any(|segment| segment.side_of(t) > 0.0)
    }
}

/// Which corners of a cell occlude.
fn occluding(depths: [f32; 4], cell: [i32; 2], limit: &Limit) -> [bool; 4] {
    std::array::from_fn(|i| {
        let corner = [0, 1].map(|axis| cell[axis] + CORNERS[i][axis]);
        limit.is_passed(corner, depths[i])
    })
}

/// The contour's segments in a cell with these depths at its corners, of which some occlude.
fn segments_of(
    depths: [f32; 4],
    cell: [i32; 2],
    occludes: [bool; 4],
) -> impl Iterator<Item = Segment> {
    let starts = (0..4).filter(move |&e| occludes[e] && !occludes[(e + 1) % 4]);
    starts.map(move |start| {
        // Round the occluders that hang together, clockwise, to the first of them: so the saddles keep
        // their two occluders apart.
        let mut first = start;
        while occludes[(first + 3) % 4] {
            first = (first + 3) % 4;
        }
        Segment {
            ends: [midpoint(cell, start), midpoint(cell, (first + 3) % 4)],
            depths: [depths[start], depths[first]],
        }
    })
}

fn midpoint(cell: [i32; 2], edge: usize) -> DVec2 {
    let corner = |i: usize| {
        let [x, y] = CORNERS[i % 4];
        DVec2::new(f64::from(cell[0] + x), f64::from(cell[1] + y))
    };
    0.5 * (corner(edge) + corner(edge + 1))
}

impl Segment {
    /// +1 where `t` lies on the left, the occluder's side, else −1. Exact: the ends are multiples of ½ and `t` an
    /// f32 within the map, so that the products are exact in f64 and their difference has the right sign.
    pub fn side_of(&self, t: DVec2) -> f64 {
        let [from, to] = self.ends;
        if (to - from).perp_dot(t - from) > 0.0 {
            1.0
        } else {
            -1.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contours_are_closed_and_go_counter_clockwise_round_occluders() {
        // Every pattern of 3 × 3 samples inside an empty frame.
        for pattern in 0..512 {
            let mut depths = [0.0f32; 25];
            for i in (0..9).filter(|i| pattern >> i & 1 == 1) {
                depths[(i / 3 + 1) * 5 + i % 3 + 1] = 1.0;
            }
            let map = ShadowMap {
                size: 5,
                depths: &depths,
            };
            let segments: Vec<Segment> = (0..16)
                .flat_map(|i| map.segments([i % 4, i / 4], &Limit::flat(0.5)))
                .collect();
            for segment in &segments {
                let next = segments
                    .iter()
                    .filter(|other| other.ends[0] == segment.ends[1]);
                assert_eq!(next.count(), 1, "pattern {pattern}");
            }
            // The shoelace formula: more than half a texel² round each occluder, less than one.
            let area: f64 = segments
                .iter()
                .map(|segment| 0.5 * segment.ends[0].perp_dot(segment.ends[1]))
                .sum();
            let occluders = f64::from(u32::count_ones(pattern as u32));
            assert!(
                area >= 0.5 * occluders && area <= occluders,
                "pattern {pattern}"
            );
        }
    }

    #[test]
    fn the_two_saddles_keep_occluders_apart() {
        for depths in [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 1.0, 0.0]] {
            let map = ShadowMap {
                size: 2,
                depths: &depths,
            };
            assert_eq!(map.segments([0, 0], &Limit::flat(0.5)).count(), 2);
            assert!(!map.hides(DVec2::splat(0.5), &Limit::flat(0.5)));
        }
    }
}
