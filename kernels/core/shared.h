// Records that host and device both see, declared once. Only 32-bit scalars, no float3, so that
// both sides lay them out alike; sizes are asserted on both sides.
#ifndef RERADIANT_SHARED_H
#define RERADIANT_SHARED_H

#ifdef __OPENCL_VERSION__
typedef float shared_float;
typedef uint shared_uint;
typedef int shared_int;
typedef uchar shared_byte;
#define ASSERT_SIZE(type, bytes) typedef char type##_size_check[(sizeof(type) == (bytes)) ? 1 : -1]
#else
#include <cstdint>
namespace reradiant {
using shared_float = float;
using shared_uint = std::uint32_t;
using shared_int = std::int32_t;
using shared_byte = std::uint8_t;
#define ASSERT_SIZE(type, bytes) static_assert(sizeof(type) == (bytes))
#endif

#define NO_INDEX 0xffffffffu

/// A ray in world space. Direction has unit length. A ray with t_far < 0 is inactive: nothing
/// is traced for it. After an occlusion query t_far < 0 means "occluded or inactive".
typedef struct {
    shared_float origin_x, origin_y, origin_z;
    shared_float t_near;
    shared_float direction_x, direction_y, direction_z;
    shared_float t_far;
} RayRecord;
ASSERT_SIZE(RayRecord, 32);

/// Nearest intersection. shape = NO_INDEX: the ray left the scene.
typedef struct {
    shared_float position_x, position_y, position_z; ///< on the surface, world space
    shared_float position_error;                     ///< bound on each coordinate's error
    shared_float normal_x, normal_y, normal_z;       ///< geometric, unit, outward
    shared_float distance;                           ///< along the ray
    shared_float shading_x, shading_y, shading_z;    ///< unit; same side as the geometric one
    shared_uint shape;                               ///< index into Scene::shapes or NO_INDEX
    shared_float u, v;                               ///< surface parameters, 0..1
    shared_uint material;                            ///< index into Scene::materials or NO_INDEX
    shared_uint light;                               ///< index into Scene::lights or NO_INDEX
} HitRecord;
ASSERT_SIZE(HitRecord, 64);

/// Nodes of a table over cos(theta): u = sqrt(cos) in TABLE_NODES - 1 equal steps (table.h).
#define TABLE_NODES 65
#define MAX_LAYERS 64
/// Floats a vertex keeps when images colour lights or reflectances: emitter or light, reflectance.
#define VERTEX_COLOURS 6

#define LIGHT_RECTANGLE 0
#define LIGHT_SPHERE 1
#define LIGHT_POINT 2
#define LIGHT_DIRECTIONAL 3
#define LIGHT_ENVIRONMENT 4
#define LIGHT_SPOT 5
#define LIGHT_DISK 6
#define LIGHT_MESH 7
#define LIGHT_DISTANT 8

typedef struct {
    shared_uint type;
    shared_uint spectrum;        ///< offset in the tables: [phase][lane]
    shared_float selection;      ///< probability of light sampling; 0: never sampled
    shared_float cumulative;     ///< sum of `selection` up to and with this light
    shared_float px, py, pz;     ///< centre, position
    shared_float radius_or_area; ///< sphere: radius; rectangle, disk, mesh: area
    shared_float ux, uy, uz;     ///< rectangle: full edge u; disk: a radius
    shared_float vx, vy, vz;     ///< rectangle: full edge v; disk: a radius across u
    shared_float nx, ny, nz;     ///< rectangle, disk: unit normal; spot: axis; directional and
                                 ///< distant: way of travel
    shared_float cone;           ///< distant: 1 - cos of the half angle; spot: likewise where it
                                 ///< goes dark
    shared_float full_cone;      ///< spot: where it begins to fall
    shared_uint triangles;       ///< mesh: offset in the tables: a cumulative share of the area for
                                 ///< each, then the corners of each, 9 numbers
    shared_uint triangle_count;
} LightRecord;
ASSERT_SIZE(LightRecord, 84);

/// An environment that is an image: offsets into the tables. light = NO_INDEX: there is none.
typedef struct {
    shared_uint light;
    shared_uint image;       ///< [row][column][rgb]
    shared_uint density;     ///< [row][column]: texel's probability times the number of texels
    shared_uint conditional; ///< [row][column]: cumulative within the row, from 0, without the 1
    shared_uint marginal;    ///< [row]: cumulative over the rows
    shared_uint width, height;
    shared_float rotation; ///< in turns
} EnvironmentRecord;
ASSERT_SIZE(EnvironmentRecord, 32);

#define TEXTURE_NOISE 0
#define TEXTURE_VORONOI 1
#define TEXTURE_CHECKER 2
#define TEXTURE_IMAGE 3
#define TEXTURE_WORLD 0
#define TEXTURE_UV 1
/// Textures that the variants of one surface depend on.
#define MAX_TEXTURES 3

typedef struct {
    shared_uint type, space;
    shared_float inverse_size;
    shared_uint octaves;
    shared_float tilt; ///< tangent of the standard deviation of the normals' tilt
    shared_float sharpness;
    shared_float share; ///< share of voronoi cells with value 1, others have 0; 0: uniform values
    shared_uint image;  ///< offset of its texels in the tables
    shared_uint width, height;
    shared_uint is_normal_map;
    shared_uint levels;
    shared_uint seed;
} TextureRecord;
ASSERT_SIZE(TextureRecord, 52);

/// A `SurfaceRecord` is what a shape refers to: a block of materials, one for every combination of
/// its textures' levels.
typedef struct {
    shared_uint first_material;
    shared_uint texture_count;
    shared_uint textures[MAX_TEXTURES]; ///< the last runs fastest
    shared_uint normal_texture;         ///< or NO_INDEX
    shared_uint mixed_with;             ///< surface, or NO_INDEX
    shared_float mix_weight;
    shared_uint mix_texture; ///< or NO_INDEX
} SurfaceRecord;
ASSERT_SIZE(SurfaceRecord, 36);

typedef struct {
    shared_float origin_x, origin_y, origin_z;
    shared_float lens_radius;
    shared_float right_x, right_y, right_z; ///< scaled: half width of the image plane at distance 1
    shared_float focus_distance;
    shared_float up_x, up_y, up_z; ///< scaled: half height at distance 1
    shared_uint width;
    shared_float forward_x, forward_y, forward_z;
    shared_uint height;
} CameraRecord;
ASSERT_SIZE(CameraRecord, 64);

/// A `LayerRecord` is one part of a material's stack, for the scalar evaluation of its lobes: an
/// interface, a sheet of flakes, or a conductor at the end. The parts follow each other from the
/// air down.
typedef struct {
    shared_float eta;   ///< IOR below over IOR above (at the reference wavelength if dispersive)
    shared_float alpha; ///< 0: smooth
    shared_uint distribution;
    shared_uint eta_lanes;   ///< offset of eta per lane, [phase][lane]; NO_INDEX if not dispersive
    shared_float coverage;   ///< > 0: a sheet of flakes, the share of light that meets one
    shared_uint reflectance; ///< [phase][node][lane] over the cosine at the facet; NO_INDEX:
                             ///< Fresnel reflectance by eta
} LayerRecord;
ASSERT_SIZE(LayerRecord, 24);

/// A rough lobe besides that of the first interface's single facets, in air half-vector space, or
/// what a slab scatters.
typedef struct {
    shared_float alpha; ///< of the facets; a slab's lobe: anisotropy g
    shared_uint distribution;
    shared_uint layer; ///< index within the material's layers; a slab's: of what lies above it
    shared_uint slab;  ///< [2][phase][lane]: optical depth and albedo; NO_INDEX: a rough lobe
    shared_uint shape; ///< table of facet_shape.h that it is multiplied by; NO_INDEX: none
    shared_uint ratio; ///< table of lobe_ratio.h likewise
    shared_float ratio_width; ///< of the lobe at normal incidence
} LobeRecord;
ASSERT_SIZE(LobeRecord, 28);

/// MaterialRecord::weidlich_wilkie. Per lane: some interface's IOR depends on wavelength.
#define MODEL_A 1u
#define MODEL_A_PER_LANE 2u

/// Offsets into the tables (in floats), NO_INDEX where a material has no such table. "grey or
/// spectral": [node] or [phase][node][lane], as `spectral` says.
typedef struct {
    shared_uint spectral;     ///< 1: the stack's tables depend on wavelength
    shared_uint transmission; ///< grey or spectral: way through the stack
    shared_uint delta;        ///< grey or spectral: weight of the mirror direction
    shared_uint residual;     ///< grey or spectral: residual / sqrt(pi * its average)
    shared_uint amplitude;    ///< lobe_count of them one after the other, grey or spectral
    shared_uint diagonal;     ///< [phase][lane]: over pi n_k^2
    shared_uint factors;      ///< [phase][2 * RANK][lane]: emission then excitation
    shared_uint dense;        ///< [phase][excitation lane][emission lane]
    shared_uint
        choice; ///< [node][4 + LOBES]: cumulative: delta, top, lobes..., diffuse; then albedo
    shared_uint first_layer; ///< into the layers
    shared_uint layer_count; ///< interfaces and sheets above the substrate; a conductor follows
    shared_uint lobe_count;
    shared_uint first_lobe; ///< into the lobes
    shared_uint has_top_lobe;
    shared_uint weidlich_wilkie; ///< 0, or MODEL_A: rough factors of model A on the diffuse part
    shared_uint rank;
    shared_uint reflectance_image; ///< texture that colours the reflectance, or NO_INDEX
    shared_uint image_reflectance; ///< [4][phase][lane]: r of the stack, then the spectra that the
                                   ///< image's red, green and blue stand for
    shared_float sigma;            ///< oren-nayar, radians; 0: lambert
    shared_float lowest_ior; ///< IOR of the medium above the substrate, at the reference wavelength
    shared_uint first_diagonal; ///< oren-nayar: the substrate's own operator, like the others
    shared_uint first_factors, first_dense;
    shared_uint separable_albedo; ///< oren-nayar, where that is: table of oren_nayar_shape.h
    shared_uint spread_value;     ///< oren-nayar: likewise; NO_INDEX: no light is spread
    shared_uint walk;  ///< walked through: the first of its layer_count + 1 parts; or NO_INDEX
    shared_uint shift; ///< hero: [phase][emission lane][excitation lane], cumulative probability;
                       ///< NO_INDEX: nothing shifts
    shared_uint dyes;  ///< [channel][phase][node][lane], what light brings to dyes and substrate
                       ///< (gather_dyes.h) instead of `transmission` and the substrate's operator;
                       ///< NO_INDEX: no slab is dyed
    shared_uint dye_coupling; ///< [phase], within lanes [channel sent][channel taken][lane], then
                              ///< of each term [channel][lane] what is taken, what is sent; or,
                              ///< with no terms, [channel][lane] taken [channel][lane] sent
    shared_uint dye_terms;    ///< 0: entry by entry
    shared_uint dye_channels;
    shared_uint dyes_shift_up;  ///< 1: nothing is sent out below the wavelength that excites it
    shared_uint is_passed;      ///< 1: shadow rays pass this smooth sheet straight on
    shared_uint other_side;     ///< of a sheet: the same as seen from below; NO_INDEX: it is opaque
    shared_uint dyes_far;       ///< of a sheet: `dyes` for directions on the other side
    shared_uint through_delta;  ///< grey or spectral: weight of the direction straight on
    shared_uint through_ratio;  ///< table of lobe_ratio.h, of the lobe through rough faces;
                                ///< NO_INDEX: all are smooth
    shared_uint through_first;  ///< 1: it takes the direction on this side first
    shared_float through_width; ///< of that lobe at normal incidence
    shared_uint through_lobe_own, through_lobe_far; ///< grey or spectral: amplitude of that lobe,
                                                    ///< for directions on each side
    shared_uint through_own, through_far; ///< grey or spectral: product form of what else goes
                                          ///< through, for directions on each side
} MaterialRecord;
ASSERT_SIZE(MaterialRecord, 172);

/// Extinctions that distances in a scattering slab are sampled with (walk.h).
#define WALK_REFERENCES 4

/// A part of a stack that is walked through: an interface with the slab beneath it; then the
/// substrate, then the sheets of flakes (of both only alpha and what follows it up to `bounced` is
/// used).
typedef struct {
    shared_float eta, ior; ///< IOR below over IOR above; IOR below
    shared_float alpha;    ///< 0: smooth
    shared_uint distribution;
    shared_uint multiple;     ///< 1: light between facets is followed
    shared_float albedo;      ///< substrate, or of scattering: for roulette, the largest lane's
    shared_uint cavities;     ///< blinn, multiple: the table of walk_cavities.h
    shared_uint reflectance;  ///< conductor: [phase][node][lane] over the cosine at the facet
    shared_uint bounced;      ///< with cavities: [phase][lane], kept of what is given back
    shared_uint extinction;   ///< [phase][lane], optical depth at normal passage; NO_INDEX: clear
    shared_uint scattering;   ///< [phase][lane], its scattering part; NO_INDEX: none
    shared_float anisotropy;  ///< mean cosine of scattering
    shared_float least_depth; ///< smallest absorption depth of all lanes, for roulette
    shared_float references[WALK_REFERENCES];
    shared_uint flakes;    ///< at the slab's end: index of their part in the stack; NO_INDEX: none
    shared_float coverage; ///< of the flakes, share of the area
    shared_uint emission;  ///< of dyes: [phase][lane i][lane o], what they send out in o of a unit
                           ///< of fluence in i, as optical depths at normal passage; NO_INDEX: none
    shared_float emission_share; ///< of directions from events in the slab that are drawn for dyes
} WalkPartRecord;
ASSERT_SIZE(WalkPartRecord, 84);

/// One step of a recorded walk: a kind in the upper 8 bits, an index below, and a number.
typedef struct {
    shared_uint code;
    shared_float value;
} WalkEvent;
ASSERT_SIZE(WalkEvent, 8);

/// Events of a walk are kept in chunks that point back to the one before.
#define WALK_CHUNK_EVENTS 15
typedef struct {
    WalkEvent events[WALK_CHUNK_EVENTS];
    shared_uint previous;
    shared_uint padding;
} WalkChunk;
ASSERT_SIZE(WalkChunk, 128);

/// A `WalkVertexRecord` holds what `gather` needs of a vertex that was walked through.
typedef struct {
    shared_uint chunk;     ///< the last one, or NO_INDEX
    shared_uint count;     ///< events in it; those before are full
    shared_uint reference; ///< which of WALK_REFERENCES distances were sampled with; NO_INDEX: the
                           ///< weights of the events say
    shared_float weight;   ///< of the radiance along `next`
} WalkVertexRecord;
ASSERT_SIZE(WalkVertexRecord, 16);

/// A pixel and the number of its next sample.
typedef struct {
    shared_uint pixel;
    shared_uint first_sample;
} PixelSamples;
ASSERT_SIZE(PixelSamples, 8);

/// Numbers that the film keeps of a pixel besides its bands (film.cl).
#define FILM_STATISTICS 6

/// A `RenderRecord` holds the numbers that stay as they are through a whole render.
typedef struct {
    CameraRecord camera;
    EnvironmentRecord image;          ///< the environment where it is an image
    shared_uint environment;          ///< light of the constant environments, or NO_INDEX
    shared_uint sampled_lights;       ///< lights that light sampling can choose, the first ones
    shared_uint max_depth, min_depth; ///< vertices of a path; those before Russian roulette
    shared_uint phases;               ///< of the comb
    shared_uint first_seen_lane, seen_lanes; ///< lanes that add to the film, for `hero`
    shared_uint sequence_blocks; ///< a path's first blocks, from the sequence (sequence.h)
    shared_uint seed;
    shared_uint capacity; ///< paths of a batch at most: what vertices keep lies [depth][capacity]
} RenderRecord;
ASSERT_SIZE(RenderRecord, 136);

/// A batch of paths: pixels that follow each other, so many samples of each. `chosen` 1: the pixels
/// are those of a list, from first_pixel on in it, and first_sample is added to what it says.
typedef struct {
    shared_uint chosen;
    shared_uint first_pixel, pixels;
    shared_uint first_sample, samples;
    shared_uint strip_pixel; ///< first pixel of the strip of the film that holds them
} BatchRecord;
ASSERT_SIZE(BatchRecord, 24);

/// One depth of a batch, 0 for what the camera sees.
typedef struct {
    shared_uint depth;
    shared_uint live_paths;  ///< that reach it
    shared_uint walk_chunks; ///< room for the events of walks
} DepthRecord;
ASSERT_SIZE(DepthRecord, 12);

/// State of a path between stages.
typedef struct {
    shared_uint pixel;
    shared_uint sample;
    shared_uint phase;
    shared_uint vertex_count; ///< records written for this path
    shared_float bsdf_pdf;    ///< of the last direction; < 0: delta or camera
    shared_float throughput;  ///< bound over the lanes, for Russian roulette
    shared_float passed;      ///< way since the last direction was chosen, through smooth sheets
    shared_uint crossings;    ///< of these sheets
} PathState;
ASSERT_SIZE(PathState, 32);

/// Sheets that a shadow ray may pass straight on.
#define MOST_CROSSINGS 4
/// A smooth sheet that a shadow ray passed; material NO_INDEX: there are no more.
typedef struct {
    shared_uint material;
    shared_float cosine;
} SheetCrossing;
ASSERT_SIZE(SheetCrossing, 8);

/// Weights of one of the two directions that a vertex gathers from. Each is a scalar times
/// cos(theta_i) / pdf; the lanes' factors are applied in `gather`.
typedef struct {
    shared_float x, y, z;  ///< direction, local frame
    shared_float diffuse;  ///< times T(o) B T(i)
    shared_float first;    ///< oren-nayar: times T(o) M T(i), light that met the substrate once
    shared_float residual; ///< times the residual's product
    shared_float top;      ///< times Fresnel (already inside unless it depends on wavelength)
    shared_float delta;    ///< times the delta table
} DirectionRecord;
ASSERT_SIZE(DirectionRecord, 32);

/// A `VertexRecord` says what happened where a path met a surface (or a light, or the environment).
typedef struct {
    shared_uint material;             ///< NO_INDEX: the path ended on `emitter`
    shared_uint emitter;              ///< light whose radiance is seen here
    shared_float emitted;             ///< its weight
    shared_uint light;                ///< light sampled, or NO_INDEX
    shared_float out_x, out_y, out_z; ///< direction towards the camera, local frame
    shared_uint has_next;             ///< the path goes on
    DirectionRecord next, towards_light;
} VertexRecord;
ASSERT_SIZE(VertexRecord, 96);

#ifndef __OPENCL_VERSION__
} // namespace reradiant
#endif

#endif
