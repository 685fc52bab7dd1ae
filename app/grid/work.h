/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_STUDIES_WORK_H
#define GM_APP_STUDIES_WORK_H

#include "app/base/arguments.h"
#include "app/grid/listener.h"
#include "app/words/request.h"

/* Work-precision: the error at the end against what it cost, for schemes and a ladder of time steps. */

struct gm_work_point {
    double dt, t;      /* the step, and the time reached */
    double resolution; /* value of the plan's parameter where that varies, or its reciprocal where smaller is
                          finer (gm_work_resolution); else 0 */
    int64_t steps;
    double error;   /* NAN where the run failed */
    double seconds; /* processor time, best of several */
    double evaluations, solves;
    enum gm_status status;
};

enum gm_work_cost { GM_COST_SECONDS, GM_COST_EVALUATIONS, GM_COST_RESOLUTION, GM_COST_COUNT };

struct gm_work_line { /* one scheme, from the longest step to the shortest, at each resolution */
    const struct gm_scheme *scheme;
    struct gm_work_point *points;
    size_t count;
    char reason[GM_MESSAGE]; /* why the measure is no number; empty: it is one, or the status says it */
    /* where the resolution varies: those that no other beats in error and cost, by rising cost; else NULL */
    struct gm_work_point *best[GM_COST_COUNT];
    size_t best_count[GM_COST_COUNT];
};

struct gm_work_table {
    struct gm_request request; /* its first lane has the parameters that all share */
    char settings[160];        /* the words that set parameters which all runs share: "viscosity=0.05" */
    bool best;                 /* built-in schemes are added that promise most */
    const char *measure;       /* "solution_error" or an observable's key */
    bool observed;             /* it is the observable, not the distance of the states */
    const char *measure_title;
    char reference[96]; /* what the error is measured against, in words */
    const struct gm_scheme
        *trusted; /* of a run that is the reference, and its step; NULL: the solution is exact */
    double reference_step;
    struct gm_lane
        *finer;    /* the run that errors are distances from, where the scene measures these; else NULL */
    double *steps; /* the ladder, falling: steps, or values of `ratio` */
    size_t step_count;
    const struct gm_parameter *resolution; /* what varies beside the step; NULL: nothing does */
    double *resolutions;                   /* in the order of the plan */
    size_t resolution_count;               /* 1 where nothing varies */
    bool smaller_is_finer;                 /* of the resolution, as of the distance of nodes */
    const struct gm_parameter *ratio; /* the ladder has its values instead of steps; NULL: it has steps */
    const double *errors;             /* 3, falling: at which schemes are compared */
    const struct gm_scheme **schemes;
    size_t scheme_count;
    struct gm_work_line *lines; /* line_count <= scheme_count are finished */
    size_t line_count;
    const struct gm_listener *listener; /* of gm_work_measure */
};

/* Reads the words, a scene and its key=value, and settles schemes, steps and measure: `measure` is the key of
   an observable, or NULL for what the scene's plan says. False with a sentence (GM_MESSAGE bytes); of the
   table only request.refusal says something then. */
bool gm_work_open(struct gm_work_table *table, const struct gm_arguments *arguments, const char *measure,
                  char *message);
void gm_work_close(struct gm_work_table *table);

/* Measures scheme after scheme. Stopped, what is finished stays. False with a sentence. */
bool gm_work_measure(struct gm_work_table *table, const struct gm_listener *listener, char *message);

/* Writes a row of CSV for every point measured. False, with errno, if that fails. */
bool gm_work_write(const struct gm_work_table *table, const char *path);

double gm_work_cost(const struct gm_work_point *point, enum gm_work_cost cost);

/* Copies to `best`, of `count` places, the points that are cheaper than all that are as accurate, by rising
   cost. Returns their number. */
size_t gm_work_keep_best(const struct gm_work_point *points, size_t count, enum gm_work_cost cost,
                         struct gm_work_point *best);

/* The points that a line is drawn and priced by. */
const struct gm_work_point *gm_work_front(const struct gm_work_line *line, enum gm_work_cost cost,
                                          size_t *count);

/* The second cost that schemes are compared by, beside the run time. */
enum gm_work_cost gm_work_second_cost(const struct gm_work_table *table);

/* What a scheme pays for this error, interpolated between two points of its front; NAN if it does not reach
 * it. */
double gm_work_price(const struct gm_work_line *line, double error, enum gm_work_cost cost);

/* The line that is cheapest at this error; NULL if none reaches it. */
const struct gm_work_line *gm_work_cheapest(const struct gm_work_table *table, double error,
                                            enum gm_work_cost cost);

/* "Cheapest by run time: ..." */
const char *gm_work_sentence(const struct gm_work_table *table, char *text, size_t size);

/* Fills an empty picture: error against run time, error against evaluations. */
void gm_work_draw(const struct gm_work_table *table, struct gm_picture *picture);

/* The parameter's value of what a point has as its resolution, and back. */
double gm_work_resolution(const struct gm_work_table *table, double resolution);

#endif
