/*
 * A swimmer holds its heading. A body that coasts along its length turns broadside by itself: that motion is unstable. Its
 * linearization about coasting with a straight tail gives a linear-quadratic regulator, whose only means is the torque at the
 * tail's hinge, set 50 times a second through a channel. Both runs begin with the same kick of that torque; without control the
 * swimmer tumbles, with control it keeps its heading. The exit code is 0 only if it does.
 *
 * Compile:
 *   cc -std=c99 lqr.c -I ../target/nekton/include ../target/nekton/lib/libnekton.a -lm -o lqr
 */
#include "nekton.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* State: x, y, heading, tail; their rates; work. The motion across does not feel x, its rate and, to first order, the work; and
   nothing depends on y. */
enum { STATE = 9, N = 5 };
static const int across[N] = {2, 3, 5, 6, 7};
static const double sample = 0.02;

static int failed(const nekton_diag *diag)
{
    char text[160];
    nekton_diag_text(diag, text, sizeof text);
    fprintf(stderr, "%s\n", text);
    return 1;
}

/* z' = F z + g u of a sample with constant u, from dz/dt = A z + b u: the exponential of (A b; 0 0) by its series. */
static void discretize(double a[N][N], double b[N], double f[N][N], double g[N])
{
    double term[N][N + 1], next[N][N + 1];
    int i, j, k, m;
    for (i = 0; i < N; i++) {
        for (j = 0; j < N; j++) {
            term[i][j] = a[i][j] * sample;
            f[i][j] = term[i][j];
        }
        term[i][N] = b[i] * sample;
        g[i] = term[i][N];
        f[i][i] += 1.0;
    }
    for (m = 2; m < 12; m++) {
        for (i = 0; i < N; i++) {
            for (j = 0; j <= N; j++) {
                double sum = 0.0;
                for (k = 0; k < N; k++) sum += a[i][k] * term[k][j];
                next[i][j] = sum * sample / m;
            }
        }
        for (i = 0; i < N; i++) {
            for (j = 0; j <= N; j++) term[i][j] = next[i][j];
            for (j = 0; j < N; j++) f[i][j] += term[i][j];
            g[i] += term[i][N];
        }
    }
}

/* Gains of u = -k z for the cost z' Q z + R u^2: the Riccati equation by iteration, a long way back from the end. The impulse across
   the course cannot be changed from inside; P grows with it, the gains do not. */
static void regulator(double f[N][N], double g[N], double k[N])
{
    const double q[N] = {1.0, 0.1, 0.0, 0.0, 0.0}, r = 1.0;
    double p[N][N] = {{0.0}}, pf[N][N], closed[N][N], pg[N];
    int i, j, m, step;
    for (i = 0; i < N; i++) p[i][i] = q[i];
    for (step = 0; step < 3000; step++) {
        double s = r;
        for (i = 0; i < N; i++) {
            pg[i] = 0.0;
            for (j = 0; j < N; j++) pg[i] += p[i][j] * g[j];
        }
        for (i = 0; i < N; i++) s += g[i] * pg[i];
        for (j = 0; j < N; j++) {
            double sum = 0.0;
            for (i = 0; i < N; i++) sum += pg[i] * f[i][j];
            k[j] = sum / s;
        }
        for (i = 0; i < N; i++)
            for (j = 0; j < N; j++) closed[i][j] = f[i][j] - g[i] * k[j];
        for (i = 0; i < N; i++) {
            for (j = 0; j < N; j++) {
                pf[i][j] = 0.0;
                for (m = 0; m < N; m++) pf[i][j] += p[i][m] * closed[m][j];
            }
        }
        for (i = 0; i < N; i++) {
            for (j = 0; j < N; j++) {
                double sum = r * k[i] * k[j] + (i == j ? q[i] : 0.0);
                for (m = 0; m < N; m++) sum += closed[m][i] * pf[m][j];
                p[i][j] = sum;
            }
        }
    }
}

/* Gains about the state that a simulation shows. */
static nekton_status gains(const nekton_model *model, nekton_sim *sim, double k[N], nekton_diag *diag)
{
    const nekton_parameter torque = {NEKTON_PARAMETER_TORQUE, 0, 0, 0};
    double a[STATE * STATE], b[STATE], bound, az[N][N], bz[N], f[N][N], g[N];
    nekton_req req;
    nekton_status status = nekton_sim_derivatives_req(model, &req, diag);
    void *mem = status < 0 ? NULL : malloc(req.size);
    int i, j;
    status = nekton_sim_linearize(sim, &torque, 1, a, STATE * STATE, b, STATE, &bound, mem, req.size, diag);
    free(mem);
    if (status < 0) return status;
    for (i = 0; i < N; i++) {
        for (j = 0; j < N; j++) az[i][j] = a[across[i] + STATE * across[j]]; /* column by column */
        bz[i] = b[across[i]];
    }
    discretize(az, bz, f, g);
    regulator(f, g, k);
    return status;
}

/* Ten seconds: the largest error of the heading, and the one at the end. */
static nekton_status run(nekton_sim *sim, const double k[N], double *largest, double *last, nekton_diag *diag)
{
    double y[STATE], t, from[4] = {0.0, 0.0, 0.0, 0.0}, to[4] = {0.0, 0.0, 0.0, 0.0};
    nekton_status status = NEKTON_OK;
    int i, j;
    *largest = 0.0;
    for (i = 0; i < 500 && status >= 0; i++) {
        status = nekton_sim_get_state(sim, &t, y, STATE);
        from[0] = sample * i;
        to[0] = sample * (i + 1);
        from[1] = 0.0;
        for (j = 0; j < N; j++) from[1] -= k[j] * y[across[j]];
        if (i < 10) from[1] = 0.5; /* the kick */
        to[1] = from[1];
        if (status >= 0) status = nekton_sim_set_channel(sim, 0, from, to, diag);
        if (status >= 0) status = nekton_sim_advance(sim, to[0], diag);
        if (status >= 0) status = nekton_sim_get_state(sim, &t, y, STATE);
        *last = fabs(y[2]);
        if (*last > *largest) *largest = *last;
    }
    return status;
}

int main(void)
{
    const double none[N] = {0.0, 0.0, 0.0, 0.0, 0.0};
    double k[N], largest[2], last[2];
    nekton_scene_def scene;
    nekton_body_def body;
    nekton_link_def links[2];
    nekton_method method;
    nekton_model *model = NULL;
    nekton_sim *sim[2] = {NULL, NULL};
    nekton_diag diag;
    int i;

    if (nekton_scene_def_init(&scene, sizeof scene, NEKTON_ABI_VERSION) != NEKTON_OK) return 1;
    for (i = 0; i < 2; i++) {
        nekton_link_def_init(&links[i]); /* density 1, like the fluid's */
        links[i].shape.kind = NEKTON_SHAPE_ELLIPSE;
        links[i].shape.a = i == 0 ? 1.0 : 0.5;
        links[i].shape.b = i == 0 ? 0.3 : 0.1;
        links[i].nodes = i == 0 ? 48 : 64;
    }
    links[1].parent = 0;
    links[1].joint = NEKTON_JOINT_HINGE;
    links[1].parent_anchor[0] = -1.1;
    links[1].self_anchor[0] = 0.6;
    links[1].drive = NEKTON_DRIVE_TORQUE;
    links[1].signal.kind = NEKTON_SIGNAL_CHANNEL;
    links[1].stiffness = 2.0;
    links[1].damping = 0.5;
    nekton_body_def_init(&body);
    body.velocity[0] = 1.0;
    body.links = links;
    body.link_count = 2;
    scene.bodies = &body;
    scene.body_count = 1;
    nekton_method_init(&method);
    method.kind = NEKTON_METHOD_RK4;
    method.step = sample;
    if (nekton_model_create(&scene, &model, &diag) < 0) return failed(&diag);
    for (i = 0; i < 2; i++)
        if (nekton_sim_create(model, &method, &sim[i], &diag) < 0) return failed(&diag);
    if (gains(model, sim[1], k, &diag) < 0) return failed(&diag);
    for (i = 0; i < 2; i++)
        if (run(sim[i], i == 0 ? none : k, &largest[i], &last[i], &diag) < 0) return failed(&diag);
    printf("gains %.17g %.17g %.17g %.17g %.17g\n", k[0], k[1], k[2], k[3], k[4]);
    printf("free %.17g %.17g\n", largest[0], last[0]);
    printf("held %.17g %.17g\n", largest[1], last[1]);
    for (i = 0; i < 2; i++) nekton_sim_free(sim[i]);
    nekton_model_free(model);
    return last[0] > 0.5 && last[1] < 1e-3 ? 0 : 2;
}
