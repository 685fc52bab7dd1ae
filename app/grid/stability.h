/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_STUDIES_STABILITY_H
#define GM_APP_STUDIES_STABILITY_H

#include "app/base/arguments.h"
#include "app/grid/listener.h"
#include "app/words/request.h"

/* Which time step keeps which scheme bounded, or accurate, over a grid of steps and of one parameter. */

enum gm_cell_verdict {
    GM_UNTRIED,
    GM_BOUNDED, /* or accurate, where that was asked */
    GM_LOST,    /* what should be kept fell below half of its start */
    GM_GAINED,  /* ... rose above twice its start */
    GM_WRONG,   /* bounded, and not accurate, where that was asked */
    GM_FAILED,  /* ended with a status */
};

struct gm_map_cell {
    enum gm_cell_verdict verdict;
    enum gm_status status;
    double dt, t;        /* the time it came to */
    double ratio, error; /* of what should be kept to its start; NAN: not known */
};

struct gm_stability_map { /* of one scheme */
    const struct gm_scheme *scheme;
    struct gm_map_cell *cells; /* [step * value_count + value] */
};

struct gm_stability_table {
    struct gm_request request; /* its first lane has the parameters that all share */
    const struct gm_stability *plan;
    const struct gm_parameter *parameter;
    double accuracy; /* above which the scene's error is not accurate; INFINITY: bounded is asked alone */
    struct gm_stability_map *maps;
    size_t count;
};

/* Reads the words, a scene and its key=value, and what a step is judged by: "bounded" (NULL), "accurate" or
   "accurate=1e-2". False with a sentence (GM_MESSAGE bytes); of the table only request.refusal says something
   then. */
bool gm_stability_open(struct gm_stability_table *table, const struct gm_arguments *arguments,
                       const char *judge, char *message);
void gm_stability_close(struct gm_stability_table *table);

/* Fills the maps; stopped, what was not tried stays untried. False with a sentence. */
bool gm_stability_measure(struct gm_stability_table *table, const struct gm_listener *listener,
                          char *message);

/* Writes a row of CSV for every cell tried. False, with errno, if that fails. */
bool gm_stability_write(const struct gm_stability_table *table, const char *path);

/* What is asked: "bounded" or "accurate"; and in a sentence, "accurate to 0.01 (position_error)". */
const char *gm_stability_judge(const struct gm_stability_table *table);
const char *gm_stability_question(const struct gm_stability_table *table, char *text, size_t size);

/* That word, "lost", ... or the status' name; and a letter for the map. */
const char *gm_cell_word(const struct gm_stability_table *table, const struct gm_map_cell *cell);
char gm_cell_letter(const struct gm_map_cell *cell);

/* The letters in use, but that of what is asked: "W wrong, M mesh-crossing". Returns text. */
const char *gm_stability_letters(const struct gm_stability_table *table, char *text, size_t size);

/* The largest step, in the plan's unit, up to which a scheme is as asked for all values; 0: none. NAN
   where cells that were not tried leave it open. */
double gm_stability_limit(const struct gm_stability_table *table, const struct gm_stability_map *map);

void gm_stability_draw(const struct gm_stability_table *table, struct gm_picture *picture);

#endif
