#include "outputs.h"

mxArray *column(size_t n) { return mxCreateDoubleMatrix((mwSize)n, 1, mxREAL); }

mxArray *record(const char **names, const double *values, int n)
{
    mxArray *s = mxCreateStructMatrix(1, 1, n, names);
    for (int k = 0; k < n; k++) mxSetField(s, 0, names[k], mxCreateDoubleScalar(values[k]));
    return s;
}
