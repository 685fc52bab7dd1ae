/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_SCENE_H
#define GM_SCENES_SCENE_H

#include "core/run.h"
#include "render/picture.h"

struct gm_lane;

/* Every scene's own struct of parameters begins with this. */
struct gm_timing {
    double dt;    /* time step */
    double until; /* where `run` and `render` stop */
};

/* The rows of the two, for a scene's parameter table. */
#define GM_DT(standard_text, low, high)                                                                      \
    {                                                                                                        \
        .key = "dt", .unit = "", .help = "time step", .type = GM_REAL,                                       \
        .offset = offsetof(struct gm_timing, dt), .standard = standard_text, .lowest = low, .highest = high, \
        .logarithmic = true, .live = true,                                                                   \
    }
#define GM_UNTIL(standard_text)                                                                              \
    {                                                                                                        \
        .key = "until", .unit = "", .help = "time at which run and render stop", .type = GM_REAL,            \
        .offset = offsetof(struct gm_timing, until), .standard = standard_text, .lowest = 0,                 \
        .highest = 1e12, .logarithmic = true, .live = true,                                                  \
    }

/* What may be looked at of one lane. */
struct gm_view {
    const void *parameters; /* the scene's own struct */
    const struct gm_problem *problem;
    const double *start; /* the state at t0, [component * m + member] */
    const double *state; /* the present state */
    double t0, t, dt;
};

/* A number per step. With `error` the number printed is |x - x0| / max(|x0|, scale), x = evaluate. */
struct gm_observable {
    const char *key;
    const char *title; /* as a graph's title */
    const char *unit;
    double (*evaluate)(const struct gm_view *view);
    bool error;
    double scale;     /* natural scale of an error */
    bool logarithmic; /* drawn on a log axis */
};

/* A bounded record of the past: an entry of `width` numbers every `interval` of model time. When `bound`
   entries are full every other one is dropped. Entry 0 is the start. */
struct gm_track {
    const char *key;
    size_t (*width)(const struct gm_view *view);
    double (*interval)(const void *parameters);
    size_t bound;
    void (*record)(const struct gm_view *view, double *entry);
};

/* A published figure: the arguments that redo it. */
struct gm_figure {
    const char *name;      /* "razafindralandy-1" */
    const char *statement; /* what the document says it shows */
    const char *arguments; /* of `geomint render SCENE`, separated by blanks */
};

/* Text sizes that setup may use for a sentence. */
enum { GM_SENTENCE = 256 };

struct gm_scene {
    const char *name, *title, *blurb, *watch;
    size_t size; /* of the scene's own struct, which begins with struct gm_timing */
    const struct gm_parameter *parameters;
    size_t parameter_count;
    const char *const *schemes; /* in preferred order, NULL-terminated; further ones may fit */
    const struct gm_observable *observables;
    size_t observable_count;
    const struct gm_track *tracks;
    size_t track_count;
    const struct gm_figure *figures;
    size_t figure_count;

    /* Fills the problem (n, m, facets) for these parameters; false with a sentence if they contradict. */
    bool (*setup)(const void *parameters, struct gm_problem *problem, char *sentence);
    /* Frees what setup made for the problem; NULL if it makes nothing. */
    void (*close)(struct gm_problem *problem);
    /* Writes the canonical state at t0 (n * m). */
    void (*start)(const void *parameters, const struct gm_problem *problem, double *y);
    /* Draws the lanes, count >= 1, into an empty picture; looks only. */
    void (*draw)(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);
    /* Writes profiles of a state as rows of CSV, each beginning with `front`; NULL if there are none. The
       columns are GM_PROFILE_COLUMNS. */
    void (*profile)(const struct gm_view *view, const char *front, FILE *stream);
};

#define GM_PROFILE_COLUMNS "profile,x,y,psi,u,v,theta,omega,reference"

size_t gm_scene_count(void);
const struct gm_scene *gm_scene_at(size_t index);
const struct gm_scene *gm_scene_find(const char *name);
/* NULL if there is none of that key */
const struct gm_parameter *gm_scene_parameter(const struct gm_scene *scene, const char *key);

#endif
