/*
 * nekton_mex: gateway from Matlab and Octave to the C interface of nekton (include/nekton.h).
 *
 *   [out, ...] = nekton_mex(command, handle, ...)
 *
 * Meant to be called by Nekton.m, which has the help texts. Only what Matlab's C MEX interface also has is used, and only
 * real double data is exchanged, besides texts, structs and handles.
 *
 * An object (a model with its simulation) is known by a uint64 scalar: its slot in the low half, the slot's generation in the
 * high half, so that the handle of a freed object is never taken for a later one. The file is locked while objects live.
 *
 * An error leaves mexFunction by a long jump or an exception: it is raised only when the library has returned, memory needed on the
 * way comes from mxCalloc (freed by the caller of mexFunction in that case), and outputs are assigned last.
 */
#include "mex.h"
#include "nekton.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define SLOTS 1024
#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

typedef struct {
    uint32_t generation;
    nekton_model *model; /* NULL: the slot is free */
    nekton_sim *sim;
    nekton_sim *twin; /* evaluates rhs when joints are driven by channels, so that the simulation's channels stay; or NULL */
    nekton_method method;
    nekton_plan plan;
    bool unresolved; /* the last step gave a notice */
} object;

static object objects[SLOTS];
static size_t live = 0;

static void free_object(object *o)
{
    nekton_sim_free(o->twin);
    nekton_sim_free(o->sim);
    nekton_model_free(o->model);
    o->twin = o->sim = NULL;
    o->model = NULL;
}

/* Runs when the file is unloaded and when the program ends. Must not print. */
static void at_exit(void)
{
    for (size_t i = 0; i < SLOTS; i++) {
        if (objects[i].model) free_object(&objects[i]);
    }
    live = 0;
}

/* ---- errors ------------------------------------------------------------------------------------------------------- */

static void check(nekton_status status, const nekton_diag *diag, const char *group)
{
    if (status >= 0) return;
    char id[96] = "nekton:", text[256] = "";
    const char *name = nekton_status_name(status);
    strncat(id, group, 30);
    strcat(id, ":");
    strncat(id, name, 50);
    if (diag) nekton_diag_text(diag, text, sizeof text);
    mexErrMsgIdAndTxt(id, "%s", text[0] ? text : nekton_status_text(status));
}

/* The same for steps: a notice becomes a warning, once until the tolerance is met again. */
static void stepped(object *o, nekton_status status, const nekton_diag *diag)
{
    check(status, diag, "sim");
    bool before = o->unresolved;
    o->unresolved = status > 0;
    if (!o->unresolved || before) return;
    char id[96] = "nekton:sim:", text[256] = "";
    strncat(id, nekton_status_name(status), 50);
    nekton_diag_text(diag, text, sizeof text);
    mexWarnMsgIdAndTxt(id, "%s", text);
}

/* ---- arguments ---------------------------------------------------------------------------------------------------- */

static bool is_real(const mxArray *a)
{
    return a && mxIsDouble(a) && !mxIsComplex(a) && !mxIsSparse(a) && mxGetNumberOfDimensions(a) == 2;
}

/* A real full double array of n numbers, none of them NaN or infinite. */
static const double *numbers(const mxArray *a, size_t n, const char *what)
{
    if (!is_real(a)) mexErrMsgIdAndTxt("nekton:arg:class", "%s must be real, full and of class double", what);
    if ((size_t)mxGetNumberOfElements(a) != n) {
        mexErrMsgIdAndTxt("nekton:arg:size", "%s must have %lu elements, not %lu", what, (unsigned long)n,
                          (unsigned long)mxGetNumberOfElements(a));
    }
    const double *x = mxGetPr(a);
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(x[i])) mexErrMsgIdAndTxt("nekton:arg:finite", "%s must be finite", what);
    }
    return x;
}

static double number(const mxArray *a, const char *what) { return numbers(a, 1, what)[0]; }

/* A real full double matrix of any number of rows and n columns. */
static const double *matrix(const mxArray *a, size_t n, const char *what)
{
    if (!is_real(a)) mexErrMsgIdAndTxt("nekton:arg:class", "%s must be real, full and of class double", what);
    if ((size_t)mxGetN(a) != n) {
        mexErrMsgIdAndTxt("nekton:arg:size", "%s must have %lu columns, not %lu", what, (unsigned long)n,
                          (unsigned long)mxGetN(a));
    }
    return numbers(a, (size_t)mxGetNumberOfElements(a), what);
}

/* A whole number in [low, high]. */
static double whole(const mxArray *a, double low, double high, const char *what)
{
    double x = number(a, what);
    if (x < low || x > high || x != floor(x)) {
        mexErrMsgIdAndTxt("nekton:arg:range", "%s must be a whole number from %g to %g, not %g", what, low, high, x);
    }
    return x;
}

static void text(const mxArray *a, char *buffer, size_t size, const char *what)
{
    if (!a || !mxIsChar(a) || mxGetNumberOfElements(a) < 1 || mxGetM(a) != 1 || mxGetString(a, buffer, (mwSize)size)) {
        mexErrMsgIdAndTxt("nekton:arg:text", "%s must be a short text", what);
    }
}

/* The position of a word in a list. */
static int32_t word(const mxArray *a, const char *const *words, size_t n, const char *what)
{
    char w[32];
    text(a, w, sizeof w, what);
    for (size_t i = 0; i < n; i++) {
        if (!strcmp(w, words[i])) return (int32_t)i;
    }
    mexErrMsgIdAndTxt("nekton:arg:word", "%s: '%s' is not known", what, w);
    return 0;
}

static object *get(const mxArray *a)
{
    if (!a || !mxIsUint64(a) || mxIsComplex(a) || mxGetNumberOfElements(a) != 1) {
        mexErrMsgIdAndTxt("nekton:handle:class", "a handle must be a uint64 scalar");
    }
    uint64_t h;
    memcpy(&h, mxGetData(a), sizeof h);
    uint64_t slot = (h & 0xffffffffu), generation = h >> 32;
    if (slot < 1 || slot > SLOTS) mexErrMsgIdAndTxt("nekton:handle:invalid", "this is not a handle of nekton");
    object *o = &objects[slot - 1];
    if (!o->model || o->generation != generation) {
        mexErrMsgIdAndTxt("nekton:handle:stale", "this handle's simulation was deleted");
    }
    return o;
}

/* ---- scenes (in the form that nekton_scene.m makes) ------------------------------------------------------------------ */

/* Field of a struct; NULL when it is absent or []. */
static const mxArray *field(const mxArray *s, mwIndex i, const char *name)
{
    const mxArray *a = mxGetField(s, i, name);
    return a && !mxIsEmpty(a) ? a : NULL;
}

static void known(const mxArray *s, const char *const *names, size_t n, const char *what)
{
    if (!s || !mxIsStruct(s)) mexErrMsgIdAndTxt("nekton:scene:class", "%s must be a struct", what);
    for (int k = 0; k < mxGetNumberOfFields(s); k++) {
        const char *name = mxGetFieldNameByNumber(s, k);
        bool found = false;
        for (size_t i = 0; i < n && !found; i++) found = !strcmp(name, names[i]);
        if (!found) mexErrMsgIdAndTxt("nekton:scene:field", "%s has no field '%s'", what, name);
    }
}

static void optional(const mxArray *s, mwIndex i, const char *name, double *value)
{
    const mxArray *a = field(s, i, name);
    if (a) *value = number(a, name);
}

static void optionals(const mxArray *s, mwIndex i, const char *name, double *values, size_t n)
{
    const mxArray *a = field(s, i, name);
    if (a) memcpy(values, numbers(a, n, name), n * sizeof(double));
}

static void nodes(const mxArray *s, mwIndex i, int32_t shape, size_t *n)
{
    const mxArray *a = field(s, i, "nodes");
    static const char *const automatic[] = {"auto"};
    if (a && mxIsChar(a)) {
        *n = (size_t)word(a, automatic, 1, "nodes");
    } else if (a) {
        *n = (size_t)whole(a, 0, 65536, "nodes");
    } else if (shape == NEKTON_SHAPE_RECTANGLE || shape == NEKTON_SHAPE_POLYGON) {
        *n = 128;
    }
}

/* The rows of a matrix, one after the other. */
static double *rows(const mxArray *a, size_t columns, size_t *count, const char *what)
{
    const double *x = matrix(a, columns, what);
    size_t n = (size_t)mxGetM(a);
    double *r = mxCalloc((mwSize)(n * columns + 1), sizeof(double));
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < columns; k++) r[i * columns + k] = x[i + n * k];
    }
    *count = n;
    return r;
}

static void read_shape(const mxArray *a, nekton_shape *shape)
{
    static const char *const names[] = {"ellipse", "star", "rectangle", "polygon", "curve", "radius"};
    known(a, names, COUNT(names), "shape");
    int given = 0;
    for (int k = 0; k < 5; k++) {
        const mxArray *f = field(a, 0, names[k]);
        if (!f) continue;
        given++;
        shape->kind = NEKTON_SHAPE_ELLIPSE + k;
        if (k == 0) {
            const double *x = numbers(f, 2, "ellipse");
            shape->a = x[0];
            shape->b = x[1];
        } else if (k == 1) {
            const double *x = numbers(f, 3, "star");
            shape->radius = x[0];
            shape->amplitude = x[1];
            if (x[2] < 0 || x[2] > 1e6 || x[2] != floor(x[2])) {
                mexErrMsgIdAndTxt("nekton:arg:range", "star: the number of lobes must be a whole number");
            }
            shape->lobes = (uint32_t)x[2];
        } else if (k == 2) {
            const double *x = numbers(f, 2, "rectangle");
            shape->width = x[0];
            shape->height = x[1];
        } else {
            shape->points = (const double(*)[2])rows(f, 2, &shape->point_count, names[k]);
        }
    }
    if (given != 1) mexErrMsgIdAndTxt("nekton:scene:shape", "a shape must be one of ellipse, star, rectangle, polygon, curve");
    optional(a, 0, "radius", &shape->corner_radius);
}

static void read_wall(const mxArray *a, mwIndex i, nekton_wall_def *wall)
{
    static const char *const names[] = {"shape", "position", "angle", "nodes", "circulation"};
    known(a, names, COUNT(names), "a wall");
    check(nekton_wall_def_init(wall), NULL, "scene");
    read_shape(field(a, i, "shape"), &wall->shape);
    optionals(a, i, "position", wall->position, 2);
    optional(a, i, "angle", &wall->angle);
    optional(a, i, "circulation", &wall->circulation);
    nodes(a, i, wall->shape.kind, &wall->nodes);
}

/* A number; a matrix with rows (t, u, du, ddu); a struct with harmonic terms and perhaps a window; or the text 'channel'. */
static void read_signal(const mxArray *a, nekton_signal *signal)
{
    if (mxIsChar(a)) {
        static const char *const words[] = {"channel"};
        word(a, words, 1, "signal");
        signal->kind = NEKTON_SIGNAL_CHANNEL;
    } else if (mxIsStruct(a)) {
        static const char *const names[] = {"harmonic", "window"};
        known(a, names, COUNT(names), "signal");
        const mxArray *h = field(a, 0, "harmonic"), *w = field(a, 0, "window");
        if (!h) mexErrMsgIdAndTxt("nekton:scene:signal", "a signal needs harmonic terms");
        signal->kind = NEKTON_SIGNAL_HARMONIC;
        /* nekton_harmonic is four numbers in this order. */
        signal->harmonics = (const nekton_harmonic *)rows(h, 4, &signal->harmonic_count, "harmonic");
        if (w) {
            const double *x = numbers(w, 3, "window");
            signal->window.from = x[0];
            signal->window.to = x[1];
            signal->window.ramp = x[2];
        }
    } else if (mxIsDouble(a) && mxGetNumberOfElements(a) == 1) {
        signal->kind = NEKTON_SIGNAL_CONSTANT;
        signal->value = number(a, "signal");
    } else {
        signal->kind = NEKTON_SIGNAL_TABLE;
        signal->rows = (const double(*)[4])rows(a, 4, &signal->row_count, "table");
    }
}

static void read_link(const mxArray *a, mwIndex i, nekton_link_def *link)
{
    static const char *const names[] = {"shape",         "nodes",       "circulation", "density", "mass",         "inertia", "centre_of_mass",
                                        "parent",        "joint",       "drive",       "axis",    "locked_value", "angle",   "parent_anchor",
                                        "self_anchor",   "signal",      "stiffness",   "damping", "rest",         "start"};
    static const char *const joints[] = {"hinge", "slider"}, *const drives[] = {"locked", "motion", "torque"};
    known(a, names, COUNT(names), "a link");
    check(nekton_link_def_init(link), NULL, "scene");
    read_shape(field(a, i, "shape"), &link->shape);
    nodes(a, i, link->shape.kind, &link->nodes);
    optional(a, i, "circulation", &link->circulation);
    optional(a, i, "density", &link->density);
    if (field(a, i, "mass")) {
        link->mass_kind = NEKTON_MASS_GIVEN;
        optional(a, i, "mass", &link->mass);
        optional(a, i, "inertia", &link->inertia);
        optionals(a, i, "centre_of_mass", link->centre_of_mass, 2);
    }
    const mxArray *f = field(a, i, "parent");
    if (f) link->parent = (int32_t)whole(f, 0, 1e6, "parent") - 1; /* from 1; 0: none */
    if ((f = field(a, i, "joint"))) link->joint = word(f, joints, COUNT(joints), "joint");
    if ((f = field(a, i, "drive"))) link->drive = word(f, drives, COUNT(drives), "drive");
    optionals(a, i, "parent_anchor", link->parent_anchor, 2);
    optionals(a, i, "self_anchor", link->self_anchor, 2);
    optionals(a, i, "axis", link->axis, 2);
    optional(a, i, "angle", &link->angle);
    optional(a, i, "locked_value", &link->locked_value);
    if ((f = field(a, i, "signal"))) read_signal(f, &link->signal);
    optional(a, i, "stiffness", &link->stiffness);
    optional(a, i, "damping", &link->damping);
    optional(a, i, "rest", &link->rest);
    optionals(a, i, "start", link->start, 2);
}

static void read_body(const mxArray *a, mwIndex i, nekton_body_def *body)
{
    static const char *const names[] = {"pose", "velocity", "root", "links"};
    known(a, names, COUNT(names), "a body");
    check(nekton_body_def_init(body), NULL, "scene");
    optionals(a, i, "pose", body->pose, 3);
    optionals(a, i, "velocity", body->velocity, 3);
    const mxArray *f = field(a, i, "root");
    if (f) {
        if (!mxIsCell(f) || mxGetNumberOfElements(f) != 3) mexErrMsgIdAndTxt("nekton:scene:root", "root must be a cell of 3 signals");
        body->root = NEKTON_ROOT_PRESCRIBED;
        for (mwIndex k = 0; k < 3; k++) {
            const mxArray *signal = mxGetCell(f, k);
            if (signal && !mxIsEmpty(signal)) read_signal(signal, &body->motion[k]);
        }
    }
    f = field(a, i, "links");
    if (!f || !mxIsStruct(f)) mexErrMsgIdAndTxt("nekton:scene:links", "a body needs links");
    body->link_count = (size_t)mxGetNumberOfElements(f);
    nekton_link_def *links = mxCalloc((mwSize)body->link_count, sizeof *links);
    for (size_t k = 0; k < body->link_count; k++) read_link(f, (mwIndex)k, &links[k]);
    body->links = links;
}

static void read_scene(const mxArray *a, nekton_scene_def *scene)
{
    static const char *const names[] = {"fluid_density", "gravity",   "repulsion_epsilon", "repulsion_alpha", "circulation", "force",
                                        "quadrature",    "tolerance", "shortcuts",         "tank",            "obstacles",   "bodies"};
    static const char *const circulations[] = {"full", "paper"}, *const forces[] = {"exact", "boundary"},
                      *const quadratures[] = {"graded", "plain"};
    known(a, names, COUNT(names), "scene");
    check(nekton_scene_def_init(scene, sizeof *scene, NEKTON_ABI_VERSION), NULL, "scene");
    optional(a, 0, "fluid_density", &scene->fluid_density);
    optional(a, 0, "gravity", &scene->gravity);
    optional(a, 0, "repulsion_epsilon", &scene->repulsion_epsilon);
    optional(a, 0, "repulsion_alpha", &scene->repulsion_alpha);
    const mxArray *f;
    if ((f = field(a, 0, "circulation"))) scene->circulation = word(f, circulations, COUNT(circulations), "circulation");
    if ((f = field(a, 0, "force"))) scene->force = word(f, forces, COUNT(forces), "force");
    if ((f = field(a, 0, "quadrature"))) scene->quadrature = word(f, quadratures, COUNT(quadratures), "quadrature");
    optional(a, 0, "tolerance", &scene->tolerance);
    if ((f = field(a, 0, "shortcuts"))) scene->shortcuts = (int32_t)whole(f, 0, 1, "shortcuts");
    if ((f = field(a, 0, "tank"))) {
        nekton_wall_def *tank = mxCalloc(1, sizeof *tank);
        read_wall(f, 0, tank);
        scene->tank = tank;
    }
    if ((f = field(a, 0, "obstacles"))) {
        size_t n = (size_t)mxGetNumberOfElements(f);
        nekton_wall_def *walls = mxCalloc((mwSize)n, sizeof *walls);
        for (size_t k = 0; k < n; k++) read_wall(f, (mwIndex)k, &walls[k]);
        scene->obstacles = walls;
        scene->obstacle_count = n;
    }
    if ((f = field(a, 0, "bodies"))) {
        size_t n = (size_t)mxGetNumberOfElements(f);
        nekton_body_def *bodies = mxCalloc((mwSize)n, sizeof *bodies);
        for (size_t k = 0; k < n; k++) read_body(f, (mwIndex)k, &bodies[k]);
        scene->bodies = bodies;
        scene->body_count = n;
    }
}

/* ---- outputs ------------------------------------------------------------------------------------------------------ */

static mxArray *column(size_t n) { return mxCreateDoubleMatrix((mwSize)n, 1, mxREAL); }

static mxArray *record(const char **names, const double *values, int n)
{
    mxArray *s = mxCreateStructMatrix(1, 1, n, names);
    for (int k = 0; k < n; k++) mxSetField(s, 0, names[k], mxCreateDoubleScalar(values[k]));
    return s;
}

/* ---- commands ----------------------------------------------------------------------------------------------------- */

typedef struct {
    int nlhs;
    mxArray **plhs;
    int nrhs; /* without the command */
    const mxArray **prhs;
} call;

static void create(call *c)
{
    static const char *const kinds[] = {"", "rk4", "abm4", "adams", "gauss6"};
    nekton_scene_def scene;
    nekton_method method;
    nekton_diag diag;
    memset(&method, 0, sizeof method);
    read_scene(c->prhs[0], &scene);
    method.kind = word(c->prhs[1], kinds, COUNT(kinds), "method");
    const double *x = numbers(c->prhs[2], 3, "step and tolerances");
    method.step = x[0];
    method.relative = x[1];
    method.absolute = x[2];
    object *o = objects;
    while (o < objects + SLOTS && o->model) o++;
    if (o == objects + SLOTS) mexErrMsgIdAndTxt("nekton:handle:full", "more than %d simulations at once", SLOTS);
    /* What may fail for lack of memory comes before the library's objects exist. */
    mxArray *out = mxCreateNumericMatrix(1, 1, mxUINT64_CLASS, mxREAL);
    object made;
    memset(&made, 0, sizeof made);
    made.method = method;
    nekton_status status = nekton_model_create(&scene, &made.model, &diag);
    check(status, &diag, "scene");
    status = nekton_sim_create(made.model, &method, &made.sim, &diag);
    if (status >= 0) status = nekton_model_plan(made.model, &made.plan);
    if (status >= 0 && made.plan.channels > 0) {
        status = nekton_sim_create(made.model, &method, &made.twin, &diag);
    }
    if (status < 0) {
        free_object(&made);
        check(status, &diag, "scene");
    }
    made.generation = o->generation + 1;
    *o = made;
    if (live++ == 0) mexLock();
    uint64_t handle = ((uint64_t)o->generation << 32) | (uint64_t)(o - objects + 1);
    memcpy(mxGetData(out), &handle, sizeof handle);
    c->plhs[0] = out;
}

static void destroy(call *c)
{
    free_object(get(c->prhs[0]));
    if (--live == 0) mexUnlock();
}

static void count(call *c) { c->plhs[0] = mxCreateDoubleScalar((double)live); }

static void plan(call *c)
{
    const nekton_plan *p = &get(c->prhs[0])->plan;
    static const char *names[] = {"formulation", "fluid",       "gravity",          "repulsion",              "circulation",
                                  "links",       "walls",       "joints",           "channels",               "notices",
                                  "coordinates", "free_coordinates", "prescribed_coordinates", "state_len",   "unknowns",
                                  "moving_unknowns", "right_hand_sides", "model_bytes", "sim_bytes",          "operations",
                                  "tolerance"};
    double v[] = {p->formulation,           p->fluid,
                  p->gravity,               p->repulsion,
                  p->circulation,           (double)p->links,
                  (double)p->walls,         (double)p->joints,
                  (double)p->channels,      (double)p->notices,
                  (double)p->coordinates,   (double)p->free_coordinates,
                  (double)p->prescribed_coordinates, (double)p->state_len,
                  (double)p->unknowns,      (double)p->moving_unknowns,
                  (double)p->right_hand_sides, (double)p->model_bytes,
                  (double)p->sim_bytes,     p->operations,
                  p->tolerance};
    c->plhs[0] = record(names, v, COUNT(names));
}

/* Rows: body, link (from 1), nodes, mass, inertia, area, perimeter, centroid x, y. */
static void links(call *c)
{
    object *o = get(c->prhs[0]);
    size_t n = o->plan.links;
    mxArray *out = mxCreateDoubleMatrix((mwSize)n, 9, mxREAL);
    double *x = mxGetPr(out);
    for (size_t i = 0; i < n; i++) {
        nekton_link_info info;
        check(nekton_model_link(o->model, i, &info), NULL, "model");
        double v[9] = {info.place.index + 1.0, info.place.link + 1.0, (double)info.nodes, info.mass,       info.inertia,
                       info.area,              info.perimeter,        info.centroid[0],   info.centroid[1]};
        for (size_t k = 0; k < 9; k++) x[i + n * k] = v[k];
    }
    c->plhs[0] = out;
}

/* Rows: body, link (from 1), prescribed. */
static void joints(call *c)
{
    object *o = get(c->prhs[0]);
    size_t n = o->plan.joints;
    mxArray *out = mxCreateDoubleMatrix((mwSize)n, 3, mxREAL);
    double *x = mxGetPr(out);
    for (size_t i = 0; i < n; i++) {
        nekton_joint_info info;
        check(nekton_model_joint(o->model, i, &info), NULL, "model");
        x[i] = info.place.index + 1.0;
        x[i + n] = info.place.link + 1.0;
        x[i + 2 * n] = info.prescribed;
    }
    c->plhs[0] = out;
}

static void notices(call *c)
{
    object *o = get(c->prhs[0]);
    mxArray *out = mxCreateCellMatrix((mwSize)o->plan.notices, 1);
    for (size_t i = 0; i < o->plan.notices; i++) {
        nekton_diag diag;
        char line[256] = "";
        memset(&diag, 0, sizeof diag);
        diag.other.kind = NEKTON_PLACE_NONE;
        diag.item = -1;
        diag.value = diag.time = NAN;
        check(nekton_model_notice(o->model, i, &diag.place, &diag.status), NULL, "model");
        nekton_diag_text(&diag, line, sizeof line);
        mxSetCell(out, (mwIndex)i, mxCreateString(line));
    }
    c->plhs[0] = out;
}

/* Points of the outline of 'tank', 'obstacle' or 'link' number (body and) index at parameters t: 2 x n. */
static void outline(call *c)
{
    static const char *const kinds[] = {"tank", "obstacle", "body", "link"};
    object *o = get(c->prhs[0]);
    nekton_place place;
    place.kind = NEKTON_PLACE_TANK + word(c->prhs[1], kinds, COUNT(kinds), "kind of place");
    const double *x = numbers(c->prhs[2], 2, "place");
    for (int k = 0; k < 2; k++) {
        if (x[k] < 0 || x[k] > 1e6 || x[k] != floor(x[k])) mexErrMsgIdAndTxt("nekton:arg:range", "place must be whole numbers");
    }
    place.index = (int32_t)x[0] - 1;
    place.link = (int32_t)x[1] - 1;
    size_t n = (size_t)mxGetNumberOfElements(c->prhs[3]);
    const double *t = numbers(c->prhs[3], n, "t");
    mxArray *out = mxCreateDoubleMatrix(2, (mwSize)n, mxREAL);
    for (size_t i = 0; i < n; i++) {
        check(nekton_model_outline_point(o->model, &place, t[i], mxGetPr(out) + 2 * i), NULL, "model");
    }
    c->plhs[0] = out;
}

static void get_time(call *c)
{
    double t = 0;
    check(nekton_sim_time(get(c->prhs[0])->sim, &t), NULL, "sim");
    c->plhs[0] = mxCreateDoubleScalar(t);
}

static void state(call *c)
{
    object *o = get(c->prhs[0]);
    mxArray *y = column(o->plan.state_len);
    double t = 0;
    check(nekton_sim_get_state(o->sim, &t, mxGetPr(y), o->plan.state_len), NULL, "sim");
    c->plhs[0] = y;
    if (c->nlhs > 1) c->plhs[1] = mxCreateDoubleScalar(t);
}

static void set_state(call *c)
{
    object *o = get(c->prhs[0]);
    nekton_diag diag;
    double t = number(c->prhs[1], "t");
    const double *y = numbers(c->prhs[2], o->plan.state_len, "state");
    check(nekton_sim_set_state(o->sim, t, y, o->plan.state_len, &diag), &diag, "sim");
}

static void restart(call *c) { check(nekton_sim_restart(get(c->prhs[0])->sim), NULL, "sim"); }

static void step(call *c)
{
    nekton_diag diag;
    object *o = get(c->prhs[0]);
    stepped(o, nekton_sim_step(o->sim, &diag), &diag);
}

static void advance(call *c)
{
    object *o = get(c->prhs[0]);
    nekton_diag diag;
    double t = number(c->prhs[1], "t");
    stepped(o, nekton_sim_advance(o->sim, t, &diag), &diag);
}

static void advance_dense(call *c)
{
    object *o = get(c->prhs[0]);
    nekton_diag diag;
    double t = number(c->prhs[1], "t"), stop = number(c->prhs[2], "t_stop");
    stepped(o, nekton_sim_advance_dense(o->sim, t, stop, &diag), &diag);
}

static void step_limit(call *c)
{
    object *o = get(c->prhs[0]);
    uint64_t n = (uint64_t)whole(c->prhs[1], 1, 9007199254740992.0, "limit of steps");
    check(nekton_sim_set_step_limit(o->sim, n), NULL, "sim");
    if (o->twin) check(nekton_sim_set_step_limit(o->twin, n), NULL, "sim");
}

/* u, du, ddu (channels x 3) at time t. */
static const double *controls(object *o, const mxArray *a)
{
    if (is_real(a) && (size_t)mxGetM(a) != o->plan.channels) {
        mexErrMsgIdAndTxt("nekton:arg:size", "controls must have %lu rows, not %lu", (unsigned long)o->plan.channels,
                          (unsigned long)mxGetM(a));
    }
    return matrix(a, 3, "controls");
}

static void set_channels(object *o, nekton_sim *sim, double t0, const double *u0, double t1, const double *u1)
{
    size_t n = o->plan.channels;
    for (size_t k = 0; k < n; k++) {
        nekton_diag diag;
        double from[4] = {t0, u0[k], u0[k + n], u0[k + 2 * n]}, to[4] = {t1, u1[k], u1[k + n], u1[k + 2 * n]};
        check(nekton_sim_set_channel(sim, k, from, to, &diag), &diag, "sim");
    }
}

/* channels, t0, controls at t0, t1, controls at t1 */
static void channels(call *c)
{
    object *o = get(c->prhs[0]);
    double t0 = number(c->prhs[1], "t0"), t1 = number(c->prhs[3], "t1");
    const double *u0 = controls(o, c->prhs[2]), *u1 = controls(o, c->prhs[4]);
    if (!(t0 < t1)) mexErrMsgIdAndTxt("nekton:arg:range", "t1 must be later than t0");
    set_channels(o, o->sim, t0, u0, t1, u1);
}

/* rhs, t, state [, controls at t] */
static void rhs(call *c)
{
    object *o = get(c->prhs[0]);
    nekton_diag diag;
    size_t n = o->plan.state_len;
    double t = number(c->prhs[1], "t");
    const double *y = numbers(c->prhs[2], n, "state");
    nekton_sim *sim = o->sim;
    if (o->twin) {
        if (c->nrhs != 4) mexErrMsgIdAndTxt("nekton:arg:count", "rhs needs the controls at time t");
        const double *u = controls(o, c->prhs[3]);
        sim = o->twin;
        set_channels(o, sim, t, u, t + 1.0 + fabs(t), u); /* only the values at t itself are used */
    }
    mxArray *out = column(n);
    check(nekton_sim_rhs(sim, t, y, mxGetPr(out), n, &diag), &diag, "sim");
    c->plhs[0] = out;
}

static void joint_values(call *c)
{
    object *o = get(c->prhs[0]);
    size_t n = o->plan.joints;
    mxArray *u = column(n), *du = column(n);
    if (n) check(nekton_sim_joint_values(o->sim, mxGetPr(u), mxGetPr(du), n), NULL, "sim");
    c->plhs[0] = u;
    if (c->nlhs > 1) c->plhs[1] = du;
}

static void torques(call *c)
{
    object *o = get(c->prhs[0]);
    nekton_diag diag;
    size_t n = o->plan.joints;
    mxArray *torque = column(n), *power = column(n);
    if (n) check(nekton_sim_joint_torques(o->sim, mxGetPr(torque), mxGetPr(power), n, &diag), &diag, "sim");
    c->plhs[0] = torque;
    if (c->nlhs > 1) c->plhs[1] = power;
}

static void energy(call *c)
{
    nekton_energy e;
    nekton_diag diag;
    check(nekton_sim_energy(get(c->prhs[0])->sim, &e, &diag), &diag, "sim");
    static const char *names[] = {"kinetic_fluid", "kinetic_bodies", "buoyancy", "repulsion", "circulation", "total", "work"};
    double v[] = {e.kinetic_fluid, e.kinetic_bodies, e.buoyancy, e.repulsion, e.circulation, e.total, e.work};
    c->plhs[0] = record(names, v, COUNT(names));
}

static void impulse(call *c)
{
    object *o = get(c->prhs[0]);
    nekton_diag diag;
    mxArray *out = column(3);
    check(nekton_sim_impulse(o->sim, mxGetPr(out), &diag), &diag, "sim");
    c->plhs[0] = out;
}

static mxArray *errors_in_space(const nekton_resolution *r)
{
    static const char *names[] = {"mass", "force", "quadrature", "repulsion", "bound"};
    double v[] = {r->mass, r->force, r->quadrature, r->repulsion, r->bound};
    return record(names, v, COUNT(names));
}

static void resolution(call *c)
{
    nekton_resolution r;
    nekton_diag diag;
    check(nekton_sim_resolution(get(c->prhs[0])->sim, &r, &diag), &diag, "sim");
    c->plhs[0] = errors_in_space(&r);
}

static void indicators(call *c)
{
    nekton_resolution r;
    nekton_diag diag;
    check(nekton_sim_indicators(get(c->prhs[0])->sim, &r, &diag), &diag, "sim");
    c->plhs[0] = errors_in_space(&r);
}

static void time_error(call *c)
{
    nekton_time_error e;
    check(nekton_sim_time_error(get(c->prhs[0])->sim, &e), NULL, "sim");
    static const char *names[] = {"length",     "angle",     "speed",     "spin",   "length_sum",
                                  "angle_sum", "speed_sum", "spin_sum", "unknown"};
    double v[] = {e.length, e.angle, e.speed, e.spin, e.length_sum, e.angle_sum, e.speed_sum, e.spin_sum, (double)e.unknown};
    c->plhs[0] = record(names, v, COUNT(names));
}

/* The distance, and the two places as rows (kind, index, link), counted from 1. */
static void gap(call *c)
{
    nekton_gap g;
    nekton_diag diag;
    check(nekton_sim_gap(get(c->prhs[0])->sim, &g, &diag), &diag, "sim");
    mxArray *places = mxCreateDoubleMatrix(2, 3, mxREAL);
    double v[6] = {g.first.kind, g.second.kind, g.first.index + 1.0, g.second.index + 1.0, g.first.link + 1.0, g.second.link + 1.0};
    memcpy(mxGetPr(places), v, sizeof v);
    c->plhs[0] = mxCreateDoubleScalar(g.distance);
    if (c->nlhs > 1) c->plhs[1] = places;
}

static void counters(call *c)
{
    nekton_counters n;
    check(nekton_sim_counters(get(c->prhs[0])->sim, &n), NULL, "sim");
    static const char *names[] = {"evaluations", "factorizations", "steps", "rejected"};
    double v[] = {(double)n.evaluations, (double)n.factorizations, (double)n.steps, (double)n.rejected};
    c->plhs[0] = record(names, v, COUNT(names));
}

static void positions(call *c)
{
    object *o = get(c->prhs[0]);
    mxArray *out = mxCreateDoubleMatrix(3, (mwSize)o->plan.links, mxREAL);
    check(nekton_sim_positions(o->sim, mxGetPr(out), o->plan.coordinates), NULL, "sim");
    c->plhs[0] = out;
}

static void velocities(call *c)
{
    object *o = get(c->prhs[0]);
    mxArray *out = mxCreateDoubleMatrix(3, (mwSize)o->plan.links, mxREAL);
    check(nekton_sim_velocities(o->sim, mxGetPr(out), o->plan.coordinates), NULL, "sim");
    c->plhs[0] = out;
}

typedef nekton_status (*getter)(nekton_sim *, double *, size_t, nekton_diag *);

/* Vectors (columns = 0) and matrices at the state shown. */
static void quantity(call *c, getter f, bool square)
{
    object *o = get(c->prhs[0]);
    nekton_diag diag;
    size_t n = o->plan.coordinates;
    mxArray *out = mxCreateDoubleMatrix((mwSize)n, (mwSize)(square ? n : 1), mxREAL);
    check(f(o->sim, mxGetPr(out), square ? n * n : n, &diag), &diag, "sim");
    c->plhs[0] = out;
}

static void accelerations(call *c) { quantity(c, nekton_sim_accelerations, false); }
static void mass_matrix(call *c) { quantity(c, nekton_sim_mass_matrix, true); }
static void added_mass(call *c) { quantity(c, nekton_sim_added_mass, true); }
static void christoffel(call *c) { quantity(c, nekton_sim_christoffel, false); }
static void buoyancy(call *c) { quantity(c, nekton_sim_buoyancy, false); }
static void repulsion(call *c) { quantity(c, nekton_sim_repulsion, false); }
static void circulation(call *c) { quantity(c, nekton_sim_circulation_gradient, false); }
static void gyroscopic(call *c) { quantity(c, nekton_sim_gyroscopic, true); }

static const struct {
    const char *name;
    void (*run)(call *);
    int least, most, outputs;
} commands[] = {
    {"create", create, 3, 3, 1},
    {"free", destroy, 1, 1, 0},
    {"live", count, 0, 0, 1},
    {"plan", plan, 1, 1, 1},
    {"links", links, 1, 1, 1},
    {"joints", joints, 1, 1, 1},
    {"notices", notices, 1, 1, 1},
    {"outline", outline, 4, 4, 1},
    {"time", get_time, 1, 1, 1},
    {"state", state, 1, 1, 2},
    {"set_state", set_state, 3, 3, 0},
    {"restart", restart, 1, 1, 0},
    {"step", step, 1, 1, 0},
    {"advance", advance, 2, 2, 0},
    {"advance_dense", advance_dense, 3, 3, 0},
    {"step_limit", step_limit, 2, 2, 0},
    {"channels", channels, 5, 5, 0},
    {"rhs", rhs, 3, 4, 1},
    {"positions", positions, 1, 1, 1},
    {"velocities", velocities, 1, 1, 1},
    {"joint_values", joint_values, 1, 1, 2},
    {"torques", torques, 1, 1, 2},
    {"energy", energy, 1, 1, 1},
    {"impulse", impulse, 1, 1, 1},
    {"resolution", resolution, 1, 1, 1},
    {"indicators", indicators, 1, 1, 1},
    {"time_error", time_error, 1, 1, 1},
    {"gap", gap, 1, 1, 2},
    {"counters", counters, 1, 1, 1},
    {"accelerations", accelerations, 1, 1, 1},
    {"mass_matrix", mass_matrix, 1, 1, 1},
    {"added_mass", added_mass, 1, 1, 1},
    {"christoffel", christoffel, 1, 1, 1},
    {"buoyancy", buoyancy, 1, 1, 1},
    {"repulsion", repulsion, 1, 1, 1},
    {"circulation", circulation, 1, 1, 1},
    {"gyroscopic", gyroscopic, 1, 1, 1},
};

void mexFunction(int nlhs, mxArray *plhs[], int nrhs, const mxArray *prhs[])
{
    static bool ready = false;
    if (!ready) {
        if (nekton_abi_version() != NEKTON_ABI_VERSION) {
            mexErrMsgIdAndTxt("nekton:mex:version", "header and library do not fit: run build_nekton again");
        }
        mexAtExit(at_exit);
        ready = true;
    }
    char name[32];
    if (nrhs < 1) mexErrMsgIdAndTxt("nekton:arg:count", "nekton_mex(command, ...)");
    text(prhs[0], name, sizeof name, "command");
    call c = {nlhs, plhs, nrhs - 1, prhs + 1};
    for (size_t i = 0; i < COUNT(commands); i++) {
        if (strcmp(name, commands[i].name)) continue;
        if (c.nrhs < commands[i].least || c.nrhs > commands[i].most) {
            mexErrMsgIdAndTxt("nekton:arg:count", "%s: wrong number of arguments", name);
        }
        if (nlhs > commands[i].outputs) mexErrMsgIdAndTxt("nekton:arg:count", "%s: too many outputs", name);
        commands[i].run(&c);
        return;
    }
    mexErrMsgIdAndTxt("nekton:arg:command", "there is no command '%s'", name);
}
