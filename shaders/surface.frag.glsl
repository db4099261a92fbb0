// One pixel: slant range of the triangle's plane at the pixel's centre, its slope in the picture, and echo strength.
#include "interface.glsl"
layout(std430, binding = OBJECTS_BINDING) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, binding = COMMANDS_BINDING) readonly buffer Commands { CommandRecord commands[]; };
layout(std430, binding = PLANES_BINDING) readonly buffer Planes { vec4 planes[]; };
layout(std430, binding = MATERIALS_BINDING) readonly buffer Materials { MaterialRecord materials[]; };

uniform vec2 slab_axis;
uniform vec2 extent;
uniform vec2 pixel_size;  // [u, v]
uniform float near_plane;

flat in uint command;
#ifdef HAVE_NORMAL_MAP
uniform sampler2D normal_map;
in vec3 slab_normal;
in vec4 slab_tangent;
in vec2 map_uv;
#endif

// x: range [m], 0 for a miss; y, z: d(1/r)/du, d(1/r)/dv [1/m]; w: mu cos(theta), or reflectivity cos(theta)
layout(location = 0) out vec4 surface;

vec3 slabFromSonar(vec3 p) {
    return vec3(slab_axis.x * p.x + slab_axis.y * p.y, slab_axis.x * p.y - slab_axis.y * p.x, p.z);
}

#ifdef HAVE_NORMAL_MAP
float mappedCosine(vec3 direction, float scale) {
    vec3 n = normalize(slab_normal);
    vec3 t = normalize(slab_tangent.xyz - n * dot(n, slab_tangent.xyz));
    vec3 texel = texture(normal_map, map_uv).xyz * 2.0 - 1.0;
    vec3 bent = normalize(mat3(t, cross(n, t) * slab_tangent.w, n) * (texel * vec3(scale, scale, 1.0)));
    return max(-dot(bent, direction) * sign(-dot(n, direction)), 0.0);  // both sides of a surface reflect
}
#endif

void main() {
    CommandRecord run = commands[command];
    ObjectRecord object = objects[run.object];
    vec4 plane = planes[run.first_triangle + uint(gl_PrimitiveID)];
    vec3 normal = vec3(dot(object.normal_x.xyz, plane.xyz), dot(object.normal_y.xyz, plane.xyz), dot(object.normal_z.xyz, plane.xyz));
    float distance = dot(normal, vec3(object.row_x.w, object.row_y.w, object.row_z.w)) + plane.w;
    float scale = inversesqrt(max(dot(normal, normal), 1e-30));
    normal = slabFromSonar(normal * scale);
    distance *= scale;

    vec2 uv = (gl_FragCoord.xy * pixel_size) - extent;
    vec3 q = vec3(1.0, uv);
    float q2 = dot(q, q);
    float facing = dot(normal, q);
    float depth = distance / facing;
    // Edge-on, the plane tells nothing at the pixel's centre: the rasteriser's depth does.
    float drawn = near_plane / gl_FragCoord.z;
    bool grazing = !(abs(facing) > 1e-4 * sqrt(q2)) || !(depth > 0.0);
    float r = (grazing ? drawn : depth) * sqrt(q2);
    float slope = grazing ? sign(facing) * 1e-4 * sqrt(q2) : facing;
    vec2 gradient = (normal.yz / (slope == 0.0 ? 1e-4 : slope) - uv / q2) / r;

    float cosine = abs(facing) * inversesqrt(q2);
#ifdef HAVE_NORMAL_MAP
    cosine = mappedCosine(q * inversesqrt(q2), materials[run.material].values.z);
#endif
#ifdef HAVE_CERQUEIRA2017
    float strength = materials[run.material].values.y * cosine;
#else
    float strength = materials[run.material].values.x * cosine;
#endif
    surface = vec4(r, gradient, strength);
}
