/*
 * A fish holds its course. Its fin is driven by a beating torque, which shakes the head; 100 times a second a controller reads
 * the heading of the head and commands the torque at the neck (proportional and derivative), through a channel. Without
 * control the head would swing; the fish starts 0.3 rad off its course. Nothing is taken from the heap.
 *
 * Compile:
 *   cc -std=c99 swimmer_closed_loop.c -I ../target/nekton/include ../target/nekton/lib/libnekton.a -lm -o swimmer_closed_loop
 */
#include "nekton.h"
#include <stdio.h>

enum { LINKS = 3, NODES = 32 };

/* 1 body, 2 joints, no walls, no circulation, only ellipses, 1 harmonic term, 1 channel. */
static union {
    uint64_t align;
    unsigned char bytes[NEKTON_MODEL_BYTES(1, LINKS - 1, NODES, 0, 0, 0, 0, 1, 1)];
} model_memory;
static union {
    uint64_t align;
    unsigned char bytes[NEKTON_SIM_BYTES(1, LINKS - 1, NODES, 0, 0, 0, 1, 0, 1)];
} sim_memory;
static char output[1024];

static int failed(const nekton_diag *diag)
{
    char text[160];
    nekton_diag_text(diag, text, sizeof text);
    fprintf(stderr, "%s\n", text);
    return 1;
}

/* The torque of the neck acts on the trunk, its reaction on the head. */
static double controller(double heading, double rate)
{
    const double wanted = 0.0, proportional = 4.0, derivative = 4.0;
    return proportional * (heading - wanted) + derivative * rate;
}

int main(void)
{
    const double a[LINKS] = {0.6, 0.8, 0.5}, b[LINKS] = {0.3, 0.3, 0.1};
    nekton_scene_def scene;
    nekton_body_def body;
    nekton_link_def links[LINKS];
    nekton_harmonic beat = {0.3, 5.0, 0.0, 0.0};
    nekton_method method;
    nekton_model *model = NULL;
    nekton_sim *sim = NULL;
    nekton_diag diag;
    double q[3 * LINKS], qd[3 * LINKS], from[4] = {0.0, 0.0, 0.0, 0.0}, to[4] = {0.0, 0.0, 0.0, 0.0};
    int i;

    setvbuf(stdout, output, _IOFBF, sizeof output);
    if (nekton_scene_def_init(&scene, sizeof scene, NEKTON_ABI_VERSION) != NEKTON_OK)
        return 1;
    for (i = 0; i < LINKS; i++) {
        nekton_link_def_init(&links[i]); /* density 1, like the fluid's */
        links[i].shape.kind = NEKTON_SHAPE_ELLIPSE;
        links[i].shape.a = a[i];
        links[i].shape.b = b[i];
        links[i].nodes = NODES;
        if (i > 0) {
            links[i].parent = i - 1;
            links[i].joint = NEKTON_JOINT_HINGE;
            links[i].parent_anchor[0] = -a[i - 1] - 0.1;
            links[i].self_anchor[0] = a[i] + 0.1;
            links[i].drive = NEKTON_DRIVE_TORQUE;
        }
    }
    links[1].signal.kind = NEKTON_SIGNAL_CHANNEL; /* the neck: channel 0 */
    links[1].damping = 0.2;
    links[2].signal.kind = NEKTON_SIGNAL_HARMONIC; /* the fin */
    links[2].signal.harmonics = &beat;
    links[2].signal.harmonic_count = 1;
    links[2].stiffness = 0.6;
    links[2].damping = 0.1;
    nekton_body_def_init(&body);
    body.pose[2] = 0.3;
    body.links = links;
    body.link_count = LINKS;
    scene.bodies = &body;
    scene.body_count = 1;

    if (nekton_model_init(&model_memory, sizeof model_memory, &scene, &model, &diag) < 0)
        return failed(&diag);
    nekton_method_init(&method);
    method.kind = NEKTON_METHOD_RK4;
    method.step = 0.01;
    if (nekton_sim_init(&sim_memory, sizeof sim_memory, model, &method, &sim, &diag) < 0)
        return failed(&diag);
    for (i = 0; i < 400; i++) {
        nekton_sim_positions(sim, q, 3 * LINKS);
        nekton_sim_velocities(sim, qd, 3 * LINKS);
        if (i % 50 == 0)
            printf("%.17g %.17g %.17g %.17g %.17g\n", 0.01 * i, q[0], q[1], q[2], from[1]);
        /* Time, torque, and its two derivatives, which do not matter, at both ends of the sample. */
        from[0] = 0.01 * i;
        to[0] = 0.01 * (i + 1);
        from[1] = to[1] = controller(q[2], qd[2]);
        if (nekton_sim_set_channel(sim, 0, from, to, &diag) < 0 || nekton_sim_advance(sim, to[0], &diag) < 0)
            return failed(&diag);
    }
    nekton_sim_positions(sim, q, 3 * LINKS);
    printf("%.17g %.17g %.17g %.17g %.17g\n", 4.0, q[0], q[1], q[2], from[1]);
    return 0;
}
