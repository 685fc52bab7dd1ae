/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a state is called: named arrays, as files hold them that others read. Each kind of problem says which
   there are (struct gm_kind). */
#ifndef GM_CORE_QUANTITY_H
#define GM_CORE_QUANTITY_H

#include <stdbool.h>
#include <stddef.h>

struct gm_run;

/* What the values belong to. */
enum gm_support {
    GM_ON_RUN,     /* to the whole */
    GM_ON_BODIES,  /* to each of several bodies */
    GM_ON_TRACERS, /* to particles that are carried along */
    GM_ON_NODES,   /* to points of a grid, nodes or vertices of a mesh */
    GM_ON_CELLS,   /* to triangles */
};

/* An array of the shape (count, members, width): without the first axis on GM_ON_RUN, the second where m is
   1, the third where width is 1. Where `derive` is NULL these are count components of the state, from `first`
   on, as they lie there. */
struct gm_quantity {
    char name[32];
    enum gm_support support;
    size_t count, width;
    size_t first;
    int axis; /* 1, 2, 3: the values are coordinates x, y, z of what they belong to, of width 2 x and y */
    double period[2]; /* of such coordinates x and y, which go round; 0: they do not */
    bool fixed;       /* the same at all times */
    bool whole;       /* whole numbers */
    void (*derive)(const struct gm_run *run, double *values);
};

/* The nodes of the problem's line, as far as they are seen, as a quantity that is first and the same at all times. */
struct gm_quantity gm_quantity_grid(const struct gm_run *run);

enum { GM_QUANTITIES = 16 /* most of a kind */, GM_QUANTITY_AXES = 3 };

/* The quantities of a run's states, into GM_QUANTITIES places; their number. They stay valid with the run. */
size_t gm_quantities(const struct gm_run *run, struct gm_quantity *quantities);

/* Those of rows that tell their time: without the one that a system carries as its last component. */
size_t gm_quantities_beside_time(const struct gm_run *run, struct gm_quantity *quantities);

/* How many numbers it has, over all members. */
size_t gm_quantity_size(const struct gm_run *run, const struct gm_quantity *quantity);

/* The lengths of its axes, for so many members; their number, 0 for a single number. */
size_t gm_quantity_shape(const struct gm_quantity *quantity, size_t members, size_t shape[GM_QUANTITY_AXES]);

/* The numbers now: in the state, or in `scratch` (gm_quantity_size), where they are derived. */
const double *gm_quantity_values(const struct gm_run *run, const struct gm_quantity *quantity,
                                 double *scratch);

#endif
