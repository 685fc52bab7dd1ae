/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A form as what it is: a number on each vertex, edge or triangle of a small mesh, with the orientation that gives
   it its sign. Edges run from their lower to their higher vertex, triangles turn counter-clockwise, a dual edge
   crosses its edge from the right to the left. */
#include <math.h>
#include <string.h>

#include "core/functions/functions.h"
#include "scenes/form/form.h"

static const struct gm_style primal = {GM_LANE, 1, 1.6, GM_SOLID}, dual = {GM_INITIAL, 1, 1.6, GM_SOLID},
                             faint = {GM_SECONDARY, 0.55, 1, GM_SOLID};

static void draw_line(const struct gm_form_sheet *sheet, struct gm_style style, const double *points,
                      size_t count, bool closed)
{
    gm_mark_line(sheet->picture, sheet->panel, style, points, count, closed);
}

/* Draws the head of an arrow, with its middle at a place. */
static void draw_head(const struct gm_form_sheet *sheet, struct gm_style style, const double at[2], double dx,
                      double dy)
{
    const double tip[2] = {at[0] + dx / 2, at[1] + dy / 2}, back[2] = {at[0] - dx / 2, at[1] - dy / 2};
    const double head[6] = {back[0] - dy / 2, back[1] + dx / 2, tip[0],
                            tip[1],           back[0] + dy / 2, back[1] - dx / 2};
    style.width *= 1.4;
    draw_line(sheet, style, head, 3, false);
}

static void draw_dot(const struct gm_form_sheet *sheet, enum gm_role role, double width, const double at[2])
{
    gm_mark_points(sheet->picture, sheet->panel, (struct gm_style){.role = role, .alpha = 1, .width = width},
                   at, 1);
}

static void draw_text(const struct gm_form_sheet *sheet, enum gm_role role, double x, double y,
                      const char *text)
{
    gm_mark_text(sheet->picture, sheet->panel, (struct gm_style){.role = role, .alpha = 1, .width = 1}, x, y,
                 GM_ANCHOR_CENTRE, text);
}

/* A number to four digits; "v₁", "e₂", "f₃" without numbers. */
static const char *text_of(struct gm_picture *picture, const double *form, char letter, size_t i)
{
    static const char *const digits[] = {"₀", "₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈", "₉"};
    if (!form) {
        const size_t n = i + 1;
        return gm_picture_text(picture, "%c%s%s%s", letter, n > 99 ? digits[n / 100] : "",
                               n > 9 ? digits[n / 10 % 10] : "", digits[n % 10]);
    }
    const double value = fabs(form[i]) < 1e-13 ? 0 : form[i];
    return gm_picture_text(picture, "%s%.4g", value < 0 ? "−" : "", fabs(value));
}

/* One kind of simplices, or their duals. */
struct kind {
    size_t dimension;
    bool dual;
    const double *form; /* NULL: their names */
    double size;        /* of arrows */
};

/* The place of a corner, of the middle of the edge after it, or of the middle of its triangle. */
static void find_place(const struct gm_form_sheet *sheet, size_t dimension, size_t corner, double at[2])
{
    const double *p = sheet->places + 6 * (corner / 3), *from = p + 2 * (corner % 3),
                 *to = p + 2 * ((corner + 1) % 3);
    for (size_t c = 0; c < 2; c++) {
        at[c] = dimension == 0   ? from[c]
                : dimension == 1 ? (from[c] + to[c]) / 2
                                 : (p[c] + p[2 + c] + p[4 + c]) / 3;
    }
}

/* Draws the simplex of this number, on corner or edge k of a triangle of the sheet, or that triangle. */
static void draw_one(const struct gm_form_sheet *sheet, const struct kind *kind, size_t corner, size_t number)
{
    const double *p = sheet->places + 6 * (corner / 3), *from = p + 2 * (corner % 3),
                 *to = p + 2 * ((corner + 1) % 3);
    const enum gm_role role = kind->dual ? dual.role : GM_INK;
    const char *text = text_of(sheet->picture, kind->form, "vef"[kind->dimension], number);
    double at[2];
    find_place(sheet, kind->dimension, corner, at);
    if (kind->dimension == 2 && kind->dual) {
        gm_form_dual_place(sheet, corner / 3, at);
    }
    if (kind->dimension == 0 || (kind->dimension == 2 && kind->dual)) {
        draw_dot(sheet, role, 7, at);
        draw_text(sheet, role, at[0], at[1] + 0.7 * kind->size, text);
    } else if (kind->dimension == 1) {
        const double sign = sheet->complex->triangle_sign[3 * sheet->triangle[corner / 3] + corner % 3];
        const double x = to[0] - from[0], y = to[1] - from[1];
        const double scale = kind->size / 3 / fmax(gm_hypot(x, y), 1e-300), ahead = sign * 0.28;
        const double head[2] = {at[0] + (kind->dual ? 0 : ahead * x), at[1] + (kind->dual ? 0 : ahead * y)};
        draw_head(sheet, kind->dual ? dual : primal, head, scale * sign * (kind->dual ? -y : x),
                  scale * sign * (kind->dual ? x : y));
        /* the text interrupts its edge, or is beside its dual edge */
        const double aside = kind->dual ? 0.2 : 0;
        draw_text(sheet, kind->dual ? dual.role : primal.role, at[0] + aside * x, at[1] + aside * y, text);
    } else {
        enum { ARC = 25 };
        const struct gm_style style = {GM_LANE + 2, 1, 1.6, GM_SOLID};
        const double area = (p[2] - p[0]) * (p[5] - p[1]) - (p[4] - p[0]) * (p[3] - p[1]);
        const double round = 0.62 * sqrt(fabs(area) / 12), sense = area > 0 ? 1 : -1;
        double circle[2 * ARC];
        for (size_t n = 0; n < ARC; n++) {
            const double a = sense * (0.6 + 5 * (double)n / (ARC - 1));
            circle[2 * n] = at[0] + round * gm_cos(a);
            circle[2 * n + 1] = at[1] + round * gm_sin(a);
        }
        const double *end = circle + 2 * (ARC - 1), a = sense * 5.6, length = sense * kind->size / 4;
        draw_line(sheet, style, circle, ARC, false);
        draw_head(sheet, style, end, -length * gm_sin(a), length * gm_cos(a));
        draw_text(sheet, style.role, at[0], at[1], text);
    }
}

/* Draws each simplex of a kind once. */
static void draw_kind(const struct gm_form_sheet *sheet, struct kind kind)
{
    const struct gm_complex *complex = sheet->complex;
    const size_t count = complex->vertices + complex->edges + complex->triangles;
    const struct gm_panel *panel = sheet->panel;
    const double width = panel->x.high - panel->x.low, height = panel->y.high - panel->y.low;
    bool *drawn = gm_picture_memory(sheet->picture, count * sizeof *drawn);
    memset(drawn, 0, count * sizeof *drawn);
    kind.size = fmin(0.045 * fmax(width, height), 0.3 * complex->mean_edge);
    for (size_t i = 0; i < 3 * sheet->count; i++) {
        const size_t t = sheet->triangle[i / 3], k = i % 3;
        const size_t number = kind.dimension == 0   ? (size_t)complex->triangle[3 * t + k]
                              : kind.dimension == 1 ? (size_t)complex->triangle_edge[3 * t + k]
                                                    : t;
        if (!sheet->hidden[i / 3] && !drawn[number]) {
            drawn[number] = true;
            draw_one(sheet, &kind, i, number);
        }
    }
}

/* Makes room for what is beside the mesh, without axes. */
static void widen(struct gm_panel *panel)
{
    struct gm_axis *axes[2] = {&panel->x, &panel->y};
    const double room = 0.06 * fmax(panel->x.high - panel->x.low, panel->y.high - panel->y.low);
    for (size_t c = 0; c < 2; c++) {
        axes[c]->low -= room;
        axes[c]->high += room;
        axes[c]->label = "";
    }
    panel->axes = false;
}

void gm_form_draw_numbers(const struct gm_form_sheet *sheet, struct gm_form_type type, const double *form)
{
    const size_t dimension = (size_t)(type.dual ? 2 - type.degree : type.degree);
    widen(sheet->panel);
    gm_form_draw_grid(sheet, type.degree == 1 && !type.dual ? primal : faint, false);
    if (type.dual) {
        struct gm_style style = dual;
        style.alpha = 0.7;
        gm_form_draw_dual(sheet, style);
    }
    draw_kind(sheet, (struct kind){dimension, type.dual, form, 0});
}

void gm_form_draw_names(const struct gm_form_sheet *sheet)
{
    widen(sheet->panel);
    gm_form_draw_grid(sheet, primal, false);
    for (size_t k = 3; k-- > 0;) {
        draw_kind(sheet, (struct kind){k, false, NULL, 0});
    }
}

/* ---- one of each kind with its dual ---- */

/* The inner simplex that is nearest to parts of the panel's width and height. */
static size_t nearest_of(const struct gm_form_sheet *sheet, size_t dimension, double across, double up)
{
    const struct gm_complex *complex = sheet->complex;
    const struct gm_panel *panel = sheet->panel;
    const double width = panel->x.high - panel->x.low, height = panel->y.high - panel->y.low;
    double nearest = INFINITY;
    size_t chosen = 0;
    for (size_t i = 0; i < 3 * sheet->count; i++) {
        const size_t e = (size_t)complex->triangle_edge[3 * sheet->triangle[i / 3] + i % 3];
        double at[2];
        find_place(sheet, dimension, i, at);
        const double away =
            gm_hypot((at[0] - panel->x.low) / width - across, (at[1] - panel->y.low) / height - up);
        if (away < nearest && complex->edge_triangle[2 * e] >= 0 && complex->edge_triangle[2 * e + 1] >= 0) {
            nearest = away;
            chosen = i;
        }
    }
    return chosen;
}

void gm_form_draw_duals(const struct gm_form_sheet *sheet)
{
    const struct gm_complex *complex = sheet->complex;
    const struct gm_style bold[2] = {{primal.role, 1, 3.6, GM_SOLID}, {dual.role, 1, 3.6, GM_SOLID}},
                          pale[2] = {{.role = primal.role, .alpha = 0.25, .width = 1},
                                     {.role = dual.role, .alpha = 0.22, .width = 1}};
    widen(sheet->panel);
    gm_form_draw_grid(sheet, (struct gm_style){primal.role, 0.55, 1.2, GM_SOLID}, false);
    gm_form_draw_dual(sheet, (struct gm_style){dual.role, 0.45, 1.1, GM_SOLID});
    const size_t vertex = nearest_of(sheet, 0, 0.22, 0.5), edge = nearest_of(sheet, 1, 0.5, 0.6),
                 whole = nearest_of(sheet, 2, 0.68, 0.42);
    const int *corner = complex->triangle, v = corner[3 * sheet->triangle[vertex / 3] + vertex % 3],
              e = complex->triangle_edge[3 * sheet->triangle[edge / 3] + edge % 3];
    for (size_t i = 0; i < 3 * sheet->count; i++) {
        const size_t t = sheet->triangle[i / 3], before = 3 * (i / 3) + (i + 2) % 3;
        double kite[8]; /* the part of a corner's dual cell, from its first side to its second one */
        find_place(sheet, 1, i, kite);
        gm_form_dual_place(sheet, i / 3, kite + 2);
        find_place(sheet, 1, before, kite + 4);
        find_place(sheet, 0, i, kite + 6);
        if (corner[3 * t + i % 3] == v) {
            gm_mark_polygon(sheet->picture, sheet->panel, pale[1], kite, 4);
            draw_line(sheet, bold[1], kite, 3, false);
        }
        if (complex->triangle_edge[3 * t + i % 3] == e) {
            draw_line(sheet, bold[1], kite, 2, false);
        }
    }
    const double *p = sheet->places + 6 * (edge / 3), *from = p + 2 * (edge % 3),
                 *to = p + 2 * ((edge + 1) % 3), side[4] = {from[0], from[1], to[0], to[1]};
    double centre[2];
    gm_form_dual_place(sheet, whole / 3, centre);
    draw_line(sheet, bold[0], side, 2, false);
    gm_mark_polygon(sheet->picture, sheet->panel, pale[0], sheet->places + 6 * (whole / 3), 3);
    draw_line(sheet, bold[0], sheet->places + 6 * (whole / 3), 3, true);
    draw_dot(sheet, dual.role, 11, centre);
    find_place(sheet, 0, vertex, centre);
    draw_dot(sheet, primal.role, 11, centre);
}
