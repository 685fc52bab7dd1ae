/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the parameters of a lane to its problem and start. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "scenes/common/system/pieces.h"
#include "scenes/common/system/texts.h"
#include "scenes/field/kind.h"

/* points at which a start is examined on a ring, and cells under a moving mesh */
enum { SAMPLES = 4096, CELLS = 1024 };

void gm_field_start(const void *parameters, const struct gm_problem *problem, double *y)
{
    const struct gm_system_lane *lane = parameters;
    if (gm_user_field_of(lane)->kind->start) {
        gm_user_field_of(lane)->kind->start(problem, y);
    } else {
        gm_user_line_levels(problem->parameters, &problem->line, lane->timing.dt, y);
    }
}

bool gm_field_takes(const struct gm_scheme *scheme, const char *key)
{
    const enum gm_mesh_kind mesh = gm_scheme_mesh(scheme);
    return (mesh == GM_MESH_FREE || strcmp(key, "cell") != 0) &&
           (mesh == GM_MESH_GIVEN || strcmp(key, "mesh") != 0) &&
           (gm_scheme_relaxes(scheme) || strcmp(key, "relax") != 0);
}

/* Returns true if the line between nodes alone joins their velocities. */
static bool joins(const struct gm_problem *problem, const struct gm_mesh *mesh, const double *y,
                  char *sentence)
{
    enum { PARTS = 4 };
    for (size_t e = 0; e <= mesh->points; e++) {
        const bool first = e == 0, last = e == mesh->points;
        const double left = first ? mesh->first : y[e - 1], v0 = first ? 0 : y[mesh->points + e - 1],
                     d = (last ? mesh->first + mesh->length : y[e]) - left,
                     v1 = last ? 0 : y[mesh->points + e];
        double at[GM_BETWEEN_INPUTS][PARTS + 1], v[PARTS + 1];
        for (size_t i = 0; i <= PARTS; i++) {
            at[0][i] = (double)i / PARTS;
            at[1][i] = d;
            at[2][i] = v0;
            at[3][i] = v1;
        }
        gm_user_mesh_between(problem, at[0], v, PARTS + 1);
        for (size_t i = 0; i <= PARTS; i++) {
            const double wanted = i == 0 ? v0 : i == PARTS ? v1 : v[i];
            if (!(fabs(v[i] - wanted) <= 1e-6 * (fabs(v0) + fabs(v1)))) {
                return gm_refuse(sentence,
                                 "between: is %.4g at s = %g between x = %.4g and %.4g, where v0 = %.4g and "
                                 "v1 = %.4g; it is finite, v0 at s = 0 and v1 at s = 1",
                                 isnan(v[i]) ? NAN : v[i], at[0][i], left, left + d, v0, v1);
            }
        }
    }
    return true;
}

bool gm_field_start_mesh(const void *parameters, const struct gm_problem *problem,
                         const struct gm_scheme *scheme, double *y, char *sentence)
{
    const struct gm_moving_mesh *moving = gm_moving_mesh_of(problem);
    const struct gm_system_lane *lane = parameters;
    const struct gm_mesh mesh = gm_mesh_of_problem(problem);
    const bool free = gm_scheme_mesh(scheme) == GM_MESH_FREE;
    if (mesh.alone && !mesh.cell) {
        return gm_refuse(sentence, "cell: is 0, and nodes alone move by nothing else");
    }
    const size_t points = mesh.points;
    double rank, condition;
    if (gm_mesh_start(&mesh, gm_scheme_mesh(scheme), moving->start, problem->parameters, y)) {
        if (free && mesh.cell && !isfinite(gm_mesh_energy(&mesh, y))) {
            return gm_refuse(sentence, "cell: the energy of the cells is not finite at the start");
        }
        if (mesh.alone && !joins(problem, &mesh, y, sentence)) {
            return false;
        }
        if (!free || !gm_mesh_mass(&mesh, y, &rank, &condition)) {
            return true;
        }
        if (condition < 0) {
            return gm_refuse(sentence,
                             "cell: the mass matrix is not positive at the start: inertia is below 0");
        }
        if (rank >= 2 * (double)points) {
            return true;
        }
        return mesh.alone
                   ? gm_refuse(sentence,
                               "cell: the mass matrix of the nodes is singular: not all have inertia")
                   : gm_refuse(
                         sentence,
                         "%g of %zu nodes are straight: the mass matrix has rank %g of %zu; a line cell: "
                         "%smakes it regular",
                         2 * (double)points - rank, points, rank, 2 * points,
                         mesh.cell ? "like 0.05*(d_t/d)^2 " : "");
    }
    const char *name = lane->owner->system.variables[0].name;
    double u, slope, rate;
    moving->start(problem->parameters, &mesh.first, 1, &u, &slope, &rate);
    if (fabs(u - mesh.left) > 0.01) {
        /* the jump at the end is narrower than any cell */
        return gm_refuse(sentence,
                         "no mesh was found: a line of length %g cuts the start off, where %.60s is %.4g at "
                         "x = %g and the end holds %.4g",
                         mesh.length, name, u, mesh.first, mesh.left + 0.);
    }
    return gm_refuse(
        sentence,
        "no mesh of %ld nodes was found for the density %s with alpha = %g, where the slope of %.60s is up "
        "to %.4g: the homotopy from the uniform mesh fails; a density that varies less helps",
        lane->grid.points, lane->grid.density, gm_user_mesh_names(problem)->alpha, name,
        gm_user_mesh_names(problem)->steepest);
}

/* Notes the weight of the slope if the start chose it, and the number of nodes that are listed. */
void gm_field_note_mesh(const struct gm_problem *problem, void *parameters)
{
    struct gm_system_lane *lane = parameters;
    lane->grid.alpha = gm_user_mesh_names(problem)->alpha;
    lane->grid.points = (long)gm_mesh_of_problem(problem).points;
}

double *gm_field_start_on(const struct gm_system_lane *lane, const struct gm_problem *problem,
                          struct gm_grid1 *grid)
{
    const bool moves = gm_user_field_of(lane)->kind->moves;
    *grid = problem->line;
    if (moves) {
        const struct gm_mesh mesh = gm_mesh_of_problem(problem);
        *grid = (struct gm_grid1){.points = CELLS + 1, .dx = mesh.length / CELLS, .first = mesh.first};
    }
    const struct gm_user_line *line = problem->parameters; /* first in those of every field */
    double *y = malloc((moves ? line->start.outputs * grid->points : problem->n) * sizeof *y);
    if (y && moves) {
        gm_user_line_start(line, grid, y);
    } else if (y) {
        gm_field_start(lane, problem, y);
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
    const struct gm_user_line *line = gm_field_line(view);
    double places[2 * GM_LINE_ROOM], values[GM_LINE_BLOCK], constants[GM_MOST_OF_MATRICES];
    for (size_t c = 0; c < gm_line_components(&field->of_file.system); c++) {
        constants[c] = gm_field_constant(view, c);
    }
    for (size_t first = 0, some; first < gm_grid1_seen(grid); first += some * apart) {
        for (some = 0; some < GM_LINE_ROOM && first + some * apart < gm_grid1_seen(grid); some++) {
            places[some] = gm_grid1_node(grid, first + some * apart);
        }
        for (size_t i = 0; i < some; i++) {
            places[some + i] = line->begin;
        }
        gm_tape_values(&line->exact, places, values, some);
        for (size_t i = 0; i < some * gm_line_components(&field->of_file.system); i++) {
            const size_t c = i / some;
            const double begin = view->state[c * grid->points + first + i % some * apart],
                         exact = values[i] + constants[c];
            if (!(fabs(exact - begin) <= 1e-3 * largest)) {
                return gm_refuse(sentence,
                                 "exact: %.60s would begin at %.6g where x = %.6g, and it starts at %.6g",
                                 field->of_file.system.variables[c].name, exact, places[i % some], begin);
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
    struct gm_fault fault;
    if (field->kind->closes && !field->kind->closes(problem, &fault)) {
        return gm_refuse(sentence, "%s", fault.sentence);
    }
    if (field->kind->closes && field->kind != &gm_field_waves && !lane->owner->scene.words) {
        return true; /* the program's own files begin with their exact solutions */
    }
    double *y = gm_field_start_on(lane, problem, &grid);
    const double t0 = gm_field_t0(lane);
    const struct gm_view view = {
        .problem = problem, .parameters = lane, .state = y, .start = y, .t0 = t0, .t = t0};
    const bool written =
        field->of_file.system.variables[0].start_place > 0; /* else it is the exact solution */
    const bool fits = y ? (field->kind->closes || is_finite(field, problem, y, sentence)) &&
                              (!field->solved || !written || !gm_field_holds(&view) ||
                               begins_exactly(&view, &grid, sentence)) &&
                              (field->kind != &gm_field_waves ||
                               has_levels(problem, field->of_file.system.variables[0].name, y, sentence))
                        : gm_refuse(sentence, "not enough memory");
    free(y);
    return fits;
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
    bool opened = kind->open(problem, lane, values) || gm_refuse(sentence, "not enough memory");
    problem->name = lane->owner->scene.name;
    free(values);
    /* the program's own files are right: values that are typed may be wrong */
    const bool trusted = lane == lane->owner->initial && !lane->owner->scene.words;
    opened = opened && (!kind->admits || kind->admits(lane, problem, sentence)) &&
             (trusted || check_start(lane, problem, sentence));
    if (!opened) {
        gm_user_line_close(problem);
    }
    return opened;
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
