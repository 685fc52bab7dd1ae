/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_GRID_GRID_H
#define GM_APP_GRID_GRID_H

#include "app/base/arguments.h"
#include "app/grid/sweep.h"
#include "app/output/row.h"
#include "app/words/request.h"
#include "core/ode/backward/modified_energy.h"
#include "scenes/common/graph.h"

/* A grid of runs: a scene, its words, axes of step sizes, values and schemes, and a measurement for each
   run. Four presets give the measurement: the cost of an accuracy, the stable steps, the modified
   Hamiltonians that schemes conserve, and the table of a sweep. */

enum gm_study_kind {
    GM_STUDY_NONE,
    GM_STUDY_WORK,
    GM_STUDY_STABILITY,
    GM_STUDY_BACKWARD,
    GM_STUDY_SWEEP,
    GM_STUDY_COUNT
};

enum gm_cell_verdict {
    GM_BOUNDED, /* or accurate, if that was asked */
    GM_LOST,    /* the conserved quantity fell below half of its start */
    GM_GAINED,  /* the conserved quantity rose above twice its start */
    GM_WRONG,   /* bounded but not accurate, if accuracy was asked */
    GM_FAILED,  /* ended with a status */
};

enum { GM_POWERS = GM_MODIFIED_POWER + 1 };

/* A run. */
struct gm_grid_cell {
    const struct gm_lane_spec *spec; /* the run's lane in the request; scheme, value and step size differ */
    double value;                    /* the value of the grid's parameter */
    double step;                     /* the ladder's step: dt, in the plan's unit, or a value of `ratio` */
    double resolution;               /* the value, or its reciprocal if smaller is finer */
    bool tried;                      /* the following fields are set */
    enum gm_status status;
    double dt, t; /* the step size, and the time reached, in model time */
    int64_t steps;
    double seconds; /* CPU time, the best of several runs; INFINITY: no run came to its end */
    double evaluations, solves;
    double error; /* NAN: unknown, or the run failed */
    double ratio; /* the conserved quantity divided by its start; NAN: unknown */
    enum gm_cell_verdict verdict;
    /* With the truncation after dt^k: the largest |H~(y_n) - H~(y_0)| at the sampled steps, and the
       largest |dt^k H_k| of the terms, both divided by the divisor of the energy error. */
    double errors[GM_POWERS], terms[GM_POWERS];
    int best; /* the k with the smallest error */
    /* If terms continue as the last two known ones, k! (dt / gamma)^k, they are smallest at k = gamma /
       dt, and the rest drifts by exp(-gamma / 2 dt) in the time exp(gamma / 2 dt). Hairer, Lubich & Wanner
       (2006), IX.8. NAN if fewer than two are known. */
    double gamma;
};

enum gm_cost { GM_COST_SECONDS, GM_COST_EVALUATIONS, GM_COST_RESOLUTION, GM_COST_COUNT };

/* The runs of one scheme. */
struct gm_grid_line {
    const struct gm_scheme *scheme;
    struct gm_grid_cell *cells;
    size_t count;
    char reason[GM_MESSAGE]; /* the reason for missing numbers; "": see the statuses */
    bool ended;              /* no lane can be opened */
    /* The cells, by rising cost, for which no other has a smaller error and cost; NULL unless the
       resolution varies. */
    struct gm_grid_cell *front[GM_COST_COUNT];
    size_t front_count[GM_COST_COUNT];
    struct gm_grid_cell *credited; /* scratch for the fronts */
    /* The slopes of modified energies at the two smallest steps with errors above round-off, or NAN; and
       true for powers with a term that does not vanish. */
    double orders[GM_POWERS];
    bool shown[GM_POWERS];
};

/* The values of an axis, which are different. */
struct gm_grid_axis {
    double *values;
    size_t count;
};

struct gm_study_row;

struct gm_grid {
    struct gm_arena *arena;    /* owns the memory of the others */
    struct gm_request request; /* its first lane has the common parameters */
    const struct gm_study_row *row;
    const struct gm_arguments *typed; /* a scene and its key=value, while the grid is opened */
    const char *requested;            /* the requested measure or judge; NULL: the scene's */
    struct gm_grid_line *lines;
    size_t count;
    size_t begun;                         /* number of lines that are shown: measured or being measured */
    const struct gm_parameter *parameter; /* the parameter that varies beside step and scheme, or NULL */
    struct gm_grid_axis steps, values;
    const struct gm_listener *listener; /* the listener of a running measurement */
    size_t jobs;                        /* number of parallel runs; 0: one per core */

    /* stability */
    const struct gm_stability *plan;
    double accuracy; /* the largest error that is accurate; INFINITY: only boundedness is judged */

    /* work-precision */
    char settings[160];  /* the words that set parameters which all runs share: "viscosity=0.05" */
    bool best;           /* the most promising built-in schemes are added */
    bool best_is_none;   /* no such scheme was found */
    const char *measure; /* "solution_error" or an observable's key */
    bool observed;       /* it is the observable, not the distance of the states */
    const char *measure_title;
    char reference[96]; /* the reference of the error, in words */
    const struct gm_scheme
        *trusted; /* the scheme of the reference run, which has this step; NULL: the solution is exact */
    double reference_step, reference_error; /* the error: 0 if it is not known */
    struct gm_lane *finer; /* the reference run, if the scene measures distances from it; else NULL */
    double *solution;      /* the reference state for differences, or NULL */
    bool smaller_is_finer; /* true for a parameter such as the distance of nodes */
    const struct gm_parameter *ratio; /* the ladder has its values instead of steps; NULL: steps */
    const double *errors;             /* 3 falling errors, at which schemes are compared */

    /* sweep */
    struct gm_sweep sweep;
    int table; /* a file without a name */
    struct gm_sweep_chart *chart;
};

/* The properties and functions of a kind. */
struct gm_study_row {
    const char *name; /* the name of its command */
    int refusal;      /* the exit status if nothing can be measured */
    void (*draw)(const struct gm_grid *grid, struct gm_picture *picture);
    /* The words of the run that panel number `panel` shows at (x, y), the scene first; malloc'ed. NULL if
       it shows none, and for a kind without runs. Can be called in any thread, also during the
       measurement. */
    char *(*pick)(const struct gm_grid *grid, size_t panel, double x, double y);

    /* ---- kinds without cells, NULL for the others; on a failure the first two leave the body of the grid's
       arena, with a sentence ---- */
    void (*open)(struct gm_grid *grid);
    void (*measure)(struct gm_grid *grid);
    bool (*write)(const struct gm_grid *grid, FILE *table);

    /* ---- kinds with cells, when they are opened, in the body of the grid's arena ---- */
    const char *which; /* the question, for a message without a scene */
    size_t schemes;    /* number of the scene's preferred schemes if none is given */
    /* The words unless overridden. */
    const char *(*usual)(struct gm_grid *grid, const struct gm_scene *scene);
    /* Changes the words before they are read; NULL: nothing. */
    void (*edit)(struct gm_grid *grid, struct gm_arguments *words);
    /* Fills axes, lines and cells; `words` are all, among them those typed. */
    void (*lay_out)(struct gm_grid *grid, const struct gm_arguments *words);

    /* ---- of gm_grid_measure, in a body of the arena ---- */
    bool alone; /* timed runs, one after the other; a lane that cannot be opened ends only its line */
    /* Makes the reference of the runs; NULL: none. */
    void (*prepare)(struct gm_grid *grid);
    /* Returns true if a cell is of no use after those before it; NULL: all are of use. */
    bool (*is_needless)(const struct gm_grid *grid, const struct gm_grid_line *line, size_t cell);
    /* Makes the run of an open lane and fills its cell, in any thread; a message is the reason for missing
       numbers. */
    void (*run)(const struct gm_grid *grid, struct gm_lane *lane, struct gm_grid_cell *cell, char *message);
    /* Computes the results of a line, after each of its cells; NULL: none. */
    void (*conclude)(const struct gm_grid *grid, struct gm_grid_line *line);

    /* ---- the output of kinds with cells ---- */
    void (*print)(const struct gm_grid *grid); /* a table */
    const char *cells;                         /* the key of a line's cells in JSON */
    /* Put what JSON has before and, unless it is NULL, after them. */
    void (*put_front)(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line);
    void (*put_end)(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line);
    bool ordered; /* the scheme's order is a column */
    int rows;     /* rows per cell in CSV; `number` is one of them */
    void (*put_cell)(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_cell *cell,
                     int number);
};
extern const struct gm_study_row *const gm_study_rows[GM_STUDY_COUNT]; /* NULL: GM_STUDY_NONE */

/* The parameters that all lanes share. */
struct gm_timing *gm_grid_timing(const struct gm_grid *grid);

/* The kind with that name, or GM_STUDY_NONE. */
enum gm_study_kind gm_study_find(const char *name);

/* Reads the words: a scene and its key=value. `measure`: the key of an observable or, for stability, the
   judge of a step; NULL: the scene's. Returns false with a sentence (GM_MESSAGE bytes); only
   request.refusal is then set. */
bool gm_grid_open(struct gm_grid *grid, enum gm_study_kind kind, const struct gm_arguments *arguments,
                  const char *measure, char *message);
/* Makes the runs; after a stop the others stay untried. Returns false with a sentence. */
bool gm_grid_measure(struct gm_grid *grid, const struct gm_listener *listener, char *message);
void gm_grid_close(void *grid);

/* Functions of a gm_chart; `grid` is a struct gm_grid. Fill an empty picture; write the cells as CSV. */
void gm_grid_draw(const void *grid, struct gm_picture *picture);
bool gm_grid_write(const void *grid, FILE *table);

/* Prints the results: a table, or a line of JSON for every line of the grid. */
void gm_grid_print(const struct gm_grid *grid, bool json);

/* ---- verdicts of stability ---- */

/* The question in a sentence: "bounded", "accurate to 0.01 (position_error)". Returns text. */
const char *gm_stability_question(const struct gm_grid *grid, char *text, size_t size);

/* The verdict, "lost", ... or the status' name; and a letter for the map. */
const char *gm_cell_word(const struct gm_grid *grid, const struct gm_grid_cell *cell);
char gm_cell_letter(const struct gm_grid_cell *cell);

/* The largest step, in the plan's unit, up to which a scheme passes for all values; 0 if it never does.
   NAN if untried cells leave it open. */
double gm_stability_limit(const struct gm_grid *grid, const struct gm_grid_line *line);

/* ---- costs of work-precision ---- */

/* Copies to `best`, of `count` places, the cells that are cheaper than all that are as accurate, by rising
   cost. Returns their number. */
size_t gm_work_keep_best(const struct gm_grid_cell *cells, size_t count, enum gm_cost cost,
                         struct gm_grid_cell *best);

/* The cost of a scheme at this error, interpolated between two cells of its front; NAN if it does not
   reach it. */
double gm_work_price(const struct gm_grid_line *line, double error, enum gm_cost cost);

/* The line that is cheapest at this error; NULL if none reaches it. */
const struct gm_grid_line *gm_work_cheapest(const struct gm_grid *grid, double error, enum gm_cost cost);

/* ---- panels, lines and cells of the pictures of grids ---- */

/* A panel with axes. */
struct gm_panel *gm_chart_panel(struct gm_picture *picture, enum gm_place place, const char *title,
                                const struct gm_axis *x, const struct gm_axis *y);

/* The count + 1 edges of the cells around `count` >= 1 values in rising order: halfway between them, on the axis'
   scale. Returns the axis. */
struct gm_axis gm_chart_edges(const char *label, const double *values, size_t count, bool logarithmic,
                              double *edges);

/* ---- one scheme on a system ---- */

/* Certifies a scheme, the first of the typed words, on a scene or a system with the others, key=value, from the
   start of the first member. Called in a body of the arena, which closes what the certificate points to; leaves it
   with a sentence and an exit status. */
struct gm_certificate;
struct gm_certificate gm_certify_words(struct gm_arena *arena, const char *system,
                                       const struct gm_arguments *typed, int *status);

/* The common functions of the kinds of grids, and the kinds. */

/* ---- layout ---- */

/* The `open` of kinds that have cells. */
void gm_cells_open(struct gm_grid *grid);
/* Adds a value that is not there yet. */
void gm_axis_add(struct gm_grid_axis *axis, double value);
/* The line of a scheme, or NULL. */
struct gm_grid_line *gm_grid_find(const struct gm_grid *grid, const struct gm_scheme *scheme);
/* Adds a line with room for `most` cells. */
struct gm_grid_line *gm_grid_add(struct gm_grid *grid, const struct gm_scheme *scheme, size_t most);

/* ---- runs ---- */

/* A lane at its start, which takes the malloc'ed parameters, or NULL when out of memory. Returns NULL with
   a sentence. */
struct gm_lane *gm_grid_start(const struct gm_grid *grid, const struct gm_lane_spec *spec,
                              struct gm_timing *parameters, const struct gm_scheme *scheme, char *message);

/* The lane of a cell at its start, with its own parameters; sets the cell's dt. Returns NULL with a
   sentence. */
struct gm_lane *gm_grid_open_lane(const struct gm_grid *grid, const struct gm_scheme *scheme,
                                  struct gm_grid_cell *cell, char *message);

/* Returns true if a lane has reached neither `steps` steps nor its end, and no stop is requested. */
bool gm_grid_goes_on(const struct gm_grid *grid, const struct gm_lane *lane, int64_t steps);

/* Advances to `steps` steps in all, or to the end of an adaptive scheme, in bursts that answer an
   interruption; gives up after `most` seconds of CPU time. Returns the seconds used. */
double gm_grid_advance(const struct gm_grid *grid, struct gm_lane *lane, int64_t steps, double most);

/* Notes the end of a run, and its costs except the time. */
void gm_grid_take_end(const struct gm_lane *lane, struct gm_grid_cell *cell);

size_t gm_grid_cells(const struct gm_grid *grid);

/* ---- the kinds ---- */

extern const struct gm_study_row gm_study_work, gm_study_stability, gm_study_backward, gm_study_sweep;

/* ---- tables ---- */

/* Prints a cell of a table, with a dash as wide as the number for one that is not finite. */
__attribute__((format(printf, 1, 0))) void gm_print_number(const char *format, int width, double value);

/* ---- work-precision ---- */

void gm_work_draw(const struct gm_grid *grid, struct gm_picture *picture);
void gm_work_print(const struct gm_grid *grid);
void gm_work_put_front(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line);
void gm_work_put_end(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line);

#endif
