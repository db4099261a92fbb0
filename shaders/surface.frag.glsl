// One pixel: writes its triangle and, with a normal map, the cosine of incidence on the mapped surface.
// plane.glsl computes range, slope and strength exactly from the triangle's plane.

flat in uvec2 seen;
#ifdef HAVE_NORMAL_MAP
uniform sampler2D normal_map;
uniform bool mapped;      // the draws of this call have a normal map
uniform vec2 extent;
uniform vec2 pixel_size;  // [u, v]
in vec3 frustum_normal;
in vec4 frustum_tangent;
in vec2 map_uv;
flat in float map_scale;

// x: command + 1, 0 for a miss; y: triangle within the mesh; z: bits of the mapped cosine, 0 without a map
layout(location = 0) out uvec4 surface;

float mappedCosine(vec3 direction, float scale) {
    vec3 n = normalize(frustum_normal);
    vec3 t = normalize(frustum_tangent.xyz - n * dot(n, frustum_tangent.xyz));
    vec3 texel = texture(normal_map, map_uv).xyz * 2.0 - 1.0;
    vec3 bent = normalize(mat3(t, cross(n, t) * frustum_tangent.w, n) * (texel * vec3(scale, scale, 1.0)));
    float cosine = -dot(bent, direction) * sign(-dot(n, direction));  // both sides of a surface reflect
    return cosine > 1e-6f ? cosine : 1e-6f;                            // also where normal and tangent form no frame
}

void main() {
    float cosine = 0.0;
    if (mapped) {
        vec3 direction = normalize(vec3(1.0, gl_FragCoord.xy * pixel_size - extent));
        cosine = mappedCosine(direction, map_scale);
    }
    surface = uvec4(seen.x + 1u, seen.y, floatBitsToUint(cosine), 0u);
}
#else
layout(location = 0) out uvec2 surface;

void main() { surface = uvec2(seen.x + 1u, seen.y); }
#endif
