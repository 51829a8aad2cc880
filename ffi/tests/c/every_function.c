/* Calls every function of nekton.h; prints numbers that the test compares with those of the Rust interface. Another copy of
   this file, with names and types replaced, does the same in single precision. */
#include "nekton.h"
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef double real;

static void must(nekton_status status, const nekton_diag *diag, const char *call) {
    if (status != NEKTON_OK) {
        char text[160];
        nekton_diag_text(diag, text, sizeof text);
        printf("%s: %s (%s): %s\n", call, nekton_status_name(status), nekton_status_text(status), text);
        exit(1);
    }
}
#define MUST(call) must((call), &diag, #call)

static void print(const char *name, const real *x, size_t n) {
    printf("%s", name);
    for (size_t i = 0; i < n; i++) printf(" %.17g", (double)x[i]);
    printf("\n");
}

/* Memory for a model of one body with two joints and a simulation of it. */
static union {
    uint64_t align;
    unsigned char bytes[NEKTON_MODEL_BYTES(1, 2, 32, 1, 48, 0, 0, 1, 2)];
} model_memory;
static union {
    uint64_t align;
    unsigned char bytes[NEKTON_SIM_BYTES(1, 2, 32, 1, 48, 0, 1, 0, 2)];
} sim_memory[2];

int main(void) {
    nekton_diag diag;
    memset(&diag, 0, sizeof diag);
    if (nekton_abi_version() != NEKTON_ABI_VERSION || !(nekton_capabilities() & NEKTON_CAP_ALLOC)) return 2;

    static const nekton_harmonic wave = {(real)0.4, (real)2.0, (real)0.0, (real)0.0};
    nekton_link_def link[3];
    for (size_t i = 0; i < 3; i++) {
        MUST(nekton_link_def_init(&link[i]));
        link[i].shape.kind = NEKTON_SHAPE_ELLIPSE;
        link[i].shape.a = (real)0.5;
        link[i].shape.b = (real)0.125;
        link[i].density = (real)1.5;
        link[i].nodes = 32;
        link[i].parent = (int32_t)i - 1;
        link[i].parent_anchor[0] = (real)-0.625;
        link[i].self_anchor[0] = (real)0.625;
    }
    link[1].drive = NEKTON_DRIVE_MOTION;
    link[1].signal.kind = NEKTON_SIGNAL_HARMONIC;
    link[1].signal.harmonics = &wave;
    link[1].signal.harmonic_count = 1;
    link[2].drive = NEKTON_DRIVE_TORQUE;
    link[2].signal.kind = NEKTON_SIGNAL_CHANNEL;
    link[2].damping = (real)0.125;
    nekton_body_def body;
    MUST(nekton_body_def_init(&body));
    body.links = link;
    body.link_count = 3;
    nekton_wall_def tank;
    MUST(nekton_wall_def_init(&tank));
    tank.shape.kind = NEKTON_SHAPE_ELLIPSE;
    tank.shape.a = tank.shape.b = (real)6.0;
    tank.nodes = 48;
    nekton_scene_def def;
    MUST(nekton_scene_def_init(&def, sizeof def, NEKTON_ABI_VERSION));
    def.gravity = (real)0.5;
    def.repulsion_epsilon = (real)0.015625;
    def.tolerance = (real)0.015625;
    def.tank = &tank;
    def.bodies = &body;
    def.body_count = 1;

    nekton_req req;
    nekton_model *model, *heap_model;
    nekton_sim *sim, *copy, *heap_sim;
    const nekton_model *same;
    nekton_method method;
    MUST(nekton_method_init(&method));
    method.kind = NEKTON_METHOD_ABM4;
    method.step = (real)0.0078125;
    MUST(nekton_model_req(&def, &req, &diag));
    MUST(nekton_model_init(&model_memory, sizeof model_memory, &def, &model, &diag));
    MUST(nekton_model_create(&def, &heap_model, &diag));
    MUST(nekton_sim_req(model, &method, &req, &diag));
    MUST(nekton_sim_init(&sim_memory[0], sizeof sim_memory[0], model, &method, &sim, &diag));
    MUST(nekton_sim_init(&sim_memory[1], sizeof sim_memory[1], model, &method, &copy, &diag));
    MUST(nekton_sim_create(heap_model, &method, &heap_sim, &diag));
    MUST(nekton_sim_free(heap_sim));
    MUST(nekton_model_free(heap_model));

    nekton_plan plan;
    nekton_link_info link_info;
    nekton_joint_info joint_info;
    nekton_place place;
    nekton_status notice;
    real point[2];
    MUST(nekton_model_plan(model, &plan));
    MUST(nekton_model_link(model, 2, &link_info));
    MUST(nekton_model_joint(model, 1, &joint_info));
    if (nekton_model_notice(model, 0, &place, &notice) != NEKTON_E_OUT_OF_RANGE) return 3;
    if (joint_info.prescribed || link_info.place.link != 2) return 4;
    size_t nodes = 0;
    MUST(nekton_model_nodes(model, &link_info.place, &nodes));
    if (nodes != link_info.nodes) return 5;
    real outline_error = 0;
    MUST(nekton_model_outline_error(model, &link_info.place, &outline_error));
    print("outline_error", &outline_error, 1);
    MUST(nekton_model_outline_point(model, &link_info.place, (real)1.0, point));
    print("outline_point", point, 2);

    /* A controller at a fixed rate. */
    size_t n = plan.coordinates, ns = plan.state_len, nj = plan.joints;
    real *a = malloc(n * n * n * sizeof *a), *b = malloc(n * n * n * sizeof *b);
    if (!a || !b) return 5;
    for (int k = 0; k < 8; k++) {
        real t = (real)(k * 0.0625), from[4] = {0, 0, 0, 0}, to[4] = {0, 0, 0, 0};
        MUST(nekton_sim_joint_values(sim, a, b, nj));
        from[0] = t;
        to[0] = t + (real)0.0625;
        from[1] = to[1] = (real)0.25 - a[1];
        MUST(nekton_sim_set_channel(sim, 0, from, to, &diag));
        MUST(nekton_sim_advance(sim, to[0], &diag));
    }
    MUST(nekton_sim_copy(copy, sim, &diag));
    /* Saved and loaded again, the copy is what it was. */
    size_t bytes = 0, written = 0;
    MUST(nekton_sim_save_req(copy, &bytes));
    void *saved = malloc(bytes);
    if (!saved) return 7;
    MUST(nekton_sim_save(copy, saved, bytes, &written, &diag));
    if (written != bytes) return 8;
    MUST(nekton_sim_step(copy, &diag));
    MUST(nekton_sim_load(copy, saved, written, &diag));
    free(saved);
    MUST(nekton_sim_set_step_limit(sim, 100));
    MUST(nekton_sim_model(copy, &same));
    if (same != model) return 6;
    MUST(nekton_sim_step(sim, &diag));
    MUST(nekton_sim_step(copy, &diag));
    MUST(nekton_sim_advance_dense(sim, (real)0.53125, (real)0.5625, &diag));
    real t;
    MUST(nekton_sim_time(sim, &t));
    print("time", &t, 1);
    MUST(nekton_sim_positions(sim, a, n));
    print("positions", a, n);
    MUST(nekton_sim_velocities(sim, a, n));
    print("velocities", a, n);
    MUST(nekton_sim_get_state(sim, &t, a, ns));
    print("state", a, ns);
    MUST(nekton_sim_rhs(sim, t, a, b, ns, &diag));
    print("rhs", b, ns);
    MUST(nekton_sim_set_state(copy, t, a, ns, &diag));
    MUST(nekton_sim_restart(copy));
    MUST(nekton_sim_joint_torques(sim, a, b, nj, &diag));
    print("torque", a, nj);
    print("power", b, nj);
    MUST(nekton_sim_accelerations(sim, a, n, &diag));
    print("accelerations", a, n);
    MUST(nekton_sim_christoffel(sim, a, n, &diag));
    print("christoffel", a, n);
    MUST(nekton_sim_buoyancy(sim, a, n, &diag));
    print("buoyancy", a, n);
    MUST(nekton_sim_repulsion(sim, a, n, &diag));
    print("repulsion", a, n);
    MUST(nekton_sim_circulation_gradient(sim, a, n, &diag));
    print("circulation_gradient", a, n);
    MUST(nekton_sim_mass_matrix(sim, a, n * n, &diag));
    print("mass_matrix", a, n * n);
    MUST(nekton_sim_added_mass(sim, a, n * n, &diag));
    print("added_mass", a, n * n);
    MUST(nekton_sim_gyroscopic(sim, a, n * n, &diag));
    print("gyroscopic", a, n * n);
    MUST(nekton_sim_christoffel_tensor(sim, a, n * n * n, &diag));
    print("christoffel_tensor", a, n * n * n);
    static const nekton_parameter parameters[3] = {
        {NEKTON_PARAMETER_FLUID_DENSITY, 0, 0, 0}, {NEKTON_PARAMETER_WRENCH, 1, 2, 0}, {NEKTON_PARAMETER_TORQUE, 1, 0, 0}};
    real bound;
    MUST(nekton_sim_derivatives_req(model, &req, &diag));
    void *mem = malloc(req.size);
    if (!mem) return 9;
    MUST(nekton_sim_linearize(sim, parameters, 3, a, ns * ns, b, ns * 3, &bound, mem, req.size, &diag));
    print("linearize_a", a, ns * ns);
    print("linearize_b", b, ns * 3);
    print("linearize_bound", &bound, 1);
    real qdd[9];
    MUST(nekton_sim_accelerations(sim, qdd, n, &diag));
    MUST(nekton_sim_force_derivatives(sim, qdd, n, a, b, mem, req.size, &diag));
    print("by_position", a, n * n);
    print("by_velocity", b, n * n);
    free(mem);
    nekton_energy energy;
    nekton_resolution resolution;
    nekton_time_error error;
    nekton_gap gap;
    nekton_counters counters;
    MUST(nekton_sim_energy(sim, &energy, &diag));
    print("total", &energy.total, 1);
    print("work", &energy.work, 1);
    MUST(nekton_sim_impulse(sim, a, &diag));
    print("impulse", a, 3);
    MUST(nekton_sim_energy_drift(sim, a, &diag));
    print("energy_drift", a, 3);
    MUST(nekton_sim_resolution(sim, &resolution, &diag));
    print("resolution", &resolution.mass, 1);
    MUST(nekton_sim_indicators(sim, &resolution, &diag));
    print("indicators", &resolution.bound, 1);
    MUST(nekton_sim_time_error(sim, &error));
    print("time_error", &error.length_sum, 4);
    printf("unknown %lu\n", (unsigned long)error.unknown);
    MUST(nekton_sim_gap(sim, &gap, &diag));
    print("gap", &gap.distance, 1);
    MUST(nekton_sim_counters(sim, &counters));
    printf("steps %lu\n", (unsigned long)counters.steps);
    free(a);
    free(b);
    return 0;
}
