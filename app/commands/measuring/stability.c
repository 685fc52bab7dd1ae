/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint stability: which time step keeps which scheme bounded, and how it fails beyond; with --region the linear
   stability region, found by stepping. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/base/interrupt.h"
#include "app/commands/commands.h"
#include "app/grid/grid.h"
#include "app/output/row.h"
#include "app/words/names.h"
#include "core/arena.h"
#include "core/memory.h"
#include "core/ode/certify/linear_stability.h"

/* ---- the region ---- */

enum { SIDE = 121, LINE = 601 };

struct region {
    const struct gm_scheme *scheme;
    enum gm_linear_test test;
    double reach;     /* the plane: from -reach to reach; the oscillator: 0 to reach */
    double *measured; /* SIDE * SIDE, rows from the bottom; or LINE */
    double *known;    /* the same from the coefficients; NAN: not known */
    double limit;     /* the oscillator: stable up to this h w */
};

/* A symplectic map's eigenvalues stay on the circle but for rounding. */
static bool stable(double growth)
{
    return growth <= 1 + 1e-7;
}

static double place(const struct region *region, size_t i)
{
    return -region->reach + 2 * region->reach * (double)i / (SIDE - 1);
}

/* The number of steps to measure: a family with stored steps needs more than one. */
static int64_t steps_of(const struct gm_scheme *scheme)
{
    return scheme->family->not_resumable ? 24 : 1;
}

static void measure_plane(struct region *region)
{
    const struct gm_scheme *scheme = region->scheme;
    for (size_t r = SIDE / 2; r < SIDE && !gm_interrupted; r++) { /* a conjugate pair grows alike */
        for (size_t c = 0; c < SIDE; c++) {
            const double re = place(region, c), im = place(region, r);
            const size_t here = r * SIDE + c, there = (SIDE - 1 - r) * SIDE + c;
            region->measured[here] = region->measured[there] =
                gm_linear_growth(scheme, re, im, steps_of(scheme));
            region->known[here] = region->known[there] = gm_linear_growth_known(scheme, re, im);
        }
    }
}

static void measure_line(struct region *region)
{
    for (size_t i = 0; i < LINE && !gm_interrupted; i++) {
        const double w = region->reach * (double)i / (LINE - 1);
        region->measured[i] = i > 0 ? gm_linear_growth(region->scheme, 0, w, 1) : 1;
        region->known[i] = gm_linear_growth_known(region->scheme, 0, w);
    }
    region->limit = gm_linear_limit(region->scheme, 0, 1, region->reach, 1);
}

static void draw_plane(const struct region *region, struct gm_picture *picture)
{
    const struct gm_axis x = {
        .label = "Re z", .scale = GM_LINEAR, .low = -region->reach, .high = region->reach};
    const struct gm_axis y = {
        .label = "Im z", .scale = GM_LINEAR, .low = -region->reach, .high = region->reach};
    struct gm_panel *panel = gm_chart_panel(picture, GM_PLACE_STATE, region->scheme->title, &x, &y);
    panel->equal = true;
    panel->colour_bar = true;
    panel->colour_bar_label = "growth a step, log₁₀";
    double *values = gm_picture_memory(picture, (size_t)SIDE * SIDE * sizeof *values);
    double *points = gm_picture_memory(picture, (size_t)2 * SIDE * SIDE * sizeof *points);
    int *triangles = gm_picture_memory(picture, (size_t)6 * (SIDE - 1) * (SIDE - 1) * sizeof *triangles);
    size_t made = 0;
    bool known = true;
    for (size_t r = 0; r < SIDE; r++) {
        for (size_t c = 0; c < SIDE; c++) {
            const size_t i = r * SIDE + c;
            const double growth = region->measured[i];
            values[i] = isfinite(growth) ? fmax(-1, fmin(log10(fmax(growth, 1e-9)), 1)) : 1;
            points[2 * i] = place(region, c);
            points[2 * i + 1] = place(region, r);
            known &= isfinite(region->known[i]) || r == SIDE / 2;
            if (r + 1 < SIDE && c + 1 < SIDE) {
                const int corner = (int)i, above = (int)(i + SIDE);
                const int both[] = {corner, corner + 1, above, corner + 1, above + 1, above};
                memcpy(triangles + 3 * made, both, sizeof both);
                made += 2;
            }
        }
    }
    gm_mark_mesh(picture, panel, GM_MAP_DIVERGING, -1, 1, points, values, (size_t)SIDE * SIDE, triangles,
                 made);
    const double zero = 0;
    gm_mark_level_lines(picture, panel, (struct gm_style){GM_INK, 1, 2.6, GM_SOLID}, points, values,
                        (size_t)SIDE * SIDE, triangles, made, &zero, 1);
    if (known) {
        for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
            values[i] = fmax(-1, fmin(log10(fmax(region->known[i], 1e-9)), 1));
        }
        gm_mark_level_lines(picture, panel, (struct gm_style){GM_PAPER, 1, 1.6, GM_LONG_DASH}, points, values,
                            (size_t)SIDE * SIDE, triangles, made, &zero, 1);
    }
}

static void draw_line(const struct region *region, struct gm_picture *picture)
{
    const struct gm_axis x = {.label = "h ω", .scale = GM_LINEAR, .low = 0, .high = region->reach};
    const struct gm_axis y = {.label = "growth a step", .scale = GM_LINEAR, .low = 0, .high = 4};
    struct gm_panel *panel = gm_chart_panel(picture, GM_PLACE_GRAPH, region->scheme->title, &x, &y);
    panel->note = gm_picture_text(picture, "stable up to h ω = %.4g", region->limit);
    double points[2 * LINE];
    for (int known = 0; known < 2; known++) {
        for (size_t i = 0; i < LINE; i++) {
            points[2 * i] = region->reach * (double)i / (LINE - 1);
            points[2 * i + 1] = known ? region->known[i] : region->measured[i];
        }
        const struct gm_style style = known ? (struct gm_style){GM_INK, 1, 1.4, GM_SHORT_DASH}
                                            : (struct gm_style){gm_lane_role(0), 1, 3, GM_SOLID};
        gm_mark_line(picture, panel, style, points, LINE, false);
    }
}

static void draw_region(const void *data, struct gm_picture *picture)
{
    const struct region *region = data;
    picture->clock = "";
    picture->title = "Linear stability, found by stepping";
    picture->subtitle =
        region->test == GM_TEST_PLANE
            ? "y′ = z y with the step 1;  solid: growth 1, measured;  dashed: from the coefficients"
            : "q″ = −ω² q;  solid: spectral radius of a step, measured;  dashed: from the coefficients";
    if (region->test == GM_TEST_PLANE) {
        draw_plane(region, picture);
    } else {
        draw_line(region, picture);
    }
}

static bool write_region(const void *data, FILE *csv)
{
    const struct region *region = data;
    const bool plane = region->test == GM_TEST_PLANE;
    fprintf(csv, "scheme,re,im,growth,growth_known\n");
    for (size_t i = 0; i < (plane ? (size_t)SIDE * SIDE : LINE); i++) {
        struct gm_row row = {.stream = csv, .form = GM_ROW_CSV};
        gm_row_put(&row, "scheme %s, re %.9g, im %.9g, growth %.9g, growth_known %.9g", region->scheme->name,
                   plane ? place(region, i % SIDE) : 0,
                   plane ? place(region, i / SIDE) : region->reach * (double)i / (LINE - 1),
                   isfinite(region->measured[i]) ? region->measured[i] : NAN,
                   isfinite(region->known[i]) ? region->known[i] : NAN);
        fputc('\n', csv);
    }
    return true;
}

/* The limits of a region, its part of the picture, and the largest difference from the stability function; NAN:
   nothing was compared. */
static void print_limits(const struct region *region, bool json)
{
    const struct gm_scheme *scheme = region->scheme;
    const bool plane = region->test == GM_TEST_PLANE;
    const double reach = region->reach;
    const double left = plane ? gm_linear_limit(scheme, -1, 0, reach, steps_of(scheme)) : NAN;
    const double up = plane ? gm_linear_limit(scheme, 0, 1, reach, steps_of(scheme)) : region->limit;
    double apart = NAN;
    size_t inside = 0;
    for (size_t i = 0; plane && i < (size_t)SIDE * SIDE; i++) {
        inside += stable(region->measured[i]);
        if (isfinite(region->known[i]) && isfinite(region->measured[i]) && region->known[i] < 1e3) {
            apart = fmax(apart, fabs(region->known[i] - region->measured[i]));
        }
    }
    const double part = (double)inside / (SIDE * SIDE);
    if (gm_memory_was_short()) {
        return;
    }
    if (json) {
        struct gm_row row = gm_row_begin(stdout);
        gm_row_put(&row, "scheme %s, test %s, reach %.17g", scheme->name, plane ? "y' = z y" : "q'' = -w^2 q",
                   reach);
        if (plane) {
            gm_row_put(&row, "real_limit %.17g, imaginary_limit %.17g, stable_part %.17g, difference %.17g",
                       left, up, part, apart);
        } else {
            gm_row_put(&row, "limit %.17g", up);
        }
        gm_row_close(&row, "\n");
    } else if (!plane) {
        printf("%s: stable on the oscillator up to h ω = %.4g%s\n", scheme->name, up,
               up == reach ? " at least" : "");
    } else {
        printf("%s: stable for real z from -%.4g%s, for imaginary z up to %.4g%s; %.1f %% of the picture\n",
               scheme->name, left, left == reach ? " and below" : "", up, up == reach ? " and beyond" : "",
               100 * part);
        if (!isnan(apart)) {
            printf("largest difference from the stability function of its coefficients: %.1e\n", apart);
        }
    }
}

static int find_region(const struct gm_options *options)
{
    char name[128], message[GM_MESSAGE];
    int status = GM_EXIT_OK;
    struct region region = {
        .scheme = gm_scheme_sought(options->region, &status, message),
        .measured = gm_arena_take(options->arena, (size_t)SIDE * SIDE, sizeof *region.measured),
        .known = gm_arena_take(options->arena, (size_t)SIDE * SIDE, sizeof *region.known)};
    gm_command_end_if(options, !region.scheme, status, "%s", message);
    region.test = gm_linear_test_of(region.scheme);
    gm_command_end_if(options, region.test == GM_TEST_NONE, GM_EXIT_USAGE,
                      "%s takes neither y' = z y nor an oscillator: it has no linear stability region",
                      region.scheme->name);
    gm_catch_interrupts();
    region.reach = region.test == GM_TEST_PLANE ? 6 : 2 * M_PI;
    char own[41];
    snprintf(own, sizeof own, "%s", region.scheme->word ? region.scheme->title : "");
    for (char *at = own; *at; at++) {
        *at = isalnum((unsigned char)*at) ? *at : '-';
    }
    snprintf(name, sizeof name, "%s-stability", own[0] ? own : region.scheme->name);
    (region.test == GM_TEST_PLANE ? measure_plane : measure_line)(&region);
    if (!gm_options_take_stdout(options)) {
        print_limits(&region, options->json);
    }
    status = gm_command_chart(
        options, "stability",
        &(struct gm_chart){.name = name, .data = &region, .draw = draw_region, .write = write_region});
    return gm_interrupted ? GM_EXIT_INTERRUPTED : status;
}

int gm_command_stability(const struct gm_options *options)
{
    gm_command_end_if(options, options->region && options->arguments.count > 0, GM_EXIT_USAGE,
                      "--region takes a scheme alone, no scene");
    return options->region ? find_region(options) : gm_command_study(options, GM_STUDY_STABILITY);
}
