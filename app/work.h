/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_WORK_H
#define GM_APP_WORK_H

#include "app/listener.h"
#include "app/options.h"

/* Work-precision: the error at the end against what it cost, for schemes and a ladder of time steps. */

struct gm_work_point {
    double dt, t; /* the step, and the time reached */
    long steps;
    double error;   /* NAN where the run failed */
    double seconds; /* processor time, best of several */
    double evaluations, solves;
    enum gm_status status;
};

struct gm_work_line { /* one scheme, from the longest step to the shortest */
    const struct gm_scheme *scheme;
    struct gm_work_point *points;
    size_t count;
};

struct gm_work_table {
    struct gm_request request; /* its first lane has the parameters that all share */
    const char *measure;       /* "solution_error" or an observable's key */
    const char *measure_title;
    char reference[96]; /* what the error is measured against, in words */
    double *steps;      /* the ladder, falling */
    size_t step_count;
    const struct gm_scheme **schemes;
    size_t scheme_count;
    struct gm_work_line *lines; /* line_count <= scheme_count are finished */
    size_t line_count;
    const struct gm_listener *listener; /* of gm_work_measure */
};

/* Reads the words of the command line and settles schemes, steps and measure. False with a sentence. */
bool gm_work_open(struct gm_work_table *table, const struct gm_options *options, char *message);
void gm_work_close(struct gm_work_table *table);

/* Measures scheme after scheme. Stopped, what is finished stays. False with a sentence. */
bool gm_work_measure(struct gm_work_table *table, const struct gm_listener *listener, char *message);

/* Writes a row of CSV for every point measured. False, with errno, if that fails. */
bool gm_work_write(const struct gm_work_table *table, const char *path);

enum gm_work_cost { GM_COST_SECONDS, GM_COST_EVALUATIONS };
double gm_work_cost(const struct gm_work_point *point, enum gm_work_cost cost);

/* What a scheme pays for this error, interpolated between two steps of its ladder; NAN if it does not reach
 * it. */
double gm_work_price(const struct gm_work_line *line, double error, enum gm_work_cost cost);

/* The line that is cheapest at this error; NULL if none reaches it. */
const struct gm_work_line *gm_work_cheapest(const struct gm_work_table *table, double error,
                                            enum gm_work_cost cost);

/* "Cheapest by run time: ..." */
const char *gm_work_sentence(const struct gm_work_table *table, char *text, size_t size);

/* Fills an empty picture: error against run time, error against evaluations. */
void gm_work_draw(const struct gm_work_table *table, struct gm_picture *picture);

extern const double gm_work_errors[3]; /* at which schemes are compared */

#endif
