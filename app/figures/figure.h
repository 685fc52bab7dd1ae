/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_FIGURES_FIGURE_H
#define GM_APP_FIGURES_FIGURE_H

#include "app/output/printer.h"
#include "app/words/request.h"
#include "scenes/common/published.h"

/* One figure: run, painted in both themes, and, if it is a published one, held against what its document says of it. */

enum {
    GM_FIGURE_LANES = 32,
    GM_FIGURE_OBSERVABLES = 16,
    GM_FIGURE_STATEMENTS = 12,
    GM_FIGURE_LABEL = 96,
    GM_FIGURE_NOTE = 256
};

enum gm_making { GM_WAITING, GM_RUNNING, GM_MADE, GM_NOT_MADE };

/* What came out, as plain data without pointers: it is filled by another process. */
struct gm_outcome {
    enum gm_making progress;
    int status; /* an exit status; GM_EXIT_OK when made */
    char message[GM_MESSAGE];
    double seconds; /* that it took */
    size_t lane_count;
    struct {
        char label[GM_FIGURE_LABEL]; /* the scheme and what else sets the lane apart */
        char failure[GM_MESSAGE];    /* "" where it came to its end */
        double t;
        double observables[GM_FIGURE_OBSERVABLES];
    } lanes[GM_FIGURE_LANES];
    size_t verdict_count; /* the figure's statements */
    struct {
        double low, high; /* of the numbers of its lanes */
        double scale;     /* that multiplies the statement's bounds */
        bool holds;
        bool open; /* it holds with some values that the document does not give, not with others */
        char note[GM_FIGURE_NOTE]; /* those values; "" */
    } verdicts[GM_FIGURE_STATEMENTS];
};

/* Where the figures go. */
struct gm_figure_output {
    const char *folder;        /* that there is */
    struct gm_appearance look; /* of their pictures; each is made in both themes */
    enum gm_format format;
    bool quick; /* long runs are coarser: nothing is judged of them, and the page says so */
};

/* A figure as asked for. */
struct gm_figure_job {
    const struct gm_scene *scene;
    const struct gm_figure *figure;
    const struct gm_published *published; /* NULL if its document says nothing that can be measured */
    char arguments[512];                  /* those that are run */
    bool shortened;                       /* in work, by --quick: nothing is judged */
};

/* Whether it is of a system of somebody's own. */
static inline bool gm_figure_is_user(const struct gm_figure_job *job)
{
    return job->scene->words;
}

/* What `geomint render` calls the scene. */
static inline const char *gm_figure_word(const struct gm_figure_job *job)
{
    return gm_figure_is_user(job) ? job->scene->words[0] : job->scene->name;
}

/* How many of the scene's observables are among the numbers of a lane. */
static inline size_t gm_figure_observables(const struct gm_figure_job *job)
{
    const size_t count = job->scene->observable_count;
    return count < GM_FIGURE_OBSERVABLES ? count : GM_FIGURE_OBSERVABLES;
}

/* Settles which arguments are run. */
void gm_figure_plan(struct gm_figure_job *job, const struct gm_scene *scene, const struct gm_figure *figure,
                    bool quick);

/* The indices of the lanes with these values, "scheme=rk4 dt=0.1,0.2"; returns how many, GM_FIGURE_LANES at most. Where
   a key or a value is none, *known becomes false. */
size_t gm_figure_lanes(const struct gm_request *request, const char *lanes, size_t *chosen, bool *known);

/* Runs it, judges it and writes its pictures, as FOLDER/NAME.png and FOLDER/NAME-dark.png, and those of
   another format beside them, which the page may not show. An interruption is GM_EXIT_INTERRUPTED. */
void gm_figure_make(const struct gm_figure_job *job, const struct gm_figure_output *output,
                    struct gm_outcome *outcome);

/* Whether observable `index` of the scene is a number in any lane: what has none is told nowhere. */
bool gm_outcome_has(const struct gm_outcome *outcome, size_t index);

/* FOLDER/NAME.png or FOLDER/NAME-dark.png; malloc'ed. */
char *gm_figure_path(const struct gm_figure_output *output, const char *name, enum gm_theme theme,
                     enum gm_format format);

/* Who makes a statement, as JSON names it. */
enum gm_source { GM_OF_DOCUMENT, GM_OF_OURS, GM_OF_VARIANT, GM_SOURCES };
enum gm_source gm_statement_source(const struct gm_figure_job *job, size_t index);
const char *gm_source_name(enum gm_source source);

/* How many figures were made, and what became of their statements. */
struct gm_figure_sum {
    size_t made;
    struct gm_tally {
        size_t hold, fail, open;
    } of[GM_SOURCES];
};
struct gm_figure_sum gm_figures_sum(const struct gm_figure_job *jobs, const struct gm_outcome *outcomes,
                                    size_t count);

/* Of statement `index`: "holds", "does not hold", "open", or "not judged" of a run that was shortened. */
const char *gm_verdict_word(const struct gm_figure_job *job, const struct gm_outcome *outcome, size_t index);

/* What a statement expects ("at most 1e-12"; "at most 0.21, 5 % of the breather's height") and what was found
   ("0.105", "0.09 to 0.11"; "no number" where there is none). */
void gm_statement_expectation(const struct gm_statement *statement, double scale, char *text, size_t size);
void gm_verdict_number(double low, double high, char *text, size_t size);

/* Writes FOLDER/figures.html: one file with everything in it, pictures too, that needs neither net nor
   script. Figures that are not made are listed as such. By way of a temporary name. False with a sentence. */
bool gm_figures_page_write(const struct gm_figure_output *output, const struct gm_figure_job *jobs,
                           const struct gm_outcome *outcomes, size_t count, char *message);

#endif
