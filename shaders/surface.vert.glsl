// One vertex: from object axes to one slab's image. Whatever is the same for a draw comes as attributes of its one
// instance: llvmpipe reads those once, and buffers once for each vertex.
#extension GL_ARB_shader_draw_parameters : require
#include "interface.glsl"
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 clip_x;  // rows of the matrix from object axes to the image: u, v, and depth along its axis
layout(location = 2) in vec4 clip_y;
layout(location = 3) in vec4 clip_w;

uniform float near_plane;  // [m]

flat out uvec2 seen;  // command, triangle (SurfaceScene.cpp has each triangle end in a vertex of its number)
#ifdef HAVE_NORMAL_MAP
layout(std430, binding = OBJECTS_BINDING) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, binding = COMMANDS_BINDING) readonly buffer Commands { CommandRecord commands[]; };
uniform vec2 slab_axis;  // cosine and sine of the slab's azimuth
layout(location = 4) in vec3 normal;
layout(location = 5) in vec4 tangent;
layout(location = 6) in vec2 uv;
out vec3 slab_normal;
out vec4 slab_tangent;
out vec2 map_uv;

// x into the picture, y to port, z up
vec3 slabFromSonar(vec3 p) {
    return vec3(slab_axis.x * p.x + slab_axis.y * p.y, slab_axis.x * p.y - slab_axis.y * p.x, p.z);
}

void passNormal(ObjectRecord object) {
    slab_normal = slabFromSonar(vec3(dot(object.normal_x.xyz, normal), dot(object.normal_y.xyz, normal), dot(object.normal_z.xyz, normal)));
    slab_tangent = vec4(slabFromSonar(vec3(dot(object.row_x.xyz, tangent.xyz), dot(object.row_y.xyz, tangent.xyz), dot(object.row_z.xyz, tangent.xyz))), tangent.w);
    map_uv = uv;
}
#endif

void main() {
    seen = uvec2(gl_BaseInstanceARB, gl_VertexID - gl_BaseVertexARB);
    vec4 p = vec4(position, 1.0);
    gl_Position = vec4(dot(clip_x, p), dot(clip_y, p), near_plane, dot(clip_w, p));  // reversed, infinite depth: near / x
#ifdef HAVE_NORMAL_MAP
    passNormal(objects[commands[seen.x].object]);
#endif
}
