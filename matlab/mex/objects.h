/* Objects (a model with its simulation) and their handles.
 *
 * An object is known by a uint64 scalar: its slot in the low half, the slot's generation in the high half, so that the handle of a
 * freed object is never taken for a later one. The file is locked while objects live.
 */
#ifndef NEKTON_MEX_OBJECTS_H
#define NEKTON_MEX_OBJECTS_H

#include "mex.h"
#include "nekton.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    uint32_t generation;
    nekton_model *model; /* NULL: the slot is free */
    nekton_sim *sim;
    nekton_sim *twin; /* evaluates rhs when joints are driven by channels, so that the simulation's channels stay; or NULL */
    nekton_method method;
    nekton_plan plan;
    bool unresolved; /* the last step gave a notice */
} object;

/* The object of a handle; an error if there is none. */
object *get(const mxArray *a);

/* A place for a new object; an error if there is none left. */
object *free_slot(void);

/* Puts a complete object there and gives its handle. */
uint64_t keep(object *slot, const object *made);

/* Frees what an object has, also one that is not complete. */
void free_object(object *o);

/* Ends the life of an object that was kept. */
void drop(object *o);

/* How many there are. */
size_t live_objects(void);

/* Frees all of them: runs when the file is unloaded and when the program ends. Must not print. */
void at_exit(void);

#endif
