// One vertex: transforms it from object axes to one frustum's image. Constants of a draw are attributes of its only
// instance, because llvmpipe reads these once, but buffers once per vertex.
#extension GL_ARB_shader_draw_parameters : require
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 clip_x;  // rows of the matrix from object axes to the image: u, v, and depth along its axis
layout(location = 2) in vec4 clip_y;
layout(location = 3) in vec4 clip_w;

uniform float near_plane;  // [m]

flat out uvec2 seen;  // command, triangle (SurfaceScene.cpp has each triangle end in a vertex of its number)
#ifdef HAVE_NORMAL_MAP
layout(location = 4) in vec3 normal;
layout(location = 5) in vec4 tangent;
layout(location = 6) in vec2 uv;
layout(location = 7) in vec4 normal_x;  // rows of the matrix from object axes to the frustum's, for normals; w: scale of the map
layout(location = 8) in vec4 normal_y;
layout(location = 9) in vec4 normal_z;
layout(location = 10) in vec4 tangent_x;  // the same for tangents
layout(location = 11) in vec4 tangent_y;
layout(location = 12) in vec4 tangent_z;
out vec3 frustum_normal;  // x into the picture, y to port, z up
out vec4 frustum_tangent;
out vec2 map_uv;
flat out float map_scale;
#endif

void main() {
    seen = uvec2(gl_BaseInstanceARB, gl_VertexID - gl_BaseVertexARB);
    vec4 p = vec4(position, 1.0);
    gl_Position = vec4(dot(clip_x, p), dot(clip_y, p), near_plane, dot(clip_w, p));  // reversed, infinite depth: near / x
#ifdef HAVE_NORMAL_MAP
    frustum_normal = vec3(dot(normal_x.xyz, normal), dot(normal_y.xyz, normal), dot(normal_z.xyz, normal));
    frustum_tangent = vec4(dot(tangent_x.xyz, tangent.xyz), dot(tangent_y.xyz, tangent.xyz), dot(tangent_z.xyz, tangent.xyz), tangent.w);
    map_uv = uv;
    map_scale = normal_x.w;
#endif
}
