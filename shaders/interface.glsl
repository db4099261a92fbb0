// Shared by C++ and GLSL: what the surface pass and the deposit are told. Groups of 16 bytes, so that std430 and C++ agree.

#define EDGE_ON_COSINE 1e-4
#define MIN_LOBE_COSINE 1e-6
#define MIN_ACROSS 1e-30
#define MIN_SINE_SQUARE 1e-12
#define LOBE_PI 3.14159265358979323846
#define MIN_RISE 1e-9
// In GLSL numbers are in single precision.
#ifdef GLSL
#define double float
#define MIN_WIDTH_RATIO 1e-9
#define MIN_WIDTH 1e-30
#else
#define MIN_WIDTH_RATIO 1e-12
#define MIN_WIDTH 1e-300
#endif

// OpenGL 4.5 promises eight storage buffers for a compute shader, 0 to 7.
#define OBJECTS_BINDING 0
#define COMMANDS_BINDING 1
#define PLANES_BINDING 2
#define MATERIALS_BINDING 3
#define SHARES_BINDING 4
#define SHARE_STARTS_BINDING 5
#define NUMBERS_BINDING 6
#define SUMS_BINDING 7

// Steps of the table of an elevation pattern, which comes first among the tables, and entries of a table of backscatter.
#define ELEVATION_STEPS 4096
#define BACKSCATTER_ENTRIES 256

// Of the culling of clusters, beside OBJECTS_BINDING.
#define CLUSTERS_BINDING 1
#define VIEWED_BINDING 2
#define DRAWS_BINDING 3
#define CLIPS_BINDING 4
#define NORMAL_TRANSFORMS_BINDING 5
#define SHOWN_BINDING 6

// What a frustum has of an object; of one whose front is in view, clusters may be left out that turn their backs.
#define NOT_IN_VIEW 0u
#define IN_VIEW 1u
#define FRONT_IN_VIEW 2u
#define DRAWN_WHOLE 3u

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
    vec4 point;   // xyz: close to the triangle, on the plane but for the rounding that normal.w makes up for [m]
};

// How a smooth closed body bends at a facet: along a unit vector t of the facet by bend.w + dot(t, bend.xyz)^2 [1/m].
struct CurveRecord {
    vec4 bend;  // xyz: turned as normals are [m^-1/2]; w [1/m]
};

// How a facet spreads the lobe of its material, in two principal directions of its plane.
struct FacetRecord {
    vec4 axis;           // xyz: the first direction, which is turned as normals are, of any length; w: 1 where all edges of its flat
                         // part echo themselves, else 0
    vec4 first, second;  // x, y: mean square slopes of steps and of diffraction [1], z: curvature [1/m]; w: the smooth surface's
                         // slope along the second is first.w + second.w times the square of that along the first [1]
};

// How a lobe is seen in two directions across each other: squares of the sines of the way to the normal, mean square slopes of
// all that widens it, and of these the part of diffraction; edges: 1 where the sidelobes of diffraction are echoes of edges [1].
struct LobeSlopes {
    double sine_1, sine_2, square_1, square_2, wave_1, wave_2, edges;
};

// One draw of a run of triangles.
struct CommandRecord {
    // first_triangle: of the mesh, among all planes; lattice: the object with which it shares its lattice of scatterers
    uint object, first_triangle, material, lattice;
};

// What the model needs of a material.
struct MaterialRecord {
    vec4 values;  // x mu = 10^(lambert_db/10), y reflectivity, z normal scale
    vec4 law;     // x its table of backscatter, -1: Lambert's law; y R^2 / (4 pi) of its lobe, 0: none; z mean square slope
};
#define FOLLOWS_LAMBERT(law) ((law).x < 0.0 && (law).y == 0.0)

// The part of an image column that belongs to one beam, as ShareRecord.
struct DeviceShare {
    vec2 middle, limit;  // each the sum of two floats [1]
    float width, shear;  // [1]
    uint beam, unused;
};

// A run of triangles of one object that is drawn or culled as one; object axes.
struct ClusterRecord {
    vec4 centre, half_size;    // xyz: of its box [m]; centre.w: scale of the normal map [1]
    vec4 cone_apex, cone_axis;  // xyz: of the cone from which only backs are seen [m, 1]; cone_axis.w: cosine of its side, 2: no such cone
    uint object, index_count, first_index, first_vertex;  // among all meshes
};

// How a frustum sees an object.
struct ViewedObject {
    vec4 clip_x, clip_y, clip_w;           // rows of the matrix from object axes to the image: u, v, and depth along its axis
    vec4 normal_x, normal_y, normal_z;     // xyz: rows of the matrix from object axes to the frustum's, for normals
    vec4 tangent_x, tangent_y, tangent_z;  // the same for tangents
    uint in_view, unused_x, unused_y, unused_z;
};
