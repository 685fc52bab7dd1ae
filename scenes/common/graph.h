/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_GRAPH_H
#define GM_SCENES_COMMON_GRAPH_H

#include "scenes/common/lane.h"

/* Parts of the pictures of all scenes. `lanes` are count >= 1 lanes of one scene. */

/* Draws the clock, from the lane that is farthest. */
void gm_draw_clock(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count);

/* A time, as a fraction of pi if the step is one. */
const char *gm_time_text(struct gm_picture *picture, double t, double dt);

/* A time step, to four digits or as a fraction of pi. */
const char *gm_step_text(struct gm_picture *picture, double dt);

/* The time step that all lanes share, as ",  dt = 0.05"; "" if they differ. */
const char *gm_shared_step(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count);

/* The name of a lane's panel, and the end of its note: the failure of the run, or a lost conserved quantity
   (gm_lane_lost), else "". */
const char *gm_lane_title(const struct gm_lane *lane);
const char *gm_lane_failure(struct gm_picture *picture, const struct gm_lane *lane);

/* The value of an observable at the start. */
double gm_start_of(const struct gm_lane *lane, size_t series);

/* The title of an error's graph, with the divisor of the errors in these lanes. */
const char *gm_error_title(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                           size_t series);

/* The parameter trails= of scenes of orbits: which part of the past their pictures draw. */
extern const char *const gm_trails_words[];
/* Returns true if the text is yes, no or a time above 0, else false with a sentence. */
bool gm_trails_admit(const struct gm_parameter *row, const char *text, char *sentence);
/* Returns the first of the entries that is drawn at time t. */
size_t gm_trails_from(const char *text, const struct gm_entries *entries, double t);
/* The row of the member `trails`, a char[GM_TEXT_SIZE]. */
#define GM_TRAILS_ROW(own)                                                                                   \
    GM_TEXT_ROW(own, trails, "trails", "yes", "paths of the past: yes, no, or those of the last time T",     \
                .choices = gm_trails_words, .admits = gm_trails_admit, .live = true, .looks = true)

/* Draws a fading line through the recent past: `points` are count pairs, the newest last. */
void gm_draw_trail(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                   const double *points, size_t count);

/* Writes the points of an arrow around a place, with a NaN after its shaft and after its head. */
void gm_arrow(double x, double y, const double along[2], double points[14]);

/* A number as 2.4·10⁻⁴. */
const char *gm_power_text(struct gm_picture *picture, double value);

/* The number of different schemes of the lanes: "two schemes". */
const char *gm_counted_schemes(const struct gm_lane *const *lanes, size_t count);

/* The colour and dash of a lane. */
struct gm_style gm_lane_style(const struct gm_lane *lane, double alpha, double width);

/* One past the highest panel number of the lanes. */
size_t gm_panel_count(const struct gm_lane *const *lanes, size_t count);

/* Iterates over the lanes panel by panel:
       for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) */
struct gm_walk {
    const struct gm_lane *const *lanes;
    size_t count;
    const struct gm_lane *lane; /* current lane */
    bool first;                 /* the current lane is the first of its panel */
    size_t panel, next;         /* next panel, and the next lane to test for it */
    bool begun;
};
bool gm_walk_next(struct gm_walk *walk);

/* Adds the panel of a state with the name and colour of the current lane. Its note is gm_lane_failure, or
   else `otherwise`; lanes that share the panel are named instead. */
struct gm_panel *gm_walk_panel(struct gm_picture *picture, const struct gm_walk *walk, const char *otherwise);

/* True if all lanes have the time step, or the scheme, of the first. */
bool gm_one_step(const struct gm_lane *const *lanes, size_t count);
bool gm_one_scheme(const struct gm_lane *const *lanes, size_t count);

/* True if no other lane is in the panel of this one. */
bool gm_lane_is_alone(const struct gm_lane *const *lanes, size_t count, const struct gm_lane *lane);

/* A time axis for the histories of these lanes. */
void gm_time_axis(struct gm_axis *axis, const struct gm_lane *const *lanes, size_t count);

/* Draws a thin line in the lane's colour at each switch of its scheme, at a panel's time axis: x, or y if
   time runs `upwards`. The axes are set. */
void gm_mark_switches(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                      bool upwards);

/* The style of an observable's graph over time. */
struct gm_graph {
    const char *observable;     /* key of the observable */
    const char *title;          /* NULL: the observable's */
    bool relative;              /* divided by its value at the start */
    bool magnitude;             /* draws the absolute value */
    bool highest;               /* draws the greatest values alone, if there are too many to distinguish */
    enum gm_scale scale;        /* GM_LOG: zeros are gaps; a round-off line if the range comes near it */
    double calm_low, calm_high; /* least range shown; equal: none */
    const char *time_label;     /* label of the time axis; NULL: "t" */
    double time_unit;           /* unit of the time axis; 0: 1 */
    bool to_last;               /* ends the time axis at the last value, and reports it */
    double floor;               /* log: values below it are left out, such as the first ones; 0: none */
    const struct gm_lane *panel_of; /* lane whose panel is drawn; NULL: all */
    bool named;                     /* names lanes under the title, if no panel has their names */
};

/* An observable that shares a graph with others of its lane, each in its own colour. */
struct gm_together {
    const char *observable; /* key of the observable */
    const char *name;       /* name in the graph */
};
/* Adds a graph for each lane, with equal logarithmic axes. An observable without values is not named, and the
   note under the graph's title gives the reason. */
void gm_draw_together(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                      const struct gm_together *together, size_t together_count);

/* Returns the number of the observable that a picture needs. If the scene lacks that key, adds an empty graph
   whose title begins with GM_NO_OBSERVABLE, and returns -1. */
#define GM_NO_OBSERVABLE "no observable "
int gm_asked_series(struct gm_picture *picture, const struct gm_scene *scene, const char *key);

/* The colour of line number `index`. */
struct gm_style gm_chart_style(size_t index);

/* A line with its points, and its name among the panel's keys; without points it draws nothing. */
void gm_chart_line(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                   const double *points, size_t count, const char *name);

/* Adds graphs of the lanes' histories. */
void gm_draw_graphs(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                    const struct gm_graph *graphs, size_t graph_count);

#endif
