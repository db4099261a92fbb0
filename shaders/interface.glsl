// Shared by C++ and GLSL: inputs of the surface pass and the deposit, in groups of 16 bytes, so that std430 and C++
// agree.

#define EDGE_ON_COSINE 1e-4
#define MIN_LOBE_COSINE 1e-6
#define MIN_ACROSS 1e-30
#define MIN_SINE_SQUARE 1e-12
#define LOBE_PI 3.14159265358979323846
#define MIN_RISE 1e-9
// GLSL uses single precision.
#ifdef GLSL
#define double float
#define MIN_WIDTH_RATIO 1e-9
#define MIN_WIDTH 1e-30
#else
#define MIN_WIDTH_RATIO 1e-12
#define MIN_WIDTH 1e-300
#endif

// OpenGL 4.5 guarantees eight storage buffers for a compute shader, 0 to 7.
#define OBJECTS_BINDING 0
#define COMMANDS_BINDING 1
#define PLANES_BINDING 2
#define MATERIALS_BINDING 3
#define SHARES_BINDING 4
#define SHARE_STARTS_BINDING 5
#define NUMBERS_BINDING 6
#define SUMS_BINDING 7

// Steps of the table of an elevation pattern, which is the first of the tables, and entries of a table of backscatter.
#define ELEVATION_STEPS 16384
#define BACKSCATTER_ENTRIES 1024

// Bindings for the culling of clusters, in addition to OBJECTS_BINDING.
#define CLUSTERS_BINDING 1
#define VIEWED_BINDING 2
#define DRAWS_BINDING 3
#define CLIPS_BINDING 4
#define NORMAL_TRANSFORMS_BINDING 5
#define SHOWN_BINDING 6

// Visibility of an object in a frustum. FRONT_IN_VIEW: clusters that show only their backs may be omitted.
#define NOT_IN_VIEW 0u
#define IN_VIEW 1u
#define FRONT_IN_VIEW 2u
#define WHOLE_IN_VIEW 3u

// The pose of a mesh relative to the sonar: rows of the matrix from object to sonar axes, and of its inverse transpose.
struct ObjectRecord {
    vec4 row_x, row_y, row_z;           // xyz: matrix row [1], w: translation [m]
    vec4 normal_x, normal_y, normal_z;  // xyz: row of the inverse transpose [1]
    vec4 extent;                        // x, y: max and min inverse range of the object [1/m]
    vec4 eye, eye_rest;                 // xyz: the sum of the two is the sonar's place in object axes [m]
};

// A triangle's plane, in object axes. Its error scales with the size of the triangle, at any distance from the object's
// origin.
struct PlaneRecord {
    vec4 normal;  // xyz: unit normal [1]; w: correction to add to distances of `point` along the normal [m]
    vec4 point;   // xyz: close to the triangle, on the plane except for the rounding that normal.w corrects [m]
};

// Curvature of a smooth closed body at a facet: along a unit vector t of the facet, bend.w + dot(t, bend.xyz)^2 [1/m].
struct CurveRecord {
    vec4 bend;  // xyz: transforms like normals [m^-1/2]; w [1/m]
};

// The spread of a material's lobe by a facet, in two principal directions of its plane.
struct FacetRecord {
    vec4 axis;           // xyz: the first direction, of any length, transforms like normals; w: 1 where all edges of its
                         // flat part have their own echoes, else 0
    vec4 first, second;  // x, y: mean square slopes of steps and of diffraction [1], z: curvature [1/m]; w: the smooth surface's
                         // slope along the second is first.w + second.w times the square of that along the first [1]
};

// A lobe in two perpendicular directions [1]: squares of the sines of the angle to the normal (sine), mean square
// slopes of all that widens the lobe (square), and the part of diffraction in these (wave). edges: 1 where echoes of
// edges replace the sidelobes of diffraction.
struct LobeSlopes {
    double sine_1, sine_2, square_1, square_2, wave_1, wave_2, edges;
};

// One draw of consecutive triangles.
struct CommandRecord {
    // first_triangle: of the mesh, among all planes; lattice: the object with which it shares its lattice of scatterers
    uint object, first_triangle, material, lattice;
};

// Properties of a material.
struct MaterialRecord {
    vec4 values;  // x mu = 10^(lambert_db/10), y reflectivity, z normal scale
    vec4 law;     // x table of backscatter, -1: Lambert's law; y R^2 / (4 pi) of the lobe, 0: no lobe; z mean square slope
};
#define FOLLOWS_LAMBERT(law) ((law).x < 0.0 && (law).y == 0.0)

// The part of an image column that belongs to one beam, as ShareRecord.
struct DeviceShare {
    vec2 middle, limit;  // each the sum of two floats [1]
    float width, shear;  // [1]
    uint beam, unused;
};

// Consecutive triangles of one object that are rasterised or culled together; object axes.
struct ClusterRecord {
    vec4 centre, half_size;     // xyz: of the box [m]; centre.w: scale of the normal map [1]
    vec4 cone_apex, cone_axis;  // xyz: cone from which only backs are visible [m, 1]; cone_axis.w: its cosine, 2: no cone
    uint object, index_count, first_index, first_vertex;  // among all meshes
};

// Transforms and visibility of an object in a frustum.
struct ViewedObject {
    vec4 clip_x, clip_y, clip_w;           // rows of the matrix from object axes to the image: u, v, and depth along its axis
    vec4 normal_x, normal_y, normal_z;     // xyz: rows of the matrix from object axes to the frustum's, for normals
    vec4 tangent_x, tangent_y, tangent_z;  // the same for tangents
    uint in_view, unused_x, unused_y, unused_z;
};
