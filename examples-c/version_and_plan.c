/*
 * Which library is this, what will a scene cost, and what does an error look like?
 *
 * Compile:
 *   cc -std=c99 version_and_plan.c -I ../target/nekton/include ../target/nekton/lib/libnekton.a -lm -o version_and_plan
 */
#include "nekton.h"
#include <stdio.h>

int main(void)
{
    nekton_scene_def scene;
    nekton_body_def body;
    nekton_link_def links[3];
    nekton_harmonic beat[2] = {{0.5, 2.0, 0.0, 0.0}, {0.5, 2.0, 1.5, 0.0}};
    nekton_diag diag;
    nekton_model *model = NULL;
    nekton_plan plan;
    nekton_method method;
    nekton_sim *sim = NULL;
    nekton_resolution resolution;
    char text[160];
    int i;

    /* Header and library must be of the same version; nekton_scene_def_init checks it as well. */
    if (nekton_abi_version() != NEKTON_ABI_VERSION)
        return 1;
    printf("interface %u\n", (unsigned)nekton_abi_version());
    printf("heap %u\n", (unsigned)(nekton_capabilities() & NEKTON_CAP_ALLOC));

    /* Three equal ellipses in a row. Sizes in m, angles in rad, densities in kg/m^3. */
    if (nekton_scene_def_init(&scene, sizeof scene, NEKTON_ABI_VERSION) != NEKTON_OK)
        return 1;
    nekton_body_def_init(&body);
    for (i = 0; i < 3; i++) {
        nekton_link_def_init(&links[i]);
        links[i].shape.kind = NEKTON_SHAPE_ELLIPSE;
        links[i].shape.a = 1.0;
        links[i].shape.b = 0.4;
        links[i].nodes = 48;
        links[i].parent = i - 1; /* -1: none */
        if (i > 0) {
            links[i].parent_anchor[0] = -1.2;
            links[i].self_anchor[0] = 1.2;
            links[i].drive = NEKTON_DRIVE_MOTION;
            links[i].signal.kind = NEKTON_SIGNAL_HARMONIC;
            links[i].signal.harmonics = &beat[i - 1];
            links[i].signal.harmonic_count = 1;
        }
    }
    body.links = links;
    body.link_count = 3;
    scene.bodies = &body;
    scene.body_count = 1;

    /* A mistake is refused, and told as precisely as possible. */
    links[2].nodes = 47;
    if (nekton_model_create(&scene, &model, &diag) >= 0)
        return 1;
    nekton_diag_text(&diag, text, sizeof text);
    printf("refused: %s\n", text);
    printf("status %d\nbody %d\nlink %d\nvalue %.17g\n", (int)diag.status, (int)diag.place.index, (int)diag.place.link,
           diag.value);
    links[2].nodes = 48;

    if (nekton_model_create(&scene, &model, &diag) < 0 || nekton_model_plan(model, &plan) < 0)
        return 1;
    printf("formulation %d\n", (int)plan.formulation);
    printf("links %lu\n", (unsigned long)plan.links);
    printf("joints %lu\n", (unsigned long)plan.joints);
    printf("coordinates %lu\n", (unsigned long)plan.coordinates);
    printf("state %lu\n", (unsigned long)plan.state_len);
    printf("unknowns %lu\n", (unsigned long)plan.unknowns);
    printf("right-hand-sides %lu\n", (unsigned long)plan.right_hand_sides);
    printf("operations %.17g\n", plan.operations);
    fprintf(stderr, "model: %lu bytes, each simulation: %lu bytes\n", (unsigned long)plan.model_bytes,
            (unsigned long)plan.sim_bytes);

    /* Are 48 nodes enough? Relative errors of space, estimated at the present state. */
    nekton_method_init(&method);
    method.relative = method.absolute = 1e-8; /* of ADAMS, the default */
    if (nekton_sim_create(model, &method, &sim, &diag) < 0 || nekton_sim_resolution(sim, &resolution, &diag) < 0)
        return 1;
    printf("resolution %.17g %.17g\n", resolution.mass, resolution.force);
    nekton_sim_free(sim);
    nekton_model_free(model);
    return 0;
}
