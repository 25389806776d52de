//! Views side by side: their receivers, casters, projections and hierarchies in one dispatch each, and with local packets what looks at
//! them as well. On a device with thousands of lanes a view alone fills few, and each dispatch waits for the one before.

use std::ops::Range;

use super::maps::fits;
use super::memory::peak_bytes;
use super::{Plan, ViewPlan, ViewSet};
use crate::frame::{Inventory, Scope};
use crate::gpu::Limits;
use crate::sub_light::Cut;
use crate::technique::{Recipe, Settings};

/// [byte] That views side by side take by default, beside the first.
const BYTES_MAX: u64 = 64 << 20;

impl Plan {
    /// As many as asked for, or as are fastest; shared out evenly among the dispatches of the longest run.
    pub(super) fn choose_views_at_once(
        &mut self,
        settings: &Settings,
        inventory: &Inventory,
        limits: &Limits,
    ) {
        let views = self.sets().flat_map(ViewSet::runs).map(|run| run.len());
        let views = views.max().unwrap_or(1) as u32;
        let mut most = views.min(settings.views_at_once.unwrap_or(views));
        if most > 1 && self.needs(|recipe| recipe.layers > 0) {
            most = 1;
            if settings.views_at_once.is_some() {
                let note = "layers are peeled in the map itself: views are made one after another, whatever --views-at-once says";
                self.notes.push(note.into());
            }
        }
        let bytes = |count| peak_bytes(&self.resources_for(count, inventory));
        let most_bytes = match settings.views_at_once {
            Some(_) => u64::MAX,
            None => limits.bytes_max().min(bytes(1) + bytes_by_default(limits)),
        };
        let there_is_room = |&count: &u32| {
            let resources = self.resources_for(count, inventory);
            let mut shapes = resources.iter().map(|resource| resource.shape);
            shapes.all(|shape| fits(shape, limits)) && peak_bytes(&resources) <= most_bytes
        };
        // More take more room.
        let counts: Vec<u32> = (1..=most).collect();
        let most = counts.partition_point(there_is_room).max(1) as u32;
        self.views_at_once = views.div_ceil(views.div_ceil(most));
    }

    /// Whether a set's views are looked at side by side.
    pub(crate) fn looks_side_by_side(&self, recipe: &Recipe) -> bool {
        self.views_at_once > 1 && recipe.side_by_side()
    }

    /// The views of a set, as many together as are side by side.
    pub(super) fn side_by_side(&self, set: &ViewSet) -> Vec<Range<u32>> {
        let most = self.views_at_once as usize;
        let cut = move |run: Range<usize>| {
            let end = run.end;
            let part = move |first| set.number(first)..set.number((first + most).min(end));
            run.step_by(most).map(part)
        };
        set.runs().flat_map(cut).collect()
    }
}

/// [byte] On a CPU a dispatch costs next to nothing, and its caches hold what one view needs: it takes 2 to 12 % more time for several.
fn bytes_by_default(limits: &Limits) -> u64 {
    match limits.is_cpu {
        true => 0,
        false => BYTES_MAX,
    }
}

impl ViewSet {
    /// Views in a row that run the same but for their face.
    fn runs(&self) -> impl Iterator<Item = Range<usize>> {
        let mut first = 0;
        let is_whole = |view: &ViewPlan| *view.cut() == Cut::Nothing;
        let runs = (self.views).chunk_by(move |a, b| is_whole(a) == is_whole(b));
        runs.map(move |run| {
            let start = first;
            first += run.len();
            start..first
        })
    }

    /// What numbers a view of the set has in the frame.
    fn number(&self, index: usize) -> u32 {
        self.view_first + index as u32
    }

    /// Of views in a row those that look towards the same face, for each face: they are part by part towards the same ones.
    pub(super) fn of_each_face(&self, views: Range<u32>) -> Vec<Scope> {
        let faces = self
            .views
            .iter()
            .take_while(|view| view.pose.part == self.views[0].pose.part);
        let stride = faces.count() as u32;
        let scope = |first: u32| Scope::Views {
            first,
            count: (views.end - first).div_ceil(stride),
            stride,
        };
        let firsts = views.clone().take(stride as usize);
        firsts.map(scope).collect()
    }
}
