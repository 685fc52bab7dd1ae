/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The flows between two walls, couette and poiseuille: a unit square with psi, and theta = y, given all
   round. */
#include "scenes/flow/shear.h"

#include <math.h>

const struct gm_look_error gm_shear_errors[] = {
    {"psi_error", "ψ"},
    {"theta_error", "θ"},
    {"flux_error", "flux"},
    {"velocity_error", "velocity"},
    {"pressure_error", "total pressure"},
    {NULL, NULL},
};

static const double edges[] = {6, 12, 24, 48, 96}, errors[] = {1e-2, 1e-3, 1e-4};

const struct gm_work gm_shear_work = {
    .arguments = "until=1",
    .measure = "psi_error",
    .coarsest = 0.2,
    .halvings = 4,
    .resolution = "rows",
    .resolutions = edges,
    .resolution_count = GM_COUNT(edges),
    .errors = errors,
};

static bool make(const struct gm_flows *own, const struct gm_shear *shear, struct gm_flow **made,
                 char *sentence)
{
    struct gm_rectangle rectangle = {
        .width = 1, .height = 1, .edges = own->rows, .strips = own->columns, .irregular = own->irregular};
    struct gm_complex *complex = gm_flows_rectangle(&rectangle, sentence);
    struct gm_flow *flow = complex ? gm_flow_open(complex) : NULL;
    if (!flow) {
        if (complex) {
            snprintf(sentence, GM_SENTENCE, "not enough memory");
        }
        return false;
    }
    for (size_t b = 0; b < complex->boundary; b++) {
        const int v = complex->boundary_vertex[b];
        const double z = complex->point[2 * v + 1];
        double middle[2];
        gm_flows_middle(complex, b, middle);
        flow->kind[v] = GM_VERTEX_FIXED;
        flow->psi[v] = shear->psi(z);
        flow->theta_fixed[v] = true;
        flow->theta[v] = z;
        /* a wall that moves to the right drags counter-clockwise at the bottom, clockwise on top */
        const double drag = middle[1] == 0 ? shear->velocity(0) : middle[1] == 1 ? -shear->velocity(1) : 0;
        for (int k = 0; k < 2; k++) {
            flow->sheet[complex->edge[2 * complex->boundary_edge[b] + k]] +=
                drag * complex->length[complex->boundary_edge[b]] / 2;
        }
    }
    flow->viscosity = flow->diffusivity = 1 / own->reynolds;
    flow->reynolds = own->reynolds;
    flow->time_unit = own->reynolds;
    flow->speed = 1;
    flow->scalar = true;
    flow->tracers = (size_t)own->tracers;
    *made = flow;
    return true;
}

bool gm_shear_setup(const void *parameters, const struct gm_shear *shear, const char *name,
                    struct gm_problem *problem, char *sentence)
{
    struct gm_flow *flow = NULL;
    if (!make(parameters, shear, &flow, sentence)) {
        return false;
    }
    gm_flows_problem(problem, flow, name);
    return true;
}

static void draw_profile(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                         enum gm_place place, const struct gm_profile *line, bool scalar,
                         double (*exact)(double), const char *label)
{
    enum { POINTS = 65 };
    struct gm_panel *panel = gm_panel_add(picture, place, "");
    double points[2 * POINTS];
    panel->axes = true;
    panel->x = (struct gm_axis){.label = label, .low = 1, .high = 0};
    panel->y = (struct gm_axis){.label = "y", .low = line->a[1], .high = line->b[1]};
    for (int drawn = 0; drawn < 2; drawn++) {
        for (size_t i = 0; exact && i < POINTS; i++) {
            const double z = line->a[1] + (line->b[1] - line->a[1]) * (double)i / (POINTS - 1);
            points[2 * i] = exact(z);
            points[2 * i + 1] = z;
            gm_range_add(&panel->x.low, &panel->x.high, points[2 * i]);
        }
        if (drawn && exact) {
            gm_mark_line(picture, panel, (struct gm_style){GM_EXACT, 1, 1.6, GM_SHORT_DASH}, points, POINTS,
                         false);
        }
        for (size_t k = 0; k < count; k++) {
            size_t made = 0;
            for (size_t i = 0; i < POINTS; i++) {
                const double s = (double)i / (POINTS - 1), x = line->a[0] + s * (line->b[0] - line->a[0]);
                const double z = line->a[1] + s * (line->b[1] - line->a[1]);
                struct gm_sample sample;
                if (gm_flow_sample(gm_flow_of(&lanes[k]->problem), gm_run_state(lanes[k]->run), x, z,
                                   &sample)) {
                    points[2 * made] = scalar ? sample.theta : sample.u;
                    points[2 * made + 1] = z;
                    if (!exact) {
                        gm_range_add(&panel->x.low, &panel->x.high, points[2 * made]);
                    }
                    made++;
                }
            }
            if (drawn) {
                gm_mark_line(picture, panel, gm_lane_style(lanes[k], 1, 2.4), points, made, false);
            }
        }
        if (!drawn && !exact) {
            gm_range_round(&panel->x.low, &panel->x.high, GM_LINEAR);
        }
    }
}

void gm_shear_draw_profiles(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                            enum gm_place place, const struct gm_profile *line, double (*velocity)(double),
                            double (*theta)(double))
{
    draw_profile(picture, lanes, count, place, line, false, velocity, "u");
    draw_profile(picture, lanes, count, place, line, true, theta, "θ");
    picture->caption = "Grey, dashed: exact.";
}
