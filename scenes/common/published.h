/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_PUBLISHED_H
#define GM_SCENES_COMMON_PUBLISHED_H

#include <stdbool.h>
#include <stddef.h>

/* What the documents say of their figures, as numbers that can be held against ours. The figures themselves,
   that is the arguments that redo them, are the scenes' (struct gm_figure). */

enum gm_figure_measure {
    GM_AT_END,  /* an observable at the end */
    GM_MAXIMUM, /* its largest value over all steps */
    GM_GROWTH,  /* its largest value in the second half of the time, divided by that in the first */
    GM_FACTOR,  /* at the end, divided by that at the start */
    GM_LASTS,   /* the time that a run came to: less than asked for where it failed */
    GM_PEAKS,   /* the time of its largest value, */
    GM_DIPS,    /* of its smallest, */
    GM_EXCEEDS, /* of the first one above `level`, infinite if there is none; as exact as bins are wide */
};

/* Statements that no document makes begin with this. */
#define GM_OURS "(ours) "

/* The size by which a word is measured: "close" is a part of it. */
struct gm_figure_scale {
    const char *name;       /* "the soliton's height" */
    const char *observable; /* of the same lane, measured as the statement is; NULL: */
    double size;
};

struct gm_statement {
    const char *says; /* the document, in a few words; or GM_OURS and what we say */
    /* Whose number: the lanes that have all of these values, "scheme=rk4 dt=0.1,0.2" (of a list, one
       of them); "": all. Of several lanes, each has to hold. */
    const char *lanes;
    const char *against;    /* lanes whose numbers divide those, one by one or one for all; NULL: none */
    const char *observable; /* its key; NULL for GM_LASTS */
    enum gm_figure_measure measure;
    /* NULL; or the key of a parameter or observable: then the number is the order of convergence, the slope
       of the measure against that on log axes, from the first of the lanes to the last; with `against`, the
       order of those divided by the order of the others */
    const char *over;
    /* NULL; or keys of parameters that the document does not give and on whose values the verdict depends,
       "dt until": those of each lane are judged apart */
    const char *open;
    const struct gm_figure_scale *scale; /* that multiplies low, high and level; NULL: 1 */
    double level;                        /* of GM_EXCEEDS */
    double from, to;  /* of GM_PEAKS and GM_DIPS: they look at these times alone; 0, 0: at all */
    double low, high; /* it holds where low <= number <= high */
};

struct gm_published {
    const char *figure; /* the name of a struct gm_figure */
    /* key=value that make it short, for `figures --quick`: coarser, on as many lanes up to the same times;
       NULL: it is short */
    const char *quick;
    const char *remark; /* ours, where something has to be said: why a statement does not hold; NULL */
    bool variant;       /* a published figure with another value of ours: its statements are counted apart */
    const struct gm_statement *statements;
    size_t count;
};

struct gm_document {
    const char *prefix; /* of its figures' names: "razafindralandy" */
    const char *citation, *link;
};

size_t gm_document_count(void);
const struct gm_document *gm_document_at(size_t index);

size_t gm_published_count(void);
const struct gm_published *gm_published_at(size_t index);
/* NULL if nothing is said of that figure */
const struct gm_published *gm_published_find(const char *figure);

#endif
