#include "scene.h"
#include "arguments.h"
#include "errors.h"

#include <math.h>
#include <string.h>

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

static void nodes(const mxArray *s, mwIndex i, size_t *n)
{
    const mxArray *a = field(s, i, "nodes");
    static const char *const automatic[] = {"auto"};
    if (a && mxIsChar(a)) {
        *n = (size_t)word(a, automatic, 1, "nodes");
    } else if (a) {
        *n = (size_t)whole(a, 0, 65536, "nodes");
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

/* Corners of a curve: 'auto', 'none', or numbers of points from 1. */
typedef struct {
    int32_t kind;
    const size_t *points;
    size_t count;
} corner_list;

static corner_list read_corners(const mxArray *a)
{
    corner_list c = {NEKTON_CORNERS_AUTO, NULL, 0};
    static const char *const words[] = {"auto", "none"};
    if (a && mxIsChar(a)) {
        c.kind = word(a, words, 2, "corners") ? NEKTON_CORNERS_NONE : NEKTON_CORNERS_AUTO;
    } else if (a) {
        c.count = (size_t)mxGetNumberOfElements(a);
        const double *x = numbers(a, c.count, "corners");
        size_t *points = mxCalloc((mwSize)c.count, sizeof(size_t));
        for (size_t i = 0; i < c.count; i++) {
            if (!(x[i] >= 1 && x[i] <= 1e9) || x[i] != floor(x[i])) {
                mexErrMsgIdAndTxt("nekton:arg:range", "corners: the number of a point must be a whole number from 1 on");
            }
            points[i] = (size_t)x[i] - 1;
        }
        c.kind = NEKTON_CORNERS_GIVEN;
        c.points = points;
    }
    return c;
}

static corner_list read_shape(const mxArray *a, nekton_shape *shape)
{
    static const char *const names[] = {"ellipse", "star", "rectangle", "polygon", "curve", "radius", "corners"};
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
    return read_corners(field(a, 0, "corners"));
}

static void read_wall(const mxArray *a, mwIndex i, nekton_wall_def *wall)
{
    static const char *const names[] = {"shape", "position", "angle", "nodes", "circulation"};
    known(a, names, COUNT(names), "a wall");
    check(nekton_wall_def_init(wall), NULL, "scene");
    corner_list corners = read_shape(field(a, i, "shape"), &wall->shape);
    wall->corners = corners.kind;
    wall->corner_points = corners.points;
    wall->corner_count = corners.count;
    optionals(a, i, "position", wall->position, 2);
    optional(a, i, "angle", &wall->angle);
    optional(a, i, "circulation", &wall->circulation);
    nodes(a, i, &wall->nodes);
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
    corner_list corners = read_shape(field(a, i, "shape"), &link->shape);
    link->corners = corners.kind;
    link->corner_points = corners.points;
    link->corner_count = corners.count;
    nodes(a, i, &link->nodes);
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

void read_scene(const mxArray *a, nekton_scene_def *scene)
{
    static const char *const names[] = {"fluid_density", "gravity",   "repulsion_epsilon", "repulsion_alpha", "circulation", "force",
                                        "quadrature",    "tolerance", "shortcuts",         "tank",            "obstacles",   "bodies",    "allow_unresolved"};
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
    if ((f = field(a, 0, "allow_unresolved"))) scene->allow_unresolved = (int32_t)whole(f, 0, 1, "allow_unresolved");
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
