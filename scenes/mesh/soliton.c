/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solitons between two walls on linear elements whose nodes follow them: r-adaptive variational integrators.
       L = integral of phi_t^2/2 - phi_X^2/2 - W(phi),   W = 1 - cos phi, or (phi^2 - 1)^2/4
   What to look at: the paths of the nodes; the energy, conserved by the multiplier strategy, wandering with
   the control-theoretic one, symplectic or not, although both meshes follow the soliton equally well; the
   error over the number of nodes.

   Tyranowski & Desbrun (2019), section 5:
       figures 2, 3      the exact solutions
       figures 4 to 7    the field on few nodes
       figures 8, 9      the paths of the nodes
       figure 10         nodes that stand still
       figure 11         error over nodes
       figure 12         which strategy gets ahead, which lags behind, and where they break down
       figures 13, 14    the energy */
#include <math.h>

#include "core/mesh/soliton.h"
#include "scenes/mesh/observed.h"
#include "scenes/mesh/picture.h"

struct parameters {
    struct gm_timing timing;
    int show; /* enum gm_mesh_view */
    struct gm_soliton model;
};

static const char *const fields[] = {"sine-gordon", "phi4", NULL};

static const struct gm_parameter parameters[] = {
    GM_DT("0.01", 1e-6, 10),
    GM_UNTIL("50"),
    GM_INTEGER_ROW(struct parameters, model.solitons, "solitons", "1", 1, 2,
                   "one soliton, or two that bounce off each other"),
    GM_INTEGER_ROW(struct parameters, model.points, "points", "31", 1, 1e5, "nodes between the ends",
                   .logarithmic = true),
    GM_REAL_ROW(struct parameters, model.velocity, "velocity", "0.9", 0.01, 0.999999,
                "of the solitons; 1 is that of light"),
    GM_REAL_ROW(struct parameters, model.alpha, "alpha", "auto", 0, 1000,
                "weight of the field's slope in the mesh density; auto: 2.5 for one soliton, 1.5 for two",
                .automatic = true),
    GM_CHOICE_ROW(
        struct parameters, model.density, "density", "arclength", gm_mesh_densities,
        "what the nodes equidistribute: arclength, curvature, a mix of both, or arclength that is limited or "
        "tempered where the field is steeper than a soliton"),
    GM_CHOICE_ROW(struct parameters, model.field, "potential", "sine-gordon", fields,
                  "W(φ) = 1 − cos φ or (φ² − 1)²/4"),
    GM_REAL_ROW(struct parameters, model.length, "length", "25", 1, 1e4, "distance of the walls",
                .logarithmic = true),
    GM_CHOICE_ROW(
        struct parameters, show, "show", "all", gm_mesh_views,
        "what the picture shows: all, the field, the paths of the nodes, the energy, or error over nodes",
        .live = true),
};

static void resolve(void *model)
{
    struct parameters *soliton = model;
    soliton->model.alpha = gm_soliton_alpha(&soliton->model);
}

static bool setup(const void *model, struct gm_problem *problem, char *sentence)
{
    (void)sentence;
    const struct parameters *soliton = model;
    gm_soliton_problem(&soliton->model, problem);
    return true;
}

static bool start_with(const void *model, const struct gm_problem *problem, const struct gm_scheme *scheme,
                       double *y, char *sentence)
{
    const struct parameters *soliton = model;
    struct gm_mesh mesh;
    gm_moving_mesh_of(problem)->describe(problem, &mesh);
    if (gm_mesh_start(&mesh, gm_scheme_mesh(scheme), gm_soliton_profile, &soliton->model, y)) {
        return true;
    }
    double wall, slope, rate;
    gm_soliton_profile(&soliton->model, 0, &wall, &slope, &rate);
    if (fabs(wall - mesh.left) > 0.01) {
        /* the jump at the wall is narrower than any cell */
        gm_refuse(
            sentence,
            "no mesh was found: a box of length %g cuts the soliton off, which at velocity = %g is wider",
            soliton->model.length, soliton->model.velocity);
        return false;
    }
    return gm_refuse(
        sentence,
        "no mesh of %ld nodes was found for alpha = %g and velocity = %g: the homotopy from the uniform "
        "mesh fails; a smaller alpha helps",
        soliton->model.points, gm_soliton_alpha(&soliton->model), soliton->model.velocity);
}

/* Returns the position of the first soliton: the field, linear between the nodes, is half of its height, π.
   NaN if it never is, or has no such height (phi^4). */
static double position(const struct gm_view *view)
{
    const struct parameters *soliton = view->parameters;
    const size_t points = (size_t)soliton->model.points;
    const double *field = view->state, *place = field + points;
    for (size_t k = 1; k < points && soliton->model.field == GM_SINE_GORDON; k++) {
        const double before = field[k - 1] - M_PI, after = field[k] - M_PI;
        if (before * after <= 0 && before != after) {
            return place[k - 1] + (place[k] - place[k - 1]) * before / (before - after);
        }
    }
    return NAN;
}

static double energy_continuum_error(const struct gm_view *view)
{
    const struct parameters *soliton = view->parameters;
    const double continuum = gm_soliton_energy(&soliton->model);
    return fabs(gm_view_mesh_energy(view) - continuum) / continuum;
}

static const struct gm_observable observables[] = {
    GM_MESH_ERRORS,
    GM_OBSERVABLE("position", position, "place of the soliton, φ = π", .missing = "the field is nowhere π"),
    GM_MESH_ENERGIES,
    GM_LOG_OBSERVABLE("energy_continuum_error", energy_continuum_error,
                      "difference from the solitons' energy"),
    GM_MESH_NODES,
};

static const struct gm_track tracks[] = {GM_MESH_PATHS_TRACK};

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct parameters *soliton = lanes[0]->parameters;
    const char *who = soliton->model.solitons == 2 ? "two solitons" : "a soliton";
    static const char *const titles[] = {
        [GM_MESH_ALL] = "Mesh points that follow %s",
        [GM_MESH_FIELD] = "Mesh points that follow %s",
        [GM_MESH_PATHS] = "The paths of mesh points that follow %s",
        [GM_MESH_ENERGY] = "The energy of %s on a moving mesh",
        [GM_MESH_CONVERGENCE] = "What moving the mesh gains: %s",
    };
    picture->title = gm_picture_text(picture, titles[soliton->show], who);
    const struct gm_view view = gm_lane_view(lanes[0]);
    const struct gm_mesh mesh = gm_mesh_of(&view);
    const bool phi4 = soliton->model.field == GM_PHI4;
    const struct gm_mesh_look look = {
        .show = (enum gm_mesh_view)soliton->show,
        .front = gm_picture_text(picture, "%s,  velocity %g", phi4 ? "φ⁴" : "sine-Gordon",
                                 soliton->model.velocity),
        .name = "φ",
        .scale = phi4 ? GM_LINEAR : GM_PI,
        .low = fmin(mesh.left, mesh.right),
        .high = phi4 ? 1 : fmax(mesh.left, mesh.right),
    };
    gm_mesh_draw(lanes, count, picture, &look);
}

static const char *const schemes[] = {"multiplier-lobatto4", "control-gauss4",         "uniform-gauss4",
                                      "multiplier-lobatto2", "multiplier-trapezoidal", "multiplier-adaptive4",
                                      "control-gauss2",      "control-lobatto2",       "control-lobatto4",
                                      "control-radau3",      "control-radau5",         "uniform-gauss2",
                                      "uniform-lobatto2",    "uniform-lobatto4",       NULL};

static const struct gm_figure figures[] = {
    {
        .name = "tyranowski-2",
        .statement = "the single soliton of the sine-Gordon equation",
        .arguments = "scheme=multiplier-lobatto4 points=63 until=0 show=field",
    },
    {
        .name = "tyranowski-3",
        .statement = "the two-soliton solution",
        .arguments = "scheme=multiplier-lobatto4 solitons=2 points=63 until=0 show=field",
    },
    {
        .name = "tyranowski-4",
        .statement =
            "17 mesh points capture the soliton with the multiplier strategy; it bounces at 13.84 and 41.52",
        .arguments = "scheme=multiplier-lobatto4 points=15 until=50",
    },
    {
        .name = "tyranowski-5",
        .statement = "the multiplier strategy with 31 nodes",
        .arguments = "scheme=multiplier-lobatto4 points=31 until=50",
    },
    {
        .name = "tyranowski-6",
        .statement = "the control-theoretic strategy with 22 nodes",
        .arguments = "scheme=control-gauss4,control-lobatto4 points=22 until=50",
    },
    {
        .name = "tyranowski-7",
        .statement = "the control-theoretic strategy with 31 nodes",
        .arguments = "scheme=control-gauss4,control-lobatto4 points=31 until=50",
    },
    {
        .name = "tyranowski-8",
        .statement = "mesh points of the multiplier strategy, 22 and 31 of them",
        .arguments = "points=22,31 scheme=multiplier-lobatto4 until=50 show=mesh",
    },
    {
        .name = "tyranowski-9",
        .statement = "mesh points of the control-theoretic strategy, 22 and 31 of them",
        .arguments = "points=22,31 scheme=control-gauss4,control-lobatto4 until=50 show=mesh",
    },
    {
        .name = "tyranowski-10",
        .statement = "31 nodes that stand still do not resolve the soliton",
        .arguments = "scheme=uniform-gauss4,uniform-lobatto4 points=31 until=50",
    },
    {
        .name = "tyranowski-11",
        .statement =
            "the multiplier strategy is more accurate than the control-theoretic one, and both than a uniform mesh",
        .arguments = "scheme=multiplier-lobatto4,control-gauss4,uniform-gauss4 points=15,31,63,127 until=50 "
                     "show=convergence",
    },
    {
        .name = "tyranowski-11-schemes",
        .statement = "other integrators, of second order too, give very similar errors",
        .arguments = "scheme=multiplier-lobatto4,multiplier-lobatto2,control-gauss4,control-lobatto4,control-"
                     "gauss2,uniform-gauss4,uniform-lobatto4,uniform-gauss2 points=31,63,127 until=50 "
                     "show=convergence",
    },
    {
        .name = "tyranowski-11-uniform",
        .statement = "on a uniform mesh the error falls quadratically, once there are enough points",
        .arguments = "scheme=uniform-gauss4 points=15,31,63,127,255,361 until=50 show=convergence",
    },
    {
        .name = "tyranowski-12",
        .statement =
            "the multiplier solution gets ahead of the exact one, the control-theoretic solution lags behind",
        .arguments =
            "scheme=multiplier-lobatto4,control-gauss4 solitons=2 points=25 alpha=1.5 dt=0.05 until=100 "
            "show=field",
    },
    {
        .name = "tyranowski-12-breakdown",
        .statement =
            "the multiplier strategy breaks down at about 600, the control-theoretic one beyond 1000",
        .arguments =
            "scheme=multiplier-lobatto2,multiplier-lobatto4,control-gauss4,control-lobatto4,control-radau5 "
            "solitons=2 points=25 alpha=1.5 dt=0.05 until=1100 show=mesh",
    },
    {
        .name = "tyranowski-13",
        .statement =
            "the multiplier strategy conserves the energy, except for spikes at the bounces; order 4 better than 2",
        .arguments = "scheme=multiplier-lobatto2,multiplier-lobatto4 solitons=2 points=25 alpha=1.5 dt=0.05 "
                     "until=300 show=energy",
    },
    {
        .name = "tyranowski-14",
        .statement = "with the control-theoretic strategy the energy wanders, symplectic or not",
        .arguments =
            "scheme=control-gauss4,control-lobatto4,control-radau5,multiplier-lobatto4 solitons=2 points=25 alpha=1.5 dt=0.05 "
            "until=300 show=energy",
    },
};

/* Schemes do best with different nodes and steps, so each scheme is tried with all of them. */
static const double resolutions[] = {7, 15, 31, 63, 127, 255, 511, 1023};
static const double compared[] = {1, 0.1, 0.01};

static const struct gm_work work = {
    .arguments = "until=20",
    .measure = "solution_error",
    .coarsest = 0.32,
    .halvings = 6,
    .resolution = "points",
    .resolutions = resolutions,
    .resolution_count = GM_COUNT(resolutions),
    .errors = compared,
};

static double one(const void *model)
{
    (void)model;
    return 1;
}

static const double velocities[] = {0.2, 0.4, 0.6, 0.8, 0.9, 0.98};
static const double steps[] = {0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1};
static const char *const mapped[] = {"multiplier-lobatto4", "multiplier-trapezoidal", "control-gauss4",
                                     "uniform-gauss4", NULL};

static const struct gm_stability stability = {
    .arguments = "until=20",
    .parameter = "velocity",
    .values = velocities,
    .value_count = GM_COUNT(velocities),
    .label = "Δt",
    .unit = one,
    .steps = steps,
    .step_count = GM_COUNT(steps),
    .kept = "energy",
    .error = "solution_error",
    .schemes = mapped,
};

const struct gm_scene gm_scene_soliton = {
    .name = "soliton",
    .title = "Mesh points that follow a soliton",
    .blurb =
        "The sine-Gordon equation between two walls, on linear elements whose nodes move so that the arclength "
        "of the field is equidistributed, with variational integrators for field and mesh.",
    .watch =
        "Watch the energy: the multiplier strategy keeps it, with the control-theoretic one it wanders, although "
        "both meshes follow the soliton equally well.",
    .time = "what light needs for a length of 1",
    .size = sizeof(struct parameters),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
    .observables = observables,
    .observable_count = GM_COUNT(observables),
    .tracks = tracks,
    .track_count = GM_COUNT(tracks),
    .figures = figures,
    .figure_count = GM_COUNT(figures),
    .work = &work,
    .stability = &stability,
    .resolve = resolve,
    .setup = setup,
    .start_with = start_with,
    .draw = draw,
};
