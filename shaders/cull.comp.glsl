// One cluster of one object: writes its draw, which is empty unless the cluster may be in the frustum.
#include "interface.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = OBJECTS_BINDING) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, binding = CLUSTERS_BINDING) readonly buffer Clusters { ClusterRecord clusters[]; };
layout(std430, binding = VIEWED_BINDING) readonly buffer Viewed { ViewedObject viewed[]; };
layout(std430, binding = DRAWS_BINDING) writeonly buffer Draws { uint draws[]; };  // five per cluster
layout(std430, binding = CLIPS_BINDING) writeonly buffer Clips { vec4 clips[]; };  // three rows per cluster
#ifdef HAVE_NORMAL_MAP
layout(std430, binding = NORMAL_TRANSFORMS_BINDING) writeonly buffer NormalTransforms { vec4 normal_transforms[]; };  // six rows
#endif
layout(std430, binding = SHOWN_BINDING) buffer ShownTriangles { uint shown[]; };  // triangles of each frustum, then objects

uniform uint cluster_count, frustum, frustum_count;
uniform vec3 outward[5];  // normals of the planes about the view, sonar axes
uniform float range_max;  // [m]

#include "cull.glsl"

bool isSeen(ClusterRecord cluster, uint in_view) {
    if (in_view == NOT_IN_VIEW) return false;
    if (in_view == WHOLE_IN_VIEW) return true;
    ObjectRecord object = objects[cluster.object];
    vec3 at = boxCentre(object, cluster.centre.xyz);
    for (int i = 0; i < 5; ++i)
        if (boxBeyond(object, at, cluster.half_size.xyz, outward[i])) return false;
    if (!(boxDistance(object, at, cluster.half_size.xyz) <= range_max)) return false;
    bool has_cone = in_view == FRONT_IN_VIEW && cluster.cone_axis.w <= 1.0;
    return !(has_cone && showsBacks(object.eye.xyz, cluster.cone_apex.xyz, cluster.cone_axis.xyz, cluster.cone_axis.w));
}

void main() {
    uint at = gl_GlobalInvocationID.x;
    if (at >= cluster_count) return;
    ClusterRecord cluster = clusters[at];
    ViewedObject object = viewed[cluster.object];
    bool seen = isSeen(cluster, object.in_view);
    draws[5u * at] = seen ? cluster.index_count : 0u;
    draws[5u * at + 1u] = seen ? 1u : 0u;
    draws[5u * at + 2u] = cluster.first_index;
    draws[5u * at + 3u] = cluster.first_vertex;
    draws[5u * at + 4u] = at;
    if (!seen) return;
    clips[3u * at] = object.clip_x;
    clips[3u * at + 1u] = object.clip_y;
    clips[3u * at + 2u] = object.clip_w;
#ifdef HAVE_NORMAL_MAP
    normal_transforms[6u * at] = vec4(object.normal_x.xyz, cluster.centre.w);
    normal_transforms[6u * at + 1u] = object.normal_y;
    normal_transforms[6u * at + 2u] = object.normal_z;
    normal_transforms[6u * at + 3u] = object.tangent_x;
    normal_transforms[6u * at + 4u] = object.tangent_y;
    normal_transforms[6u * at + 5u] = object.tangent_z;
#endif
    atomicAdd(shown[frustum], cluster.index_count / 3u);
    shown[frustum_count + cluster.object] = 1u;
}
