/*
 * An ellipse sinks and flutters. No heap: model and simulation live in arrays whose sizes the compiler computes.
 *
 * Compile:
 *   cc -std=c99 one_body_static.c -I ../target/nekton/include ../target/nekton/lib/libnekton.a -lm -o one_body_static
 */
#include "nekton.h"
#include <stdio.h>

/* 1 body, 0 joints, 32 nodes, no walls (0 of them, 0 nodes), no circulation, only ellipses, no signals. */
static union {
    uint64_t align;
    unsigned char bytes[NEKTON_MODEL_BYTES(1, 0, 32, 0, 0, 0, 0, 0, 1)];
} model_memory;
/* A lone rigid body needs no boundary system while it moves: 0 nodes. */
static union {
    uint64_t align;
    unsigned char bytes[NEKTON_SIM_BYTES(1, 0, 0, 0, 0, 0, 0, 0, 0)];
} sim_memory;
/* For stdout, which would otherwise ask for memory itself. */
static char output[1024];

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
    nekton_body_def body;
    nekton_link_def link;
    nekton_method method;
    nekton_model *model = NULL;
    nekton_sim *sim = NULL;
    nekton_diag diag;
    double t, q[3];
    int i;

    setvbuf(stdout, output, _IOFBF, sizeof output);
    if (nekton_scene_def_init(&scene, sizeof scene, NEKTON_ABI_VERSION) != NEKTON_OK)
        return 1;
    nekton_body_def_init(&body);
    nekton_link_def_init(&link);
    link.shape.kind = NEKTON_SHAPE_ELLIPSE;
    link.shape.a = 0.5;
    link.shape.b = 0.1;
    link.nodes = 32;
    link.density = 1500.0;
    body.pose[2] = 0.4; /* heading, rad */
    body.links = &link;
    body.link_count = 1;
    scene.fluid_density = 1000.0;
    scene.gravity = 9.81;
    scene.bodies = &body;
    scene.body_count = 1;

    if (nekton_model_init(&model_memory, sizeof model_memory, &scene, &model, &diag) < 0)
        return failed(&diag);
    nekton_method_init(&method);
    method.kind = NEKTON_METHOD_RK4;
    method.step = 0.01;
    if (nekton_sim_init(&sim_memory, sizeof sim_memory, model, &method, &sim, &diag) < 0)
        return failed(&diag);
    for (i = 1; i <= 10; i++) {
        if (nekton_sim_advance(sim, 0.2 * i, &diag) < 0)
            return failed(&diag);
        nekton_sim_time(sim, &t);
        nekton_sim_positions(sim, q, 3);
        printf("%.17g %.17g %.17g %.17g\n", t, q[0], q[1], q[2]);
    }
    return 0;
}
