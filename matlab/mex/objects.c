#include "objects.h"

#include <string.h>

#define SLOTS 1024

static object objects[SLOTS];
static size_t live = 0;

void free_object(object *o)
{
    nekton_sim_free(o->twin);
    nekton_sim_free(o->sim);
    nekton_model_free(o->model);
    o->twin = o->sim = NULL;
    o->model = NULL;
}

void at_exit(void)
{
    for (size_t i = 0; i < SLOTS; i++) {
        if (objects[i].model) free_object(&objects[i]);
    }
    live = 0;
}

object *get(const mxArray *a)
{
    if (!a || !mxIsUint64(a) || mxIsComplex(a) || mxGetNumberOfElements(a) != 1) {
        mexErrMsgIdAndTxt("nekton:handle:class", "a handle must be a uint64 scalar");
    }
    uint64_t h;
    memcpy(&h, mxGetData(a), sizeof h);
    uint64_t slot = (h & 0xffffffffu), generation = h >> 32;
    if (slot < 1 || slot > SLOTS) mexErrMsgIdAndTxt("nekton:handle:invalid", "this is not a handle of nekton");
    object *o = &objects[slot - 1];
    if (!o->model || o->generation != generation) {
        mexErrMsgIdAndTxt("nekton:handle:stale", "this handle's simulation was deleted");
    }
    return o;
}

object *free_slot(void)
{
    object *o = objects;
    while (o < objects + SLOTS && o->model) o++;
    if (o == objects + SLOTS) mexErrMsgIdAndTxt("nekton:handle:full", "more than %d simulations at once", SLOTS);
    return o;
}

uint64_t keep(object *slot, const object *made)
{
    uint32_t generation = slot->generation + 1;
    *slot = *made;
    slot->generation = generation;
    if (live++ == 0) mexLock();
    return ((uint64_t)generation << 32) | (uint64_t)(slot - objects + 1);
}

void drop(object *o)
{
    free_object(o);
    if (--live == 0) mexUnlock();
}

size_t live_objects(void) { return live; }
