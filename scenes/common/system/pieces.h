/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of the scene of a user-defined system: the lines of its file, its texts and tapes, values at the
   start. */
#ifndef GM_SCENES_COMMON_SYSTEM_PIECES_H
#define GM_SCENES_COMMON_SYSTEM_PIECES_H

#include "core/files/files.h"
#include "scenes/common/system/look.h"

/* Returns values of all variables at the start, from the rows that are `given`, or from all rows if NULL.
   malloc'ed; NULL when out of memory. */
double *gm_system_start_values(const struct gm_system_lane *lane, const char *given);

/* Returns half the length of a field's line, which may follow from other keys; NaN when out of memory. */
double gm_system_half_length(const struct gm_system_lane *lane);

/* Returns the path of the mesh that a file names, in the arena of its scene: beside the file or, without such a file, in
   the folder where the program runs. Sets *inside to the built-in mesh of that name if the first is missing, or to NULL. */
const char *gm_system_find_mesh(struct gm_system_scene *system_scene, const char *name,
                                const struct gm_built_in **inside);

/* Takes the tables of at most that many observables, which are those of the scene; in a body of its arena. */
void gm_system_take_observables(struct gm_system_scene *system_scene, size_t most);

/* Adds an observable to them. Returns its measure, which the caller sets. Refuses a key that is there, and more than
   `most`. */
struct gm_system_measure *gm_system_add_observable(struct gm_system_scene *system_scene,
                                                   struct gm_observable row, size_t most);

/* Opens a tape whose inputs are all variables, so that lanes with different parameters share it. It lives as
   long as the scene. In a body of the scene's arena. */
void gm_system_open_tape(struct gm_system_scene *system_scene, struct gm_tape *tape, const gm_node_id *nodes,
                         size_t count);
/* The same with a tape that it takes. */
struct gm_tape *gm_system_take_tape(struct gm_system_scene *system_scene, const gm_node_id *nodes,
                                    size_t count);

/* Makes the rows: `timing`, which are dt and until, then the system's own, then `count` common ones. If
   `typed`, the values of the system's own have no defaults. */
void gm_system_make_rows(struct gm_system_scene *system_scene, const struct gm_parameter *timing,
                         const struct gm_parameter *common, size_t count, bool typed);
/* Opens the formulas of dt, until and steps, and sets their values, NaN without a line. */
void gm_system_open_timing(struct gm_system_scene *system_scene, double numbers[GM_SYSTEM_TIMES]);

/* Makes figures, work and stability of a scene that has rows, observables and schemes. `radian` is 1 / the
   largest frequency at the start, the unit of steps unless the file names another; NULL: a field, which has a
   map of stability if its file does, and whose work is set. */
void gm_system_make_studies(struct gm_system_scene *system_scene, const struct gm_problem *problem,
                            double (*radian)(const void *parameters));

#endif
