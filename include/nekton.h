/**
 * nekton.h: rigid and articulated bodies moving in a 2D ideal fluid.
 *
 * Made by `cargo xtask header` from ffi/src; do not edit.
 *
 * A scene (nekton_scene_def) is compiled into a model that never changes; any number of simulations step it. Both live in
 * memory that the caller gives (query the size, or use NEKTON_MODEL_BYTES and NEKTON_SIM_BYTES), or in memory from the heap
 * (create, free). nekton32.h has the same in single precision.
 *
 * Units are SI per unit depth: lengths m, density kg/m^3 (so mass kg/m, inertia kg m), circulation m^2/s, torque N, force N/m,
 * energy J/m. Angles are radians, counter-clockwise. Matrices are column-major.
 *
 * Definitions (nekton_scene_def, nekton_body_def, nekton_link_def, nekton_wall_def, nekton_method) are filled by the function with
 * init in its name first, which also says how large they are (struct_size); those of one array have the same size. Later versions
 * of the library append fields, for which 0 means none, so that a program and a library of different age get along: what an
 * older program does not know is none; a newer one is refused (UNSUPPORTED) only if it sets what the library does not know. What lies
 * within definitions (shapes, signals), and what functions fill, keeps its size.
 *
 * Errors: every function returns a nekton_status: 0 ok, > 0 a notice (it was done), < 0 an error. A call that fails leaves
 * every simulation bit for bit as it was; outputs are then of no use. Only nekton_sim_advance and nekton_sim_advance_dense keep the
 * steps that they made before the error: an hour of work is not rolled back for one step. Where a function takes a nekton_diag
 * (NULL is fine) it says what, where, and which value. In the comments, BAD_HANDLE stands for NEKTON_E_BAD_HANDLE, and so on. A
 * non-finite number is never accepted and never returned as ok (only the distance of a gap may be infinite).
 *
 * Objects are recognized by a mark; handles to memory that was overwritten, freed twice or unmapped are the caller's duty.
 *
 * Threads: no global and no thread-local variable, no lock, no input or output. A model may be used by any number of threads at
 * once; a simulation by one at a time, even to read it. Whoever comes while another call uses it is refused at once (BUSY, from
 * every function of a simulation, interrupts included) and nothing changes; nobody waits. Any number of threads may copy from one
 * simulation at once (nekton_sim_copy, its from). Without atomic operations (Cortex-M0) BUSY is not noticed. Only create and
 * free use the heap.
 */
#ifndef NEKTON_H
#define NEKTON_H

#include <stddef.h>
#include <stdint.h>

/**
 * Outcomes: 0 ok, > 0 notices, < 0 errors.
 */
enum {
    /** ok */
    NEKTON_OK = 0,
    /** the outline runs clockwise and was turned round */
    NEKTON_N_OUTLINE_REVERSED = 1,
    /** the error in space may exceed the tolerance asked for, or a thousandth */
    NEKTON_N_UNRESOLVED = 2,
    /** the step is too long for the motion: its error is a tenth of a body or more */
    NEKTON_N_STEP_TOO_LONG = 3,
    /** the step is too long for what a drive does within it */
    NEKTON_N_DRIVE_UNRESOLVED = 4,
    /** energy and the work of the drives do not balance */
    NEKTON_N_ENERGY_DRIFT = 5,
    /** the first point is repeated at the end and was dropped */
    NEKTON_N_POINT_REPEATED = 6,
    /** kinks of the points were taken as corners */
    NEKTON_N_CORNERS_FOUND = 7,
    /** the points leave the outline uncertain: give more where it bends, or name its corners */
    NEKTON_N_OUTLINE_UNCERTAIN = 8,
    /** the memory given is smaller than required */
    NEKTON_E_MEMORY_TOO_SMALL = -1,
    /** a value is not finite */
    NEKTON_E_NOT_FINITE = -2,
    /** a value is out of its range */
    NEKTON_E_OUT_OF_RANGE = -3,
    /** the scene has no body */
    NEKTON_E_EMPTY_SCENE = -4,
    /** a node count must be even, at least 8 and at most 65536, or 0 for automatic */
    NEKTON_E_NODE_COUNT = -5,
    /** the shape's measures do not describe an outline */
    NEKTON_E_BAD_SHAPE = -6,
    /** the outline crosses itself */
    NEKTON_E_SELF_INTERSECTION = -7,
    /** a link's parent must be an earlier link of the same body */
    NEKTON_E_BAD_PARENT = -8,
    /** two boundaries touch or overlap */
    NEKTON_E_OVERLAP = -9,
    /** a body or obstacle is not inside the tank */
    NEKTON_E_OUTSIDE_TANK = -10,
    /** a body without mass cannot be accelerated in a fluid without density */
    NEKTON_E_MASSLESS = -11,
    /** a table's times must increase */
    NEKTON_E_BAD_TABLE = -12,
    /** the scene is too large to be addressed */
    NEKTON_E_SIZE_OVERFLOW = -13,
    /** two bodies came into contact */
    NEKTON_E_CONTACT = -14,
    /** a matrix is singular to working precision */
    NEKTON_E_SINGULAR = -15,
    /** the motion became infinite or undefined */
    NEKTON_E_NON_FINITE_STATE = -16,
    /** the step is too small for the tolerance asked for or for the digits of the time */
    NEKTON_E_STEP_TOO_SMALL = -17,
    /** more steps are needed than one call may make: lengthen the step, loosen the tolerance or raise the step limit */
    NEKTON_E_TOO_MANY_STEPS = -18,
    /** the step must be positive and finite */
    NEKTON_E_BAD_STEP = -19,
    /** a tolerance must be positive and not below rounding */
    NEKTON_E_BAD_TOLERANCE = -20,
    /** a buffer has the wrong length */
    NEKTON_E_LENGTH = -21,
    /** not available for this scene or this build */
    NEKTON_E_UNSUPPORTED = -22,
    /** an internal consistency check failed (please report it) */
    NEKTON_E_INTERNAL = -23,
    /** a pointer that must not be NULL is NULL */
    NEKTON_E_NULL_POINTER = -24,
    /** memory is not aligned as required */
    NEKTON_E_MISALIGNED = -25,
    /** not initialized, or compiled for another version of the interface */
    NEKTON_E_ABI_VERSION = -26,
    /** this is no object of this library: not initialized, freed, or its model was replaced */
    NEKTON_E_BAD_HANDLE = -27,
    /** no memory could be had */
    NEKTON_E_OUT_OF_MEMORY = -28,
    /** a kind or flag has no such value */
    NEKTON_E_UNKNOWN_KIND = -29,
    /** two buffers overlap that must not */
    NEKTON_E_ALIASING = -30,
    /** the equations of an implicit step were not solved: the step is too long */
    NEKTON_E_NO_CONVERGENCE = -31,
    /** another thread uses this simulation */
    NEKTON_E_BUSY = -32,
    /** these bytes are no state that was saved of this model by this version */
    NEKTON_E_BAD_SAVE = -33,
    /** the time asked for lies before the present time */
    NEKTON_E_PAST_TIME = -34,
    /** the error in space may be as large as the result: more nodes are needed */
    NEKTON_E_BOUND_EXCEEDED = -35
};

/** Not set: refused. */
#define NEKTON_SHAPE_NONE 0

/** Semi-axes a along x and b along y. */
#define NEKTON_SHAPE_ELLIPSE 1

/** r(t) = radius (1 + amplitude cos(lobes t)). */
#define NEKTON_SHAPE_STAR 2

/** width by height about the origin, corners rounded by corner_radius. */
#define NEKTON_SHAPE_RECTANGLE 3

/** Simple polygon through points, corners rounded by corner_radius. */
#define NEKTON_SHAPE_POLYGON 4

/** Smooth closed curve through points. */
#define NEKTON_SHAPE_CURVE 5

/** The constant value. */
#define NEKTON_SIGNAL_CONSTANT 0

/** Sum of harmonic terms, times the window if window.ramp > 0. */
#define NEKTON_SIGNAL_HARMONIC 1

/** Rows (t, u, du/dt, d2u/dt2) at increasing times, quintic in between, constant outside. */
#define NEKTON_SIGNAL_TABLE 2

/** Set while running by nekton_sim_set_channel; 0 until then. */
#define NEKTON_SIGNAL_CHANNEL 3

/** Where the points of a curve show a kink: a turn of 29 to 175 degrees that stands out (notice NEKTON_N_CORNERS_FOUND). */
#define NEKTON_CORNERS_AUTO 0

/** Nowhere: the curve is smooth. */
#define NEKTON_CORNERS_NONE 1

/** At corner_points. */
#define NEKTON_CORNERS_GIVEN 2

/** Homogeneous, of the link's density. */
#define NEKTON_MASS_DENSITY 0

/** The link's mass, inertia and centre_of_mass. */
#define NEKTON_MASS_GIVEN 1

/** The anchors coincide; u = heading of the link minus heading of the parent. */
#define NEKTON_JOINT_HINGE 0

/** The link's anchor slides along an axis of the parent; u = distance along it. */
#define NEKTON_JOINT_SLIDER 1

/** Held at locked_value. */
#define NEKTON_DRIVE_LOCKED 0

/** u(t) is prescribed by the signal. */
#define NEKTON_DRIVE_MOTION 1

/** Moves by the torque signal(t) - stiffness (u - rest) - damping du/dt. */
#define NEKTON_DRIVE_TORQUE 2

/** By the laws of motion. */
#define NEKTON_ROOT_FREE 0

/** x(t), y(t), theta(t) are given by the body's motion, added to its pose; its velocity is ignored. */
#define NEKTON_ROOT_PRESCRIBED 1

/** Energy gradient and the gyroscopic (Kutta-Joukowski) force. */
#define NEKTON_CIRCULATION_FULL 0

/** Without the force linear in the velocities. */
#define NEKTON_CIRCULATION_PAPER 1

/** Exact gradient of the discrete added mass: conserves the discrete energy at any resolution. */
#define NEKTON_FORCE_EXACT_GRADIENT 0

/** A boundary integral, as an independent cross-check; not with a prescribed joint or root. */
#define NEKTON_FORCE_BOUNDARY 1

/**
 * Nodes crowd where boundaries come close, and the kernel's pole beside a boundary is integrated in closed form: spectral
 * accuracy down to tiny gaps. Costs nothing for boundaries that are far apart. UNSUPPORTED in archives for
 * microcontrollers, unless they were built with the feature near.
 */
#define NEKTON_QUADRATURE_GRADED 0

/** Fixed nodes and the plain trapezoidal rule: least code and memory; some 36/gap nodes per unit of length are needed. */
#define NEKTON_QUADRATURE_PLAIN 1

/** Classical Runge-Kutta of order 4, fixed step, 4 evaluations a step. */
#define NEKTON_METHOD_RK4 1

/** Adams-Bashforth-Moulton of order 4, fixed step, 2 evaluations a step. */
#define NEKTON_METHOD_ABM4 2

/** Adams-Bashforth-Moulton of variable order 1 to 12 and variable step, 2 evaluations a step. */
#define NEKTON_METHOD_ADAMS 3

/**
 * Implicit Gauss-Legendre of order 6, fixed step, 20 to 40 evaluations a step: the energy does not drift. UNSUPPORTED in
 * archives for microcontrollers, unless they were built with the feature implicit.
 */
#define NEKTON_METHOD_GAUSS6 4

/** Density of the fluid, kg/m^2; the masses of bodies stay. */
#define NEKTON_PARAMETER_FLUID_DENSITY 1

/** Gravity, m/s^2. */
#define NEKTON_PARAMETER_GRAVITY 2

/** Mass of link index, kg/m. */
#define NEKTON_PARAMETER_MASS 3

/** Moment of inertia of link index about its centre of mass, kg m. */
#define NEKTON_PARAMETER_INERTIA 4

/** Force from outside on link index, world: component 0 along x, 1 along y, N/m; 2: torque about the centre of mass, N. */
#define NEKTON_PARAMETER_WRENCH 5

/** Torque (slider: force) added to that of torque-driven joint index. */
#define NEKTON_PARAMETER_TORQUE 6

/** Spring constant of torque-driven joint index. */
#define NEKTON_PARAMETER_STIFFNESS 7

/** Damping constant of torque-driven joint index. */
#define NEKTON_PARAMETER_DAMPING 8

/** Unloaded position of the spring of torque-driven joint index. */
#define NEKTON_PARAMETER_REST 9

/** Value of prescribed joint index; its rate and acceleration stay. */
#define NEKTON_PARAMETER_POSITION 10

/** Rate of prescribed joint index. */
#define NEKTON_PARAMETER_RATE 11

/** Acceleration of prescribed joint index. */
#define NEKTON_PARAMETER_ACCELERATION 12

/** No place, or nothing. */
#define NEKTON_PLACE_NONE (-1)

/** The scene as a whole. */
#define NEKTON_PLACE_SCENE 0

/** The tank. */
#define NEKTON_PLACE_TANK 1

/** Obstacle number index. */
#define NEKTON_PLACE_OBSTACLE 2

/** Body number index. */
#define NEKTON_PLACE_BODY 3

/** Link number link of body number index. */
#define NEKTON_PLACE_LINK 4

/** The general case: coordinates and their rates. */
#define NEKTON_FORMULATION_VELOCITY 0

/** A lone rigid body: constant added mass. */
#define NEKTON_FORMULATION_KIRCHHOFF 1

/** A lone swimmer: conserved impulse, first order in time. */
#define NEKTON_FORMULATION_LOCKED_MOMENTUM 2

/**
 * Version of the interface. Goes up with every change that is not compatible; fields appended to a definition are
 * compatible, by its struct_size.
 */
#define NEKTON_ABI_VERSION 2

/** Capability: nekton_model_create, nekton_sim_create and their free work. */
#define NEKTON_CAP_ALLOC 1

/** Alignment that is enough for every object, bytes. */
#define NEKTON_ALIGN 8

/** A compiled scene. Never changes; any number of threads and simulations may use it at once. */
typedef struct nekton_model nekton_model;

/** A simulation of a model. One thread at a time. */
typedef struct nekton_sim nekton_sim;

/** Outcome of a call: 0 ok, > 0 a notice, < 0 an error (see the list above). */
typedef int32_t nekton_status;

/** A place in the scene. Numbers count from 0; -1 where there is none. */
typedef struct nekton_place {
    /** NEKTON_PLACE_... */
    int32_t kind;
    /** Obstacle or body. */
    int32_t index;
    /** Link within the body. */
    int32_t link;
} nekton_place;

/** What a call has to say: status, where, which value. Every function that takes one accepts NULL. */
typedef struct nekton_diag {
    /** What the call returned. */
    nekton_status status;
    /** Where. */
    struct nekton_place place;
    /** The other party of a contact or overlap. */
    struct nekton_place other;
    /** Number of the point, row or harmonic term that is wrong; -1: none. */
    int32_t item;
    /** The offending value; NaN: none. */
    double value;
    /** What the value had to keep to (steps that are allowed, the present time); NaN: none. */
    double limit;
    /** Simulated time that was reached before the error, s; NaN where there is none. */
    double time;
    /** Name of the offending quantity; empty: none. */
    char what[32];
} nekton_diag;

/** An outline. Only the fields of its kind are read. */
typedef struct nekton_shape {
    /** NEKTON_SHAPE_... */
    int32_t kind;
    /** Star: number of lobes. */
    uint32_t lobes;
    /** Ellipse: semi-axis along x, m. */
    double a;
    /** Ellipse: semi-axis along y, m. */
    double b;
    /** Star: mean radius, m. */
    double radius;
    /** Star: relative amplitude, |amplitude| < 1. */
    double amplitude;
    /** Rectangle: extent along x, m. */
    double width;
    /** Rectangle: extent along y, m. */
    double height;
    /** Rectangle, polygon: radius of the corners, m; 0: a sharp corner's default. */
    double corner_radius;
    /**
     * Polygon, curve: x, y of each point in order (the last joins the first). Declare the array const: before C23, C converts no
     * `double (*)[2]` to this type without a cast.
     */
    const double (*points)[2];
    /** Number of points. */
    size_t point_count;
} nekton_shape;

/** A fixed boundary: the tank or an obstacle. To be filled by nekton_wall_def_init first. */
typedef struct nekton_wall_def {
    /** sizeof of this struct; set by nekton_wall_def_init. */
    uint32_t struct_size;
    /** Outline. */
    struct nekton_shape shape;
    /** Where the outline's own origin lies, m. */
    double position[2];
    /** Nodes: even, 8 to 65536; 0: as many as the scene's tolerance takes. */
    size_t nodes;
    /** Turn about the outline's own origin, rad. */
    double angle;
    /** Circulation around an obstacle, m^2/s; must be 0 for the tank. */
    double circulation;
    /** Curve: which of its points are corners; NEKTON_CORNERS_... */
    int32_t corners;
    /** Must be 0. */
    int32_t corners_reserved;
    /** Given corners: numbers of the points, from 0. */
    const size_t *corner_points;
    /** Number of given corners. */
    size_t corner_count;
} nekton_wall_def;

/** offset + amplitude sin(frequency t + phase). */
typedef struct nekton_harmonic {
    /** Amplitude. */
    double amplitude;
    /** Angular frequency, rad/s. */
    double frequency;
    /** Phase, rad. */
    double phase;
    /** Constant part. */
    double offset;
} nekton_harmonic;

/** 0 outside (from, to), 1 between from + ramp and to - ramp, infinitely smooth in between. */
typedef struct nekton_window {
    /** Start of the support, s. */
    double from;
    /** End of the support, s. */
    double to;
    /** Length of each ramp, s, at most half the support, more than 64 roundings of the times; all three 0: no window. */
    double ramp;
} nekton_window;

/** A function of time with two derivatives. All zero: the constant 0. */
typedef struct nekton_signal {
    /** NEKTON_SIGNAL_... */
    int32_t kind;
    /** Constant: its value. */
    double value;
    /** Harmonic: the terms. */
    const struct nekton_harmonic *harmonics;
    /** Number of terms. */
    size_t harmonic_count;
    /** Harmonic: the window. */
    struct nekton_window window;
    /** Table: the rows, const as the points of a shape. */
    const double (*rows)[4];
    /** Number of rows. */
    size_t row_count;
} nekton_signal;

/** One rigid part of a body, with the joint by which it hangs on its parent. To be filled by nekton_link_def_init first. */
typedef struct nekton_link_def {
    /** sizeof of this struct; set by nekton_link_def_init. */
    uint32_t struct_size;
    /** Outline, drawn in the link's own frame (any origin). */
    struct nekton_shape shape;
    /** Nodes: even, 8 to 65536; 0: as many as the scene's tolerance takes. */
    size_t nodes;
    /** Circulation of the fluid around the link, counter-clockwise, m^2/s. */
    double circulation;
    /** NEKTON_MASS_... */
    int32_t mass_kind;
    /** Parent among the body's links; -1: none (the first link of a body, and only that). */
    int32_t parent;
    /** Density, kg/m^3, >= 0. */
    double density;
    /** Mass given: kg/m, >= 0. */
    double mass;
    /** Mass given: moment of inertia about the centre of mass, kg m, >= 0. */
    double inertia;
    /** Mass given: centre of mass minus area centroid, in the link's frame, m. */
    double centre_of_mass[2];
    /** NEKTON_JOINT_...; like all that follows of no meaning without a parent. */
    int32_t joint;
    /** NEKTON_DRIVE_... */
    int32_t drive;
    /** Anchor on the parent, from the parent's area centroid in the parent's frame, m. */
    double parent_anchor[2];
    /** Anchor on this link, from its area centroid in its own frame, m. */
    double self_anchor[2];
    /** Slider: its direction in the parent's frame (of any length but 0). */
    double axis[2];
    /** Slider: constant heading of the link minus that of the parent, rad. */
    double angle;
    /** Locked: the value of u, rad (slider: m). */
    double locked_value;
    /** Torque: u of the unloaded spring. */
    double rest;
    /** Motion: u(t). Torque: the applied torque, N (slider: force, N/m). */
    struct nekton_signal signal;
    /** Torque: spring constant, >= 0. */
    double stiffness;
    /** Torque: damping constant, >= 0. */
    double damping;
    /** Torque: u and du/dt at the start. */
    double start[2];
    /** Curve: which of its points are corners; NEKTON_CORNERS_... */
    int32_t corners;
    /** Must be 0. */
    int32_t corners_reserved;
    /** Given corners: numbers of the points, from 0. */
    const size_t *corner_points;
    /** Number of given corners. */
    size_t corner_count;
} nekton_link_def;

/** A body: a tree of links, of which the first is the root. To be filled by nekton_body_def_init first. */
typedef struct nekton_body_def {
    /** sizeof of this struct; set by nekton_body_def_init. */
    uint32_t struct_size;
    /** NEKTON_ROOT_... */
    int32_t root;
    /** x, y, theta: centre of mass and heading of the first link. */
    double pose[3];
    /** Their rates. */
    double velocity[3];
    /** Prescribed root: x(t), y(t), theta(t). */
    struct nekton_signal motion[3];
    /** Links; the first has no parent, every other one a parent before it. */
    const struct nekton_link_def *links;
    /** Number of links, >= 1. */
    size_t link_count;
} nekton_body_def;

/** Everything that describes a scene. To be filled by nekton_scene_def_init first. Only read while a call runs. */
typedef struct nekton_scene_def {
    /** sizeof of this struct; set by nekton_scene_def_init. */
    uint32_t struct_size;
    /** NEKTON_ABI_VERSION of the caller; set by nekton_scene_def_init. */
    uint32_t abi_version;
    /** Density of the fluid, kg/m^3, >= 0; 0: bodies in vacuum. */
    double fluid_density;
    /** Gravitational acceleration along -y, m/s^2. */
    double gravity;
    /** Strength of the repulsion of near boundaries, >= 0; 0: none. */
    double repulsion_epsilon;
    /** Exponent of the repulsion, > 0. */
    double repulsion_alpha;
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
    double tolerance;
    /** 1: use what symmetry makes unnecessary (a lone body, a lone swimmer); 0: only to cross-check. */
    int32_t shortcuts;
    /** The fluid is inside this outline; NULL: no tank. */
    const struct nekton_wall_def *tank;
    /** Fixed obstacles. */
    const struct nekton_wall_def *obstacles;
    /** Number of obstacles. */
    size_t obstacle_count;
    /** Moving bodies. */
    const struct nekton_body_def *bodies;
    /** Number of bodies, >= 1. */
    size_t body_count;
    /** 1: go on where the bound of the relative error in space exceeds 1; 0: that is refused (NEKTON_E_BOUND_EXCEEDED). */
    int32_t allow_unresolved;
    /** 0. */
    int32_t reserved;
} nekton_scene_def;

/** How a simulation is integrated in time. To be filled by nekton_method_init first. */
typedef struct nekton_method {
    /** sizeof of this struct; set by nekton_method_init. */
    uint32_t struct_size;
    /** NEKTON_METHOD_... */
    int32_t kind;
    /** RK4, ABM4, GAUSS6: step, s. */
    double step;
    /** ADAMS: relative tolerance of each step. */
    double relative;
    /** ADAMS: absolute tolerance of each step. */
    double absolute;
    /** ADAMS: longest step, s; 0: none. Must be 0 for a method of fixed steps. */
    double max_step;
    /** ADAMS: first step after a start, s (shorter if the tolerances ask for that); 0: chosen. Must be 0 for a method of fixed steps. */
    double first_step;
} nekton_method;

/** Memory that an object needs. */
typedef struct nekton_req {
    /** Bytes. */
    size_t size;
    /** Alignment, bytes: a power of two, at most NEKTON_ALIGN. */
    size_t align;
} nekton_req;

/** What a model computes and what that costs. Counts are per evaluation. */
typedef struct nekton_plan {
    /** NEKTON_FORMULATION_... */
    int32_t formulation;
    /** 1: a fluid of positive density. */
    int32_t fluid;
    /** 1: gravity and buoyancy. */
    int32_t gravity;
    /** 1: repulsion. */
    int32_t repulsion;
    /** 1: circulation. */
    int32_t circulation;
    /** Moving links. */
    size_t links;
    /** Fixed boundaries (tank and obstacles). */
    size_t walls;
    /** Joints. */
    size_t joints;
    /** Channels (signals set while running). */
    size_t channels;
    /** Notices of set-up (see nekton_model_notice). */
    size_t notices;
    /** Coordinates: 3 per link. Length of positions, forces; matrices are coordinates x coordinates. */
    size_t coordinates;
    /** Coordinates that obey the laws of motion. */
    size_t free_coordinates;
    /** Coordinates that are prescribed functions of time. */
    size_t prescribed_coordinates;
    /** Length of the integrated state. */
    size_t state_len;
    /** Unknowns of the boundary system; 0 when none is solved while stepping. */
    size_t unknowns;
    /** Unknowns on moving links. */
    size_t moving_unknowns;
    /** Right-hand sides solved (transposed ones included). */
    size_t right_hand_sides;
    /** Relative error in space that is asked for; 0: none. */
    double tolerance;
    /** Bytes of the model. */
    size_t model_bytes;
    /** Bytes of a simulation. */
    size_t sim_bytes;
    /** Floating-point operations, leading terms. */
    double operations;
} nekton_plan;

/** Facts about a link. */
typedef struct nekton_link_info {
    /** Body and link. */
    struct nekton_place place;
    /** Nodes on its boundary. */
    size_t nodes;
    /** Mass, kg/m. */
    double mass;
    /** Moment of inertia about the centre of mass, kg m. */
    double inertia;
    /** Area, m^2. */
    double area;
    /** Perimeter, m. */
    double perimeter;
    /** Area centroid minus centre of mass, link frame, m. */
    double centroid[2];
} nekton_link_info;

/** Facts about a joint. */
typedef struct nekton_joint_info {
    /** The link that the joint moves. */
    struct nekton_place place;
    /** 1: moved as prescribed (or locked); 0: by a torque. */
    int32_t prescribed;
} nekton_joint_info;

/** What the motion is differentiated by. Joints and links count from 0, as in nekton_sim_joint_values and nekton_sim_positions. */
typedef struct nekton_parameter {
    /** NEKTON_PARAMETER_... */
    int32_t kind;
    /** Link or joint. */
    int32_t index;
    /** Of a wrench. */
    int32_t component;
    /** 0. */
    int32_t reserved;
} nekton_parameter;

/** Energies, J/m. */
typedef struct nekton_energy {
    /** Kinetic energy of the fluid moved by the bodies. */
    double kinetic_fluid;
    /** Kinetic energy of the bodies. */
    double kinetic_bodies;
    /** Potential energy of weight and buoyancy. */
    double buoyancy;
    /** Potential energy of repulsion. */
    double repulsion;
    /** Kinetic energy of the circulatory flow, up to a constant. */
    double circulation;
    /** Sum of the five. */
    double total;
    /** Work done by the drives since the start; total - work is constant. */
    double work;
} nekton_energy;

/** Relative error indicators of the space discretization. They do not see an error of the shape itself. */
typedef struct nekton_resolution {
    /** Asymmetry of the discrete added mass before it is symmetrized. */
    double mass;
    /** Difference of two halves of the force that should be equal, relative to the largest force; 0 with the boundary formula. */
    double force;
    /** Error of the constant density as a solution of the boundary system. */
    double quadrature;
    /**
     * Estimated error of the double integrals of the repulsion, relative to its largest force between two boundaries; 0 without
     * repulsion.
     */
    double repulsion;
    /** Bound of the relative error of added mass, force and repulsion: 100 times the largest of the four. */
    double bound;
} nekton_resolution;

/**
 * Estimated local errors of time integration, that is of each step by itself, from nekton_sim_time_error: each the largest over
 * the free coordinates of its kind, 0 if there are none. Lengths are the x and y of bodies and what sliders slide, angles the
 * headings of bodies and hinges.
 */
typedef struct nekton_time_error {
    /** Of lengths in the last step that could be estimated, m; NaN if there was none. */
    double length;
    /** Of angles, rad; NaN as above. */
    double angle;
    /** Of the rates of lengths, m/s; NaN as above; 0 for a lone swimmer, whose rates are not integrated. */
    double speed;
    /** Of the rates of angles, rad/s; NaN and 0 as above. */
    double spin;
    /** Sum over all steps that could be estimated, m. */
    double length_sum;
    /** The same of angles, rad. */
    double angle_sum;
    /** Of the rates of lengths, m/s. */
    double speed_sum;
    /** Of the rates of angles, rad/s. */
    double spin_sum;
    /** Number of steps that could not be estimated, and are missing in the sums. */
    uint64_t unknown;
} nekton_time_error;

/** The smallest gap between two boundaries of which one moves. */
typedef struct nekton_gap {
    /** Distance, m; infinite when there is only one boundary. */
    double distance;
    /** One boundary. */
    struct nekton_place first;
    /** The other. */
    struct nekton_place second;
} nekton_gap;

/** What a simulation did since its start. A call that failed counts nothing but steps that it kept. */
typedef struct nekton_counters {
    /** Evaluations of the equations of motion. */
    uint64_t evaluations;
    /** Factorizations of the boundary system. */
    uint64_t factorizations;
    /** Accepted steps. */
    uint64_t steps;
    /** Rejected steps. */
    uint64_t rejected;
} nekton_counters;

#ifdef __cplusplus
extern "C" {
#endif

/** The library's NEKTON_ABI_VERSION, to be compared with the header's. Any thread. */
uint32_t nekton_abi_version(void);

/** What this build can do: a sum of NEKTON_CAP_... Any thread. */
uint32_t nekton_capabilities(void);

/** One line of text about a status; "unknown status" for any other number. Never NULL; static. Any thread. */
const char *nekton_status_text(nekton_status status);

/**
 * The status's name in CamelCase, as in a Matlab identifier "nekton:Contact"; "Unknown" for any other number. Never NULL;
 * static. Any thread.
 */
const char *nekton_status_name(nekton_status status);

/**
 * Writes "place: text (with other) (what = value beside limit) at t = time" into text (size bytes, ended by 0, cut off if too
 * long; 256 are enough). Does nothing when diag or text is NULL or size is 0. Any thread.
 */
void nekton_diag_text(const struct nekton_diag *diag,
                      char *text,
                      size_t size);

/**
 * Fills a scene definition with defaults: fluid of density 1, nothing else. Call it as nekton_scene_def_init(&def,
 * sizeof def, NEKTON_ABI_VERSION).
 * Errors: NULL_POINTER, MISALIGNED, ABI_VERSION (header and library do not fit). Any thread.
 */
nekton_status nekton_scene_def_init(struct nekton_scene_def *def, size_t struct_size, uint32_t abi_version);

/**
 * Fills a wall definition with defaults: at the origin, automatic nodes, no circulation; the shape is still to be set. Call it as
 * nekton_wall_def_init(&def): a macro of that name adds size and version.
 * Errors: as nekton_scene_def_init. Any thread.
 */
nekton_status nekton_wall_def_init(struct nekton_wall_def *def,
                                   size_t struct_size,
                                   uint32_t abi_version);

/**
 * Fills a body definition with defaults: free, at rest at the origin; the links are still to be set. Call it as
 * nekton_body_def_init(&def).
 * Errors: as nekton_scene_def_init. Any thread.
 */
nekton_status nekton_body_def_init(struct nekton_body_def *def, size_t struct_size, uint32_t abi_version);

/**
 * Fills a link definition with defaults: density 1, automatic nodes, no circulation, no parent; if it gets one, a hinge
 * locked at 0. The shape is still to be set. Call it as nekton_link_def_init(&def).
 * Errors: as nekton_scene_def_init. Any thread.
 */
nekton_status nekton_link_def_init(struct nekton_link_def *def, size_t struct_size, uint32_t abi_version);

/**
 * Fills a method with defaults: ADAMS, both tolerances 1e-9 (single precision: 1e-4), steps of its own choice. Call it as
 * nekton_method_init(&method).
 * Errors: as nekton_scene_def_init. Any thread.
 */
nekton_status nekton_method_init(struct nekton_method *def,
                                 size_t struct_size,
                                 uint32_t abi_version);

/**
 * Memory that nekton_model_init needs for this scene. Checks everything but geometry.
 * Errors: NULL_POINTER, MISALIGNED, ABI_VERSION, UNKNOWN_KIND, NOT_FINITE, OUT_OF_RANGE, EMPTY_SCENE, NODE_COUNT,
 * BAD_TOLERANCE, BAD_PARENT, MASSLESS, SIZE_OVERFLOW, UNSUPPORTED (a field of a newer header is set). Any thread.
 */
nekton_status nekton_model_req(const struct nekton_scene_def *def, struct nekton_req *req, struct nekton_diag *diag);

/**
 * Compiles a scene into mem (len bytes, aligned to NEKTON_ALIGN), which must stay as long as the model is used and
 * needs no other clean-up; def is not needed afterwards. *model is set on success only. Returns a notice (> 0, the
 * first; all by nekton_model_notice) when something was mended. How well points tell a curve is looked at by nekton_model_create only.
 * Errors: as nekton_model_req, MEMORY_TOO_SMALL: nothing was written to mem. BAD_SHAPE, SELF_INTERSECTION,
 * OUT_OF_RANGE, BAD_TABLE, SINGULAR: mem holds no model. O(n^3) once for shapes other than ellipses. Any thread.
 */
nekton_status nekton_model_init(void *mem,
                                size_t len,
                                const struct nekton_scene_def *def,
                                struct nekton_model **model,
                                struct nekton_diag *diag);

/**
 * The same in memory from the heap; to be given to nekton_model_free.
 * Errors: as nekton_model_init; OUT_OF_MEMORY; UNSUPPORTED without NEKTON_CAP_ALLOC. Any thread.
 */
nekton_status nekton_model_create(const struct nekton_scene_def *def,
                                  struct nekton_model **model,
                                  struct nekton_diag *diag);

/**
 * Frees a model from nekton_model_create (NULL: does nothing), after its simulations.
 * Errors: BAD_HANDLE if it is not from there. Any thread, once.
 */
nekton_status nekton_model_free(struct nekton_model *model);

/**
 * What the model computes, how long its arrays are, and what it costs.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. Any thread.
 */
nekton_status nekton_model_plan(const struct nekton_model *model, struct nekton_plan *plan);

/**
 * Facts about a link, counted through all bodies.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE. Any thread.
 */
nekton_status nekton_model_link(const struct nekton_model *model, size_t link, struct nekton_link_info *info);

/**
 * Facts about a joint, counted in the order of the links they move.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE. Any thread.
 */
nekton_status nekton_model_joint(const struct nekton_model *model, size_t joint, struct nekton_joint_info *info);

/**
 * What set-up noticed and mended, such as an outline that was turned round.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE (there are as many as nekton_plan tells). Any thread.
 */
nekton_status nekton_model_notice(const struct nekton_model *model,
                                  size_t notice,
                                  struct nekton_place *place,
                                  nekton_status *status);

/**
 * Nodes on a boundary, given or automatic.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE (no such place). Any thread.
 */
nekton_status nekton_model_nodes(const struct nekton_model *model, const struct nekton_place *place, size_t *nodes);

/**
 * Of a curve through points, the relative error of added mass and area that may come from what is between the points: an
 * estimate, and no part of nekton_resolution, which knows the curve only. From the tolerance of the scene (0: a thousandth) on
 * the model has the notice OUTLINE_UNCERTAIN. -1 for other shapes, and in a model from nekton_model_init, which uses no heap.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE (no such place). Any thread.
 */
nekton_status nekton_model_outline_error(const struct nekton_model *model,
                                         const struct nekton_place *place,
                                         double *error);

/**
 * Point (x, y: 2 numbers) of an outline at parameter t in [0, 2 pi): links in their own frame with the centre of
 * mass as origin, walls in the world.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, NOT_FINITE, OUT_OF_RANGE (no such place). Any thread.
 */
nekton_status nekton_model_outline_point(const struct nekton_model *model,
                                         const struct nekton_place *place,
                                         double t,
                                         double *point);

/**
 * Memory that nekton_sim_init needs.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, ABI_VERSION (the method was not filled by nekton_method_init),
 * UNKNOWN_KIND, BAD_STEP, BAD_TOLERANCE, OUT_OF_RANGE (max_step or first_step with a fixed step), SIZE_OVERFLOW,
 * UNSUPPORTED. Any thread.
 */
nekton_status nekton_sim_req(const struct nekton_model *model,
                             const struct nekton_method *method,
                             struct nekton_req *req,
                             struct nekton_diag *diag);

/**
 * Starts a simulation at time 0 and the scene's initial state in mem (len bytes, aligned to NEKTON_ALIGN), which
 * must stay, like the model, as long as the simulation is used, and needs no other clean-up. *sim is set on
 * success only.
 * Errors: as nekton_sim_req, MEMORY_TOO_SMALL: nothing was written to mem. OVERLAP, OUTSIDE_TANK, SINGULAR: mem
 * holds no simulation. Any thread; the simulation is then used by one thread at a time.
 */
nekton_status nekton_sim_init(void *mem,
                              size_t len,
                              const struct nekton_model *model,
                              const struct nekton_method *method,
                              struct nekton_sim **sim,
                              struct nekton_diag *diag);

/**
 * The same in memory from the heap; to be given to nekton_sim_free.
 * Errors: as nekton_sim_init; OUT_OF_MEMORY; UNSUPPORTED without NEKTON_CAP_ALLOC. Any thread.
 */
nekton_status nekton_sim_create(const struct nekton_model *model,
                                const struct nekton_method *method,
                                struct nekton_sim **sim,
                                struct nekton_diag *diag);

/**
 * Frees a simulation from nekton_sim_create (NULL: does nothing).
 * Errors: BAD_HANDLE if it is not from there; BUSY: it is still there. Any thread, once.
 */
nekton_status nekton_sim_free(struct nekton_sim *sim);

/**
 * Makes a simulation go on exactly as another one of the same model: time, state, integrator and its past,
 * channels, counters.
 * Errors: BAD_HANDLE (also if the models differ), NULL_POINTER, MISALIGNED, BUSY. One thread for to; any number may copy
 * from from while nobody else uses it.
 */
nekton_status nekton_sim_copy(struct nekton_sim *to,
                              const struct nekton_sim *from,
                              struct nekton_diag *diag);

/**
 * Bytes that nekton_sim_save writes; they depend on the model alone.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, BUSY. One thread per simulation.
 */
nekton_status nekton_sim_save_req(const struct nekton_sim *sim, size_t *bytes);

/**
 * Writes all that a simulation remembers to out, which has room for len bytes: time, state, method, integrator and its past,
 * channels, counters, estimates, limit of steps. nekton_sim_load of any simulation of an equal model, in any process and on any
 * machine, goes on from there bit for bit (with the same build of this library). The bytes have no alignment and no pointers;
 * written tells how many there are.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, BUSY, ALIASING, MEMORY_TOO_SMALL (out is then not written), BAD_SAVE (a number
 * of the simulation is not finite). One thread per simulation.
 */
nekton_status nekton_sim_save(const struct nekton_sim *sim,
                              void *out,
                              size_t len,
                              size_t *written,
                              struct nekton_diag *diag);

/**
 * Makes a simulation what was saved by nekton_sim_save, by itself or by another one of an equal model (every value of its scene is
 * the same); the method becomes the saved one, too. from are exactly the len bytes that were written.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, BUSY, ALIASING, BAD_SAVE: diag->what names what is wrong, "mark" (these are other
 * bytes), "version" (of another version of this library), "precision", "model" (another scene), "length", "checksum" (damaged) or
 * a value. The simulation is then as it was, bit for bit. One thread per simulation.
 */
nekton_status nekton_sim_load(struct nekton_sim *sim,
                              const void *from,
                              size_t len,
                              struct nekton_diag *diag);

/**
 * The simulation's model.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. One thread per simulation.
 */
nekton_status nekton_sim_model(const struct nekton_sim *sim, const struct nekton_model **model);

/**
 * Time of the state shown, s.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. One thread per simulation.
 */
nekton_status nekton_sim_time(const struct nekton_sim *sim, double *t);

/**
 * x, y, theta of every link's centre of mass; n = 3 links.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING. One thread per simulation.
 */
nekton_status nekton_sim_positions(const struct nekton_sim *sim, double *q, size_t n);

/**
 * Rates of x, y, theta of every link; n = 3 links.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING. One thread per simulation.
 */
nekton_status nekton_sim_velocities(const struct nekton_sim *sim, double *qd, size_t n);

/**
 * Time and integrated state: free coordinates, their rates (not for a lone swimmer), and last the work of the
 * drives if anything is driven; n = state_len of the plan.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING. One thread per simulation.
 */
nekton_status nekton_sim_get_state(const struct nekton_sim *sim, double *t, double *y, size_t n);

/**
 * Sets time and state as nekton_sim_get_state gives them; the integrator starts anew.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, NOT_FINITE, ALIASING, CONTACT; the simulation is then as
 * it was. One thread per simulation.
 */
nekton_status nekton_sim_set_state(struct nekton_sim *sim,
                                   double t,
                                   const double *y,
                                   size_t n,
                                   struct nekton_diag *diag);

/**
 * Forgets the integrator's past, as after a jump of the drives.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. One thread per simulation.
 */
nekton_status nekton_sim_restart(struct nekton_sim *sim);

/**
 * One step of the method (ADAMS: one step of its own choice). Returns a notice (> 0): STEP_TOO_LONG if the estimated error
 * of the step is a tenth of a body's reach, or of a radian, or more (see nekton_sim_time_error; GAUSS6 has no estimate);
 * UNRESOLVED if the bound of the error in space exceeded the scene's tolerance (1e-3 without); diag tells the bound,
 * when, and what is closest.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE, STEP_TOO_SMALL, NO_CONVERGENCE;
 * the simulation is then as it was, bit for bit. One thread per simulation.
 */
nekton_status nekton_sim_step(struct nekton_sim *sim,
                              struct nekton_diag *diag);

/**
 * Advances to exactly t_end; nothing is evaluated beyond it. A fixed-step method shortens its last step. This is
 * the step function of a controller: set channels, advance by a sample time, read the state. Notices as nekton_sim_step,
 * with the largest error met.
 * Errors: as nekton_sim_step, and PAST_TIME (t_end lies before the time shown), NOT_FINITE, TOO_MANY_STEPS (see
 * nekton_sim_set_step_limit; of fixed steps at once, with how many it takes and how many are allowed). The steps made until then are kept: the state shown is that of the last good step
 * (nekton_sim_time and diag->time tell when), and the simulation may go on, as if it had been asked to come this far.
 * If no step was good, it is as it was before the call, bit for bit. To get back further, copy before you advance
 * (nekton_sim_copy). One thread per simulation.
 */
nekton_status nekton_sim_advance(struct nekton_sim *sim,
                                 double t_end,
                                 struct nekton_diag *diag);

/**
 * Shows the state at t_out; the integrator may run ahead, but not beyond t_stop. Cheaper than nekton_sim_advance
 * when output is wanted at many times: ADAMS keeps its steps and interpolates.
 * Errors: as nekton_sim_advance; PAST_TIME also if t_out > t_stop. One thread per simulation.
 */
nekton_status nekton_sim_advance_dense(struct nekton_sim *sim,
                                       double t_out,
                                       double t_stop,
                                       struct nekton_diag *diag);

/**
 * How many steps one call of nekton_sim_advance or nekton_sim_advance_dense may make (at first 1000000) before it
 * ends with TOO_MANY_STEPS, so that no call takes for ever.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE (0). One thread per simulation.
 */
nekton_status nekton_sim_set_step_limit(struct nekton_sim *sim, uint64_t steps);

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
nekton_status nekton_sim_set_channel(struct nekton_sim *sim,
                                     size_t channel,
                                     const double *from,
                                     const double *to,
                                     struct nekton_diag *diag);

/**
 * Right-hand side dy/dt for an integrator of your own; y and ydot as in nekton_sim_get_state, n = state_len, not
 * overlapping. The simulation's own state does not change.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, NOT_FINITE, ALIASING, CONTACT, SINGULAR, NON_FINITE_STATE;
 * ydot is then 0. One thread per simulation.
 */
nekton_status nekton_sim_rhs(struct nekton_sim *sim,
                             double t,
                             const double *y,
                             double *ydot,
                             size_t n,
                             struct nekton_diag *diag);

/**
 * u and du/dt of every joint; n = joints each.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING. One thread per simulation.
 */
nekton_status nekton_sim_joint_values(struct nekton_sim *sim, double *u, double *du, size_t n);

/**
 * Torque (slider: force) that drives every joint, and its power; n = joints each.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One
 * evaluation if there was none since the last step. One thread per simulation.
 */
nekton_status nekton_sim_joint_torques(struct nekton_sim *sim,
                                       double *torque,
                                       double *power,
                                       size_t n,
                                       struct nekton_diag *diag);

/**
 * Accelerations of every link; n = 3 links. One evaluation if there was none since the last step.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton_sim_accelerations(struct nekton_sim *sim,
                                       double *out,
                                       size_t n,
                                       struct nekton_diag *diag);

/**
 * Mass matrix: bodies and added mass; n = (3 links)^2, column-major. 3 links + 1 solves.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton_sim_mass_matrix(struct nekton_sim *sim,
                                     double *out,
                                     size_t n,
                                     struct nekton_diag *diag);

/**
 * Added mass of the fluid, symmetrized; n = (3 links)^2, column-major. 3 links + 1 solves.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton_sim_added_mass(struct nekton_sim *sim,
                                    double *out,
                                    size_t n,
                                    struct nekton_diag *diag);

/**
 * Christoffel force, quadratic in the velocities, by the scene's formula; n = 3 links. One evaluation if there was
 * none since the last step.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton_sim_christoffel(struct nekton_sim *sim,
                                     double *out,
                                     size_t n,
                                     struct nekton_diag *diag);

/**
 * Full tensor of the Christoffel force, entry (a, i, j) at a + 3 links (i + 3 links j); n = (3 links)^3. For
 * inspection: (3 links)^2 forces.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton_sim_christoffel_tensor(struct nekton_sim *sim,
                                            double *out,
                                            size_t n,
                                            struct nekton_diag *diag);

/**
 * Gradient of the potential energy of weight and buoyancy; n = 3 links. One evaluation if there was none since the
 * last step.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton_sim_buoyancy(struct nekton_sim *sim,
                                  double *out,
                                  size_t n,
                                  struct nekton_diag *diag);

/**
 * Gradient of the potential energy of repulsion; n = 3 links. One evaluation if there was none since the last
 * step.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton_sim_repulsion(struct nekton_sim *sim,
                                   double *out,
                                   size_t n,
                                   struct nekton_diag *diag);

/**
 * Gradient of the energy of the circulatory flow; n = 3 links. One evaluation if there was none since the last
 * step.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton_sim_circulation_gradient(struct nekton_sim *sim,
                                              double *out,
                                              size_t n,
                                              struct nekton_diag *diag);

/**
 * Antisymmetric matrix G of the force G qd of circulation; n = (3 links)^2, column-major. 6 links solves.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
 * per simulation.
 */
nekton_status nekton_sim_gyroscopic(struct nekton_sim *sim,
                                    double *out,
                                    size_t n,
                                    struct nekton_diag *diag);

/**
 * Memory that nekton_sim_linearize and nekton_sim_force_derivatives need for a simulation of this model.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, SIZE_OVERFLOW, UNSUPPORTED (an archive without the feature derivatives). Any thread.
 */
nekton_status nekton_sim_derivatives_req(const struct nekton_model *model,
                                         struct nekton_req *req,
                                         struct nekton_diag *diag);

/**
 * Linearization of dy/dt = f(t, y, parameters) at the state shown, y as nekton_sim_get_state gives it (d numbers): a = df/dy, d x d,
 * and b = df/dparameters, d x count, column-major; a_len and b_len are their numbers of entries. Derivatives of what
 * nekton_sim_rhs computes, with nodes that stay where they are on their outlines. *bound gets a bound of their relative error in
 * space. mem: len bytes as nekton_sim_derivatives_req says, used while the call runs. The simulation does not change, and a run goes
 * on by the same bits. Costs two to three evaluations more; with circulation, whose force is differentiated by differences unless the body
 * is alone, 12 links + 2 more.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, MEMORY_TOO_SMALL, UNKNOWN_KIND and OUT_OF_RANGE (a parameter that the
 * model does not have: diag says which), UNSUPPORTED (the boundary formula), CONTACT, SINGULAR, BOUND_EXCEEDED,
 * NON_FINITE_STATE; a and b are then 0. One thread per simulation.
 */
nekton_status nekton_sim_linearize(struct nekton_sim *sim,
                                   const struct nekton_parameter *parameters,
                                   size_t count,
                                   double *a,
                                   size_t a_len,
                                   double *b,
                                   size_t b_len,
                                   double *bound,
                                   void *mem,
                                   size_t len,
                                   struct nekton_diag *diag);

/**
 * Derivatives of the links' force r = M qdd + F at the state shown for given accelerations qdd (n = 3 links), F without inertia and
 * without the forces of joints: position = dr/dq and velocity = dr/dqd, n x n each, column-major. For mechanics of your own. mem as for
 * nekton_sim_linearize.
 * Errors: as nekton_sim_linearize, NOT_FINITE. One thread per simulation.
 */
nekton_status nekton_sim_force_derivatives(struct nekton_sim *sim,
                                           const double *qdd,
                                           size_t n,
                                           double *position,
                                           double *velocity,
                                           void *mem,
                                           size_t len,
                                           struct nekton_diag *diag);

/**
 * Energies at the state shown. One evaluation if there was none since the last step.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread per simulation.
 */
nekton_status nekton_sim_energy(struct nekton_sim *sim,
                                struct nekton_energy *energy,
                                struct nekton_diag *diag);

/**
 * Balance of energy, 3 numbers: total - work now minus what it was when an energy was first asked for (ask at the start, too); the
 * largest kinetic energy met; the drift from where on ENERGY_DRIFT is noticed. It sees the error of the whole motion, also what
 * no estimate of single steps can see. Cost and errors: as nekton_sim_energy.
 */
nekton_status nekton_sim_energy_drift(struct nekton_sim *sim,
                                      double *drift,
                                      struct nekton_diag *diag);

/**
 * Linear impulse (x, y) and angular impulse about the origin, 3 numbers, of bodies, fluid and circulation.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread per simulation.
 */
nekton_status nekton_sim_impulse(struct nekton_sim *sim,
                                 double *impulse,
                                 struct nekton_diag *diag);

/**
 * Error indicators of the steps: the largest over the last call that stepped; before the first step those of the state
 * shown. They come with every step at the cost of one solve; see nekton_scene_def.tolerance.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED; before the first step CONTACT, SINGULAR, NON_FINITE_STATE. One thread per
 * simulation.
 */
nekton_status nekton_sim_indicators(struct nekton_sim *sim,
                                    struct nekton_resolution *indicators,
                                    struct nekton_diag *diag);

/**
 * Error indicators of the space discretization at the state shown, from all of the added mass. 6 links + 7 solves.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, CONTACT, SINGULAR, NON_FINITE_STATE. One thread per simulation.
 */
nekton_status nekton_sim_resolution(struct nekton_sim *sim,
                                    struct nekton_resolution *resolution,
                                    struct nekton_diag *diag);

/**
 * Estimated local errors of time integration since the start or the last nekton_sim_set_state. Where the motion
 * neither amplifies nor forgets errors, the sums of the coordinates plus those of their rates times the time that is left bound
 * the error: they were 2 to 8 times (RK4), 2 to 22 times (ABM4) and 3 to 400 times (ADAMS) as large. RK4 estimates from the eighth
 * step on, ABM4 from the fourth, GAUSS6 never. No evaluation.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. One thread per simulation.
 */
nekton_status nekton_sim_time_error(const struct nekton_sim *sim,
                                    struct nekton_time_error *error);

/**
 * The smallest gap between boundaries of which one moves. No evaluation.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, NON_FINITE_STATE. One thread per simulation.
 */
nekton_status nekton_sim_gap(struct nekton_sim *sim, struct nekton_gap *gap, struct nekton_diag *diag);

/**
 * What the simulation did since its start.
 * Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. One thread per simulation.
 */
nekton_status nekton_sim_counters(const struct nekton_sim *sim, struct nekton_counters *counters);

#ifdef __cplusplus
} /* extern C */
#endif

/*
 * Memory for static placement, bytes: upper bounds as integer constant expressions, not much above what nekton_model_req and
 * nekton_sim_req tell for the plain quadrature, up to some times that for the graded one on small scenes.
 *
 *   static union { uint64_t align; unsigned char bytes[NEKTON_MODEL_BYTES(1, 2, 32, 0, 0, 0, 0, 2, 0)]; } memory;
 *
 * bodies, joints: numbers; a body of n links has n - 1 joints
 * nodes:          largest number of nodes on a link (NEKTON_SIM_BYTES: 0 for a lone rigid body or without fluid)
 * walls:          number of obstacles, and one for a tank
 * wall_nodes:     largest number of nodes on a wall
 * circulation:    1 if some circulation is not 0, else 0
 * points:         0 if every outline is an ellipse; 1 if some are stars; 4 if some are rectangles; the largest number of
 *                 corners or points if some are polygons or curves
 * rows:           harmonic terms and table rows of all signals together
 * channels:       number of signals set while running
 * graded:         0 for NEKTON_QUADRATURE_PLAIN; for NEKTON_QUADRATURE_GRADED 1, and 2 if there is repulsion
 *
 * Names with NEKTON_P_ are parts of these.
 */
#define NEKTON_P_S(x) ((size_t)(x))
#define NEKTON_P_SQ(x) (NEKTON_P_S(x) * NEKTON_P_S(x))
#define NEKTON_P_L(bodies, joints) (NEKTON_P_S(bodies) + NEKTON_P_S(joints))
#define NEKTON_P_C(bodies, joints) (3 * NEKTON_P_S(bodies) + NEKTON_P_S(joints))
#define NEKTON_P_OUTLINE(points) (200 * NEKTON_P_S(points) + 8)
#define NEKTON_P_MOST(a, b) (NEKTON_P_S(a) > NEKTON_P_S(b) ? NEKTON_P_S(a) : NEKTON_P_S(b))
/* The potential of rotation, on twice the nodes where they will move. */
#define NEKTON_P_BUILD(points, nodes, graded) \
    (NEKTON_P_S(points) == 0 ? 5 * NEKTON_P_S(nodes) + 80 \
                             : ((graded) ? 8 : 2) * NEKTON_P_SQ(nodes) + 26 * NEKTON_P_S(nodes) + NEKTON_P_SQ(points) + \
                                   144 * NEKTON_P_S(points) + 80)
/* Rungs of one boundary, beyond the permanent ones. */
#define NEKTON_P_RUNGS(nodes) (7 * NEKTON_P_MOST(nodes, 24) + 4)
/* What graded quadrature adds to a model: pole tables, ladders, tips, modes; ladders that walls cause on each other; repulsion. */
#define NEKTON_P_MODEL_GRADED(boundaries, nodes, walls, wall_nodes, points, graded) \
    (NEKTON_P_S((graded) != 0) * \
         ((boundaries) * (6 * NEKTON_P_MOST(nodes, wall_nodes) + 4 + 3 * NEKTON_P_S(points) + NEKTON_P_MOST(points, 32)) + \
          NEKTON_P_S(walls) * (NEKTON_P_RUNGS(wall_nodes) + 150)) + \
     NEKTON_P_S((graded) == 2) * 5400)
/* The same for a simulation: nodes, rungs, ladders, preimages. */
#define NEKTON_P_SIM_GRADED(boundaries, u, nodes, wall_nodes, points, graded) \
    (NEKTON_P_S((graded) != 0) * \
     (8 * (u) + (boundaries) * (2 * NEKTON_P_RUNGS(NEKTON_P_MOST(nodes, wall_nodes)) + NEKTON_P_OUTLINE(points) + 74) + \
      14 * (boundaries) * (u)))
#define NEKTON_P_MODEL_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows, graded) \
    (NEKTON_P_L(bodies, joints) * (8 * NEKTON_P_S(nodes) + (1 + NEKTON_P_S((circulation) && NEKTON_P_L(bodies, joints) + NEKTON_P_S(walls) > 1)) * NEKTON_P_SQ(nodes)) + \
     7 * NEKTON_P_S(walls) * NEKTON_P_S(wall_nodes) + \
     (1 + NEKTON_P_S(circulation)) * NEKTON_P_SQ(NEKTON_P_S(walls) * NEKTON_P_S(wall_nodes)) + \
     (NEKTON_P_L(bodies, joints) + NEKTON_P_S(walls)) * NEKTON_P_OUTLINE(points) + \
     NEKTON_P_BUILD(points, NEKTON_P_S(nodes), graded) + 4 * NEKTON_P_S(rows) + \
     NEKTON_P_MODEL_GRADED(NEKTON_P_L(bodies, joints) + NEKTON_P_S(walls), nodes, walls, wall_nodes, points, graded))
#define NEKTON_P_MODEL_RECORDS(bodies, joints, walls) \
    (640 + 544 * NEKTON_P_L(bodies, joints) + 128 * NEKTON_P_C(bodies, joints) + 400 * NEKTON_P_S(walls))
#define NEKTON_P_U(bodies, joints, nodes, walls, wall_nodes) \
    (NEKTON_P_L(bodies, joints) * NEKTON_P_S(nodes) + NEKTON_P_S(walls) * NEKTON_P_S(wall_nodes))
#define NEKTON_P_KEPT(bodies, joints, walls, channels) \
    (48 * NEKTON_P_C(bodies, joints) + 11 * NEKTON_P_L(bodies, joints) + 4 * NEKTON_P_S(walls) + 8 * NEKTON_P_S(channels) + 40)
#define NEKTON_P_EVALUATION(l, c, u, circulation, walls, channels) \
    (34 * (l) + 4 * NEKTON_P_S(walls) + 8 * NEKTON_P_S(channels) + 4 * (c) + 9 * (l) * ((c) + 1) + (c) * ((c) + 2) + \
     ((u) + 15) * ((u) + (c) + 1) + 13 * (u) + 20 + NEKTON_P_S(circulation) * (u) * ((u) + 7))
#define NEKTON_P_SIM_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, channels, points, graded) \
    (2 * NEKTON_P_KEPT(bodies, joints, walls, channels) + \
     NEKTON_P_EVALUATION(NEKTON_P_L(bodies, joints), NEKTON_P_C(bodies, joints), \
                         NEKTON_P_U(bodies, joints, nodes, walls, wall_nodes), circulation, walls, channels) + \
     NEKTON_P_SIM_GRADED(NEKTON_P_L(bodies, joints) + NEKTON_P_S(walls), \
                         NEKTON_P_U(bodies, joints, nodes, walls, wall_nodes), nodes, wall_nodes, points, graded))

#define NEKTON_MODEL_BYTES(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows, graded) \
    (NEKTON_P_MODEL_RECORDS(bodies, joints, walls) + \
     8 * NEKTON_P_MODEL_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows, graded))
#define NEKTON_SIM_BYTES(bodies, joints, nodes, walls, wall_nodes, circulation, channels, points, graded) \
    (1024 + 8 * NEKTON_P_SIM_REALS(bodies, joints, nodes, walls, wall_nodes, circulation, channels, points, graded))

/*
 * Filled by their own size: nekton_link_def_init(&link). What is in the library is the function of the same name, which takes size and
 * version too: (nekton_link_def_init)(&link, sizeof link, NEKTON_ABI_VERSION), as other languages call it.
 */
#define nekton_wall_def_init(def) nekton_wall_def_init((def), sizeof(nekton_wall_def), NEKTON_ABI_VERSION)
#define nekton_body_def_init(def) nekton_body_def_init((def), sizeof(nekton_body_def), NEKTON_ABI_VERSION)
#define nekton_link_def_init(def) nekton_link_def_init((def), sizeof(nekton_link_def), NEKTON_ABI_VERSION)
#define nekton_method_init(def) nekton_method_init((def), sizeof(nekton_method), NEKTON_ABI_VERSION)

#endif /* NEKTON_H */
