/* What the library says, as errors of Matlab. */
#ifndef NEKTON_MEX_ERRORS_H
#define NEKTON_MEX_ERRORS_H

#include "nekton.h"

/* Does not return if a call failed. The error is nekton:GROUP:NAME; without a diag it has the general text. */
void check(nekton_status status, const nekton_diag *diag, const char *group);

#endif
