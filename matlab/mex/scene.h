/* Scenes in the form that nekton_scene.m makes. */
#ifndef NEKTON_MEX_SCENE_H
#define NEKTON_MEX_SCENE_H

#include "mex.h"
#include "nekton.h"

/* Fills a definition; its parts lie in memory from mxCalloc and in the array. */
void read_scene(const mxArray *a, nekton_scene_def *scene);

#endif
