// One vertex: from object axes to the axes of one slab's image (x into the picture, y to port, z up).
#extension GL_ARB_shader_draw_parameters : require
#include "interface.glsl"
layout(std430, binding = OBJECTS_BINDING) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, binding = COMMANDS_BINDING) readonly buffer Commands { CommandRecord commands[]; };

uniform vec2 slab_axis;   // cosine and sine of the slab's azimuth
uniform vec2 extent;      // tan of the half azimuth and of the half elevation of the image
uniform float near_plane; // [m]

layout(location = 0) in vec3 position;
flat out uvec2 seen;  // command, triangle (SurfaceScene.cpp has each triangle end in a vertex of its number)
#ifdef HAVE_NORMAL_MAP
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 uv;
out vec3 slab_normal;
out vec4 slab_tangent;
out vec2 map_uv;
#endif

vec3 slabFromSonar(vec3 p) {
    return vec3(slab_axis.x * p.x + slab_axis.y * p.y, slab_axis.x * p.y - slab_axis.y * p.x, p.z);
}

void main() {
    seen = uvec2(gl_BaseInstanceARB, gl_VertexID - gl_BaseVertexARB);
    ObjectRecord object = objects[commands[seen.x].object];
    vec4 p = vec4(position, 1.0);
    vec3 at = slabFromSonar(vec3(dot(object.row_x, p), dot(object.row_y, p), dot(object.row_z, p)));
    gl_Position = vec4(at.y / extent.x, at.z / extent.y, near_plane, at.x);  // reversed, infinite depth: near / x
#ifdef HAVE_NORMAL_MAP
    slab_normal = slabFromSonar(vec3(dot(object.normal_x.xyz, normal), dot(object.normal_y.xyz, normal), dot(object.normal_z.xyz, normal)));
    slab_tangent = vec4(slabFromSonar(vec3(dot(object.row_x.xyz, tangent.xyz), dot(object.row_y.xyz, tangent.xyz), dot(object.row_z.xyz, tangent.xyz))), tangent.w);
    map_uv = uv;
#endif
}
