// Shared by C++ and GLSL: what the surface pass and the deposit are told. Groups of 16 bytes, so that std430 and C++ agree.

#define OBJECTS_BINDING 0
#define COMMANDS_BINDING 1
#define PLANES_BINDING 2
#define MATERIALS_BINDING 3
#define SHARES_BINDING 4
#define SHARE_STARTS_BINDING 5
#define EDGES_BINDING 6
#define SUMS_BINDING 7
#define ELEVATION_BINDING 8

// Steps of the table of an elevation pattern.
#define ELEVATION_STEPS 4096

// One placing of a mesh, relative to the sonar: rows of the matrix from object to sonar axes, and of its inverse transpose.
struct ObjectRecord {
    vec4 row_x, row_y, row_z;           // xyz: matrix row [1], w: translation [m]
    vec4 normal_x, normal_y, normal_z;  // xyz: row of the inverse transpose [1]
    vec4 extent;                        // x, y: the object lies within these inverse ranges, y below x [1/m]
    vec4 eye, eye_rest;                 // xyz: the sum of the two is the sonar's place in object axes [m]
};

// A triangle's plane, in object axes: as exact as the triangle is small, wherever the object's origin lies.
struct PlaneRecord {
    vec4 normal;  // xyz: unit normal [1]; w: what is to be added to distances of `point` along it [m]
    vec4 point;   // xyz: close to the triangle, on the plane but for the rounding that w makes up for [m]
};

// One draw of a run of triangles.
struct CommandRecord {
    uint object, first_triangle, material, unused;  // first_triangle: of the mesh, among all planes
};

// What the model needs of a material: x mu = 10^(lambert_db/10), y reflectivity, z normal scale.
struct MaterialRecord {
    vec4 values;
};

// The part of an image column that belongs to one beam; u = tan(azimuth in the frustum).
struct ShareRecord {
    double middle, width;  // of the part, in u [1]
    double limit;          // the aperture ends at v = +-limit there [1]
    double shear;          // u / (1 + u u) at the column's middle: curves of constant elevation lean by v * shear [1]
    uint beam, column;
};
