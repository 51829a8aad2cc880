/* Commands, in three tables. Each checks its arguments first and assigns its outputs last. */
#ifndef NEKTON_MEX_COMMANDS_H
#define NEKTON_MEX_COMMANDS_H

#include "mex.h"

typedef struct {
    int nlhs;
    mxArray **plhs;
    int nrhs; /* without the command */
    const mxArray **prhs;
} call;

typedef struct {
    const char *name; /* NULL: the end of a table */
    void (*run)(call *);
    int least, most, outputs;
} command;

/* Make and free objects; facts about models. */
extern const command model_commands[];
/* Change the state of simulations. */
extern const command step_commands[];
/* Ask for quantities at the state shown. */
extern const command quantity_commands[];

#endif
