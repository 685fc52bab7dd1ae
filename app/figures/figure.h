/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_FIGURES_FIGURE_H
#define GM_APP_FIGURES_FIGURE_H

#include "app/output/printer.h"
#include "app/words/request.h"
#include "scenes/common/published.h"

/* One figure: run, painted in both themes, and, if it is published, compared with its document's
   statements. */

enum {
    GM_FIGURE_LANES = 32,
    GM_FIGURE_OBSERVABLES = 16,
    GM_FIGURE_STATEMENTS = 12,
    GM_FIGURE_LABEL = 96,
    GM_FIGURE_NOTE = 256
};

enum gm_making { GM_WAITING, GM_RUNNING, GM_MADE, GM_NOT_MADE };

/* The result, as plain data without pointers: another process fills it. */
struct gm_outcome {
    enum gm_making progress;
    int status; /* an exit status; GM_EXIT_OK when made */
    char message[GM_MESSAGE];
    double seconds; /* duration of making it */
    size_t lane_count;
    struct {
        char label[GM_FIGURE_LABEL]; /* the scheme and the other values that distinguish the lane */
        char failure[GM_MESSAGE];    /* "" if it came to its end */
        double t;
        double observables[GM_FIGURE_OBSERVABLES];
    } lanes[GM_FIGURE_LANES];
    size_t verdict_count; /* the figure's statements */
    struct {
        double low, high; /* range of the numbers of its lanes */
        double scale;     /* factor of the statement's bounds */
        bool holds;
        bool open; /* it holds with some values that the document does not give, not with others */
        char note[GM_FIGURE_NOTE]; /* these values, or "" */
    } verdicts[GM_FIGURE_STATEMENTS];
};

/* The output of the figures. */
struct gm_figure_output {
    const char *folder;        /* an existing folder */
    struct gm_appearance look; /* the look of their pictures, without the theme: each is made in both */
    enum gm_format format;
    bool quick; /* long runs are coarser and not judged, and the page notes it */
};

/* A requested figure. */
struct gm_figure_job {
    const struct gm_scene *scene;
    const struct gm_figure *figure;
    const struct gm_published *published; /* NULL if its document has no measurable statement */
    char arguments[512];                  /* the arguments of the run */
    bool shortened;                       /* --quick has reduced its work: it is not judged */
};

/* Returns true for a figure of a user-defined system. */
static inline bool gm_figure_is_user(const struct gm_figure_job *job)
{
    return job->scene->words;
}

/* The scene's word for `geomint render`. */
static inline const char *gm_figure_word(const struct gm_figure_job *job)
{
    return gm_figure_is_user(job) ? job->scene->words[0] : job->scene->name;
}

/* The number of the scene's observables among the numbers of a lane. */
static inline size_t gm_figure_observables(const struct gm_figure_job *job)
{
    const size_t count = job->scene->observable_count;
    return count < GM_FIGURE_OBSERVABLES ? count : GM_FIGURE_OBSERVABLES;
}

/* The published figure of that number, of all scenes in their order, and its scene; or NULL. */
const struct gm_figure *gm_figure_at(size_t index, const struct gm_scene **scene);

/* Chooses the arguments of the run. */
void gm_figure_plan(struct gm_figure_job *job, const struct gm_scene *scene, const struct gm_figure *figure,
                    bool quick);

/* The indices of the lanes with these values, "scheme=rk4 dt=0.1,0.2"; returns their number, at most
   GM_FIGURE_LANES. An unknown key or value sets *known to false. */
size_t gm_figure_lanes(const struct gm_request *request, const char *lanes, size_t *chosen, bool *known);

/* Runs it, judges it and writes its pictures, as FOLDER/NAME.png and FOLDER/NAME-dark.png, and also in
   another format, which the page may not show. The status after an interruption is GM_EXIT_INTERRUPTED. */
void gm_figure_make(const struct gm_figure_job *job, const struct gm_figure_output *output,
                    struct gm_outcome *outcome);

/* Returns true if observable `index` of the scene is a number in any lane; only such observables are
   printed. */
bool gm_outcome_has(const struct gm_outcome *outcome, size_t index);

/* Writes FOLDER/NAME.png or FOLDER/NAME-dark.png. Returns path. */
enum { GM_FIGURE_PATH = 4096 };
const char *gm_figure_path(const struct gm_figure_output *output, const char *name, enum gm_theme theme,
                           enum gm_format format, char path[GM_FIGURE_PATH]);

/* The source of a statement, as in JSON. */
enum gm_source { GM_OF_DOCUMENT, GM_OF_OURS, GM_OF_VARIANT, GM_SOURCES };
enum gm_source gm_statement_source(const struct gm_figure_job *job, size_t index);

/* The number of figures made, and the verdicts on their statements. */
struct gm_figure_sum {
    size_t made;
    struct gm_tally {
        size_t hold, fail, open;
    } of[GM_SOURCES];
};
struct gm_figure_sum gm_figures_sum(const struct gm_figure_job *jobs, const struct gm_outcome *outcomes,
                                    size_t count);

/* The verdict on statement `index`: "holds", "does not hold", "open", or "not judged" after a shortened
   run. */
const char *gm_verdict_word(const struct gm_figure_job *job, const struct gm_outcome *outcome, size_t index);

/* The expectation of a statement ("at most 1e-12"; "at most 0.21, 5 % of the breather's height") and the
   measured range ("0.105", "0.09 to 0.11", or that there is not one). */
void gm_statement_expectation(const struct gm_statement *statement, double scale, char *text, size_t size);
void gm_verdict_number(double low, double high, char *text, size_t size);

/* Writes FOLDER/figures.html: one file with everything in it, pictures too, without network or script. It
   lists figures that are not made as such. A temporary file is renamed. Returns false with a sentence. */
bool gm_figures_page_write(const struct gm_figure_output *output, const struct gm_figure_job *jobs,
                           const struct gm_outcome *outcomes, size_t count, char *message);

#endif
