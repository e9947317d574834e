//! The heights around the machine, as every policy that looks at them has them.

use xt28_terrain::{LocalMap, MapPose, Terrain};

use crate::Pose;

/// Cuts the local height map of a machine at `pose` from `map` into `heights_m`.
pub(crate) fn read_heights(map: &Terrain, pose: &Pose, heights_m: &mut Vec<f32>) {
    // Above the ground under the front axle: receiver and survey need not agree on height.
    let ground_m = map.height_m(pose.east_m, pose.north_m);
    let position_m = [pose.east_m, pose.north_m, ground_m];
    let pose = MapPose { position_m, heading_rad: pose.heading_rad };
    LocalMap::default().read(map, &pose, heights_m);
}
