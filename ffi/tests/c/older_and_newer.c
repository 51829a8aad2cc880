/* Programs that were compiled against an older or a newer header than the library's, played by structs that end earlier or later.
   Another copy of this file does the same in single precision. Prints one line for each thing that is as it should be. */
#include "nekton.h"
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef double real;

/* The method before max_step was there, word for word. */
typedef struct old_method {
    uint32_t struct_size;
    int32_t kind;
    real step, relative, absolute;
} old_method;

/* A link of the future, and the array of such links that a program of the future has. */
typedef struct new_link {
    nekton_link_def link;
    real porosity, colour;
} new_link;

static void check(int ok, const char *what) {
    printf("%s: %s\n", ok ? "ok" : "WRONG", what);
    if (!ok) exit(1);
}

/* A call that fills diag: what it returns, and a word of what it tells. */
#define EXPECT(call, status, word)                            \
    do {                                                      \
        char text[200];                                       \
        nekton_status got = (call);                           \
        nekton_diag_text(&diag, text, sizeof text);           \
        check(got == (status) && strstr(text, (word)), text); \
    } while (0)

int main(void) {
    nekton_diag diag;
    nekton_scene_def scene;
    nekton_body_def body;
    new_link links[2], *guarded = links;
    nekton_model *model;
    nekton_sim *sim, *old_sim;
    check(sizeof(old_method) < sizeof(nekton_method) && offsetof(nekton_method, max_step) == sizeof(old_method), "old method");

    /* The function of the library is told the size of what the program has; the macro would tell the header's. */
    check(nekton_scene_def_init(&scene, sizeof scene, NEKTON_ABI_VERSION) == NEKTON_OK, "scene");
    check(nekton_body_def_init(&body) == NEKTON_OK && body.struct_size == sizeof body, "body");
    for (int i = 0; i < 2; i++) {
        memset(&links[i], 0x5a, sizeof links[i]);
        check((nekton_link_def_init)(&links[i].link, sizeof links[i], NEKTON_ABI_VERSION) == NEKTON_OK, "new link");
        check(links[i].porosity == 0 && links[i].colour == 0, "what the library does not know is none");
        links[i].link.shape.kind = NEKTON_SHAPE_ELLIPSE;
        links[i].link.shape.a = (real)0.5;
        links[i].link.shape.b = (real)0.25;
        links[i].link.nodes = 16;
    }
    links[1].link.parent = 0;
    links[1].link.parent_anchor[0] = (real)0.75;
    links[1].link.self_anchor[0] = (real)-0.75;
    links[1].link.drive = NEKTON_DRIVE_TORQUE;
    links[1].link.start[0] = (real)0.25;
    body.links = &guarded->link;
    body.link_count = 2;
    scene.bodies = &body;
    scene.body_count = 1;
    EXPECT(nekton_model_create(&scene, &model, &diag), NEKTON_OK, "ok");
    links[1].colour = 1;
    nekton_model *none = NULL;
    EXPECT(nekton_model_create(&scene, &none, &diag), NEKTON_E_UNSUPPORTED, "body 0, link 1: ");
    check(!none, "nothing was made");
    links[1].colour = 0;
    links[1].link.struct_size = sizeof(nekton_link_def);
    EXPECT(nekton_model_create(&scene, &none, &diag), NEKTON_E_ABI_VERSION, "(struct_size[1] = ");
    links[1].link.struct_size = 0;
    EXPECT(nekton_model_create(&scene, &none, &diag), NEKTON_E_ABI_VERSION, "link_def_init");
    check(diag.place.index == 0 && diag.place.link == 1, "it says where, and what to call");

    /* An old program's method means what it meant. */
    old_method old;
    nekton_method method;
    check((nekton_method_init)((nekton_method *)(void *)&old, sizeof old, NEKTON_ABI_VERSION) == NEKTON_OK, "old method filled");
    check(nekton_method_init(&method) == NEKTON_OK && method.struct_size == sizeof method, "method");
    check(method.max_step == 0 && method.first_step == 0 && old.relative == method.relative, "the defaults");
    EXPECT(nekton_sim_create(model, &method, &sim, &diag), NEKTON_OK, "ok");
    EXPECT(nekton_sim_create(model, (const nekton_method *)(const void *)&old, &old_sim, &diag), NEKTON_OK, "ok");
    real q[2][6];
    check(nekton_sim_advance(sim, (real)0.5, &diag) == NEKTON_OK && nekton_sim_positions(sim, q[0], 6) == NEKTON_OK, "new");
    check(nekton_sim_advance(old_sim, (real)0.5, &diag) == NEKTON_OK && nekton_sim_positions(old_sim, q[1], 6) == NEKTON_OK, "old");
    check(!memcmp(q[0], q[1], sizeof q[0]), "both move alike, to the bit");
    check(nekton_sim_free(sim) == NEKTON_OK && nekton_sim_free(old_sim) == NEKTON_OK, "freed");

    /* Steps no longer than this, from a first one of that length. */
    method.max_step = (real)0.03125;
    method.first_step = (real)0.0009765625;
    method.relative = method.absolute = (real)1e-3;
    nekton_counters counters;
    real t;
    EXPECT(nekton_sim_create(model, &method, &sim, &diag), NEKTON_OK, "ok");
    check(nekton_sim_step(sim, &diag) == NEKTON_OK && nekton_sim_time(sim, &t) == NEKTON_OK && t == method.first_step, "first_step");
    EXPECT(nekton_sim_advance(sim, 1, &diag), NEKTON_OK, "ok");
    check(nekton_sim_counters(sim, &counters) == NEKTON_OK, "counters");
    check(counters.steps >= 33, "max_step");
    check(nekton_sim_free(sim) == NEKTON_OK, "freed");
    method.kind = NEKTON_METHOD_RK4;
    method.step = (real)0.01;
    EXPECT(nekton_sim_create(model, &method, &sim, &diag), NEKTON_E_OUT_OF_RANGE, "max_step with a fixed step");

    /* As before there was a size: a method by its fields alone, and one that is all zero. */
    nekton_method zero;
    memset(&zero, 0, sizeof zero);
    EXPECT(nekton_sim_create(model, &zero, &sim, &diag), NEKTON_E_ABI_VERSION, "method_init");
    zero.struct_size = NEKTON_METHOD_RK4;
    EXPECT(nekton_sim_create(model, &zero, &sim, &diag), NEKTON_E_ABI_VERSION, "struct_size = 1)");
    /* A program of the first version. */
    check(nekton_scene_def_init(&scene, sizeof scene, 1) == NEKTON_E_ABI_VERSION, "version 1");
    scene.abi_version = 1;
    EXPECT(nekton_model_create(&scene, &none, &diag), NEKTON_E_ABI_VERSION, "abi_version = 1)");
    check(nekton_model_free(model) == NEKTON_OK, "freed");
    return 0;
}
