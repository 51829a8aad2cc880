/* What commands return. */
#ifndef NEKTON_MEX_OUTPUTS_H
#define NEKTON_MEX_OUTPUTS_H

#include "mex.h"

#include <stddef.h>

/* n zeros. */
mxArray *column(size_t n);

/* A struct of numbers. */
mxArray *record(const char **names, const double *values, int n);

#endif
