/* Commands that make and free objects, and facts about models. */
#include "arguments.h"
#include "commands.h"
#include "errors.h"
#include "objects.h"
#include "outputs.h"
#include "scene.h"

#include <math.h>
#include <string.h>

static void create(call *c)
{
    static const char *const kinds[] = {"", "rk4", "abm4", "adams", "gauss6"};
    nekton_scene_def scene;
    nekton_method method;
    nekton_diag diag;
    check(nekton_method_init(&method), NULL, "arg");
    read_scene(c->prhs[0], &scene);
    method.kind = word(c->prhs[1], kinds, COUNT(kinds), "method");
    const double *x = numbers(c->prhs[2], 5, "step, tolerances, longest and first step");
    method.step = x[0];
    method.relative = x[1];
    method.absolute = x[2];
    method.max_step = x[3];
    method.first_step = x[4];
    object *o = free_slot();
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
    uint64_t handle = keep(o, &made);
    memcpy(mxGetData(out), &handle, sizeof handle);
    c->plhs[0] = out;
}

static void destroy(call *c)
{
    drop(get(c->prhs[0]));
}

static void count(call *c) { c->plhs[0] = mxCreateDoubleScalar((double)live_objects()); }

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

const command model_commands[] = {
    {"create", create, 3, 3, 1},
    {"free", destroy, 1, 1, 0},
    {"live", count, 0, 0, 1},
    {"plan", plan, 1, 1, 1},
    {"links", links, 1, 1, 1},
    {"joints", joints, 1, 1, 1},
    {"notices", notices, 1, 1, 1},
    {"outline", outline, 4, 4, 1},
    {NULL, NULL, 0, 0, 0},
};
