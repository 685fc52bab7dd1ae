/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The modified Hamiltonians that schemes conserve: their errors by step size and truncation. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "app/grid/grid.h"
#include "app/words/names.h"
#include "core/arena.h"

/* ---- layout ---- */

/* The rank of a scheme among those that the scene prefers; after them if it is not one. */
static size_t rank_of(const struct gm_scene *scene, const struct gm_scheme *scheme)
{
    size_t rank = 0;
    while (scene->schemes[rank] && strcmp(scene->schemes[rank], scheme->name) != 0) {
        rank++;
    }
    return rank;
}

/* The duration of work-precision, five steps around the scene's default, and the first scheme with a
   modified energy. */
static const char *usual(struct gm_grid *grid, const struct gm_scene *scene)
{
    gm_arena_refuse_if(grid->arena, !scene->asked_shown,
                       "scene %s has no modified energy: it has no canonical Hamiltonian", scene->name);
    const struct gm_scheme *schemes[GM_FITTING_SCHEMES], *usual = NULL;
    const size_t count = gm_fitting_schemes(scene, schemes);
    const struct gm_timing *timing = gm_arena_keep(grid->arena, gm_scene_defaults(scene), free);
    size_t best = SIZE_MAX;
    for (size_t i = 0; i < count; i++) {
        const size_t rank = rank_of(scene, schemes[i]);
        if (rank < best && (schemes[i]->claims & GM_SYMPLECTIC) && schemes[i]->family->coefficients_open) {
            best = rank;
            usual = schemes[i];
        }
    }
    const double dt = timing->dt;
    return gm_arena_print(grid->arena, "%s dt=%.17g,%.17g,%.17g,%.17g,%.17g%s%s",
                          scene->work ? scene->work->arguments : "", 2 * dt, dt, dt / 2, dt / 4, dt / 8,
                          usual ? " scheme=" : "", usual ? usual->name : "");
}

/* A cell for every lane, at the scheme's line by falling dt. */
static void lay_out(struct gm_grid *grid, const struct gm_arguments *words)
{
    (void)words;
    char message[GM_MESSAGE];
    const struct gm_request *request = &grid->request;
    gm_arena_check(grid->arena, gm_request_ends_together(request, message), message);
    grid->lines = gm_arena_take(grid->arena, request->count, sizeof *grid->lines);
    for (size_t i = 0; i < request->count; i++) {
        const struct gm_lane_spec *spec = &request->lanes[i];
        struct gm_grid_line *line = gm_grid_find(grid, spec->scheme);
        line = line ? line : gm_grid_add(grid, spec->scheme, request->count);
        const double dt = ((const struct gm_timing *)spec->parameters)->dt;
        size_t at = line->count++;
        for (; at > 0 && line->cells[at - 1].step <= dt; at--) {
            gm_arena_refuse_if(grid->arena, line->cells[at - 1].step == dt,
                               "backward compares steps and schemes: only scheme and dt take lists");
            line->cells[at] = line->cells[at - 1];
        }
        line->cells[at] = (struct gm_grid_cell){.spec = spec, .step = dt};
    }
    grid->begun = grid->count;
}

/* ---- runs ---- */

/* The gamma of the last two terms, |dt^k H_k| = C k! (dt / gamma)^k. */
static double gamma_of(const struct gm_grid_cell *cell)
{
    int last = GM_MODIFIED_POWER;
    while (last > 0 && !(cell->terms[last] > 0)) {
        last--;
    }
    int before = last - 1;
    while (before > 0 && !(cell->terms[before] > 0)) {
        before--;
    }
    if (before < 1) {
        return NAN;
    }
    double factorials = 1;
    for (int k = before + 1; k <= last; k++) {
        factorials *= k;
    }
    return cell->dt * pow(factorials * cell->terms[before] / cell->terms[last], 1. / (last - before));
}

static void conclude(const struct gm_grid *grid, struct gm_grid_line *line)
{
    const double above_roundoff = 1e-12;
    (void)grid;
    line->shown[0] = true;
    for (int k = 0; k < GM_POWERS; k++) {
        const struct gm_grid_cell *fine = NULL, *coarse = NULL;
        for (size_t i = line->count; i-- > 0 && !coarse;) {
            const struct gm_grid_cell *cell = &line->cells[i];
            line->shown[k] |= cell->tried && cell->terms[k] > 0;
            if (cell->tried && cell->status == GM_OK && cell->errors[k] > above_roundoff) {
                coarse = fine ? cell : NULL;
                fine = fine ? fine : cell;
            }
        }
        line->orders[k] =
            coarse ? log(coarse->errors[k] / fine->errors[k]) / log(coarse->dt / fine->dt) : NAN;
    }
}

/* The terms of H~ in the lane's state, of its last member. */
static void look(const struct gm_lane *lane, struct gm_modified_energy *energy, double *y, double *terms)
{
    const double *state = gm_run_state(lane->run);
    const size_t m = lane->problem.m;
    for (size_t i = 0; i < lane->problem.n; i++) {
        y[i] = state[i * m + m - 1];
    }
    gm_modified_energy_terms(energy, y, terms);
}

/* Advances a lane to its end; `y` is scratch. */
static void watch(const struct gm_grid *grid, struct gm_lane *lane, struct gm_modified_energy *energy,
                  double *y, struct gm_grid_cell *cell)
{
    enum { LOOKS = 400 }; /* the largest number of sampled steps */
    double first[GM_POWERS], terms[GM_POWERS];
    const int plain = gm_scene_observable(lane->scene, "energy_error");
    const double divisor = plain >= 0 ? gm_lane_divisor(lane, (size_t)plain) : 1;
    const double until = ((const struct gm_timing *)lane->parameters)->until;
    const int64_t steps = gm_run_steps_at(lane->run, until), looks = steps < LOOKS ? steps : LOOKS;
    look(lane, energy, y, first);
    for (int64_t i = 0; i <= looks && lane->run->status == GM_OK; i++) {
        const int64_t step = looks == steps ? i : (int64_t)((double)steps * (double)i / (double)looks);
        if (i > 0) {
            gm_grid_advance(grid, lane, step, INFINITY);
        }
        /* stopped by the user, or by a shorter step, which has another H~ */
        if (lane->run->stopped || gm_listener_stops(grid->listener)) {
            break;
        }
        look(lane, energy, y, terms);
        double difference = 0, power = 1;
        for (int k = 0; k < GM_POWERS; k++, power *= cell->dt) {
            difference += power * (terms[k] - first[k]);
            const double error = fabs(difference) / divisor;
            cell->errors[k] = isnan(error) || isnan(cell->errors[k]) ? NAN : fmax(cell->errors[k], error);
            cell->terms[k] = fmax(cell->terms[k], fabs(power * terms[k]) / divisor);
        }
    }
}

static void run(const struct gm_grid *grid, struct gm_lane *lane, struct gm_grid_cell *cell, char *message)
{
    double *y = malloc(lane->problem.n * sizeof *y);
    char reason[GM_MODIFIED_WHY] = "";
    struct gm_modified_energy *energy =
        y ? gm_modified_energy_open(&lane->problem, lane->scheme, GM_MODIFIED_POWER, reason) : NULL;
    cell->tried = energy != NULL;
    if (energy) {
        watch(grid, lane, energy, y, cell);
        gm_grid_take_end(lane, cell);
        for (int k = 1; k < GM_POWERS; k++) {
            cell->best = cell->errors[k] < cell->errors[cell->best] ? k : cell->best;
        }
        cell->gamma = gamma_of(cell);
    } else {
        gm_refuse(message, "%s", reason[0] ? reason : "not enough memory");
    }
    gm_modified_energy_close(energy);
    free(y);
}

static void put(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_cell *cell, int number)
{
    (void)grid;
    gm_row_put(row, "dt %.17g, status %s, t %.17g", cell->dt, gm_status_name(cell->status), cell->t);
    if (row->form == GM_ROW_JSON) {
        gm_row_list(row, "errors", cell->errors, GM_POWERS);
        gm_row_list(row, "terms", cell->terms, GM_POWERS);
        gm_row_put(row, "best %i", cell->best);
    } else {
        gm_row_put(row, "power %i, error %.9g, term %.9g", number, cell->errors[number], cell->terms[number]);
    }
    gm_row_put(row, "gamma %.9g", isfinite(cell->gamma) ? cell->gamma : NAN);
    if (row->form == GM_ROW_JSON) {
        gm_row_put(row, "drift %.17g", exp(-cell->gamma / (2 * cell->dt)));
    }
}

static void print_line(const struct gm_grid_line *line)
{
    printf("\n%s, order %d\n", line->scheme->name, line->scheme->order);
    if (line->reason[0]) {
        printf("  none: %s\n", line->reason);
        return;
    }
    static const char *const heads[] = {"H", "dt", "dt^2", "dt^3", "dt^4", "dt^5", "dt^6"};
    printf("%12s", "dt");
    for (int k = 0; k < GM_POWERS; k++) {
        if (line->shown[k]) {
            printf(" %9s", heads[k]);
        }
    }
    printf(" %9s %9s %9s %9s\n", "best", "gamma", "gamma/dt", "drift");
    for (size_t p = 0; p < line->count; p++) {
        const struct gm_grid_cell *cell = &line->cells[p];
        if (!cell->tried) {
            continue;
        }
        printf("%12.6g", cell->dt);
        for (int k = 0; k < GM_POWERS; k++) {
            if (line->shown[k]) {
                gm_print_number(" %9.2e", 9, cell->errors[k]);
            }
        }
        printf(" %9s", heads[cell->best]);
        gm_print_number(" %9.3g", 9, cell->gamma);
        gm_print_number(" %9.3g", 9, cell->gamma / cell->dt);
        gm_print_number(" %9.1e", 9, exp(-cell->gamma / (2 * cell->dt)));
        printf("%s%s\n", cell->status == GM_OK ? "" : "  ",
               cell->status == GM_OK ? "" : gm_status_name(cell->status));
    }
    printf("%12s", "slope");
    for (int k = 0; k < GM_POWERS; k++) {
        if (line->shown[k]) {
            gm_print_number(" %9.3f", 9, line->orders[k]);
        }
    }
    printf("\n");
}

static void print(const struct gm_grid *grid)
{
    printf("%s, up to t = %.6g: largest error of H + dt H1 + dt^2 H2 + ..., cut off after a power of dt\n",
           grid->request.scene->name, gm_grid_timing(grid)->until);
    for (size_t i = 0; i < grid->count; i++) {
        print_line(&grid->lines[i]);
    }
    printf(
        "\ngamma: term k is about k! (dt/gamma)^k, estimated from the last two; it is smallest at k = gamma/dt, and "
        "what\nis left drifts by at most exp(-gamma / 2 dt) in the time exp(gamma / 2 dt)\n");
}

static void put_front(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line)
{
    gm_row_put(row, "order %i, until %.17g, reason %s", line->scheme->order, gm_grid_timing(grid)->until,
               line->reason);
    gm_row_list(row, "slopes", line->orders, GM_POWERS);
}

/* ---- diagrams: for every scheme the errors against dt, a line for every power after which H~ is cut off; and, of the
   first, against that power, a line for every dt ---- */

static const char *const powers[GM_POWERS] = {"H", "to Δt", "to Δt²", "to Δt³", "to Δt⁴", "to Δt⁵", "to Δt⁶"};

/* Returns true if a logarithmic axis can show an error. */
static bool is_drawn(const struct gm_grid_cell *cell, int k)
{
    return cell->tried && cell->errors[k] > 1e-18 && cell->errors[k] < 1e3;
}

static void range_of(const struct gm_grid *grid, struct gm_axis *steps, struct gm_axis *errors)
{
    *steps = (struct gm_axis){.label = "Δt", .scale = GM_LOG, .low = 1, .high = 0};
    *errors = (struct gm_axis){.label = "", .scale = GM_LOG, .low = 1, .high = 0};
    for (size_t i = 0; i < grid->count; i++) {
        const struct gm_grid_line *line = &grid->lines[i];
        for (size_t p = 0; p < line->count; p++) {
            for (int k = 0; k < GM_POWERS; k++) {
                if (line->shown[k] && is_drawn(&line->cells[p], k)) {
                    gm_range_add(&steps->low, &steps->high, line->cells[p].dt);
                    gm_range_add(&errors->low, &errors->high, line->cells[p].errors[k]);
                }
            }
        }
    }
    if (errors->low > errors->high) { /* only round-off is left */
        *steps = (struct gm_axis){.label = "Δt", .scale = GM_LOG, .low = 0.1, .high = 1};
        errors->low = 1e-16;
        errors->high = 1;
    }
    steps->low /= 1.2;
    steps->high *= 1.2;
    gm_range_round(&errors->low, &errors->high, GM_LOG);
}

static void draw_line(const struct gm_grid_line *line, const struct gm_axis *steps,
                      const struct gm_axis *errors, struct gm_picture *picture, double *points)
{
    struct gm_panel *panel = gm_chart_panel(picture, GM_PLACE_STATE, line->scheme->title, steps, errors);
    if (line->reason[0]) {
        panel->note = gm_picture_text(picture, "%s", line->reason);
    }
    size_t colour = 0;
    for (int k = 0; k < GM_POWERS; k++) {
        size_t count = 0;
        for (size_t p = 0; p < line->count; p++) {
            if (is_drawn(&line->cells[p], k)) {
                points[2 * count] = line->cells[p].dt;
                points[2 * count + 1] = line->cells[p].errors[k];
                count++;
            }
        }
        if (line->shown[k]) {
            const struct gm_style ink = {GM_INK, 1, 2.4, GM_SOLID};
            gm_chart_line(picture, panel, k == 0 ? ink : gm_chart_style(colour++), points, count, powers[k]);
        }
    }
}

/* Draws the error against the power, which shows the best truncation. */
static void draw_cuts(const struct gm_grid_line *line, const struct gm_axis *errors,
                      struct gm_picture *picture, double *points)
{
    const struct gm_axis x = {.label = "cut off after this power of Δt", .low = 0, .high = GM_MODIFIED_POWER};
    struct gm_panel *panel =
        gm_chart_panel(picture, GM_PLACE_GRAPH,
                       gm_picture_text(picture, "%s: where to cut off", line->scheme->title), &x, errors);
    for (size_t p = 0; p < line->count && p < GM_LANE_COLOURS; p++) {
        size_t count = 0;
        for (int k = 0; k < GM_POWERS; k++) {
            if (line->shown[k] && is_drawn(&line->cells[p], k)) {
                points[2 * count] = k;
                points[2 * count + 1] = line->cells[p].errors[k];
                count++;
            }
        }
        gm_chart_line(picture, panel, gm_chart_style(p), points, count,
                      gm_step_text(picture, line->cells[p].dt));
    }
}

static void draw(const struct gm_grid *grid, struct gm_picture *picture)
{
    struct gm_axis steps, errors;
    range_of(grid, &steps, &errors);
    picture->title =
        gm_picture_text(picture, "%s: what the scheme really solves", grid->request.scene->title);
    picture->subtitle = gm_picture_text(picture, "errors of H + Δt H₁ + Δt² H₂ + …, cut off, up to t = %s",
                                        gm_step_text(picture, gm_grid_timing(grid)->until));
    picture->caption =
        "The steeper the line, the more of the modified Hamiltonian is taken: that one the scheme keeps.";
    picture->clock = "";
    picture->graphs_below = true;
    double *points = gm_picture_memory(picture, 2 * (grid->request.count + GM_POWERS) * sizeof *points);
    for (size_t i = 0; i < grid->count; i++) {
        draw_line(&grid->lines[i], &steps, &errors, picture, points);
    }
    size_t first = 0;
    while (first + 1 < grid->count && grid->lines[first].reason[0]) {
        first++;
    }
    draw_cuts(&grid->lines[first], &errors, picture, points);
}

const struct gm_study_row gm_study_backward = {.name = "backward",
                                               .refusal = GM_EXIT_USAGE,
                                               .draw = draw,
                                               .print = print,
                                               .cells = "points",
                                               .put_front = put_front,
                                               .which = "backward error of which scene?",
                                               .schemes = 1,
                                               .usual = usual,
                                               .lay_out = lay_out,
                                               .run = run,
                                               .conclude = conclude,
                                               .rows = GM_POWERS,
                                               .put_cell = put};
