/**
 * nekton32.h: nekton.h in single precision. Every type and function that has a precision is here once more, with the name
 * nekton32_...; what has none, and what holds for all of it, is in nekton.h.
 *
 * Made by `cargo xtask header` from ffi/src; do not edit.
 */
#ifndef NEKTON32_H
#define NEKTON32_H

#include "nekton.h"

/** A compiled scene. Never changes; any number of threads and simulations may use it at once. */
typedef struct nekton32_model nekton32_model;

/** A simulation of a model. One thread at a time. */
typedef struct nekton32_sim nekton32_sim;

/** An outline. Only the fields of its kind are read. */
typedef struct nekton32_shape {
    /** NEKTON_SHAPE_... */
    int32_t kind;
    /** Star: number of lobes. */
    uint32_t lobes;
    /** Ellipse: semi-axis along x, m. */
    float a;
    /** Ellipse: semi-axis along y, m. */
    float b;
    /** Star: mean radius, m. */
    float radius;
    /** Star: relative amplitude, |amplitude| < 1. */
    float amplitude;
    /** Rectangle: extent along x, m. */
    float width;
    /** Rectangle: extent along y, m. */
    float height;
    /** Rectangle, polygon: radius of the corners, m; 0: a sharp corner's default. */
    float corner_radius;
    /**
     * Polygon, curve: x, y of each point in order (the last joins the first). Declare the array const: before C23, C converts no
     * `double (*)[2]` to this type without a cast.
     */
    const float (*points)[2];
    /** Number of points. */
    size_t point_count;
} nekton32_shape;

/** A fixed boundary: the tank or an obstacle. To be filled by nekton_wall_def_init first. */
typedef struct nekton32_wall_def {
    /** sizeof of this struct; set by nekton_wall_def_init. */
    uint32_t struct_size;
    /** Outline. */
    struct nekton32_shape shape;
    /** Where the outline's own origin lies, m. */
    float position[2];
    /** Nodes: even, 8 to 65536; 0: as many as the scene's tolerance takes. */
    size_t nodes;
    /** Turn about the outline's own origin, rad. */
    float angle;
    /** Circulation around an obstacle, m^2/s; must be 0 for the tank. */
    float circulation;
    /** Curve: which of its points are corners; NEKTON_CORNERS_... */
    int32_t corners;
    /** Must be 0. */
    int32_t corners_reserved;
    /** Given corners: numbers of the points, from 0. */
    const size_t *corner_points;
    /** Number of given corners. */
    size_t corner_count;
} nekton32_wall_def;

/** offset + amplitude sin(frequency t + phase). */
typedef struct nekton32_harmonic {
    /** Amplitude. */
    float amplitude;
    /** Angular frequency, rad/s. */
    float frequency;
    /** Phase, rad. */
    float phase;
    /** Constant part. */
    float offset;
} nekton32_harmonic;

/** 0 outside (from, to), 1 between from + ramp and to - ramp, infinitely smooth in between. */
typedef struct nekton32_window {
    /** Start of the support, s. */
    float from;
    /** End of the support, s. */
    float to;
    /** Length of each ramp, s, at most half the support, more than 64 roundings of the times; all three 0: no window. */
    float ramp;
} nekton32_window;

/** A function of time with two derivatives. All zero: the constant 0. */
typedef struct nekton32_signal {
    /** NEKTON_SIGNAL_... */
    int32_t kind;
    /** Constant: its value. */
    float value;
    /** Harmonic: the terms. */
    const struct nekton32_harmonic *harmonics;
    /** Number of terms. */
    size_t harmonic_count;
    /** Harmonic: the window. */
    struct nekton32_window window;
    /** Table: the rows, const as the points of a shape. */
    const float (*rows)[4];
    /** Number of rows. */
    size_t row_count;
} nekton32_signal;

/** One rigid part of a body, with the joint by which it hangs on its parent. To be filled by nekton_link_def_init first. */
typedef struct nekton32_link_def {
    /** sizeof of this struct; set by nekton_link_def_init. */
    uint32_t struct_size;
    /** Outline, drawn in the link's own frame (any origin). */
    struct nekton32_shape shape;
    /** Nodes: even, 8 to 65536; 0: as many as the scene's tolerance takes. */
    size_t nodes;
    /** Circulation of the fluid around the link, counter-clockwise, m^2/s. */
    float circulation;
    /** NEKTON_MASS_... */
    int32_t mass_kind;
    /** Parent among the body's links; -1: none (the first link of a body, and only that). */
    int32_t parent;
    /** Density, kg/m^3, >= 0. */
    float density;
    /** Mass given: kg/m, >= 0. */
    float mass;
    /** Mass given: moment of inertia about the centre of mass, kg m, >= 0. */
    float inertia;
    /** Mass given: centre of mass minus area centroid, in the link's frame, m. */
    float centre_of_mass[2];
    /** NEKTON_JOINT_...; like all that follows of no meaning without a parent. */
    int32_t joint;
    /** NEKTON_DRIVE_... */
    int32_t drive;
    /** Anchor on the parent, from the parent's area centroid in the parent's frame, m. */
    float parent_anchor[2];
    /** Anchor on this link, from its area centroid in its own frame, m. */
    float self_anchor[2];
    /** Slider: its direction in the parent's frame (of any length but 0). */
    float axis[2];
    /** Slider: constant heading of the link minus that of the parent, rad. */
    float angle;
    /** Locked: the value of u, rad (slider: m). */
    float locked_value;
    /** Torque: u of the unloaded spring. */
    float rest;
    /** Motion: u(t). Torque: the applied torque, N (slider: force, N/m). */
    struct nekton32_signal signal;
    /** Torque: spring constant, >= 0. */
    float stiffness;
    /** Torque: damping constant, >= 0. */
    float damping;
    /** Torque: u and du/dt at the start. */
    float start[2];
    /** Curve: which of its points are corners; NEKTON_CORNERS_... */
    int32_t corners;
    /** Must be 0. */
    int32_t corners_reserved;
    /** Given corners: numbers of the points, from 0. */
    const size_t *corner_points;
    /** Number of given corners. */
    size_t corner_count;
} nekton32_link_def;

/** A body: a tree of links, of which the first is the root. To be filled by nekton_body_def_init first. */
typedef struct nekton32_body_def {
    /** sizeof of this struct; set by nekton_body_def_init. */
    uint32_t struct_size;
    /** NEKTON_ROOT_... */
    int32_t root;
    /** x, y, theta: centre of mass and heading of the first link. */
    float pose[3];
    /** Their rates. */
    float velocity[3];
    /** Prescribed root: x(t), y(t), theta(t). */
    struct nekton32_signal motion[3];
    /** Links; the first has no parent, every other one a parent before it. */
    const struct nekton32_link_def *links;
    /** Number of links, >= 1. */
    size_t link_count;
} nekton32_body_def;

/** Everything that describes a scene. To be filled by nekton_scene_def_init first. Only read while a call runs. */
typedef struct nekton32_scene_def {
    /** sizeof of this struct; set by nekton_scene_def_init. */
    uint32_t struct_size;
    /** NEKTON_ABI_VERSION of the caller; set by nekton_scene_def_init. */
    uint32_t abi_version;
    /** Density of the fluid, kg/m^3, >= 0; 0: bodies in vacuum. */
    float fluid_density;
    /** Gravitational acceleration along -y, m/s^2. */
    float gravity;
    /** Strength of the repulsion of near boundaries, >= 0; 0: none. */
    float repulsion_epsilon;
    /** Exponent of the repulsion, > 0. */
    float repulsion_alpha;
    /** NEKTON_CIRCULATION_...; of meaning only if some circulation is not 0. */
    int32_t circulation;
    /** NEKTON_FORCE_... */
    int32_t force;
    /** NEKTON_QUADRATURE_... */
    int32_t quadrature;
    /**
     * Relative error in space that is asked for: boundaries of 0 nodes get as many as it takes, and a step that exceeds it
     * returns NEKTON_N_UNRESOLVED. 0: boundaries of 0 nodes get as many as 1e-6 takes (single precision: 1.2e-3), and a step whose
     * bound exceeds 1e-3 returns NEKTON_N_UNRESOLVED.
     */
    float tolerance;
    /** 1: use what symmetry makes unnecessary (a lone body, a lone swimmer); 0: only to cross-check. */
    int32_t shortcuts;
    /** The fluid is inside this outline; NULL: no tank. */
    const struct nekton32_wall_def *tank;
    /** Fixed obstacles. */
    const struct nekton32_wall_def *obstacles;
    /** Number of obstacles. */
    size_t obstacle_count;
    /** Moving bodies. */
    const struct nekton32_body_def *bodies;
    /** Number of bodies, >= 1. */
    size_t body_count;
    /** 1: go on where the bound of the relative error in space exceeds 1; 0: that is refused (NEKTON_E_BOUND_EXCEEDED). */
    int32_t allow_unresolved;
    /** 0. */
    int32_t reserved;
} nekton32_scene_def;

/** How a simulation is integrated in time. To be filled by nekton_method_init first. */
typedef struct nekton32_method {
    /** sizeof of this struct; set by nekton_method_init. */
    uint32_t struct_size;
    /** NEKTON_METHOD_... */
    int32_t kind;
    /** RK4, ABM4, GAUSS6: step, s. */
    float step;
    /** ADAMS: relative tolerance of each step. */
    float relative;
    /** ADAMS: absolute tolerance of each step. */
    float absolute;
    /** ADAMS: longest step, s; 0: none. Must be 0 for a method of fixed steps. */
    float max_step;
    /** ADAMS: first step after a start, s (shorter if the tolerances ask for that); 0: chosen. Must be 0 for a method of fixed steps. */
    float first_step;
} nekton32_method;

/** Facts about a link. */
typedef struct nekton32_link_info {
    /** Body and link. */
    struct nekton_place place;
    /** Nodes on its boundary. */
    size_t nodes;
    /** Mass, kg/m. */
    float mass;
    /** Moment of inertia about the centre of mass, kg m. */
    float inertia;
    /** Area, m^2. */
    float area;
    /** Perimeter, m. */
    float perimeter;
    /** Area centroid minus centre of mass, link frame, m. */
    float centroid[2];
} nekton32_link_info;

/** Energies, J/m. */
typedef struct nekton32_energy {
    /** Kinetic energy of the fluid moved by the bodies. */
    float kinetic_fluid;
    /** Kinetic energy of the bodies. */
    float kinetic_bodies;
    /** Potential energy of weight and buoyancy. */
    float buoyancy;
    /** Potential energy of repulsion. */
    float repulsion;
    /** Kinetic energy of the circulatory flow, up to a constant. */
    float circulation;
    /** Sum of the five. */
    float total;
    /** Work done by the drives since the start; total - work is constant. */
    float work;
} nekton32_energy;

/** Relative error indicators of the space discretization. They do not see an error of the shape itself. */
typedef struct nekton32_resolution {
    /** Asymmetry of the discrete added mass before it is symmetrized. */
    float mass;
    /** Difference of two halves of the force that should be equal, relative to the largest force; 0 with the boundary formula. */
    float force;
    /** Error of the constant density as a solution of the boundary system. */
    float quadrature;
    /**
     * Estimated error of the double integrals of the repulsion, relative to its largest force between two boundaries; 0 without
     * repulsion.
     */
    float repulsion;
    /** Bound of the relative error of added mass, force and repulsion: 100 times the largest of the four. */
    float bound;
} nekton32_resolution;

/**
 * Estimated local errors of time integration, that is of each step by itself, from nekton_sim_time_error: each the largest over
 * the free coordinates of its kind, 0 if there are none. Lengths are the x and y of bodies and what sliders slide, angles the
 * headings of bodies and hinges.
 */
typedef struct nekton32_time_error {
    /** Of lengths in the last step that could be estimated, m; NaN if there was none. */
    float length;
    /** Of angles, rad; NaN as above. */
    float angle;
    /** Of the rates of lengths, m/s; NaN as above; 0 for a lone swimmer, whose rates are not integrated. */
    float speed;
    /** Of the rates of angles, rad/s; NaN and 0 as above. */
    float spin;
    /** Sum over all steps that could be estimated, m. */
    float length_sum;
    /** The same of angles, rad. */
    float angle_sum;
    /** Of the rates of lengths, m/s. */
    float speed_sum;
    /** Of the rates of angles, rad/s. */
    float spin_sum;
    /** Number of steps that could not be estimated, and are missing in the sums. */
    uint64_t unknown;
} nekton32_time_error;

/** The smallest gap between two boundaries of which one moves. */
typedef struct nekton32_gap {
    /** Distance, m; infinite when there is only one boundary. */
    float distance;
    /** One boundary. */
    struct nekton_place first;
    /** The other. */
    struct nekton_place second;
} nekton32_gap;

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Fills a scene definition with defaults: fluid of density 1, nothing else. Call it as nekton32_scene_def_init(&def,
 * sizeof def, NEKTON_ABI_VERSION).
 * Errors: NULL_POINTER, MISALIGNED, ABI_VERSION (header and library do not fit). Any thread.
 */
nekton_status nekton32_scene_def_init(struct nekton32_scene_def *def, size_t struct_size, uint32_t abi_version);

/**
 * Fills a wall definition with defaults: at the origin, automatic nodes, no circulation; the shape is still to be set. Call it as
 * nekton32_wall_def_init(&def): a macro of that name adds size and version.
 * Errors: as nekton32_scene_def_init. Any thread.
 */
nekton_status nekton32_wall_def_init(struct nekton32_wall_def *def,
                                     size_t struct_size,
                                     uint32_t abi_version);

/**
 * Fills a body definition with defaults: free, at rest at the origin; the links are still to be set. Call it as
 * nekton32_body_def_init(&def).
 * Errors: as nekton32_scene_def_init. Any thread.
 */
nekton_status nekton32_body_def_init(struct nekton32_body_def *def, size_t struct_size, uint32_t abi_version);

/**
 * Fills a link definition with defaults: density 1, automatic nodes, no circulation, no parent; if it gets one, a hinge
 * locked at 0. The shape is still to be set. Call it as nekton32_link_def_init(&def).
 * Errors: as nekton32_scene_def_init. Any thread.
 */
nekton_status nekton32_link_def_init(struct nekton32_link_def *def, size_t struct_size, uint32_t abi_version);

/**
 * Fills a method with defaults: ADAMS, both tolerances 1e-9 (single precision: 1e-4), steps of its own choice. Call it as
 * nekton32_method_init(&method).
 * Errors: as nekton32_scene_def_init. Any thread.
 */
nekton_status nekton32_method_init(struct nekton32_method *def,
                                   size_t struct_size,
                                   uint32_t abi_version);

/**
 * Memory that nekton32_model_init needs for this scene. Checks everything but geometry.
 * Errors: NULL_POINTER, MISALIGNED, ABI_VERSION, UNKNOWN_KIND, NOT_FINITE, OUT_OF_RANGE, EMPTY_SCENE, NODE_COUNT,
 * BAD_TOLERANCE, BAD_PARENT, MASSLESS, SIZE_OVERFLOW, UNSUPPORTED (a field of a newer header is set). Any thread.
 */
nekton_status nekton32_model_req(const struct nekton32_scene_def *def, struct nekton_req *req, struct nekton_diag *diag);

/**
 * Compiles a scene into mem (len bytes, aligned to NEKTON_ALIGN), which must stay as long as the model is used and
 * needs no other clean-up; def is not needed afterwards. *model is set on success only. Returns a notice (> 0, the
 * first; all by nekton32_model_notice) when something was mended. How well points tell a curve is looked at by nekton32_model_create only.
 * Errors: as nekton32_model_req, MEMORY_TOO_SMALL: nothing was written to mem. BAD_SHAPE, SELF_INTERSECTION,
 * OUT_OF_RANGE, BAD_TABLE, SINGULAR: mem holds no model. O(n^3) once for shapes other than ellipses. Any thread.
 */
nekton_status nekton32_model_init(void *mem,
                                  size_t len,
                                  const struct nekton32_scene_def *def,
                                  struct nekton32_model **model,
                                  struct nekton_diag *diag);

/**
 * The same in memory from the heap; to be given to nekton32_model_free.
 * Errors: as nekton32_model_init; OUT_OF_MEMORY; UNSUPPORTED without NEKTON_CAP_ALLOC. Any thread.
 */
nekton_status nekton32_model_create(const struct nekton32_scene_def *def,
                                    struct nekton32_model **model,
                                    struct nekton_diag *diag);

/**
 * Frees a model from nekton32_model_create (NULL: does nothing), after its simulations.
 * Errors: BAD_HANDLE if it is not from there. Any thread, once.
 */
nekton_status nekton32_model_free(struct nekton32_model *model);

/**
 * What the model computes, how long its arrays are, and what it costs.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. Any thread.
 */
nekton_status nekton32_model_plan(const struct nekton32_model *model, struct nekton_plan *plan);

/**
 * Facts about a link, counted through all bodies.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE. Any thread.
 */
nekton_status nekton32_model_link(const struct nekton32_model *model, size_t link, struct nekton32_link_info *info);

/**
 * Facts about a joint, counted in the order of the links they move.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE. Any thread.
 */
nekton_status nekton32_model_joint(const struct nekton32_model *model, size_t joint, struct nekton_joint_info *info);

/**
 * What set-up noticed and mended, such as an outline that was turned round.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE (there are as many as nekton_plan tells). Any thread.
 */
nekton_status nekton32_model_notice(const struct nekton32_model *model,
                                    size_t notice,
                                    struct nekton_place *place,
                                    nekton_status *status);

/**
 * Nodes on a boundary, given or automatic.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE (no such place). Any thread.
 */
nekton_status nekton32_model_nodes(const struct nekton32_model *model,
                                   const struct nekton_place *place,
                                   size_t *nodes);

/**
 * Of a curve through points, the relative error of added mass and area that may come from what is between the points: an
 * estimate, and no part of nekton_resolution, which knows the curve only. From the tolerance of the scene (0: a thousandth) on
 * the model has the notice OUTLINE_UNCERTAIN. -1 for other shapes, and in a model from nekton32_model_init, which uses no heap.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE (no such place). Any thread.
 */
nekton_status nekton32_model_outline_error(const struct nekton32_model *model,
                                           const struct nekton_place *place,
                                           float *error);

/**
 * Point (x, y: 2 numbers) of an outline at parameter t in [0, 2 pi): links in their own frame with the centre of
 * mass as origin, walls in the world.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, NOT_FINITE, OUT_OF_RANGE (no such place). Any thread.
 */
nekton_status nekton32_model_outline_point(const struct nekton32_model *model,
                                           const struct nekton_place *place,
                                           float t,
                                           float *point);

/**
 * Memory that nekton32_sim_init needs.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, ABI_VERSION (the method was not filled by nekton32_method_init),
 * UNKNOWN_KIND, BAD_STEP, BAD_TOLERANCE, OUT_OF_RANGE (max_step or first_step with a fixed step), SIZE_OVERFLOW,
 * UNSUPPORTED. Any thread.
 */
nekton_status nekton32_sim_req(const struct nekton32_model *model,
                               const struct nekton32_method *method,
                               struct nekton_req *req,
                               struct nekton_diag *diag);

/**
 * Starts a simulation at time 0 and the scene's initial state in mem (len bytes, aligned to NEKTON_ALIGN), which
 * must stay, like the model, as long as the simulation is used, and needs no other clean-up. *sim is set on
 * success only.
 * Errors: as nekton32_sim_req, MEMORY_TOO_SMALL: nothing was written to mem. OVERLAP, OUTSIDE_TANK, SINGULAR: mem
 * holds no simulation. Any thread; the simulation is then used by one thread at a time.
 */
nekton_status nekton32_sim_init(void *mem,
                                size_t len,
                                const struct nekton32_model *model,
                                const struct nekton32_method *method,
                                struct nekton32_sim **sim,
                                struct nekton_diag *diag);

/**
 * The same in memory from the heap; to be given to nekton32_sim_free.
 * Errors: as nekton32_sim_init; OUT_OF_MEMORY; UNSUPPORTED without NEKTON_CAP_ALLOC. Any thread.
 */
nekton_status nekton32_sim_create(const struct nekton32_model *model,
                                  const struct nekton32_method *method,
                                  struct nekton32_sim **sim,
                                  struct nekton_diag *diag);

/**
 * Frees a simulation from nekton32_sim_create (NULL: does nothing).
 * Errors: BAD_HANDLE if it is not from there; BUSY: it is still there. Any thread, once.
 */
nekton_status nekton32_sim_free(struct nekton32_sim *sim);

/**
 * Makes a simulation go on exactly as another one of the same model: time, state, integrator and its past,
 * channels, counters.
 * Errors: BAD_HANDLE (also if the models differ), NULL_POINTER, MISALIGNED, BUSY. One thread for to; any number may copy
 * from from while nobody else uses it.
 */
nekton_status nekton32_sim_copy(struct nekton32_sim *to,
                                const struct nekton32_sim *from,
                                struct nekton_diag *diag);

/**
 * Bytes that nekton32_sim_save writes; they depend on the model alone.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, BUSY. One thread per simulation.
 */
nekton_status nekton32_sim_save_req(const struct nekton32_sim *sim, size_t *bytes);

/**
 * Writes all that a simulation remembers to out, which has room for len bytes: time, state, method, integrator and its past,
 * channels, counters, estimates, limit of steps. nekton32_sim_load of any simulation of an equal model, in any process and on any
 * machine, goes on from there bit for bit (with the same build of this library). The bytes have no alignment and no pointers;
 * written tells how many there are.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, BUSY, ALIASING, MEMORY_TOO_SMALL (out is then not written), BAD_SAVE (a number
 * of the simulation is not finite). One thread per simulation.
 */
nekton_status nekton32_sim_save(const struct nekton32_sim *sim,
                                void *out,
                                size_t len,
                                size_t *written,
                                struct nekton_diag *diag);

/**
 * Makes a simulation what was saved by nekton32_sim_save, by itself or by another one of an equal model (every value of its scene is
 * the same); the method becomes the saved one, too. from are exactly the len bytes that were written.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, BUSY, ALIASING, BAD_SAVE: diag->what names what is wrong, "mark" (these are other
 * bytes), "version" (of another version of this library), "precision", "model" (another scene), "length", "checksum" (damaged) or
 * a value. The simulation is then as it was, bit for bit. One thread per simulation.
 */
nekton_status nekton32_sim_load(struct nekton32_sim *sim,
                                const void *from,
                                size_t len,
                                struct nekton_diag *diag);

/**
 * The simulation's model.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. One thread per simulation.
 */
nekton_status nekton32_sim_model(const struct nekton32_sim *sim, const struct nekton32_model **model);

/**
 * Time of the state shown, s.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. One thread per simulation.
 */
nekton_status nekton32_sim_time(const struct nekton32_sim *sim, float *t);

/**
 * x, y, theta of every link's centre of mass; n = 3 links.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING. One thread per simulation.
 */
nekton_status nekton32_sim_positions(const struct nekton32_sim *sim, float *q, size_t n);

/**
 * Rates of x, y, theta of every link; n = 3 links.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING. One thread per simulation.
 */
nekton_status nekton32_sim_velocities(const struct nekton32_sim *sim, float *qd, size_t n);

/**
 * Time and integrated state: free coordinates, their rates (not for a lone swimmer), and last the work of the
 * drives if anything is driven; n = state_len of the plan.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING. One thread per simulation.
 */
nekton_status nekton32_sim_get_state(const struct nekton32_sim *sim, float *t, float *y, size_t n);

/**
 * Sets time and state as nekton32_sim_get_state gives them; the integrator starts anew.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, NOT_FINITE, ALIASING, CONTACT; the simulation is then as
 * it was. One thread per simulation.
 */
nekton_status nekton32_sim_set_state(struct nekton32_sim *sim,
                                     float t,
                                     const float *y,
                                     size_t n,
                                     struct nekton_diag *diag);

/**
 * Forgets the integrator's past, as after a jump of the drives.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. One thread per simulation.
 */
nekton_status nekton32_sim_restart(struct nekton32_sim *sim);

/**
 * One step of the method (ADAMS: one step of its own choice). Returns a notice (> 0): STEP_TOO_LONG if the estimated error
 * of the step is a tenth of a body's reach, or of a radian, or more (see nekton32_sim_time_error; GAUSS6 has no estimate);
 * UNRESOLVED if the bound of the error in space exceeded the scene's tolerance (1e-3 without); diag tells the bound,
 * when, and what is closest.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE, STEP_TOO_SMALL, NO_CONVERGENCE;
 * the simulation is then as it was, bit for bit. One thread per simulation.
 */
nekton_status nekton32_sim_step(struct nekton32_sim *sim,
                                struct nekton_diag *diag);

/**
 * Advances to exactly t_end; nothing is evaluated beyond it. A fixed-step method shortens its last step. This is
 * the step function of a controller: set channels, advance by a sample time, read the state. Notices as nekton32_sim_step,
 * with the largest error met.
 * Errors: as nekton32_sim_step, and PAST_TIME (t_end lies before the time shown), NOT_FINITE, TOO_MANY_STEPS (see
 * nekton32_sim_set_step_limit; of fixed steps at once, with how many it takes and how many are allowed). The steps made until then are kept: the state shown is that of the last good step
 * (nekton32_sim_time and diag->time tell when), and the simulation may go on, as if it had been asked to come this far.
 * If no step was good, it is as it was before the call, bit for bit. To get back further, copy before you advance
 * (nekton32_sim_copy). One thread per simulation.
 */
nekton_status nekton32_sim_advance(struct nekton32_sim *sim,
                                   float t_end,
                                   struct nekton_diag *diag);

/**
 * Shows the state at t_out; the integrator may run ahead, but not beyond t_stop. Cheaper than nekton32_sim_advance
 * when output is wanted at many times: ADAMS keeps its steps and interpolates.
 * Errors: as nekton32_sim_advance; PAST_TIME also if t_out > t_stop. One thread per simulation.
 */
nekton_status nekton32_sim_advance_dense(struct nekton32_sim *sim,
                                         float t_out,
                                         float t_stop,
                                         struct nekton_diag *diag);

/**
 * How many steps one call of nekton32_sim_advance or nekton32_sim_advance_dense may make (at first 1000000) before it
 * ends with TOO_MANY_STEPS, so that no call takes for ever.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE (0). One thread per simulation.
 */
nekton_status nekton32_sim_set_step_limit(struct nekton32_sim *sim, uint64_t steps);

/**
 * Sets a channel (NEKTON_SIGNAL_CHANNEL; counted body by body, first the root, then the joints): t, u, du/dt,
 * d2u/dt2 (4 numbers) at both ends of the coming interval, quintic in between, constant outside. For a torque
 * these are the torque and its rates. What continues the piece before (u, du/dt, d2u/dt2 of a motion, the value of a torque), and
 * the same piece again, does not disturb the integrator; where d2u/dt2 or a torque jumps, fixed-step methods forget past
 * rates and ADAMS evaluates once more. A motion whose u or du/dt jumps once it has begun is noticed (DRIVE_UNRESOLVED): it would
 * take an impulse, which is not made. For control loops: RK4 or ABM4 with a step that divides the sample and is a sixteenth of
 * the fastest period or less; ADAMS where time per sample need not be bounded.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, NOT_FINITE, BAD_TABLE (times do not increase), UNSUPPORTED (no
 * such channel). One thread per simulation.
 */
nekton_status nekton32_sim_set_channel(struct nekton32_sim *sim,
                                       size_t channel,
                                       const float *from,
                                       const float *to,
                                       struct nekton_diag *diag);

/**
 * Right-hand side dy/dt for an integrator of your own; y and ydot as in nekton32_sim_get_state, n = state_len, not
 * overlapping. The simulation's own state does not change.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, NOT_FINITE, ALIASING, CONTACT, SINGULAR, NON_FINITE_STATE;
 * ydot is then 0. One thread per simulation.
 */
nekton_status nekton32_sim_rhs(struct nekton32_sim *sim,
                               float t,
                               const float *y,
                               float *ydot,
                               size_t n,
                               struct nekton_diag *diag);

/**
 * u and du/dt of every joint; n = joints each.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING. One thread per simulation.
 */
nekton_status nekton32_sim_joint_values(struct nekton32_sim *sim, float *u, float *du, size_t n);

/**
 * Torque (slider: force) that drives every joint, and its power; n = joints each.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One
 * evaluation if there was none since the last step. One thread per simulation.
 */
nekton_status nekton32_sim_joint_torques(struct nekton32_sim *sim,
                                         float *torque,
                                         float *power,
                                         size_t n,
                                         struct nekton_diag *diag);

/**
 * Accelerations of every link; n = 3 links. One evaluation if there was none since the last step.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton32_sim_accelerations(struct nekton32_sim *sim,
                                         float *out,
                                         size_t n,
                                         struct nekton_diag *diag);

/**
 * Mass matrix: bodies and added mass; n = (3 links)^2, column-major. 3 links + 1 solves.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton32_sim_mass_matrix(struct nekton32_sim *sim,
                                       float *out,
                                       size_t n,
                                       struct nekton_diag *diag);

/**
 * Added mass of the fluid, symmetrized; n = (3 links)^2, column-major. 3 links + 1 solves.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton32_sim_added_mass(struct nekton32_sim *sim,
                                      float *out,
                                      size_t n,
                                      struct nekton_diag *diag);

/**
 * Christoffel force, quadratic in the velocities, by the scene's formula; n = 3 links. One evaluation if there was
 * none since the last step.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton32_sim_christoffel(struct nekton32_sim *sim,
                                       float *out,
                                       size_t n,
                                       struct nekton_diag *diag);

/**
 * Full tensor of the Christoffel force, entry (a, i, j) at a + 3 links (i + 3 links j); n = (3 links)^3. For
 * inspection: (3 links)^2 forces.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton32_sim_christoffel_tensor(struct nekton32_sim *sim,
                                              float *out,
                                              size_t n,
                                              struct nekton_diag *diag);

/**
 * Gradient of the potential energy of weight and buoyancy; n = 3 links. One evaluation if there was none since the
 * last step.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton32_sim_buoyancy(struct nekton32_sim *sim,
                                    float *out,
                                    size_t n,
                                    struct nekton_diag *diag);

/**
 * Gradient of the potential energy of repulsion; n = 3 links. One evaluation if there was none since the last
 * step.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton32_sim_repulsion(struct nekton32_sim *sim,
                                     float *out,
                                     size_t n,
                                     struct nekton_diag *diag);

/**
 * Gradient of the energy of the circulatory flow; n = 3 links. One evaluation if there was none since the last
 * step.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton32_sim_circulation_gradient(struct nekton32_sim *sim,
                                                float *out,
                                                size_t n,
                                                struct nekton_diag *diag);

/**
 * Antisymmetric matrix G of the force G qd of circulation; n = (3 links)^2, column-major. 6 links solves.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton32_sim_gyroscopic(struct nekton32_sim *sim,
                                      float *out,
                                      size_t n,
                                      struct nekton_diag *diag);

/**
 * Memory that nekton32_sim_linearize and nekton32_sim_force_derivatives need for a simulation of this model.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, SIZE_OVERFLOW, UNSUPPORTED (an archive without the feature derivatives). Any thread.
 */
nekton_status nekton32_sim_derivatives_req(const struct nekton32_model *model,
                                           struct nekton_req *req,
                                           struct nekton_diag *diag);

/**
 * Linearization of dy/dt = f(t, y, parameters) at the state shown, y as nekton32_sim_get_state gives it (d numbers): a = df/dy, d x d,
 * and b = df/dparameters, d x count, column-major; a_len and b_len are their numbers of entries. Derivatives of what
 * nekton32_sim_rhs computes, with nodes that stay where they are on their outlines. *bound gets a bound of their relative error in
 * space. mem: len bytes as nekton32_sim_derivatives_req says, used while the call runs. The simulation does not change, and a run goes
 * on by the same bits. Costs two to three evaluations more; with circulation, whose force is differentiated by differences unless the body
 * is alone, 12 links + 2 more.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, MEMORY_TOO_SMALL, UNKNOWN_KIND and OUT_OF_RANGE (a parameter that the
 * model does not have: diag says which), UNSUPPORTED (the boundary formula), CONTACT, SINGULAR, BOUND_EXCEEDED,
 * NON_FINITE_STATE; a and b are then 0. One thread per simulation.
 */
nekton_status nekton32_sim_linearize(struct nekton32_sim *sim,
                                     const struct nekton_parameter *parameters,
                                     size_t count,
                                     float *a,
                                     size_t a_len,
                                     float *b,
                                     size_t b_len,
                                     float *bound,
                                     void *mem,
                                     size_t len,
                                     struct nekton_diag *diag);

/**
 * Derivatives of the links' force r = M qdd + F at the state shown for given accelerations qdd (n = 3 links), F without inertia and
 * without the forces of joints: position = dr/dq and velocity = dr/dqd, n x n each, column-major. For mechanics of your own. mem as for
 * nekton32_sim_linearize.
 * Errors: as nekton32_sim_linearize, NOT_FINITE. One thread per simulation.
 */
nekton_status nekton32_sim_force_derivatives(struct nekton32_sim *sim,
                                             const float *qdd,
                                             size_t n,
                                             float *position,
                                             float *velocity,
                                             void *mem,
                                             size_t len,
                                             struct nekton_diag *diag);

/**
 * Energies at the state shown. One evaluation if there was none since the last step.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread per simulation.
 */
nekton_status nekton32_sim_energy(struct nekton32_sim *sim,
                                  struct nekton32_energy *energy,
                                  struct nekton_diag *diag);

/**
 * Balance of energy, 3 numbers: total - work now minus what it was when an energy was first asked for (ask at the start, too); the
 * largest kinetic energy met; the drift from where on ENERGY_DRIFT is noticed. It sees the error of the whole motion, also what
 * no estimate of single steps can see. Cost and errors: as nekton32_sim_energy.
 */
nekton_status nekton32_sim_energy_drift(struct nekton32_sim *sim,
                                        float *drift,
                                        struct nekton_diag *diag);

/**
 * Linear impulse (x, y) and angular impulse about the origin, 3 numbers, of bodies, fluid and circulation.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread per simulation.
 */
nekton_status nekton32_sim_impulse(struct nekton32_sim *sim,
                                   float *impulse,
                                   struct nekton_diag *diag);

/**
 * Error indicators of the steps: the largest over the last call that stepped; before the first step those of the state
 * shown. They come with every step at the cost of one solve; see nekton_scene_def.tolerance.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED; before the first step CONTACT, SINGULAR, NON_FINITE_STATE. One thread per
 * simulation.
 */
nekton_status nekton32_sim_indicators(struct nekton32_sim *sim,
                                      struct nekton32_resolution *indicators,
                                      struct nekton_diag *diag);

/**
 * Error indicators of the space discretization at the state shown, from all of the added mass. 6 links + 7 solves.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, CONTACT, SINGULAR, NON_FINITE_STATE. One thread per simulation.
 */
nekton_status nekton32_sim_resolution(struct nekton32_sim *sim,
                                      struct nekton32_resolution *resolution,
                                      struct nekton_diag *diag);

/**
 * Estimated local errors of time integration since the start or the last nekton32_sim_set_state. Where the motion
 * neither amplifies nor forgets errors, the sums of the coordinates plus those of their rates times the time that is left bound
 * the error: they were 2 to 8 times (RK4), 2 to 22 times (ABM4) and 3 to 400 times (ADAMS) as large. RK4 estimates from the eighth
 * step on, ABM4 from the fourth, GAUSS6 never. No evaluation.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. One thread per simulation.
 */
nekton_status nekton32_sim_time_error(const struct nekton32_sim *sim,
                                      struct nekton32_time_error *error);

/**
 * The smallest gap between boundaries of which one moves. No evaluation.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, NON_FINITE_STATE. One thread per simulation.
 */
nekton_status nekton32_sim_gap(struct nekton32_sim *sim, struct nekton32_gap *gap, struct nekton_diag *diag);

/**
 * What the simulation did since its start.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. One thread per simulation.
 */
nekton_status nekton32_sim_counters(const struct nekton32_sim *sim, struct nekton_counters *counters);

#ifdef __cplusplus
} /* extern C */
#endif

/* Memory for static placement, bytes: as NEKTON_MODEL_BYTES and NEKTON_SIM_BYTES. */
#define NEKTON32_MODEL_BYTES(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows, graded) \
    (NEKTON_P_MODEL_RECORDS(bodies, joints, walls) + \
     4 * NEKTON_P_MODEL_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows, graded))
#define NEKTON32_SIM_BYTES(bodies, joints, nodes, walls, wall_nodes, circulation, channels, points, graded) \
    (1024 + 4 * NEKTON_P_SIM_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, channels, points, graded))

/* Filled by their own size, as in nekton.h. */
#define nekton32_wall_def_init(def) nekton32_wall_def_init((def), sizeof(nekton32_wall_def), NEKTON_ABI_VERSION)
#define nekton32_body_def_init(def) nekton32_body_def_init((def), sizeof(nekton32_body_def), NEKTON_ABI_VERSION)
#define nekton32_link_def_init(def) nekton32_link_def_init((def), sizeof(nekton32_link_def), NEKTON_ABI_VERSION)
#define nekton32_method_init(def) nekton32_method_init((def), sizeof(nekton32_method), NEKTON_ABI_VERSION)

#endif /* NEKTON32_H */
