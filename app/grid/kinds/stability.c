/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps for which a scheme is bounded or accurate: a step in the plan's unit over a parameter. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/grid/grid.h"
#include "core/arena.h"
#include "core/expression/number.h"

/* ---- layout ---- */

static const char *usual(struct gm_grid *grid, const struct gm_scene *scene)
{
    enum { MOST = 6 }; /* schemes of the scene, if the plan gives none */
    gm_arena_refuse_if(grid->arena, !scene->stability, "scene %s has no stability map: %s", scene->name,
                       scene->no_stability ? scene->no_stability
                                           : "stability --region SCHEME shows the limit of a scheme");
    const bool planned = scene->stability->schemes != NULL;
    const char *const *schemes = planned ? scene->stability->schemes : scene->schemes;
    char list[512] = "";
    for (size_t i = 0; schemes[i] && (planned || i < MOST); i++) {
        gm_append(list, sizeof list, "%s%s", i ? "," : "", schemes[i]);
    }
    return gm_arena_print(grid->arena, "%s scheme=%s", scene->stability->arguments, list);
}

/* "accurate=1e-2"; the parsed scene has to have an error. */
static void read_judge(struct gm_grid *grid, const char *judge)
{
    static const char accurate[] = "accurate";
    const size_t length = strlen(accurate);
    grid->accuracy = INFINITY;
    if (!judge || strcmp(judge, "bounded") == 0) {
        return;
    }
    gm_arena_refuse_if(grid->arena,
                       strncmp(judge, accurate, length) != 0 || (judge[length] && judge[length] != '='),
                       "--judge %.60s is none of: bounded, accurate, accurate=ERROR", judge);
    grid->accuracy = 0.1;
    gm_arena_refuse_if(grid->arena,
                       judge[length] && (!gm_number_parse(judge + length + 1, &grid->accuracy) ||
                                         !(grid->accuracy > 0 && grid->accuracy < INFINITY)),
                       "--judge %.60s needs an error above 0, such as accurate=1e-2", judge);
    gm_arena_refuse_if(grid->arena, !grid->plan->error,
                       "scene %s has no error to be accurate by; take --judge bounded",
                       grid->request.scene->name);
}

static struct gm_grid_axis axis_of(struct gm_grid *grid, const double *values, size_t count)
{
    struct gm_grid_axis axis = {.values = gm_arena_take(grid->arena, count, sizeof *values)};
    for (size_t i = 0; i < count; i++) {
        gm_axis_add(&axis, values[i]);
    }
    return axis;
}

static void lay_out(struct gm_grid *grid, const struct gm_arguments *words)
{
    (void)words;
    const struct gm_request *request = &grid->request;
    const struct gm_stability *plan = grid->plan = request->scene->stability;
    grid->parameter = gm_scene_parameter(request->scene, plan->parameter);
    read_judge(grid, grid->requested);
    grid->steps = axis_of(grid, plan->steps, plan->step_count);
    grid->values = axis_of(grid, plan->values, plan->value_count);
    grid->lines = gm_arena_take(grid->arena, request->count, sizeof *grid->lines);
    for (size_t i = 0; i < request->count; i++) {
        gm_arena_refuse_if(grid->arena, gm_grid_find(grid, request->lanes[i].scheme),
                           "stability varies dt and %s itself: only scheme takes a list", plan->parameter);
        struct gm_grid_line *line =
            gm_grid_add(grid, request->lanes[i].scheme, grid->steps.count * grid->values.count);
        for (size_t s = 0; s < grid->steps.count; s++) {
            for (size_t v = 0; v < grid->values.count; v++) {
                line->cells[line->count++] = (struct gm_grid_cell){.spec = &request->lanes[i],
                                                                   .step = grid->steps.values[s],
                                                                   .value = grid->values.values[v]};
            }
        }
    }
    grid->begun = grid->count;
}

/* ---- verdicts ---- */

static const char *judge_of(const struct gm_grid *grid)
{
    return grid->accuracy < INFINITY ? "accurate" : "bounded";
}

const char *gm_stability_question(const struct gm_grid *grid, char *text, size_t size)
{
    const char *judge = judge_of(grid);
    if (grid->accuracy < INFINITY) {
        snprintf(text, size, "%s to %.3g (%s)", judge, grid->accuracy, grid->plan->error);
    } else {
        snprintf(text, size, "%s", judge);
    }
    return text;
}

/* A cell of a map: its letter, its word in tables, and the lane whose colour it has. */
static const struct {
    char letter;
    const char *word;
    size_t lane;
    double alpha;
} verdicts[] = {[GM_BOUNDED] = {'.', "", 2, 0.22},
                [GM_LOST] = {'L', "lost", 0, 0.55},
                [GM_GAINED] = {'G', "gained", 1, 0.6},
                [GM_WRONG] = {'W', "wrong", 3, 0.4}};

const char *gm_cell_word(const struct gm_grid *grid, const struct gm_grid_cell *cell)
{
    if (!cell->tried) {
        return "untried";
    }
    if (cell->verdict == GM_FAILED) {
        return gm_status_name(cell->status);
    }
    return cell->verdict == GM_BOUNDED ? judge_of(grid) : verdicts[cell->verdict].word;
}

char gm_cell_letter(const struct gm_grid_cell *cell)
{
    static const char failures[GM_STATUSES] = {
        [GM_BLOW_UP] = 'B', [GM_NO_CONVERGENCE] = 'N', [GM_MESH_CROSSING] = 'M'};
    if (!cell->tried || cell->verdict != GM_FAILED) {
        return cell->tried ? verdicts[cell->verdict].letter : '?';
    }
    return failures[cell->status] ? failures[cell->status] : 'C';
}

/* Writes the letters in use, except that of the question: "W wrong, M mesh-crossing". */
static const char *letters_of(const struct gm_grid *grid, char *text, size_t size)
{
    bool noted[128] = {['.'] = true};
    text[0] = '\0';
    for (size_t i = 0; i < grid->count; i++) {
        for (size_t k = 0; k < grid->lines[i].count; k++) {
            const struct gm_grid_cell *cell = &grid->lines[i].cells[k];
            const char letter = gm_cell_letter(cell);
            if (!noted[(size_t)letter]) {
                gm_append(text, size, "%s%c %s", text[0] ? ", " : "", letter, gm_cell_word(grid, cell));
                noted[(size_t)letter] = true;
            }
        }
    }
    return text;
}

double gm_stability_limit(const struct gm_grid *grid, const struct gm_grid_line *line)
{
    double limit = 0;
    for (size_t s = 0; s < grid->steps.count; s++) {
        bool open = false;
        for (size_t v = 0; v < grid->values.count; v++) {
            const struct gm_grid_cell *cell = &line->cells[s * grid->values.count + v];
            if (cell->tried && cell->verdict != GM_BOUNDED) {
                return limit;
            }
            open = open || !cell->tried;
        }
        if (open) {
            return NAN;
        }
        limit = grid->steps.values[s];
    }
    return limit;
}

/* ---- runs ---- */

static enum gm_cell_verdict verdict(const struct gm_grid *grid, const struct gm_grid_cell *cell)
{
    if (cell->status != GM_OK) {
        return GM_FAILED;
    }
    if (fabs(cell->ratio) > 2 || (!grid->plan->kept && grid->plan->error && !(cell->error <= 1))) {
        return GM_GAINED;
    }
    if (!(cell->ratio >= 0.5)) {
        return GM_LOST;
    }
    return grid->accuracy < INFINITY && !(cell->error <= grid->accuracy) ? GM_WRONG : GM_BOUNDED;
}

/* CPU time after which a run is judged by its current state */
static const double most_seconds = 10;

static const struct gm_observable *find(const struct gm_scene *scene, const char *key)
{
    const int observable = key ? gm_scene_observable(scene, key) : -1;
    return observable < 0 ? NULL : &scene->observables[observable];
}

static double value_of(const struct gm_lane *lane, const struct gm_observable *observable)
{
    const struct gm_view view = gm_lane_view(lane);
    return observable ? gm_observe(observable, &view) : 1;
}

static double error_of(const struct gm_lane *lane, const struct gm_observable *error)
{
    return error ? fabs(gm_lane_observe(lane, (size_t)(error - lane->scene->observables))) : NAN;
}

/* Up to `steps` steps in all, one by one; returns the largest value after them, and at least `largest`. */
static double largest_to(const struct gm_grid *grid, struct gm_lane *lane, int64_t steps,
                         double (*value)(const struct gm_lane *lane, const struct gm_observable *observable),
                         const struct gm_observable *observable, double largest)
{
    for (double spent = 0; gm_grid_goes_on(grid, lane, steps) && spent < most_seconds;) {
        spent += gm_grid_advance(grid, lane, lane->run->steps + 1, INFINITY);
        largest = fmax(largest, value(lane, observable));
    }
    return largest;
}

/* The end divided by the start; a conserved quantity that may start at 0 is measured by its size. */
static double ratio_of(const struct gm_lane *lane, const struct gm_observable *conserved, double before,
                       double after)
{
    const double size = conserved && conserved->error
                            ? gm_lane_divisor(lane, (size_t)(conserved - lane->scene->observables))
                            : 0;
    return size > fabs(before) ? 1 + copysign(after - before, (after - before) * before) / size
                               : after / before;
}

static void run(const struct gm_grid *grid, struct gm_lane *lane, struct gm_grid_cell *cell, char *message)
{
    (void)message;
    const struct gm_stability *plan = grid->plan;
    const struct gm_observable *conserved = find(lane->scene, plan->kept),
                               *error = find(lane->scene, plan->error);
    const struct gm_timing *timing = lane->parameters;
    const int64_t some = gm_run_steps_at(lane->run, timing->until), all = some > 1 ? some : 1;
    double before = value_of(lane, conserved), after;
    if (plan->settle > 0 && all > 2 * plan->settle && !lane->scheme->family->adaptive) {
        before = largest_to(grid, lane, plan->settle, value_of, conserved, before);
        gm_grid_advance(grid, lane, all - plan->settle, most_seconds);
        after = largest_to(grid, lane, all, value_of, conserved, -INFINITY);
        cell->error = error_of(lane, error);
    } else if (error && plan->throughout) {
        cell->error = largest_to(grid, lane, all, error_of, error, -INFINITY);
        after = value_of(lane, conserved);
    } else {
        gm_grid_advance(grid, lane, all, most_seconds);
        cell->error = error_of(lane, error);
        after = value_of(lane, conserved);
    }
    cell->ratio = ratio_of(lane, conserved, before, after);
    gm_grid_take_end(lane, cell);
    cell->verdict = verdict(grid, cell);
}

static void put(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_cell *cell, int number)
{
    char judge[64];
    (void)number;
    gm_row_number(row, grid->parameter->key, cell->value, 17);
    gm_row_put(row, "step %.17g, dt %.17g, verdict %s, status %s, t %.17g, ratio %.9g, error %.9g",
               cell->step, cell->dt, gm_cell_word(grid, cell), gm_status_name(cell->status), cell->t,
               isfinite(cell->ratio) ? cell->ratio : NAN, isfinite(cell->error) ? cell->error : NAN);
    if (row->form != GM_ROW_JSON) {
        snprintf(judge, sizeof judge, grid->accuracy < INFINITY ? "%s=%.9g" : "%s", judge_of(grid),
                 grid->accuracy);
        gm_row_put(row, "judge %s", judge);
    }
}

/* ---- tables ---- */

static void print(const struct gm_grid *grid)
{
    const struct gm_stability *plan = grid->plan;
    char letters[128], question[GM_TEXT_SIZE];
    letters_of(grid, letters, sizeof letters);
    printf("%s, which step is %s, after t = %.6g: . %s%s%s\n", grid->request.scene->name,
           gm_stability_question(grid, question, sizeof question), gm_grid_timing(grid)->until,
           judge_of(grid), letters[0] ? ", " : "", letters);
    if (plan->told) {
        printf("%s: %.4g here\n", plan->told, 1 / plan->unit(gm_grid_timing(grid)));
    }
    for (size_t i = 0; i < grid->count; i++) {
        const struct gm_grid_line *line = &grid->lines[i];
        printf("\n%-20s %s\n%12s", line->scheme->name, plan->parameter, plan->label);
        for (size_t v = 0; v < grid->values.count; v++) {
            printf(" %7.4g", grid->values.values[v]);
        }
        printf("\n");
        for (size_t s = grid->steps.count; s-- > 0;) {
            printf("%12.4g", grid->steps.values[s]);
            for (size_t v = 0; v < grid->values.count; v++) {
                printf(" %7c", gm_cell_letter(&line->cells[s * grid->values.count + v]));
            }
            printf("\n");
        }
        const double limit = gm_stability_limit(grid, line);
        if (isnan(limit)) {
            printf("  how far it is %s is open: not every step was tried\n", judge_of(grid));
        } else if (limit > 0) {
            printf("  %s for all values up to %.4g\n", judge_of(grid), limit);
        } else {
            printf("  at no step %s for all values\n", judge_of(grid));
        }
    }
}

static void put_front(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line)
{
    const double limit = gm_stability_limit(grid, line);
    gm_row_put(row, "parameter %s, unit %s, until %.17g, judge %s, accuracy %.17g, limit %.17g",
               grid->parameter->key, grid->plan->label, gm_grid_timing(grid)->until, judge_of(grid),
               grid->accuracy, limit > 0 ? limit : NAN);
}

/* ---- maps: a cell for every step and value, with a letter, so that colour is not needed ---- */

enum { MOST_EDGES = 64 };

static struct gm_style style_of(const struct gm_grid_cell *cell)
{
    if (cell->tried && cell->verdict == GM_FAILED) {
        return (struct gm_style){.role = GM_SECONDARY, .alpha = cell->status == GM_BLOW_UP ? 0.85 : 0.5};
    }
    return (struct gm_style){.role = gm_lane_role(verdicts[cell->verdict].lane),
                             .alpha = cell->tried ? verdicts[cell->verdict].alpha : 0};
}

static void draw_map(const struct gm_grid *grid, const struct gm_grid_line *line, struct gm_picture *picture)
{
    const struct gm_grid_axis *steps = &grid->steps, *values = &grid->values;
    const bool logarithmic = grid->parameter->logarithmic;
    double x[MOST_EDGES + 1], y[MOST_EDGES + 1];
    const struct gm_axis across =
        gm_chart_edges(grid->parameter->key, values->values, values->count, logarithmic, x);
    /* the subtitle has the label of the steps: beside every map it would take the room of the ticks */
    const struct gm_axis up = gm_chart_edges("", steps->values, steps->count, true, y);
    struct gm_panel *panel = gm_chart_panel(picture, GM_PLACE_STATE, line->scheme->title, &across, &up);
    const double limit = gm_stability_limit(grid, line);
    panel->note = limit > 0 ? gm_picture_text(picture, "%s up to %.3g", judge_of(grid), limit) : "";
    for (size_t s = 0; s < steps->count; s++) {
        for (size_t v = 0; v < values->count; v++) {
            const struct gm_grid_cell *cell = &line->cells[s * values->count + v];
            const double corners[] = {x[v], y[s], x[v + 1], y[s], x[v + 1], y[s + 1], x[v], y[s + 1]};
            gm_mark_polygon(picture, panel, style_of(cell), corners, 4);
        }
    }
    /* one letter for all that end alike, above one another */
    for (size_t v = 0; v < values->count; v++) {
        size_t next = 0;
        for (size_t s = 0; s < steps->count; s = next) {
            const char letter = gm_cell_letter(&line->cells[s * values->count + v]);
            for (next = s + 1; next < steps->count; next++) {
                if (gm_cell_letter(&line->cells[next * values->count + v]) != letter) {
                    break;
                }
            }
            if (letter != '.') {
                gm_mark_text(picture, panel, (struct gm_style){GM_INK, 1, 1, GM_SOLID},
                             logarithmic ? sqrt(x[v] * x[v + 1]) : (x[v] + x[v + 1]) / 2,
                             sqrt(y[s] * y[next]), GM_ANCHOR_CENTRE, gm_picture_text(picture, "%c", letter))
                    ->fixed = true;
            }
        }
    }
}

static void draw(const struct gm_grid *grid, struct gm_picture *picture)
{
    char letters[128], question[GM_TEXT_SIZE];
    picture->title = gm_picture_text(picture, "%s: which step is %s", grid->request.scene->title,
                                     gm_stability_question(grid, question, sizeof question));
    picture->subtitle = gm_picture_text(picture, "up: %s;  after t = %s", grid->plan->label,
                                        gm_step_text(picture, gm_grid_timing(grid)->until));
    letters_of(grid, letters, sizeof letters);
    picture->caption = gm_picture_text(picture, "Without a letter: %s.  %s%s", judge_of(grid), letters,
                                       letters[0] ? "." : "");
    picture->clock = "";
    for (size_t i = 0; i < grid->count; i++) {
        draw_map(grid, &grid->lines[i], picture);
    }
}

const struct gm_study_row gm_study_stability = {.name = "stability",
                                                .refusal = GM_EXIT_USAGE,
                                                .draw = draw,
                                                .print = print,
                                                .cells = "cells",
                                                .put_front = put_front,
                                                .which = "stability of which scene? Or --region SCHEME",
                                                .schemes = GM_RUN_SCHEMES,
                                                .usual = usual,
                                                .lay_out = lay_out,
                                                .run = run,
                                                .rows = 1,
                                                .put_cell = put};
