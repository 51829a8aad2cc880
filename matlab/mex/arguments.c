#include "arguments.h"

#include <math.h>
#include <string.h>

bool is_real(const mxArray *a)
{
    return a && mxIsDouble(a) && !mxIsComplex(a) && !mxIsSparse(a) && mxGetNumberOfDimensions(a) == 2;
}

const double *numbers(const mxArray *a, size_t n, const char *what)
{
    if (!is_real(a)) mexErrMsgIdAndTxt("nekton:arg:class", "%s must be real, full and of class double", what);
    if ((size_t)mxGetNumberOfElements(a) != n) {
        mexErrMsgIdAndTxt("nekton:arg:size", "%s must have %lu elements, not %lu", what, (unsigned long)n,
                          (unsigned long)mxGetNumberOfElements(a));
    }
    const double *x = mxGetPr(a);
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(x[i])) mexErrMsgIdAndTxt("nekton:arg:finite", "%s must be finite", what);
    }
    return x;
}

double number(const mxArray *a, const char *what) { return numbers(a, 1, what)[0]; }

const double *matrix(const mxArray *a, size_t n, const char *what)
{
    if (!is_real(a)) mexErrMsgIdAndTxt("nekton:arg:class", "%s must be real, full and of class double", what);
    if ((size_t)mxGetN(a) != n) {
        mexErrMsgIdAndTxt("nekton:arg:size", "%s must have %lu columns, not %lu", what, (unsigned long)n,
                          (unsigned long)mxGetN(a));
    }
    return numbers(a, (size_t)mxGetNumberOfElements(a), what);
}

double whole(const mxArray *a, double low, double high, const char *what)
{
    double x = number(a, what);
    if (x < low || x > high || x != floor(x)) {
        mexErrMsgIdAndTxt("nekton:arg:range", "%s must be a whole number from %g to %g, not %g", what, low, high, x);
    }
    return x;
}

void text(const mxArray *a, char *buffer, size_t size, const char *what)
{
    if (!a || !mxIsChar(a) || mxGetNumberOfElements(a) < 1 || mxGetM(a) != 1 || mxGetString(a, buffer, (mwSize)size)) {
        mexErrMsgIdAndTxt("nekton:arg:text", "%s must be a short text", what);
    }
}

int32_t word(const mxArray *a, const char *const *words, size_t n, const char *what)
{
    char w[32];
    text(a, w, sizeof w, what);
    for (size_t i = 0; i < n; i++) {
        if (!strcmp(w, words[i])) return (int32_t)i;
    }
    mexErrMsgIdAndTxt("nekton:arg:word", "%s: '%s' is not known", what, w);
    return 0;
}
