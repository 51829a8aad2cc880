/*
 * Two neutrally buoyant ellipses pass each other in a fluid at rest. They never touch, yet each turns the other through the
 * fluid alone (Munnier and Pincon 2010, section 9.2; more nodes give more digits of the paper's motion).
 *
 * Compile:
 *   cc -std=c99 two_ellipses.c -I ../target/nekton/include ../target/nekton/lib/libnekton.a -lm -o two_ellipses
 */
#include "nekton.h"
#include <stdio.h>

static int failed(const nekton_diag *diag)
{
    char text[160];
    nekton_diag_text(diag, text, sizeof text);
    fprintf(stderr, "%s\n", text);
    return 1;
}

int main(void)
{
    nekton_scene_def scene;
    nekton_body_def bodies[2];
    nekton_link_def link;
    nekton_method method;
    nekton_model *model = NULL;
    nekton_sim *sim = NULL;
    nekton_diag diag;
    nekton_energy energy;
    nekton_gap gap;
    double q[6];
    int i;

    if (nekton_scene_def_init(&scene, sizeof scene, NEKTON_ABI_VERSION) != NEKTON_OK)
        return 1;
    nekton_link_def_init(&link); /* density 1, like the fluid's */
    link.shape.kind = NEKTON_SHAPE_ELLIPSE;
    link.shape.a = 2.0;
    link.shape.b = 0.9;
    link.nodes = 64;
    for (i = 0; i < 2; i++) {
        double side = i == 0 ? 1.0 : -1.0;
        nekton_body_def_init(&bodies[i]);
        bodies[i].pose[0] = 2.0 * side;
        bodies[i].pose[1] = -1.1 * side;
        bodies[i].velocity[0] = -0.5 * side;
        bodies[i].links = &link; /* both may share one description */
        bodies[i].link_count = 1;
    }
    scene.bodies = bodies;
    scene.body_count = 2;

    if (nekton_model_create(&scene, &model, &diag) < 0)
        return failed(&diag);
    nekton_method_init(&method);
    method.relative = method.absolute = 1e-9; /* of ADAMS, the default */
    if (nekton_sim_create(model, &method, &sim, &diag) < 0)
        return failed(&diag);
    for (i = 1; i <= 8; i++) {
        /* Reported twice a second, integrated in the integrator's own steps up to t = 4. */
        double t = 0.5 * i;
        if (nekton_sim_advance_dense(sim, t, 4.0, &diag) < 0 || nekton_sim_energy(sim, &energy, &diag) < 0 ||
            nekton_sim_gap(sim, &gap, &diag) < 0)
            return failed(&diag);
        nekton_sim_positions(sim, q, 6);
        printf("%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", t, q[0], q[1], q[2], q[3], q[4], q[5],
               gap.distance, energy.total);
    }
    nekton_sim_free(sim);
    nekton_model_free(model);
    return 0;
}
