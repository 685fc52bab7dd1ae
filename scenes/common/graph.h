/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_GRAPH_H
#define GM_SCENES_COMMON_GRAPH_H

#include "scenes/common/lane.h"

/* What the pictures of all scenes have in common. `lanes` are count >= 1 lanes of one scene. */

/* The clock of the picture, from the first lane. */
void gm_draw_clock(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count);

/* A time, as a fraction of pi where the step is one. */
const char *gm_time_text(struct gm_picture *picture, double t, double dt);

/* A time step, to four digits or as a fraction of pi. */
const char *gm_step_text(struct gm_picture *picture, double dt);

/* The name of a lane's panel, and what its note ends with: how it stands if it has failed, what it has lost
   of what the exact motion keeps (gm_lane_lost), else "". */
const char *gm_lane_title(const struct gm_lane *lane);
const char *gm_lane_failure(struct gm_picture *picture, const struct gm_lane *lane);

/* The title of an error's graph, with what it is divided by in these lanes. */
const char *gm_error_title(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                           size_t series);

/* A recent past as a line that fades: `points` are count pairs, the newest last. */
void gm_draw_trail(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                   const double *points, size_t count);

/* A number as 2.4·10⁻⁴. */
const char *gm_power_text(struct gm_picture *picture, double value);

/* "two schemes": how many different ones the lanes have. */
const char *gm_counted_schemes(const struct gm_lane *const *lanes, size_t count);

/* The colour and dash of a lane. */
struct gm_style gm_lane_style(const struct gm_lane *lane, double alpha, double width);

/* One past the highest panel number of the lanes. */
size_t gm_panel_count(const struct gm_lane *const *lanes, size_t count);

/* Goes through the lanes panel by panel:
       for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) */
struct gm_walk {
    const struct gm_lane *const *lanes;
    size_t count;
    const struct gm_lane *lane; /* where it is, */
    bool first;                 /* and whether its panel begins with it */
    size_t panel, next;         /* what comes next: that panel's lanes from number `next` on */
    bool begun;
};
bool gm_walk_next(struct gm_walk *walk);

/* Adds the panel of a state with the name and colour of the lane that it begins with. Its note says how the
   lane stands (gm_lane_failure), or else `otherwise`; lanes that share it are named in place of that. */
struct gm_panel *gm_walk_panel(struct gm_picture *picture, const struct gm_walk *walk, const char *otherwise);
/* Whether all lanes of the panel have left what is shown of the others: it has a scale of its own. */
bool gm_walk_has_left(const struct gm_walk *walk, bool (*has_left)(const struct gm_lane *lane));

/* Whether all lanes have the time step of the first. */
bool gm_one_step(const struct gm_lane *const *lanes, size_t count);

/* A time axis for the histories of these lanes. */
void gm_time_axis(struct gm_axis *axis, const struct gm_lane *const *lanes, size_t count);

/* A thin line in the lane's colour where a scheme took over in flight, over a panel's time axis: x, or y
   where time runs `upwards`. The axes are set. */
void gm_mark_switches(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                      bool upwards);

/* How an observable is drawn over time. */
struct gm_graph {
    const char *observable;     /* its key */
    const char *title;          /* NULL: the observable's */
    bool relative;              /* divided by its value at the start */
    bool magnitude;             /* its absolute value */
    bool highest;               /* the greatest values only, where there are too many to tell apart */
    enum gm_scale scale;        /* GM_LOG: zeros are gaps; a round-off line where the range comes near it */
    double calm_low, calm_high; /* the range shown at least; equal: none */
    const char *time_label;     /* of the time axis; NULL: "t" */
    double time_unit;           /* that its values are told in; 0: 1 */
    bool to_last;               /* the time axis ends where the values do, not where the run does; says so */
    double floor; /* log: values below are left out, such as those of the first steps; 0: none */
    const struct gm_lane *panel_of; /* only this lane and those of its panel; NULL: all */
    bool named;                     /* lanes are named under the title, where no panel carries their names */
};

/* Observables of one lane that are drawn in one graph, each in a colour of its own. */
struct gm_together {
    const char *observable; /* its key */
    const char *name;       /* in the graph */
};
/* Adds a graph for each lane, on logarithmic axes that are the same for all; where an observable has no value
   its name is left out, and the note under the graph's title says why. */
void gm_draw_together(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                      const struct gm_together *together, size_t together_count);

/* The number of the observable that a picture asks for, -1 where the scene has none of that key: then an
   empty graph says so in its title, which begins with GM_NO_OBSERVABLE. */
#define GM_NO_OBSERVABLE "no observable "
int gm_asked_series(struct gm_picture *picture, const struct gm_scene *scene, const char *key);

/* Adds graphs of the lanes' histories. */
void gm_draw_graphs(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                    const struct gm_graph *graphs, size_t graph_count);

#endif
