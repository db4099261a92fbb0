// Shared by C++ and GLSL: conservative tests whether a frustum may see triangles in a box or under a cone. They allow
// for rounding, so that no device omits a triangle that is in view.

// Reach of a box along an object's axes from its centre, in a direction of the sonar's axes.
float boxReach(ObjectRecord object, vec3 half_size, vec3 along) {
    vec3 axes = along.x * vec3(object.row_x) + along.y * vec3(object.row_y) + along.z * vec3(object.row_z);
    return dot(abs(axes), half_size);
}

// Place of a box's centre, sonar axes [m].
vec3 boxCentre(ObjectRecord object, vec3 centre) {
    vec4 middle = vec4(centre, 1.0f);
    return vec3(dot(object.row_x, middle), dot(object.row_y, middle), dot(object.row_z, middle));
}

float boxRounding(vec3 at) { return 1e-5f * (abs(at.x) + abs(at.y) + abs(at.z)); }

// Whether a whole box is beyond a plane through the sonar, with an outward normal of any length.
bool boxBeyond(ObjectRecord object, vec3 at, vec3 half_size, vec3 outward) {
    return !(dot(outward, at) - boxReach(object, half_size, outward) <= boxRounding(at) * length(outward));
}

// Min distance of a box [m].
float boxDistance(ObjectRecord object, vec3 at, vec3 half_size) {
    float distance = length(at);
    return distance > 0.0f ? max(distance - boxReach(object, half_size, at / distance) - boxRounding(at), 0.0f) : 0.0f;
}

// Whether only backs of triangles are visible from `eye`, because it is in the cone about `axis` from `apex`; object
// axes.
bool showsBacks(vec3 eye, vec3 apex, vec3 axis, float cutoff) {
    vec3 away = apex - eye;
    return dot(away, axis) >= (cutoff + 1e-4f) * length(away);
}
