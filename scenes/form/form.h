/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scene of a system of forms, for its own files. */
#ifndef GM_SCENES_FORM_FORM_H
#define GM_SCENES_FORM_FORM_H

#include "core/ode/user/forms.h"
#include "scenes/common/system/look.h"

enum { GM_MOST_FORM_OBSERVABLES = 64 };

/* The subject of an observable. */
struct gm_form_subject {
    enum { GM_FORM_ERROR, GM_FORM_CONTRADICTION, GM_FORM_REMAINDER, GM_FORM_OBSERVED, GM_FORM_FACT } what;
    size_t index; /* of a form, of what is observed, or of a fact */
};

struct gm_form_scene {
    struct gm_system_scene of_file; /* first: the scene is its first member */
    struct gm_form_model model;
    const char **shows; /* words of show=: named forms of the model, then "numbers" and "mesh" */
};

static inline const struct gm_form_scene *gm_form_scene_of(const void *parameters)
{
    return (const struct gm_form_scene *)((const struct gm_system_lane *)parameters)->owner;
}

/* True if a lane shows the numbers of a form, or the names of simplices, instead of colours. */
bool gm_form_shows_numbers(const struct gm_system_lane *lane);
bool gm_form_shows_names(const struct gm_system_lane *lane);
/* True if a mesh has more simplices than such a picture has room for, GM_MOST_NUMBERS. */
enum { GM_MOST_NUMBERS = 200 };
static inline bool gm_form_is_fine(const struct gm_complex *complex)
{
    return complex->vertices + complex->edges + complex->triangles > GM_MOST_NUMBERS;
}

void gm_form_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

/* The triangles of a mesh as they are seen, on a panel: of a surface in space those that face the eye, the farthest
   first; of a flat torus with images where they reach over a side. */
struct gm_form_sheet {
    struct gm_picture *picture;
    struct gm_panel *panel;
    const struct gm_complex *complex;
    bool flat;             /* in the plane */
    struct gm_space sight; /* the box of the mesh, and of a surface in space the directions */
    size_t count;
    size_t *triangle; /* numbers of triangles */
    double *corners;  /* 9 a triangle, in space */
    double *places;   /* 6 a triangle: its corners on the panel */
    size_t points;    /* places of vertices, of which a torus has images */
    int *point;       /* 3 a triangle: their numbers */
    double *light;    /* 3 a triangle, from 0 to 1; NULL in the plane */
    bool *hidden;     /* another triangle is before its middle */
};
/* Sets the panel's axes. */
void gm_form_sheet_make(struct gm_picture *picture, struct gm_panel *panel, const struct gm_complex *complex,
                        const struct gm_camera *camera, double t, struct gm_form_sheet *sheet);
/* Values at vertices, on triangles that share their points, without hidden ones. */
struct gm_form_surface {
    double *points, *values; /* 2 and 1 a point */
    int *triangles;          /* 3 points each */
    size_t count, triangle_count;
};
/* Makes it of the values at the corners of the complex' triangles, 3 each. */
struct gm_form_surface gm_form_surface_of(const struct gm_form_sheet *sheet, const double *values);
/* Draws arrows of vectors, 3 numbers a triangle of the complex, of which one of that length is as long as their
   distance: not more than fit. */
void gm_form_draw_arrows(const struct gm_form_sheet *sheet, struct gm_style style, const double *vectors,
                         double length);
/* Draws edges; with `outline` those with a triangle of the sheet on one side alone. */
void gm_form_draw_grid(const struct gm_form_sheet *sheet, struct gm_style style, bool outline);
/* Draws dual edges, and dots at dual vertices. */
void gm_form_draw_dual(const struct gm_form_sheet *sheet, struct gm_style style);
/* The place of the dual vertex of triangle i of the sheet. */
void gm_form_dual_place(const struct gm_form_sheet *sheet, size_t i, double place[2]);

/* Draws the numbers of a form with orientations on a small mesh; the names of simplices; or one simplex of
   each kind with its dual. */
void gm_form_draw_numbers(const struct gm_form_sheet *sheet, struct gm_form_type type, const double *form);
void gm_form_draw_names(const struct gm_form_sheet *sheet);
void gm_form_draw_duals(const struct gm_form_sheet *sheet);

#endif
