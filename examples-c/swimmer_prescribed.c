/*
 * A swimmer of three links. Its two hinges follow -cos t and sin t; the fluid does the rest: after each stroke, 2 pi long, it
 * has moved (Kanso, Marsden, Rowley and Melli-Huber 2005).
 *
 * Compile:
 *   cc -std=c99 swimmer_prescribed.c -I ../target/nekton/include ../target/nekton/lib/libnekton.a -lm -o swimmer_prescribed
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
    const double pi = 3.14159265358979323846;
    nekton_scene_def scene;
    nekton_body_def body;
    nekton_link_def links[3];
    /* amplitude, frequency, phase, offset */
    nekton_harmonic front = {-1.0, 1.0, 1.5707963267948966, 0.0}, rear = {1.0, 1.0, 0.0, 0.0};
    nekton_method method;
    nekton_model *model = NULL;
    nekton_sim *sim = NULL;
    nekton_diag diag;
    double q[9], torque[2], power[2];
    int i;

    if (nekton_scene_def_init(&scene, sizeof scene, NEKTON_ABI_VERSION) != NEKTON_OK)
        return 1;
    for (i = 0; i < 3; i++) {
        nekton_link_def_init(&links[i]); /* density 1, like the fluid's */
        links[i].shape.kind = NEKTON_SHAPE_ELLIPSE;
        links[i].shape.a = 1.0;
        links[i].shape.b = 0.1;
        links[i].nodes = 64;
    }
    /* Link 0 is the middle; the others hang on it by hinges 0.2 beyond the tips. */
    for (i = 1; i < 3; i++) {
        double side = i == 1 ? -1.0 : 1.0;
        links[i].parent = 0;
        links[i].joint = NEKTON_JOINT_HINGE;
        links[i].parent_anchor[0] = 1.2 * side;
        links[i].self_anchor[0] = -1.2 * side;
        links[i].drive = NEKTON_DRIVE_MOTION;
        links[i].signal.kind = NEKTON_SIGNAL_HARMONIC;
        links[i].signal.harmonics = i == 1 ? &front : &rear;
        links[i].signal.harmonic_count = 1;
    }
    nekton_body_def_init(&body);
    /* The velocity with which the impulse of the whole is zero. */
    body.velocity[0] = -0.43406482698683885;
    body.velocity[1] = -0.22678503735025515;
    body.velocity[2] = -0.3446110319592447;
    body.links = links;
    body.link_count = 3;
    scene.bodies = &body;
    scene.body_count = 1;

    if (nekton_model_create(&scene, &model, &diag) < 0)
        return failed(&diag);
    nekton_method_init(&method);
    method.relative = method.absolute = 1e-8; /* of ADAMS, the default */
    if (nekton_sim_create(model, &method, &sim, &diag) < 0)
        return failed(&diag);
    for (i = 1; i <= 8; i++) {
        double t = i * pi / 4.0;
        if (nekton_sim_advance(sim, t, &diag) < 0 || nekton_sim_joint_torques(sim, torque, power, 2, &diag) < 0)
            return failed(&diag);
        nekton_sim_positions(sim, q, 9);
        printf("%.17g %.17g %.17g %.17g %.17g %.17g\n", t, q[0], q[1], q[2], torque[0], torque[1]);
    }
    nekton_sim_free(sim);
    nekton_model_free(model);
    return 0;
}
