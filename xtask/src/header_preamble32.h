/**
 * nekton32.h: nekton.h in single precision. Every type and function that has a precision is here once more, with the name
 * nekton32_...; what has none, and what holds for all of it, is in nekton.h.
 *
 * Made by `cargo xtask header` from ffi/src; do not edit.
 */
#ifndef NEKTON32_H
#define NEKTON32_H

#include "nekton.h"
