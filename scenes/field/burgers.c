/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Burgers' equation, seen from frames that move with the velocity lambda:
       u_t + u u_x = nu u_xx,   (t, x, u) -> (t, x + lambda t, u + lambda)
   It is not Hamiltonian: what counts are its symmetries, boosts and projections among them, with which the
   exact flow commutes. What to look at: the profiles, drawn at rest, from frames that are faster and faster.
   The profiles of the invariantised schemes, on nodes that move along, coincide; the others separate,
   overshoot and blow up. With form=printed the convection is u D0 u as in the document, whose error grows at
   the shock even at rest where nodes are coarse.

   Razafindralandy, Hamdouni & Chhay (2018), section "Invariantisation":
       figures 22, 23   the moving frame at a node (show=frame)
       figure 24   the standard schemes        figure 25   the invariantised ones
       figure 26   a self-similar viscous shock */
#include <math.h>

#include "scenes/common/system/rows.h"
#include "scenes/field/burgers_draw.h"
#include "scenes/field/field.h"

static const char *const tests[] = {"front", "shock", NULL};
static const char *const frames[] = {"each", "fixed", "moving", NULL};
static const char *const forms[] = {"conservative", "printed", NULL};

static const struct gm_parameter parameters[] = {
    GM_DT("0.005", 1e-9, 10),
    GM_UNTIL("1"),
    GM_CHOICE_ROW(struct gm_burgers_scene, burgers.test, "test", "front", tests,
                  "a front from t = 0, or a self-similar shock from t = 1"),
    GM_REAL_ROW(struct gm_burgers_scene, burgers.viscosity, "viscosity", "5e-3", 0, 10, "ν",
                .logarithmic = true),
    GM_REAL_ROW(struct gm_burgers_scene, dx, "dx", "0.01", 1e-6, 0.5,
                "distance of the nodes; made to divide the interval", .logarithmic = true),
    GM_REAL_ROW(struct gm_burgers_scene, courant, "courant", "0.5", 1e-6, 1e3,
                "dt / dx: either this or dt is given", .logarithmic = true),
    GM_REAL_ROW(struct gm_burgers_scene, burgers.lambda, "lambda", "0", -1e4, 1e4, "velocity of the frame"),
    GM_CHOICE_ROW(
        struct gm_burgers_scene, burgers.frame, "frame", "each", frames,
        "nodes at rest in the frame, or moving by lambda dt per step, for invariant schemes only; each: "
        "moving for the invariant schemes, fixed for the others"),
    GM_CHOICE_ROW(struct gm_burgers_scene, burgers.printed, "form", "conservative", forms,
                  "of the convection in ftcs and crank-nicolson: D(u²/2), or u Du as printed"),
    GM_REAL_ROW(struct gm_burgers_scene, offset, "offset", "0", 0, 1, "shift of the nodes, in dx"),
    GM_REAL_ROW(struct gm_burgers_scene, burgers.a, "a", "-0.5", -10, 10,
                "of the frames of ftcs-family: all keep the symmetries, −1/2 alone the second order in dx"),
    GM_REAL_ROW(struct gm_burgers_scene, burgers.d, "d", "0", -10, 10,
                "likewise; without effect where a is −1/2"),
    GM_FRAME_ROWS(struct gm_burgers_scene, show, at, "-0.01"),
};

static double half_length(const struct gm_burgers_scene *scene)
{
    return scene->burgers.test == GM_BURGERS_SHOCK ? 1 : 2;
}

static double t0(const void *self)
{
    return gm_burgers_t0(&((const struct gm_burgers_scene *)self)->burgers);
}

static bool settle(void *self, const char *const *keys, size_t count, char *sentence)
{
    struct gm_burgers_scene *scene = self;
    const double length = 2 * half_length(scene);
    scene->dx = length / fmax(2, round(length / scene->dx));
    const struct gm_tie tie = {"courant", &scene->courant, scene->dx, &scene->timing};
    return gm_tie_settle(&tie, keys, count, sentence);
}

static bool setup(const void *self, struct gm_problem *problem, char *sentence)
{
    const struct gm_burgers_scene *scene = self;
    const double most = 1e7, lambda = scene->burgers.lambda;
    *problem = gm_problem_burgers;
    problem->parameters = &scene->burgers;
    /* a grid at rest extends to the front's last position */
    const double travel =
        scene->burgers.frame == GM_FRAME_MOVING ? 0 : lambda * (scene->timing.until - t0(self));
    const double more = round(fabs(travel) / scene->dx);
    const double pieces = round(2 * half_length(scene) / scene->dx) + more;
    if (!(pieces < most)) {
        return gm_refuse(sentence,
                         "the grid would need %.3g nodes to hold the front until the end; 1e7 is the most",
                         pieces);
    }
    problem->line = (struct gm_grid1){
        .points = (size_t)pieces + 1,
        .dx = scene->dx,
        .first = -half_length(scene) + scene->offset * scene->dx - (travel < 0 ? more * scene->dx : 0),
    };
    problem->n = gm_burgers_size(&scene->burgers, problem->line.points);
    return true;
}

static double node(const struct gm_problem *problem, size_t j)
{
    return gm_grid1_node(&problem->line, j);
}

static void start(const void *self, const struct gm_problem *problem, double *y)
{
    struct gm_burgers burgers = ((const struct gm_burgers_scene *)self)->burgers;
    const size_t points = problem->line.points;
    for (size_t j = 0; j < points; j++) {
        y[j] = gm_burgers_exact(&burgers, true, node(problem, j), t0(self));
    }
    if (burgers.lambda != 0) {
        burgers.lambda = 0;
        for (size_t j = 0; j < points; j++) {
            y[points + j] = gm_burgers_exact(&burgers, true, node(problem, j), t0(self));
        }
        y[2 * points] = 1;
    }
}

static double exact(const struct gm_view *view, size_t j)
{
    const struct gm_burgers *burgers = gm_burgers_of(view->problem);
    return gm_burgers_exact(burgers, gm_burgers_fixed(burgers, view->scheme), node(view->problem, j),
                            view->t);
}

static double sup_error(const struct gm_view *view)
{
    double largest = 0;
    for (size_t j = 0; j < view->problem->line.points; j++) {
        largest = fmax(largest, fabs(view->state[j] - exact(view, j)));
    }
    return largest;
}

static double l1_error(const struct gm_view *view)
{
    double sum = 0;
    for (size_t j = 0; j < view->problem->line.points; j++) {
        sum += fabs(view->state[j] - exact(view, j));
    }
    return view->problem->line.dx * sum;
}

static double overshoot(const struct gm_view *view)
{
    const double lambda = gm_burgers_of(view->problem)->lambda;
    double largest = 0;
    for (size_t j = 0; j < view->problem->line.points; j++) {
        largest = fmax(largest, fabs(view->state[j] - lambda) - 1);
    }
    return largest;
}

static double amplitude(const struct gm_view *view)
{
    double largest = 0;
    for (size_t j = 0; j < view->problem->line.points; j++) {
        largest = fmax(largest, fabs(view->state[j] - gm_burgers_of(view->problem)->lambda));
    }
    return largest;
}

/* Returns the largest difference from the companion's value as many nodes back as the frame has moved;
   between nodes it is linear. */
static double galilean_defect(const struct gm_view *view)
{
    const struct gm_burgers *burgers = gm_burgers_of(view->problem);
    const size_t points = view->problem->line.points;
    if (burgers->lambda == 0) {
        return 0;
    }
    const double *companion = view->state + points;
    if (companion[points] == 0) {
        return NAN;
    }
    const bool fixed = gm_burgers_fixed(burgers, view->scheme);
    const double back = fixed ? burgers->lambda * (view->t - view->t0) / view->problem->line.dx : 0;
    double largest = 0;
    for (size_t j = 0; j < points; j++) {
        const double place = (double)j - back, nearest = round(place);
        const double below = fabs(place - nearest) < 1e-6 ? nearest : floor(place), part = place - below;
        if (!(below >= 0 && below + 1 < (double)points)) {
            continue;
        }
        const size_t at = (size_t)below;
        const double there =
            fabs(part) < 1e-6 ? companion[at] : (1 - part) * companion[at] + part * companion[at + 1];
        largest = fmax(largest, fabs(view->state[j] - burgers->lambda - there));
    }
    return largest;
}

/* Returns the defect on the three nodes 0.3 - h, 0.3, 0.3 + h with the values 0.4, 0.3, 0.15. */
static double defect(const struct gm_view *view, const struct gm_burgers_symmetry *symmetry)
{
    static const double u[3] = {0.4, 0.3, 0.15};
    return gm_burgers_defect(view->scheme, gm_burgers_of(view->problem), view->problem->line.dx, view->dt,
                             symmetry, 0.3, u);
}

static double projection_defect(const struct gm_view *view)
{
    return defect(view, &(const struct gm_burgers_symmetry){.a4 = 0.5, .scale = 1});
}

static double scaling_defect(const struct gm_view *view)
{
    return defect(view, &(const struct gm_burgers_symmetry){.scale = 1.3});
}

/* If this is 1 or more, no projection turns D0 u into 0, and the invariant scheme has no frame to step in. */
static double compression(const struct gm_view *view)
{
    const double half = view->dt / (2 * view->problem->line.dx);
    double largest = 0;
    for (size_t j = 1; j + 1 < view->problem->line.points; j++) {
        largest = fmax(largest, half * (view->state[j - 1] - view->state[j + 1]));
    }
    return largest;
}

static const struct gm_observable observables[] = {
    GM_LOG_OBSERVABLE("sup_error", sup_error, "largest error"),
    GM_LOG_OBSERVABLE("l1_error", l1_error, "mean error, h Σ|e|"),
    GM_OBSERVABLE("overshoot", overshoot, "overshoot"),
    GM_OBSERVABLE("amplitude", amplitude, "largest |u − λ|"),
    GM_OBSERVABLE("compression", compression, "compression in a step, −Δt D₀u"),
    GM_LOG_OBSERVABLE("galilean_defect", galilean_defect, "difference from the run at λ = 0",
                      .missing = "the run at λ = 0 has failed"),
    GM_LOG_OBSERVABLE("projection_defect", projection_defect, "defect of a step under a projection by 1/2"),
    GM_LOG_OBSERVABLE("scaling_defect", scaling_defect, "defect of a step under a scaling by 1.3"),
};

static const char *const schemes[] = {"ftcs",
                                      "lax-wendroff",
                                      "ftcs-invariant",
                                      "crank-nicolson",
                                      "lax-wendroff-invariant",
                                      "crank-nicolson-invariant",
                                      "ftcs-family",
                                      NULL};

/* A frame needs a scheme that steps in it. */
static const struct gm_preference preferences[] = {
    {"show=frame", {"ftcs-invariant"}},
    {NULL, {NULL}},
};

static const struct gm_figure figures[] = {
    {
        .name = "razafindralandy-22",
        .statement = "the moving frame carries the node to the origin and the grid along",
        .arguments = "show=frame scheme=ftcs-invariant lambda=0 until=0.2",
    },
    {
        .name = "razafindralandy-23",
        .statement =
            "from whichever frame the nodes are seen, the moving frame carries them to the same place",
        .arguments = "show=frame scheme=ftcs-invariant lambda=0,0.5,1 frame=moving until=0.2",
    },
    {
        .name = "razafindralandy-24",
        .statement = "seen from a moving frame, the standard schemes make errors that grow with its velocity",
        .arguments = "scheme=ftcs,lax-wendroff,crank-nicolson lambda=0,0.5,1 frame=fixed dx=0.02 "
                     "courant=0.5",
    },
    {
        .name = "razafindralandy-24-finer",
        .statement = "Figure 24 with a time step somewhat shorter than the document's",
        .arguments = "scheme=ftcs,lax-wendroff,crank-nicolson lambda=0,0.5,1 frame=fixed dx=0.02 "
                     "courant=0.4",
    },
    {
        .name = "razafindralandy-25",
        .statement = "the invariantised schemes give the same profile from every frame and do not oscillate",
        .arguments = "scheme=ftcs-invariant,lax-wendroff-invariant,crank-nicolson-invariant lambda=0,1,2,3 "
                     "frame=moving dx=0.02 courant=0.5",
    },
    {
        .name = "razafindralandy-25-finer",
        .statement = "Figure 25 on a grid twice as fine as the document's",
        .arguments = "scheme=ftcs-invariant,lax-wendroff-invariant,crank-nicolson-invariant lambda=0,1,2,3 "
                     "frame=moving dx=0.01 courant=0.5",
    },
    {
        .name = "razafindralandy-26",
        .statement =
            "on a self-similar shock the invariantised FTCS scheme stays close to the exact solution where "
            "FTCS does not",
        .arguments =
            "scheme=ftcs,ftcs-invariant lambda=0 test=shock viscosity=0.01 dx=0.05 courant=1 form=printed until=2",
    },
};

/* The error of the mesh hides that of the step, and the other way round: both are refined. */
static const double mesh[] = {0.08, 0.04, 0.02, 0.01, 0.005, 0.0025};
static const double compared[] = {1e-2, 1e-3, 1e-4};
static const struct gm_work work = {
    .arguments = "viscosity=0.05 until=1",
    .measure = "sup_error",
    .coarsest = 0.1,
    .halvings = 11,
    .resolution = "dx",
    .resolutions = mesh,
    .resolution_count = GM_COUNT(mesh),
    .ratio = "courant",
    .errors = compared,
};

/* A Courant number of 1. */
static double crossing_time(const void *self)
{
    return ((const struct gm_burgers_scene *)self)->dx;
}

static const double viscosities[] = {0.0025, 0.005, 0.0075, 0.01, 0.0125, 0.015, 0.0175};
static const double courant_numbers[] = {0.1, 0.16, 0.25, 0.4, 0.63, 1, 1.6, 2.5, 4};

static const struct gm_stability stability = {
    .arguments = "dx=0.02 until=1",
    .parameter = "viscosity",
    .values = viscosities,
    .value_count = GM_COUNT(viscosities),
    .label = "Δt / Δx",
    .unit = crossing_time,
    .steps = courant_numbers,
    .step_count = GM_COUNT(courant_numbers),
    .kept = "amplitude",
    .error = "overshoot",
};

const struct gm_scene gm_scene_burgers = {
    .name = "burgers",
    .title = "Burgers' equation from moving frames",
    .blurb =
        "A steep front or a viscous shock, and the same seen from a frame that moves with lambda. The equation "
        "does not care; a standard scheme does, an invariantised one does not.",
    .watch =
        "Watch the profiles part as lambda grows: invariantised schemes on moving nodes give one and the same "
        "(confirmed to round-off); that they never oscillate holds for Lax-Wendroff only, and for all at dx = 0.01.",
    .time = "length / speed, in the units of x and u",
    .size = sizeof(struct gm_burgers_scene),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
    .preferences = preferences,
    .lanes = "scheme=ftcs,lax-wendroff,ftcs-invariant,lax-wendroff-invariant lambda=0,0.5,1",
    .observables = observables,
    .observable_count = GM_COUNT(observables),
    .figures = figures,
    .figure_count = GM_COUNT(figures),
    .t0 = t0,
    .work = &work,
    .stability = &stability,
    .settle = settle,
    .setup = setup,
    .start = start,
    .draw = gm_burgers_draw,
};
