/* Commands that ask for quantities at the state shown. */
#include "arguments.h"
#include "commands.h"
#include "errors.h"
#include "objects.h"
#include "outputs.h"

#include <math.h>
#include <string.h>

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

/* A, B and the bound; the parameters are rows (kind, number of the link or joint from 1, component from 1; 0: none). */
static void linearize(call *c)
{
    object *o = get(c->prhs[0]);
    nekton_diag diag;
    nekton_req req;
    double bound = 0;
    size_t d = o->plan.state_len, n = is_real(c->prhs[1]) ? (size_t)mxGetM(c->prhs[1]) : 0;
    const double *x = matrix(c->prhs[1], 3, "parameters");
    for (size_t i = 0; i < 3 * n; i++) {
        if (x[i] < 0 || x[i] > 1e9 || x[i] != floor(x[i])) {
            mexErrMsgIdAndTxt("nekton:arg:range", "parameters must be whole numbers, not %g", x[i]);
        }
    }
    check(nekton_sim_derivatives_req(o->model, &req, &diag), &diag, "sim");
    nekton_parameter *parameters = mxCalloc(n + 1, sizeof *parameters);
    for (size_t k = 0; k < n; k++) {
        parameters[k].kind = (int32_t)x[k];
        parameters[k].index = (int32_t)x[k + n] - 1;
        parameters[k].component = x[k + 2 * n] > 0 ? (int32_t)x[k + 2 * n] - 1 : 0;
    }
    void *mem = mxCalloc(req.size + 1, 1);
    mxArray *a = mxCreateDoubleMatrix((mwSize)d, (mwSize)d, mxREAL), *b = mxCreateDoubleMatrix((mwSize)d, (mwSize)n, mxREAL);
    nekton_status status = nekton_sim_linearize(o->sim, parameters, n, mxGetPr(a), d * d, mxGetPr(b), d * n, &bound, mem,
                                                req.size, &diag);
    mxFree(mem);
    mxFree(parameters);
    check(status, &diag, "sim");
    c->plhs[0] = a;
    if (c->nlhs > 1) c->plhs[1] = b;
    if (c->nlhs > 2) c->plhs[2] = mxCreateDoubleScalar(bound);
}

const command quantity_commands[] = {
    {"linearize", linearize, 2, 2, 3},
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
    {NULL, NULL, 0, 0, 0},
};
