/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the parameters of a lane to its problem and start. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "scenes/common/system/pieces.h"
#include "scenes/common/system/texts.h"
#include "scenes/field/kind.h"

enum { SAMPLES = 4096 }; /* points at which a start is examined */

void gm_field_start(const void *parameters, const struct gm_problem *problem, double *y)
{
    const struct gm_system_lane *lane = parameters;
    if (gm_user_field_of(lane)->kind->start) {
        gm_user_field_of(lane)->kind->start(problem, y);
    } else {
        gm_user_line_levels(problem->parameters, &problem->line, lane->timing.dt, y);
    }
}

bool gm_field_start_mesh(const void *parameters, const struct gm_problem *problem,
                         const struct gm_scheme *scheme, double *y, char *sentence)
{
    const struct gm_moving_mesh *moving = gm_moving_mesh_of(problem);
    const struct gm_system_lane *lane = parameters;
    struct gm_mesh mesh;
    moving->describe(problem, &mesh);
    return gm_mesh_start(&mesh, gm_scheme_mesh(scheme), moving->start, problem->parameters, y) ||
           gm_refuse(
               sentence,
               "no mesh of %ld nodes was found for alpha = %g: the homotopy from the uniform mesh fails; a "
               "smaller alpha helps",
               lane->grid.points, lane->grid.alpha);
}

/* Notes the weight of the slope if the start chose it. */
void gm_field_note_alpha(const struct gm_problem *problem, void *parameters)
{
    ((struct gm_system_lane *)parameters)->grid.alpha = gm_user_mesh_alpha(problem);
}

double *gm_field_start_on(const struct gm_system_lane *lane, const struct gm_problem *problem,
                          struct gm_grid1 *grid)
{
    const bool moves = gm_user_field_of(lane)->kind == &gm_field_moving_waves;
    const double half = gm_field_half_length(lane);
    *grid = moves ? (struct gm_grid1){.points = SAMPLES, .dx = 2 * half / SAMPLES, .first = -half}
                  : problem->line;
    grid->points += moves;
    double *y = malloc((moves ? grid->points : problem->n) * sizeof *y), slope, rate;
    if (y && !moves) {
        gm_field_start(lane, problem, y);
    }
    for (size_t i = 0; y && moves && i < grid->points; i++) {
        gm_moving_mesh_of(problem)->start(problem->parameters, gm_grid1_node(grid, i), &y[i], &slope, &rate);
    }
    return y;
}

/* Returns true if the exact solution begins like the start, up to 0.1 %, at enough nodes. */
static bool begins_exactly(const struct gm_view *view, const struct gm_grid1 *grid, char *sentence)
{
    const struct gm_user_field *field = gm_viewed_field(view);
    const size_t apart = gm_grid1_seen(grid) / (SAMPLES + 2) + 1;
    double largest = 1e-9;
    for (size_t i = 0; i < gm_line_components(&field->of_file.system) * grid->points; i++) {
        largest = fmax(largest, fabs(view->state[i]));
    }
    for (size_t c = 0; c < gm_line_components(&field->of_file.system); c++) {
        const double constant = gm_field_constant(view, c);
        for (size_t i = 0; i < gm_grid1_seen(grid); i += apart) {
            const double x = gm_grid1_node(grid, i), begin = view->state[c * grid->points + i],
                         exact = gm_user_line_exact(gm_field_line(view), c, x, gm_field_line(view)->begin) +
                                 constant;
            if (!(fabs(exact - begin) <= 1e-3 * largest)) {
                return gm_refuse(sentence,
                                 "exact: %.60s would begin at %.6g where x = %.6g, and it starts at %.6g",
                                 field->of_file.system.variables[c].name, exact, x, begin);
            }
        }
    }
    return true;
}

/* Returns true if a step can lead to the other level of a wave; else false with a sentence. */
static bool has_levels(const struct gm_problem *problem, const char *name, const double *y, char *sentence)
{
    const double most = 1e10; /* the growth that a run treats as a blow-up */
    const size_t points = problem->line.points;
    double begin = 1, further = 0;
    for (size_t i = 0; i < points; i++) {
        if (!isfinite(y[points + i])) {
            return gm_refuse(sentence, "%.60s is not finite where x = %.6g one step after the start", name,
                             gm_grid1_node(&problem->line, i));
        }
        begin = fmax(begin, fabs(y[i]));
        further = fmax(further, fabs(y[points + i]));
    }
    return further <= most * begin ||
           gm_refuse(
               sentence,
               "%.60s would be %.3g one step after the start: V' is too large there, or dt = %.3g too long",
               name, further, y[2 * points]);
}

static bool is_finite(const struct gm_user_field *field, const struct gm_problem *problem, const double *y,
                      char *sentence)
{
    const size_t points = problem->line.points;
    for (size_t i = 0; i < problem->n; i++) {
        if (!isfinite(y[i])) {
            return gm_refuse(
                sentence, "%.60s at the start is not finite where x = %.6g",
                field->of_file.system.variables[i < points ? 0 : field->of_file.system.n - 1].name,
                gm_grid1_node(&problem->line, i % points));
        }
    }
    return true;
}

static bool check_start(const struct gm_system_lane *lane, const struct gm_problem *problem, char *sentence)
{
    const struct gm_user_field *field = gm_user_field_of(lane);
    struct gm_grid1 grid;
    if (field->kind->closes && !field->kind->closes(problem, sentence, GM_MESSAGE)) {
        return false;
    }
    double *y = gm_field_start_on(lane, problem, &grid);
    const struct gm_view view = {.problem = problem, .parameters = lane, .state = y};
    const bool written =
        field->of_file.system.variables[0].start_place > 0; /* else it is the exact solution */
    const bool good = y ? (field->kind->closes || is_finite(field, problem, y, sentence)) &&
                              (!field->solved || !written || begins_exactly(&view, &grid, sentence)) &&
                              (field->kind != &gm_field_waves ||
                               has_levels(problem, field->of_file.system.variables[0].name, y, sentence))
                        : gm_refuse(sentence, "not enough memory");
    free(y);
    return good;
}

bool gm_field_setup(const void *parameters, struct gm_problem *problem, char *sentence)
{
    const struct gm_system_lane *lane = parameters;
    const struct gm_field_kind *kind = gm_user_field_of(lane)->kind;
    double *values = gm_system_start_values(lane, NULL);
    if (!values) {
        return gm_refuse(sentence, "not enough memory");
    }
    if (!gm_system_is_admitted(lane, values, sentence)) {
        free(values);
        return false;
    }
    bool good = kind->open(problem, lane, values) || gm_refuse(sentence, "not enough memory");
    problem->name = lane->owner->scene.name;
    free(values);
    good = good && (!kind->admits || kind->admits(lane, problem, sentence)) &&
           check_start(lane, problem, sentence);
    if (!good) {
        kind->close(problem);
    }
    return good;
}

/* Sets the parameter `position`, if the start depends on it. */
size_t gm_field_point(const void *parameters, double x, double u, struct gm_choice *choices)
{
    static const char key[] = "position";
    const struct gm_user_system *system = &((const struct gm_system_lane *)parameters)->owner->system;
    size_t count = 0, found = 0;
    gm_node_id *parts = gm_formula_parts(&system->graph, system->variables[0].start, &count);
    for (size_t i = 0; parts && i < count; i++) {
        const struct gm_node *node = &system->graph.nodes[parts[i]];
        found |= node->operation == GM_VARIABLE && strcmp(system->variables[node->a].name, key) == 0;
    }
    free(parts);
    (void)u;
    gm_choose(&choices[0], key, x);
    return found;
}
