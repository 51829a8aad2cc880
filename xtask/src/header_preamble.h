/**
 * nekton.h: rigid and articulated bodies moving in a 2D ideal fluid.
 *
 * Made by `cargo xtask header` from ffi/src; do not edit.
 *
 * A scene (nekton_scene_def) is compiled into a model that never changes; any number of simulations step it. Both live in
 * memory that the caller gives (query the size, or use NEKTON_MODEL_BYTES and NEKTON_SIM_BYTES), or in memory from the heap
 * (create, free). nekton32.h has the same in single precision.
 *
 * Units are SI per unit depth: lengths m, density kg/m^3 (so mass kg/m, inertia kg m), circulation m^2/s, torque N, force N/m,
 * energy J/m. Angles are radians, counter-clockwise. Matrices are column-major.
 *
 * Definitions (nekton_scene_def, nekton_body_def, nekton_link_def, nekton_wall_def, nekton_method) are filled by the function with
 * init in its name first, which also says how large they are (struct_size); those of one array have the same size. Later versions
 * of the library append fields, for which 0 means none, so that a program and a library of different age get along: what an
 * older program does not know is none; a newer one is refused (UNSUPPORTED) only if it sets what the library does not know. What lies
 * within definitions (shapes, signals), and what functions fill, keeps its size.
 *
 * Errors: every function returns a nekton_status: 0 ok, > 0 a notice (it was done), < 0 an error. A call that fails leaves
 * every simulation bit for bit as it was; outputs are then of no use. Only nekton_sim_advance and nekton_sim_advance_dense keep the
 * steps that they made before the error: an hour of work is not rolled back for one step. Where a function takes a nekton_diag
 * (NULL is fine) it says what, where, and which value. In the comments, BAD_HANDLE stands for NEKTON_E_BAD_HANDLE, and so on. A
 * non-finite number is never accepted and never returned as ok (only the distance of a gap may be infinite).
 *
 * Objects are recognized by a mark; handles to memory that was overwritten, freed twice or unmapped are the caller's duty.
 *
 * Threads: no global and no thread-local variable, no lock, no input or output. A model may be used by any number of threads at
 * once; a simulation by one at a time, even to read it. Whoever comes while another call uses it is refused at once (BUSY, from
 * every function of a simulation, interrupts included) and nothing changes; nobody waits. Any number of threads may copy from one
 * simulation at once (nekton_sim_copy, its from). Without atomic operations (Cortex-M0) BUSY is not noticed. Only create and
 * free use the heap.
 */
#ifndef NEKTON_H
#define NEKTON_H

#include <stddef.h>
#include <stdint.h>
