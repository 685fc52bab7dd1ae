/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The modified Hamiltonian of a lane, derived when it is first requested and stored by the lane. */
#include "scenes/ode/modified.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/backward/modified_energy.h"
#include "scenes/common/graph.h"
#include "scenes/common/scene.h"

/* The stored energies of a state: the start is requested repeatedly. */
struct state {
    double *y; /* n */
    double terms[GM_MODIFIED_POWER + 1];
    bool known;
};

struct worked {
    const struct gm_scheme *scheme; /* the lane may change it */
    int power;
    size_t n;
    struct gm_modified_energy *energy; /* NULL: it does not exist; `why` has the reason */
    char why[GM_MODIFIED_WHY];
    struct state start, now;
};

static void forget(void *data)
{
    struct worked *worked = data;
    gm_modified_energy_close(worked->energy);
    free(worked->start.y);
    free(worked->now.y);
    free(worked);
}

/* Returns the stored data of a lane; NULL when out of memory, which is noted. */
static struct worked *worked_of(const struct gm_view *view, int power)
{
    struct worked *worked = view->worked[GM_WORKED_ENERGY].data;
    if (worked && worked->scheme == view->scheme && worked->power >= power) {
        return worked;
    }
    if (worked) {
        forget(worked);
    }
    const size_t n = view->problem->n;
    view->worked[GM_WORKED_ENERGY].data = worked = calloc(1, sizeof *worked);
    if (!worked) {
        return NULL;
    }
    view->worked[GM_WORKED_ENERGY].forget = forget;
    worked->scheme = view->scheme;
    worked->power = power;
    worked->n = n;
    worked->start.y = malloc(n * sizeof(double));
    worked->now.y = malloc(n * sizeof(double));
    if (worked->start.y && worked->now.y) {
        worked->energy = gm_modified_energy_open(view->problem, view->scheme, power, worked->why);
    }
    return worked;
}

static double energy_of(struct worked *worked, struct state *state, const struct gm_view *view, int power)
{
    const size_t m = view->problem->m;
    bool same = state->known;
    for (size_t i = 0; i < worked->n; i++) {
        const double value = view->state[i * m + m - 1];
        same = same && value == state->y[i];
        state->y[i] = value;
    }
    if (!same) {
        gm_modified_energy_terms(worked->energy, state->y, state->terms);
        state->known = true;
    }
    double sum = 0;
    for (int k = power; k >= 0; k--) {
        sum = sum * view->dt + state->terms[k];
    }
    return sum;
}

/* Returns true if the run was stopped within a step: its last, shorter step has another modified
   Hamiltonian. */
static bool is_within_step(const struct gm_view *view)
{
    return view->run && view->run->n == 0 && view->run->steps > 0 && gm_view_stopped(view);
}

static double error_of(const struct gm_view *view, int power)
{
    struct worked *worked = worked_of(view, power);
    if (!worked || !worked->energy || is_within_step(view)) {
        return NAN;
    }
    struct gm_view before = *view;
    before.state = view->start;
    const double initial = energy_of(worked, &worked->start, &before, power);
    const int plain = gm_scene_observable(view->scene, "energy_error");
    const double scale =
        plain >= 0 ? gm_observable_scale(gm_scene_observable_at(view->scene, (size_t)plain), view) : 0;
    const double divisor = fmax(fabs(worked->start.terms[0]), scale);
    return fabs(energy_of(worked, &worked->now, view, power) - initial) / (divisor > 0 ? divisor : 1);
}

double gm_modified_error_2(const struct gm_view *view)
{
    return error_of(view, 2);
}

double gm_modified_error_4(const struct gm_view *view)
{
    return error_of(view, 4);
}

double gm_modified_error_6(const struct gm_view *view)
{
    return error_of(view, 6);
}

const char *gm_modified_why(const struct gm_view *view)
{
    const struct worked *worked = view->worked[GM_WORKED_ENERGY].data;
    return worked && worked->why[0] ? worked->why
           : is_within_step(view)
               ? "the run was stopped within a step, and a shorter step has another modified Hamiltonian"
               : NULL;
}

const char *const gm_modified_shows[] = {"all", GM_SHOW_MODIFIED, NULL};

size_t gm_modified_shown(const struct gm_scene *scene, const void *parameters)
{
    const struct gm_parameter *show = gm_scene_parameter(scene, "show");
    char text[GM_TEXT_SIZE];
    const bool chosen =
        show && strcmp(gm_parameter_format(show, parameters, text, sizeof text), GM_SHOW_MODIFIED) == 0;
    return chosen ? GM_MODIFIED_OBSERVABLES : 0;
}

void gm_draw_modified(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    static const struct gm_together together[] = {
        {"energy_error", "H"},
        {"modified_energy2_error", "to Δt²"},
        {"modified_energy4_error", "to Δt⁴"},
        {"modified_energy6_error", "to Δt⁶"},
    };
    const bool one = gm_one_step(lanes, count);
    picture->title = "The conserved quantity: the modified energy";
    picture->subtitle =
        gm_picture_text(picture, "%s%s%s;  errors of H + Δt H₁ + Δt² H₂ + …, cut off", lanes[0]->scene->title,
                        one ? ",  Δt = " : "", one ? gm_step_text(picture, lanes[0]->run->dt) : "");
    picture->caption =
        "A symplectic scheme solves an equation with another Hamiltonian almost exactly: the more terms "
        "of it are taken, the flatter the line.";
    gm_draw_clock(picture, lanes, count);
    gm_draw_together(picture, lanes, count, together, GM_COUNT(together));
}
