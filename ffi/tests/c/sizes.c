/* Are NEKTON_MODEL_BYTES and NEKTON_SIM_BYTES enough, and not much more than that? Prints the worst ratio of each. */
#include "nekton.h"
#include <stdio.h>
#include <stdlib.h>

typedef double real;

/* Also usable for static memory. */
static unsigned char static_memory[NEKTON_MODEL_BYTES(1, 2, 32, 1, 16, 1, 4, 2, 1) + NEKTON_SIM_BYTES(1, 2, 32, 1, 16, 1, 1, 4, 1)];

static double worst_model = 1.0, worst_sim = 1.0;
static long tried = 0;

static const real corners[4][2] = {{0, 0}, {1, 0}, {1, (real)0.4}, {0, (real)0.4}};
static const real knots[6][2] = {{(real)0.5, 0}, {(real)0.25, (real)0.3}, {(real)-0.25, (real)0.3},
                              {(real)-0.5, 0}, {(real)-0.25, (real)-0.3}, {(real)0.25, (real)-0.3}};
static const nekton_harmonic wave[2] = {{(real)0.1, 1, 0, 0}, {(real)0.1, 2, 0, 0}};

static void check(int ok, const char *what) {
    if (!ok) {
        printf("failed: %s\n", what);
        exit(1);
    }
}

/* points: 0 ellipses, 1 stars, 4 rectangles or polygons, 6 curves. */
static void set_shape(nekton_shape *shape, size_t points, size_t number, real radius) {
    /* No two links alike, so that nothing is shared. */
    real scale = 1 + (real)0.01 * (real)number;
    if (points == 0) {
        shape->kind = NEKTON_SHAPE_ELLIPSE;
        shape->a = (real)0.5 * scale;
        shape->b = (real)0.2;
    } else if (points == 1) {
        shape->kind = NEKTON_SHAPE_STAR;
        shape->radius = (real)0.4 * scale;
        shape->amplitude = (real)0.2;
        shape->lobes = 3;
    } else if (points == 4 && number % 2 == 0) {
        shape->kind = NEKTON_SHAPE_RECTANGLE;
        shape->width = scale;
        shape->height = (real)0.4;
        shape->corner_radius = radius;
    } else if (points == 4) {
        shape->kind = NEKTON_SHAPE_POLYGON;
        shape->points = corners;
        shape->point_count = 4;
        shape->corner_radius = radius;
    } else {
        shape->kind = NEKTON_SHAPE_CURVE;
        shape->points = knots;
        shape->point_count = 6;
    }
}

static void try_one(size_t bodies, size_t joints, size_t nodes, size_t walls, size_t wall_nodes, size_t circulation,
                    size_t points, int torque, real radius, int tight) {
    nekton_body_def body[8];
    nekton_link_def link[32];
    nekton_wall_def wall[8];
    nekton_scene_def def;
    size_t used = 0, channels = 0, rows = 0;
    check(nekton_scene_def_init(&def, sizeof def, NEKTON_ABI_VERSION) == NEKTON_OK, "scene");
    for (size_t b = 0; b < bodies; b++) {
        /* Joints are dealt out in turn. */
        size_t here = 1 + joints / bodies + (b < joints % bodies);
        check(nekton_body_def_init(&body[b]) == NEKTON_OK, "body");
        body[b].pose[0] = 100 * (real)b;
        body[b].links = &link[used];
        body[b].link_count = here;
        for (size_t l = 0; l < here; l++) {
            nekton_link_def *x = &link[used];
            check(nekton_link_def_init(x) == NEKTON_OK, "link");
            set_shape(&x->shape, points, used, radius);
            x->nodes = nodes;
            if (circulation) x->circulation = (real)0.1;
            if (l > 0) {
                x->parent = (int32_t)l - 1;
                x->parent_anchor[0] = (real)0.7;
                x->self_anchor[0] = (real)-0.7;
                if (torque) {
                    x->drive = NEKTON_DRIVE_TORQUE;
                    x->signal.kind = NEKTON_SIGNAL_CHANNEL;
                    channels++;
                } else {
                    x->drive = NEKTON_DRIVE_MOTION;
                    x->signal.kind = NEKTON_SIGNAL_HARMONIC;
                    x->signal.harmonics = wave;
                    x->signal.harmonic_count = 2;
                    rows += 2;
                }
            }
            used++;
        }
    }
    for (size_t w = 0; w < walls; w++) {
        check(nekton_wall_def_init(&wall[w]) == NEKTON_OK, "wall");
        set_shape(&wall[w].shape, points, w, radius);
        wall[w].position[1] = 50 + 10 * (real)w;
        wall[w].nodes = wall_nodes;
    }
    int graded = (int)(tried % 3);
    def.quadrature = graded ? NEKTON_QUADRATURE_GRADED : NEKTON_QUADRATURE_PLAIN;
    if (graded == 2) def.repulsion_epsilon = (real)0.01;
    def.bodies = body;
    def.body_count = bodies;
    def.obstacles = wall;
    def.obstacle_count = walls;

    nekton_req req;
    nekton_diag diag;
    nekton_model *model;
    check(nekton_model_req(&def, &req, &diag) == NEKTON_OK, "model_req");
    size_t bound = NEKTON_MODEL_BYTES(bodies, joints, nodes, walls, wall_nodes, circulation, points, rows, graded);
    double ratio = (double)bound / (double)req.size;
    if (ratio < 1.0) printf("model: %zu bytes needed, %zu said: bodies %zu joints %zu nodes %zu walls %zu circulation %zu points %zu graded %d\n", req.size, bound, bodies, joints, nodes, walls, circulation, points, graded);
    check(ratio >= 1.0, "NEKTON_MODEL_BYTES is not enough");
    check(req.align <= NEKTON_ALIGN, "NEKTON_ALIGN is not enough");
    if (tight && graded == 0 && ratio > worst_model) worst_model = ratio;
    void *memory = malloc(req.size);
    check(memory != NULL, "malloc");
    nekton_status status = nekton_model_init(memory, req.size, &def, &model, &diag);
    if (status < 0) {
        char text[160];
        nekton_diag_text(&diag, text, sizeof text);
        printf("%s\n", text);
    }
    check(status >= 0, "model_init");
    nekton_method method;
    check(nekton_method_init(&method) == NEKTON_OK, "method");
    method.kind = NEKTON_METHOD_RK4;
    method.step = (real)0.01;
    check(nekton_sim_req(model, &method, &req, &diag) == NEKTON_OK, "sim_req");
    /* A lone rigid body needs no boundary system. */
    size_t n = bodies == 1 && joints == 0 && walls == 0 ? 0 : nodes;
    bound = NEKTON_SIM_BYTES(bodies, joints, n, walls, wall_nodes, circulation, channels, points, graded);
    ratio = (double)bound / (double)req.size;
    if (ratio < 1.0) printf("sim: %zu bytes needed, %zu said: bodies %zu joints %zu nodes %zu walls %zu circulation %zu points %zu graded %d\n", req.size, bound, bodies, joints, nodes, walls, circulation, points, graded);
    check(ratio >= 1.0, "NEKTON_SIM_BYTES is not enough");
    if (tight && graded == 0 && ratio > worst_sim) worst_sim = ratio;
    tried++;
    free(memory);
}

int main(void) {
    static const size_t body_counts[] = {1, 2, 5}, joint_counts[] = {0, 1, 2, 7}, node_counts[] = {8, 16, 32, 64};
    static const size_t wall_counts[] = {0, 1, 3}, point_counts[] = {0, 1, 4, 6};
    (void)static_memory;
    for (size_t b = 0; b < 3; b++)
        for (size_t j = 0; j < 4; j++)
            for (size_t n = 0; n < 4; n++)
                for (size_t w = 0; w < 3; w++)
                    for (size_t c = 0; c < 2; c++)
                        for (int torque = 0; torque < 2; torque++)
                            for (size_t p = 0; p < 4; p++) {
                                /* Set-up of other outlines is slow with many links: a part of the grid is enough. */
                                if (p > 0 && (joint_counts[j] > 2 || body_counts[b] > 2 || node_counts[n] > 32)) continue;
                                /* Few nodes: the records and the integrator count more than what is counted closely. */
                                int tight = point_counts[p] == 0 && node_counts[n] >= 16;
                                try_one(body_counts[b], joint_counts[j], node_counts[n], wall_counts[w], 2 * node_counts[n], c,
                                        point_counts[p], torque, (real)0.05, tight);
                            }
    /* The finest corners. */
    try_one(2, 1, 16, 2, 32, 0, 4, 1, 0, 0);
    try_one(2, 1, 16, 2, 32, 0, 4, 1, sizeof(real) == 8 ? (real)1e-12 : (real)1e-4, 0);
    printf("tried %ld model %.3f sim %.3f\n", tried, worst_model, worst_sim);
    return 0;
}
