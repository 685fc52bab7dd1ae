/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_PUBLISHED_H
#define GM_SCENES_COMMON_PUBLISHED_H

#include <stdbool.h>
#include <stddef.h>

/* Statements of documents on their figures, as numbers to compare with ours. The scenes have the figures
   themselves, as arguments that redo them (struct gm_figure). */

enum gm_figure_measure {
    GM_AT_END,  /* observable at the end */
    GM_MAXIMUM, /* largest value over all steps */
    GM_GROWTH,  /* largest value in the second half of the time, divided by that in the first */
    GM_FACTOR,  /* value at the end, divided by that at the start */
    GM_LASTS,   /* time that a run reached: before `until` if it failed */
    GM_PEAKS,   /* time of the largest value */
    GM_DIPS,    /* time of the smallest value */
    GM_EXCEEDS, /* first time above `level`, infinite without one; as exact as bins are wide */
};

/* The front of a statement that no document makes. */
#define GM_OURS "(ours) "

/* A size that measures words: "close" is a part of it. */
struct gm_figure_scale {
    const char *name;       /* "the soliton's height" */
    const char *observable; /* observable of the same lane, with the same measure; NULL: `size` */
    double size;
};

struct gm_statement {
    const char *says; /* words of the document, shortened; or GM_OURS and ours */
    /* The lanes with all of these values, "scheme=rk4 dt=0.1,0.2" (one of a list); "": all. The statement
       must hold for each of them. */
    const char *lanes;
    const char *against;    /* lanes whose numbers are the divisors, one by one or one for all; NULL: none */
    const char *observable; /* key of the observable; NULL for GM_LASTS */
    enum gm_figure_measure measure;
    /* NULL; or the key of a parameter or observable: the number is then the order of convergence, the slope
       of the measure against it on log axes, from the first lane to the last; with `against`, the ratio of
       two orders */
    const char *over;
    /* NULL; or keys of parameters that the document does not give and the verdict depends on, "dt until":
       each lane is judged separately */
    const char *open;
    const struct gm_figure_scale *scale; /* factor of low, high and level; NULL: 1 */
    double level;                        /* threshold of GM_EXCEEDS */
    double from, to;                     /* range of times of GM_PEAKS and GM_DIPS; 0, 0: all */
    double low, high;                    /* true if low <= number <= high */
};

struct gm_published {
    const char *figure; /* name of a struct gm_figure */
    /* key=value for a short run, with `figures --quick`: coarser, with as many lanes and the same times;
       NULL: it is short */
    const char *quick;
    const char *remark; /* our remark, such as the reason why a statement does not hold; NULL */
    bool variant;       /* a published figure with a value of ours: counted separately */
    const struct gm_statement *statements;
    size_t count;
};

struct gm_document {
    const char *prefix; /* prefix of its figures' names: "razafindralandy" */
    const char *citation, *link;
};

/* All documents, and all figures with statements. */
const struct gm_document *gm_documents(size_t *count);
const struct gm_published *gm_published_figures(size_t *count);
/* NULL if there are no statements on that figure */
const struct gm_published *gm_published_find(const char *figure);

#endif
