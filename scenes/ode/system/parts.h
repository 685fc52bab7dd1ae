/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the scene of a user-defined system, each in a file of its own. */
#ifndef GM_SCENES_ODE_SYSTEM_PARTS_H
#define GM_SCENES_ODE_SYSTEM_PARTS_H

#include "core/ode/portrait/portrait.h"
#include "scenes/common/graph.h"
#include "scenes/common/space.h"
#include "scenes/common/system/look.h"

/* ---- sights.c ---- */

/* Makes the sights, the section and the words of show=, with space for one more. */
void gm_system_make_sights(struct gm_system_scene *system_scene);

/* Opens the surfaces that the file names; refuses too many. */
void gm_system_open_surfaces(struct gm_system_scene *system_scene);

/* ---- curves.c ---- */

/* Returns true if the text is one of the words of show=, or t: with names of one of the file's systems; else false
   with a sentence. The row's `admitting` is the first of them. */
bool gm_system_admits_show(const struct gm_parameter *row, const char *text, char *sentence);

/* Returns true if the lane's own system has the names that the lane shows over time; else false with a sentence. */
bool gm_system_can_show(const struct gm_system_lane *lane, char *sentence);

/* Returns the sight that a lane shows, in the picture's memory if it is of names over time; NULL when out of
   memory. */
const struct gm_sight *gm_system_curves(struct gm_picture *picture, const struct gm_lane *lane);

/* Draws the current lane of a walk, whose sight is over time, into a panel whose axes are set; `now` are the
   numbers of the sight now. */
void gm_system_draw_curves(struct gm_picture *picture, struct gm_panel *panel, const struct gm_walk *walk,
                           const struct gm_paths *paths, const double *now);

/* ---- observed.c ---- */

/* Makes the observables. */
void gm_system_make_observables(struct gm_system_scene *system_scene, const struct gm_problem *problem);

/* Refuses an exact solution in the file that has not the system's start. */
void gm_system_check_exact(struct gm_system_scene *system_scene, const struct gm_problem *problem);

/* ---- space.c ---- */

/* The range of a sight up to now. */
struct gm_seen {
    double low[3], high[3]; /* for each coordinate; low > high: empty */
    double far;             /* the largest distance from the origin */
    bool left;              /* the lane has a scale of its own */
};

/* Sets the panel's axes and draws the parts at rest: surfaces with the axes through them, or else the box of
   the range. */
struct gm_space gm_system_space(struct gm_picture *picture, struct gm_panel *panel,
                                const struct gm_lane *lane, const struct gm_seen *seen,
                                const char *const names[3]);
/* Gives the space the surfaces of a lane. */
void gm_system_take_surfaces(struct gm_picture *picture, const struct gm_lane *lane, struct gm_space *space);

/* ---- shapes.c ---- */

/* Returns true if the members of a lane are a disc in the plane of a sight. */
bool gm_system_is_disc(const struct gm_lane *lane, const struct gm_sight *sight);

/* Draws the shape now and earlier ones; the first in red. The axes are set. */
void gm_system_draw_shapes(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane);

/* ---- levels.c ---- */

/* Refuses levels that contain more than the two names of their plane, parameters, values at the start and
   exact solutions. */
void gm_system_check_levels(struct gm_system_scene *system_scene);

/* Returns true if a sight shows levels. */
bool gm_system_has_level(const struct gm_system_scene *system_scene, const struct gm_sight *sight);

/* Adds the closed curves around a lane's start to its range; an open curve adds nothing. */
void gm_system_hold_levels(struct gm_picture *picture, const struct gm_lane *lane,
                           const struct gm_sight *sight, struct gm_seen *range);

/* Draws the lines on which a function changes its sign, from its values at the corners of a grid of cells over the
   panel, row by row from the lower left; none beside a value that is not finite. */
void gm_system_draw_zeros(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                          const double *values, const size_t cells[2]);

/* Draws the lane's curves into a panel whose axes are set. */
void gm_system_draw_levels(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                           const struct gm_sight *sight);

/* Returns the text that explains grey curves, "; grey: the exact orbit"; "" without one. */
const char *gm_system_level_text(struct gm_picture *picture, const struct gm_lane *const *lanes,
                                 size_t count);

/* ---- phase.c ---- */

/* Returns true if a system has a portrait; else false with a sentence. With another word of a choice a file may be
   another system, so this is about a lane's own. */
bool gm_system_is_plane(const struct gm_system_scene *system_scene, char *sentence);

/* Return true if a text is a value of portrait= for the system of the row, or of window=; else false with a
   sentence. */
bool gm_system_admits_portrait(const struct gm_parameter *row, const char *text, char *sentence);
bool gm_system_admits_window(const struct gm_parameter *row, const char *text, char *sentence);

/* Reads the lane's window of a sight's axes. Returns false if it is chosen by the picture. */
bool gm_system_window(const struct gm_system_lane *lane, const struct gm_sight *sight,
                      struct gm_window *window);

/* Returns true if a lane draws its portrait under a sight. */
bool gm_system_has_portrait(const struct gm_system_lane *lane, const struct gm_sight *sight);

/* The portrait in the lane's window, or in the box of its trajectory widened by a quarter: gm_scene, portrait. */
bool gm_system_portrait(const struct gm_lane *lane, struct gm_portrait *portrait);

/* Draws the portrait into a panel whose axes are set. */
void gm_system_draw_portrait(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane);

/* ---- aim.c ---- */

/* Sets the coordinates of a start with which the nearest moving body is at the point (x, y), or as near as
   possible; the momenta stay. Returns how many, at most GM_CHOICES; 0 if no body moves, more coordinates
   would change, or constraints hold them. `start`: the n current components. */
size_t gm_system_aim(const struct gm_system_lane *lane, const double *start, double x, double y,
                     struct gm_choice *choices);

/* ---- failure.c ---- */

/* Writes the fault at the view's last state or before the next one; "" if none is found. */
void gm_system_tell_failure(const struct gm_view *view, char *text, size_t size);

/* ---- draw.c ---- */

void gm_system_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

#endif
