/* Three ellipses in a row, whose two hinges beat as prescribed, swim in memory that is laid out before the program starts:
   no heap. Compiled once for double and, with -DSINGLE, once for single precision. Prints the trajectory of the middle link,
   memory, clock ticks and stack. How to build: README.md. */
#include "board.h"

#ifdef SINGLE
#include "../../include/nekton32.h"
typedef float real;
#define NAME "f32"
#define NEKTON(name) nekton32_##name
#define MODEL_BYTES NEKTON32_MODEL_BYTES
#define SIM_BYTES NEKTON32_SIM_BYTES
#define DECIMALS 9
#else
#include "../../include/nekton.h"
typedef double real;
#define NAME "f64"
#define NEKTON(name) nekton_##name
#define MODEL_BYTES NEKTON_MODEL_BYTES
#define SIM_BYTES NEKTON_SIM_BYTES
#define DECIMALS 15
#endif

enum { LINKS = 3, NODES = 16, STEPS = 10, JOINTS = LINKS - 1 };
enum { START = 3 }; /* steps that are not measured: ABM4 starts by RK4 */
static const real STEP = (real)0.1;

/* One body, two joints, links of 16 nodes; no walls, no circulation, ellipses only; two harmonic terms, no channels. */
static union {
    uint64_t align;
    unsigned char bytes[MODEL_BYTES(1, JOINTS, NODES, 0, 0, 0, 0, JOINTS, 0)];
} model_memory;
static union {
    uint64_t align;
    unsigned char bytes[SIM_BYTES(1, JOINTS, NODES, 0, 0, 0, 0, 0, 0)];
} sim_memory;
static NEKTON(model) *model;

static void print_count(const char *what, uint32_t n)
{
    char text[12], *p = text + sizeof text;
    *--p = '\0';
    do {
        *--p = (char)('0' + n % 10);
        n /= 10;
    } while (n > 0);
    board_print(what);
    board_print(p);
}

/* |x| < 10, as a decimal number (no printf: it would be larger than the rest of this program). */
static void print_real(real x)
{
    char text[DECIMALS + 4], *p = text + sizeof text;
    int64_t scaled;
    int i;
    real scale = 1;
    for (i = 0; i < DECIMALS; i++) {
        scale *= 10;
    }
    scaled = (int64_t)((x < 0 ? -x : x) * scale);
    *--p = '\0';
    for (i = 0; i < DECIMALS; i++, scaled /= 10) {
        *--p = (char)('0' + scaled % 10);
    }
    *--p = '.';
    *--p = (char)('0' + scaled % 10);
    board_print(x < 0 ? " -" : " ");
    board_print(p);
}

static int32_t failed(const char *what, int32_t status)
{
    board_print(what);
    board_print(": ");
    board_print(nekton_status_text(status));
    board_print("\n");
    return status;
}

/* Links of a = 1, b = 0.1; hinges 0.2 beyond the tips. Starts from rest impulse: see scenes/three_link_swimmer.toml. */
static int32_t set_up(void)
{
    static const NEKTON(harmonic) beats[JOINTS] = {{-1, 1, (real)1.5707963267948966, 0}, {1, 1, 0, 0}};
    NEKTON(scene_def) scene;
    NEKTON(body_def) body;
    NEKTON(link_def) links[LINKS];
    nekton_diag diag;
    int i;

    NEKTON(scene_def_init)(&scene, sizeof scene, NEKTON_ABI_VERSION);
    scene.quadrature = NEKTON_QUADRATURE_PLAIN; /* the smallest memory and time; gaps stay wide here */
    /* Sizes and times are shown here. For accuracy give links as thin as these 48 nodes (1e-3), and leave this out. */
    scene.allow_unresolved = 1;
    scene.tolerance = 1000; /* no notices of it, which take a search for the gap each */
    NEKTON(body_def_init)(&body);
    for (i = 0; i < LINKS; i++) {
        NEKTON(link_def_init)(&links[i]);
        links[i].shape.kind = NEKTON_SHAPE_ELLIPSE;
        links[i].shape.a = 1;
        links[i].shape.b = (real)0.1;
        links[i].nodes = NODES;
    }
    for (i = 1; i < LINKS; i++) {
        links[i].parent = 0;
        links[i].parent_anchor[0] = i == 1 ? (real)-1.2 : (real)1.2;
        links[i].self_anchor[0] = -links[i].parent_anchor[0];
        links[i].drive = NEKTON_DRIVE_MOTION;
        links[i].signal.kind = NEKTON_SIGNAL_HARMONIC;
        links[i].signal.harmonics = &beats[i - 1];
        links[i].signal.harmonic_count = 1;
    }
    body.velocity[0] = (real)-0.43406482698683885;
    body.velocity[1] = (real)-0.22678503735025515;
    body.velocity[2] = (real)-0.3446110319592447;
    body.links = links;
    body.link_count = LINKS;
    scene.bodies = &body;
    scene.body_count = 1;
    return NEKTON(model_init)(model_memory.bytes, sizeof model_memory, &scene, &model, &diag);
}

static int32_t swim(const char *name, int32_t kind)
{
    NEKTON(method) method;
    NEKTON(sim) *sim;
    nekton_diag diag;
    real q[3 * LINKS];
    uint32_t ticks = 0;
    int32_t status;
    int step;

    NEKTON(method_init)(&method);
    method.kind = kind;
    method.step = STEP;
    status = NEKTON(sim_init)(sim_memory.bytes, sizeof sim_memory, model, &method, &sim, &diag);
    for (step = 1; step <= STEPS && status >= 0; step++) {
        board_ticks();
        status = NEKTON(sim_step)(sim, &diag);
        if (step > START) {
            ticks += board_ticks();
        }
        if (status >= 0) {
            status = NEKTON(sim_positions)(sim, q, 3 * LINKS);
        }
        board_print(name);
        print_count(" ", (uint32_t)step);
        print_real(q[0]);
        print_real(q[1]);
        print_real(q[2]);
        board_print("\n");
    }
    if (status < 0) {
        return failed(name, status);
    }
    board_print(name);
    print_count(" ticks ", ticks / (STEPS - START));
    board_print("\n");
    return 0;
}

int main(void)
{
    nekton_plan plan;
    int32_t status;

    board_print("precision " NAME "\n");
    board_ticks();
    status = set_up();
    if (status < 0) {
        return failed("model", status) != 0;
    }
    print_count("setup ticks ", board_ticks());
    NEKTON(model_plan)(model, &plan);
    print_count("\nmodel bytes ", (uint32_t)plan.model_bytes);
    print_count(" of ", sizeof model_memory);
    print_count("\nsim bytes ", (uint32_t)plan.sim_bytes);
    print_count(" of ", sizeof sim_memory);
    board_print("\n");
    if (swim("rk4", NEKTON_METHOD_RK4) != 0 || swim("abm4", NEKTON_METHOD_ABM4) != 0) {
        return 1;
    }
    print_count("stack ", board_stack());
    board_print("\ndone\n");
    return 0;
}
