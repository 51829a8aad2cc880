/* A control loop that is saved by one process and goes on in another. Another copy of this file does the same in single precision.
   saved FILE save: half of the run, then the file. saved FILE load: the other half, from the file. saved FILE whole: all of it. */
#include "nekton.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef double real;

static nekton_diag diag;

static void must(nekton_status status, int line) {
    char text[200];
    if (status >= 0) return;
    nekton_diag_text(&diag, text, sizeof text);
    printf("line %d: %s\n", line, text);
    exit(1);
}
#define MUST(call) must((call), __LINE__)

/* Commands that jump, and ends that are no multiple of any step. */
static void control(nekton_sim *sim, int first, int last) {
    for (int k = first; k < last; k++) {
        real t = (real)(k * 0.0625), from[4] = {0, 0, 0, 0}, to[4] = {0, 0, 0, 0};
        from[0] = t;
        to[0] = t + (real)0.0625;
        from[1] = to[1] = (real)(0.25 * (k % 3) - 0.125);
        MUST(nekton_sim_set_channel(sim, 0, from, to, &diag));
        MUST(nekton_sim_advance_dense(sim, to[0], to[0], &diag));
    }
}

int main(int argc, char **argv) {
    nekton_link_def link[2];
    nekton_body_def body[2];
    nekton_scene_def def;
    nekton_method method;
    nekton_model *model;
    nekton_sim *sim;
    size_t bytes = 0, written = 0;
    if (argc != 3) return 2;
    for (int i = 0; i < 2; i++) {
        MUST(nekton_link_def_init(&link[i]));
        MUST(nekton_body_def_init(&body[i]));
        link[i].shape.kind = NEKTON_SHAPE_ELLIPSE;
        link[i].shape.a = (real)0.5;
        link[i].shape.b = (real)0.125;
        link[i].nodes = 16;
    }
    link[1].parent = 0;
    link[1].parent_anchor[0] = (real)-0.625;
    link[1].self_anchor[0] = (real)0.625;
    link[1].drive = NEKTON_DRIVE_TORQUE;
    link[1].signal.kind = NEKTON_SIGNAL_CHANNEL;
    link[1].damping = (real)0.125;
    body[0].links = link;
    body[0].link_count = 2;
    body[1].links = link;
    body[1].link_count = 1;
    body[1].pose[1] = (real)1.5;
    MUST(nekton_scene_def_init(&def, sizeof def, NEKTON_ABI_VERSION));
    def.gravity = (real)0.5;
    def.bodies = body;
    def.body_count = 2;
    MUST(nekton_model_create(&def, &model, &diag));
    MUST(nekton_method_init(&method));
    method.relative = method.absolute = (real)1e-4;
    /* Another method than the saved one: it is part of what is saved. */
    if (!strcmp(argv[2], "load")) {
        method.kind = NEKTON_METHOD_RK4;
        method.step = (real)0.0625;
    }
    MUST(nekton_sim_create(model, &method, &sim, &diag));
    MUST(nekton_sim_save_req(sim, &bytes));
    unsigned char *saved = malloc(bytes);
    if (!saved) return 3;

    if (!strcmp(argv[2], "load")) {
        FILE *file = fopen(argv[1], "rb");
        if (!file || fread(saved, 1, bytes, file) != bytes || fgetc(file) != EOF) return 4;
        fclose(file);
        saved[bytes / 2] ^= 1;
        if (nekton_sim_load(sim, saved, bytes, &diag) != NEKTON_E_BAD_SAVE || strcmp(diag.what, "checksum")) return 5;
        saved[bytes / 2] ^= 1;
        MUST(nekton_sim_load(sim, saved, bytes, &diag));
    } else {
        control(sim, 0, 9);
    }
    if (!strcmp(argv[2], "save")) {
        FILE *file = fopen(argv[1], "wb");
        MUST(nekton_sim_save(sim, saved, bytes, &written, &diag));
        if (!file || fwrite(saved, 1, written, file) != written || fclose(file) || written != bytes) return 6;
    } else {
        nekton_plan plan;
        nekton_counters counters;
        real q[9];
        control(sim, 9, 16);
        MUST(nekton_model_plan(model, &plan));
        MUST(nekton_sim_positions(sim, q, plan.coordinates));
        MUST(nekton_sim_counters(sim, &counters));
        for (size_t i = 0; i < plan.coordinates; i++) printf("%a\n", (double)q[i]);
        printf("%lu steps\n", (unsigned long)counters.steps);
    }
    free(saved);
    MUST(nekton_sim_free(sim));
    MUST(nekton_model_free(model));
    return 0;
}
