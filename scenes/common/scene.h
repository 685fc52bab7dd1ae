/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes: parameters, setup and start, observables, tracks, and the picture of lanes. */
#ifndef GM_SCENES_COMMON_SCENE_H
#define GM_SCENES_COMMON_SCENE_H

#include "core/run.h"
#include "render/message.h"
#include "render/picture/picture.h"
#include "scenes/common/rows.h"

struct gm_lane;
struct gm_scene;
struct gm_entries;
struct gm_portrait;

/* Every scene's own struct of parameters begins with this. */
struct gm_timing {
    double dt;    /* time step */
    double until; /* time at which `run` and `render` stop */
};

/* The end of a run that its number of steps limits. */
#define GM_NEVER 1e12

/* Results that a lane's observables have stored, and the function that frees them; NULL at first. Each kind
   has an index. */
enum {
    GM_WORKED_ENERGY,
    GM_WORKED_GROWTH,
    GM_WORKED_VOLUME,
    GM_WORKED_REASON,
    GM_WORKED_FOUND,
    GM_WORKED_TRANSFORM,
    GM_WORKED
};
struct gm_worked {
    void *data;
    void (*forget)(void *data);
};

/* All that a function may read of one lane. */
struct gm_view {
    const struct gm_scene *scene;
    const void *parameters; /* the scene's own struct */
    const struct gm_problem *problem;
    const struct gm_scheme *scheme;
    const double *start; /* the state at t0, [component * m + member] */
    const double *state; /* the current state */
    double t0, t, dt;
    int64_t steps;                          /* all steps up to t */
    const double *memory;                   /* the scheme's memory; NULL if it has none */
    const struct gm_entries *tracks;        /* the scene's tracks so far; NULL while a lane is opened */
    const struct gm_run *run;               /* run, for diagnostics of the scheme */
    size_t member;                          /* member for a track with `each` */
    const struct gm_observable *observable; /* the evaluated observable (gm_observe) */
    struct gm_worked *worked;               /* [GM_WORKED], of the lane */
    const double *initials;                 /* [observable] with `error`: x at the start */
    const double *cancelled;                /* [observable]: its terms, or 0; or NULL */
    const double *booked; /* the memory of events (core/events.h); NULL at the start, and without any */
};

/* A number per step. With `error` the number printed is |x - x0| / max(|x0|, scale), x = evaluate, and |x -
   x0| if both are 0. */
struct gm_observable {
    const char *key;
    const char *title; /* title of a graph; for an error without its formula */
    const char *unit;
    double (*evaluate)(const struct gm_view *view);
    bool error;
    const char *symbol;                          /* symbol of x in the formula of an error: "H" */
    double (*scale)(const struct gm_view *view); /* natural scale of an error; NULL: 0 */
    double least;                                /* natural scale if it is a number; else 0 */
    const char *scale_text;                      /* text of the scale: "1 for the pendulum" */
    /* The sum of the magnitudes of x's terms: the scale if they cancel at the start. NULL: they do not. */
    double (*terms)(const struct gm_view *view);
    bool kept; /* the exact motion conserves x */
    /* The reason why there may be no value (NaN), NULL: there always is one; or a function that returns the
       reason, or NULL. */
    const char *missing;
    const char *(*why)(const struct gm_view *view);
    bool of_members;   /* without further members it has no meaning, and is printed only on request */
    double most;       /* a warning is due above it; 0: none */
    double period;     /* period of an angle, which is printed unwrapped; 0: none */
    bool recalls;      /* computed from the record of earlier steps */
    bool whole_steps;  /* of a map of one step size: the last step of a run is not shortened for it */
    bool logarithmic;  /* drawn on a log axis */
    const char *group; /* a key that requests all observables that have it; NULL: none */
};

/* A bounded record of the past: an entry of `numbers` numbers per interval of model time; or, with `section`,
   an entry at each zero of that function, upwards, between two steps, at the interpolated state (with
   `again`: at the state the scheme computes there, if it can repeat the step, shorter). With `admits` it is
   at each zero in either direction for which that returns true. When `bound` entries are full every other one
   is dropped, or, of a `recent` track, the older half. Entry 0 of a track by intervals that is not recent is
   the start. */
struct gm_track {
    const char *key;
    size_t numbers;                                /* numbers per entry; 0: given by `width` */
    size_t (*width)(const struct gm_view *view);   /* numbers per entry */
    double (*interval)(const void *parameters);    /* interval of model time; NULL: each observed step */
    double (*section)(const struct gm_view *view); /* reads active components only */
    /* Writes the section's values after each of trace->count steps, the last of which is the view's. NULL: by `section` */
    void (*sections)(const struct gm_view *view, const struct gm_trace *trace, double *values);
    bool (*admits)(const struct gm_view *view);
    /* Returns true if the section is at this event, and nowhere else; NULL: at none. */
    bool (*at_event)(const struct gm_view *view, size_t event);
    bool jumps; /* entries before and after each event, both at its time */
    bool again; /* uses the scheme to find the crossing, if it can repeat the step, of one member */
    bool each;  /* one section per member: these three functions read that of view->member alone */
    size_t bound;
    bool recent;
    bool is_state; /* of one member, an entry is the first `numbers` components */
    void (*record)(const struct gm_view *view, double *entry);
};

/* The settings of `geomint work-precision` for a scene; without them it takes the defaults and every scheme
   that fits. A reference run replaces a missing exact solution. With `resolution` each scheme is judged by
   its best pairs of step and resolution. */
struct gm_work {
    const char *arguments;      /* key=value that differ from the defaults, separated by blanks; "" */
    const char *measure;        /* key of the error at the end; NULL: distance from exact or reference
                                   state */
    double coarsest;            /* largest step of the ladder (0: four times the default) */
    int halvings;               /* halvings of the largest step */
    const char *const *schemes; /* the entrants, NULL-terminated; NULL: every scheme that fits */
    const char *reference;      /* scheme of the reference run; NULL: the highest order that fits */
    const char *is_exact;       /* scheme excluded, as exact, if the scene has an exact solution; NULL:
                                   none */
    const char *resolution;     /* key of a parameter varied with the step; NULL: none */
    const double *resolutions;  /* [resolution_count], from coarse to fine */
    size_t resolution_count;
    const char *ratio; /* key of a parameter that sets the step and replaces the ladder; NULL */
    /* The distance of a lane's state from that of `finer`, whose resolution is twice the finest, and whose
       step is half the shortest: the error instead of `measure`. NULL: the states of all lanes have one
       size */
    double (*distance)(const struct gm_lane *lane, const struct gm_lane *finer);
    const char *distance_title;
    const double *errors; /* three errors, falling, at which costs are compared; NULL: 1e-3, 1e-6, 1e-9 */
};

/* The settings of `geomint stability` for a scene: a grid of time steps and of one parameter. */
struct gm_stability {
    const char *arguments; /* key=value that differ from the defaults, separated by blanks; "" */
    const char *parameter; /* key of the parameter */
    const double *values;  /* [value_count] */
    size_t value_count;
    const char *label;                      /* label of the time step in units of `unit`: "h ω" */
    double (*unit)(const void *parameters); /* unit of the time step: the shortest time scale */
    const char *told;                       /* meaning of 1 / unit if it is computed numerically; NULL */
    const double *steps;                    /* [step_count], in units of `unit` */
    size_t step_count;
    const char *
        kept; /* key of the observable that is lost below half of its start, gained above twice; NULL: none */
    int64_t settle;             /* steps per window at start and end; compares maxima; 0: end to start */
    const char *error;          /* key of the observable that measures accuracy; NULL: none */
    bool throughout;            /* uses the largest error of the run instead of the last */
    const char *const *schemes; /* NULL-terminated; NULL: the scene's */
};

/* A published figure: the arguments that redo it. */
struct gm_figure {
    const char *name;      /* "razafindralandy-1" */
    const char *statement; /* claim of the document */
    const char *arguments; /* arguments of `geomint render SCENE`, separated by blanks */
};

/* A value for one of the scene's parameters, as it would be typed. */
struct gm_choice {
    const char *key;
    char value[40];
};
enum { GM_CHOICES = 4 };

/* The greatest number of observables of a scene, with those on request. */
enum { GM_MOST_OBSERVABLES = 160 };

struct gm_scene {
    const char *name, *title, *blurb, *watch;
    const char *time;    /* unit of time: "H²/ν" */
    size_t size;         /* size of the scene's own struct, which begins with struct gm_timing */
    const void *initial; /* own struct before its parameters are set; NULL: zeros */
    /* Words that define the scene, NULL-terminated, the first instead of a name; NULL: a built-in scene. */
    const char *const *words;
    const char *source; /* text of the file that defines the scene; NULL */
    const char *text;   /* text that defines the scene, typed or from a file; NULL */
    const char *room;   /* text of the room's file that defines the scene; NULL */
    const char *mark;   /* name with a checksum of the text; NULL: the name suffices */
    const struct gm_parameter *parameters;
    size_t parameter_count;
    /* A key that this problem has with other schemes alone, and the sentence on why; NULL: none. */
    const char *lacking, *lacking_why;
    const char *const *schemes; /* preferred order, NULL-terminated; others may fit */
    /* Schemes that replace the first of `schemes` if a word such as "show=frame" is typed and no scheme; ends
       with a NULL row. NULL: none. */
    const struct gm_preference {
        const char *word;
        const char *schemes[4]; /* ends with a NULL */
    } * preferences;
    /* The default lanes: key=value with lists, separated by blanks; NULL: the first schemes. */
    const char *lanes;
    const struct gm_observable *observables;
    size_t observable_count;
    /* Observables on request, numbered after the others: they take time, and are computed if their key is
       requested, or while a picture shows them. */
    const struct gm_observable *asked;
    size_t asked_count;
    /* The number of the first observables on request that the picture shows; NULL: none. */
    size_t (*asked_shown)(const struct gm_scene *scene, const void *parameters);
    const struct gm_track *tracks;
    size_t track_count;
    const struct gm_figure *figures;
    size_t figure_count;
    const struct gm_work *work;
    const struct gm_stability *stability; /* NULL: the scene has no such map */
    const char *no_stability;             /* reason why there is no map, and an alternative; NULL: unknown */
    int64_t follow; /* most steps between two observed steps, for `recalls`; 0: any number */

    /* The time at the start; NULL: 0. */
    double (*t0)(const void *parameters);
    /* The scene for these parameters, if the words of a choice make several scenes whose tables have the same
       rows; NULL: this scene. */
    const struct gm_scene *(*variant)(const void *parameters);
    /* The reason why the parameter of that key has no effect, NULL if it has one; no hook: all have one. */
    const char *(*idle)(const void *parameters, const char *key);
    /* Makes parameters agree that follow from others, after those of these keys were set. Returns false with
       a sentence if they contradict. NULL: none do. */
    bool (*settle)(void *parameters, const char *const *keys, size_t count, char *sentence);
    /* True if an unfit scheme fits the scene's text on another kind of grid: a word that requests it makes
       another scene. NULL: no other grid. */
    bool (*elsewhere)(const struct gm_scheme *scheme);
    /* Fills the problem (n, m, facets) for these parameters. Returns false with a sentence if they
       contradict. */
    bool (*setup)(const void *parameters, struct gm_problem *problem, char *sentence);
    /* Writes choices made with the problem into the lane's own copy; NULL: no choices. */
    void (*chosen)(const struct gm_problem *problem, void *parameters);
    /* False for a key that a scheme has no use for; NULL: each uses all. */
    bool (*takes)(const struct gm_scheme *scheme, const char *key);
    /* True if the files named by the parameters can be read; else false with a sentence. NULL: they name
       none. */
    bool (*readable)(const void *parameters, char *sentence);
    /* Writes a note on how the files were read, "" or a sentence; NULL: none. */
    void (*note)(const struct gm_problem *problem, const void *parameters, char *sentence);
    /* Frees the memory that setup has made for the problem; NULL: none. */
    void (*close)(struct gm_problem *problem);
    /* Writes the canonical state at t0 (n * m). */
    void (*start)(const void *parameters, const struct gm_problem *problem, double *y);
    /* Replaces start if the state depends on the scheme, or may not exist: then it returns false with a
       sentence. */
    bool (*start_with)(const void *parameters, const struct gm_problem *problem,
                       const struct gm_scheme *scheme, double *y, char *sentence);
    /* Writes one sentence, or "", on the step after a view, which led to a state that is not finite. NULL:
       never. */
    void (*failure)(const struct gm_view *view, char *text, size_t size);
    /* Opens the phase portrait of a lane (core/ode/portrait/portrait.h); the caller closes it if true is returned.
       False if the lane shows none, or when out of memory. NULL: the scene has no portraits. */
    bool (*portrait)(const struct gm_lane *lane, struct gm_portrait *portrait);
    /* Draws the lanes, count >= 1, into an empty picture, without changing them. */
    void (*draw)(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);
    /* Writes the parameters, at most GM_CHOICES, of a run that starts at the point (x, y) of a state's panel.
       Returns their number, 0 if impossible. NULL: the scene has no such points. */
    size_t (*point)(const void *parameters, double x, double y, struct gm_choice *choices);
    /* Writes profiles of a state as rows of CSV, each after `front`; NULL: the scene has no profiles. The
       columns are GM_PROFILE_COLUMNS. */
    void (*profile)(const struct gm_view *view, const char *front, FILE *stream);
};

#define GM_PROFILE_COLUMNS "profile,x,y,psi,u,v,theta,omega,reference"

/* Writes the title; an error has its formula: "energy error  |H − H₀| / max(|H₀|, 1/2)". Returns text. */
const char *gm_observable_title(const struct gm_observable *observable, char *text, size_t size);

/* The value of an observable in a view. */
double gm_observe(const struct gm_observable *observable, const struct gm_view *view);
/* True if two observables would share a name: they are equal, or one is KEY_max, as --max names the maximum
   of the other. */
bool gm_observables_clash(const char *key, const char *other);
/* The natural scale of an error. */
double gm_observable_scale(const struct gm_observable *observable, const struct gm_view *view);

/* Returns the scene's own struct with every parameter at its default. The caller frees; NULL when out of
   memory. */
void *gm_scene_defaults(const struct gm_scene *scene);

/* True if the key is among `keys`; for settle. */
bool gm_is_given(const char *key, const char *const *keys, size_t count);

/* Writes a value with three digits, the accuracy of a point in a picture. */
void gm_choose(struct gm_choice *choice, const char *key, double value);

size_t gm_scene_count(void);
/* The name and title of a scene; its file is not opened. */
const char *gm_scene_name(size_t index);
const char *gm_scene_title(size_t index);
/* The index of the scene of that name, or gm_scene_count(). */
size_t gm_scene_number(const char *name);
const struct gm_scene *gm_scene_at(size_t index);
const struct gm_scene *gm_scene_find(const char *name);
double gm_scene_t0(const struct gm_scene *scene, const void *parameters);
/* Returns the number of the scene's first section; its count of tracks without one. */
size_t gm_scene_section(const struct gm_scene *scene);
/* The number of the observable of that key, on request or not, or -1. */
int gm_scene_observable(const struct gm_scene *scene, const char *key);
/* The observable of that number; NULL after the last. */
const struct gm_observable *gm_scene_observable_at(const struct gm_scene *scene, size_t number);
/* The key of an observable, for proposals (core/expression/nearest.h); `scene` is a struct gm_scene. */
const char *gm_scene_observable_key(size_t number, const void *scene);
/* The reason why the parameter of that key has no effect: "the mesh comes from a file"; NULL if it has
   one. */
const char *gm_scene_idle(const struct gm_scene *scene, const void *parameters, const char *key);
/* The parameter of that key, or NULL. */
const struct gm_parameter *gm_scene_parameter(const struct gm_scene *scene, const char *key);

#endif
