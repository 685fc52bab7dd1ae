/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_LOOK_H
#define GM_SCENES_FLOW_LOOK_H

#include "render/picture/picture.h"
#include "scenes/flow/room_scene.h"

/* The parts of a room's picture other than the field. */
struct gm_look {
    /* The subtitle: real parameters by name and offset in struct gm_flows, if all lanes share them (else the
       panels show them); then mesh and scheme, and a remark. */
    struct {
        const char *name;
        size_t offset;
        const char *unit; /* NULL: none */
        bool nonzero;     /* it is left out if it is 0 */
    } told[2];
    const char *remark;     /* NULL: none */
    const char *clock_unit; /* the unit after the clock's time; "" */
    const char *axes[2];    /* labels of x and y of the field, if one lane is shown; NULL: none are drawn */
    double scalar_high;     /* the scalar's range */
    double temperature[2];  /* the range of the temperature */
    const char *names[GM_SHOW_TEMPERATURE + 1]; /* labels of the colours */
    double vorticity_range;                     /* the end of the colours */
    double speed_high;
    const char *const *sides; /* names of openings, by the number of their side; NULL: "inlet", "outlet" */
    const double *levels;     /* levels of psi; NULL: they are chosen by the flow through */
    size_t level_count;
    const char *graphs[2]; /* keys of observables */
    double graph_low[2], graph_high[2];
    bool profiles;       /* there are profiles to draw */
    bool profiles_below; /* they are below the field, if there are no graphs over time */
};

/* Sets the look that the lines of a lane's room describe. */
void gm_room_take_look(const struct gm_user_room *user_room, const struct gm_room *room,
                       struct gm_picture *picture, struct gm_look *look);
void gm_flows_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                   const struct gm_look *look);
/* Returns a part of a lane's text, for a picture. */
static inline const char *gm_room_text(struct gm_picture *picture, const struct gm_room *room,
                                       struct gm_span span)
{
    return gm_picture_text(picture, "%.*s", (int)(span.end - span.begin), room->system.source + span.begin);
}

/* Draws a panel for each quantity of the profiles, the exact one broad and grey, published points in red;
   writes rows of CSV. */
void gm_room_draw_profiles(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                           enum gm_place place);
void gm_room_write_profiles(const struct gm_view *view, const char *front, FILE *stream);

/* A mesh as it is drawn: refined if it is coarse, unfolded if it is a torus. */
struct gm_flow_sheet {
    const double *points, *psi, *field; /* field: NULL for none */
    const int *triangles;
    size_t vertices, count;
};
/* Makes the sheet in the picture's arena; psi and field are values at the vertices. False when out of
   memory. */
bool gm_flow_sheet_make(struct gm_picture *picture, const struct gm_complex *complex, const double *psi,
                        const double *field, struct gm_flow_sheet *sheet);

/* Marks over a field of colours, if `over`. `size`: the longer side of the domain. */

/* Returns true if the field that is shown has both signs. */
bool gm_flow_is_signed(int show);

/* Draws level lines of psi: at equal parts of the flow that passes through, and at the same distance in
   closed eddies. */
void gm_flow_draw_streamlines(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                              const struct gm_flow_sheet *sheet, const struct gm_look *look);
/* Draws the walls, bold; openings are left open. */
void gm_flow_draw_walls(struct gm_picture *picture, struct gm_panel *panel, const struct gm_flow *flow);
/* Draws the edges of the mesh. */
void gm_flow_draw_grid(struct gm_picture *picture, struct gm_panel *panel, const struct gm_complex *complex,
                       bool over);
/* Draws tracers: a dot each, and a tail to its position a short time ago. */
void gm_flow_draw_tracers(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                          bool over, double size);
/* Draws arrows of velocity on an even grid; one of `speed` is as long as their distance. */
void gm_flow_draw_arrows(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                         bool over, double speed);
/* Writes the names of openings, or "inlet" and "outlet", outside the walls. */
void gm_flow_name_openings(struct gm_picture *picture, struct gm_panel *panel, const struct gm_flow *flow,
                           const char *const *names, double size);

/* Sets `outward` to the way out through an opening, with its length, and `middle`. */
void gm_flow_opening_outward(const struct gm_flow *flow, const struct gm_opening *opening, double outward[2],
                             double middle[2]);

#endif
