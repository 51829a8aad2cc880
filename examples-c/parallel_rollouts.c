/*
 * One model, many simulations on many threads, as for planning or learning: each rollout tries another torque at the joint.
 * The results are bit for bit those of running the rollouts one after the other.
 *
 * Compile:
 *   cc -std=c99 parallel_rollouts.c -I ../target/nekton/include ../target/nekton/lib/libnekton.a -lm -lpthread -o parallel_rollouts
 */
#include "nekton.h"
#include <pthread.h>
#include <stdio.h>
#include <string.h>

enum { ROLLOUTS = 8, LEN = 6 };

typedef struct rollout {
    const nekton_model *model; /* shared: it never changes */
    double torque;
    double q[LEN];
    nekton_status status;
    nekton_diag diag;
} rollout;

/* Each rollout has its own simulation, used by one thread only. */
static void *run(void *argument)
{
    rollout *r = (rollout *)argument;
    nekton_method method;
    nekton_sim *sim = NULL;
    double from[4] = {0.0, 0.0, 0.0, 0.0}, to[4] = {0.5, 0.0, 0.0, 0.0};
    from[1] = to[1] = r->torque;
    nekton_method_init(&method);
    method.relative = method.absolute = 1e-7; /* of ADAMS, the default */
    r->status = nekton_sim_create(r->model, &method, &sim, &r->diag);
    if (r->status >= 0)
        r->status = nekton_sim_set_channel(sim, 0, from, to, &r->diag);
    if (r->status >= 0)
        r->status = nekton_sim_advance(sim, 1.0, &r->diag);
    if (r->status >= 0)
        r->status = nekton_sim_positions(sim, r->q, LEN);
    nekton_sim_free(sim);
    return NULL;
}

int main(void)
{
    nekton_scene_def scene;
    nekton_body_def body;
    nekton_link_def links[2];
    nekton_model *model = NULL;
    nekton_diag diag;
    static rollout alone[ROLLOUTS], together[ROLLOUTS];
    pthread_t threads[ROLLOUTS];
    char text[160];
    int i;

    if (nekton_scene_def_init(&scene, sizeof scene, NEKTON_ABI_VERSION) != NEKTON_OK)
        return 1;
    for (i = 0; i < 2; i++) {
        nekton_link_def_init(&links[i]);
        links[i].shape.kind = NEKTON_SHAPE_ELLIPSE;
        links[i].shape.a = 0.5;
        links[i].shape.b = 0.2;
        links[i].nodes = 32;
    }
    links[1].parent = 0;
    links[1].parent_anchor[0] = -0.6;
    links[1].self_anchor[0] = 0.6;
    links[1].drive = NEKTON_DRIVE_TORQUE;
    links[1].stiffness = 0.5;
    links[1].damping = 0.1;
    links[1].signal.kind = NEKTON_SIGNAL_CHANNEL;
    nekton_body_def_init(&body);
    body.links = links;
    body.link_count = 2;
    scene.bodies = &body;
    scene.body_count = 1;
    if (nekton_model_create(&scene, &model, &diag) < 0) {
        nekton_diag_text(&diag, text, sizeof text);
        fprintf(stderr, "%s\n", text);
        return 1;
    }

    for (i = 0; i < ROLLOUTS; i++) {
        alone[i].model = together[i].model = model;
        alone[i].torque = together[i].torque = 0.05 * (i - 4);
        run(&alone[i]);
    }
    for (i = 0; i < ROLLOUTS; i++)
        if (pthread_create(&threads[i], NULL, run, &together[i]) != 0)
            return 1;
    for (i = 0; i < ROLLOUTS; i++)
        pthread_join(threads[i], NULL);

    for (i = 0; i < ROLLOUTS; i++) {
        const rollout *r = &together[i];
        if (r->status < 0 || memcmp(r->q, alone[i].q, sizeof r->q) != 0) {
            nekton_diag_text(&r->diag, text, sizeof text);
            fprintf(stderr, "rollout %d: %s\n", i, r->status < 0 ? text : "differs from the same alone");
            return 1;
        }
        printf("%.17g %.17g %.17g %.17g %.17g\n", r->torque, r->q[0], r->q[1], r->q[2], r->q[5]);
    }
    nekton_model_free(model);
    return 0;
}
