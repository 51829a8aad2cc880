/* Commands that show and change the state of simulations. */
#include "arguments.h"
#include "commands.h"
#include "errors.h"
#include "objects.h"
#include "outputs.h"

#include <math.h>
#include <string.h>

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

/* As check; a notice becomes a warning, once until the tolerance is met again. */
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

/* All that the simulation remembers, a row of bytes. */
static void save(call *c)
{
    object *o = get(c->prhs[0]);
    nekton_diag diag;
    size_t bytes = 0, written = 0;
    check(nekton_sim_save_req(o->sim, &bytes), NULL, "sim");
    mxArray *out = mxCreateNumericMatrix(1, (mwSize)bytes, mxUINT8_CLASS, mxREAL);
    check(nekton_sim_save(o->sim, mxGetData(out), bytes, &written, &diag), &diag, "sim");
    c->plhs[0] = out;
}

static void load(call *c)
{
    object *o = get(c->prhs[0]);
    nekton_diag diag;
    const mxArray *bytes = c->prhs[1];
    if (!mxIsUint8(bytes)) mexErrMsgIdAndTxt("nekton:arg:class", "what was saved must be of class uint8");
    check(nekton_sim_load(o->sim, mxGetData(bytes), (size_t)mxGetNumberOfElements(bytes), &diag), &diag, "sim");
    o->unresolved = false;
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

const command step_commands[] = {
    {"time", get_time, 1, 1, 1},
    {"state", state, 1, 1, 2},
    {"set_state", set_state, 3, 3, 0},
    {"restart", restart, 1, 1, 0},
    {"step", step, 1, 1, 0},
    {"advance", advance, 2, 2, 0},
    {"advance_dense", advance_dense, 3, 3, 0},
    {"step_limit", step_limit, 2, 2, 0},
    {"save", save, 1, 1, 1},
    {"load", load, 2, 2, 0},
    {"channels", channels, 5, 5, 0},
    {"rhs", rhs, 3, 4, 1},
    {NULL, NULL, 0, 0, 0},
};
