/*
 * The right-hand side for an integrator of your own: here the classical Runge-Kutta method, written out. nekton_sim_rhs does
 * not change the simulation; time and state belong to the caller.
 *
 * Compile:
 *   cc -std=c99 own_integrator.c -I ../target/nekton/include ../target/nekton/lib/libnekton.a -lm -o own_integrator
 */
#include "nekton.h"
#include <stdio.h>

enum { MAX = 16 };

static int failed(const nekton_diag *diag)
{
    char text[160];
    nekton_diag_text(diag, text, sizeof text);
    fprintf(stderr, "%s\n", text);
    return 1;
}

/* One step of length h from time t. Negative: the status of the evaluation that failed; y is then as it was. */
static nekton_status rk4_step(nekton_sim *sim, double t, double h, double *y, size_t n, nekton_diag *diag)
{
    static const double node[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    double k[MAX] = {0.0}, stage[MAX], sum[MAX];
    size_t s, i;
    for (i = 0; i < n; i++)
        sum[i] = y[i];
    for (s = 0; s < 4; s++) {
        nekton_status status;
        for (i = 0; i < n; i++)
            stage[i] = y[i] + h * node[s] * k[i];
        status = nekton_sim_rhs(sim, t + h * node[s], stage, k, n, diag);
        if (status < 0)
            return status;
        for (i = 0; i < n; i++)
            sum[i] += h * weight[s] * k[i];
    }
    for (i = 0; i < n; i++)
        y[i] = sum[i];
    return NEKTON_OK;
}

int main(void)
{
    const double h = 0.05;
    nekton_scene_def scene;
    nekton_wall_def tank;
    nekton_body_def body;
    nekton_link_def link;
    /* The simulation's own method is only used for comparison. */
    nekton_method method;
    nekton_model *model = NULL;
    nekton_sim *sim = NULL;
    nekton_plan plan;
    nekton_diag diag;
    double t, y[MAX], q[3];
    size_t n;
    int i;

    /* An ellipse in a round tank. */
    if (nekton_scene_def_init(&scene, sizeof scene, NEKTON_ABI_VERSION) != NEKTON_OK)
        return 1;
    nekton_wall_def_init(&tank);
    tank.shape.kind = NEKTON_SHAPE_ELLIPSE;
    tank.shape.a = 2.0;
    tank.shape.b = 2.0;
    tank.nodes = 64;
    nekton_link_def_init(&link);
    link.shape.kind = NEKTON_SHAPE_ELLIPSE;
    link.shape.a = 0.6;
    link.shape.b = 0.3;
    link.nodes = 32;
    link.density = 1.2;
    nekton_body_def_init(&body);
    body.pose[0] = 0.5;
    body.pose[2] = 0.3;
    body.velocity[0] = -0.4;
    body.velocity[1] = 0.3;
    body.velocity[2] = 0.5;
    body.links = &link;
    body.link_count = 1;
    scene.tank = &tank;
    scene.gravity = 0.5;
    scene.bodies = &body;
    scene.body_count = 1;

    if (nekton_model_create(&scene, &model, &diag) < 0)
        return failed(&diag);
    nekton_method_init(&method);
    method.kind = NEKTON_METHOD_RK4;
    method.step = 0.05;
    if (nekton_sim_create(model, &method, &sim, &diag) < 0)
        return failed(&diag);
    nekton_model_plan(model, &plan);
    n = plan.state_len;
    if (n > MAX || nekton_sim_get_state(sim, &t, y, n) < 0)
        return 1;
    for (i = 0; i < 40; i++) {
        if (rk4_step(sim, i * h, h, y, n, &diag) < 0)
            return failed(&diag);
        if (i % 10 == 9)
            printf("%.17g %.17g %.17g %.17g\n", (i + 1) * h, y[0], y[1], y[2]);
    }

    /* The library's own Runge-Kutta method, from the same start. */
    if (nekton_sim_advance(sim, 40 * h, &diag) < 0)
        return failed(&diag);
    nekton_sim_positions(sim, q, 3);
    printf("%.17g %.17g %.17g %.17g\n", 40 * h, q[0], q[1], q[2]);
    nekton_sim_free(sim);
    nekton_model_free(model);
    return 0;
}
