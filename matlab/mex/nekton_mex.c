/*
 * nekton_mex: gateway from Matlab and Octave to the C interface of nekton (include/nekton.h).
 *
 *   [out, ...] = nekton_mex(command, handle, ...)
 *
 * Meant to be called by Nekton.m, which has the help texts. Only what Matlab's C MEX interface also has is used, and only
 * real double data is exchanged, besides texts, structs and handles.
 *
 * Arguments are read in arguments.c and scene.c, objects and their handles are in objects.c, the commands in models.c, steps.c
 * and quantities.c.
 *
 * An error leaves mexFunction by a long jump or an exception: it is raised only when the library has returned, memory needed on the
 * way comes from mxCalloc (freed by the caller of mexFunction in that case), and outputs are assigned last.
 */
#include "arguments.h"
#include "commands.h"
#include "nekton.h"
#include "objects.h"

#include <string.h>

/* The command of a name; NULL if there is none. */
static const command *find(const char *name)
{
    static const command *const tables[] = {model_commands, step_commands, quantity_commands};
    for (size_t i = 0; i < COUNT(tables); i++) {
        for (const command *c = tables[i]; c->name; c++) {
            if (!strcmp(name, c->name)) return c;
        }
    }
    return NULL;
}

void mexFunction(int nlhs, mxArray *plhs[], int nrhs, const mxArray *prhs[])
{
    static bool ready = false;
    if (!ready) {
        if (nekton_abi_version() != NEKTON_ABI_VERSION) {
            mexErrMsgIdAndTxt("nekton:mex:version", "header and library do not fit: run build_nekton again");
        }
        mexAtExit(at_exit);
        ready = true;
    }
    char name[32];
    if (nrhs < 1) mexErrMsgIdAndTxt("nekton:arg:count", "nekton_mex(command, ...)");
    text(prhs[0], name, sizeof name, "command");
    call c = {nlhs, plhs, nrhs - 1, prhs + 1};
    const command *wanted = find(name);
    if (!wanted) mexErrMsgIdAndTxt("nekton:arg:command", "there is no command '%s'", name);
    if (c.nrhs < wanted->least || c.nrhs > wanted->most) {
        mexErrMsgIdAndTxt("nekton:arg:count", "%s: wrong number of arguments", name);
    }
    if (nlhs > wanted->outputs) mexErrMsgIdAndTxt("nekton:arg:count", "%s: too many outputs", name);
    wanted->run(&c);
}
