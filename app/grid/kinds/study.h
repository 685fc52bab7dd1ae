/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_STUDIES_KINDS_STUDY_H
#define GM_APP_STUDIES_KINDS_STUDY_H

#include "app/grid/backward.h"
#include "app/grid/kinds/sweep.h"
#include "app/grid/stability.h"
#include "app/grid/work.h"

/* What the kinds of studies have in common, for whoever shows one without knowing which. */

enum gm_study_kind {
    GM_STUDY_NONE,
    GM_STUDY_WORK,
    GM_STUDY_STABILITY,
    GM_STUDY_BACKWARD,
    GM_STUDY_SWEEP,
    GM_STUDY_COUNT
};

union gm_study_table {
    struct gm_request request; /* with which each begins */
    struct gm_work_table work;
    struct gm_stability_table stability;
    struct gm_backward_table backward;
    struct gm_sweep_study sweep;
};

/* As gm_work_open and its neighbours say; `table` is that of the kind, `measure` is the observable or, of
   stability, what a step is judged by; NULL, or what the others do not take. */
struct gm_study_row {
    const char *name; /* of its command */
    int refusal;      /* the exit status where nothing can be measured */
    bool (*open)(void *table, const struct gm_arguments *arguments, const char *measure, char *message);
    bool (*measure)(void *table, const struct gm_listener *listener, char *message);
    void (*draw)(const void *table, struct gm_picture *picture);
    bool (*write)(const void *table, const char *path);
    void (*close)(void *table);
    /* The words of the run that panel number `panel` shows at (x, y), the scene first; malloc'ed. NULL
       where it shows none, and for a kind that has no runs of its own. In any thread, while it measures. */
    char *(*pick)(const void *table, size_t panel, double x, double y);
};
extern const struct gm_study_row gm_study_rows[GM_STUDY_COUNT]; /* that of GM_STUDY_NONE is empty */

/* The kind of that name; GM_STUDY_NONE if there is none. */
enum gm_study_kind gm_study_find(const char *name);

#endif
