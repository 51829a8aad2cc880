/* Arguments of commands: read and checked. A wrong one is an error, which does not return. */
#ifndef NEKTON_MEX_ARGUMENTS_H
#define NEKTON_MEX_ARGUMENTS_H

#include "mex.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

bool is_real(const mxArray *a);

/* A real full double array of n numbers, none of them NaN or infinite. */
const double *numbers(const mxArray *a, size_t n, const char *what);

double number(const mxArray *a, const char *what);

/* A real full double matrix of any number of rows and n columns. */
const double *matrix(const mxArray *a, size_t n, const char *what);

/* A whole number in [low, high]. */
double whole(const mxArray *a, double low, double high, const char *what);

void text(const mxArray *a, char *buffer, size_t size, const char *what);

/* The position of a word in a list. */
int32_t word(const mxArray *a, const char *const *words, size_t n, const char *what);

#endif
