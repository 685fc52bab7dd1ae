/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The names of a state's arrays in files for other programs. Each kind of problem defines its own (struct
   gm_kind). */
#ifndef GM_CORE_QUANTITY_H
#define GM_CORE_QUANTITY_H

#include <stdbool.h>
#include <stddef.h>

struct gm_arena;
struct gm_run;

/* The object that values belong to. */
enum gm_support {
    GM_ON_RUN,     /* the whole run */
    GM_ON_BODIES,  /* each of several bodies */
    GM_ON_TRACERS, /* passive particles */
    GM_ON_NODES,   /* points of a grid, nodes or vertices of a mesh */
    GM_ON_CELLS,   /* triangles */
    GM_ON_EDGES,   /* edges of triangles */
};

/* An array of the shape (count, members, width): without the first axis on GM_ON_RUN, the second if m is
   1, the third if width is 1. If `derive` is NULL, the values are the state's `count` components from
   `first` on; else `first` is its argument. */
struct gm_quantity {
    char name[32];
    enum gm_support support;
    size_t count, width;
    size_t first;
    int axis;         /* 1, 2, 3: coordinates x, y, z of the objects; with width 2, x and y */
    double period[2]; /* periods of the coordinates x and y; 0: not periodic */
    bool fixed;       /* the same at all times */
    bool whole;       /* whole numbers */
    enum {
        GM_FOR_ALL,
        GM_FOR_TABLES,
        GM_FOR_PICTURES
    } use; /* in all files, or not in those for VTK, or in those alone */
    void (*derive)(const struct gm_run *run, size_t first, double *values);
};

/* The nodes of the problem's line, as far as they are visible: a quantity that is constant in time and
   comes first. */
struct gm_quantity gm_quantity_grid(const struct gm_run *run);

enum { GM_QUANTITIES = 128 /* most of a kind */, GM_QUANTITY_AXES = 3 };

/* The quantities of a run's states, into an array of GM_QUANTITIES. Returns their number. They stay valid
   with the run. */
size_t gm_quantities(const struct gm_run *run, struct gm_quantity *quantities);

/* The quantities of each kind, for its row (struct gm_kind). */
#define GM_KIND(name) size_t gm_##name##_quantities(const struct gm_run *run, struct gm_quantity *quantities);
#include "core/kinds.def"
#undef GM_KIND

/* The quantities of a file of tables or of pictures, without a system's time, for rows that have their own. Returns
   their number. */
size_t gm_quantities_beside_time(const struct gm_run *run, bool pictures, struct gm_quantity *quantities);

/* The name of a component of a run's state, "q1", or "x[3]" of a list. In a body of the arena. */
const char *gm_component_name(struct gm_arena *arena, const struct gm_run *run, size_t component);

/* The number of values of a quantity, over all members. */
size_t gm_quantity_size(const struct gm_run *run, const struct gm_quantity *quantity);

/* Writes the lengths of a quantity's axes. Returns the number of axes, 0 for a single number. */
size_t gm_quantity_shape(const struct gm_quantity *quantity, size_t members, size_t shape[GM_QUANTITY_AXES]);

/* The current values: in the state or, if they are derived, in `scratch` (gm_quantity_size). */
const double *gm_quantity_values(const struct gm_run *run, const struct gm_quantity *quantity,
                                 double *scratch);

#endif
