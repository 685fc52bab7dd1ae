/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a scene is: parameters, setup and start, observables, tracks, and the picture that is drawn of
   lanes. */
#ifndef GM_SCENES_COMMON_SCENE_H
#define GM_SCENES_COMMON_SCENE_H

#include "core/run.h"
#include "render/message.h"
#include "render/picture/picture.h"
#include "scenes/common/rows.h"

struct gm_lane;
struct gm_scene;
struct gm_entries;

/* Every scene's own struct of parameters begins with this. */
struct gm_timing {
    double dt;    /* time step */
    double until; /* where `run` and `render` stop */
};

/* The end of a run that is told by its steps alone. */
#define GM_NEVER 1e12

/* What a lane's observables have worked out for it, and how it is freed; NULL at first. Each kind has a
   place. */
enum { GM_WORKED_ENERGY, GM_WORKED_GROWTH, GM_WORKED };
struct gm_worked {
    void *data;
    void (*forget)(void *data);
};

/* What may be looked at of one lane. */
struct gm_view {
    const struct gm_scene *scene;
    const void *parameters; /* the scene's own struct */
    const struct gm_problem *problem;
    const struct gm_scheme *scheme;
    const double *start; /* the state at t0, [component * m + member] */
    const double *state; /* the present state */
    double t0, t, dt;
    const double *memory;                   /* the scheme's own; NULL if it has none */
    const struct gm_entries *tracks;        /* the scene's, as recorded so far; NULL while a lane is opened */
    const struct gm_run *run;               /* for what a scheme says of itself */
    size_t member;                          /* that a track with `each` is asked of */
    const struct gm_observable *observable; /* the one that is evaluated (gm_observe) */
    struct gm_worked *worked;               /* the lane's, GM_WORKED of them */
    const double *initials;  /* of each of the scene's observables with `error`: x at the start */
    const double *cancelled; /* of each of the scene's observables: its terms, or 0; or NULL */
    int side;                /* of the scene's stop at the start: struct gm_lane */
};

/* A number per step. With `error` the number printed is |x - x0| / max(|x0|, scale), x = evaluate, and
   |x - x0| where both are 0. */
struct gm_observable {
    const char *key;
    const char *title; /* as a graph's title; of an error without its formula */
    const char *unit;
    double (*evaluate)(const struct gm_view *view);
    bool error;
    const char *symbol;                      /* of x, in the formula of an error: "H" */
    double (*scale)(const void *parameters); /* natural scale of an error; NULL: 0 */
    double least;                            /* such a scale, where it is a number; else 0 */
    const char *scale_text;                  /* as it is written: "1 for the pendulum" */
    /* The sum of the magnitudes of x's terms: the scale where they cancel at the start. NULL: they do not. */
    double (*terms)(const struct gm_view *view);
    bool kept; /* the exact motion keeps x */
    /* Why there may be no value (NaN), NULL: there always is one; or what tells why there was none, if
       anything. */
    const char *missing;
    const char *(*why)(const struct gm_view *view);
    double period;    /* of an angle, which is printed unwrapped; 0: none */
    bool recalls;     /* it is made of what was recorded on the way */
    bool logarithmic; /* drawn on a log axis */
};

/* A bounded record of the past: an entry of so many numbers every so much of model time; or, with `section`,
   one wherever that function of the state passes zero upwards between two steps, at the state interpolated
   there (with `again`: that the scheme finds there, where it can make the step again, shorter), or, with
   `admits`, in either direction wherever that holds of it. When `bound` entries are full every other one is
   dropped, or, of a `recent` track, the older half. Entry 0 of a track by intervals that is not recent is the
   start. */
struct gm_track {
    const char *key;
    size_t numbers;                                /* of an entry; 0: */
    size_t (*width)(const struct gm_view *view);   /* as many as that says */
    double every;                                  /* model time; 0: after each step that is looked at, or */
    double (*interval)(const void *parameters);    /* what that says, where it is there */
    double (*section)(const struct gm_view *view); /* looks at active components only */
    bool (*admits)(const struct gm_view *view);
    bool again; /* the crossing is where the scheme puts it, if it can make the step again, of one member */
    bool each;  /* members have sections of their own: these three look at that of view->member alone */
    size_t bound;
    bool recent;
    void (*record)(const struct gm_view *view, double *entry);
};

/* How `geomint work-precision` measures a scene; without it the scene's defaults and every scheme that
   fits. */
struct gm_work {
    const char *arguments; /* key=value that differ from the defaults, separated by blanks; "" */
    const char *measure;   /* key of the observable that is the error, at the end; NULL: the distance of the
                              state from the exact one, or from that of a reference run */
    double coarsest;       /* the largest step of the ladder (0: four times the usual one), */
    int halvings;          /* halved so many times */
    const char *const *schemes; /* the entrants, NULL-terminated; NULL: every scheme that fits */
    const char *reference;  /* the scheme of the reference run, where the problem has no exact solution; NULL:
                               the highest order that fits */
    const char *is_exact;   /* name of a scheme that solves the scene exactly where it has an exact solution,
                               and is no  entrant then; NULL: none */
    const char *resolution; /* key of a parameter that is measured at `resolution_count` values beside the
                               steps: each scheme is judged by its best pairs; NULL: none */
    const double *resolutions; /* from coarse to fine */
    size_t resolution_count;
    const char *ratio; /* key of a parameter with which the step follows the resolution (settle); typed, its
                          values take the place of the ladder; NULL: none */
    /* How far the state of a lane is from that of one whose resolution is twice as fine as the finest, and whose
       step is half the shortest: the error instead of `measure`. NULL: the states of all lanes have one size */
    double (*distance)(const struct gm_lane *lane, const struct gm_lane *finer);
    const char *distance_title;
    const double *errors; /* three, falling, at which prices are compared; NULL: 1e-3, 1e-6, 1e-9 */
};

/* What `geomint stability` does with a scene: a grid of time steps and of one parameter. */
struct gm_stability {
    const char *arguments; /* key=value that differ from the defaults, separated by blanks; "" */
    const char *parameter; /* its key */
    const double *values;  /* value_count of them */
    size_t value_count;
    const char *label;                      /* of the time step in units of `unit`: "h ω" */
    double (*unit)(const void *parameters); /* of the time step: the shortest time there is */
    const char *told;                       /* what 1 / that is, where it is found numerically; NULL */
    const double *steps;                    /* step_count of them, in that unit */
    size_t step_count;
    const char *
        kept; /* key of the observable that is lost below half of its start, gained above twice; NULL: none */
    int64_t
        settle; /* where that swings by itself: the largest value of so many first steps is compared to that
                    of so many last ones; 0: the end to the start */
    const char *error;          /* key of the observable by which a step is accurate; NULL: none */
    bool throughout;            /* its largest value on the way counts, and not that at the end */
    const char *const *schemes; /* NULL-terminated; NULL: the scene's */
};

/* A published figure: the arguments that redo it. */
struct gm_figure {
    const char *name;      /* "razafindralandy-1" */
    const char *statement; /* what the document says it shows */
    const char *arguments; /* of `geomint render SCENE`, separated by blanks */
};

/* A value for one of the scene's parameters, as it would be typed. */
struct gm_choice {
    const char *key;
    char value[40];
};
enum { GM_CHOICES = 4 };

/* Of a scene, with those that are asked for. */
enum { GM_MOST_OBSERVABLES = 128 };

struct gm_scene {
    const char *name, *title, *blurb, *watch;
    const char *time;    /* what a time of 1 is: "H²/ν" */
    size_t size;         /* of the scene's own struct, which begins with struct gm_timing */
    const void *initial; /* that struct before its parameters are set; NULL: zeros */
    /* Of a scene that was made of words: these, NULL-terminated, the first instead of a name. */
    const char *const *words;
    const char *source; /* the text of the file that it was made of, if it was; NULL */
    const char *text;   /* the text that it was made of, also of one that was typed; NULL */
    const char *room;   /* the text of the room's file that it was made of; NULL */
    const char *mark;   /* its name and a checksum of that text; NULL: its name tells all */
    const struct gm_parameter *parameters;
    size_t parameter_count;
    const char *const *schemes; /* in preferred order, NULL-terminated; further ones may fit */
    /* Those that are shown in the place of the first of them where such a word is typed and no scheme:
       "show=frame", of schemes that have one; ends with a NULL. NULL: none. */
    const struct gm_preference {
        const char *word;
        const char *schemes[4]; /* ends with a NULL */
    } * preferences;
    /* What is shown where nothing is asked for: key=value with lists, by blanks; NULL: the first schemes. */
    const char *lanes;
    const struct gm_observable *observables;
    size_t observable_count;
    /* Further ones, numbered behind those: they cost something, and are computed where they are asked for by
       their key, or while a picture shows them. */
    const struct gm_observable *asked;
    size_t asked_count;
    /* How many of the first of them its picture shows; NULL: none. */
    size_t (*asked_shown)(const struct gm_scene *scene, const void *parameters);
    /* The picture that shows them, in the place of `draw`. */
    void (*draw_asked)(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);
    const struct gm_track *tracks;
    size_t track_count;
    const struct gm_figure *figures;
    size_t figure_count;
    const struct gm_work *work;
    const struct gm_stability *stability; /* NULL: the scene has no such map */
    const char *no_stability;             /* why not, and what helps instead; NULL: not known */
    int64_t
        follow; /* 0, or: between two looks there are at most so many steps, for what an observable recalls */

    /* The time at the start; NULL: 0. */
    double (*t0)(const void *parameters);
    /* The scene whose lane has these parameters, where words of a choice make several whose tables have the same rows;
       NULL: this one. */
    const struct gm_scene *(*variant)(const void *parameters);
    /* Why the parameter of that key has no effect with these, NULL if it has one; no hook: all have one. */
    const char *(*idle)(const void *parameters, const char *key);
    /* Makes parameters agree that follow from others, after those of these keys were set; false with a
       sentence if they contradict. NULL: none do. */
    bool (*settle)(void *parameters, const char *const *keys, size_t count, char *sentence);
    /* Whether a scheme that does not fit is one that the scene's own text takes on another kind of grid: a word that
       asks for it makes another scene. NULL: there is no other. */
    bool (*elsewhere)(const struct gm_scheme *scheme);
    /* Settles, in the lane's own copy, the parameters that were left to it ("auto"); NULL: there are none. */
    void (*resolve)(void *parameters);
    /* Fills the problem (n, m, facets) for these parameters; false with a sentence if they contradict. */
    bool (*setup)(const void *parameters, struct gm_problem *problem, char *sentence);
    /* Notes, in the lane's own copy, what was chosen while the problem was made; NULL: nothing is. */
    void (*chosen)(const struct gm_problem *problem, void *parameters);
    /* Whether the files that the parameters name can be read; a sentence if not. NULL: they name none. */
    bool (*readable)(const void *parameters, char *sentence);
    /* What is to be known of how the files were read, "" or a sentence; NULL: nothing. */
    void (*note)(const struct gm_problem *problem, const void *parameters, char *sentence);
    /* Frees what setup made for the problem; NULL if it makes nothing. */
    void (*close)(struct gm_problem *problem);
    /* Writes the canonical state at t0 (n * m). */
    void (*start)(const void *parameters, const struct gm_problem *problem, double *y);
    /* Instead of start, where the state depends on the scheme, or may not exist: false with a sentence
       then. */
    bool (*start_with)(const void *parameters, const struct gm_problem *problem,
                       const struct gm_scheme *scheme, double *y, char *sentence);
    /* Where it has another sign than at the start the run ends, and ends well: just beyond that place, if the
       scheme can make its last step again, shorter, else after that step. With it, `follow` is 1. NULL: it
       does not. */
    double (*stop)(const struct gm_view *view);
    /* The same, to the same bits, of `count` states of a view's last member at these times: component c of
       the k-th is states[c * count + k]. */
    void (*stops)(const struct gm_view *view, const double *states, const double *times, size_t count,
                  double *values);
    /* Writes one sentence on the step that would follow a view, where that led to no number; "": there is
       nothing to say. NULL: there never is. */
    void (*failure)(const struct gm_view *view, char *text, size_t size);
    /* Draws the lanes, count >= 1, into an empty picture; looks only. */
    void (*draw)(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);
    /* The parameters, at most GM_CHOICES, with which a run starts at the point (x, y) of a state's panel; 0
       where it cannot. NULL: the scene has no such points. */
    size_t (*point)(const void *parameters, double x, double y, struct gm_choice *choices);
    /* Writes profiles of a state as rows of CSV, each beginning with `front`; NULL if there are none. The
       columns are GM_PROFILE_COLUMNS. */
    void (*profile)(const struct gm_view *view, const char *front, FILE *stream);
};

#define GM_PROFILE_COLUMNS "profile,x,y,psi,u,v,theta,omega,reference"

/* Writes the title, of an error with its formula: "energy error  |H − H₀| / max(|H₀|, 1/2)". */
const char *gm_observable_title(const struct gm_observable *observable, char *text, size_t size);

/* The value of an observable in a view. */
double gm_observe(const struct gm_observable *observable, const struct gm_view *view);
/* Whether two observables would be told by one name: both have it, or one is KEY_max, as --max calls the largest of
   the other. */
bool gm_observables_clash(const char *key, const char *other);
/* Whether the scene's stop has changed its sign. */
bool gm_view_stopped(const struct gm_view *view);
/* The natural scale of an error. */
double gm_observable_scale(const struct gm_observable *observable, const struct gm_view *view);

/* The scene's own struct with every parameter at its default; malloc'ed, NULL when memory is short. */
void *gm_scene_defaults(const struct gm_scene *scene);

/* For settle: whether the key is among those that were given. */
bool gm_is_given(const char *key, const char *const *keys, size_t count);

/* A choice of three digits, which is what a place in a picture tells. */
void gm_choose(struct gm_choice *choice, const char *key, double value);

size_t gm_scene_count(void);
/* Name and title of a scene, whose file is not opened for them. */
const char *gm_scene_name(size_t index);
const char *gm_scene_title(size_t index);
/* The index of the scene of that name; gm_scene_count(): there is none. */
size_t gm_scene_number(const char *name);
const struct gm_scene *gm_scene_at(size_t index);
const struct gm_scene *gm_scene_find(const char *name);
double gm_scene_t0(const struct gm_scene *scene, const void *parameters);
/* The number of the observable of that key, of all there are; -1 if there is none. */
int gm_scene_observable(const struct gm_scene *scene, const char *key);
/* The observable of that number; NULL behind the last. */
const struct gm_observable *gm_scene_observable_at(const struct gm_scene *scene, size_t number);
/* Its key, for proposals (core/expression/nearest.h); `scene` is a struct gm_scene. */
const char *gm_scene_observable_key(size_t number, const void *scene);
/* Why the parameter of that key has no effect with these: "the mesh comes from a file"; NULL if it has
   one. */
const char *gm_scene_idle(const struct gm_scene *scene, const void *parameters, const char *key);
/* NULL if there is none of that key */
const struct gm_parameter *gm_scene_parameter(const struct gm_scene *scene, const char *key);

#endif
